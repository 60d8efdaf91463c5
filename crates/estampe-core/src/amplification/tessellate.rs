//! Tessellation of patches (V3).
//!
//! *In* patches and the records of their vertices · *Out* primitives of tessellated vertices.

use super::domain::{Subdivisions, TessellatedDomain};
use super::vertices::Primitives;
use estampe_simd::Level;
use estampe_types::Bindings;
use estampe_types::shader::{ControlBatch, EvaluationBatch, TessellationProgram};
use estampe_types::state::TessellationMode;
use std::ops::Range;

/// The tessellation stage of a draw.
#[derive(Debug, Clone, Copy)]
pub(super) struct TessellationStage<'a> {
    pub(super) program: &'a dyn TessellationProgram,
    pub(super) mode: &'a TessellationMode,
    pub(super) patch_points: usize,
    pub(super) bindings: &'a Bindings,
}

/// Patches with their control points.
#[derive(Debug, Default)]
pub(super) struct Patches {
    control: Vec<u32>,
    values: Vec<u32>,
    numbers: Vec<u32>,
    /// The subdivisions of each patch; `None` if it is dropped.
    subdivisions: Vec<Option<Subdivisions>>,
}

/// Some of the patches.
#[derive(Debug, Clone)]
pub(super) struct PatchRange {
    pub(super) patches: Range<usize>,
    /// Points that they have at most.
    pub(super) points: usize,
}

impl TessellationStage<'_> {
    /// Makes the control points and the levels of patches.
    pub(super) fn control(&self, level: Level, vertices: &Primitives) -> Patches {
        let interface = self.program.interface();
        let count = vertices.numbers.len();
        let mut levels = vec![[0.0; 6]; count];
        let mut patches = Patches {
            control: vec![0; count * interface.control_points * interface.control],
            values: vec![0; count * interface.patch],
            numbers: vertices.numbers.clone(),
            subdivisions: Vec::new(),
        };
        self.program.run_control(
            level,
            self.bindings,
            ControlBatch {
                records: &vertices.records,
                corners: &vertices.corners,
                patch_points: self.patch_points,
                primitive_index: &vertices.numbers,
                control: &mut patches.control,
                patches: &mut patches.values,
                levels: &mut levels,
            },
        );
        let divided = levels.iter();
        patches.subdivisions = divided
            .map(|levels| Subdivisions::new(self.mode, levels))
            .collect();
        patches
    }

    /// Makes the vertices and primitives of some patches.
    pub(super) fn evaluate(
        &self,
        level: Level,
        patches: &Patches,
        range: Range<usize>,
    ) -> Primitives {
        let mut domain = TessellatedDomain::default();
        let mut last = None;
        let (mut coordinates, mut patch_of) = (Vec::new(), Vec::new());
        let mut out = Primitives {
            words: self.program.interface().output.record_words(),
            ..Primitives::default()
        };
        let corners = TessellatedDomain::corners_of(self.mode);
        for patch in range {
            let Some(subdivisions) = &patches.subdivisions[patch] else {
                continue;
            };
            if last != Some(subdivisions) {
                domain.divide(self.mode, subdivisions);
                last = Some(subdivisions);
            }
            let first = number(coordinates.len());
            coordinates.extend_from_slice(&domain.coordinates);
            patch_of.resize(coordinates.len(), number(patch));
            out.corners
                .extend(domain.indices.iter().map(|index| first + index));
            let primitives = domain.indices.len() / corners;
            let total = out.numbers.len() + primitives;
            out.numbers.resize(total, patches.numbers[patch]);
        }
        out.records = vec![0; coordinates.len() * out.words];
        self.program.run_evaluation(
            level,
            self.bindings,
            EvaluationBatch {
                control: &patches.control,
                patches: &patches.values,
                primitive_index: &patches.numbers,
                patch: &patch_of,
                coordinates: &coordinates,
                records: &mut out.records,
            },
        );
        out
    }
}

impl Patches {
    /// Cuts the patches into ranges of about `limit` points.
    pub(super) fn ranges(&self, limit: usize) -> Vec<PatchRange> {
        let mut ranges: Vec<PatchRange> = Vec::new();
        for (patch, subdivisions) in self.subdivisions.iter().enumerate() {
            let Some(subdivisions) = subdivisions else {
                continue;
            };
            let points = subdivisions.points_at_most();
            match ranges.last_mut() {
                Some(last) if last.points + points <= limit => {
                    last.patches.end = patch + 1;
                    last.points += points;
                }
                _ => ranges.push(PatchRange {
                    patches: patch..patch + 1,
                    points,
                }),
            }
        }
        ranges
    }
}

/// The number of a patch or point of a unit.
fn number(value: usize) -> u32 {
    debug_assert!(u32::try_from(value).is_ok(), "units are small");
    u32::try_from(value).unwrap_or(u32::MAX)
}
