//! The memory of runs.

use crate::Code;
use crate::enter::Line;
use crate::frame;
use crate::places::Track;
use estampe_ir::interpreter::{Part, Run};
use std::sync::atomic::AtomicU32;

/// The memory of a run, kept for the next one. One for each thread.
#[derive(Debug, Default)]
pub struct Scratch {
    pub(crate) lines: Vec<Line>,
    /// The code for which the lines were cleared.
    pub(crate) code: u64,
    /// Copies of buffers that are shorter than what instructions read at fixed places.
    pub(crate) padded: Vec<Vec<u32>>,
    /// The memory of a work-group.
    pub(crate) workgroup: Vec<AtomicU32>,
    /// Where the data of the run are.
    pub(crate) tracks: Vec<Track>,
    /// Pointers and steps as a work-group finds them.
    pub(crate) pointers: Vec<Line>,
    /// The pointers of the last run of which all data were in memory.
    pub(crate) begin: Begin,
}

/// The pointers with which a run began, while its steps are in the frame. The next run most often
/// has its data in the same memory, and begins with the same pointers, however many packets it has.
#[derive(Debug, Default)]
pub(crate) struct Begin {
    /// The code of the run; none has the number 0.
    code: u64,
    /// The parts of its inputs, then of its outputs.
    parts: [Vec<Part>; 2],
    tracks: Vec<Track>,
    /// Of each track how many parts must be in memory.
    needed: Vec<usize>,
    /// Those of all packets of a pass.
    pointers: Vec<Line>,
}

impl Begin {
    /// Notes the pointers of a run, if all of its inputs and outputs are in memory for all packets,
    /// or dropped; else none.
    pub(crate) fn note(&mut self, code: &Code, run: &Run<'_>, tracks: &[Track], pointers: &[Line]) {
        self.code = 0;
        self.needed.clear();
        self.needed.resize(tracks.len(), 0);
        let (inputs, outputs) = self.needed.split_at_mut(run.inputs.len());
        let (of_inputs, of_outputs) = tracks.split_at(run.inputs.len());
        let all_inputs = (&code.input_types[..], run.input_parts);
        let all_outputs = (&code.output_types[..], run.output_parts);
        for ((kinds, parts), (needed, tracks), drops) in [
            (all_inputs, (inputs, of_inputs), false),
            (all_outputs, (outputs, of_outputs), true),
        ] {
            for (number, &kind) in (0..).zip(kinds) {
                let part = Part::of(parts, number);
                let at = part.data as usize;
                let track = tracks.get(at).unwrap_or(&Track::NOWHERE);
                if drops && track.is_nowhere() {
                    continue;
                }
                if track.whole_part(kind, part.first, 0).is_none() {
                    return;
                }
                needed[at] = needed[at].max(part.first as usize + 1);
            }
        }
        for (kept, parts) in self
            .parts
            .iter_mut()
            .zip([run.input_parts, run.output_parts])
        {
            kept.clear();
            kept.extend_from_slice(parts);
        }
        self.tracks.clear();
        self.tracks.extend_from_slice(tracks);
        self.pointers.clear();
        self.pointers.extend_from_slice(pointers);
        self.code = code.id;
    }

    /// Forgets the pointers, as the steps in the frame change.
    pub(crate) fn forget(&mut self) {
        self.code = 0;
    }

    /// The pointers of a run, if they are known.
    #[inline]
    pub(crate) fn pointers(&self, code: &Code, run: &Run<'_>, tracks: &[Track]) -> Option<&[Line]> {
        let [inputs, outputs] = &self.parts;
        let is_of = self.code == code.id
            && self.tracks.len() == tracks.len()
            && inputs == run.input_parts
            && outputs == run.output_parts;
        let mut pairs = self.tracks.iter().zip(&self.needed).zip(tracks);
        let is_of = is_of && pairs.all(|((before, needed), now)| now.goes_as(before, *needed));
        is_of.then_some(&self.pointers[..])
    }
}

impl Scratch {
    /// True if it was last used for this code: for others the whole frame is cleared first.
    #[must_use]
    pub fn is_of(&self, code: &Code) -> bool {
        self.code == code.id
    }

    /// The bytes of its memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let padded: usize = self.padded.iter().map(Vec::capacity).sum();
        self.lines.capacity() * size_of::<Line>() + (self.workgroup.capacity() + padded) * 4
    }

    /// The jumps backwards of the last run of a code, about: those of its last pass for every
    /// packet; of a work-group with barriers all, and of several work-groups the last one's.
    #[must_use]
    pub fn jumps(&self, code: &Code, run: &Run<'_>) -> u64 {
        let left = self
            .lines
            .first()
            .map_or(0, |head| head.0[frame::BUDGET as usize / 8]);
        let jumps = run.budget.saturating_sub(left);
        match code.workgroup_words {
            _ if !code.has_loops => 0,
            Some(_) => jumps,
            None => jumps.saturating_mul(run.packets as u64),
        }
    }
}
