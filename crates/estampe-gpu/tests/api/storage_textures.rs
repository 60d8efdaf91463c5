//! Fragment shaders that store to a texture: all covered fragments store, helper invocations do
//! not.

use crate::support::{Fill, Images, device_with, texture};
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{DepthStencilState, VertexBufferLayout};
use estampe::storage_store;
use estampe::{
    BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType, ColorAttachment,
    DepthStencilAttachment, Draw, Level, RenderPass, RenderPipelineDescriptor, TextureFormat, Vec2,
    Vec4, VertexFormat, ViewDimension, bytes_of,
};

const SIZE: [u32; 2] = [75, 41];

/// Writes a colour that depends on the position, to the attachment and to the texture of binding 1.
struct Storing {
    depth: f32,
}

estampe::shader! {
    impl Shader for Storing {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = ();
        const STORES: bool = true;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, ()> {
            let (depth, w) = (input.real(self.depth), input.real(1.0));
            VertexOut::new(Vec4::new(at.x, at.y, depth, w), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _nothing: ()) -> FragmentOut<R> {
            let (x, y) = (input.position.x, input.position.y);
            let color = Vec4::new(x / 128.0, y / 128.0, input.real(1.0), input.real(1.0));
            let at = [x.floor().to_int(), y.floor().to_int()];
            let slice = at[0].splat(0);
            if let Some(texture) = input.bindings.storage_texture(0, 1) {
                storage_store(texture, !input.is_helper, [at[0], at[1], slice], color);
            }
            FragmentOut::color(color)
        }
    }
}

/// The contents of the attachment and of the texture after triangles at depth ½ were drawn over
/// depths cleared to `clear_depth`.
fn drawn(level: Level, threads: usize, clear_depth: f32) -> [Vec<u8>; 2] {
    let device = device_with(threads, level);
    let format = TextureFormat::Rgba8Unorm;
    let stored = texture(&device, SIZE, format);
    let layout = device
        .create_bind_group_layout(&[BindGroupLayoutEntry {
            binding: 1,
            ty: BindingType::StorageTexture {
                format,
                view_dimension: ViewDimension::D2,
            },
        }])
        .expect("a valid layout");
    let group = device
        .create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[(1, BindingResource::Texture(stored.view()))],
        })
        .expect("it has the layout");
    let mut descriptor = RenderPipelineDescriptor::new(Storing { depth: 0.5 });
    descriptor.bind_group_layouts = vec![layout];
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
    descriptor.depth_stencil = Some(DepthStencilState::LESS_WRITE);
    let pipeline = device
        .create_render_pipeline(&descriptor)
        .expect("a valid pipeline");
    let corners: [f32; 12] = [
        -0.9, -0.8, 0.7, -0.5, -0.2, 0.9, // large
        0.8, 0.8, 0.81, 0.84, 0.85, 0.79, // of a pixel or two
    ];
    let buffer = device.create_buffer_with_contents(bytes_of(&corners));
    let buffers = [buffer.expect("it is small").slice(..)];
    let draws = [Draw {
        vertex_buffers: &buffers,
        bind_groups: std::slice::from_ref(&group),
        ..Draw::new(&pipeline, 0..6)
    }];
    let images = Images::with(&device, SIZE, format, 1);
    let pass = RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&images.color.view(), [0.0; 4]))],
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(
            &images.depth.view(),
            clear_depth,
        )),
        draws: &draws,
        ..RenderPass::default()
    };
    device.render(&pass).expect("it fits");
    let stored = device.read_texture(&stored).expect("it can be read");
    [images.pixels(&device), stored]
}

/// Rows: F2, O9.
#[test]
fn covered_fragments_store_even_if_invisible() {
    let [seen, _] = drawn(Level::best(), 1, 1.0);
    let white = |pixels: &[u8]| pixels.iter().filter(|&&byte| byte == 255).count();
    assert!(white(&seen) > 500);
    for level in Level::all_available() {
        for threads in [1, 2] {
            let [target, stored] = drawn(level, threads, 1.0);
            assert_eq!(target, seen, "{}", level.name());
            assert_eq!(stored, seen, "{}", level.name());
            // No fragment passes the depth test, but all are shaded.
            let [target, stored] = drawn(level, threads, 0.25);
            assert_eq!(white(&target), 0);
            assert_eq!(stored, seen, "{}", level.name());
        }
    }
}

/// A dry run cannot see a store whose texture is bound, so the constant is needed: without it the
/// pass is refused.
#[test]
fn a_storage_texture_needs_a_shader_that_stores() {
    let device = device_with(1, Level::best());
    let format = TextureFormat::Rgba8Unorm;
    let ty = BindingType::StorageTexture {
        format,
        view_dimension: ViewDimension::D2,
    };
    let layout = device
        .create_bind_group_layout(&[BindGroupLayoutEntry { binding: 0, ty }])
        .expect("a valid layout");
    let stored = texture(&device, SIZE, format);
    let group = device
        .create_bind_group(&BindGroupDescriptor {
            label: Some("output"),
            layout: &layout,
            entries: &[(0, BindingResource::Texture(stored.view()))],
        })
        .expect("it has the layout");
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor::new(Fill::WHITE))
        .expect("a valid pipeline");
    let images = Images::with(&device, SIZE, format, 1);
    let error = device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::load(&images.color.view()))],
            depth_stencil_attachment: Some(DepthStencilAttachment::load(&images.depth.view())),
            draws: &[Draw {
                bind_groups: std::slice::from_ref(&group),
                ..Draw::new(&pipeline, 0..3)
            }],
            ..RenderPass::default()
        })
        .expect_err("the shader declares no stores");
    assert_eq!(
        error.to_string(),
        "the pass: draw 0: bind group 0: the bind group `output` has a storage texture, and the \
         shader declares no stores: set its constant `STORES`"
    );
}
