//! [`TapShifts`]: where the taps of a filter stand, beside a place that differs from packet to packet.

use super::taps::MOST_TAPS;
use estampe_simd::{LANES, Packet as Values};

/// The shifts (u, v) of up to sixteen taps of a filter, and which of them stand in the same columns
/// and rows.
#[derive(Debug, Clone)]
pub struct TapShifts {
    /// By tap.
    of_taps: [[f32; 2]; MOST_TAPS],
    count: usize,
    /// The shifts of u in the lanes of columns, and those of v in the lanes of rows, each once, in
    /// the order of [`columns_and_rows`](estampe_simd::Lanes::columns_and_rows): in lanes 0 to 7
    /// those of an even number, in the others those of the next number. If there are fewer of one,
    /// its first is repeated; a last one without a next one fills all lanes.
    pub(super) pairs: [Values<f32>; MOST_TAPS / 2],
    /// The number of them that count.
    pub(super) spot_count: usize,
    /// For each shift of u its taps: bit `i` is tap `i`.
    pub(super) columns: [u32; MOST_TAPS],
    /// For each tap the number of its shift of v.
    rows: [u8; MOST_TAPS],
    /// For each shift of u the numbers of the least and the greatest shift of v of its taps.
    pub(super) ends: [[u8; 2]; MOST_TAPS],
    /// The least and the greatest shift of u, then of v.
    pub(super) extents: [[f32; 2]; 2],
    /// True if all shifts are finite, so that greater shifts lead to greater coordinates.
    pub(super) is_finite: bool,
}

impl TapShifts {
    /// One tap, at the place itself: unlike +0, −0 changes no coordinate.
    pub const UNSHIFTED: Self = Self {
        of_taps: [[-0.0; 2]; MOST_TAPS],
        count: 1,
        pairs: [Values([-0.0; LANES]); MOST_TAPS / 2],
        spot_count: 1,
        columns: {
            let mut columns = [0; MOST_TAPS];
            columns[0] = 1;
            columns
        },
        rows: [0; MOST_TAPS],
        ends: [[0; 2]; MOST_TAPS],
        extents: [[-0.0; 2]; 2],
        is_finite: true,
    };

    /// The shifts of each tap. Those beyond sixteen do not count.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "numbers of taps")]
    pub fn new(of_taps: &[[f32; 2]]) -> Self {
        let count = of_taps.len().min(MOST_TAPS);
        let of_taps = &of_taps[..count];
        let mut shifts = Self {
            count,
            columns: [0; MOST_TAPS],
            is_finite: of_taps.as_flattened().iter().all(|shift| shift.is_finite()),
            ..Self::UNSHIFTED
        };
        shifts.of_taps[..count].copy_from_slice(of_taps);
        let (mut along_u, mut along_v) = (Axis::default(), Axis::default());
        for (tap, [u, v]) in of_taps.iter().enumerate() {
            let (column, row) = (along_u.number_of(*u), along_v.number_of(*v));
            let [least, greatest] = &mut shifts.ends[column];
            let is_first = shifts.columns[column] == 0;
            if is_first || *v < along_v.values[usize::from(*least)] {
                *least = row as u8;
            }
            if is_first || *v > along_v.values[usize::from(*greatest)] {
                *greatest = row as u8;
            }
            shifts.columns[column] |= 1 << tap;
            shifts.rows[tap] = row as u8;
        }
        shifts.extents = [along_u.extent(), along_v.extent()];
        shifts.spot_count = along_u.count.max(along_v.count);
        for (pair, to) in shifts.pairs.iter_mut().enumerate() {
            for (lane, to) in to.0.iter_mut().enumerate() {
                let next = usize::from(lane >= LANES / 2 && 2 * pair + 1 < shifts.spot_count);
                let along = if lane % 8 < 4 { &along_u } else { &along_v };
                *to = along.get(2 * pair + next);
            }
        }
        shifts
    }

    /// True if these are the shifts.
    #[must_use]
    pub fn are(&self, of_taps: &[[f32; 2]]) -> bool {
        let known = self.of_taps().as_flattened().iter();
        let asked = of_taps.as_flattened().iter();
        known
            .map(|shift| shift.to_bits())
            .eq(asked.map(|shift| shift.to_bits()))
    }

