//! The memory of runs.

use crate::Code;
use crate::enter::Line;
use crate::frame;
use crate::places::Track;
use estampe_ir::interpreter::Run;
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
    /// The pointers of the last run that began with several passes.
    pub(crate) begin: Begin,
}

/// The pointers with which a run began. The next one most often has its data in the same memory,
/// and begins with the same pointers.
#[derive(Debug, Default)]
pub(crate) struct Begin {
    /// The code of the run; none has the number 0.
    pub(crate) code: u64,
    pub(crate) packets: usize,
    pub(crate) tracks: Vec<Track>,
    pub(crate) pointers: Vec<Line>,
}

impl Begin {
    /// True if a run of so many packets begins so, and its steps are still in the frame.
    #[inline]
    pub(crate) fn is_of(&self, code: &Code, packets: usize, tracks: &[Track]) -> bool {
        (self.code, self.packets) == (code.id, packets) && self.tracks == tracks
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
