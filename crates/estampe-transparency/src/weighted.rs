//! Weighted transparency: the sums of all fragments, in two float targets.

use crate::composite::composite;
use crate::{DepthOrder, Target, TransparencyError};
use estampe::state::{BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState};
use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Draw, FragmentOut, Real, RenderPass,
    Statistics, TextureFormat, Vec3, Vec4,
};

/// The format of the sums A.
const SUMS: TextureFormat = TextureFormat::Rgba32Float;
/// The format of the products B.
const REVEALAGE: TextureFormat = TextureFormat::R32Float;

/// The outputs of a fragment for [`blend_weighted`]: of a colour with alpha, not premultiplied, and
/// of the depth of its position in the window.
///
/// Colours beyond 0..=1 count as they are; clamp those that the picture would clamp.
#[inline(always)]
pub fn weighted_fragment<R: Real>(order: DepthOrder, color: Vec4<R>, depth: R) -> FragmentOut<R> {
    let near = order.nearness(depth);
    let Vec4 { x, y, z, w: alpha } = color;
    let weight = alpha * (near * near * near * 3e3).max(1e-2);
    let scale = alpha * weight;
    let sum = Vec4::new(x * scale, y * scale, z * scale, scale);
    FragmentOut::color(sum).with_color(1, Vec3::repeat(alpha).point())
}

/// The targets of pipelines whose fragments are those of [`weighted_fragment`].
#[must_use]
pub fn weighted_targets() -> Vec<Option<ColorTargetState>> {
    let product = BlendComponent {
        operation: BlendOperation::Add,
        src_factor: BlendFactor::Zero,
        dst_factor: BlendFactor::OneMinusSrc,
    };
    let product = BlendState {
        color: product,
        alpha: product,
    };
    let target = |format: TextureFormat, blend| {
        Some(ColorTargetState {
            blend: Some(blend),
            ..format.into()
        })
    };
    vec![
        target(SUMS, BlendState::ADDITIVE),
        target(REVEALAGE, product),
    ]
}

/// Blends draws by their weighted sums. Their pipelines have [`weighted_targets`] and test
/// [`DepthOrder::nearer`]; their order changes the rounding of the sums alone.
///
/// # Errors
/// [`TransparencyError`] if memory is short, or a draw does not fit the target.
pub fn blend_weighted(
    device: &Device,
    target: &Target<'_>,
    draws: &[Draw<'_>],
) -> Result<Statistics, TransparencyError> {
    let texture = |format| device.create_texture(&target.texture_like(format));
    let (sums, revealage) = (texture(SUMS)?, texture(REVEALAGE)?);
    let mut statistics = device.render(&RenderPass {
        color_attachments: &[
            Some(ColorAttachment::clear(&sums.view(), [0.0; 4])),
            Some(ColorAttachment::clear(&revealage.view(), [1.0; 4])),
        ],
        depth_stencil_attachment: Some(DepthStencilAttachment::read_only(&target.depth.view())),
        draws,
        ..RenderPass::default()
    })?;
    statistics += composite(device, target, &sums, &revealage)?;
    Ok(statistics)
}
