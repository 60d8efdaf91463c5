//! ETC2 and EAC blocks, after the Khronos Data Format Specification 1.3, chapters 21 and 22.
//!
//! A block is a big-endian number of 64 bits. Its texels are numbered down the columns: texel i is
//! at (i / 4, i % 4).

#![expect(
    clippy::cast_possible_truncation,
    reason = "fields have at most 8 bits, and a block 16 texels"
)]

use estampe_types::TextureFormat;

/// Table 105: the distances of intensities within a subblock.
const INTENSITIES: [[i32; 2]; 8] = [
    [2, 8],
    [5, 17],
    [9, 29],
    [13, 42],
    [18, 60],
    [24, 80],
    [33, 106],
    [47, 183],
];

/// The distances of modes T and H.
const DISTANCES: [i32; 8] = [3, 6, 11, 16, 23, 32, 41, 64];

/// The modifiers of EAC.
const MODIFIERS: [[i32; 8]; 16] = [
    [-3, -6, -9, -15, 2, 5, 8, 14],
    [-3, -7, -10, -13, 2, 6, 9, 12],
    [-2, -5, -8, -13, 1, 4, 7, 12],
    [-2, -4, -6, -13, 1, 3, 5, 12],
    [-3, -6, -8, -12, 2, 5, 7, 11],
    [-3, -7, -9, -11, 2, 6, 8, 10],
    [-4, -7, -8, -11, 3, 6, 7, 10],
    [-3, -5, -8, -11, 2, 4, 7, 10],
    [-2, -6, -8, -10, 1, 5, 7, 9],
    [-2, -5, -8, -10, 1, 4, 7, 9],
    [-2, -4, -8, -10, 1, 3, 7, 9],
    [-2, -5, -7, -10, 1, 4, 6, 9],
    [-3, -4, -7, -10, 2, 3, 6, 9],
    [-1, -2, -3, -10, 0, 1, 2, 9],
    [-4, -6, -8, -9, 3, 5, 7, 8],
    [-3, -5, -7, -9, 2, 4, 6, 8],
];

/// Decodes a block to the words that are stored.
pub(super) fn decode(format: TextureFormat, block: &[u8], words: &mut [u32]) {
    use TextureFormat as F;
    let number = |at: usize| {
        let bytes = block.get(at..at + 8).and_then(|b| b.try_into().ok());
        u64::from_be_bytes(bytes.unwrap_or_default())
    };
    match format {
        F::Etc2Rgb8Unorm | F::Etc2Rgb8UnormSrgb => colors(number(0), false, words),
        F::Etc2Rgb8A1Unorm | F::Etc2Rgb8A1UnormSrgb => colors(number(0), true, words),
        F::Etc2Rgba8Unorm | F::Etc2Rgba8UnormSrgb => {
            colors(number(8), false, words);
            let alpha = number(0);
            for texel in 0..16 {
                let [base, multiplier, modifier] = eac(alpha, texel);
                let code = (base + modifier * multiplier).clamp(0, 255).cast_unsigned();
                let word = &mut words[row_order(texel)];
                *word = *word & 0xFF_FFFF | code << 24;
            }
        }
        F::EacR11Unorm | F::EacR11Snorm => {
            channel(number(0), format == F::EacR11Snorm, words, 1, 0);
        }
        F::EacRg11Unorm | F::EacRg11Snorm => {
            channel(number(0), format == F::EacRg11Snorm, words, 2, 0);
            channel(number(8), format == F::EacRg11Snorm, words, 2, 1);
        }
        _ => {}
    }
}

/// Converts a column-wise index to a row-wise one.
fn row_order(texel: usize) -> usize {
    texel % 4 * 4 + texel / 4
}

/// Base, multiplier and modifier of a texel.
fn eac(block: u64, texel: usize) -> [i32; 3] {
    let table = &MODIFIERS[field(block, 48, 4)];
    let modifier = table[field(block, 45 - 3 * texel as u32, 3)];
    [int(block, 56, 8), int(block, 52, 4), modifier]
}

/// One channel of 11 bits, as floats.
fn channel(block: u64, is_signed: bool, words: &mut [u32], stride: usize, at: usize) {
    for texel in 0..16 {
        let [base, multiplier, modifier] = eac(block, texel);
        // A multiplier of 0 counts as ⅛.
        let scaled = modifier * (multiplier * 8).max(1);
        let value = if is_signed {
            // −128 counts as −127.
            let base = ((base ^ 0x80) - 0x80).max(-127);
            (base * 8 + scaled).clamp(-1023, 1023) as f32 / 1023.0
        } else {
            (base * 8 + 4 + scaled).clamp(0, 2047) as f32 / 2047.0
        };
        words[row_order(texel) * stride + at] = value.to_bits();
    }
}

/// `count` bits of a block from bit `low` on.
fn field(block: u64, low: u32, count: u32) -> usize {
    // At most 8 bits.
    (block >> low & ((1 << count) - 1)) as usize
}

fn int(block: u64, low: u32, count: u32) -> i32 {
    field(block, low, count) as i32
}

