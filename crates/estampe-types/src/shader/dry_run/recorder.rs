//! The record of a dry run.

use crate::ShaderError;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// A set of facts about a shader: inputs that it uses, and operations that it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Facts(u32);

impl Facts {
    pub(super) const NONE: Self = Self(0);
    /// The window position is used.
    pub(super) const POSITION: Self = Self(1);
    /// The mask of covered samples is used.
    pub(super) const COVERAGE: Self = Self(2);
    /// The index of the shaded sample is used.
    pub(super) const SAMPLE_INDEX: Self = Self(4);
    /// The mask of helper invocations is used.
    pub(super) const HELPER: Self = Self(8);
    /// Derivatives are taken.
    pub(super) const DERIVATIVES: Self = Self(16);
    /// Memory is stored to, as far as a mask of lanes that excludes helpers tells.
    pub(super) const STORES: Self = Self(32);
    /// What the shader does depends on something that a dry run does not know: the number of a
    /// lane, whether a condition holds, or a resource that is not bound.
    pub(super) const UNKNOWN: Self = Self(64);
    /// Dry runs do not try what it depends on either, as they do with questions about masks.
    pub(super) const UNTRIED: Self = Self(4096);
    /// A derivative of a varying is used that the primitive gives.
    pub(super) const GRADIENT: Self = Self(2048);

    /// The scalar `number` of the varyings is used, of the first four.
    pub(super) const fn varying(number: usize) -> Self {
        match number {
            0..4 => Self(128 << number),
            _ => Self::NONE,
        }
    }

    pub(super) fn has(self, fact: Self) -> bool {
        self.0 & fact.0 != 0
    }

    pub(super) const fn and(self, others: Self) -> Self {
        Self(self.0 | others.0)
    }
}

/// The answers to the questions [`Real::any`](crate::Real::any) and `all`, so that both branches of
/// a condition are tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Answers {
    /// The true ones.
    True,
    /// Some lane holds, whatever the mask.
    SomeLane,
    /// No lane holds, whatever the mask.
    NoLane,
}

/// Questions that are answered as [`Answers`] says. Later answers are pseudo-random, so that a loop
/// that waits for an answer ends.
const QUESTIONS: u32 = 4096;

/// Values of a run, in pieces that stay where they are: the first of [`FIRST`] values, each as
/// large as all before it.
///
/// One thread runs a shader, but the type of its numbers could be sent to another: atomics without
/// an order cost nothing more than numbers.
#[derive(Debug, Default)]
struct Values {
    pieces: [OnceLock<Box<[Value]>>; PIECES],
    len: AtomicU32,
}

#[derive(Debug, Default)]
struct Value {
    lanes: [AtomicU32; 4],
    input: AtomicU32,
}

/// Values of the first piece.
const FIRST: u32 = 256;
/// Pieces at most: together 2²⁴ values, 320 MB.
const PIECES: usize = 17;

impl Values {
    /// The piece of a value, and its place in it.
    fn place(at: u32) -> (usize, u32) {
        let past = at / FIRST;
        let piece = past.checked_ilog2().map_or(0, |log2| log2 + 1);
        let before = if piece == 0 { 0 } else { FIRST << (piece - 1) };
        (piece as usize, at - before)
    }

    fn of(&self, at: u32) -> &Value {
        let (piece, place) = Self::place(at);
        let values = self.pieces[piece].get();
        &values.expect("values are added before they are read")[place as usize]
    }

    fn add(&self, lanes: [u32; 4], input: Facts) -> u32 {
        let at = self.len.load(Relaxed);
        let (piece, place) = Self::place(at);
        let Some(piece) = self.pieces.get(piece) else {
            panic!("the dry run of a shader has more than {at} operations: shorten its loops");
        };
        let size = FIRST.max(at - place);
        let values = piece.get_or_init(|| (0..size).map(|_| Value::default()).collect());
        let value = &values[place as usize];
        for (to, lane) in value.lanes.iter().zip(lanes) {
            to.store(lane, Relaxed);
        }
        value.input.store(input.0, Relaxed);
        self.len.store(at + 1, Relaxed);
        at
    }
}

/// The record of one run.
#[derive(Debug)]
pub(super) struct Recorder {
    answers: Answers,
    values: Values,
    facts: AtomicU32,
    questions: AtomicU32,
    misuse: OnceLock<ShaderError>,
}

impl Recorder {
    pub(super) fn new(answers: Answers) -> Self {
        Self {
            answers,
            values: Values::default(),
            facts: AtomicU32::new(0),
            questions: AtomicU32::new(0),
            misuse: OnceLock::new(),
        }
    }

    /// Adds a value, four lanes and the input that it is; gives its number.
    pub(super) fn add(&self, lanes: [u32; 4], input: Facts) -> u32 {
        self.values.add(lanes, input)
    }

    /// The lanes of a value.
    pub(super) fn lanes(&self, at: u32) -> [u32; 4] {
        self.values
            .of(at)
            .lanes
            .each_ref()
            .map(|lane| lane.load(Relaxed))
    }

    /// The input that a value is.
    pub(super) fn input(&self, at: u32) -> Facts {
        Facts(self.values.of(at).input.load(Relaxed))
    }

    pub(super) fn note(&self, facts: Facts) {
        if facts != Facts::NONE {
            self.facts.fetch_or(facts.0, Relaxed);
        }
    }

    /// Records a misuse; the first one counts.
    pub(super) fn report(&self, misuse: ShaderError) {
        // An error means that an earlier misuse is recorded.
        let _ = self.misuse.set(misuse);
    }

    pub(super) fn facts(&self) -> Facts {
        Facts(self.facts.load(Relaxed))
    }

    /// The number of questions that were asked.
    pub(super) fn questions(&self) -> u32 {
        self.questions.load(Relaxed)
    }

    pub(super) fn misuse(self) -> Option<ShaderError> {
        self.misuse.into_inner()
    }

    /// The answer to a question of which the truth is given.
    pub(super) fn answer(&self, truth: bool) -> bool {
        match self.next_question() {
            Some(chance) => chance,
            None => match self.answers {
                Answers::True => truth,
                Answers::SomeLane => true,
                Answers::NoLane => false,
            },
        }
    }

    /// The bits of a mask, in agreement with the answers about it.
    pub(super) fn answer_bits(&self, truth: u64) -> u64 {
        match self.next_question() {
            Some(true) => truth,
            Some(false) => 0,
            None => match self.answers {
                Answers::True => truth,
                Answers::SomeLane => truth | 1,
                Answers::NoLane => 0,
            },
        }
    }

    /// Counts a question. `None` while there were few, then a pseudo-random answer (Knuth's
    /// multiplicative hash of the number of the question).
    fn next_question(&self) -> Option<bool> {
        let number = self.questions.fetch_add(1, Relaxed);
        (number >= QUESTIONS).then(|| number.wrapping_mul(0x9E37_79B9) >> 31 == 1)
    }
}

#[cfg(test)]
mod tests {
    use super::{Facts, Values};

    #[test]
    fn values_stay_what_they_were() {
        let values = Values::default();
        let lanes = |at: u32| [at, at ^ 0xFFFF, at * 3, !at];
        for at in 0..20_000 {
            assert_eq!(values.add(lanes(at), Facts(at * 7)), at);
        }
        for at in 0..20_000 {
            let value = values.of(at);
            let stored = value.lanes.each_ref().map(|lane| lane.load(super::Relaxed));
            assert_eq!(stored, lanes(at));
            assert_eq!(value.input.load(super::Relaxed), at * 7);
        }
    }
}
