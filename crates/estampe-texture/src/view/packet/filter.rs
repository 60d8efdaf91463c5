//! Filters of half floats: taps of one texture at shifts from a place, for packet after packet.
//!
//! All packets have the same shifts, so it is known before any coordinate is read which taps stand
//! in the same columns, and which in the same rows. Of a packet, columns and rows are found once
//! for each shift of u and of v: for the 13 taps of a downsampling filter five times. A row of
//! texels is loaded and filtered along x once for all taps of the same columns.
//!
//! Sixteen packets that are a square share more: see `square.rs`. Of other packets columns and rows
//! of some are found before any is filtered: the steps that lead to them take long, and no packet
//! waits for another. The arithmetic of each tap is that of `block.rs`, in
//! the same order, so the bits are the same.

use super::ahead::Ahead;
use super::block::{BlockLevel, Footprint, Spot, columns_and_rows};
use super::planes::Planes;
use super::shifts::TapShifts;
use super::square::{PACKETS, SquareLines, SquarePlaces};
use super::taps::{Lines, MOST_LINES, MOST_TAPS, all_of};
use crate::PacketPlaces;
use crate::view::SampledTexture;
use crate::view::coordinates::{Answers, packet};
use estampe_simd::{
    LANES, Lanes as SimdLanes, Packet as Values, SimdBase, SimdSplit, dispatch, f32x16,
};
use estampe_types::AddressMode;
use std::cell::RefCell;

/// Columns and rows that are found before texels are filtered: of two packets or more.
const MOST_SPOTS: usize = 2 * MOST_TAPS;

thread_local! {
    /// Memory that a batch need not clear.
    static PLACES: RefCell<Places> = const {
        RefCell::new(Places {
            spots: [[Values([0.0; LANES]); 2]; MOST_SPOTS],
            found: [Found::NONE; MOST_TAPS],
            lines: [Values([0.0; LANES]); MOST_LINES + 1],
            square: SquarePlaces::NONE,
            square_lines: SquareLines::NONE,
            planes: Planes::NONE,
        })
    };
}

/// The columns and rows of some packets.
struct Places {
    spots: [Spot; MOST_SPOTS],
    /// By packet.
    found: [Found; MOST_TAPS],
    /// Rows of texels of one packet.
    lines: [Values<f32>; MOST_LINES + 1],
    square: SquarePlaces,
    square_lines: SquareLines,
    planes: Planes,
}

const _: () = assert!(PACKETS == MOST_TAPS, "a square is a batch");

/// The taps of each of several packets, at most [`MOST_TAPS`], that were not sampled: bit `i` is
/// tap `i`.
pub(crate) type OtherTaps = [u32; MOST_TAPS];

