//! Running a pass for one pixel.

use super::history::PixelHistory;
use super::initial;
use super::oracle_draw::{OracleDraw, with_draw};
use super::record::{Recorder, values};
use crate::pass::{Attachments, PassErrorKind, core_pass, prepared};
use crate::{Device, RenderPass, RenderPassError};
use estampe_reference::{PixelBounds, StoredSample, Target, color, draw_observed};
use estampe_types::TextureFormat;

/// The reason why a pixel cannot be inspected.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InspectError {
    /// The pass is one that [`Device::render`] refuses too.
    #[error(transparent)]
    Pass(#[from] RenderPassError),
    /// The pixel lies outside of the attachments.
    #[error(
        "pixel {x},{y} lies outside of the {width}x{height} pixels of the pass: columns and \
             rows count from 0 at the top left"
    )]
    Outside {
        /// The column.
        x: u32,
        /// The row.
        y: u32,
        /// Columns of the pass.
        width: u32,
        /// Rows of the pass.
        height: u32,
    },
    /// A draw's pipeline has stages that inspecting does not follow yet.
    #[error(
        "draw {draw} has a tessellation or geometry shader, which inspecting does not follow: \
             leave the draw out, or inspect the primitives drawn plainly"
    )]
    Amplified {
        /// The number of the draw.
        draw: usize,
    },
    /// All pixels are drawn, for every stage of a pass or because its shaders store, and what is
    /// written down needs too much memory.
    #[error(
        "every pixel of the pass is drawn, and {bytes} bytes for that are more than {limit}: \
             inspect a smaller picture, or fewer primitives"
    )]
    TooLarge {
        /// The bytes that are needed.
        bytes: u64,
        /// The limit.
        limit: u64,
    },
}

/// The most bytes of the oracle's target, and of what is written down of all pixels.
pub(super) const MAX_BYTES: u64 = 1 << 30;

/// Runs a pass with the oracle, and writes down what happens to a pixel.
pub(crate) fn inspect(
    device: &Device,
    pass: &RenderPass<'_>,
    pixel: [u32; 2],
) -> Result<PixelHistory, InspectError> {
    prepared(device, pass, |attachments, data| {
        let draws = data.draws(pass.draws);
        let core_pass = core_pass(pass, attachments.loads(), &draws);
        let checked = attachments.with_shape(|shape| core_pass.check(shape));
        checked.map_err(|error| refused(pass, error.into()))?;
        let stored = stored_part(attachments, pass, pixel)?;
        check_stages(pass)?;
        let target = initial::target(device.context(), attachments, stored);
        let mut target = target.map_err(|kind| refused(pass, kind))?;
        Ok(history(device, attachments, &draws, &mut target, pixel))
    })
    .map_err(|kind| refused(pass, kind))?
}

/// Refuses draws with stages that are not followed.
pub(super) fn check_stages(pass: &RenderPass<'_>) -> Result<(), InspectError> {
    let is_amplified = |draw: &crate::Draw<'_>| {
        let descriptor = draw.pipeline.descriptor();
        descriptor.tessellation.is_some()
            || descriptor.geometry.is_some()
            || descriptor.vertex_program.is_some()
    };
    match pass.draws.iter().position(is_amplified) {
        Some(draw) => Err(InspectError::Amplified { draw }),
        None => Ok(()),
    }
}

/// The bytes of the oracle's target, if all pixels are stored.
pub(super) fn target_bytes(attachments: &Attachments<'_>) -> u64 {
    let (width, height) = (attachments.size.width, attachments.size.height);
    let samples = u64::from(width) * u64::from(height) * u64::from(attachments.size.samples);
    samples * (16 * attachments.formats.len() as u64 + 5)
}

pub(super) fn refused(pass: &RenderPass<'_>, kind: PassErrorKind) -> RenderPassError {
    RenderPassError {
        pass: pass.label.map(str::to_owned),
        kind,
    }
}

/// The pixels that are drawn: the quad of the pixel, or all where shaders may read what others
/// store.
fn stored_part(
    attachments: &Attachments<'_>,
    pass: &RenderPass<'_>,
    [x, y]: [u32; 2],
) -> Result<PixelBounds, InspectError> {
    let (width, height) = (attachments.size.width, attachments.size.height);
    if x >= width || y >= height {
        return Err(InspectError::Outside {
            x,
            y,
            width,
            height,
        });
    }
    if !pass.draws.iter().any(|draw| draw.pipeline.stores()) {
        return Ok(PixelBounds {
            x: x & !1..((x & !1) + 2).min(width),
            y: y & !1..((y & !1) + 2).min(height),
        });
    }
    let bytes = target_bytes(attachments);
    if bytes > MAX_BYTES {
        return Err(InspectError::TooLarge {
            bytes,
            limit: MAX_BYTES,
        });
    }
    Ok(PixelBounds {
        x: 0..width,
        y: 0..height,
    })
}

fn history(
    device: &Device,
    attachments: &Attachments<'_>,
    draws: &[estampe_core::Draw<'_>],
    target: &mut Target,
    pixel: [u32; 2],
) -> PixelHistory {
    let formats = &attachments.formats[..];
    let stored = |target: &Target| -> Vec<StoredSample> {
        let samples = 0..target.samples;
        let samples = samples.map(|sample| target.sample(target.index(pixel, sample)));
        samples.collect()
    };
    let all_values = |target: &Target| {
        let stored = stored(target);
        stored.iter().map(|one| values(formats, one)).collect()
    };
    let initial = all_values(target);
    let mut primitives = Vec::new();
    for (number, draw) in draws.iter().enumerate() {
        let place = (pixel, target.samples);
        let drawn = with_draw(device, draw, target, |target, oracle| {
            let reached = oracle.bounds(target).intersection(target.stored());
            if reached.x.is_empty() || reached.y.is_empty() {
                return Vec::new();
            }
            let OracleDraw {
                shaders,
                state,
                draw,
            } = *oracle;
            let mut recorder = Recorder::new(place, number, draw, shaders, formats);
            draw_observed(target, shaders, state, draw, &mut recorder);
            recorder.primitives
        });
        primitives.extend(drawn);
    }
    let samples = stored(target);
    let texel = |(at, format): (usize, &Option<TextureFormat>)| {
        let format = (*format)?;
        let codes: Vec<_> = samples.iter().map(|sample| sample.colors[at]).collect();
        let codes = match &codes[..] {
            [one] => *one,
            several => color::resolve(format, several),
        };
        Some(color::bytes(format, codes))
    };
    PixelHistory {
        pixel,
        initial,
        primitives,
        last: all_values(target),
        texels: formats.iter().enumerate().map(texel).collect(),
    }
}
