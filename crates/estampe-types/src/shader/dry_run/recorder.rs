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

    pub(super) fn and(self, others: Self) -> Self {
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

/// The record of one run.
#[derive(Debug)]
pub(super) struct Recorder {
    answers: Answers,
    facts: AtomicU32,
    questions: AtomicU32,
    misuse: OnceLock<ShaderError>,
}

impl Recorder {
    pub(super) fn new(answers: Answers) -> Self {
        Self {
            answers,
            facts: AtomicU32::new(0),
            questions: AtomicU32::new(0),
            misuse: OnceLock::new(),
        }
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
    pub(super) fn answer_bits(&self, truth: u32) -> u32 {
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
