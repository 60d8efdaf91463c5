//! Running a pass for one pixel.

use super::history::PixelHistory;
use super::initial;
use super::record::{Recorder, values};
use crate::pass::{Attachments, PassErrorKind, core_pass, prepared};
use crate::{Device, RenderPass, RenderPassError};
use estampe_reference::program::ProgramShaders;
use estampe_reference::{
    Draw, PixelBounds, State, StoredSample, Target, TargetState, color, draw_observed,
};
use estampe_types::state::{DepthStencilState, VertexBufferLayout};
use estampe_types::{Bindings, BufferData, TextureFormat};

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
    /// A draw's pipeline has stages that the history does not follow yet.
    #[error(
        "draw {draw} has a tessellation or geometry shader, which the history of a pixel does \
             not follow: leave the draw out, or inspect the primitives drawn plainly"
    )]
    Amplified {
        /// The number of the draw.
        draw: usize,
    },
    /// The pass has shaders that store, so that all of its pixels are drawn, and these need too
    /// much memory.
    #[error(
        "its shaders store, so that every pixel is drawn for the history of one; {bytes} bytes \
             for that are more than {limit}: inspect a smaller picture"
    )]
    TooLarge {
        /// The bytes that are needed.
        bytes: u64,
        /// The limit.
        limit: u64,
    },
}

/// The most bytes of the oracle's target.
const MAX_TARGET: u64 = 1 << 30;

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
        let is_amplified = |draw: &crate::Draw<'_>| {
            let descriptor = draw.pipeline.descriptor();
            descriptor.tessellation.is_some()
                || descriptor.geometry.is_some()
                || descriptor.vertex_program.is_some()
        };
        if let Some(draw) = pass.draws.iter().position(is_amplified) {
            return Err(InspectError::Amplified { draw });
        }
        let target = initial::target(device.context(), attachments, stored);
        let mut target = target.map_err(|kind| refused(pass, kind))?;
        Ok(history(device, attachments, &draws, &mut target, pixel))
    })
    .map_err(|kind| refused(pass, kind))?
}

fn refused(pass: &RenderPass<'_>, kind: PassErrorKind) -> RenderPassError {
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
    let samples = u64::from(width) * u64::from(height) * u64::from(attachments.size.samples);
    let bytes = samples * (16 * attachments.formats.len() as u64 + 5);
    if bytes > MAX_TARGET {
        return Err(InspectError::TooLarge {
            bytes,
            limit: MAX_TARGET,
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
        let state = state(draw, target);
        let descriptor = draw.pipeline.descriptor();
        let shaders = ProgramShaders::new(&*descriptor.program, device.level());
        let layouts = descriptor.vertex_buffers.iter().enumerate();
        let buffers: Vec<(VertexBufferLayout, BufferData)> = layouts
            .map(|(at, layout)| {
                let buffer = draw.vertex_buffers.get(at).cloned();
                (
                    layout.clone(),
                    buffer.unwrap_or_else(|| BufferData::from_bytes(&[])),
                )
            })
            .collect();
        let no_bindings = Bindings::default();
        let command = Draw {
            buffers: &buffers,
            indices: draw.indices.map(|(buffer, format)| (format, buffer)),
            vertices: draw.elements.clone(),
            instances: draw.instances.clone(),
            base_vertex: draw.base_vertex,
            bindings: draw.bindings.unwrap_or(&no_bindings),
        };
        let place = (pixel, target.samples);
        let mut recorder = Recorder::new(place, number, &command, &shaders, formats);
        draw_observed(target, &shaders, &state, &command, &mut recorder);
        primitives.append(&mut recorder.primitives);
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

/// The state of a draw, as the oracle names it.
fn state(draw: &estampe_core::Draw<'_>, target: &Target) -> State {
    let descriptor = draw.pipeline.descriptor();
    let whole = State::new(target.width, target.height);
    let tests = descriptor.depth_stencil;
    let targets = descriptor.targets.iter().map(|target| {
        target.map_or_else(TargetState::default, |target| TargetState {
            blend: target.blend,
            write_mask: target.write_mask,
        })
    });
    State {
        primitive: descriptor.primitive,
        depth: tests.map(|tests| tests.depth()),
        depth_bias: tests.map_or_else(Default::default, |tests: DepthStencilState| tests.bias),
        depth_bias_unit: match target.depth_stencil {
            Some(TextureFormat::Depth16Unorm) => Some(1.0 / 65_536.0),
            Some(TextureFormat::Depth24Plus | TextureFormat::Depth24PlusStencil8) => {
                Some(1.0 / 16_777_216.0)
            }
            _ => None,
        },
        stencil: tests.and_then(|tests| tests.stencil),
        stencil_reference: draw.stencil_reference,
        depth_bounds: draw.depth_bounds,
        sample_mask: descriptor.multisample.mask,
        alpha_to_coverage: descriptor.multisample.alpha_to_coverage_enabled,
        sample_shading: descriptor.multisample.sample_shading_enabled,
        logic_operation: descriptor.logic_operation,
        targets: targets.collect(),
        blend_constant: draw.blend_constant,
        viewport: draw.viewport.unwrap_or(whole.viewport),
        scissor: draw.scissor.unwrap_or(whole.scissor),
    }
}