    /// The shifts of each tap.
    pub(crate) fn of_taps(&self) -> &[[f32; 2]] {
        &self.of_taps[..self.count]
    }

    /// The number of a tap's shift of v.
    #[inline(always)]
    pub(super) fn row_of(&self, tap: usize) -> usize {
        usize::from(self.rows[tap % MOST_TAPS]) % MOST_TAPS
    }
}

/// The shifts along an axis, each once.
#[derive(Default)]
struct Axis {
    values: [f32; MOST_TAPS],
    count: usize,
}

impl Axis {
    /// The number of a shift. Zeros of either sign are one: they move no sample.
    fn number_of(&mut self, shift: f32) -> usize {
        let known = self.values[..self.count].iter();
        let number = known.take_while(|known| **known != shift).count();
        if number == self.count {
            self.values[number] = shift;
            self.count += 1;
        }
        number
    }

    /// A shift; the first one for numbers that there are none of.
    fn get(&self, number: usize) -> f32 {
        self.values[if number < self.count { number } else { 0 }]
    }

    fn extent(&self) -> [f32; 2] {
        let values = &self.values[..self.count];
        let least = values.iter().copied().fold(f32::INFINITY, f32::min);
        let greatest = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        [least, greatest]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lanes of a number of the shifts.
    fn spot(shifts: &TapShifts, number: usize) -> &[f32] {
        &shifts.pairs[number / 2].0[number % 2 * 8..][..8]
    }

    #[test]
    fn a_shift_without_a_next_one_fills_all_lanes() {
        let shifts = TapShifts::new(&[[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]);
        let of = |[u, v]: [f32; 2]| [u, u, u, u, v, v, v, v];
        assert_eq!(spot(&shifts, 1), of([2.0, 5.0]));
        assert_eq!(spot(&shifts, 2), of([3.0, 6.0]));
        assert_eq!(spot(&shifts, 3), of([3.0, 6.0]));
    }

    #[test]
    fn taps_of_a_square_stand_in_three_columns_and_rows() {
        let at = |tap: usize| [tap / 3, tap % 3].map(|at| at as f32 - 1.0);
        let taps: Vec<[f32; 2]> = (0..9).map(at).collect();
        let shifts = TapShifts::new(&taps);
        assert!(shifts.are(&taps) && !shifts.are(&taps[1..]) && shifts.is_finite);
        assert_eq!(shifts.spot_count, 3);
        assert_eq!(shifts.columns[..4], [0b111, 0b111_000, 0b111_000_000, 0]);
        assert_eq!(shifts.ends[..3], [[0, 2]; 3]);
        assert_eq!(shifts.extents, [[-1.0, 1.0]; 2]);
        for tap in 0..9 {
            assert_eq!(shifts.row_of(tap), tap % 3);
        }
        for (number, at) in [-1.0, 0.0, 1.0].into_iter().enumerate() {
            assert_eq!(spot(&shifts, number), [at; LANES / 2]);
        }
    }

    #[test]
    fn zeros_are_one_shift_and_the_first_is_repeated() {
        let shifts = TapShifts::new(&[[-0.0, 3.0], [0.0, -2.0], [0.0, 5.0]]);
        assert_eq!((shifts.spot_count, shifts.columns[0]), (3, 0b111));
        assert_eq!(shifts.ends[0], [1, 2]);
        let spots = [0, 1, 2].map(|number| spot(&shifts, number));
        let [columns, rows] = [0, 4].map(|lane| spots.iter().map(move |spot| spot[lane]));
        assert!(columns.eq([0.0; 3]) && rows.eq([3.0, -2.0, 5.0]));
    }

    #[test]
    fn shifts_that_are_no_numbers_are_no_order() {
        let taps = [[f32::NAN, 0.0], [f32::NAN, 1.0]];
        let shifts = TapShifts::new(&taps);
        assert!(shifts.are(&taps) && !shifts.is_finite);
        assert_eq!(shifts.spot_count, 2);
        assert!(!TapShifts::new(&[[0.0, f32::INFINITY]]).is_finite);
        assert!(TapShifts::UNSHIFTED.are(&[[-0.0; 2]]) && !TapShifts::UNSHIFTED.are(&[[0.0; 2]]));
    }
}
