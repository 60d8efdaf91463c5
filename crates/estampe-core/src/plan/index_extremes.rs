//! The least and the greatest index of a range of an index buffer.
//!
//! Programs draw the same mesh many times in a pass, and in every pass: what a range holds is found
//! once, and of large ranges remembered with the buffer. Its indices are otherwise read for each
//! draw.

use crate::geometry::assembly::raw_index;
use crate::schedule::Executor;
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, u32x16};
use estampe_types::{BufferData, IndexFormat};

/// Ranges that are remembered for a pass.
const KNOWN: usize = 64;

/// Ranges of as many indices are remembered with the buffer: fewer are read as soon as looked up.
const LARGE: u32 = 4096;

/// A range of indices: the buffer's words by address and number, format, first and count.
type RangeKey = (usize, usize, IndexFormat, [u32; 2]);

/// The extremes of ranges of a pass's index buffers. Buffers do not change during a pass, so their
/// addresses name them.
#[derive(Debug)]
pub(super) struct KnownExtremes {
    level: Level,
    /// By the key's hash: the range that was looked up last.
    ranges: [Option<(RangeKey, [u32; 2])>; KNOWN],
    /// How many ranges were read.
    #[cfg(test)]
    pub(super) read: usize,
}

impl KnownExtremes {
    /// No ranges yet. Indices are read at a SIMD level.
    pub(super) fn new(level: Level) -> Self {
        Self {
            level,
            ranges: [None; KNOWN],
            #[cfg(test)]
            read: 0,
        }
    }

    /// The least and the greatest of the indices of `count` elements from `first` on; `None` where
    /// the buffer does not hold all of them, or they are bytes.
    pub(super) fn in_buffer(
        &mut self,
        executor: &Executor,
        buffer: &BufferData,
        format: IndexFormat,
        range: [u32; 2],
    ) -> Option<[u32; 2]> {
        let words = buffer.words();
        let key: RangeKey = (words.as_ptr().addr(), words.len(), format, range);
        let slot = &mut self.ranges[slot_of(&key)];
        if let Some((known, extremes)) = slot
            && *known == key
        {
            return Some(*extremes);
        }
        let level = self.level;
        let read = || extremes_in_buffer((executor, level), buffer, format, range);
        let extremes = if range[1] >= LARGE {
            buffer.index_extremes(format, range, read)?
        } else {
            read()?
        };
        *slot = Some((key, extremes));
        #[cfg(test)]
        {
            self.read += 1;
        }
        Some(extremes)
    }
}

/// Where a range is remembered: the highest bits of a product, to which all parts of the key add.
fn slot_of(&(address, _, format, [first, count]): &RangeKey) -> usize {
    const SPREAD: u64 = 0x9E37_79B9_7F4A_7C15;
    let elements = u64::from(first) << 32 | u64::from(count);
    let sum = elements.wrapping_mul(SPREAD) ^ address as u64 ^ (format as u64) << 20;
    (sum.wrapping_mul(SPREAD) >> 58) as usize % KNOWN
}

/// Indices that one worker looks through at a time.
const INDEX_CHUNK: usize = 1 << 16;

/// [`KnownExtremes::in_buffer`], by reading the range.
fn extremes_in_buffer(
    on: (&Executor, Level),
    buffer: &BufferData,
    format: IndexFormat,
    [first, count]: [u32; 2],
) -> Option<[u32; 2]> {
    let (from, to) = (first as usize, first as usize + count as usize);
    match format {
        IndexFormat::Uint8 => None,
        IndexFormat::Uint32 => {
            let words = buffer.words().get(from..to)?;
            extremes(on, words, extremes_of::<false>)
        }
        IndexFormat::Uint16 => {
            let whole = buffer.words().get(from.div_ceil(2)..to / 2)?;
            let halves = extremes(on, whole, extremes_of::<true>);
            let [mut least, mut greatest] = halves.unwrap_or([u32::MAX, 0]);
            // The first one where it is the upper half of a word, and the last one where it is the
            // lower.
            let upper = (!from.is_multiple_of(2)).then_some(from);
            let lower = (!to.is_multiple_of(2)).then(|| to - 1);
            for at in [upper, lower].into_iter().flatten() {
                let index = raw_index(buffer, format, at);
                (least, greatest) = (least.min(index), greatest.max(index));
            }
            Some([least, greatest])
        }
    }
}

/// The least and the greatest of some words, or of their halves.
fn extremes_of<const HALVES: bool>(level: Level, words: &[u32]) -> [u32; 2] {
    let (chunks, rest) = words.as_chunks();
    let of_chunks = dispatch!(@wide level, s => extremes_of_lanes::<_, HALVES>(s, chunks),
        scalar => extremes_one_by_one::<HALVES>(chunks.as_flattened()));
    wider(of_chunks, extremes_one_by_one::<HALVES>(rest))
}

#[inline(always)]
fn extremes_of_lanes<S: Lanes, const HALVES: bool>(s: S, chunks: &[[u32; LANES]]) -> [u32; 2] {
    let mut least = <u32x16<S> as SimdBase<S>>::splat(s, u32::MAX);
    let mut greatest = <u32x16<S> as SimdBase<S>>::splat(s, 0);
    for chunk in chunks {
        let words = u32x16::load_array_ref(s, chunk);
        if const { HALVES } {
            let (low, high) = (words & 0xFFFF, words >> 16);
            least = least.min(low).min(high);
            greatest = greatest.max(low).max(high);
        } else {
            least = least.min(words);
            greatest = greatest.max(words);
        }
    }
    let (least, greatest) = (least.to_array(), greatest.to_array());
    [
        least.into_iter().fold(u32::MAX, u32::min),
        greatest.into_iter().fold(0, u32::max),
    ]
}

