//! A depth attachment as a shadow map: the same depths, without a copy, and immutable.

use crate::support::{device, f32s, texture};
use estampe::shader::{FragmentBatch, Interface, VertexBatch};
use estampe::{
    BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType, Bindings,
    ColorAttachment, DepthStencilAttachment, Device, DeviceDescriptor, Draw, FragmentIn,
    FragmentOut, Level, PassExtent, Program, RenderPass, RenderPipelineDescriptor, ShadowMap,
    Statistics, Texture, TextureDescriptor, TextureFormat, Vec4, VertexIn, VertexOut,
};
use std::sync::{Arc, Mutex};

/// A triangle that slopes towards the viewer, depth only.
struct Slope;

estampe::shader! {
    impl Shader for Slope {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let index = input.vertex_index.to_real();
            let (one, zero) = (input.real(1.0), input.zero);
            let x = R::select(index.eq(one), input.real(0.9), input.real(-0.8));
            let y = R::select(index.eq(zero), input.real(0.95), input.real(-0.7));
            VertexOut::new(Vec4::new(x, y, index * 0.4 + 0.1, one), ())
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::none()
        }
    }
}

/// A program without colours that keeps the shadow map of binding 2.
#[derive(Debug, Default)]
struct Keeper {
    interface: Interface,
    kept: Mutex<Option<ShadowMap>>,
}

impl Program for Keeper {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn run_vertices(&self, _level: Level, bindings: &Bindings, _batch: VertexBatch<'_>) {
        *self.kept.lock().unwrap() = bindings.shadow_map(0, 2).cloned();
    }

    fn run_fragments(&self, _level: Level, _bindings: &Bindings, _batch: FragmentBatch<'_>) {}
}

const SIZE: [u32; 2] = [200, 130];

fn cleared(device: &Device) -> Texture {
    let depth = texture(device, SIZE, TextureFormat::Depth32Float);
    let attachment = DepthStencilAttachment::clear(&depth.view(), 1.0);
    device
        .render(&RenderPass {
            depth_stencil_attachment: Some(attachment),
            ..RenderPass::default()
        })
        .unwrap();
    depth
}

fn draw(device: &Device, depth: &Texture) -> Statistics {
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor {
            targets: Vec::new(),
            ..RenderPipelineDescriptor::new(Slope)
        })
        .unwrap();
    device
        .render(&RenderPass {
            depth_stencil_attachment: Some(DepthStencilAttachment::load(&depth.view())),
            draws: &[Draw::new(&pipeline, 0..3)],
            ..RenderPass::default()
        })
        .unwrap()
}

/// The shadow map as a shader reads it.
fn bound(device: &Device, depth: &Texture) -> ShadowMap {
    let layout = device
        .create_bind_group_layout(&[BindGroupLayoutEntry {
            binding: 2,
            ty: BindingType::ShadowMap,
        }])
        .unwrap();
    let group = device
        .create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[(2, BindingResource::Texture(depth.view()))],
        })
        .unwrap();
    let keeper = Arc::new(Keeper::default());
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor {
            bind_group_layouts: vec![layout],
            depth_stencil: None,
            targets: Vec::new(),
            ..RenderPipelineDescriptor::with_program(Arc::clone(&keeper) as Arc<dyn Program>)
        })
        .unwrap();
    device
        .render(&RenderPass {
            extent: Some(PassExtent {
                width: 1,
                height: 1,
                samples: 1,
            }),
            draws: &[Draw {
                bind_groups: std::slice::from_ref(&group),
                ..Draw::new(&pipeline, 0..3)
            }],
            ..RenderPass::default()
        })
        .unwrap();
    keeper
        .kept
        .lock()
        .unwrap()
        .take()
        .expect("a shadow map is bound")
}

fn rows(texture: &ShadowMap) -> Vec<f32> {
    let (width, height) = (texture.width(), texture.height());
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    texels.map(|(x, y)| texture.texel(x, y)).collect()
}

#[test]
fn the_shadow_map_holds_the_depths_and_bounds_them() {
    for threads in [1, 2, 7] {
        let device = Device::new(&DeviceDescriptor {
            threads,
            ..DeviceDescriptor::default()
        })
        .unwrap();
        let depth = cleared(&device);
        assert_eq!(draw(&device, &depth).tiles_bounded, 0, "no map was taken");
        check_map(&device, &depth);
        // The next passes find the bounds of the twelve tiles themselves, which are quarters where
        // several threads draw few primitives.
        let tiles = if threads == 1 { 12 } else { 48 };
        assert_eq!(draw(&device, &depth).tiles_bounded, tiles);
        check_map(&device, &depth);
    }
}

