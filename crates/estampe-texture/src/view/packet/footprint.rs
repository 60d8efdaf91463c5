//! The footprint of a pixel in the packet code: its level of detail, the number of probes, and the
//! derivative along which they lie.

use super::Packet;
use super::face::Face;
use crate::lod::level_of_detail;
use crate::view::PacketLod;
use crate::view::coordinates::load;
use estampe_types::{Real, ViewDimension};

/// The footprint of each lane.
pub(super) struct Footprints<R: Real> {
    /// λ with every bias.
    pub(super) lod: R,
    /// The number of probes that are averaged.
    pub(super) probes: R,
    /// The derivative along which they lie.
    pub(super) step: [R; 3],
}

impl Packet<'_> {
    /// The footprints of lanes at these coordinates. If the level of detail is of no effect, it is
    /// not computed.
    #[inline(always)]
    pub(super) fn footprints<R: Real>(&self, at: [R; 3]) -> Footprints<R> {
        let zero = at[0].splat(0.0);
        let one = at[0].splat(1.0);
        let sampler = &self.of.sampler;
        let value = load(zero, self.lanes.value, 0);
        let (lod, bias, probes, step) = match self.lanes.lod {
            _ if self.of.ignores_lod => (zero, zero, one, [zero; 3]),
            PacketLod::Level => (value, zero, one, [zero; 3]),
            PacketLod::Implicit | PacketLod::Bias => {
                let first = of_quad(at, 0);
                if sampler.max_anisotropy <= 1 {
                    (self.lod_of_quads(first, at), value, one, [zero; 3])
                } else {
                    let d = [minus(of_quad(at, 1), first), minus(of_quad(at, 2), first)];
                    let (lod, probes, step) = self.footprint(first, d);
                    (lod, value, probes, step)
                }
            }
            PacketLod::Gradients => {
                let d = [self.gradient(zero, 0), self.gradient(zero, 3)];
                let (lod, probes, step) = self.footprint(at, d);
                (lod, zero, probes, step)
            }
        };
        let lod = lod + Real::clamp(bias + sampler.lod_bias, -16.0, 15.99);
        Footprints { lod, probes, step }
    }

    /// A derivative that the request gives.
    #[inline(always)]
    fn gradient<R: Real>(&self, like: R, first: usize) -> [R; 3] {
        [
            load(like, self.lanes.gradients[first], 0),
            load(like, self.lanes.gradients[first + 1], 0),
            load(like, self.lanes.gradients[first + 2], 0),
        ]
    }

    /// λ, the number of probes, and the derivative along which they lie.
    #[inline(always)]
    fn footprint<R: Real>(&self, at: [R; 3], [dx, dy]: [[R; 3]; 2]) -> (R, R, [R; 3]) {
        let one = at[0].splat(1.0);
        let zero = at[0].splat(0.0);
        let [x, y] = [self.squared(at, dx), self.squared(at, dy)];
        let most_probes = f32::from(self.of.sampler.max_anisotropy.min(16));
        let is_flat = !matches!(
            self.of.view.dimension,
            ViewDimension::D1 | ViewDimension::D3
        );
        if most_probes <= 1.0 || !is_flat {
            return (level_of_detail(x.max(y).max(zero)), one, [zero; 3]);
        }
        let (x, y) = (x.max(zero), y.max(zero));
        let is_y = y.gt(x);
        let (most, least) = (R::select(is_y, y, x), R::select(is_y, x, y));
        let ratio = (most / least).sqrt();
        let limited = ratio.min(one.splat(most_probes));
        let ratio = R::select(ratio.ge(one), limited, one);
        let mut step = dx;
        for k in 0..3 {
            step[k] = R::select(is_y, dy[k], dx[k]);
        }
        let probes = -(-ratio).floor();
        (level_of_detail(most / (ratio * ratio)), probes, step)
    }

    /// λ of each quad for one probe, from the coordinates of its first fragment and of all
    /// fragments.
    ///
    /// The squared lengths are computed in all lanes at once, and those of the derivatives are
    /// taken from the quad's second and third lane: half the work of one derivative after the
    /// other.
    #[inline(always)]
    fn lod_of_quads<R: Real>(&self, first: [R; 3], at: [R; 3]) -> R {
        let squared = self.squared(first, minus(at, first));
        let (x, y) = (squared.quad_lane(1), squared.quad_lane(2));
        level_of_detail(x.max(y).max(x.splat(0.0)))
    }

    /// The squared length of a derivative in texels of the base level.
    #[inline(always)]
    fn squared<R: Real>(&self, at: [R; 3], d: [R; 3]) -> R {
        let size = self.of.view.planes[0].size;
        let d = if self.of.view.is_cube() {
            let face = Face::of(at);
            let ([sc, tc, rc], [ds, dt, dr]) = (face.turned(at), face.turned(d));
            let length = rc.abs();
            let squared = length * length;
            let s = (length * ds - sc * dr) / squared * 0.5;
            let t = (length * dt - tc * dr) / squared * 0.5;
            [s, t, s]
        } else {
            d
        };
        let x = d[0] * size[0];
        let one = x * x;
        if self.of.view.dimension == ViewDimension::D1 {
            return one;
        }
        let y = d[1] * size[1];
        let two = one + y * y;
        if self.of.view.dimension != ViewDimension::D3 {
            return two;
        }
        let z = d[2] * size[2];
        two + z * z
    }
}

/// The coordinates of one fragment of each quad.
#[inline(always)]
fn of_quad<R: Real>([x, y, z]: [R; 3], index: u8) -> [R; 3] {
    [x.quad_lane(index), y.quad_lane(index), z.quad_lane(index)]
}

#[inline(always)]
fn minus<R: Real>([a, b, c]: [R; 3], [x, y, z]: [R; 3]) -> [R; 3] {
    [a - x, b - y, c - z]
}
