//! Passes that sample one image and render to another.

use super::covering;
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry, BindingResource,
    BindingType, ColorAttachment, Coordinates, Device, Draw, FragmentIn, FragmentOut, Lod,
    RenderPass, RenderPipeline, RenderPipelineDescriptor, SampleType, SamplerDescriptor,
    TextureBindings, TextureFormat, TextureView, Vec2, Vec4, VertexIn, VertexOut, ViewDimension,
};

/// Colours in a 2D texture.
pub(crate) const FLAT: (SampleType, ViewDimension) = (SampleType::Float, ViewDimension::D2);

/// Samples binding 0 from right to left, and turns the channels round: the green becomes the red.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turned;

estampe::shader! {
    impl Shader for Turned {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, Vec2<R>> {
            let at: Vec2<R> = covering(&input);
            let uv = Vec2::new(at.x * -0.5 + 0.5, at.y * -0.5 + 0.5);
            VertexOut::new(Vec4::new(at.x, at.y, input.zero, input.real(1.0)), uv)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, uv: Vec2<R>) -> FragmentOut<R> {
            let texture = input.bindings.sampled_texture(0, 0);
            let color = texture.sample_with(Coordinates::d2(uv), Lod::Level(input.zero), [0; 3]);
            FragmentOut::color(Vec4::new(color.y, color.z, color.x, color.w))
        }
    }
}

/// A pipeline of a shader that reads one texture with its sampler, for colours of a format, and the
/// layout of its bind group.
pub(crate) fn sampling_pipeline(
    device: &Device,
    shader: impl estampe::Shader,
    (sample_type, view_dimension): (SampleType, ViewDimension),
    format: TextureFormat,
) -> (BindGroupLayout, RenderPipeline) {
    let layout = device
        .create_bind_group_layout(&[BindGroupLayoutEntry {
            binding: 0,
            ty: BindingType::SampledTexture {
                sample_type,
                view_dimension,
            },
        }])
        .unwrap();
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor {
            bind_group_layouts: vec![layout.clone()],
            depth_stencil: None,
            targets: vec![format.into()],
            ..RenderPipelineDescriptor::new(shader)
        })
        .unwrap();
    (layout, pipeline)
}

/// A bind group of a view and the default sampler.
pub(crate) fn sampled_group(
    device: &Device,
    layout: &BindGroupLayout,
    view: &TextureView,
) -> BindGroup {
    let sampler = device
        .create_sampler(&SamplerDescriptor::default())
        .unwrap();
    device
        .create_bind_group(&BindGroupDescriptor {
            label: None,
            layout,
            entries: &[(0, BindingResource::SampledTexture(view.clone(), sampler))],
        })
        .unwrap()
}

/// Draws a triangle over a view, which reads another one.
pub(crate) fn draw_over(
    device: &Device,
    pipeline: &RenderPipeline,
    group: &BindGroup,
    into: &TextureView,
) {
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::load(into))],
            draws: &[Draw {
                bind_groups: std::slice::from_ref(group),
                ..Draw::new(pipeline, 0..3)
            }],
            ..RenderPass::default()
        })
        .unwrap();
}

/// The result of [`Turned`] for RGBA or BGRA bytes, in the size of another image.
pub(crate) fn turned(bytes: &[u8], from: [u32; 2], into: [u32; 2], is_bgra: bool) -> Vec<u8> {
    let [width, height] = into;
    let mut turned = Vec::new();
    for y in 0..height {
        for x in 0..width {
            // Pixel centres, from the right.
            let column = (2 * (width - x) - 1) * from[0] / (2 * width);
            let row = (2 * y + 1) * from[1] / (2 * height);
            let at = (row * from[0] + column) as usize * 4;
            let mut texel: [u8; 4] = bytes[at..at + 4].try_into().unwrap();
            if is_bgra {
                texel.swap(0, 2);
            }
            texel[..3].rotate_left(1);
            if is_bgra {
                texel.swap(0, 2);
            }
            turned.extend(texel);
        }
    }
    turned
}