/// The shadow map of a texture holds its depths and bounds them.
fn check_map(device: &Device, depth: &Texture) {
    let map = bound(device, depth);
    assert_eq!([map.width(), map.height()], SIZE);
    let depths = f32s(&device.read_texture(depth).unwrap());
    assert!(rows(&map) == depths);
    assert!(depths.iter().filter(|depth| **depth < 1.0).count() > 5000);
    let stride = ShadowMap::bounds_stride(SIZE[0]);
    for (index, depth) in depths.iter().enumerate() {
        let (x, y) = (index % SIZE[0] as usize, index / SIZE[0] as usize);
        let word = map.windows()[y / 4 * stride + x / 4];
        let scaled = depth * ShadowMap::BOUND_SCALE;
        assert!((word & 0xFFFF) as f32 <= scaled && (word >> 16) as f32 >= scaled);
    }
    // The same image from rows; the windows differ only where they extend beyond the image.
    let brought = ShadowMap::from_rows(SIZE[0], SIZE[1], &depths);
    assert!(rows(&brought) == depths);
    assert_eq!(brought.windows()[..32], map.windows()[..32]);
}

/// A second binding of the same depths shares their memory with the first; drawing does not.
#[test]
fn a_shadow_map_is_the_attachments_memory_until_it_is_drawn_over() {
    let device = device();
    let depth = cleared(&device);
    let before = bound(&device, &depth);
    let place = |map: &ShadowMap| map.depths().as_ptr();
    assert_eq!(place(&before), place(&bound(&device, &depth)));
    let rows_before = rows(&before);
    draw(&device, &depth);
    assert!(rows(&before) == rows_before);
    let drawn = bound(&device, &depth);
    assert!(rows(&drawn) != rows_before);
    assert_ne!(place(&before), place(&drawn));
    drop((before, depth));
    assert!(rows(&drawn) != rows_before);
}

/// Depths that the host writes are in the next shadow map.
#[test]
fn written_depths_reach_the_shadow_map() {
    let device = device();
    let depth = cleared(&device);
    draw(&device, &depth);
    drop(bound(&device, &depth));
    let written = [0.25_f32, 0.75];
    device
        .write_texture(
            &depth,
            estampe::bytes_of(&written),
            &estampe::TexelCopyLayout::default(),
            estampe::Extent3d::new_2d(2, 1),
        )
        .unwrap();
    let map = bound(&device, &depth);
    assert_eq!(
        [map.texel(0, 0), map.texel(1, 0), map.texel(2, 0)],
        [0.25, 0.75, 1.0]
    );
    let depths = f32s(&device.read_texture(&depth).unwrap());
    assert!(rows(&map) == depths);
}

#[test]
fn there_is_no_shadow_map_without_depth_or_with_several_samples() {
    let device = device();
    let layout = device
        .create_bind_group_layout(&[BindGroupLayoutEntry {
            binding: 2,
            ty: BindingType::ShadowMap,
        }])
        .unwrap();
    for (format, sample_count, what) in [
        (
            TextureFormat::Rgba8Unorm,
            1,
            "a D2 view of Float (rgba8unorm)",
        ),
        (TextureFormat::Stencil8, 1, "a D2 view of Uint (stencil8)"),
        (
            TextureFormat::Depth32Float,
            4,
            "a multisampled D2 view of Depth (depth32float)",
        ),
    ] {
        let descriptor = TextureDescriptor {
            sample_count,
            ..TextureDescriptor::new_2d(8, 8, format)
        };
        let texture = device.create_texture(&descriptor).unwrap();
        let error = device
            .create_bind_group(&BindGroupDescriptor {
                label: Some("lights"),
                layout: &layout,
                entries: &[(2, BindingResource::Texture(texture.view()))],
            })
            .unwrap_err();
        assert_eq!(
            error.to_string(),
            format!(
                "binding 2 of the bind group `lights` is a shadow map, and the resource is {what}"
            )
        );
    }
    // A pass cannot write the depths that it compares.
    let depth = cleared(&device);
    let group = device
        .create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[(2, BindingResource::Texture(depth.view()))],
        })
        .unwrap();
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor {
            bind_group_layouts: vec![layout],
            ..RenderPipelineDescriptor::new(crate::support::Fill::WHITE)
        })
        .unwrap();
    let color = texture(&device, SIZE, TextureFormat::Rgba8Unorm);
    let error = device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&color.view(), [0.0; 4]))],
            depth_stencil_attachment: Some(DepthStencilAttachment::load(&depth.view())),
            draws: &[Draw {
                bind_groups: std::slice::from_ref(&group),
                ..Draw::new(&pipeline, 0..3)
            }],
            ..RenderPass::default()
        })
        .unwrap_err();
    assert_eq!(
        error.to_string(),
        "the pass: the depth-stencil attachment and binding 2 of a bind group are the same image: \
         a pass cannot use an image that it writes twice"
    );
}
