//! Filters of half floats in squares of 16×16 pixels, as passes over a whole picture shade them:
//! sixteen packets in Morton order.
//!
//! Packets above each other stand in the same columns, packets beside each other in the same rows.
//! So columns and rows are found for the four packets of the diagonal alone, in place of sixteen.
//! The rows of texels that four packets above each other read overlap: for five taps along y, one
//! texel a pixel, they are 25 in place of four times 13. Each is loaded and filtered along x once.
//! The arithmetic of each tap is that of `block.rs`, in the same order, so the bits are the same.

use super::ahead::Ahead;
use super::block::{BlockLevel, Footprint, Spot, columns_and_rows};
use super::filter::{COLUMNS, Found, OtherTaps, ROWS};
use super::planes::Planes;
use super::shifts::TapShifts;
use super::taps::{Lines, MOST_TAPS};
use crate::PacketPlaces;
use crate::view::coordinates::{Answers, packet};
use estampe_simd::{LANES, Lanes as SimdLanes, Packet as Values, SimdBase, f32x16, words_of};
use estampe_types::morton::spread;

/// The packets along a side of a square, and all.
pub(super) const SIDE: usize = 4;
pub(super) const PACKETS: usize = SIDE * SIDE;

/// The rows of texels of a square are fewer: a power of two. In memory there is room for four more,
/// so that no line needs a test.
pub(super) const MOST_LINES: usize = 64;

/// The number of each packet: by row, then by column.
#[expect(clippy::cast_possible_truncation, reason = "numbers of packets")]
pub(super) const NUMBERS: [[usize; SIDE]; SIDE] = {
    let mut numbers = [[0; SIDE]; SIDE];
    let mut at = 0;
    while at < PACKETS {
        let (x, y) = (at % SIDE, at / SIDE);
        numbers[y][x] = (spread(x as u32) | spread(y as u32) << 1) as usize;
        at += 1;
    }
    numbers
};

/// Where the packets of a square stand in a level.
pub(super) struct SquarePlaces {
    /// The coordinates of each packet's columns and rows.
    of_packets: [Values<f32>; PACKETS],
    /// The columns and rows of the packets of the diagonal, at each shift.
    pub(super) spots: [[Spot; MOST_TAPS]; SIDE],
    found: [Found; SIDE],
    /// The first and the last of the upper rows of texels that their rows are in.
    pub(super) rows: [[[i32; 2]; MOST_TAPS]; SIDE],
}

/// Rows of texels of a square, filtered along x: memory that a square need not clear.
pub(super) struct SquareLines([Values<f32>; MOST_LINES + 4]);

impl SquareLines {
    pub(super) const NONE: Self = Self([Values([0.0; LANES]); MOST_LINES + 4]);
}

impl SquarePlaces {
    pub(super) const NONE: Self = Self {
        of_packets: [Values([0.0; LANES]); PACKETS],
        spots: [[[Values([0.0; LANES]); 2]; MOST_TAPS]; SIDE],
        found: [Found::NONE; SIDE],
        rows: [[[0; 2]; MOST_TAPS]; SIDE],
    };
}

