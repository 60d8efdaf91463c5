//! Filters of squares of sixteen packets, channel by channel, where a packet fills two registers.
//!
//! Rows of texels are decoded once for all taps, into a plane for each channel: so a channel that
//! nobody reads is left out, no texel is decoded as the left and the right one, and sixteen columns
//! are filtered in a step. The rows of all columns of the square are then filtered between, four
//! packets at a time. The arithmetic of each channel is that of `block.rs`, in the same order, so
//! the bits are the same.

use super::ahead::Ahead;
use super::block::BlockLevel;
use super::shifts::TapShifts;
use super::square::{MOST_LINES, NUMBERS, PACKETS, SIDE, SquarePlaces};
use super::taps::MOST_TAPS;
use crate::view::coordinates::{Answers, packet};
use estampe_simd::{
    Bytes, LANES, Lanes as SimdLanes, Packet as Values, SimdBase, SimdSplit, Window, f32x16,
    mask32x16, u32x16, words_of,
};

const CHANNELS: usize = 4;

/// The texels that are decoded together.
const TOGETHER: usize = 8;

/// Numbers that are loaded from a place in a row: more than are used, and never beyond the end.
const ROOM: usize = 2 * LANES;

/// The most numbers in planes.
const MOST: usize = 8192;

/// The order of [`channels_of_paired`](SimdLanes::channels_of_paired) for sixteen pixels of a row,
/// where a packet stands for a channel.
const PAIRED: [u32; LANES] = [0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15];

/// For each two texels the bytes of their first channels, then of their second ones, and so on.
const PAIRS_OF_BYTES: [u32; LANES] = {
    let pairs = [0x0908_0100, 0x0B0A_0302, 0x0D0C_0504, 0x0F0E_0706];
    let mut all = [0; LANES];
    let mut at = 0;
    while at < LANES {
        all[at] = pairs[at % 4];
        at += 1;
    }
    all
};

/// The words of each channel, one after the other.
const BY_CHANNEL: [u32; LANES] = [0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15];

/// Texels of a square, and rows of them filtered along x: memory that a square need not clear.
pub(super) struct Planes {
    /// Row by row the numbers of each channel.
    texels: [f32; MOST + ROOM],
    lines: ByChannel,
}

/// A row of each channel, filtered along x, beside the next one less this one.
type Line = [Values<f32>; 2];

/// Of each channel the line above the first row, which means nothing, and those of all rows.
type ByChannel = [[Line; MOST_LINES + 1]; CHANNELS];

impl Planes {
    pub(super) const NONE: Self = Self {
        texels: [0.0; MOST + ROOM],
        lines: [[[Values([0.0; LANES]); 2]; MOST_LINES + 1]; CHANNELS],
    };
}

/// The texels that a square reads.
#[derive(Clone, Copy)]
struct Reach {
    /// The first column and row.
    left: i32,
    top: i32,
    /// The numbers of a row of a channel.
    width: usize,
    /// The channels that are read.
    channels: usize,
}

/// How sixteen columns stand.
const NEIGHBOURS: usize = 0;
const APART: usize = 1;
const WINDOW: usize = 2;
const ANY: usize = 3;