/// The colours of a block; with `punch_through`, the bit that chooses between individual and
/// differential mode says instead whether all texels are opaque.
fn colors(block: u64, punch_through: bool, words: &mut [u32]) {
    let flag = int(block, 33, 1) == 1;
    let is_opaque = flag || !punch_through;
    if !flag && !punch_through {
        // Two colours of four bits a channel.
        let at = |low: u32| [low, low - 8, low - 16].map(|low| int(block, low, 4) * 17);
        return subblocks(block, [at(60), at(56)], is_opaque, words);
    }
    // A colour of five bits a channel and a difference of three, signed; sums beyond five bits are
    // other modes.
    let base = [59, 51, 43].map(|low| int(block, low, 5));
    let sum = [0, 1, 2].map(|k| base[k] + ((int(block, 56 - 8 * k as u32, 3) ^ 4) - 4));
    let beyond = sum.map(|channel| !(0..32).contains(&channel));
    match beyond {
        [true, ..] => mode_t(block, is_opaque, words),
        [_, true, _] => mode_h(block, is_opaque, words),
        [.., true] => planar(block, words),
        _ => {
            let eight = |five: [i32; 3]| five.map(|c| c << 3 | c >> 2);
            subblocks(block, [eight(base), eight(sum)], is_opaque, words);
        }
    }
}

/// The index of a texel: its bit in the upper half of the last 32 bits, then that in the lower
/// half.
fn index(block: u64, texel: usize) -> usize {
    field(block, 16 + texel as u32, 1) << 1 | field(block, texel as u32, 1)
}

fn color(rgb: [i32; 3]) -> u32 {
    let [r, g, b] = rgb.map(|c| c.clamp(0, 255).cast_unsigned());
    r | g << 8 | b << 16 | 0xFF00_0000
}

/// Individual and differential modes: each half has its base colour, and texels differ in
/// intensity.
fn subblocks(block: u64, bases: [[i32; 3]; 2], is_opaque: bool, words: &mut [u32]) {
    let is_flipped = int(block, 32, 1) == 1;
    let tables = [37, 34].map(|low| INTENSITIES[field(block, low, 3)]);
    for texel in 0..16 {
        let (x, y) = (texel / 4, texel % 4);
        let half = usize::from(if is_flipped { y } else { x } >= 2);
        let [small, large] = tables[half];
        let distance = match index(block, texel) {
            0 => {
                if is_opaque {
                    small
                } else {
                    0
                }
            }
            1 => large,
            2 if !is_opaque => {
                words[row_order(texel)] = 0;
                continue;
            }
            2 => -small,
            _ => -large,
        };
        words[row_order(texel)] = color(bases[half].map(|c| c + distance));
    }
}

/// Modes T and H: four paint colours, of which the third is transparent where not all texels are
/// opaque.
fn painted(block: u64, paints: [[i32; 3]; 4], is_opaque: bool, words: &mut [u32]) {
    for texel in 0..16 {
        let index = index(block, texel);
        words[row_order(texel)] = if index == 2 && !is_opaque {
            0
        } else {
            color(paints[index])
        };
    }
}

fn mode_t(block: u64, is_opaque: bool, words: &mut [u32]) {
    let first = [
        int(block, 59, 2) << 2 | int(block, 56, 2),
        int(block, 52, 4),
        int(block, 48, 4),
    ];
    let [first, second] =
        [first, [44, 40, 36].map(|low| int(block, low, 4))].map(|c| c.map(|c| c * 17));
    let distance = DISTANCES[field(block, 34, 2) << 1 | field(block, 32, 1)];
    let paints = [
        first,
        second.map(|c| c + distance),
        second,
        second.map(|c| c - distance),
    ];
    painted(block, paints, is_opaque, words);
}

fn mode_h(block: u64, is_opaque: bool, words: &mut [u32]) {
    let first = [
        int(block, 59, 4),
        int(block, 56, 3) << 1 | int(block, 52, 1),
        int(block, 51, 1) << 3 | int(block, 47, 3),
    ];
    let second = [int(block, 43, 4), int(block, 39, 4), int(block, 35, 4)];
    // The order of the two colours is the distance's lowest bit.
    let lowest = usize::from(first >= second);
    let distance = DISTANCES[field(block, 34, 1) << 2 | field(block, 32, 1) << 1 | lowest];
    let [first, second] = [first, second].map(|c| c.map(|c| c * 17));
    let paints = [
        first.map(|c| c + distance),
        first.map(|c| c - distance),
        second.map(|c| c + distance),
        second.map(|c| c - distance),
    ];
    painted(block, paints, is_opaque, words);
}

/// A colour at the origin, one at the right and one at the lower end; the mode is always opaque.
fn planar(block: u64, words: &mut [u32]) {
    let six = |c: i32| c << 2 | c >> 4;
    let seven = |c: i32| c << 1 | c >> 6;
    let origin = [
        six(int(block, 57, 6)),
        seven(int(block, 56, 1) << 6 | int(block, 49, 6)),
        six(int(block, 48, 1) << 5 | int(block, 43, 2) << 3 | int(block, 39, 3)),
    ];
    let right = [
        six(int(block, 34, 5) << 1 | int(block, 32, 1)),
        seven(int(block, 25, 7)),
        six(int(block, 19, 6)),
    ];
    let lower = [
        six(int(block, 13, 6)),
        seven(int(block, 6, 7)),
        six(int(block, 0, 6)),
    ];
    for texel in 0..16 {
        let (x, y) = ((texel / 4) as i32, (texel % 4) as i32);
        let rgb = [0, 1, 2].map(|k| {
            (x * (right[k] - origin[k]) + y * (lower[k] - origin[k]) + 4 * origin[k] + 2) >> 2
        });
        words[row_order(texel)] = color(rgb);
    }
}
