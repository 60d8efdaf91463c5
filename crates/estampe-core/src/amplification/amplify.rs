//! The loop over the parts and units of an amplified draw.

use super::elements::{InputCursor, InputPart};
use super::geometry::{Emitted, GeometryStage};
use super::piece::Piece;
use super::tessellate::TessellationStage;
use super::vertices::{Primitives, VertexStage};
use crate::commands::Draw;
use crate::pipeline::amplified::Amplified;
use crate::schedule::Executor;
use crate::statistics::Statistics;
use estampe_simd::Level;
use estampe_types::Bindings;
use std::ops::Range;

/// Vertices of the primitives of a part, at most.
const PART_CORNERS: usize = 1 << 17;

/// Patches of a part, at most: their control points are kept until all are evaluated.
const PART_PATCHES: usize = 1 << 12;

/// Primitives of a part, at most.
const PART_PRIMITIVES: usize = 1 << 14;

/// Patches whose vertices and control points are made together.
const UNIT_PATCHES: usize = 64;

/// Primitives whose vertices are shaded together, and which a geometry shader reads together.
const UNIT_PRIMITIVES: usize = 512;

/// Points that are evaluated together, or those of one patch.
const UNIT_POINTS: usize = 1 << 13;

/// Words that the invocations of a unit of primitives may emit, or those of one primitive.
const UNIT_WORDS: usize = 1 << 19;

/// Words of the units that are worked on in parallel: 64 MiB.
const WAVE_WORDS: usize = 1 << 24;

/// Bindings of draws that have none.
static NO_BINDINGS: Bindings = Bindings {
    unbound: None,
    groups: Vec::new(),
    immediates: Vec::new(),
};

/// What amplification needs besides a draw.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Amplifier<'a> {
    pub(crate) executor: &'a Executor,
    pub(crate) level: Level,
    /// Layers of the target.
    pub(crate) layers: u32,
}

/// The stages of a draw.
struct Stages<'a> {
    amplifier: &'a Amplifier<'a>,
    vertex: VertexStage<'a>,
    tessellation: Option<TessellationStage<'a>>,
    geometry: Option<GeometryStage<'a>>,
}

impl Amplifier<'_> {
    /// Amplifies a draw and hands its pieces over, in order. Ends early, and says false, where
    /// `take` says that it wants no more.
    pub(crate) fn amplify(
        &self,
        draw: &Draw<'_>,
        amplified: &Amplified,
        statistics: &mut Statistics,
        mut take: impl FnMut(Vec<Piece>, &mut Statistics) -> bool,
    ) -> bool {
        let stages = self.stages(draw, amplified);
        let corners_each = amplified.input_corners();
        let most = match stages.tessellation {
            Some(_) => PART_PATCHES,
            None => PART_PRIMITIVES,
        };
        let limit = (PART_CORNERS / corners_each).clamp(1, most);
        let mut cursor = InputCursor::new(draw, corners_each);
        let mut part = InputPart::default();
        while cursor.take(limit, &mut part) {
            let goes_on = match &stages.tessellation {
                Some(stage) => stages.tessellate(stage, &part, statistics, &mut take),
                None => {
                    let primitives = stages.shade(&part, statistics);
                    stages.emit(&primitives, statistics, &mut take)
                }
            };
            if !goes_on {
                return false;
            }
        }
        true
    }

    fn stages<'a>(&'a self, draw: &'a Draw<'_>, amplified: &'a Amplified) -> Stages<'a> {
        let bindings = draw.bindings.unwrap_or(&NO_BINDINGS);
        let descriptor = draw.pipeline.descriptor();
        let tessellation = descriptor.tessellation.as_ref();
        Stages {
            amplifier: self,
            vertex: VertexStage {
                pipeline: &amplified.vertex,
                buffers: draw.vertex_buffers,
                bindings,
                base_instance: draw.instances.start,
            },
            tessellation: tessellation.map(|stage| TessellationStage {
                program: &*stage.program,
                mode: &stage.mode,
                patch_points: stage.patch_points as usize,
                bindings,
            }),
            geometry: descriptor.geometry.as_deref().map(|program| GeometryStage {
                program,
                provoking: descriptor.primitive.provoking_vertex,
                bindings,
                layers: self.layers,
                // Memory is short before there are 2³².
                viewports: u32::try_from(draw.more_viewports.len()).map_or(1, |more| more + 1),
            }),
        }
    }
}