impl SampledTexture {
    /// How many taps of [`sample_shifted`](Self::sample_shifted) are filtered in blocks; tests see by
    /// it which way the taps take.
    #[doc(hidden)]
    #[must_use]
    pub fn filtered_taps(&self, places: &PacketPlaces<'_>, shifts: &TapShifts) -> usize {
        let mut colors = vec![Answers::default(); MOST_TAPS * shifts.of_taps().len()];
        let others = |places: PacketPlaces<'_>| {
            let count = places.each().count();
            let others = self.sample_filter(&places, (shifts, true), &mut colors);
            let others = others[..count]
                .iter()
                .map(|taps| taps.count_ones() as usize);
            count * shifts.of_taps().len() - others.sum::<usize>()
        };
        places.chunks(MOST_TAPS).map(others).sum()
    }

    /// True if sixteen packets of [`sample_shifted`](Self::sample_shifted) are filtered as a square;
    /// tests see by it which way they take.
    #[doc(hidden)]
    #[must_use]
    pub fn filters_a_square(&self, places: &PacketPlaces<'_>, shifts: &TapShifts) -> bool {
        let mut colors = vec![Answers::default(); PACKETS * shifts.of_taps().len()];
        let (mut square, mut lines) = (SquarePlaces::NONE, SquareLines::NONE);
        let mut planes = Planes::NONE;
        dispatch!(@specialized_move self.level, s => {
            let Some(level) = BlockLevel::new(s, self, &self.view.planes[0]) else {
                return false;
            };
            let (of, mut ahead) = ((places, shifts, true), Ahead::default());
            let memory = (&mut square, &mut lines, &mut planes);
            let others = level.filter_square::<false>(s, of, memory, &mut ahead, &mut colors);
            places.each().count() == PACKETS && others.is_some()
        }, others => false)
    }

    /// Samples the finest level, which [may have blocks](Self::may_have_blocks), at shifts from a
    /// place in each of up to [`MOST_TAPS`] packets, as far as they are blocks; returns the others,
    /// of which nothing is stored that counts.
    pub(in crate::view) fn sample_filter(
        &self,
        places: &PacketPlaces<'_>,
        (shifts, reads_alpha): (&TapShifts, bool),
        colors: &mut [Answers],
    ) -> OtherTaps {
        let all = [all_of(shifts.of_taps().len()); MOST_TAPS];
        PLACES.with_borrow_mut(|memory| {
            dispatch!(@specialized_move self.level, s => {
                let Some(level) = BlockLevel::new(s, self, &self.view.planes[0]) else {
                    return all;
                };
                let of = (&level, (shifts, reads_alpha), memory);
                // Clamping is most common, and needs few of the constants that wrapping does.
                if level.mode == AddressMode::ClampToEdge {
                    self.sample_packets_filtered::<_, true>(s, of, places, colors)
                } else {
                    self.sample_packets_filtered::<_, false>(s, of, places, colors)
                }
            }, others => all)
        })
    }

    /// `CLAMPS` says that the mode is to clamp.
    #[inline(always)]
    fn sample_packets_filtered<S: SimdLanes, const CLAMPS: bool>(
        &self,
        s: S,
        (level, (shifts, reads_alpha), memory): (
            &BlockLevel<'_, S>,
            (&TapShifts, bool),
            &mut Places,
        ),
        places: &PacketPlaces<'_>,
        colors: &mut [Answers],
    ) -> OtherTaps {
        let mut others = OtherTaps::default();
        let Places {
            spots,
            found,
            lines,
            square,
            square_lines,
            planes,
        } = memory;
        let taps = shifts.of_taps().len();
        let mut ahead = Ahead::default();
        if let Some(uv) = places.each().next()
            && colors.len() == taps * PACKETS
        {
            let plane = &self.view.planes[0];
            ahead = Ahead::new(level.rows(), plane, uv, shifts);
            let of = (places, shifts, reads_alpha);
            let memory = (square, square_lines, planes);
            if let Some(others) = level.filter_square::<CLAMPS>(s, of, memory, &mut ahead, colors) {
                return others;
            }
        }
        let mut coordinates = places.each();
        let mut packets = colors.chunks_exact_mut(taps).zip(&mut others);
        loop {
            let mut count = 0;
            for (spots, found) in spots.chunks_exact_mut(shifts.spot_count).zip(&mut *found) {
                let Some(uv) = coordinates.next() else {
                    break;
                };
                level.find_all::<CLAMPS>(s, uv, shifts, (spots, found));
                count += 1;
            }
            let of_packets = spots.chunks_exact(shifts.spot_count).zip(&*found);
            for (of_packet, (colors, others)) in of_packets.take(count).zip(&mut packets) {
                ahead.step(s);
                *others = level.filter_all::<CLAMPS>(s, shifts, of_packet, colors, lines);
            }
            if count == 0 {
                return others;
            }
        }
    }
}

/// The lanes of a packet's columns and rows whose texels have neighbours.
#[derive(Clone, Copy)]
pub(super) struct Found {
    /// True if all texels have a neighbour in the level.
    pub(super) is_inside: bool,
    /// For each shift the lanes whose texels have.
    pub(super) has_next: [u16; MOST_TAPS],
    /// For each shift the lanes whose texels are neighbours of each other.
    pub(super) neighbours: [u16; MOST_TAPS],
}

/// The lanes of columns and of rows.
pub(super) const COLUMNS: u16 = 0xF;
pub(super) const ROWS: u16 = 0xF0;

impl Found {
    pub(super) const NONE: Self = Self {
        is_inside: false,
        has_next: [0; MOST_TAPS],
        neighbours: [0; MOST_TAPS],
    };

    /// True if the texels of a row, of which a tap has the number, have a neighbour.
    #[inline(always)]
    fn is_inside(&self, row: usize) -> bool {
        self.is_inside || self.has_next[row] & ROWS == ROWS
    }

    /// True if columns and rows are each four neighbours.
    #[inline(always)]
    fn are_neighbours(&self, column: usize, row: usize) -> bool {
        self.neighbours[column % MOST_TAPS] & COLUMNS | self.neighbours[row] & ROWS
            == COLUMNS | ROWS
    }
}

