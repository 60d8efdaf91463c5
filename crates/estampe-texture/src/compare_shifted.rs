//! Comparisons of a depth image at shifts from a place, for packet after packet: soft shadows whose
//! taps are known before a shader runs.
//!
//! All packets have the same shifts, so the corners of a packet's taps are two sums, and most often
//! the window of texels between them decides all taps. The results are those of
//! [`compare_packets`](crate::compare_packets).

use crate::PacketPlaces;
use crate::compare::{Map, Square, square_of_three};
use crate::texel::mix;
use crate::view::{load, packet};
use estampe_simd::{LANES, Level, Packet, SimdBase, dispatch, f32x16};
use estampe_types::{Real, ShadowMap, Vec2};

/// The shares of [`sample_compare_level`](crate::sample_compare_level) at shifts from the place of
/// each packet: as many for each packet as shifts. The reference is a scalar of the packet, and a
/// number that is added to it. [Gradients](PacketPlaces::gradients) do not count.
#[inline(never)]
pub fn compare_shifted(
    texture: &ShadowMap,
    level: Level,
    (places, (reference, above)): (&PacketPlaces<'_>, (usize, f32)),
    shifts: &[[f32; 2]],
    shares: &mut [Packet<f32>],
) {
    let map = Map::new(texture);
    let corners = corners(shifts);
    let [u, v] = places.at;
    let of_packets = places
        .packets()
        .zip(shares.chunks_exact_mut(shifts.len().max(1)));
    dispatch!(@wide level, s => {
        let zero: f32x16<_> = SimdBase::splat(s, 0.0);
        for (scalars, shares) in of_packets {
            let uv = Vec2::new(load(zero, &scalars[u], 0), load(zero, &scalars[v], 0));
            let reference = load(zero, &scalars[reference], 0) + above;
            map.shares(uv, reference, (shifts, corners), shares);
        }
    }, scalar => {
        for (scalars, shares) in of_packets {
            for (&[x, y], share) in shifts.iter().zip(shares) {
                for lane in 0..LANES {
                    let uv = Vec2::new(scalars[u].0[lane] + x, scalars[v].0[lane] + y);
                    share.0[lane] = map.sample(uv, scalars[reference].0[lane] + above);
                }
            }
        }
    });
}

/// The least and the greatest shifts; `None` if there is one, which is as fast as a look at its
/// window, or if one is not finite.
fn corners(shifts: &[[f32; 2]]) -> Option<[[f32; 2]; 2]> {
    let are_finite = shifts.as_flattened().iter().all(|shift| shift.is_finite());
    if shifts.len() < 2 || !are_finite {
        return None;
    }
    let mut corners = [shifts[0]; 2];
    for shift in shifts {
        for axis in 0..2 {
            corners[0][axis] = corners[0][axis].min(shift[axis]);
            corners[1][axis] = corners[1][axis].max(shift[axis]);
        }
    }
    Some(corners)
}

impl Map<'_> {
    /// The shares of sixteen lanes at (u, v) and each shift.
    #[inline(always)]
    fn shares<R: Real>(
        &self,
        uv: Vec2<R>,
        reference: R,
        (shifts, corners): (&[[f32; 2]], Option<[[f32; 2]; 2]>),
        shares: &mut [Packet<f32>],
    ) {
        if let Some([low, high]) = corners {
            // Rounding is monotonic, so every texel of every tap lies between these.
            let low = Vec2::new(uv.x + low[0], uv.y + low[1]);
            let high = Vec2::new(uv.x + high[0], uv.y + high[1]);
            if let Some(lit) = self.decided([low, high], reference) {
                let share = packet(R::select(lit, uv.x.splat(1.0), uv.x.splat(0.0)), 0);
                shares.fill(share);
                return;
            }
        }
        if let Some(of_axes) = square_of_three(shifts)
            && let Some(square) = self.square(uv, of_axes)
        {
            self.shares_of_square(&square, reference, shares);
            return;
        }
        for (&[x, y], share) in shifts.iter().zip(shares) {
            let uv = Vec2::new(uv.x + x, uv.y + y);
            *share = packet(self.sample(uv, reference), 0);
        }
    }

    /// The shares of 3×3 taps, row by row.
    #[inline(always)]
    fn shares_of_square<R: Real>(
        &self,
        square: &Square<R>,
        reference: R,
        shares: &mut [Packet<f32>],
    ) {
        let [y0, y1, y2] = square.down;
        let (rows, _) = shares.as_chunks_mut();
        let [upper, middle, lower] = rows else {
            unreachable!("a square has nine taps");
        };
        let first = self.row_of_three(square, 0, reference);
        let second = self.row_of_three(square, 1, reference);
        *upper = shares_of_row(first, second, y0);
        let third = self.row_of_three(square, 2, reference);
        *middle = shares_of_row(second, third, y1);
        let fourth = self.row_of_three(square, 3, reference);
        *lower = shares_of_row(third, fourth, y2);
    }
}

/// The shares of three taps beside each other, between two rows of texels.
#[inline(always)]
fn shares_of_row<R: Real>(above: [R; 3], below: [R; 3], fraction: R) -> [Packet<f32>; 3] {
    [
        packet(mix(above[0], below[0], fraction), 0),
        packet(mix(above[1], below[1], fraction), 0),
        packet(mix(above[2], below[2], fraction), 0),
    ]
}
