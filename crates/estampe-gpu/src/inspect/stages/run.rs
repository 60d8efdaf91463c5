//! Running a pass for all pixels: its geometry once, then bands of tile rows side by side.

use super::band::{Band, BandRecorder};
use super::bins::{Binning, tile_side};
use super::geometry::{Geometry, GeometryRecorder};
use super::hidden_blocks::Rejection;
use super::pass_stages::{PassStages, PixelCounts};
use crate::inspect::initial;
use crate::inspect::oracle_draw::{OracleDraw, TargetShape, with_draw};
use crate::inspect::run::{InspectError, MAX_BYTES, check_stages, refused, target_bytes};
use crate::pass::{Attachments, core_pass, prepared};
use crate::{Device, RenderPass};
use estampe_reference::cull::Face;
use estampe_reference::observer::{Assembled, FragmentEvent, Observer, SampleEvent};
use estampe_reference::program::Shaders;
use estampe_reference::{PixelBounds, Target, WindowVertex, draw_observed};
use estampe_types::TextureFormat;
use estampe_types::state::{ColorWrites, ConservativeMode};

/// Runs a pass with the oracle, and writes down what each stage makes of it.
pub(crate) fn inspect_stages(
    device: &Device,
    pass: &RenderPass<'_>,
) -> Result<PassStages, InspectError> {
    prepared(device, pass, |layers, data| {
        // Draws without a geometry shader go to the first layer.
        let attachments = &layers[0];
        let draws = data.draws(device.context(), pass.draws);
        let core_pass = core_pass(pass, attachments.loads(), draws[..].into());
        let checked = attachments.with_shape(|shape| core_pass.check(shape));
        checked.map_err(|error| refused(pass, error.into()))?;
        check_stages(pass)?;
        let run = Run {
            device,
            pass,
            attachments,
            draws: &draws,
        };
        run.stages()
    })
    .map_err(|kind| refused(pass, kind))?
}

/// A pass that is run.
struct Run<'a> {
    device: &'a Device,
    pass: &'a RenderPass<'a>,
    attachments: &'a Attachments<'a>,
    draws: &'a [estampe_core::Draw<'a>],
}

/// A band of tile rows, with the target that is drawn to.
struct BandRun<'a> {
    target: Target,
    band: Band<'a>,
}

impl Run<'_> {
    fn stages(&self) -> Result<PassStages, InspectError> {
        let size = self.attachments.size;
        let pixels = u64::from(size.width) * u64::from(size.height);
        // Of each pixel its counts and the last piece, of each sample another depth.
        let each = size_of::<PixelCounts>() as u64 + 4 + 4 * u64::from(size.samples);
        let bytes = target_bytes(self.attachments) + pixels * each;
        let fits = |bytes: u64| {
            let limit = MAX_BYTES;
            let error = InspectError::TooLarge { bytes, limit };
            if bytes > limit { Err(error) } else { Ok(()) }
        };
        fits(bytes)?;

        let mut geometry = Geometry::new(MAX_BYTES - bytes);
        let mut counts = vec![PixelCounts::default(); pixels_len(pixels)];
        // What shaders store, later draws may read: in all vertices after all pixels of a draw.
        let is_one_run = self.draws.iter().any(|draw| draw.pipeline.stores());
        let mut binnings = Vec::new();
        if !is_one_run {
            let mut nothing = self.target(0..0)?;
            binnings = self.draw_to(&mut nothing, Some(&mut geometry), None);
            fits(bytes + geometry.bytes)?;
        }
        let mut runs = self.bands(&mut counts, is_one_run)?;
        if is_one_run {
            let BandRun { target, band } = &mut runs[0];
            binnings = self.draw_to(target, Some(&mut geometry), Some(band));
            fits(bytes + geometry.bytes)?;
        } else {
            self.device.context().for_each(&mut runs, |run| {
                self.draw_to(&mut run.target, None, Some(&mut run.band));
            });
        }
        let (mut blocks, mut depths) = (Vec::new(), Vec::new());
        for run in runs {
            blocks.extend(run.band.blocks.counts);
            depths.extend(run.band.blocks.depths);
        }
        let mut stages = PassStages {
            size: [size.width, size.height],
            samples: size.samples,
            vertices: geometry.vertices,
            primitives: geometry.primitives,
            pieces: geometry.pieces,
            tile_side: tile_side(size.samples),
            tiles: Vec::new(),
            pixels: counts,
            blocks,
            depths,
            binnings,
        };
        stages.count_tiles();
        Ok(stages)
    }

    /// One band for each thread, or one for all pixels.
    fn bands<'c>(
        &self,
        counts: &'c mut [PixelCounts],
        is_one: bool,
    ) -> Result<Vec<BandRun<'c>>, InspectError> {
        let size = self.attachments.size;
        let side = tile_side(size.samples);
        let tile_rows = size.height.div_ceil(side);
        let threads = u32::try_from(self.device.threads()).unwrap_or(u32::MAX);
        let bands = if is_one {
            1
        } else {
            threads.clamp(1, tile_rows)
        };
        let rows = tile_rows.div_ceil(bands) * side;
        let starts = (0..size.height).step_by(rows as usize);
        let parts = counts.chunks_mut(rows as usize * size.width as usize);
        let runs = starts.zip(parts).map(|(start, counts)| {
            let target = self.target(start..(start + rows).min(size.height))?;
            let band = Band::new(&target, counts);
            Ok(BandRun { target, band })
        });
        runs.collect()
    }

    /// The target of some rows at the beginning of the pass.
    fn target(&self, rows: std::ops::Range<u32>) -> Result<Target, InspectError> {
        let stored = PixelBounds {
            x: 0..self.attachments.size.width,
            y: rows,
        };
        let target = initial::target(self.device.context(), self.attachments, stored);
        target.map_err(|kind| refused(self.pass, kind).into())
    }

    /// Runs all draws, and writes down their geometry, the counts of pixels, or both. Returns how
    /// their pieces are binned.
    fn draw_to(
        &self,
        target: &mut Target,
        mut geometry: Option<&mut Geometry>,
        mut band: Option<&mut Band<'_>>,
    ) -> Vec<Binning> {
        let formats = &self.attachments.formats;
        let draws = (0u32..).zip(self.draws).map(|(number, draw)| {
            with_draw(self.device, draw, TargetShape::of(target), |oracle| {
                let geometry = geometry.as_deref_mut();
                let band = band.as_deref_mut();
                let mut both = Both {
                    geometry: geometry.map(|all| GeometryRecorder::new(all, number, oracle)),
                    band: band.map(|band| band_recorder(band, oracle, formats)),
                };
                draw_observed(target, oracle.shaders, oracle.state, oracle.draw, &mut both);
                binning(target, oracle)
            })
        });
        draws.collect()
    }
}