fn extremes_one_by_one<const HALVES: bool>(words: &[u32]) -> [u32; 2] {
    words.iter().fold([u32::MAX, 0], |extremes, &word| {
        if const { HALVES } {
            let (low, high) = (word & 0xFFFF, word >> 16);
            wider(extremes, [low.min(high), low.max(high)])
        } else {
            wider(extremes, [word; 2])
        }
    })
}

fn wider(a: [u32; 2], b: [u32; 2]) -> [u32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// The least and the greatest number in some words. A million triangles have 12 MB of indices,
/// which one thread alone reads no faster than memory gives them to it.
fn extremes(
    (executor, level): (&Executor, Level),
    words: &[u32],
    of_part: fn(Level, &[u32]) -> [u32; 2],
) -> Option<[u32; 2]> {
    if words.is_empty() {
        return None;
    }
    if words.len() <= INDEX_CHUNK {
        return Some(of_part(level, words));
    }
    let mut parts: [(&[u32], [u32; 2]); 64] = [(&[], [u32::MAX, 0]); 64];
    let each = words.len().div_ceil(parts.len());
    let mut used = 0;
    for (part, words) in parts.iter_mut().zip(words.chunks(each)) {
        part.0 = words;
        used += 1;
    }
    executor.for_each_alone(&mut parts[..used], |(words, found)| {
        *found = of_part(level, words);
    });
    parts.iter().map(|part| part.1).reduce(wider)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The extremes by the definition.
    fn slowly(buffer: &BufferData, format: IndexFormat, [first, count]: [u32; 2]) -> [u32; 2] {
        let indices = (first..first + count).map(|at| raw_index(buffer, format, at as usize));
        [indices.clone().min().unwrap(), indices.max().unwrap()]
    }

    #[test]
    fn extremes_in_lanes_are_those_of_each_index() {
        let executor = Executor::new(2).unwrap();
        let mut state = 1u32;
        let mut byte = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        for len in [40, 43, 600_000] {
            let bytes: Vec<u8> = (0..len).map(|_| byte()).collect();
            let buffer = BufferData::from_bytes(&bytes);
            for format in [IndexFormat::Uint16, IndexFormat::Uint32] {
                let all = u32::try_from(buffer.words().len()).unwrap();
                let all = if format == IndexFormat::Uint16 {
                    all * 2
                } else {
                    all
                };
                for range in [[0, all], [1, all - 1], [3, 4], [2, 1], [3, 1], [0, all - 1]] {
                    let slow = Some(slowly(&buffer, format, range));
                    for level in Level::all_available() {
                        let found = extremes_in_buffer((&executor, level), &buffer, format, range);
                        assert_eq!(found, slow, "{range:?} at {}", level.name());
                    }
                }
                let beyond =
                    extremes_in_buffer((&executor, Level::best()), &buffer, format, [1, all + 2]);
                assert_eq!(beyond, None);
            }
        }
    }

    #[test]
    fn large_ranges_are_remembered_from_pass_to_pass() {
        let executor = Executor::alone();
        let mut words: Vec<u32> = (7..7 + LARGE).rev().collect();
        let mut buffer = BufferData::from_words(words.clone());
        let range = [0, LARGE];
        let of_pass = |buffer: &BufferData| {
            let mut known = KnownExtremes::new(Level::best());
            known.in_buffer(&executor, buffer, IndexFormat::Uint32, range)
        };
        assert_eq!(of_pass(&buffer), Some([7, 6 + LARGE]));
        let remembered = buffer.index_extremes(IndexFormat::Uint32, range, || None);
        assert_eq!(remembered, Some([7, 6 + LARGE]));
        (words[5], buffer.words_mut()[5]) = (3, 3);
        assert_eq!(buffer.words(), words);
        assert_eq!(of_pass(&buffer), Some([3, 6 + LARGE]));
    }

    #[test]
    fn a_range_is_read_once() {
        let executor = Executor::alone();
        let buffer = BufferData::from_bytes(&(0..200).collect::<Vec<u8>>());
        let other = BufferData::from_bytes(&[7; 200]);
        let mut known = KnownExtremes::new(Level::best());
        for _draw in 0..3 {
            let found = known.in_buffer(&executor, &buffer, IndexFormat::Uint16, [3, 30]);
            assert_eq!(found, Some(slowly(&buffer, IndexFormat::Uint16, [3, 30])));
        }
        assert_eq!(known.read, 1);
        // Whatever share a place, what differs in one part of the key is another range.
        for _draw in 0..3 {
            for format in [IndexFormat::Uint16, IndexFormat::Uint32] {
                for range in [[0, 40], [3, 30], [3, 31], [4, 30]] {
                    for buffer in [&buffer, &other, &buffer.slice(8, 192)] {
                        let found = known.in_buffer(&executor, buffer, format, range);
                        assert_eq!(found, Some(slowly(buffer, format, range)));
                    }
                }
            }
        }
        let beyond = known.in_buffer(&executor, &buffer, IndexFormat::Uint32, [0, 51]);
        assert_eq!(beyond, None);
    }
}