impl<S: SimdLanes> BlockLevel<'_, S> {
    /// Filters all taps of a square whose columns and rows have been found, and of which all texels
    /// are inside. False, with nothing stored that counts, if they are far apart.
    #[inline(always)]
    pub(super) fn filter_planes(
        &self,
        s: S,
        (shifts, reads_alpha): (&TapShifts, bool),
        (square, planes): (&SquarePlaces, &mut Planes),
        ahead: &mut Ahead<'_>,
        colors: &mut [Answers],
    ) -> bool {
        let each = shifts.of_taps().len();
        if each == 0 || colors.len() != PACKETS * each {
            return false;
        }
        let channels = if reads_alpha { CHANNELS } else { CHANNELS - 1 };
        let Some(reach) = self.decode(s, (square, shifts), channels, (planes, &mut *ahead)) else {
            return false;
        };
        while ahead.row(s) {}
        for (column, &taps) in shifts.columns.iter().enumerate() {
            if taps == 0 {
                break;
            }
            let mut ends = [i32::MAX, 0];
            let mut left = taps;
            while left != 0 {
                let row = shifts.row_of(left.trailing_zeros() as usize);
                left &= left - 1;
                for rows in &square.rows {
                    ends = [ends[0].min(rows[row][0]), ends[1].max(rows[row][1])];
                }
            }
            let lines = ends.map(|row| row.wrapping_sub(reach.top).cast_unsigned() as usize);
            if !filter_along(s, (square, column), (reach, lines), planes) {
                return false;
            }
            let mut left = taps;
            while left != 0 {
                let tap = left.trailing_zeros() as usize;
                left &= left - 1;
                let of = (square, shifts.row_of(tap));
                if filter_between(s, of, reach, &planes.lines, (each, tap), colors).is_none() {
                    return false;
                }
            }
        }
        true
    }

    /// Decodes the texels of a square. `None` if they are too many, or not in memory.
    #[inline(always)]
    fn decode(
        &self,
        s: S,
        (square, shifts): (&SquarePlaces, &TapShifts),
        channels: usize,
        (planes, ahead): (&mut Planes, &mut Ahead<'_>),
    ) -> Option<Reach> {
        let (mut columns, mut rows) = ([i32::MAX, 0], [i32::MAX, 0]);
        for (spots, of_rows) in square.spots.iter().zip(&square.rows) {
            for (spot, [first, last]) in spots.iter().zip(of_rows).take(shifts.spot_count) {
                let [a, b, c, d, ..] = words_of(spot)[1].0.map(u32::cast_signed);
                columns[0] = columns[0].min(a.min(b).min(c.min(d)));
                columns[1] = columns[1].max(a.max(b).max(c.max(d)));
                rows = [rows[0].min(*first), rows[1].max(*last)];
            }
        }
        // With the texels after the last ones.
        let [width, height] = [columns, rows].map(|[first, last]| {
            let last = last.wrapping_sub(first).cast_unsigned() as usize;
            last.saturating_add(2)
        });
        let width = width.checked_next_multiple_of(TOGETHER)?;
        if height > MOST_LINES || width > MOST || width * height * channels > MOST {
            return None;
        }
        let reach = Reach {
            left: columns[0],
            top: rows[0],
            width,
            channels,
        };
        let mut words = self.texels_from(reach.left, reach.top)?;
        let rows = planes.texels.chunks_exact_mut(width * channels);
        for (row, to) in rows.take(height).enumerate() {
            if row > 0 {
                words = words.get(self.row_words..)?;
            }
            ahead.row(s);
            let (groups, _) = words.get(..2 * width)?.as_chunks::<LANES>();
            let (red, others) = to.split_at_mut_checked(width)?;
            let (green, others) = others.split_at_mut_checked(width)?;
            let (blue, alpha) = others.split_at_mut_checked(width)?;
            let (red, _) = red.as_chunks_mut::<TOGETHER>();
            let (green, _) = green.as_chunks_mut::<TOGETHER>();
            let (blue, _) = blue.as_chunks_mut::<TOGETHER>();
            let (alpha, _) = alpha.as_chunks_mut::<TOGETHER>();
            let to = red.iter_mut().zip(green).zip(blue);
            for (at, (group, ((red, green), blue))) in groups.iter().zip(to).enumerate() {
                let [red_green, blue_alpha] = decode_eight(s, group)?;
                let ((r, g), (b, a)) = (red_green.split(), blue_alpha.split());
                r.store_slice(red);
                g.store_slice(green);
                b.store_slice(blue);
                if let Some(alpha) = alpha.get_mut(at) {
                    a.store_slice(alpha);
                }
            }
        }
        Some(reach)
    }
}

