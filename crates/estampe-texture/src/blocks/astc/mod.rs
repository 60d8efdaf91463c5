//! ASTC blocks of the LDR profile, after the Khronos Data Format Specification 1.3, chapter 23.
//!
//! A block of 128 bits holds colour endpoints for one to four partitions of its texels, and a grid
//! of weights that is stretched over the texels and mixes the endpoints. Both are sequences of
//! small integers (*ISE*): the weights from the top downwards, the endpoints from behind the header
//! upwards. Invalid blocks and HDR blocks are decoded to magenta.

#![expect(
    clippy::cast_possible_truncation,
    reason = "fields of at most 32 bits, and sides of at most 12 texels"
)]

mod endpoints;
mod sequence;

use endpoints::{Ends, ends_of};
use sequence::{LEVELS, Range};

/// The colour of errors.
const MAGENTA: u32 = 0xFFFF_00FF;

/// The most weights of a block, both planes together.
const MAX_WEIGHTS: usize = 64;

/// The layout of a block's weights.
struct Grid {
    width: usize,
    height: usize,
    planes: usize,
    range: Range,
}

impl Grid {
    /// The layout of a block mode (table 125); `None` for reserved modes.
    fn new(mode: u32) -> Option<Self> {
        let field = |low: u32, count: u32| (mode >> low & ((1 << count) - 1)) as usize;
        let (a, b) = (field(5, 2), field(7, 2));
        let is_low = mode & 3 != 0;
        let (width, height, has_flags) = if is_low {
            match field(2, 2) {
                0 => (b + 4, a + 2, true),
                1 => (b + 8, a + 2, true),
                2 => (a + 2, b + 8, true),
                _ if b & 2 == 0 => (a + 2, (b & 1) + 6, true),
                _ => ((b & 1) + 2, a + 2, true),
            }
        } else {
            match field(7, 2) {
                _ if field(2, 2) == 0 => return None,
                0 => (12, a + 2, true),
                1 => (a + 2, 12, true),
                2 => (a + 6, field(9, 2) + 6, false),
                _ if a == 0 => (6, 10, true),
                _ if a == 1 => (10, 6, true),
                _ => return None,
            }
        };
        let high = if is_low { field(0, 2) } else { field(2, 2) };
        // 2 to 7, for high is not 0.
        let range = high << 1 | field(4, 1);
        let is_fine = has_flags && field(9, 1) == 1;
        let levels = if is_fine {
            [10, 12, 16, 20, 24, 32]
        } else {
            [2, 3, 4, 5, 6, 8]
        };
        Some(Self {
            width,
            height,
            planes: if has_flags && field(10, 1) == 1 { 2 } else { 1 },
            range: Range::of(levels[range - 2]),
        })
    }
}

/// Decodes a block to RGBA8 words, row by row.
pub(super) fn decode(block: &[u8; 16], size: [u32; 2], is_srgb: bool, words: &mut [u32]) {
    let [width, height] = size.map(|side| side as usize);
    let Some(words) = words.get_mut(..width * height) else {
        return;
    };
    let bits = u128::from_le_bytes(*block);
    if field(bits, 0, 9) == 0x1FC {
        words.fill(void_extent(bits, is_srgb).unwrap_or(MAGENTA));
    } else if decode_texels(bits, [width, height], is_srgb, words).is_none() {
        words.fill(MAGENTA);
    }
}

/// Up to 32 bits from bit `low` on.
fn field(bits: u128, low: u32, count: u32) -> u32 {
    (bits >> low & ((1 << count) - 1)) as u32
}

/// A block of one colour.
fn void_extent(bits: u128, is_srgb: bool) -> Option<u32> {
    let is_hdr = field(bits, 9, 1) == 1;
    let [s0, s1, t0, t1] = [12, 25, 38, 51].map(|low| field(bits, low, 13));
    let is_everywhere = [s0, s1, t0, t1] == [0x1FFF; 4];
    if is_hdr || field(bits, 10, 2) != 3 || !is_everywhere && (s0 >= s1 || t0 >= t1) {
        return None;
    }
    let channels = [64, 80, 96, 112].map(|low| field(bits, low, 16));
    Some(word_of(channels, is_srgb))
}