/// The number of pixels, which the memory for them has limited.
fn pixels_len(pixels: u64) -> usize {
    usize::try_from(pixels).unwrap_or(usize::MAX)
}

fn band_recorder<'a, 'b>(
    band: &'a mut Band<'b>,
    oracle: &OracleDraw<'_>,
    formats: &[Option<TextureFormat>],
) -> BandRecorder<'a, 'b> {
    let state = oracle.state;
    let writes = |(at, format): (usize, &Option<TextureFormat>)| {
        let mask = state.targets.get(at).map(|target| target.write_mask);
        format.is_some() && mask != Some(ColorWrites::NONE)
    };
    let writes_color = formats.iter().enumerate().any(writes);
    let rejection = Rejection::of_draw(state, oracle.shaders.interface());
    BandRecorder::new(band, rejection, (state.depth.is_some(), writes_color))
}

fn binning(target: &Target, oracle: &OracleDraw<'_>) -> Binning {
    let state = oracle.state;
    let bounds = oracle.bounds(target);
    let is_conservative = state.primitive.conservative != ConservativeMode::Disabled;
    Binning::new(target.width, target.samples, bounds, is_conservative)
}

/// Tells two observers.
struct Both<'a, 'b> {
    geometry: Option<GeometryRecorder<'a>>,
    band: Option<BandRecorder<'a, 'b>>,
}

impl Observer for Both<'_, '_> {
    fn primitive(&mut self, assembled: &Assembled<'_>) {
        if let Some(geometry) = &mut self.geometry {
            geometry.primitive(assembled);
        }
    }

    fn piece(&mut self, vertices: &[WindowVertex], face: Face) {
        if let Some(geometry) = &mut self.geometry {
            geometry.piece(vertices, face);
        }
        if let Some(band) = &mut self.band {
            band.piece(vertices, face);
        }
    }

    fn culled(&mut self, vertices: &[WindowVertex], face: Face) {
        if let Some(geometry) = &mut self.geometry {
            geometry.culled(vertices, face);
        }
        if let Some(band) = &mut self.band {
            band.culled(vertices, face);
        }
    }

    fn fragment(&mut self, event: &FragmentEvent<'_>) {
        if let Some(band) = &mut self.band {
            band.fragment(event);
        }
    }

    fn wants(&self, pixel: [u32; 2]) -> bool {
        self.band.as_ref().is_some_and(|band| band.wants(pixel))
    }

    fn sample(&mut self, event: SampleEvent) {
        if let Some(band) = &mut self.band {
            band.sample(event);
        }
    }
}