impl<S: SimdLanes> BlockLevel<'_, S> {
    /// Filters the taps of sixteen packets, and returns those that are no blocks. `None`, with
    /// nothing stored that counts, if the packets are no square, or many rows of texels apart.
    #[inline(always)]
    pub(super) fn filter_square<const CLAMPS: bool>(
        &self,
        s: S,
        (places, shifts, reads_alpha): (&PacketPlaces<'_>, &TapShifts, bool),
        (square, lines, planes): (&mut SquarePlaces, &mut SquareLines, &mut Planes),
        ahead: &mut Ahead<'_>,
        colors: &mut [Answers],
    ) -> Option<OtherTaps> {
        if !find_packets(s, places, &mut square.of_packets)
            || !self.find_diagonal::<CLAMPS>(s, shifts, square)
        {
            return None;
        }
        let mut others = OtherTaps::default();
        if const { S::REGISTERS == 2 } && square.found.iter().all(|found| found.is_inside) {
            let of = (shifts, reads_alpha);
            if self.filter_planes(s, of, (&*square, planes), ahead, colors) {
                return Some(others);
            }
        }
        for x in 0..SIDE {
            for _ in 0..SIDE {
                ahead.step(s);
            }
            for (column, &taps) in shifts.columns.iter().enumerate() {
                if taps == 0 {
                    break;
                }
                let done = self.filter_tall_column::<CLAMPS>(
                    s,
                    shifts,
                    (x, column, square),
                    colors,
                    &mut lines.0,
                );
                for (numbers, done) in NUMBERS.iter().zip(done) {
                    others[numbers[x]] |= taps & !done;
                }
            }
        }
        Some(others)
    }

    /// Finds the columns and rows of the diagonal. False if they are in too many rows of texels.
    #[inline(always)]
    fn find_diagonal<const CLAMPS: bool>(
        &self,
        s: S,
        shifts: &TapShifts,
        square: &mut SquarePlaces,
    ) -> bool {
        let (mut top, mut bottom) = (i32::MAX, i32::MIN);
        for (number, numbers) in NUMBERS.iter().enumerate() {
            let both = f32x16::load_array_ref(s, &square.of_packets[numbers[number]].0);
            let spots = &mut square.spots[number][..shifts.spot_count];
            self.find_shifts::<CLAMPS>(s, both, shifts, (spots, &mut square.found[number]));
            for (spot, rows) in spots.iter().zip(&mut square.rows[number]) {
                let [_, _, _, _, a, b, c, d, ..] = words_of(spot)[1].0.map(u32::cast_signed);
                *rows = [a.min(b).min(c.min(d)), a.max(b).max(c.max(d))];
                top = top.min(rows[0]);
                bottom = bottom.max(rows[1]);
            }
        }
        (bottom.wrapping_sub(top).cast_unsigned() as usize) < MOST_LINES - 1
    }

    /// Filters the taps of one shift of u in four packets above each other; returns those of each
    /// that were filtered.
    #[inline(always)]
    fn filter_tall_column<const CLAMPS: bool>(
        &self,
        s: S,
        shifts: &TapShifts,
        (x, column, square): (usize, usize, &SquarePlaces),
        colors: &mut [Answers],
        lines: &mut [Values<f32>; MOST_LINES + 4],
    ) -> [u32; SIDE] {
        let column = column % MOST_TAPS;
        let taps = shifts.columns[column];
        let (columns, found) = (&square.spots[x][column], &square.found[x]);
        if found.has_next[column] & COLUMNS != COLUMNS {
            return [0; SIDE];
        }
        let mut inside = [taps; SIDE];
        let mut of = Lines::NONE;
        let of_rows = square.found.iter().zip(&square.rows);
        for (inside, (found, rows)) in inside.iter_mut().zip(of_rows) {
            if CLAMPS && shifts.is_finite && found.is_inside {
                for row in shifts.ends[column] {
                    of.add_rows(rows[usize::from(row) % MOST_TAPS]);
                }
                continue;
            }
            let mut left = taps;
            while left != 0 {
                let tap = left.trailing_zeros() as usize;
                left &= left - 1;
                let row = shifts.row_of(tap);
                if found.has_next[row] & ROWS == ROWS {
                    of.add_rows(rows[row]);
                } else {
                    *inside &= !(1 << tap);
                }
            }
        }
        let are_neighbours = found.neighbours[column] & COLUMNS == COLUMNS;
        if !self.filter_lines(s, (Footprint::of(columns), are_neighbours), &of, lines) {
            return [0; SIDE];
        }
        let each = shifts.of_taps().len();
        let of_rows = NUMBERS.iter().zip(&square.spots).zip(&square.found);
        for (((numbers, spots), found), inside) in of_rows.zip(inside) {
            let colors = colors.get_mut(numbers[x] * each..).unwrap_or_default();
            let mut left = inside;
            while left != 0 {
                let tap = left.trailing_zeros() as usize;
                left &= left - 1;
                let row = shifts.row_of(tap);
                let footprint = Footprint {
                    columns,
                    rows: &spots[row],
                };
                // In one register, five lines in place of eight gain nothing.
                let are_neighbours =
                    const { S::REGISTERS > 1 } && found.neighbours[row] & ROWS == ROWS;
                let [r, g, b, a] = if are_neighbours {
                    of.between_neighbours(s, footprint, lines)
                } else {
                    of.between(s, footprint, lines)
                };
                if let Some(colors) = colors.get_mut(tap) {
                    *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
                }
            }
        }
        inside
    }
}

/// Finds the coordinates of columns and rows of sixteen packets. False if they are no square.
#[inline(always)]
fn find_packets<S: SimdLanes>(
    s: S,
    places: &PacketPlaces<'_>,
    of_packets: &mut [Values<f32>; PACKETS],
) -> bool {
    // Lanes of masks are joined as they are: their bits are needed once.
    let mut stands = s.mask_from_bits(u16::MAX);
    for (uv, to) in places.each().zip(&mut *of_packets) {
        let (both, of_packet) = columns_and_rows(s, uv);
        stands &= of_packet;
        *to = packet(both, 0);
    }
    // In the lanes of columns those of the diagonal's packet in the same column of the square, in
    // the lanes of rows those of the one in the same row.
    let (mut columns, mut rows) = (stands, stands);
    for (y, numbers) in NUMBERS.iter().enumerate() {
        let beside = f32x16::load_array_ref(s, &of_packets[NUMBERS[y][y]].0);
        for (x, &number) in numbers.iter().enumerate() {
            let both = f32x16::load_array_ref(s, &of_packets[number].0);
            let above = f32x16::load_array_ref(s, &of_packets[NUMBERS[x][x]].0);
            columns &= both.simd_eq(above);
            rows &= both.simd_eq(beside);
        }
    }
    let (columns, rows) = (s.bits_of_mask(columns), s.bits_of_mask(rows));
    s.bits_of_mask(stands) == u16::MAX && columns & COLUMNS == COLUMNS && rows & ROWS == ROWS
}
