//! Points: every value is the vertex's.

use super::Interpolant;
use super::varyings::VaryingSource;
use crate::bounds::primitives::PointPrimitive;
use estampe_simd::{Lanes, Packet, SimdBase, f32x16};
use estampe_types::Interpolation;

/// A point: everything is its vertex's.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointInterpolant<'a> {
    pub(crate) point: &'a PointPrimitive,
    pub(crate) source: VaryingSource<'a>,
}

impl<S: Lanes> Interpolant<S> for PointInterpolant<'_> {
    #[inline(always)]
    fn depth(&self, s: S, _pixel: [i32; 2], _sample: [f32; 2]) -> f32x16<S> {
        SimdBase::splat(s, self.point.center.z)
    }

    #[inline(always)]
    fn inverse_w(&self, s: S, _pixel: [i32; 2]) -> f32x16<S> {
        SimdBase::splat(s, self.point.center.iw)
    }

    #[inline(always)]
    fn varyings(&self, s: S, _pixel: [i32; 2], out: &mut [Packet<f32>]) {
        let own = self.source.of(self.point.center.vertex);
        let provoking = self.source.of(self.point.provoking);
        let (out, derivatives) = out.split_at_mut(self.source.modes.len());
        derivatives.fill(Packet::default());
        for (k, packet) in out.iter_mut().enumerate() {
            let value = match self.source.modes[k] {
                Interpolation::Flat => provoking[k],
                Interpolation::Smooth | Interpolation::NoPerspective => own[k],
            };
            <f32x16<S> as SimdBase<S>>::splat(s, value).store_array(&mut packet.0);
        }
    }
}
