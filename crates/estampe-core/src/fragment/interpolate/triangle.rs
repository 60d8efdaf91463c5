//! Triangles: planes of depth, 1/w and varyings, at packets of 4×4 pixels and at any pixels.

use super::planes::{PlaneOrigin, evaluate};
use super::varyings::VaryingPlanes;
use super::{Interpolant, PixelInterpolant, PixelOffsets, WindowPixels};
use crate::bounds::plane::Plane;
use estampe_simd::{LANES, Lanes, Packet, SimdBase, f32x16, outline};
use estampe_types::Interpolation;

/// A triangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TriangleInterpolant<'a> {
    pub(crate) origin: PlaneOrigin,
    pub(crate) z: Plane,
    pub(crate) iw: Plane,
    /// True if the three 1/w are equal in bits.
    pub(crate) equal_w: bool,
    pub(crate) planes: VaryingPlanes<'a>,
    pub(crate) modes: &'a [Interpolation],
    /// True if every varying is smooth; `modes` is then not read.
    pub(crate) all_smooth: bool,
    /// The scalars whose derivatives are wanted.
    pub(crate) gradients: &'a [usize],
}

impl<S: Lanes> Interpolant<S> for TriangleInterpolant<'_> {
    #[inline(always)]
    fn depth(&self, s: S, pixel: [i32; 2], sample: [f32; 2]) -> f32x16<S> {
        evaluate(s, &self.z, self.origin.distances(s, pixel, sample))
    }

    #[inline(always)]
    fn inverse_w(&self, s: S, pixel: [i32; 2]) -> f32x16<S> {
        if self.equal_w {
            return SimdBase::splat(s, self.iw.origin);
        }
        evaluate(s, &self.iw, self.origin.distances(s, pixel, [0.5; 2]))
    }

    #[inline(always)]
    fn varyings(&self, s: S, pixel: [i32; 2], out: &mut [Packet<f32>]) {
        self.varyings_at(s, self.origin.distances(s, pixel, [0.5; 2]), out);
    }

    #[inline(always)]
    fn inverse_w_at(&self, s: S, pixel: [i32; 2], places: &PixelOffsets) -> f32x16<S> {
        if self.equal_w {
            return SimdBase::splat(s, self.iw.origin);
        }
        evaluate(s, &self.iw, self.origin.distances_of(s, pixel, places))
    }

    #[inline(always)]
    fn varyings_in(&self, s: S, pixel: [i32; 2], places: &PixelOffsets, out: &mut [Packet<f32>]) {
        self.varyings_at(s, self.origin.distances_of(s, pixel, places), out);
    }
}

impl<S: Lanes> PixelInterpolant<S> for TriangleInterpolant<'_> {
    #[inline(always)]
    fn varyings_of(&self, s: S, pixels: WindowPixels<S>, out: &mut [Packet<f32>]) {
        self.varyings_at(s, self.origin.distances_to(pixels, [0.5; 2]), out);
    }

    #[inline(always)]
    fn depth_of(&self, s: S, pixels: WindowPixels<S>, sample: [f32; 2]) -> f32x16<S> {
        evaluate(s, &self.z, self.origin.distances_to(pixels, sample))
    }

    #[inline(always)]
    fn inverse_w_of(&self, s: S, pixels: WindowPixels<S>) -> f32x16<S> {
        if self.equal_w {
            return SimdBase::splat(s, self.iw.origin);
        }
        evaluate(s, &self.iw, self.origin.distances_to(pixels, [0.5; 2]))
    }
}

impl TriangleInterpolant<'_> {
    /// Returns true if every varying has the same bits at all pixels.
    #[inline(always)]
    pub(crate) fn is_constant(&self) -> bool {
        self.equal_w && self.planes.are_constant()
    }

    /// The varyings at sixteen pixels, given by their centres' distances from the planes' origin.
    #[inline(always)]
    fn varyings_at<S: Lanes>(&self, s: S, distances: [f32x16<S>; 2], out: &mut [Packet<f32>]) {
        outline!(s, {
            let planes = self.planes;
            let n = out.len().min(planes.len());
            let mut w = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
            if !self.equal_w {
                w /= evaluate(s, &self.iw, distances);
            }
            for (k, packet) in out.iter_mut().enumerate().take(n) {
                let mode = self.mode(k);
                if mode == Interpolation::Flat {
                    // Not from the plane, whose sum would turn −0 into 0.
                    packet.0 = [planes.origin[k]; LANES];
                    continue;
                }
                let mut value = evaluate(s, &planes.of(k), distances);
                if !self.equal_w && mode == Interpolation::Smooth {
                    value *= w;
                }
                value.store_array(&mut packet.0);
            }
            let (values, derivatives) = out.split_at_mut(n);
            self.derivatives(s, (values, derivatives), w);
        })
    }

    /// The derivatives of a packet's varyings, given these and the w that they were multiplied by.
    #[inline(always)]
    pub(super) fn derivatives<S: Lanes>(
        &self,
        s: S,
        (values, derivatives): (&[Packet<f32>], &mut [Packet<f32>]),
        w: f32x16<S>,
    ) {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let (along_x, along_y) = derivatives.split_at_mut(self.gradients.len());
        let along = along_x.iter_mut().zip(along_y);
        for ((along_x, along_y), &k) in along.zip(self.gradients) {
            let Plane { dx, dy, .. } = self.planes.of(k);
            if self.equal_w || self.mode(k) != Interpolation::Smooth {
                // The sum turns −0 into 0, so that all that does not vary is alike.
                (along_x.0, along_y.0) = ([dx + 0.0; LANES], [dy + 0.0; LANES]);
                continue;
            }
            let value = f32x16::load_array_ref(s, &values[k].0);
            let slopes = [splat(dx), splat(dy)];
            let slopes_of_iw = [splat(self.iw.dx), splat(self.iw.dy)];
            let [x, y] = smooth_derivatives(slopes, value, slopes_of_iw, w);
            x.store_array(&mut along_x.0);
            y.store_array(&mut along_y.0);
        }
    }

    /// How scalar `k` varies.
    #[inline(always)]
    pub(super) fn mode(&self, k: usize) -> Interpolation {
        if self.all_smooth {
            Interpolation::Smooth
        } else {
            self.modes[k]
        }
    }
}

/// The derivatives along x and y of a perspective-correct varying u = P·w, where P and 1/w are
/// planes: (∂P − u·∂(1/w))·w.
#[inline(always)]
pub(crate) fn smooth_derivatives<S: Lanes>(
    [x, y]: [f32x16<S>; 2],
    value: f32x16<S>,
    [iw_x, iw_y]: [f32x16<S>; 2],
    w: f32x16<S>,
) -> [f32x16<S>; 2] {
    [(x - value * iw_x) * w, (y - value * iw_y) * w]
}