impl<S: SimdLanes> BlockLevel<'_, S> {
    /// Finds columns and rows at all shifts from the place (u, v).
    #[inline(always)]
    fn find_all<const CLAMPS: bool>(
        &self,
        s: S,
        uv: [&Values<f32>; 2],
        shifts: &TapShifts,
        (spots, found): (&mut [Spot], &mut Found),
    ) {
        let (both, stands) = columns_and_rows(s, uv);
        self.find_shifts::<CLAMPS>(s, both, shifts, (spots, found));
        if s.bits_of_mask(stands) != u16::MAX {
            found.is_inside = false;
            found.has_next = [0; MOST_TAPS];
        }
    }

    /// Finds columns and rows at all shifts from those whose coordinates are given, two shifts at a
    /// time. Of spots, the lanes that are not of columns and rows are unspecified.
    #[inline(always)]
    pub(super) fn find_shifts<const CLAMPS: bool>(
        &self,
        s: S,
        both: f32x16<S>,
        shifts: &TapShifts,
        (spots, found): (&mut [Spot], &mut Found),
    ) {
        let mut inside = u16::MAX;
        let (of_next, _) = found.has_next.as_chunks_mut::<2>();
        let (of_neighbours, _) = found.neighbours.as_chunks_mut::<2>();
        let found_of = of_next.iter_mut().zip(of_neighbours);
        let pairs = spots.chunks_mut(2).zip(&shifts.pairs);
        for ((spots, shift), (of_next, of_neighbours)) in pairs.zip(found_of) {
            let shifted = both + f32x16::load_array_ref(s, &shift.0);
            let (values, [has_next, neighbours]) = self.place::<CLAMPS>(s, shifted);
            store_halves(values[0], spots, 0);
            store_halves(values[1], spots, 1);
            *of_next = has_next.to_le_bytes().map(u16::from);
            *of_neighbours = neighbours.to_le_bytes().map(u16::from);
            inside &= has_next;
        }
        found.is_inside = inside == u16::MAX;
    }

    /// Filters the taps of a packet; returns those that are no blocks.
    #[inline(always)]
    fn filter_all<const CLAMPS: bool>(
        &self,
        s: S,
        shifts: &TapShifts,
        (spots, found): (&[Spot], &Found),
        colors: &mut [Answers],
        lines: &mut [Values<f32>; MOST_LINES + 1],
    ) -> u32 {
        let mut others = 0;
        for (column, (columns, &taps)) in spots.iter().zip(&shifts.columns).enumerate() {
            if taps == 0 {
                break;
            }
            if !found.is_inside && found.has_next[column % MOST_TAPS] & COLUMNS != COLUMNS {
                others |= taps;
                continue;
            }
            let is_done = !taps.is_power_of_two() && {
                let of_column = (columns, column);
                self.filter_column::<CLAMPS>(s, shifts, (of_column, spots, found), colors, lines)
            };
            let mut left = if is_done { 0 } else { taps };
            while left != 0 {
                let tap = left.trailing_zeros() as usize;
                left &= left - 1;
                let row = shifts.row_of(tap);
                let (Some(rows), Some(colors), true) =
                    (spots.get(row), colors.get_mut(tap), found.is_inside(row))
                else {
                    others |= 1 << tap;
                    continue;
                };
                let footprint = Footprint { columns, rows };
                match self.filter(s, footprint, found.are_neighbours(column, row)) {
                    Some([r, g, b, a]) => {
                        *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
                    }
                    None => others |= 1 << tap,
                }
            }
        }
        others
    }

    /// Filters the taps of a column together. False, with nothing stored that counts, if that
    /// cannot be done.
    #[inline(always)]
    fn filter_column<const CLAMPS: bool>(
        &self,
        s: S,
        shifts: &TapShifts,
        ((columns, column), spots, found): ((&Spot, usize), &[Spot], &Found),
        colors: &mut [Answers],
        lines: &mut [Values<f32>; MOST_LINES + 1],
    ) -> bool {
        let taps = shifts.columns[column % MOST_TAPS];
        let mut of = Lines::NONE;
        if CLAMPS && shifts.is_finite && found.is_inside {
            for row in shifts.ends[column % MOST_TAPS] {
                if let Some(rows) = spots.get(usize::from(row)) {
                    of.add(Footprint { columns, rows });
                }
            }
        } else {
            let mut left = taps;
            while left != 0 {
                let row = shifts.row_of(left.trailing_zeros() as usize);
                left &= left - 1;
                let (Some(rows), true) = (spots.get(row), found.is_inside(row)) else {
                    return false;
                };
                of.add(Footprint { columns, rows });
            }
        }
        let are_neighbours = found.neighbours[column % MOST_TAPS] & COLUMNS == COLUMNS;
        let columns_and_kind = (Footprint::of(columns), are_neighbours);
        if !self.filter_lines(s, columns_and_kind, &of, lines) {
            return false;
        }
        let mut left = taps;
        while left != 0 {
            let tap = left.trailing_zeros() as usize;
            left &= left - 1;
            let (Some(rows), Some(colors)) = (spots.get(shifts.row_of(tap)), colors.get_mut(tap))
            else {
                return false;
            };
            let [r, g, b, a] = of.between(s, Footprint { columns, rows }, lines);
            *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
        }
        true
    }
}

/// Stores one value of two spots, or of one.
#[inline(always)]
fn store_halves<S: SimdLanes>(value: f32x16<S>, spots: &mut [Spot], at: usize) {
    let (first, second) = value.split();
    let [spot, next @ ..] = spots else {
        return;
    };
    first.store_slice(&mut spot[at].0[..LANES / 2]);
    if let [spot, ..] = next {
        second.store_slice(&mut spot[at].0[..LANES / 2]);
    }
}
