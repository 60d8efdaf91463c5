//! Rows of texels for a packet that is a block of 4×4 pixels: its columns and rows, and four texels
//! of four channels each in a register, as they lie in memory.
//!
//! A filter that needs whole rows then has a few loads of neighbours in place of sixteen loads of
//! squares.

use crate::{LANE_X, LANE_Y, Lanes};
use fearless_simd::{Bytes, SimdBase, f32x16, i32x16, u32x16};

/// The texels of a window of eight that belong to the four columns of a block.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(
    not(target_arch = "x86_64"),
    allow(dead_code, reason = "only the levels of x86-64 read them")
)]
pub struct Columns<S: Lanes> {
    /// For each of four times four floats its place among the window's 32.
    pub(crate) places: u32x16<S>,
    /// The left texel of each column: below [`Self::MOST`].
    pub(crate) texels: [usize; 4],
}

impl<S: Lanes> Columns<S> {
    /// The number of texels of a window.
    pub const WINDOW: usize = 8;
    /// Left texels are below this number, so that the right one is in the window, too.
    pub const MOST: usize = Self::WINDOW - 1;

    /// The columns whose left texels, in lanes 0 to 3, have these numbers, counted from `first`;
    /// `None` if one of them, or the texel after it, is not among eight.
    #[inline(always)]
    pub fn new(s: S, texel: i32x16<S>, first: i32) -> Option<Self> {
        let at = texel.to_array();
        let mut texels = [0; 4];
        let mut column = 0;
        while column < 4 {
            let texel = at[column].wrapping_sub(first).cast_unsigned() as usize;
            if texel >= Self::MOST {
                return None;
            }
            texels[column] = texel;
            column += 1;
        }
        let places = texel - i32x16::splat(s, first);
        Some(Self {
            places: s.places_of_texels(places.bitcast()),
            texels,
        })
    }
}

impl<S: Lanes> Columns<S> {
    /// True if all left texels, and those after them, are the window's first four.
    #[inline(always)]
    pub fn are_among_four(&self) -> bool {
        let [a, b, c, d] = self.texels;
        a.max(b).max(c.max(d)) < Self::WINDOW / 2 - 1
    }
}

/// The lanes of the first row of a block, from left to right, and of its first column, from above.
pub(crate) const COLUMNS_AND_ROWS: [usize; 8] = [0, 1, 4, 5, 0, 2, 8, 10];

/// A register whose lanes are those of another, in this order.
#[inline(always)]
pub(crate) fn permuted<S: Lanes>(s: S, value: f32x16<S>, order: [usize; 16]) -> f32x16<S> {
    let of = value.to_array();
    let mut permuted = of;
    let mut lane = 0;
    while lane < 16 {
        permuted[lane] = of[order[lane]];
        lane += 1;
    }
    f32x16::load_array(s, permuted)
}

