//! Rows of four texels whose channels lie in pairs: r0 r1 g0 g1, r2 r3 g2 g3, b0 b1 a0 a1 and
//! b2 b3 a2 a3, where a row as in memory is r0 g0 b0 a0 and so on.
//!
//! Quads of a packet are two pixels of one row and two of the next, so channels of four such rows
//! need a third of the shuffles that those of rows as in memory do. A row that several packets or
//! taps of a filter need is brought into pairs once.

use crate::{LANE_X, LANE_Y, Lanes};
use fearless_simd::{SimdBase, f32x16};

/// For each place of a row in pairs the place in the row as in memory.
pub(crate) const PAIRED: [usize; 16] = [0, 4, 1, 5, 8, 12, 9, 13, 2, 6, 3, 7, 10, 14, 11, 15];

/// [`Lanes::channels_of_paired`] lane by lane.
#[inline(always)]
pub(crate) fn channels<S: Lanes>(s: S, rows: [f32x16<S>; 4]) -> [f32x16<S>; 4] {
    let mut channels = [[0.0; 16]; 4];
    let mut lane = 0;
    while lane < 16 {
        let row = rows[usize::from(LANE_Y[lane])].to_array();
        let column = usize::from(LANE_X[lane]);
        let mut channel = 0;
        while channel < 4 {
            let at = column % 2 + column / 2 * 4 + channel % 2 * 2 + channel / 2 * 8;
            channels[channel][lane] = row[at];
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
    use fearless_simd::x86::{Avx2, Avx512};
    use fearless_simd::{SimdCombine, SimdInto, SimdSplit, f32x8, f32x16};

    #[inline(always)]
    pub(crate) fn paired_avx512(simd: Avx512, row: f32x16<Avx512>) -> f32x16<Avx512> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx512, row: f32x16<Avx512>) -> f32x16<Avx512> {
                use core::arch::x86_64::*;
                let order = _mm512_setr_epi32(0, 4, 1, 5, 8, 12, 9, 13, 2, 6, 3, 7, 10, 14, 11, 15);
                _mm512_permutexvar_ps(order, row.into()).simd_into(simd)
            }
        );
        kernel(simd, row)
    }

    #[inline(always)]
    pub(crate) fn channels_of_paired_avx512(
        simd: Avx512,
        rows: [f32x16<Avx512>; 4],
    ) -> [f32x16<Avx512>; 4] {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx512, rows: [f32x16<Avx512>; 4]) -> [f32x16<Avx512>; 4] {
                use core::arch::x86_64::*;
                let [a, b, c, d] = rows;
                let [a, b] = [_mm512_castps_pd(a.into()), _mm512_castps_pd(b.into())];
                let [c, d] = [_mm512_castps_pd(c.into()), _mm512_castps_pd(d.into())];
                // Red and blue of two rows, then green and alpha.
                let upper = [_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b)];
                let lower = [_mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(c, d)];
                let [rb, ga] = [[upper[0], lower[0]], [upper[1], lower[1]]];
                [
                    _mm512_castpd_ps(_mm512_shuffle_f64x2::<0b01_00_01_00>(rb[0], rb[1]))
                        .simd_into(simd),
                    _mm512_castpd_ps(_mm512_shuffle_f64x2::<0b01_00_01_00>(ga[0], ga[1]))
                        .simd_into(simd),
                    _mm512_castpd_ps(_mm512_shuffle_f64x2::<0b11_10_11_10>(rb[0], rb[1]))
                        .simd_into(simd),
                    _mm512_castpd_ps(_mm512_shuffle_f64x2::<0b11_10_11_10>(ga[0], ga[1]))
                        .simd_into(simd),
                ]
            }
        );
        kernel(simd, rows)
    }

    #[inline(always)]
    pub(crate) fn paired_avx2(simd: Avx2, row: f32x16<Avx2>) -> f32x16<Avx2> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx2, left: f32x8<Avx2>, right: f32x8<Avx2>) -> [f32x8<Avx2>; 2] {
                use core::arch::x86_64::*;
                let (left, right) = (left.into(), right.into());
                let even = _mm256_permute2f128_ps::<0x20>(left, right);
                let odd = _mm256_permute2f128_ps::<0x31>(left, right);
                [
                    _mm256_unpacklo_ps(even, odd).simd_into(simd),
                    _mm256_unpackhi_ps(even, odd).simd_into(simd),
                ]
            }
        );
        let (left, right) = row.split();
        let [red_green, blue_alpha] = kernel(simd, left, right);
        red_green.combine(blue_alpha)
    }

    #[inline(always)]
    pub(crate) fn channels_of_paired_avx2(
        simd: Avx2,
        rows: [f32x16<Avx2>; 4],
    ) -> [f32x16<Avx2>; 4] {
        fearless_simd::kernel!(
            /// Two channels of two rows.
            #[inline(always)]
            fn kernel(simd: Avx2, upper: f32x8<Avx2>, lower: f32x8<Avx2>) -> [f32x8<Avx2>; 2] {
                use core::arch::x86_64::*;
                let upper = _mm256_castps_pd(upper.into());
                let lower = _mm256_castps_pd(lower.into());
                [
                    _mm256_castpd_ps(_mm256_unpacklo_pd(upper, lower)).simd_into(simd),
                    _mm256_castpd_ps(_mm256_unpackhi_pd(upper, lower)).simd_into(simd),
                ]
            }
        );
        let [a, b, c, d] = rows;
        let (a, b, c, d) = (a.split(), b.split(), c.split(), d.split());
        let [red, green] = kernel(simd, a.0, b.0);
        let [blue, alpha] = kernel(simd, a.1, b.1);
        let [red_2, green_2] = kernel(simd, c.0, d.0);
        let [blue_2, alpha_2] = kernel(simd, c.1, d.1);
        [
            red.combine(red_2),
            green.combine(green_2),
            blue.combine(blue_2),
            alpha.combine(alpha_2),
        ]
    }
}