/// Reduces sixteen bits per channel to eight: the upper bits for colours of sRGB, otherwise the
/// nearest value.
fn word_of(channels: [u32; 4], is_srgb: bool) -> u32 {
    let code = |k: usize| {
        if is_srgb && k < 3 {
            channels[k] >> 8
        } else {
            (channels[k] * 255 + 32767) / 65536
        }
    };
    code(0) | code(1) << 8 | code(2) << 16 | code(3) << 24
}

/// The header of a block, and the position of its colours.
struct Header {
    grid: Grid,
    /// The endpoint mode of each partition, 0..=15: the encoding of its colours.
    modes: [u32; 4],
    partitions: usize,
    seed: u32,
    /// The channel of the second plane of weights.
    second_channel: Option<usize>,
    /// The bits between these hold the colours.
    colors: [u32; 2],
    weight_bits: u32,
}

impl Header {
    fn new(bits: u128, [width, height]: [usize; 2]) -> Option<Self> {
        let grid = Grid::new(field(bits, 0, 11))?;
        let count = grid.width * grid.height * grid.planes;
        let weight_bits = grid.range.bits_of(count);
        let partitions = field(bits, 11, 2) as usize + 1;
        if grid.width > width
            || grid.height > height
            || count > MAX_WEIGHTS
            || !(24..=96).contains(&weight_bits)
            || partitions == 4 && grid.planes == 2
        {
            return None;
        }
        let mut end = 128 - weight_bits;
        let mut modes = [field(bits, 13, 4); 4];
        let (mut begin, mut seed) = (17, 0);
        if partitions > 1 {
            begin = 29;
            seed = field(bits, 13, 10);
            let selector = field(bits, 23, 6);
            let class = selector & 3;
            modes = [selector >> 2; 4];
            if class != 0 {
                // Each partition is of this class or the next: a bit each; then two bits each for
                // its kind. The remaining bits are stored below the weights.
                let extra = 3 * partitions as u32 - 4;
                end -= extra;
                let all = selector >> 2 | field(bits, end, extra) << 4;
                for (index, mode) in (0..).zip(modes.iter_mut().take(partitions)) {
                    let is_next = all >> index & 1;
                    let kind = all >> (partitions as u32 + 2 * index) & 3;
                    *mode = (class - 1 + is_next) << 2 | kind;
                }
            }
        }
        let mut second_channel = None;
        if grid.planes == 2 {
            end -= 2;
            second_channel = Some(field(bits, end, 2) as usize);
        }
        Some(Self {
            grid,
            modes,
            partitions,
            seed,
            second_channel,
            colors: [begin, end],
            weight_bits,
        })
    }

    /// The endpoints of the partitions; HDR endpoints are `None`.
    fn ends(&self, bits: u128, is_srgb: bool) -> Option<[Option<Ends>; 4]> {
        let [begin, end] = self.colors;
        let modes = &self.modes[..self.partitions];
        let counts = modes.iter().map(|mode| (mode >> 2) as usize * 2 + 2);
        let count: usize = counts.sum();
        let room = end.checked_sub(begin)?;
        if count > 18 {
            return None;
        }
        // The finest range for which there is room, six levels at least.
        let ranges = LEVELS.iter().map(|levels| Range::of(*levels));
        let range = ranges.rev().find(|range| range.bits_of(count) <= room)?;
        if range.levels() < 6 {
            return None;
        }
        let mut values = [0; 18];
        range.read(
            bits >> begin & ((1 << range.bits_of(count)) - 1),
            &mut values[..count],
        );
        let mut left = values
            .map(|value| range.color_of(value).cast_signed())
            .into_iter();
        let mut ends = [None; 4];
        for (ends, mode) in ends.iter_mut().zip(modes) {
            let mut of_partition = [0; 8];
            let count = (mode >> 2) as usize * 2 + 2;
            for (to, value) in of_partition.iter_mut().zip(left.by_ref().take(count)) {
                *to = value;
            }
            *ends = ends_of(*mode, of_partition, is_srgb);
        }
        Some(ends)
    }
}

