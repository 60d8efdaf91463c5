//! The body-centred cubic lattice of a box: its nodes and its tetrahedra.

use glam::DVec3;

use super::axis::Axis;

/// A node of the lattice with the function's value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// The number of the node.
    pub(super) id: u32,
    pub(super) position: DVec3,
    pub(super) value: f64,
}

/// The lattice of a box. Nodes are the corners and the centres of the cells, and the centres of the
/// cells' faces on the box.
#[derive(Debug)]
pub(super) struct Lattice {
    pub(super) axes: [Axis; 3],
}

/// The nodes of a layer of cells: those of the corners below and above, and those of the centres
/// below and in it.
#[derive(Debug, Default)]
struct Layer {
    /// The number of the layer.
    k: u32,
    corners: [Vec<f64>; 2],
    centers: [Vec<f64>; 2],
}

impl Lattice {
    fn cells(&self) -> [u32; 3] {
        self.axes.map(|axis| axis.cells)
    }

    /// The position of a node, by halves of cells.
    fn position(&self, halves: [u32; 3]) -> DVec3 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.axes[axis].coordinate(halves[axis]));
        DVec3::new(x, y, z)
    }

    /// The number of a node, by halves of cells. All nodes of a lattice with odd and even halves
    /// are numbered alike; those that do not exist leave gaps.
    fn id(&self, halves: [u32; 3]) -> u32 {
        let [nx, ny, _] = self.cells().map(|cells| cells + 1);
        // A centre (all odd) or a face's centre (one even, two odd) is numbered with the corner
        // below it, in a block by which of its halves are odd.
        let [i, j, k] = halves.map(|half| half / 2);
        let kind = halves.iter().fold(0, |kind, half| kind * 2 + half % 2);
        let block = match kind {
            0b000 => 0,
            0b111 => 1,
            0b011 => 2,
            0b101 => 3,
            _ => 4,
        };
        let per_block = nx * ny * (self.cells()[2] + 1);
        block * per_block + i + nx * (j + ny * k)
    }

    /// Calls `tetrahedra` with the two ends of each axis and the four corners around it,
    /// counter-clockwise as seen from the second end. The axis runs from a cell's centre to the
    /// next one's, or to the centre of a face on the box.
    ///
    /// ```text
    ///      q3─────q2        tetrahedra: a b q0 q1, a b q1 q2, a b q2 q3, a b q3 q0;
    ///      │ a─•─b │        seen from b, q0 q1 q2 q3 are counter-clockwise
    ///      q0─────q1
    /// ```
    ///
    /// Stops at the first error.
    pub(super) fn visit<E>(
        &self,
        function: impl Fn(DVec3) -> f64,
        mut tetrahedra: impl FnMut([Node; 2], [Node; 4]) -> Result<(), E>,
    ) -> Result<(), E> {
        let [nx, ny, nz] = self.cells();
        let mut layer = Layer::default();
        self.fill_corners(&mut layer.corners[1], 0, &function);
        for k in 0..nz {
            layer.k = k;
            layer.corners.swap(0, 1);
            layer.centers.swap(0, 1);
            self.fill_corners(&mut layer.corners[1], k + 1, &function);
            self.fill_centers(&mut layer.centers[1], k, &function);
            for j in 0..=ny {
                for i in 0..=nx {
                    // The faces below this corner's cell along each axis, and the box's last ones.
                    for axis in 0..3 {
                        let cell = [i, j, k];
                        let is_cell = |other: usize| cell[other] < self.cells()[other];
                        if (0..3).all(|other| other == axis || is_cell(other)) {
                            self.visit_face(&layer, axis, cell, &function, &mut tetrahedra)?;
                        }
                    }
                    if k + 1 == nz && i < nx && j < ny {
                        self.visit_face(&layer, 2, [i, j, nz], &function, &mut tetrahedra)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn fill_corners(&self, values: &mut Vec<f64>, k: u32, function: impl Fn(DVec3) -> f64) {
        let [nx, ny, _] = self.cells();
        values.clear();
        for j in 0..=ny {
            let position = |i: u32| self.position([2 * i, 2 * j, 2 * k]);
            values.extend((0..=nx).map(|i| function(position(i))));
        }
    }

    fn fill_centers(&self, values: &mut Vec<f64>, k: u32, function: impl Fn(DVec3) -> f64) {
        let [nx, ny, _] = self.cells();
        values.clear();
        for j in 0..ny {
            let position = |i: u32| self.position([2 * i + 1, 2 * j + 1, 2 * k + 1]);
            values.extend((0..nx).map(|i| function(position(i))));
        }
    }

    /// Visits the axis through the face below a cell, along `axis`.
    fn visit_face<E>(
        &self,
        layer: &Layer,
        axis: usize,
        cell: [u32; 3],
        function: &impl Fn(DVec3) -> f64,
        tetrahedra: &mut impl FnMut([Node; 2], [Node; 4]) -> Result<(), E>,
    ) -> Result<(), E> {
        let [nx, _, _] = self.cells();
        let corner_value = |[i, j, k]: [u32; 3]| {
            layer.corners[(k - layer.k) as usize][(i + (nx + 1) * j) as usize]
        };
        // The corners in the order of the two other axes, which is counter-clockwise.
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let corner = |steps: [u32; 2]| {
            let mut at = cell;
            at[next] += steps[0];
            at[last] += steps[1];
            at
        };
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(corner);
        let corner_values = corners.map(corner_value);

        let center = |at: [u32; 3], is_layer_below: bool| {
            let [i, j, _] = at;
            let value = layer.centers[usize::from(!is_layer_below)][(i + nx * j) as usize];
            (at.map(|half| 2 * half + 1), value)
        };
        let face_center = || {
            let mut halves = cell.map(|half| 2 * half);
            halves[next] += 1;
            halves[last] += 1;
            (halves, function(self.position(halves)))
        };
        let below = if cell[axis] == 0 {
            face_center()
        } else {
            let mut at = cell;
            at[axis] -= 1;
            center(at, at[2] < layer.k)
        };
        let above = if cell[axis] == self.cells()[axis] {
            face_center()
        } else {
            center(cell, false)
        };

        let values = corner_values.into_iter().chain([below.1, above.1]);
        let negative = values.filter(|value| *value < 0.0).count();
        if negative == 0 || negative == 6 {
            return Ok(());
        }
        let node = |(halves, value): ([u32; 3], f64)| Node {
            id: self.id(halves),
            position: self.position(halves),
            value,
        };
        let corner_nodes = [0, 1, 2, 3].map(|q| {
            let halves = corners[q].map(|half| 2 * half);
            node((halves, corner_values[q]))
        });
        tetrahedra([node(below), node(above)], corner_nodes)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::{HashMap, HashSet};

    use super::*;

    /// The tetrahedra fill the box, each face is shared by two or lies on the box, and numbers of
    /// nodes are as different as their positions.
    #[test]
    fn tetrahedra_fill_the_box() {
        for cells in [[1, 1, 1], [2, 1, 3], [3, 4, 2]] {
            let axis = |axis: usize| Axis {
                low: -1.0,
                high: 2.0,
                cells: cells[axis],
            };
            let lattice = Lattice {
                axes: [axis(0), axis(1), axis(2)],
            };
            let mut volume = 0.0;
            let mut faces: HashMap<[u32; 3], i32> = HashMap::new();
            let mut positions: HashMap<u32, [u64; 3]> = HashMap::new();
            // A function that is neither negative nor not negative at all nodes of any face.
            let parity = |p: DVec3| {
                let whole = |x: f64, n: u32| {
                    ((x + 1.0) / 3.0 * f64::from(n)).round() == (x + 1.0) / 3.0 * f64::from(n)
                };
                if whole(p.x, cells[0]) && whole(p.y, cells[1]) && whole(p.z, cells[2]) {
                    1.0
                } else {
                    -1.0
                }
            };
            let mut visit = |axis: [Node; 2], around: [Node; 4]| -> Result<(), ()> {
                let [a, b] = axis;
                for m in 0..4 {
                    let tet = [a, b, around[m], around[(m + 1) % 4]];
                    let [p, q, r, s] = tet.map(|node| node.position);
                    let six = (q - p).dot((r - p).cross(s - p));
                    assert!(six > 0.0, "a tetrahedron of the wrong orientation");
                    volume += six / 6.0;
                    for node in tet {
                        let bits = node.position.to_array().map(f64::to_bits);
                        assert_eq!(*positions.entry(node.id).or_insert(bits), bits);
                    }
                    for (f, sign) in [
                        ([0, 1, 2], 1),
                        ([0, 2, 3], 1),
                        ([0, 3, 1], 1),
                        ([1, 3, 2], 1),
                    ] {
                        let mut face = f.map(|i: usize| tet[i].id);
                        face.sort_unstable();
                        *faces.entry(face).or_insert(0) += sign;
                    }
                }
                Ok(())
            };
            lattice.visit(parity, &mut visit).unwrap();
            assert!((volume - 27.0).abs() < 1e-9, "{volume}");
            let different: HashSet<_> = positions.values().collect();
            assert_eq!(different.len(), positions.len());
            let is_on_box = |face: &[u32; 3]| {
                (0..3).any(|axis| {
                    [-1.0_f64, 2.0]
                        .iter()
                        .any(|limit| face.iter().all(|id| positions[id][axis] == limit.to_bits()))
                })
            };
            for (face, count) in &faces {
                assert_eq!(*count, if is_on_box(face) { 1 } else { 2 });
            }
        }
    }
}
