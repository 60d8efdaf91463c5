//! Writing lanes as records: each lane has a record of its own.

use crate::Real;
use crate::shader::Sink;

/// The greatest number of lanes of a number.
pub(super) const MAX_LANES: usize = 32;

/// Writes the scalars of a value into the records of its lanes.
pub(super) struct RecordSink<'a> {
    records: &'a mut [u32],
    /// By lane: the first word of its record.
    first: [usize; MAX_LANES],
    /// The lanes that are written, as bits.
    lanes: u32,
    /// The word of the record that is next.
    word: usize,
}

impl<'a> RecordSink<'a> {
    /// Writes the first `count` lanes into consecutive records of `words` words, from record
    /// `first` on.
    #[inline(always)]
    pub(super) fn consecutive(
        records: &'a mut [u32],
        first: usize,
        count: usize,
        words: usize,
    ) -> Self {
        let lanes = if count >= 32 {
            u32::MAX
        } else {
            (1 << count) - 1
        };
        let mut places = [0; MAX_LANES];
        for (lane, place) in places.iter_mut().enumerate() {
            *place = (first + lane) * words;
        }
        Self::new(records, places, lanes)
    }

    /// Writes the lanes of a mask to these first words.
    #[inline(always)]
    pub(super) fn new(records: &'a mut [u32], first: [usize; MAX_LANES], lanes: u32) -> Self {
        Self {
            records,
            first,
            lanes,
            word: 0,
        }
    }
}

impl<R: Real> Sink<R> for RecordSink<'_> {
    #[inline(always)]
    fn put(&mut self, value: R) {
        for lane in 0..R::LANES {
            if self.lanes >> lane & 1 == 1
                && let Some(word) = self.records.get_mut(self.first[lane] + self.word)
            {
                *word = value.lane(lane).to_bits();
            }
        }
        self.word += 1;
    }
}