/// Decodes eight texels: red and green, then blue and alpha. `None` if the level does not decode
/// half floats.
#[inline(always)]
fn decode_eight<S: SimdLanes>(s: S, texels: &[u32; LANES]) -> Option<[f32x16<S>; 2]> {
    // Of each two texels the channels in pairs, then the pairs of each channel.
    let pairs = u32x16::load_array(s, PAIRS_OF_BYTES).to_bytes();
    let texels = u32x16::load_array_ref(s, texels).swizzle_dyn_within_blocks(pairs);
    let halves = s
        .permute(texels, u32x16::load_array(s, BY_CHANNEL))
        .to_array();
    let (halves, _) = halves.as_chunks::<TOGETHER>();
    Some([s.row_of_halves(&halves[0])?, s.row_of_halves(&halves[1])?])
}

/// Filters rows of texels, from the first to the one after the last, between the columns of a
/// shift. False if columns are not among sixteen neighbours or a texel apart.
#[inline(always)]
fn filter_along<S: SimdLanes>(
    s: S,
    (square, column): (&SquarePlaces, usize),
    (reach, rows): (Reach, [usize; 2]),
    planes: &mut Planes,
) -> bool {
    let column = column % MOST_TAPS;
    let (mut texels, mut across) = ([0; LANES], [0.0; LANES]);
    let of_packets = texels.as_chunks_mut::<SIDE>().0.iter_mut();
    let of_packets = of_packets.zip(across.as_chunks_mut::<SIDE>().0);
    for ((texels, across), spots) in of_packets.zip(&square.spots) {
        let spot = &spots[column];
        texels.copy_from_slice(&words_of(spot)[1].0[..SIDE]);
        across.copy_from_slice(&spot[0].0[..SIDE]);
    }
    let left = reach.left.cast_unsigned();
    let first = texels[0].wrapping_sub(left);
    let from = u32x16::load_array(s, texels) - u32x16::splat(s, texels[0]);
    let steps = u32x16::load_array(s, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]);
    let across = f32x16::load_array(s, across);
    let of = (reach, rows);
    let are_neighbours: mask32x16<S> = from.simd_eq(steps);
    let none = Order::<S> {
        window: None,
        any: steps,
    };
    if s.bits_of_mask(are_neighbours) == u16::MAX {
        return filter_rows::<S, NEIGHBOURS>(s, of, (first, across), none, planes).is_some();
    }
    let are_apart: mask32x16<S> = from.simd_eq(steps + steps);
    if s.bits_of_mask(are_apart) == u16::MAX {
        let along = (first, in_pairs(s, across));
        return filter_rows::<S, APART>(s, of, along, none, planes).is_some();
    }
    let least = texels
        .iter()
        .fold(texels[0], |least, texel| least.min(*texel));
    let from = u32x16::load_array(s, texels) - u32x16::splat(s, least);
    let is_near: mask32x16<S> = from.simd_lt(u32x16::splat(s, 16));
    if s.bits_of_mask(is_near) != u16::MAX {
        return false;
    }
    let (from, across) = (in_pairs_of_words(s, from), in_pairs(s, across));
    let along = (least.wrapping_sub(left), across);
    let order = Order {
        window: Window::new(s, from),
        any: from,
    };
    if order.window.is_some() {
        filter_rows::<S, WINDOW>(s, of, along, order, planes).is_some()
    } else {
        filter_rows::<S, ANY>(s, of, along, order, planes).is_some()
    }
}

/// Of columns among sixteen neighbours, which each is.
struct Order<S: SimdLanes> {
    window: Option<Window<S>>,
    any: u32x16<S>,
}

