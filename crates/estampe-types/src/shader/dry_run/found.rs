//! The findings of a shader's dry runs.

use super::recorder::{Answers, Facts};
use super::{DepthOutput, runs};
use crate::{Interface, Shader, ShaderError};

/// Inputs and outputs that some run used.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Found {
    pub(super) facts: Facts,
    pub(super) color_targets: usize,
    pub(super) second_color: bool,
    /// A run's colour is something else than the first four scalars of the varyings.
    pub(super) changes_color: bool,
    pub(super) discards: bool,
    pub(super) sample_mask: bool,
    pub(super) depth: bool,
    /// A run left the interpolated depth.
    pub(super) no_depth: bool,
    pub(super) point_size: bool,
    pub(super) clip_distances: usize,
    pub(super) cull_distances: usize,
    /// A run read words of bindings.
    pub(super) reads_words: bool,
    /// The most questions about masks that a run of the fragment shader asked.
    pub(super) questions: u32,
}

/// Words of bindings are read as 0, 1, … in turn, fewer than this.
const WORDS: u16 = 4;

impl Found {
    /// The findings of all runs. A panic is an error of the shader only if the answers were
    /// true: a body may rely on them.
    pub(super) fn of<T: Shader>(shader: &T, declared: &Interface) -> Result<Self, ShaderError> {
        let varyings = runs::plain_varyings(declared.varyings.len());
        let mut all = Self::default();
        // A panic cannot be caught in a program that aborts on panics.
        let ways: &[Answers] = if cfg!(panic = "unwind") {
            &[Answers::True, Answers::SomeLane, Answers::NoLane]
        } else {
            &[Answers::True]
        };
        for word in 0..WORDS {
            for &answers in ways {
                let vertex = runs::vertex(shader, answers, word);
                let fragment = runs::fragment(shader, answers, word, &varyings);
                for (run, lost) in [
                    (vertex, Facts::NONE),
                    (fragment, Facts::UNKNOWN.and(Facts::UNTRIED)),
                ] {
                    match run {
                        Ok(found) => all = all.and(found),
                        // A body may rely on what holds, and on what is bound. What it would have
                        // done is not known.
                        Err(ShaderError::Panicked { .. })
                            if answers != Answers::True || word != 0 =>
                        {
                            all.facts = all.facts.and(lost);
                        }
                        Err(error) => return Err(error),
                    }
                }
            }
            if !all.reads_words {
                break;
            }
            if ways.len() == 1 {
                // The other words cannot be tried.
                all.facts = all.facts.and(Facts::UNKNOWN).and(Facts::UNTRIED);
                break;
            }
        }
        Ok(all)
    }

    fn and(self, other: Self) -> Self {
        Self {
            facts: self.facts.and(other.facts),
            color_targets: self.color_targets.max(other.color_targets),
            second_color: self.second_color | other.second_color,
            changes_color: self.changes_color | other.changes_color,
            discards: self.discards | other.discards,
            sample_mask: self.sample_mask | other.sample_mask,
            depth: self.depth | other.depth,
            no_depth: self.no_depth | other.no_depth,
            point_size: self.point_size | other.point_size,
            clip_distances: self.clip_distances.max(other.clip_distances),
            cull_distances: self.cull_distances.max(other.cull_distances),
            reads_words: self.reads_words | other.reads_words,
            questions: self.questions.max(other.questions),
        }
    }

    /// The interface of these and of what is declared.
    pub(super) fn widen(&self, declared: Interface) -> Interface {
        let depth_output = match declared.depth_output {
            DepthOutput::None if self.depth => DepthOutput::Any,
            declared => declared,
        };
        // A fragment that does not set the depth keeps the interpolated one.
        let keeps_depth = depth_output != DepthOutput::None && self.no_depth;
        let reads = |input| self.facts.has(input);
        let no_derivatives = !reads(Facts::DERIVATIVES.and(Facts::UNKNOWN));
        let is_color_alone = self.color_targets == 1
            && declared.color_targets <= 1
            && depth_output == DepthOutput::None
            && !(declared.discards | self.discards)
            && !(declared.stores | reads(Facts::STORES))
            && !(declared.writes_sample_mask | self.sample_mask)
            && !(declared.dual_source | self.second_color);
        Interface {
            color_passthrough: no_derivatives && is_color_alone && !self.changes_color,
            no_derivatives,
            gradients: match reads(Facts::GRADIENT.and(Facts::UNTRIED)) {
                true => declared.gradients,
                false => Vec::new(),
            },
            color_targets: declared.color_targets.max(self.color_targets),
            discards: declared.discards | self.discards,
            depth_output,
            reads_position: declared.reads_position | reads(Facts::POSITION) | keeps_depth,
            per_sample: declared.per_sample | reads(Facts::SAMPLE_INDEX),
            reads_coverage: declared.reads_coverage | reads(Facts::COVERAGE),
            writes_sample_mask: declared.writes_sample_mask | self.sample_mask,
            dual_source: declared.dual_source | self.second_color,
            stores: declared.stores | reads(Facts::STORES),
            writes_point_size: declared.writes_point_size | self.point_size,
            clip_distances: declared.clip_distances.max(self.clip_distances),
            cull_distances: declared.cull_distances.max(self.cull_distances),
            ..declared
        }
    }
}
