//! Linear filtering of packets whose lanes lie in two neighbouring mip levels, or across a border
//! of a repeated texture.
//!
//! Quads of several triangles share packets, and then their levels of detail differ slightly. Each
//! lane selects the size of its own level, which takes a few selections. The alternative, sampling
//! the whole packet once for every level among its lanes, reads twice as many texels: `mid_tris`
//! took 20.9 ms with this path, 22.2 without.

use crate::filter::{Level, mix_colors};
use crate::texel::{Corners, Number, OPAQUE, finish};
use crate::wrap::tile_lanes as tile;
use estampe_types::{Int, Real, TexelData, Vec2, Vec3, Vec4};

/// The footprints of linear filtering, in two levels of each lane.
pub(crate) struct Mixed<R: Real> {
    fine: Lanes<R>,
    coarse: Lanes<R>,
    fraction: R,
}

impl<R: Number> Mixed<R> {
    /// The lanes in `second` are filtered between the second and the third level, the others
    /// between the first and the second. The address mode is repeat.
    #[inline(always)]
    pub(crate) fn new(
        levels: [&Level; 3],
        second: R::SelectMask,
        wrapped: Vec2<R>,
        fraction: R,
    ) -> Self {
        let [first, middle, last] = levels;
        Self {
            fine: Lanes::new([first, middle], second, wrapped),
            coarse: Lanes::new([middle, last], second, wrapped),
            fraction,
        }
    }

    /// The colour of a texture at these footprints, 0..1.
    #[inline(always)]
    pub(crate) fn color(&self, texture: &TexelData, is_srgb: bool) -> Vec4<R> {
        let of_fine = self.fine.corners(&texture.texels);
        let of_coarse = self.coarse.corners(&texture.texels);
        if texture.is_opaque && !is_srgb {
            let fine = self.fine.mean_of_colors(of_fine);
            let coarse = self.coarse.mean_of_colors(of_coarse);
            let alpha = self.fraction.splat(OPAQUE);
            return finish(fine.mix(coarse, self.fraction).extend(alpha), false);
        }
        let color = mix_colors(
            of_fine.mean(self.fine.x, self.fine.y, is_srgb),
            of_coarse.mean(self.coarse.x, self.coarse.y, is_srgb),
            self.fraction,
        );
        finish(color, is_srgb)
    }
}

/// The footprint of each lane in its own level.
struct Lanes<R: Real> {
    /// The indices of the texels around the sample.
    around: Corners<R::Int>,
    /// The position between the centres of the first texel and the next, 0..1.
    x: R,
    y: R,
}

impl<R: Number> Lanes<R> {
    #[inline(always)]
    fn new([a, b]: [&Level; 2], in_b: R::SelectMask, wrapped: Vec2<R>) -> Self {
        let like = wrapped.x;
        let real = |a: f32, b: f32| R::select(in_b, like.splat(b), like.splat(a));
        let int = |a: i32, b: i32| R::Int::select(in_b, like.splat_int(b), like.splat_int(a));
        let x = wrapped.x * real(a.size[0], b.size[0]) - 0.5;
        let y = wrapped.y * real(a.size[1], b.size[1]) - 0.5;
        let (column, row) = (x.floor(), y.floor());
        let (x, y) = (x - column, y - row);
        let (column, row) = (column.to_int_within_range(), row.to_int_within_range());
        let (width, height) = (int(a.width, b.width), int(a.height, b.height));
        let one = like.splat_int(1);
        let (left, right) = (tile(column, width), tile(column + one, width));
        let (upper, lower) = (tile(row, height), tile(row + one, height));
        let offset = int(a.offset(), b.offset());
        let (upper, lower) = (upper * width + offset, lower * width + offset);
        let around = Corners {
            upper: [upper + left, upper + right],
            lower: [lower + left, lower + right],
        };
        Self { around, x, y }
    }

    #[inline(always)]
    fn corners(&self, texels: &[u32]) -> Corners<R::Int> {
        let Corners { upper, lower } = &self.around;
        Corners {
            upper: [upper[0].gather(texels), upper[1].gather(texels)],
            lower: [lower[0].gather(texels), lower[1].gather(texels)],
        }
    }

    #[inline(always)]
    fn mean_of_colors(&self, corners: Corners<R::Int>) -> Vec3<R> {
        corners.mean_of_colors(self.x, self.y)
    }
}