/// [`filter_along`] for columns that stand in one way, from a column of planes on.
#[inline(always)]
fn filter_rows<S: SimdLanes, const HOW: usize>(
    s: S,
    (reach, [first_row, last_row]): (Reach, [usize; 2]),
    (first, across): (u32, f32x16<S>),
    order: Order<S>,
    planes: &mut Planes,
) -> Option<()> {
    let mut row = first_row;
    while row <= last_row.checked_add(1)? {
        let mut channel = 0;
        while channel < reach.channels {
            let at = (row * reach.channels + channel) * reach.width + first as usize;
            let values = planes.texels.get(at..)?.first_chunk::<ROOM>()?;
            let left: &[f32; LANES] = values.first_chunk()?;
            let right: &[f32; LANES] = values[1..].first_chunk()?;
            let [left, right] = match HOW {
                APART => {
                    let next: &[f32; LANES] = values.last_chunk()?;
                    let left = f32x16::load_array_ref(s, left);
                    let (left, right) = left.deinterleave(f32x16::load_array_ref(s, next));
                    [in_pairs(s, left), in_pairs(s, right)]
                }
                WINDOW => {
                    let window = order.window.as_ref()?;
                    [window.permute_f32(s, left), window.permute_f32(s, right)]
                }
                ANY => [
                    s.permute_f32(f32x16::load_array_ref(s, left), order.any),
                    s.permute_f32(f32x16::load_array_ref(s, right), order.any),
                ],
                _ => [
                    f32x16::load_array_ref(s, left),
                    f32x16::load_array_ref(s, right),
                ],
            };
            let filtered = left + (right - left) * across;
            let filtered = if HOW == NEIGHBOURS {
                in_pairs(s, filtered)
            } else {
                filtered
            };
            let lines = planes.lines[channel % CHANNELS].get_mut(row % MOST_LINES..)?;
            let [[above, down], [line, _]] = lines.first_chunk_mut()?;
            *down = packet(filtered - f32x16::load_array_ref(s, &above.0), 0);
            *line = packet(filtered, 0);
            channel += 1;
        }
        row += 1;
    }
    Some(())
}

/// Filters a tap of all packets between rows that are filtered along x. `None` if there are not as
/// many colours.
#[inline(always)]
fn filter_between<S: SimdLanes>(
    s: S,
    (square, row_of_tap): (&SquarePlaces, usize),
    reach: Reach,
    lines: &ByChannel,
    (each, tap): (usize, usize),
    colors: &mut [Answers],
) -> Option<()> {
    for (numbers, spots) in NUMBERS.iter().zip(&square.spots) {
        let spot = &spots[row_of_tap % MOST_TAPS];
        let mut at = [0; SIDE];
        for (at, texel) in at.iter_mut().zip(&words_of(spot)[1].0[SIDE..2 * SIDE]) {
            let line = texel.cast_signed().wrapping_sub(reach.top);
            *at = line.cast_unsigned() as usize % MOST_LINES;
        }
        // Packets beside each other are two, and two of the next quad of packets.
        let own = colors.get_mut(numbers[0] * each + tap..)?;
        let (a, own) = own.split_at_mut_checked(each)?;
        let (b, own) = own.split_at_mut_checked(3 * each)?;
        let (c, d) = own.split_at_mut_checked(each)?;
        let ([a, ..], [b, ..], [c, ..], [d, ..]) = (a, b, c, d) else {
            return None;
        };
        for (channel, lines) in lines.iter().enumerate().take(reach.channels) {
            let mut filtered = [<f32x16<S> as SimdBase<S>>::splat(s, 0.0); SIDE];
            let mut row = 0;
            while row < SIDE {
                let [upper, difference] = &lines[at[row] + 1];
                let upper = f32x16::load_array_ref(s, &upper.0);
                let difference = f32x16::load_array_ref(s, &difference.0);
                let down = f32x16::splat(s, spot[0].0[SIDE + row]);
                filtered[row] = upper + difference * down;
                row += 1;
            }
            let of_packets = s.channels_of_paired(filtered);
            a[channel] = packet(of_packets[0], 0);
            b[channel] = packet(of_packets[1], 0);
            c[channel] = packet(of_packets[2], 0);
            d[channel] = packet(of_packets[3], 0);
        }
    }
    Some(())
}

const _: () = {
    let mut row = 0;
    while row < SIDE {
        let [a, b, c, d] = NUMBERS[row];
        assert!(b == a + 1 && c == b + 3 && d == c + 1, "in Morton order");
        row += 1;
    }
};

#[inline(always)]
fn in_pairs<S: SimdLanes>(s: S, row: f32x16<S>) -> f32x16<S> {
    s.permute_f32(row, u32x16::load_array(s, PAIRED))
}

#[inline(always)]
fn in_pairs_of_words<S: SimdLanes>(s: S, row: u32x16<S>) -> u32x16<S> {
    s.permute(row, u32x16::load_array(s, PAIRED))
}