fn decode_texels(bits: u128, size: [usize; 2], is_srgb: bool, words: &mut [u32]) -> Option<()> {
    let header = Header::new(bits, size)?;
    let ends = header.ends(bits, is_srgb)?;
    let Grid {
        width,
        height,
        planes,
        range,
    } = &header.grid;
    // Weights are read from the highest bit downwards.
    let reversed = bits.reverse_bits() & ((1 << header.weight_bits) - 1);
    let mut weights = [0; MAX_WEIGHTS];
    let count = width * height * planes;
    range.read(reversed, &mut weights[..count]);
    for weight in &mut weights[..count] {
        *weight = range.weight_of(*weight);
    }
    for (index, word) in words.iter_mut().enumerate() {
        let place = [index % size[0], index / size[0]];
        let partition = if header.partitions == 1 {
            0
        } else {
            let is_small = size[0] * size[1] < 31;
            partition_of(header.seed, place, header.partitions as u32, is_small)
        };
        let Some([first, second]) = ends[partition] else {
            *word = MAGENTA;
            continue;
        };
        let mixed = std::array::from_fn(|k| {
            let plane = usize::from(header.second_channel == Some(k));
            let weight = stretched(&weights, &header.grid, size, place, plane);
            (first[k] * (64 - weight) + second[k] * weight + 32) >> 6
        });
        *word = word_of(mixed, is_srgb);
    }
    Some(())
}

/// A texel's weight, 0 to 64, from the four of the grid around it.
fn stretched(
    weights: &[u32; MAX_WEIGHTS],
    grid: &Grid,
    size: [usize; 2],
    place: [usize; 2],
    plane: usize,
) -> u32 {
    // In sixteenths of the grid's spacing.
    let along = |k: usize, count: usize| {
        let scale = (1024 + size[k] / 2) / (size[k] - 1);
        let at = (scale * place[k] * (count - 1) + 32) >> 6;
        (at >> 4, (at & 15) as u32)
    };
    let ((x, fx), (y, fy)) = (along(0, grid.width), along(1, grid.height));
    let lower_right = (fx * fy + 8) >> 4;
    let shares = [
        16 + lower_right - fx - fy,
        fx - lower_right,
        fy - lower_right,
        lower_right,
    ];
    let first = y * grid.width + x;
    let corners = [first, first + 1, first + grid.width, first + grid.width + 1];
    let mut sum = 8;
    for (share, corner) in shares.into_iter().zip(corners) {
        // Weights beyond the grid have no share.
        let weight = weights.get(corner * grid.planes + plane);
        sum += share * weight.copied().unwrap_or_default();
    }
    sum >> 4
}

/// The partition of a texel: a hash of the seed chooses four slopes, and the greatest wins (section
/// 23.21).
fn partition_of(seed: u32, place: [usize; 2], count: u32, is_small: bool) -> usize {
    let [x, y] = place.map(|at| (at as u32) << u32::from(is_small));
    let seed = seed + (count - 1) * 1024;
    let number = hashed(seed);
    let shift = if seed & 2 == 0 { 5 } else { 4 };
    let other = if count == 3 { 6 } else { 5 };
    let [even, odd] = if seed & 1 == 1 {
        [shift, other]
    } else {
        [other, shift]
    };
    let slope = |low: u32, by: u32| {
        let four = number >> low & 15;
        (four * four) >> by
    };
    let value = |low: u32, offset: u32| {
        let sum = slope(low, even) * x + slope(low + 4, odd) * y + (number >> offset);
        sum & 63
    };
    let a = value(0, 14);
    let b = value(8, 10);
    let c = if count < 3 { 0 } else { value(16, 6) };
    let d = if count < 4 { 0 } else { value(24, 2) };
    if a >= b && a >= c && a >= d {
        0
    } else if b >= c && b >= d {
        1
    } else if c >= d {
        2
    } else {
        3
    }
}

fn hashed(mut p: u32) -> u32 {
    p ^= p >> 15;
    p = p.wrapping_sub(p << 17);
    p = p.wrapping_add(p << 7);
    p = p.wrapping_add(p << 4);
    p ^= p >> 5;
    p = p.wrapping_add(p << 16);
    p ^= p >> 7;
    p ^= p >> 3;
    p ^= p << 6;
    p ^ (p >> 17)
}
