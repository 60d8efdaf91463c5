//! The clip detour (A3): what becomes of the few primitives that leave the view volume or the guard
//! band.
//!
//! *In* vertices of which at least one needs clipping · *Out* vertices in the window, made by
//! clipping · *Space* clip, then window.
//!
//! Clip-space positions are not kept for filled triangles: the detour computes them again, cuts,
//! and takes the pieces to the window, where they join the other primitives.

use super::clip::ClipPolygon;
use super::clip_positions::PositionCache;
use super::run::RunWork;
use super::setup::Setup;
use super::viewport::snap;
use crate::bounds::primitives::{VertexRef, WindowVertex};
use estampe_types::shader::MAX_DISTANCES;

/// Memory of one worker for clipping.
#[derive(Debug, Default)]
pub(crate) struct ClipDetour {
    polygon: ClipPolygon,
    /// The vertices of the polygon that was clipped last, in the window; `None` where a vertex has
    /// no place there.
    pieces: Vec<Option<WindowVertex>>,
    positions: PositionCache,
}

impl ClipDetour {
    /// Forgets what belongs to another run.
    pub(super) fn begin(&mut self) {
        self.positions.clear();
    }

    /// Clips a filled triangle and sets its pieces up.
    #[inline(never)]
    pub(super) fn draw_triangle(
        &mut self,
        work: &RunWork<'_>,
        corners: [u32; 3],
        setup: &mut Setup<'_>,
    ) {
        setup.chunk.statistics.primitives_clipped += 1;
        if self.is_culled_by_distance(work, &corners) || !self.clip(work, &corners, setup) {
            return;
        }
        for fan in self.fans() {
            if !is_on_target(work, &fan) {
                continue;
            }
            let area = doubled_area(&fan);
            let facing = work.plan.facing;
            if facing.drops(area) {
                setup.chunk.statistics.primitives_culled += 1;
            } else {
                setup.push(&fan, corners[0], area, facing.is_front(area));
            }
        }
    }

    /// The triangles of the polygon that was clipped last; those without a place in the window are
    /// left out.
    pub(super) fn fans(&self) -> impl Iterator<Item = [WindowVertex; 3]> {
        let pieces = &self.pieces;
        (2..pieces.len()).filter_map(|last| Some([pieces[0]?, pieces[last - 1]?, pieces[last]?]))
    }

    /// The ends of the line that was clipped last, if both have a place in the window.
    pub(super) fn line(&self) -> Option<[WindowVertex; 2]> {
        match self.pieces[..] {
            [Some(a), Some(b)] => Some([a, b]),
            _ => None,
        }
    }

    /// Returns true if some cull distance is negative at all of a primitive's vertices.
    pub(super) fn is_culled_by_distance(&mut self, work: &RunWork<'_>, corners: &[u32]) -> bool {
        let interface = work.source.pipeline.interface();
        // A bit for each distance; a pipeline has at most eight.
        let mut negative = (1u32 << interface.cull_distances.min(MAX_DISTANCES)) - 1;
        for &corner in corners {
            if negative == 0 {
                break;
            }
            self.position_of(work, corner);
            let distances = self.positions.distances_of(interface, corner);
            let mut of_corner = 0;
            for (bit, distance) in distances.skip(interface.clip_distances).enumerate() {
                of_corner |= u32::from(distance < 0.0) << bit;
            }
            negative &= of_corner;
        }
        negative != 0
    }

    /// Clips a polygon or line; false when nothing is left.
    pub(super) fn clip(
        &mut self,
        work: &RunWork<'_>,
        corners: &[u32],
        setup: &mut Setup<'_>,
    ) -> bool {
        let (vertices, transform) = (&work.vertices, &work.plan.transform);
        let interface = work.source.pipeline.interface();
        let distances = interface.clip_distances;
        self.polygon.begin(vertices.varying_scalars, distances);
        for &corner in corners {
            let position = match vertices.clip_position(corner) {
                Some(position) if distances == 0 => position,
                _ => self.position_of(work, corner),
            };
            let of_corner = self.positions.distances_of(interface, corner);
            let varyings = vertices.varyings_of(corner);
            self.polygon
                .push(position, varyings, of_corner.take(distances));
        }
        self.pieces.clear();
        if !self.polygon.clip(transform) {
            return false;
        }
        for vertex in self.polygon.vertices() {
            let (position, others) = vertex.split_at(4);
            let [x, y, z, w] = [position[0], position[1], position[2], position[3]];
            let projected = transform.project([x, y, z, w]);
            let is_usable = w > 0.0 && projected.iw.is_finite();
            let (x, y) = (snap(projected.x), snap(projected.y));
            let (z, iw) = (projected.z, projected.iw);
            self.pieces.push(is_usable.then(|| {
                let [x_bits, y_bits] = [x, y].map(i32::cast_unsigned);
                let packed = [x_bits, y_bits, z.to_bits(), iw.to_bits()];
                let vertex = setup.push_clipped(packed, &others[..vertices.varying_scalars]);
                WindowVertex {
                    x,
                    y,
                    z,
                    iw,
                    vertex,
                }
            }));
        }
        true
    }

    /// The place of a visible corner of a triangle that is drawn as points. Cull distances concern
    /// the triangle and are ignored; a negative clip distance gives none.
    pub(super) fn corner_point(&mut self, work: &RunWork<'_>, vertex: u32) -> Option<WindowVertex> {
        let interface = work.source.pipeline.interface();
        if interface.cull_distances == 0 {
            return None;
        }
        let position = self.position_of(work, vertex);
        let distances = self.positions.distances_of(interface, vertex);
        let mut clip = distances.take(interface.clip_distances);
        let is_inside = clip.all(|distance| (0.0..f32::INFINITY).contains(&distance))
            && position.iter().all(|component| component.is_finite());
        let at = work.plan.transform.project(position);
        (is_inside && at.iw.is_finite()).then_some(WindowVertex {
            x: snap(at.x),
            y: snap(at.y),
            z: at.z,
            iw: at.iw,
            vertex: VertexRef(vertex),
        })
    }

    /// A vertex's clip-space position, computed again; its distances are then known, too.
    fn position_of(&mut self, work: &RunWork<'_>, vertex: u32) -> [f32; 4] {
        self.positions.position_of(work.level, &work.source, vertex)
    }
}

/// Returns true if a triangle's box contains sample positions of the plan's rectangle; culling
/// makes the same test in lanes.
fn is_on_target(work: &RunWork<'_>, vertices: &[WindowVertex; 3]) -> bool {
    let rect = work.plan.rect;
    let [first, last] = work.plan.sample_range;
    let spans = |of: fn(&WindowVertex) -> i32, low: i32, high: i32| {
        let [a, b, c] = [of(&vertices[0]), of(&vertices[1]), of(&vertices[2])];
        let from = (a.min(b).min(c) - last + 255) >> 8;
        let to = (a.max(b).max(c) - first) >> 8;
        from <= to && to >= low && from < high
    };
    spans(|v| v.x, rect.x0, rect.x1) && spans(|v| v.y, rect.y0, rect.y1)
}

/// Twice the signed area in 1/256 pixel²; positive is clockwise as seen, y pointing down. Exact:
/// differences are below 2²⁴.
pub(super) fn doubled_area([a, b, c]: &[WindowVertex; 3]) -> i64 {
    let x = |v: &WindowVertex| i64::from(v.x);
    let y = |v: &WindowVertex| i64::from(v.y);
    (x(b) - x(a)) * (y(c) - y(a)) - (x(c) - x(a)) * (y(b) - y(a))
}
