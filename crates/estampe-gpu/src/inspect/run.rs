//! Running a pass for one pixel.

use super::amplified::draw_amplified;
use super::history::{PixelHistory, PrimitiveRecord, SampleValues};
use super::initial;
use super::oracle_draw::{OracleDraw, TargetShape, with_draw};
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
    /// The pass has fewer layers.
    #[error("layer {layer} of a pass of {layers} layers: they count from 0")]
    NoLayer {
        /// The layer that was asked for.
        layer: u32,
        /// Layers of the attachments.
        layers: u32,
    },
    /// A draw's pipeline has stages that [`Device::inspect_stages`] does not follow yet.
    #[error(
        "draw {draw} has a tessellation or geometry shader, which inspecting stages does not \
             follow: leave the draw out, or inspect single pixels"
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

/// Runs a pass with the oracle, and writes down what happens to a pixel of a layer.
pub(crate) fn inspect(
    device: &Device,
    pass: &RenderPass<'_>,
    pixel: [u32; 2],
    layer: u32,
) -> Result<PixelHistory, InspectError> {
    prepared(device, pass, |layers, data| {
        let Some(attachments) = layers.get(layer as usize) else {
            let layers = u32::try_from(layers.len()).unwrap_or(u32::MAX);
            return Err(InspectError::NoLayer { layer, layers });
        };
        let draws = data.draws(device.context(), pass.draws);
        let core_pass = core_pass(pass, attachments.loads(), draws[..].into());
        let checked = attachments.with_shape(|shape| core_pass.check(shape));
        checked.map_err(|error| refused(pass, error.into()))?;
        let stores = pass.draws.iter().any(|draw| draw.pipeline.stores());
        let stored = stored_part(layers, attachments, stores, pixel)?;
        // What is stored in one layer may be read in another.
        let is_drawn = |at: usize| stores || at == layer as usize;
        let targets = layers.iter().enumerate().map(|(at, attachments)| {
            let target = || initial::target(device.context(), attachments, stored.clone());
            is_drawn(at).then(target).transpose()
        });
        let targets = targets.collect::<Result<Vec<_>, _>>();
        let inspected = Inspected {
            device,
            attachments,
            pixel,
            layer: layer as usize,
        };
        let mut targets = targets.map_err(|kind| refused(pass, kind))?;
        Ok(inspected.history(&draws, &mut targets))
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
    layers: &[Attachments<'_>],
    attachments: &Attachments<'_>,
    stores: bool,
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
    if !stores {
        return Ok(PixelBounds {
            x: x & !1..((x & !1) + 2).min(width),
            y: y & !1..((y & !1) + 2).min(height),
        });
    }
    let bytes = target_bytes(attachments).saturating_mul(layers.len() as u64);
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

/// The pixel that is inspected, and its layer.
struct Inspected<'a> {
    device: &'a Device,
    attachments: &'a Attachments<'a>,
    pixel: [u32; 2],
    layer: usize,
}

impl Inspected<'_> {
    /// Draws into the layers that have a target.
    fn history(
        &self,
        draws: &[estampe_core::Draw<'_>],
        targets: &mut [Option<Target>],
    ) -> PixelHistory {
        let formats = &self.attachments.formats[..];
        let initial = self.values(&self.samples(targets));
        let mut primitives = Vec::new();
        for (number, draw) in draws.iter().enumerate() {
            primitives.extend(self.draw((number, draw), targets));
        }
        let samples = self.samples(targets);
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
            pixel: self.pixel,
            layer: u32::try_from(self.layer).unwrap_or(u32::MAX),
            initial,
            primitives,
            last: self.values(&samples),
            texels: formats.iter().enumerate().map(texel).collect(),
        }
    }

    fn target<'t>(&self, targets: &'t [Option<Target>]) -> &'t Target {
        let target = targets.get(self.layer).and_then(Option::as_ref);
        target.expect("the layer that is inspected has a target")
    }

    /// The stored samples of the pixel.
    fn samples(&self, targets: &[Option<Target>]) -> Vec<StoredSample> {
        let target = self.target(targets);
        let samples = 0..target.samples;
        let samples = samples.map(|sample| target.sample(target.index(self.pixel, sample)));
        samples.collect()
    }

    fn values(&self, samples: &[StoredSample]) -> Vec<SampleValues> {
        let formats = &self.attachments.formats;
        let samples = samples.iter();
        samples.map(|sample| values(formats, sample)).collect()
    }

    /// Draws; returns what covers the pixel.
    fn draw(
        &self,
        (number, draw): (usize, &estampe_core::Draw<'_>),
        targets: &mut [Option<Target>],
    ) -> Vec<PrimitiveRecord> {
        let shape = TargetShape::of(self.target(targets));
        let place = (self.pixel, self.target(targets).samples);
        let formats = &self.attachments.formats[..];
        with_draw(self.device, draw, shape, |oracle| {
            let recorder = || Recorder::new(place, number, oracle.draw, oracle.shaders, formats);
            let descriptor = draw.pipeline.descriptor();
            if descriptor.tessellation.is_some() || descriptor.geometry.is_some() {
                let level = self.device.level();
                return draw_amplified((draw, level), oracle, targets, self.layer, recorder);
            }
            // Draws without a geometry shader go to the first layer.
            let Some(target) = &mut targets[0] else {
                return Vec::new();
            };
            let reached = oracle.bounds(target).intersection(target.stored());
            if reached.x.is_empty() || reached.y.is_empty() {
                return Vec::new();
            }
            let OracleDraw {
                shaders,
                state,
                draw,
            } = *oracle;
            let mut recorder = recorder();
            draw_observed(target, shaders, state, draw, &mut recorder);
            if self.layer == 0 {
                recorder.primitives
            } else {
                Vec::new()
            }
        })
    }
}
