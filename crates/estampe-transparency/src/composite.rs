//! The composition of weighted sums: C = A_rgb/A_α · (1 − B) + C_opaque·B.

use crate::{Target, TransparencyError};
use estampe::state::{BlendState, ColorTargetState, MultisampleState};
use estampe::{
    BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType, Bindings,
    ColorAttachment, Device, Draw, FragmentIn, FragmentOut, Int, Real, RenderPass,
    RenderPipelineDescriptor, SampleType, Statistics, Texture, TextureBindings, Vec4, VertexIn,
    VertexOut, ViewDimension,
};

/// The least divisor: the weights of one far and nearly clear fragment may be tiny.
const LEAST_SUM: f32 = 1e-12;

/// A triangle over the whole target, which reads the sums.
struct Composite {
    is_multisampled: bool,
}

estampe::shader! {
    impl Shader for Composite {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            // The triangle (−1, 1), (3, 1), (−1, −3) covers the whole viewport.
            let index = input.vertex_index;
            let x = (index & index.splat(1)).to_real() * 4.0 - 1.0;
            let y = 1.0 - (index >> 1).to_real() * 4.0;
            VertexOut::new(Vec4::new(x, y, input.zero, input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let [x, y] = [input.position.x.to_int(), input.position.y.to_int()];
            let zero = x.splat(0);
            let sample = if self.is_multisampled { input.sample_index } else { zero };
            let at = ([x, y, zero], sample);
            let sum = texel::<R>(input.bindings, 0, at);
            let revealage = texel::<R>(input.bindings, 1, at).x;
            let alpha = -revealage + 1.0;
            let scale = alpha / sum.w.max(LEAST_SUM);
            let color = Vec4::new(sum.x * scale, sum.y * scale, sum.z * scale, alpha);
            // Where there is no fragment, the picture keeps its bits.
            FragmentOut::color(color).discard_unless(revealage.lt(1.0))
        }
    }
}

/// A texel of the base level of a texture of group 0.
#[inline(always)]
fn texel<R: Real>(
    bindings: &Bindings,
    binding: u32,
    (at, sample): ([R::Int; 3], R::Int),
) -> Vec4<R> {
    let zero = sample.splat(0);
    bindings.texture(0, binding).fetch(at, zero, sample)
}

/// Draws the composition over the picture.
pub(crate) fn composite(
    device: &Device,
    target: &Target<'_>,
    sums: &Texture,
    revealage: &Texture,
) -> Result<Statistics, TransparencyError> {
    let is_multisampled = target.is_multisampled();
    let entry = |binding| BindGroupLayoutEntry {
        binding,
        ty: BindingType::Texture {
            sample_type: SampleType::Float,
            view_dimension: ViewDimension::D2,
            multisampled: is_multisampled,
        },
    };
    let layout = device.create_bind_group_layout(&[entry(0), entry(1)])?;
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[
            (0, BindingResource::Texture(sums.view())),
            (1, BindingResource::Texture(revealage.view())),
        ],
    })?;
    let blended = ColorTargetState {
        blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        ..target.color.format().into()
    };
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![layout],
        targets: vec![Some(blended)],
        depth_stencil: None,
        multisample: MultisampleState::new(target.color.sample_count()),
        ..RenderPipelineDescriptor::new(Composite { is_multisampled })
    })?;
    Ok(device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::load(&target.color.view()))],
        draws: &[Draw {
            bind_groups: &[group],
            ..Draw::new(&pipeline, 0..3)
        }],
        ..RenderPass::default()
    })?)
}
