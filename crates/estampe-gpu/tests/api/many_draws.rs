//! Passes of so many draws that threads prepare parts of them: the image is that of many passes,
//! and the first draw that breaks a rule is named.

use crate::support::{Images, devices};
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{CullMode, VertexBufferLayout, Viewport};
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType,
    BufferBindingType, BufferSlice, ColorAttachment, DepthStencilAttachment, Device, Draw,
    IndexFormat, PassErrorKind, RenderPass, RenderPassError, RenderPipeline,
    RenderPipelineDescriptor, Vec2, Vec4, VertexFormat, bytes_of,
};

/// More than two parts.
const DRAWS: u32 = 1300;

/// Draws of one of the passes that are compared: fewer than a part.
const FEW: usize = 15;

/// Bytes between the uniforms of draws: the multiple that dynamic offsets must be of.
const STRIDE: u32 = 256;

/// A triangle at the place and of the colour of a uniform.
struct Placed;

estampe::shader! {
    impl Shader for Placed {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, ()> {
            let [x, y, z, _] = input.bindings.f32s::<4>(0, 0, 0);
            let (x, y) = (at.x + input.real(x), at.y + input.real(y));
            VertexOut::new(Vec4::new(x, y, input.real(z), input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::color(Vec4::uniform(input.zero, input.bindings.f32s::<4>(0, 0, 16)))
        }
    }
}

/// A blue triangle where its vertices are.
struct Unplaced;

estampe::shader! {
    impl Shader for Unplaced {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, ()> {
            VertexOut::new(Vec4::new(at.x, at.y, input.real(0.5), input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::color(Vec4::uniform(input.zero, [0.0, 0.0, 1.0, 1.0]))
        }
    }
}

struct Objects {
    pipelines: [RenderPipeline; 2],
    /// Without bind groups.
    unbound: RenderPipeline,
    groups: [BindGroup; 2],
    vertices: [BufferSlice; 3],
    indices: BufferSlice,
    offsets: Vec<u32>,
    images: Images,
}

fn random(number: u32, k: u32) -> u32 {
    let hash = (number * 8 + k).wrapping_mul(0x9E37_79B9);
    (hash ^ hash >> 15).wrapping_mul(0x85EB_CA6B) >> 16
}

impl Objects {
    fn new(device: &Device) -> Self {
        let ty = BindingType::Buffer {
            ty: BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: 32,
        };
        let layout = [BindGroupLayoutEntry { binding: 0, ty }];
        let layout = device.create_bind_group_layout(&layout).unwrap();
        let pipeline = |cull_mode| {
            let mut descriptor = RenderPipelineDescriptor::new(Placed);
            descriptor.vertex_buffers =
                vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
            descriptor.bind_group_layouts = vec![layout.clone()];
            descriptor.primitive.cull_mode = cull_mode;
            device.create_render_pipeline(&descriptor).unwrap()
        };
        let mut unbound = RenderPipelineDescriptor::new(Unplaced);
        unbound.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
        let uniform = |number| {
            let unit = |k| random(number, k) as f32 / 65_536.0;
            let mut words = [0.0; STRIDE as usize / 4];
            words[..3].copy_from_slice(&[unit(0) * 2.0 - 1.0, unit(1) * 2.0 - 1.0, unit(2)]);
            words[4..8].copy_from_slice(&[3, 4, 5, 6].map(unit));
            words
        };
        let uniforms: Vec<f32> = (0..DRAWS).flat_map(uniform).collect();
        let uniforms = device
            .create_buffer_with_contents(bytes_of(&uniforms))
            .unwrap();
        let group = || {
            let slice = uniforms.slice(..u64::from(STRIDE));
            let descriptor = BindGroupDescriptor {
                label: None,
                layout: &layout,
                entries: &[(0, BindingResource::Buffer(slice))],
            };
            device.create_bind_group(&descriptor).unwrap()
        };
        let corners = [-0.1_f32, -0.1, 0.1, -0.1, 0.0, 0.2];
        let corners: Vec<f32> = [1.0, 0.5, -1.5]
            .iter()
            .flat_map(|size| corners.map(|at| at * size))
            .collect();
        let corners = device
            .create_buffer_with_contents(bytes_of(&corners))
            .unwrap();
        let indices = device.create_buffer_with_contents(bytes_of(&[2_u32, 0, 1]));
        Self {
            pipelines: [CullMode::None, CullMode::Back].map(pipeline),
            unbound: device.create_render_pipeline(&unbound).unwrap(),
            groups: [group(), group()],
            vertices: [0, 24, 48].map(|first| corners.slice(first..first + 24)),
            indices: indices.unwrap().slice(..),
            offsets: (0..DRAWS).map(|number| number * STRIDE).collect(),
            images: Images::new(device, 200, 150),
        }
    }

    /// Draws of which each has something of the one before, mostly.
    fn draws(&self) -> Vec<Draw<'_>> {
        let draw = |number: u32| {
            let of_run = number / 7;
            let vertices = &self.vertices[random(of_run, 0) as usize % 3];
            let is_indexed = random(of_run, 1).is_multiple_of(2);
            // Whole runs have the same bindings, or their draws have any, or none.
            let uniform = match random(of_run, 2) % 2 {
                0 => of_run,
                _ if random(number, 2).is_multiple_of(4) => of_run,
                _ => number,
            };
            let draw = Draw {
                vertex_buffers: std::slice::from_ref(vertices),
                index_buffer: is_indexed.then_some((&self.indices, IndexFormat::Uint32)),
                ..Draw::new(&self.unbound, 0..3)
            };
            if random(of_run, 5).is_multiple_of(4) {
                return draw;
            }
            Draw {
                pipeline: &self.pipelines[random(of_run, 4) as usize % 2],
                bind_groups: std::slice::from_ref(&self.groups[random(of_run, 3) as usize % 2]),
                dynamic_offsets: std::slice::from_ref(&self.offsets[uniform as usize]),
                ..draw
            }
        };
        (0..DRAWS).map(draw).collect()
    }

    fn render(
        &self,
        device: &Device,
        draws: &[Draw<'_>],
        is_first: bool,
    ) -> Result<u64, RenderPassError> {
        let (color, depth) = (self.images.color.view(), self.images.depth.view());
        let (color, depth) = if is_first {
            (
                ColorAttachment::clear(&color, [0.0; 4]),
                DepthStencilAttachment::clear(&depth, 1.0),
            )
        } else {
            (
                ColorAttachment::load(&color),
                DepthStencilAttachment::load(&depth),
            )
        };
        let pass = RenderPass {
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(depth),
            draws,
            ..RenderPass::default()
        };
        Ok(device.render(&pass)?.vertices_shaded)
    }
}

#[test]
fn the_image_is_that_of_passes_of_few_draws() {
    let mut first: Option<Vec<u8>> = None;
    for (name, device) in devices() {
        let objects = Objects::new(&device);
        let draws = objects.draws();
        // Twice, because memory is used again.
        for _ in 0..2 {
            let shaded = objects.render(&device, &draws, true).unwrap();
            assert_eq!(shaded, u64::from(DRAWS) * 3, "{name}");
        }
        let together = device.read_texture(&objects.images.color).unwrap();
        for (number, draws) in draws.chunks(FEW).enumerate() {
            objects.render(&device, draws, number == 0).unwrap();
        }
        let few = device.read_texture(&objects.images.color).unwrap();
        assert!(together == few, "{name}");
        assert!(together == *first.get_or_insert(few), "{name}");
    }
}

#[test]
fn the_first_draw_that_breaks_a_rule_is_named() {
    for (name, device) in devices() {
        let objects = Objects::new(&device);
        let of_draw = |draws: &[Draw<'_>]| objects.render(&device, draws, true).unwrap_err().kind;
        let mut draws = objects.draws();
        draws[1290].dynamic_offsets = &[1];
        draws[700].dynamic_offsets = &[3];
        let kind = of_draw(&draws);
        let is_named = matches!(kind, PassErrorKind::BindGroup { draw: 700, .. });
        assert!(is_named, "{name}: {kind:?}");
        // Rules of the core come after those of objects.
        draws[3].viewport = Some(Viewport::of_target(0, 0));
        let kind = of_draw(&draws);
        let is_named = matches!(kind, PassErrorKind::BindGroup { draw: 700, .. });
        assert!(is_named, "{name}: {kind:?}");
        let mut draws = objects.draws();
        draws[1201].occlusion_query = Some(0);
        draws[1200].viewport = Some(Viewport::of_target(0, 0));
        let message = of_draw(&draws).to_string();
        assert!(message.contains("draw 1200"), "{name}: {message}");
        // What was found of a pass that was refused is not taken for another one.
        let shaded = objects.render(&device, &objects.draws()[..5], true);
        assert_eq!(shaded.unwrap(), 15, "{name}");
    }
}
