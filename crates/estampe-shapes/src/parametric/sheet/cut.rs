//! Cuts a sheet where a condition ends: its domain, or a range of heights.

use std::collections::HashMap;

use glam::DVec3;

use super::draft::{Draft, NEARBY, Vertex};
use crate::continuity::{has_limit, is_defined, last_that};
use crate::parametric::jet::SurfaceJet;

impl<F: Fn(f64, f64) -> SurfaceJet> Draft<F> {
    /// Cuts the sheet at the ends of the function's domain. Triangles that reach to a pole there
    /// are left out unless `keeps_poles`, because it is far away.
    pub(crate) fn cut_to_domain(&mut self, keeps_poles: bool) {
        let whole = self.vertices.len();
        self.cut(is_defined, |position| position);
        if keeps_poles {
            return;
        }
        for number in whole..self.vertices.len() {
            let vertex = self.vertices[number];
            let Some(from) = vertex.cut_from else {
                continue;
            };
            let at = |f: f64| [0, 1].map(|i| from[i] * (1.0 - f) + vertex.at[i] * f);
            if !has_limit(|f| self.jet(at(f)).position, 0.0, 1.0) {
                self.vertices[number].position = DVec3::NAN;
            }
        }
    }

    /// Keeps the parts whose positions satisfy a condition; `moved` puts a vertex at the cut onto
    /// its boundary.
    ///
    /// Each edge that leaves the kept part is cut once, at the last of its parameters that
    /// satisfies the condition, so that the triangles on both sides share the new vertex.
    ///
    /// ```text
    ///      a                  a
    ///     ╱ ╲                ╱ ╲       one corner kept: a triangle,
    ///    ╱   ╲    ───▶      x───y      two: two triangles
    ///   b─────c
    /// ```
    pub(crate) fn cut(&mut self, is_kept: impl Fn(DVec3) -> bool, moved: impl Fn(DVec3) -> DVec3) {
        let keeps: Vec<bool> = self.vertices.iter().map(|v| is_kept(v.position)).collect();
        if keeps.iter().all(|is_kept| *is_kept) {
            return;
        }
        let mut cuts: HashMap<(u32, u32), u32> = HashMap::new();
        // Edges to a vertex just outside are cut at nearly the same place: to one vertex, or a
        // triangle between them would have no extent, and its neighbours no common edge.
        let mut near_outside: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
        let whole = std::mem::take(&mut self.triangles);
        let mut kept = Vec::with_capacity(whole.len());
        for triangle in whole {
            let mut corners = triangle;
            let is_kept_at = |corner: u32| keeps[corner as usize];
            let count = corners.iter().filter(|corner| is_kept_at(**corner)).count();
            if count == 3 {
                kept.push(corners);
            }
            if count == 0 || count == 3 {
                continue;
            }
            // Rotate so that the corner unlike the other two comes first.
            let is_alone = |corner: &u32| is_kept_at(*corner) == (count == 1);
            let alone = corners.iter().position(is_alone).unwrap_or(0);
            corners.rotate_left(alone);
            let [a, b, c] = corners;
            let mut crossing = |inside: u32, outside: u32| {
                *cuts.entry((inside, outside)).or_insert_with(|| {
                    let vertex = self.crossing(inside, outside, &is_kept, &moved);
                    let place = place(&vertex);
                    if place == self::place(&self.vertices[inside as usize]) {
                        return inside;
                    }
                    *near_outside.entry((outside, place)).or_insert_with(|| {
                        self.vertices.push(vertex);
                        u32::try_from(self.vertices.len() - 1)
                            .expect("a cut adds fewer vertices than the grid has edges")
                    })
                })
            };
            if count == 1 {
                kept.push([a, crossing(a, b), crossing(a, c)]);
            } else {
                let (ab, ac) = (crossing(b, a), crossing(c, a));
                kept.push([ab, b, c]);
                kept.push([ab, c, ac]);
            }
        }
        self.triangles = kept;
    }

    /// The vertex at which an edge leaves the kept part.
    fn crossing(
        &self,
        inside: u32,
        outside: u32,
        is_kept: impl Fn(DVec3) -> bool,
        moved: impl Fn(DVec3) -> DVec3,
    ) -> Vertex {
        let [from, to] = [inside, outside].map(|vertex| self.vertices[vertex as usize]);
        let at = |f: f64| [0, 1].map(|i| from.at[i] * (1.0 - f) + to.at[i] * f);
        let last = last_that(|f| is_kept(self.jet(at(f)).position), 0.0, 1.0);
        if last == 0.0 {
            // The edge leaves at once; its computed point may even lie outside.
            return from;
        }
        let mut vertex = self.vertex(at(last), &self.jet(at(last)));
        vertex.position = moved(vertex.position);
        vertex.cut_from = Some(from.at);
        if self.jet(at(last)).normal([0.0; 2]).is_none() {
            // At the rim of a half sphere the derivatives are infinite: look inside, on the edge.
            let inside = |step: f64| self.jet(at(last * (1.0 - step))).normal([0.0; 2]);
            let normal = NEARBY.into_iter().find_map(inside);
            vertex.normal = normal.unwrap_or(vertex.normal);
        }
        vertex
    }
}

/// The position of a vertex in the mesh, as a key.
fn place(vertex: &Vertex) -> [u32; 3] {
    (vertex.position + DVec3::ZERO)
        .as_vec3()
        .to_array()
        .map(f32::to_bits)
}
