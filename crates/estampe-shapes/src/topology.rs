//! The topology of meshes, for tests: edges, borders, fans, the Euler characteristic.

use std::collections::{HashMap, HashSet};

use crate::mesh::ShapeMesh;

/// The findings of a mesh that passed [`topology`].
pub(crate) struct Topology {
    /// Edges that belong to one triangle only.
    pub(crate) border: Vec<[u32; 2]>,
    /// Vertices − edges + triangles.
    pub(crate) euler_characteristic: i64,
}

/// Checks that a mesh is an oriented manifold, perhaps with a border: no edge is used twice in one
/// direction, the triangles around each vertex are one fan, none has two equal corners, no area or
/// a duplicate, and every vertex is used.
pub(crate) fn topology(mesh: &ShapeMesh) -> Topology {
    assert_eq!(mesh.positions.len(), mesh.normals.len());
    let mut third_of: HashMap<(u32, u32), u32> = HashMap::new();
    let mut triangles_of: HashMap<u32, usize> = HashMap::new();
    let mut seen: HashSet<[u32; 3]> = HashSet::new();
    for &triangle in &mesh.triangles {
        let [a, b, c] = triangle;
        for (edge, third) in [((a, b), c), ((b, c), a), ((c, a), b)] {
            assert!(
                third_of.insert(edge, third).is_none(),
                "edge {edge:?} is used twice"
            );
            *triangles_of.entry(third).or_insert(0) += 1;
        }
        let mut sorted = triangle;
        sorted.sort_unstable();
        assert!(seen.insert(sorted), "{triangle:?} is there twice");
        let [p, q, r] = triangle.map(|corner| mesh.positions[corner as usize].as_dvec3());
        let area = 0.5 * (q - p).cross(r - p).length();
        assert!(area > 0.0, "{triangle:?} has no area: {p} {q} {r}");
    }
    for normal in &mesh.normals {
        assert!((normal.length() - 1.0).abs() < 1e-6, "{normal}");
    }

    let has_opposite = |&(a, b): &(u32, u32)| third_of.contains_key(&(b, a));
    let border: Vec<[u32; 2]> = third_of
        .keys()
        .filter(|edge| !has_opposite(edge))
        .map(|&(a, b)| [a, b])
        .collect();
    let edges = third_of.len() - (third_of.len() - border.len()) / 2;

    // Each vertex: start at a border if there is one, turn, and count.
    let mut starts: HashMap<u32, u32> = third_of.keys().map(|&(a, b)| (a, b)).collect();
    for &[a, b] in &border {
        // The fan of `a` begins with the edge from a to b, which has no triangle on its right.
        starts.insert(a, b);
    }
    for (&vertex, &start) in &starts {
        let mut count = 0;
        let mut at = start;
        while let Some(&next) = third_of.get(&(vertex, at)) {
            count += 1;
            at = next;
            if at == start {
                break;
            }
        }
        assert_eq!(
            count, triangles_of[&vertex],
            "vertex {vertex} joins several fans"
        );
    }
    assert_eq!(starts.len(), mesh.positions.len(), "every vertex is used");
    Topology {
        border,
        euler_characteristic: (starts.len() + mesh.triangles.len()) as i64 - edges as i64,
    }
}
