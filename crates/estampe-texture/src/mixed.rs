//! Samples whose lanes lie on two neighbouring mip levels.
//!
//! Quads of several triangles share packets, and then their levels of detail differ by a little. Each lane
//! brings its level's size along: that is a few selections, where sampling the whole packet once for every level
//! among its lanes takes twice as many texels. `mid_tris` took 20.9 ms with it, 22.2 without.

use crate::filter::{Level, mix_colors};
use crate::texel::{Corners, OPAQUE};
use estampe_types::{Int, Real, Texture, Vec2, Vec3, Vec4};

/// Where linearly filtered samples lie, in two levels for each lane.
pub(crate) struct Mixed<R: Real> {
    fine: Lanes<R>,
    coarse: Lanes<R>,
    fraction: R,
}

impl<R: Real> Mixed<R> {
    /// The lanes in `second` lie between the second and the third level, others between the first and the
    /// second. Coordinates are wrapped by repetition. `None` where a lane's texels lie across a border.
    #[inline(always)]
    pub(crate) fn new(
        levels: [&Level; 3],
        second: R::Mask,
        wrapped: Vec2<R>,
        fraction: R,
    ) -> Option<Self> {
        let [first, middle, last] = levels;
        let (fine, outside) = Lanes::new([first, middle], second, wrapped);
        let (coarse, outside_coarse) = Lanes::new([middle, last], second, wrapped);
        (!R::any(outside | outside_coarse)).then_some(Self {
            fine,
            coarse,
            fraction,
        })
    }

    /// The colour of a unorm8 texture there, in the units of [`texel`](crate::texel).
    #[inline(always)]
    pub(crate) fn color(&self, texture: &Texture) -> Vec4<R> {
        let of_fine = self.fine.corners(&texture.texels);
        let of_coarse = self.coarse.corners(&texture.texels);
        if texture.is_opaque {
            let fine = self.fine.mean_of_colors(of_fine);
            let coarse = self.coarse.mean_of_colors(of_coarse);
            let alpha = self.fraction.splat(OPAQUE);
            return fine.mix(coarse, self.fraction).extend(alpha);
        }
        mix_colors(
            of_fine.mean(self.fine.x, self.fine.y, false),
            of_coarse.mean(self.coarse.x, self.coarse.y, false),
            self.fraction,
        )
    }
}

/// The place of a sample, each lane in a level of its own.
struct Lanes<R: Real> {
    /// The index of the first texel, and how many there are in a row.
    first: R::Int,
    width: R::Int,
    /// How far the sample is from that texel's centre to the next one's.
    x: R,
    y: R,
}

impl<R: Real> Lanes<R> {
    /// Besides, the lanes whose four texels are not all inside their level.
    #[inline(always)]
    fn new([a, b]: [&Level; 2], in_b: R::Mask, wrapped: Vec2<R>) -> (Self, R::Mask) {
        let like = wrapped.x;
        let real = |a: f32, b: f32| R::select(in_b, like.splat(b), like.splat(a));
        let int = |a: i32, b: i32| R::Int::select(in_b, like.splat_int(b), like.splat_int(a));
        let x = wrapped.x * real(a.size[0], b.size[0]) - 0.5;
        let y = wrapped.y * real(a.size[1], b.size[1]) - 0.5;
        let (column, row) = (x.floor(), y.floor());
        let (x, y) = (x - column, y - row);
        let (column, row) = (column.to_int_within_range(), row.to_int_within_range());
        let width = int(a.width, b.width);
        let (zero, one) = (like.splat_int(0), like.splat_int(1));
        let inside_x = column.lt(width - one) & !column.lt(zero);
        let inside_y = row.lt(int(a.height - 1, b.height - 1)) & !row.lt(zero);
        let first = row * width + column + int(a.offset(), b.offset());
        let lanes = Self { first, width, x, y };
        (lanes, !(inside_x & inside_y))
    }

    #[inline(always)]
    fn corners(&self, texels: &[u32]) -> Corners<R::Int> {
        let (one, below) = (self.first.splat(1), self.first + self.width);
        Corners {
            upper: [self.first.gather(texels), (self.first + one).gather(texels)],
            lower: [below.gather(texels), (below + one).gather(texels)],
        }
    }

    #[inline(always)]
    fn mean_of_colors(&self, corners: Corners<R::Int>) -> Vec3<R> {
        corners.mean_of_colors(self.x, self.y)
    }
}
