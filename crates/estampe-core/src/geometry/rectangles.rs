//! Rectangles: two triangles whose pixels are a box, and whose values are the same planes.
//!
//! Sprites and glyphs are rectangles with level sides, of two triangles that share the diagonal
//! from the upper left to the lower right corner. Both have the first sorted vertex A, at which
//! their planes begin:
//!
//! ```text
//!     A───B     upper triangle: A B D
//!     │ ╲ │     lower triangle: A C D
//!     C───D
//! ```
//!
//! A varying that changes along x alone (A = C, B = D) or along y alone (A = B, C = D) has slopes
//! of the same bits in both: with e = D − A, width W and height H, along x `(e·H − e·0)·r` in the
//! upper one and `(0·H − e·H)·(−r)` in the lower one, along y `(e·W − e·W)·r` and
//! `(e·0 − 0·W)·(−r)`. Zeros may differ in sign, which is lost when they are added to anything but
//! −0. So the two may be drawn as one box. Rectangles with the other diagonal begin at different
//! vertices, where sums are rounded otherwise.
//!
//! They are found once, when a packet is set up, and not in each tile: the first triangle is binned
//! for both, so that tiles look at one triangle and its varyings in place of two.

use crate::bounds::primitives::{TrianglePacket, VertexRef};
use estampe_simd::{Bytes, LANES, Lane, Lanes, SimdBase, f32x16, i32x16, u32x16};

/// Varyings of a rectangle are smaller, so that no product overflows: W and H are below 2¹⁶.
const MOST: f32 = 1e30;

/// The lane after each.
const NEXT: [u32; LANES] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 15];

/// The lanes of a packet whose triangle may be drawn as one box with that of the next lane. No
/// varying is flat; those of a vertex are given by `varyings_of`.
#[inline(always)]
pub(super) fn rectangles<'a, S: Lanes>(
    s: S,
    packet: &TrianglePacket,
    varyings_of: impl Fn(VertexRef) -> &'a [f32],
) -> u16 {
    let shapes = Shapes::new(s, packet);
    let pairs = shapes.pairs();
    if pairs == 0 {
        return 0;
    }
    let mut found = 0;
    let candidates = pairs & same_values(s, packet);
    for lane in Lane::all_of(candidates) {
        // A triangle is part of one rectangle.
        if found << 1 & lane.bit() != 0 {
            continue;
        }
        let (first, second) = (lane.get(), (lane.get() + 1) % LANES);
        let (upper, lower) = match lane.is_in(shapes.upper) {
            true => (first, second),
            false => (second, first),
        };
        let corners = |of: usize| {
            let [a, b, c] = &packet.vertex;
            [a[of], b[of], c[of]]
        };
        if have_same_planes(corners(upper), corners(lower), &varyings_of) {
            found |= lane.bit();
        }
    }
    found
}

/// The triangles of a packet that are halves of boxes.
struct Shapes {
    upper: u16,
    lower: u16,
}

impl Shapes {
    #[inline(always)]
    fn new<S: Lanes>(s: S, packet: &TrianglePacket) -> Self {
        let load = |lanes: &[i32; LANES]| i32x16::load_array_ref(s, lanes);
        let [x0, x1, x2] = [load(&packet.x[0]), load(&packet.x[1]), load(&packet.x[2])];
        let [y0, y1, y2] = [load(&packet.y[0]), load(&packet.y[1]), load(&packet.y[2])];
        Self {
            upper: s.bits_of_mask(y0.simd_eq(y1) & x1.simd_eq(x2)),
            lower: s.bits_of_mask(x0.simd_eq(x1) & y1.simd_eq(y2)),
        }
    }

    /// The lanes of halves whose next lane is another half.
    #[inline(always)]
    fn pairs(&self) -> u16 {
        self.upper & self.lower >> 1 | self.lower & self.upper >> 1
    }
}

/// The lanes whose triangle has the first and the last vertex, the face, and the planes of depth
/// and of 1/w, which is constant, of the next one.
#[inline(always)]
fn same_values<S: Lanes>(s: S, packet: &TrianglePacket) -> u16 {
    let next = u32x16::load_array(s, NEXT);
    let are_same = |lanes: &[i32; LANES]| {
        let lanes: u32x16<S> = i32x16::load_array_ref(s, lanes).bitcast();
        lanes.simd_eq(s.permute(lanes, next))
    };
    let are_equal = |lanes: &[f32; LANES]| {
        let lanes = f32x16::load_array_ref(s, lanes);
        lanes.simd_eq(s.permute_f32(lanes, next))
    };
    let bits_are_same = |lanes: &[f32; LANES]| {
        let lanes: u32x16<S> = f32x16::load_array_ref(s, lanes).bitcast();
        lanes.simd_eq(s.permute(lanes, next))
    };
    let (x, y, z) = (&packet.x, &packet.y, &packet.z);
    let ends = are_same(&x[0]) & are_same(&y[0]) & are_same(&x[2]) & are_same(&y[2]);
    let slopes = are_equal(&z.dx) & are_equal(&z.dy);
    let origins = bits_are_same(&z.origin) & bits_are_same(&packet.iw_at[0]);
    let negative_zero = <u32x16<S> as SimdBase<S>>::splat(s, (-0.0_f32).to_bits());
    let origin: u32x16<S> = f32x16::load_array_ref(s, &z.origin).bitcast();
    let same = ends & slopes & origins & !origin.simd_eq(negative_zero);
    let live = u16::MAX >> (LANES - usize::from(packet.len).min(LANES));
    let front = !(packet.front ^ packet.front >> 1);
    let equal_w = packet.equal_w & packet.equal_w >> 1;
    s.bits_of_mask(same) & front & equal_w & live >> 1
}

/// Returns true if the varyings of both halves have the same planes.
#[inline(always)]
fn have_same_planes<'a>(
    upper: [VertexRef; 3],
    lower: [VertexRef; 3],
    varyings_of: impl Fn(VertexRef) -> &'a [f32],
) -> bool {
    let [a, b, d] = [
        varyings_of(upper[0]),
        varyings_of(upper[1]),
        varyings_of(upper[2]),
    ];
    let mut all = true;
    if [upper[0], upper[2]] != [lower[0], lower[2]] {
        let ends = a.iter().chain(d);
        let others = varyings_of(lower[0]).iter().chain(varyings_of(lower[2]));
        for (value, other) in ends.zip(others) {
            all &= value.to_bits() == other.to_bits();
        }
    }
    let sides = b.iter().zip(varyings_of(lower[1]));
    for ((a, (b, c)), d) in a.iter().zip(sides).zip(d) {
        let along_one = (a == c) & (b == d) | (a == b) & (c == d);
        let are_small = (a.abs() < MOST) & (d.abs() < MOST);
        all &= along_one & are_small & !is_negative_zero(*a);
    }
    all
}

#[inline(always)]
fn is_negative_zero(value: f32) -> bool {
    value.to_bits() == 1 << 31
}
