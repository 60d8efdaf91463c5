//! Clipping once more, to tell which vertices and edges of a polygon it made.

use estampe_reference::ClipVertex;
use estampe_reference::clip::{ClipTest, Plane, is_within_guard_band, test};
use estampe_reference::viewport::ViewportTransform;

/// A vertex of a clipped polygon in clip space.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CutVertex {
    pub(super) vertex: ClipVertex,
    /// True if clipping made the vertex.
    pub(super) is_new: bool,
    /// True if the edge from here to the next vertex runs along a clip plane.
    pub(super) is_cut: bool,
}

/// The polygon that clipping leaves of a triangle, or `None` if the triangle is drawn as it is. It
/// has the vertices of [`clip_polygon`](estampe_reference::clip::clip_polygon).
pub(super) fn cut(vertices: &[ClipVertex], viewport: &ViewportTransform) -> Option<Vec<CutVertex>> {
    match test(vertices, viewport) {
        ClipTest::Accept => return None,
        ClipTest::Drop => return Some(Vec::new()),
        ClipTest::Clip => {}
    }
    let whole = vertices.iter().map(|vertex| CutVertex {
        vertex: vertex.clone(),
        is_new: false,
        is_cut: false,
    });
    let mut polygon: Vec<CutVertex> = whole.collect();
    for plane in Plane::always(viewport, vertices[0].clip_distances.len()) {
        polygon = cut_by(plane, &polygon);
    }
    let leaves = |one: &CutVertex| !is_within_guard_band(one.vertex.position, viewport);
    if polygon.iter().any(leaves) {
        for plane in Plane::sides(viewport) {
            polygon = cut_by(plane, &polygon);
        }
    }
    Some(polygon)
}

/// One pass of Sutherland and Hodgman's loop. Where the polygon leaves the plane's inside, its
/// boundary goes on along the plane.
fn cut_by(plane: Plane, polygon: &[CutVertex]) -> Vec<CutVertex> {
    let keeps = |one: &CutVertex| plane.distance(&one.vertex) >= 0.0;
    let crossing = |inside: &CutVertex, outside: &CutVertex, is_cut: bool| CutVertex {
        vertex: plane.crossing(&inside.vertex, &outside.vertex),
        is_new: true,
        is_cut,
    };
    let mut kept = Vec::new();
    for (i, one) in polygon.iter().enumerate() {
        let next = &polygon[(i + 1) % polygon.len()];
        if keeps(one) {
            kept.push(one.clone());
        }
        match (keeps(one), keeps(next)) {
            (true, false) => kept.push(crossing(one, next, true)),
            (false, true) => kept.push(crossing(next, one, one.is_cut)),
            _ => {}
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_reference::State;
    use estampe_reference::clip::clip_polygon;

    fn vertex(position: [f32; 4]) -> ClipVertex {
        ClipVertex {
            position,
            varyings: Vec::new(),
            point_size: 1.0,
            clip_distances: Vec::new(),
            cull_distances: Vec::new(),
        }
    }

    #[test]
    fn a_vertex_behind_the_near_plane_gives_one_new_edge() {
        let viewport = ViewportTransform::new(&State::new(64, 64).viewport);
        let corners = [
            [-0.5, 0.0, 0.5, 1.0],
            [0.5, 0.0, 0.5, 1.0],
            [0.0, 0.5, -0.5, 1.0],
        ];
        let polygon = cut(&corners.map(vertex), &viewport).expect("it is clipped");
        let told: Vec<_> = polygon.iter().map(|one| (one.is_new, one.is_cut)).collect();
        let expected = [(false, false), (false, false), (true, true), (true, false)];
        assert_eq!(told, expected);
    }

    #[test]
    fn the_polygon_is_that_of_the_reference() {
        let viewport = ViewportTransform::new(&State::new(64, 48).viewport);
        let mut random = fastrand::Rng::with_seed(5);
        let (mut new, mut cut_edges, mut large) = (0, 0, 0);
        for turn in 0..4000 {
            let scale = [1.5, 3000.0][turn % 2];
            let corners = [0; 3].map(|_| {
                let mut number = |reach: f32| (random.f32() * 2.0 - 1.0) * reach;
                vertex([number(scale), number(scale), number(1.5), number(2.0)])
            });
            let Some(polygon) = cut(&corners, &viewport) else {
                continue;
            };
            if test(&corners, &viewport) == ClipTest::Clip {
                let vertices: Vec<_> = polygon.iter().map(|one| one.vertex.clone()).collect();
                assert_eq!(vertices, clip_polygon(&corners, &viewport));
            } else {
                assert!(polygon.is_empty());
            }
            for one in &polygon {
                let is_corner = corners.contains(&one.vertex);
                assert!(one.is_new || is_corner, "{one:?}");
                new += u32::from(one.is_new);
                cut_edges += u32::from(one.is_cut);
            }
            large += u32::from(polygon.len() > 4);
        }
        let counts = [new, cut_edges, large];
        assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    }
}
