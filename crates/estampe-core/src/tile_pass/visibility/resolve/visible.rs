//! Visible triangles: their planes are made when the first of their samples is met.

use super::{NONE, ResolveScratch, Resolver};
use crate::bounds::plane::Plane;
use crate::fragment::interpolate::{
    PlaneOrigin, TriangleInterpolant, VaryingPlanes, VaryingSource, set_planes,
};
use crate::plan::tile_plan::TilePlan;
use crate::tile_pass::visibility::{ONLY_WIDE, VisibilityScratch};
use estampe_simd::{Lanes, dispatch};
use estampe_types::Interface;

/// A visible triangle: the values that its fragments are interpolated from.
#[derive(Debug, Clone, Copy)]
pub(super) struct VisibleTriangle {
    origin: PlaneOrigin,
    z: Plane,
    iw: Plane,
    equal_w: bool,
    front: bool,
    /// The index of its first varying plane in the scratch's `planes`.
    planes: u32,
}

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Returns a triangle's index in `visible`; its planes are made when it is first met.
    #[inline(always)]
    pub(super) fn visible(&mut self, id: u32) -> usize {
        match self.scratch.visibility.resolve.visible_of[id as usize] {
            NONE => self.make_visible(id),
            place => place as usize,
        }
    }

    /// Out of line: code for the planes of each kind of interpolation is long.
    #[inline(never)]
    fn make_visible(&mut self, id: u32) -> usize {
        dispatch!(@wide self.pass.level, s => self.make_planes(s, id as usize),
            scalar => unreachable!("{ONLY_WIDE}"))
    }

    #[inline(always)]
    fn make_planes<S: Lanes>(&mut self, s: S, at: usize) -> usize {
        let VisibilityScratch {
            buffer, resolve, ..
        } = &mut self.scratch.visibility;
        let reference = buffer.triangles[at];
        let chunk = &self.pass.chunks[reference.chunk as usize];
        let plan = &self.pass.plans[reference.sub_draw as usize];
        let lane = usize::from(reference.lane);
        let triangle =
            self.pass.packets.of(chunk).triangles[reference.packet as usize].triangle(lane);
        let place = resolve.visible.len();
        // Fewer than there are ids, which have 31 bits.
        resolve.visible_of[at] = u32::try_from(place).unwrap_or(NONE);
        let from = resolve.planes.len();
        let size = VaryingPlanes::size(self.modes.len());
        resolve.planes.resize(from + size, 0.0);
        resolve.visible.push(VisibleTriangle {
            origin: PlaneOrigin::new(&triangle),
            z: triangle.z,
            iw: triangle.iw,
            equal_w: triangle.equal_w,
            front: triangle.front,
            planes: u32::try_from(from).unwrap_or(NONE),
        });
        let source = VaryingSource {
            shaded: plan.varyings,
            clipped: &chunk.clipped_varyings,
            modes: self.modes,
            gradients: &[],
        };
        let planes = &mut resolve.planes[from..];
        set_planes(s, planes, &triangle, &source, plan.all_smooth);
        place
    }
}

impl<const N: usize> ResolveScratch<N> {
    /// A visible triangle's interpolant, and whether it faces the viewer.
    #[inline(always)]
    pub(super) fn interpolant<'a>(
        &'a self,
        place: usize,
        plan: &TilePlan<'a>,
    ) -> (TriangleInterpolant<'a>, bool) {
        let visible = &self.visible[place];
        let Interface {
            varyings: modes,
            gradients,
            ..
        } = plan.pipeline.interface();
        let size = VaryingPlanes::size(modes.len());
        let interpolant = TriangleInterpolant {
            origin: visible.origin,
            z: visible.z,
            iw: visible.iw,
            equal_w: visible.equal_w,
            planes: VaryingPlanes::new(&self.planes[visible.planes as usize..][..size]),
            modes,
            all_smooth: plan.all_smooth,
            gradients,
        };
        (interpolant, visible.front)
    }
}
