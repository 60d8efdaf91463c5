//! Draws that share packets and bins: a pass of many small draws gives the image of one pass for
//! each of them.

use estampe_core::{
    ColorTexels, Context, DepthStencilTexels, Draw, DrawList, ImageSize, LoadOp, RenderPass,
    RenderPipeline, RenderPipelineDescriptor, RenderTarget, row_order_words,
};
use estampe_simd::Level;
use estampe_types::shader::VertexOut;
use estampe_types::state::{MultisampleState, VertexAttribute, VertexBufferLayout};
use estampe_types::{
    Bindings, BoundGroup, BoundResource, BoundResources, BufferData, FragmentIn, FragmentOut,
    Limits, Real, TextureFormat, Vec4, VertexFormat, VertexIn,
};
use std::sync::Arc;

const DRAWS: u32 = 150;

/// One colour for each draw.
struct Bound;
/// Another colour for each side.
struct Sided;
/// A colour that varies.
struct Varying;

fn color<R: Real>(input: &FragmentIn<'_, R>) -> Vec4<R> {
    Vec4::uniform(input.zero, input.bindings.f32s::<4>(0, 0, 0))
}

estampe_types::shader! {
    impl Shader for Bound {
        type Attributes<R: Real> = Vec4<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, position: Vec4<R>) -> VertexOut<R, ()> {
            VertexOut::new(position, ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::color(color(&input))
        }
    }
}

estampe_types::shader! {
    impl Shader for Sided {
        type Attributes<R: Real> = Vec4<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, position: Vec4<R>) -> VertexOut<R, ()> {
            VertexOut::new(position, ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let color = color(&input);
            let red = R::select(input.front_facing, color.x, color.y);
            FragmentOut::color(Vec4::new(red, color.y, color.z, color.w))
        }
    }
}

estampe_types::shader! {
    impl Shader for Varying {
        type Attributes<R: Real> = Vec4<R>;
        type Varyings<R: Real> = Vec4<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec4<R>) -> VertexOut<R, Vec4<R>> {
            VertexOut::new(at, at)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, at: Vec4<R>) -> FragmentOut<R> {
            let color = color(&input);
            let slope = at.x.ddx();
            FragmentOut::color(Vec4::new(color.x, color.y + slope, at.y, at.z))
        }
    }
}

/// Positions of one to some dozen triangles, small and large; some leave the view volume.
fn triangles(random: &mut impl FnMut() -> f32) -> Vec<f32> {
    let mut positions = Vec::new();
    while positions.is_empty() || random() < 0.85 {
        let size = if random() < 0.1 { 2.0 } else { 0.1 };
        let center = [0; 3].map(|_| random() * 2.0 - 1.0);
        let w = if random() < 0.1 { 0.3 } else { 1.0 };
        for _ in 0..3 {
            let [x, y, z] = center.map(|at| at + (random() - 0.5) * size);
            positions.extend([x, y, z * 0.6 + 0.5, w + (random() - 0.5) * (1.0 - w)]);
        }
    }
    positions
}

fn check(descriptor: RenderPipelineDescriptor, samples: u32) {
    let layout = VertexBufferLayout {
        array_stride: 16,
        attributes: vec![VertexAttribute {
            format: VertexFormat::Float32x4,
            offset: 0,
            shader_location: 0,
        }],
        ..VertexBufferLayout::default()
    };
    let descriptor = RenderPipelineDescriptor {
        vertex_buffers: vec![layout],
        multisample: MultisampleState::new(samples),
        ..descriptor
    };
    let pipeline = RenderPipeline::new(&descriptor, &Limits::default()).unwrap();
    let mut state = 5u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 16_777_216.0
    };
    let resources: Vec<_> = (0..DRAWS)
        .map(|_| {
            let positions = triangles(&mut random);
            let vertices = u32::try_from(positions.len() / 4).unwrap();
            let binding = BoundResource::Buffer {
                buffer: BufferData::from_f32s(&[0; 4].map(|_| random())),
                offset: 0,
                size: u32::MAX,
                dynamic_offset: None,
            };
            let group = BoundResources {
                entries: vec![(0, binding)],
            };
            let bindings = Bindings {
                groups: vec![BoundGroup {
                    group: Arc::new(group),
                    ..BoundGroup::default()
                }],
                ..Bindings::default()
            };
            ([BufferData::from_f32s(&positions)], bindings, vertices)
        })
        .collect();
    let draws: Vec<_> = resources
        .iter()
        .map(|(buffers, bindings, vertices)| Draw {
            vertex_buffers: buffers,
            bindings: Some(bindings),
            ..Draw::new(&pipeline, 0..*vertices)
        })
        .collect();
    let [mut together, mut one_by_one] = [0, 1].map(|_| target(samples));
    let context = Context::new(1, Level::best()).unwrap();
    let pass = RenderPass {
        draws: DrawList::from(&draws[..]),
        ..RenderPass::default()
    };
    context.render(&mut together, &pass).unwrap();
    for (number, draw) in draws.iter().enumerate() {
        let mut pass = RenderPass {
            draws: DrawList::from(std::slice::from_ref(draw)),
            ..RenderPass::default()
        };
        if number > 0 {
            pass.load_colors = vec![LoadOp::Load];
            pass.load_depth = LoadOp::Load;
        }
        context.render(&mut one_by_one, &pass).unwrap();
    }
    let [together, one_by_one] =
        [together, one_by_one].map(|target| colors(&context, target, samples));
    for sample in 0..samples as usize {
        let mut words = together.iter().skip(sample).step_by(samples as usize);
        assert!(words.any(|word| *word != 0), "sample {sample}");
    }
    assert!(together == one_by_one, "{samples} samples");
}

fn size(samples: u32) -> ImageSize {
    ImageSize {
        width: 150,
        height: 100,
        samples,
    }
}

/// A target of zeros, of the formats that a pipeline has by default.
fn target(samples: u32) -> RenderTarget {
    let size = size(samples);
    let color = ColorTexels::zeros(TextureFormat::Rgba8Unorm, size).unwrap();
    let depth = DepthStencilTexels::zeros(TextureFormat::Depth32Float, size).unwrap();
    RenderTarget::of_images(size, vec![color], Some(depth))
}

/// The colours of all samples: those of a pixel follow each other.
fn colors(context: &Context, target: RenderTarget, samples: u32) -> Vec<u32> {
    let texels = &target.into_images().0[0];
    let mut words = vec![0; row_order_words(texels.format(), size(samples))];
    context.color_to_rows(texels, &mut words);
    words
}

#[test]
fn many_draws_in_a_pass_give_the_image_of_a_pass_for_each() {
    for samples in [1, 4] {
        check(RenderPipelineDescriptor::new(Bound), samples);
        check(RenderPipelineDescriptor::new(Sided), samples);
        check(RenderPipelineDescriptor::new(Varying), samples);
    }
}
