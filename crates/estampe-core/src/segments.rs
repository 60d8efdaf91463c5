//! Long lists that threads make together.
//!
//! A list in one piece has to be as long as it will be before several threads can write to it. Ten
//! thousand small structures that were in no near cache took the one thread that did so 0.2 ms, as
//! long as sixteen threads draw a tenth of their frame. So such a list lies in segments of as many
//! elements each, to which threads add.

use crate::recycle::recycled;
use std::ops::{Index, Range};

/// Elements of a segment.
const SEGMENT: usize = 128;

/// A list in segments. Its memory is kept when it is cleared.
#[derive(Debug)]
pub(crate) struct Segments<T> {
    /// All but the last one in use are full; those behind it are empty.
    segments: Vec<Vec<T>>,
    len: usize,
}

/// A segment, and the numbers of the elements that it lacks.
pub(crate) type Missing<'a, T> = (&'a mut Vec<T>, Range<usize>);

impl<T> Default for Segments<T> {
    fn default() -> Self {
        Self {
            segments: Vec::new(),
            len: 0,
        }
    }
}

impl<T> Segments<T> {
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub(crate) fn clear(&mut self) {
        let used = self.len.div_ceil(SEGMENT);
        self.segments[..used].iter_mut().for_each(Vec::clear);
        self.len = 0;
    }

    /// An empty list in the same memory.
    pub(crate) fn recycled<U>(self) -> Segments<U> {
        let segments = self.segments.into_iter().map(recycled);
        Segments {
            segments: segments.collect(),
            len: 0,
        }
    }

    pub(crate) fn push(&mut self, element: T) {
        let segment = self.len / SEGMENT;
        if segment == self.segments.len() {
            self.segments.push(Vec::new());
        }
        self.segments[segment].push(element);
        self.len += 1;
    }

    pub(crate) fn first(&self) -> Option<&T> {
        self.iter().next()
    }

    pub(crate) fn last(&self) -> Option<&T> {
        Some(&self[self.len.checked_sub(1)?])
    }

    /// The elements with some numbers.
    pub(crate) fn range(&self, numbers: Range<usize>) -> impl Iterator<Item = &T> + Clone {
        numbers.map(|number| &self[number])
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &T> + Clone {
        self.range(0..self.len)
    }

    /// The first of some numbers whose element is not one of those for which `is_before` holds,
    /// which come first.
    pub(crate) fn partition_point(
        &self,
        numbers: Range<usize>,
        is_before: impl Fn(&T) -> bool,
    ) -> usize {
        let Range { mut start, mut end } = numbers;
        while start < end {
            let middle = start + (end - start) / 2;
            if is_before(&self[middle]) {
                start = middle + 1;
            } else {
                end = middle;
            }
        }
        start
    }

    /// Makes the list so much longer, by elements that the caller adds to the segments that lack
    /// them: to each as many as it says.
    pub(crate) fn grow_by(&mut self, count: usize) -> impl Iterator<Item = Missing<'_, T>> {
        let Range { start, end } = self.len..self.len + count;
        self.len = end;
        let first = start / SEGMENT;
        let used = if count == 0 {
            first
        } else {
            end.div_ceil(SEGMENT)
        };
        if self.segments.len() < used {
            self.segments.resize_with(used, Vec::new);
        }
        let segments = (first..used).zip(&mut self.segments[first..used]);
        segments.map(move |(number, segment)| {
            let begin = number * SEGMENT;
            segment.reserve_exact(SEGMENT - segment.len());
            (segment, begin.max(start)..(begin + SEGMENT).min(end))
        })
    }
}

impl<T> Index<usize> for Segments<T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, number: usize) -> &T {
        &self.segments[number / SEGMENT][number % SEGMENT]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_found_by_number() {
        let mut list = Segments::<String>::default();
        // Several times, because memory is used again.
        for [pushed, grown] in [[0, 0], [5, 1000], [SEGMENT, 3], [300, 0], [0, 2 * SEGMENT]] {
            for number in 0..pushed {
                list.push(number.to_string());
            }
            for (segment, missing) in list.grow_by(grown) {
                assert!(!missing.is_empty());
                segment.extend(missing.map(|number| number.to_string()));
            }
            list.push("last".to_owned());
            let len = pushed + grown;
            assert_eq!(list.len(), len + 1);
            for number in 0..len {
                assert_eq!(list[number], number.to_string());
            }
            assert_eq!(list.first().unwrap(), if len > 0 { "0" } else { "last" });
            assert_eq!(list.last().unwrap(), "last");
            let numbers = len / 3..len;
            let range = numbers.clone().map(|number| number.to_string());
            assert!(list.range(numbers).eq(range.collect::<Vec<_>>().iter()));
            assert_eq!(list.iter().count(), len + 1);
            list.clear();
            assert!(list.is_empty() && list.last().is_none() && list.iter().next().is_none());
        }
        let list: Segments<u8> = list.recycled();
        assert!(list.is_empty());
    }

    #[test]
    fn the_partition_point_is_that_of_a_slice() {
        let mut list = Segments::default();
        let all: Vec<usize> = (0..700).map(|number| number / 3).collect();
        all.iter().for_each(|element| list.push(*element));
        for numbers in [0..700, 0..0, 130..600, 127..129] {
            for limit in [0, 1, 43, 44, 200, 300] {
                let expected = all[numbers.clone()].partition_point(|element| *element < limit);
                let found = list.partition_point(numbers.clone(), |element| *element < limit);
                assert_eq!(found, numbers.start + expected, "{numbers:?} {limit}");
            }
        }
    }
}