/// [`Lanes::channels_of_rows`] lane by lane.
#[inline(always)]
pub(crate) fn channels<S: Lanes>(s: S, rows: [f32x16<S>; 4]) -> [f32x16<S>; 4] {
    let mut channels = [[0.0; 16]; 4];
    let mut lane = 0;
    while lane < 16 {
        let row = rows[usize::from(LANE_Y[lane])].to_array();
        let column = usize::from(LANE_X[lane]);
        let mut channel = 0;
        while channel < 4 {
            channels[channel][lane] = row[4 * column + channel];
            channel += 1;
        }
        lane += 1;
    }
    [
        f32x16::load_array(s, channels[0]),
        f32x16::load_array(s, channels[1]),
        f32x16::load_array(s, channels[2]),
        f32x16::load_array(s, channels[3]),
    ]
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::*;

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::Columns;
    use fearless_simd::x86::{Avx2, Avx512};
    use fearless_simd::{
        SimdBase, SimdCombine, SimdInto, SimdSplit, f32x8, f32x16, u32x4, u32x8, u32x16,
    };

    fearless_simd::kernel!(
        #[inline(always)]
        fn permute_512(
            simd: Avx512,
            value: f32x16<Avx512>,
            order: u32x16<Avx512>,
        ) -> f32x16<Avx512> {
            use core::arch::x86_64::*;
            _mm512_permutexvar_ps(order.into(), value.into()).simd_into(simd)
        }
    );

    fearless_simd::kernel!(
        #[inline(always)]
        fn choose_512(
            simd: Avx512,
            low: f32x16<Avx512>,
            order: u32x16<Avx512>,
            high: f32x16<Avx512>,
        ) -> f32x16<Avx512> {
            use core::arch::x86_64::*;
            _mm512_permutex2var_ps(low.into(), order.into(), high.into()).simd_into(simd)
        }
    );

    #[inline(always)]
    fn order_512(simd: Avx512, order: [u32; 16]) -> u32x16<Avx512> {
        u32x16::load_array(simd, order)
    }

    #[inline(always)]
    pub(crate) fn first_row_avx512(simd: Avx512, value: f32x16<Avx512>) -> f32x16<Avx512> {
        let order = order_512(simd, [0, 1, 0, 1, 4, 5, 4, 5, 0, 1, 0, 1, 4, 5, 4, 5]);
        permute_512(simd, value, order)
    }

    #[inline(always)]
    pub(crate) fn first_column_avx512(simd: Avx512, value: f32x16<Avx512>) -> f32x16<Avx512> {
        let order = order_512(simd, [0, 0, 2, 2, 0, 0, 2, 2, 8, 8, 10, 10, 8, 8, 10, 10]);
        permute_512(simd, value, order)
    }

    #[inline(always)]
    pub(crate) fn spread_avx512(simd: Avx512, value: f32x16<Avx512>) -> f32x16<Avx512> {
        permute_512(simd, value, order_512(simd, SPREAD))
    }

    /// Lanes 0 to 3, each four times.
    const SPREAD: [u32; 16] = [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3];

    #[inline(always)]
    pub(crate) fn columns_and_rows_avx512(
        simd: Avx512,
        columns: f32x16<Avx512>,
        rows: f32x16<Avx512>,
    ) -> f32x16<Avx512> {
        // Lanes of `rows` are numbered from 16 on.
        let order = [0, 1, 4, 5, 16, 18, 24, 26, 0, 1, 4, 5, 16, 18, 24, 26];
        choose_512(simd, columns, order_512(simd, order), rows)
    }

    #[inline(always)]
    pub(crate) fn places_avx512(simd: Avx512, texel: u32x16<Avx512>) -> u32x16<Avx512> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx512, texel: u32x16<Avx512>) -> u32x16<Avx512> {
                use core::arch::x86_64::*;
                let order = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
                let channel = _mm512_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
                let texel = _mm512_permutexvar_epi32(order, texel.into());
                _mm512_add_epi32(_mm512_slli_epi32::<2>(texel), channel).simd_into(simd)
            }
        );
        kernel(simd, texel)
    }

    #[inline(always)]
    pub(crate) fn row_avx512(simd: Avx512, words: &[u32; 8]) -> f32x16<Avx512> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx512, words: u32x8<Avx512>) -> f32x16<Avx512> {
                use core::arch::x86_64::*;
                // The same as `_mm512_cvtph_ps` but for the form: this one may read memory.
                _mm512_cvt_roundph_ps::<_MM_FROUND_CUR_DIRECTION>(words.into()).simd_into(simd)
            }
        );
        kernel(simd, u32x8::load_array_ref(simd, words))
    }

    #[inline(always)]
    pub(crate) fn halves_avx512(
        simd: Avx512,
        window: &[u32; 16],
        columns: &Columns<Avx512>,
    ) -> [f32x16<Avx512>; 2] {
        let (words, _) = window.as_chunks::<8>();
        let low = row_avx512(simd, &words[0]);
        let high = row_avx512(simd, &words[1]);
        let left = columns.places;
        let right = left + u32x16::splat(simd, 4);
        [
            choose_512(simd, low, left, high),
            choose_512(simd, low, right, high),
        ]
    }

    #[inline(always)]
    pub(crate) fn halves_of_four_avx512(
        simd: Avx512,
        window: &[u32; 8],
        columns: &Columns<Avx512>,
    ) -> [f32x16<Avx512>; 2] {
        let texels = row_avx512(simd, window);
        let left = columns.places;
        let right = left + u32x16::splat(simd, 4);
        [
            permute_512(simd, texels, left),
            permute_512(simd, texels, right),
        ]
    }

    #[inline(always)]
    pub(crate) fn channels_avx512(simd: Avx512, rows: [f32x16<Avx512>; 4]) -> [f32x16<Avx512>; 4] {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx512, rows: [f32x16<Avx512>; 4]) -> [f32x16<Avx512>; 4] {
                use core::arch::x86_64::*;
                let [a, b, c, d] = rows;
                let [a, b, c, d] = [a.into(), b.into(), c.into(), d.into()];
                // The texels of each quad: one of four in each register.
                let upper_left = _mm512_shuffle_f32x4::<0b10_00_10_00>(a, c);
                let upper_right = _mm512_shuffle_f32x4::<0b11_01_11_01>(a, c);
                let lower_left = _mm512_shuffle_f32x4::<0b10_00_10_00>(b, d);
                let lower_right = _mm512_shuffle_f32x4::<0b11_01_11_01>(b, d);
                let upper = [
                    _mm512_castps_pd(_mm512_unpacklo_ps(upper_left, upper_right)),
                    _mm512_castps_pd(_mm512_unpackhi_ps(upper_left, upper_right)),
                ];
                let lower = [
                    _mm512_castps_pd(_mm512_unpacklo_ps(lower_left, lower_right)),
                    _mm512_castps_pd(_mm512_unpackhi_ps(lower_left, lower_right)),
                ];
                [
                    _mm512_castpd_ps(_mm512_unpacklo_pd(upper[0], lower[0])).simd_into(simd),
                    _mm512_castpd_ps(_mm512_unpackhi_pd(upper[0], lower[0])).simd_into(simd),
                    _mm512_castpd_ps(_mm512_unpacklo_pd(upper[1], lower[1])).simd_into(simd),
                    _mm512_castpd_ps(_mm512_unpackhi_pd(upper[1], lower[1])).simd_into(simd),
                ]
            }
        );
        kernel(simd, rows)
    }

    fearless_simd::kernel!(
        #[inline(always)]
        fn permute_256(simd: Avx2, value: f32x8<Avx2>, order: u32x8<Avx2>) -> f32x8<Avx2> {
            use core::arch::x86_64::*;
            _mm256_permutevar8x32_ps(value.into(), order.into()).simd_into(simd)
        }
    );

    #[inline(always)]
    fn order_256(simd: Avx2, order: [u32; 8]) -> u32x8<Avx2> {
        u32x8::load_array(simd, order)
    }

    #[inline(always)]
    pub(crate) fn first_row_avx2(simd: Avx2, value: f32x16<Avx2>) -> f32x16<Avx2> {
        let (low, _) = value.split();
        let row = permute_256(simd, low, order_256(simd, [0, 1, 0, 1, 4, 5, 4, 5]));
        row.combine(row)
    }

    #[inline(always)]
    pub(crate) fn first_column_avx2(simd: Avx2, value: f32x16<Avx2>) -> f32x16<Avx2> {
        let order = order_256(simd, [0, 0, 2, 2, 0, 0, 2, 2]);
        let (low, high) = value.split();
        permute_256(simd, low, order).combine(permute_256(simd, high, order))
    }

    #[inline(always)]
    pub(crate) fn spread_avx2(simd: Avx2, value: f32x16<Avx2>) -> f32x16<Avx2> {
        let (low, _) = value.split();
        let first = permute_256(simd, low, order_256(simd, [0, 0, 0, 0, 1, 1, 1, 1]));
        let second = permute_256(simd, low, order_256(simd, [2, 2, 2, 2, 3, 3, 3, 3]));
        first.combine(second)
    }

    fearless_simd::kernel!(
        /// Lanes 0, 1, 4 and 5 of columns; then 0 and 2 of both halves of rows.
        #[inline(always)]
        fn columns_and_row_256(
            simd: Avx2,
            columns: f32x8<Avx2>,
            upper: f32x8<Avx2>,
            lower: f32x8<Avx2>,
        ) -> f32x8<Avx2> {
            use core::arch::x86_64::*;
            let columns = _mm256_permute4x64_pd::<0b00_00_10_00>(_mm256_castps_pd(columns.into()));
            let columns = _mm256_castpd_ps(columns);
            let rows = _mm256_shuffle_ps::<0b10_00_10_00>(upper.into(), lower.into());
            _mm256_permute2f128_ps::<0x20>(columns, rows).simd_into(simd)
        }
    );

    #[inline(always)]
    pub(crate) fn columns_and_rows_avx2(
        simd: Avx2,
        columns: f32x16<Avx2>,
        rows: f32x16<Avx2>,
    ) -> f32x16<Avx2> {
        let ((columns, _), (upper, lower)) = (columns.split(), rows.split());
        let both = columns_and_row_256(simd, columns, upper, lower);
        both.combine(both)
    }

    fearless_simd::kernel!(
        #[inline(always)]
        fn decode(simd: Avx2, words: u32x4<Avx2>) -> f32x8<Avx2> {
            use core::arch::x86_64::*;
            _mm256_cvtph_ps(words.into()).simd_into(simd)
        }
    );

    #[inline(always)]
    pub(crate) fn row_avx2(simd: Avx2, words: &[u32; 8]) -> f32x16<Avx2> {
        let (words, _) = words.as_chunks::<4>();
        let low = decode(simd, u32x4::load_array_ref(simd, &words[0]));
        let high = decode(simd, u32x4::load_array_ref(simd, &words[1]));
        low.combine(high)
    }

    #[inline(always)]
    pub(crate) fn halves_avx2<const WORDS: usize>(
        simd: Avx2,
        window: &[u32; WORDS],
        columns: &Columns<Avx2>,
    ) -> [f32x16<Avx2>; 2] {
        fearless_simd::kernel!(
            #[inline(always)]
            fn divide(simd: Avx2, a: f32x8<Avx2>, b: f32x8<Avx2>) -> [f32x8<Avx2>; 2] {
                use core::arch::x86_64::*;
                let (a, b) = (a.into(), b.into());
                [
                    _mm256_permute2f128_ps::<0x20>(a, b).simd_into(simd),
                    _mm256_permute2f128_ps::<0x31>(a, b).simd_into(simd),
                ]
            }
        );
        let mut pairs = [f32x8::splat(simd, 0.0); 4];
        let mut column = 0;
        while column < 4 {
            // Texels are of two words, and each is before the window's last: the pair is in it.
            let at = 2 * columns.texels[column].min(WORDS / 2 - 2);
            let words = [window[at], window[at + 1], window[at + 2], window[at + 3]];
            pairs[column] = decode(simd, u32x4::load_array(simd, words));
            column += 1;
        }
        let [a, b, c, d] = pairs;
        let [left, right] = divide(simd, a, b);
        let [left_2, right_2] = divide(simd, c, d);
        [left.combine(left_2), right.combine(right_2)]
    }

    #[inline(always)]
    pub(crate) fn channels_avx2(simd: Avx2, rows: [f32x16<Avx2>; 4]) -> [f32x16<Avx2>; 4] {
        fearless_simd::kernel!(
            #[inline(always)]
            fn of_two_rows(
                simd: Avx2,
                upper: [f32x8<Avx2>; 2],
                lower: [f32x8<Avx2>; 2],
            ) -> [f32x8<Avx2>; 4] {
                use core::arch::x86_64::*;
                let [a, b] = [upper[0].into(), upper[1].into()];
                let [c, d] = [lower[0].into(), lower[1].into()];
                let upper_left = _mm256_permute2f128_ps::<0x20>(a, b);
                let upper_right = _mm256_permute2f128_ps::<0x31>(a, b);
                let lower_left = _mm256_permute2f128_ps::<0x20>(c, d);
                let lower_right = _mm256_permute2f128_ps::<0x31>(c, d);
                let upper = [
                    _mm256_castps_pd(_mm256_unpacklo_ps(upper_left, upper_right)),
                    _mm256_castps_pd(_mm256_unpackhi_ps(upper_left, upper_right)),
                ];
                let lower = [
                    _mm256_castps_pd(_mm256_unpacklo_ps(lower_left, lower_right)),
                    _mm256_castps_pd(_mm256_unpackhi_ps(lower_left, lower_right)),
                ];
                [
                    _mm256_castpd_ps(_mm256_unpacklo_pd(upper[0], lower[0])).simd_into(simd),
                    _mm256_castpd_ps(_mm256_unpackhi_pd(upper[0], lower[0])).simd_into(simd),
                    _mm256_castpd_ps(_mm256_unpacklo_pd(upper[1], lower[1])).simd_into(simd),
                    _mm256_castpd_ps(_mm256_unpackhi_pd(upper[1], lower[1])).simd_into(simd),
                ]
            }
        );
        let [a, b, c, d] = rows;
        let [a, b] = [a.split(), b.split()];
        let [c, d] = [c.split(), d.split()];
        let upper = of_two_rows(simd, [a.0, a.1], [b.0, b.1]);
        let lower = of_two_rows(simd, [c.0, c.1], [d.0, d.1]);
        [
            upper[0].combine(lower[0]),
            upper[1].combine(lower[1]),
            upper[2].combine(lower[2]),
            upper[3].combine(lower[3]),
        ]
    }
}
