//! The oracle's image of a case.

use crate::case::{Case, CaseDraw};
use crate::readback::{self, Stored};
use estampe_reference::{Counts, Draw, State, Target, TargetState, color};
use estampe_types::TextureFormat;

/// The results that must agree.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// The number of pixels.
    pub pixels: usize,
    /// RGBA, rows from the top, resolved; empty without a colour attachment.
    pub color: Vec<u8>,
    /// The bits of the first sample's depths, rows from the top.
    pub depth: Vec<u32>,
    /// The contents of every sample of every attachment: see [`readback`].
    pub stored: Stored,
    /// Assembled primitives of all draws.
    pub primitives: u64,
    /// The number of passed samples of each draw that counts them, in order.
    pub counts: Vec<u64>,
}

/// Draws a case.
#[must_use]
pub fn draw(case: &Case) -> Image {
    let [width, height] = case.size;
    let (target, counts, primitives) = drawn(case);
    let color = match case.format {
        Some(format) if readback::is_read_as_color(format) => {
            let texels = target.resolve(0).into_iter();
            texels
                .flat_map(|codes| color::bytes(format, codes))
                .collect()
        }
        _ => Vec::new(),
    };
    let first_samples = target.depth.iter().step_by(case.samples as usize);
    Image {
        pixels: width as usize * height as usize,
        color,
        depth: first_samples.map(|depth| depth.to_bits()).collect(),
        stored: stored(&target),
        primitives,
        counts,
    }
}

/// The target after a case was drawn.
#[must_use]
pub fn target(case: &Case) -> Target {
    drawn(case).0
}

/// The target, the sample counts of the draws that count, and the primitives of all draws.
fn drawn(case: &Case) -> (Target, Vec<u64>, u64) {
    let formats = case.formats();
    let mut target =
        Target::with_attachments(case.size, case.samples, &formats, case.depth_stencil);
    target.clear(case.clear_color, case.clear_depth);
    target.clear_stencil(case.clear_stencil);
    let (mut counts, mut primitives) = (Vec::new(), 0);
    for draw in &case.draws {
        let drawn = draw_one(&mut target, draw, case);
        primitives += drawn.primitives;
        if draw.is_counted {
            counts.push(drawn.samples_passed);
        }
    }
    (target, counts, primitives)
}

/// Every sample of every attachment.
fn stored(target: &Target) -> Stored {
    let attachments = 0..target.color_formats.len();
    let samples = target.samples;
    let of_sample = |sample: u32| {
        let stored = target.depth.iter().skip(sample as usize);
        stored.step_by(samples as usize)
    };
    let resolved = |attachment: usize| {
        let format = target.color_formats[attachment];
        let codes = target.resolve(attachment).into_iter();
        codes
            .flat_map(|codes| color::bytes(format, codes))
            .collect()
    };
    Stored {
        texels: attachments
            .clone()
            .flat_map(|attachment| (0..samples).map(move |s| target.texels(attachment, s)))
            .collect(),
        resolved: attachments.filter(|_| samples > 1).map(resolved).collect(),
        depths: (0..samples)
            .map(|s| of_sample(s).map(|depth| depth.to_bits()).collect())
            .collect(),
        stencils: (0..samples)
            .map(|s| {
                let stored = target.stencil.iter().skip(s as usize);
                stored.step_by(samples as usize).copied().collect()
            })
            .collect(),
    }
}

/// Executes one draw of a case.
pub(crate) fn draw_one(target: &mut Target, draw: &CaseDraw, case: &Case) -> Counts {
    let attachments = case.formats().len();
    let whole = State::new(target.width, target.height);
    let depth_bias_unit = match case.depth_stencil {
        Some(TextureFormat::Depth16Unorm) => Some(1.0 / 65_536.0),
        Some(TextureFormat::Depth24Plus | TextureFormat::Depth24PlusStencil8) => {
            Some(1.0 / 16_777_216.0)
        }
        _ => None,
    };
    let state = State {
        primitive: draw.primitive,
        depth: draw.depth,
        stencil: draw.stencil,
        stencil_reference: draw.stencil_reference,
        depth_bounds: draw.depth_bounds,
        sample_mask: draw.sample_mask,
        alpha_to_coverage: draw.alpha_to_coverage,
        sample_shading: draw.sample_shading,
        logic_operation: draw.logic_operation,
        targets: (0..attachments)
            .map(|attachment| {
                let (blend, write_mask) = draw.target(attachment);
                TargetState { blend, write_mask }
            })
            .collect(),
        depth_bias: draw.depth_bias,
        depth_bias_unit,
        blend_constant: draw.blend_constant,
        viewport: draw.viewport.unwrap_or(whole.viewport),
        scissor: draw.scissor.unwrap_or(whole.scissor),
    };
    let indices = draw.indices.as_ref();
    let command = Draw {
        buffers: &draw.buffers,
        indices: indices.map(|(format, buffer)| (*format, buffer)),
        vertices: draw.elements.clone(),
        instances: draw.instances.clone(),
        base_vertex: draw.base_vertex,
        bindings: &draw.bindings,
    };
    draw.shader.draw_oracle(target, &state, &command)
}
