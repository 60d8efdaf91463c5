//! Per-sample operations on one sample at a time: depth bounds, stencil, depth, then colour.
//!
//! In · Out: a fragment's sample · the target's stored values. Precision: f32 in the order of
//! NUMERICS.md, *Per-sample operations*: steps 5 to 9; [`kept_samples`] is steps 3 and 4.

use crate::arithmetic::clamp;
use crate::blending::{BlendInputs, blend};
use crate::channel::{Channel, channels};
use crate::color::{self, Codes};
use crate::cull::Face;
use crate::fragment::Fragment;
use crate::{State, Target, TargetState, compare, logic, stencil};
use estampe_types::TextureFormat;
use estampe_types::state::ColorWrites;

/// The samples of its pixel that a fragment keeps: its sample mask and alpha to coverage.
#[must_use]
pub fn kept_samples(fragment: &Fragment, state: &State, target: &Target) -> u16 {
    let mut kept = fragment.sample_mask;
    if let (true, Some(format)) = (state.alpha_to_coverage, target.color_formats.first())
        && format.is_blendable()
    {
        kept &= alpha_coverage(fragment.colors[0][3], target.samples);
    }
    kept
}

/// Alpha to coverage: the first ⌊alpha·N + ½⌋ of N samples; alpha is clamped to 0..=1, NaN counts
/// as 0.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "within 0..=16"
)]
pub fn alpha_coverage(alpha: f32, samples: u32) -> u16 {
    let count = (clamp(alpha, 0.0, 1.0) * samples as f32 + 0.5).floor() as u32;
    (0..count).fold(0, |mask, sample| mask | 1 << sample)
}

/// The test that a sample of a fragment failed, in the order of the tests, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The stored depth lies outside of the depth bounds.
    DepthBounds,
    /// The stencil test failed.
    Stencil,
    /// The stencil test passed, and the depth test failed.
    Depth,
    /// Every test passed; depth and colours were stored.
    Passed,
}

/// Tests one sample of a fragment, and stores its results. `index` is the sample's element in the
/// attachments, see [`Target::index`].
pub fn store_sample(
    target: &mut Target,
    index: usize,
    state: &State,
    face: Face,
    depth: f32,
    fragment: &Fragment,
) -> Outcome {
    let has_depth = !target.depth.is_empty();
    let has_stencil = !target.stencil.is_empty();

    if let (Some([least, greatest]), true) = (state.depth_bounds, has_depth) {
        let stored = target.depth[index];
        if !(least <= stored && stored <= greatest) {
            return Outcome::DepthBounds;
        }
    }

    let depth = target.quantised(depth);
    let depth_passes = match state.depth {
        Some(test) if has_depth => compare::passes(test.compare, depth, target.depth[index]),
        _ => true,
    };
    let stencil_passes = match &state.stencil {
        Some(test) if has_stencil => {
            let (side, reference) = match face {
                Face::Front => (&test.front, state.stencil_reference[0]),
                Face::Back => (&test.back, state.stencil_reference[1]),
            };
            let stored = target.stencil[index];
            let passes = stencil::passes(side, reference, stored);
            target.stencil[index] = stencil::updated(side, reference, stored, passes, depth_passes);
            passes
        }
        _ => true,
    };
    if !stencil_passes {
        return Outcome::Stencil;
    }
    if !depth_passes {
        return Outcome::Depth;
    }
    if has_depth && state.depth.is_some_and(|test| test.write_enabled) {
        target.depth[index] = depth;
    }
    for attachment in 0..target.color_formats.len() {
        store_color(target, attachment, index, state, fragment);
    }
    Outcome::Passed
}

fn store_color(
    target: &mut Target,
    attachment: usize,
    index: usize,
    state: &State,
    fragment: &Fragment,
) {
    // An attachment for which the shader writes no colour keeps its value.
    let Some(&source) = fragment.colors.get(attachment) else {
        return;
    };
    let of_target = state.targets.get(attachment).copied().unwrap_or_default();
    let format = target.color_formats[attachment];
    let at = attachment * target.len() + index;
    let stored = target.color[at];
    let new = combined(format, state, of_target, fragment, source, stored);
    target.color[at] = masked(of_target.write_mask, new, stored);
}

/// The new codes of an attachment: by a logic operation, by blending, or the source's own.
fn combined(
    format: TextureFormat,
    state: &State,
    of_target: TargetState,
    fragment: &Fragment,
    source: [f32; 4],
    stored: Codes,
) -> Codes {
    let channels = channels(format);
    if let Some(operation) = state.logic_operation {
        let new = color::encode(format, source);
        if !logic::concerns(channels[0]) {
            return new;
        }
        return std::array::from_fn(|k| {
            channels[k].cut(logic::combine(operation, new[k], stored[k]))
        });
    }
    match of_target.blend {
        Some(blend_state) if format.is_blendable() => {
            let confined = |color: [f32; 4]| confined(channels, color);
            let inputs = BlendInputs {
                source: confined(source),
                second: confined(fragment.second),
                constant: confined(state.blend_constant),
                destination: color::decode(format, stored),
            };
            color::encode(format, blend(&blend_state, &inputs))
        }
        _ => color::encode(format, source),
    }
}

/// A colour clamped to the range of the format's channels. A channel that the format lacks is
/// clamped as red is, because alpha is a factor in formats without alpha too.
fn confined(channels: [Channel; 4], color: [f32; 4]) -> [f32; 4] {
    std::array::from_fn(|k| match channels[k] {
        Channel::Missing(_) => channels[0].confine(color[k]),
        channel => channel.confine(color[k]),
    })
}

/// The new codes in the channels of the write mask, the stored codes in the others.
#[must_use]
pub fn masked(mask: ColorWrites, new: Codes, stored: Codes) -> Codes {
    std::array::from_fn(|channel| {
        if mask.0 >> channel & 1 == 1 {
            new[channel]
        } else {
            stored[channel]
        }
    })
}