impl Stages<'_> {
    /// Works on items in parallel, and returns what they gave in order.
    fn map<T: Send, U: Send>(&self, items: Vec<T>, work: impl Fn(T) -> U + Sync) -> Vec<U> {
        let mut slots: Vec<(Option<T>, Option<U>)> =
            items.into_iter().map(|item| (Some(item), None)).collect();
        self.amplifier
            .executor
            .for_each_alone(&mut slots, |(item, out)| {
                *out = item.take().map(&work);
            });
        slots.into_iter().filter_map(|(_, out)| out).collect()
    }

    /// Shades the vertices of a part's primitives, in units.
    fn shade(&self, part: &InputPart, statistics: &mut Statistics) -> Vec<Primitives> {
        let unit = match self.tessellation {
            Some(_) => UNIT_PATCHES,
            None => UNIT_PRIMITIVES,
        };
        let units = cut(part.instances.len(), unit);
        let level = self.amplifier.level;
        let shaded = self.map(units, |unit| self.vertex.shade(level, part, unit));
        let shaded = shaded.into_iter().map(|(primitives, vertices)| {
            statistics.vertices_shaded += vertices;
            primitives
        });
        shaded.collect()
    }

    /// Tessellates the patches of a part.
    fn tessellate(
        &self,
        stage: &TessellationStage<'_>,
        part: &InputPart,
        statistics: &mut Statistics,
        take: &mut impl FnMut(Vec<Piece>, &mut Statistics) -> bool,
    ) -> bool {
        let level = self.amplifier.level;
        statistics.patches += part.instances.len() as u64;
        let vertices = self.shade(part, statistics);
        let patches = self.map(vertices, |vertices| stage.control(level, &vertices));
        let words = stage.program.interface().output.record_words();
        let mut units = Vec::new();
        for (unit, patches) in patches.iter().enumerate() {
            units.extend(
                patches
                    .ranges(UNIT_POINTS)
                    .into_iter()
                    .map(|range| (unit, range)),
            );
        }
        for wave in waves(units, |(_, range)| range.points * words) {
            let made = self.map(wave, |(unit, range)| {
                stage.evaluate(level, &patches[unit], range.patches)
            });
            for primitives in &made {
                statistics.evaluations += (primitives.records.len() / words) as u64;
            }
            let goes_on = if self.geometry.is_some() {
                self.emit(&made, statistics, take)
            } else {
                let pieces = made
                    .into_iter()
                    .map(|made| Piece::new(made.records, made.corners));
                take(pieces.collect(), statistics)
            };
            if !goes_on {
                return false;
            }
        }
        true
    }

    /// Runs the geometry shader on primitives.
    fn emit(
        &self,
        primitives: &[Primitives],
        statistics: &mut Statistics,
        take: &mut impl FnMut(Vec<Piece>, &mut Statistics) -> bool,
    ) -> bool {
        let Some(stage) = &self.geometry else {
            return true;
        };
        let (level, words) = (self.amplifier.level, stage.words_each());
        let unit = (UNIT_WORDS / words).clamp(1, UNIT_PRIMITIVES);
        let mut units = Vec::new();
        for from in primitives {
            units.extend(
                cut(from.numbers.len(), unit)
                    .into_iter()
                    .map(|at| (from, at)),
            );
        }
        let invocations = stage.program.interface().invocations;
        for wave in waves(units, |(_, range)| range.len() * words) {
            let read: usize = wave.iter().map(|(_, range)| range.len()).sum();
            let emitted = self.map(wave, |(from, range)| stage.run(level, from, range));
            statistics.geometry_invocations += (read * invocations) as u64;
            let mut pieces = Vec::new();
            for Emitted {
                pieces: more,
                primitives,
            } in emitted
            {
                statistics.geometry_primitives += primitives;
                pieces.extend(more);
            }
            if !take(pieces, statistics) {
                return false;
            }
        }
        true
    }
}

/// Ranges of at most `each` of `count`.
fn cut(count: usize, each: usize) -> Vec<Range<usize>> {
    let starts = (0..count).step_by(each);
    starts
        .map(|start| start..(start + each).min(count))
        .collect()
}

/// Cuts units into waves of at most [`WAVE_WORDS`], or of one unit.
fn waves<T>(units: Vec<T>, words: impl Fn(&T) -> usize) -> Vec<Vec<T>> {
    let mut waves: Vec<Vec<T>> = Vec::new();
    let mut total = 0;
    for unit in units {
        let more = words(&unit);
        if waves.is_empty() || total + more > WAVE_WORDS {
            waves.push(Vec::new());
            total = 0;
        }
        total += more;
        if let Some(last) = waves.last_mut() {
            last.push(unit);
        }
    }
    waves
}
