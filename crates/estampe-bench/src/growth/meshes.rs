//! Meshes by number and size of triangles: grids of square cells, two triangles each, with shared
//! vertices and an index buffer, as real meshes have them.
//!
//! A mesh that does not fit into the frame has several layers over each other, of equal size and in
//! the middle of the frame, the farthest first. No triangle is hidden by an earlier one, so each
//! costs as much as a visible one, however many there are.

use super::gouraud;
use crate::generate::{LittleEndian, hash32};
use crate::scene::Scene;
use crate::stages::SIZE;

/// A size class of triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizeClass {
    /// The name in tables and plots.
    pub name: &'static str,
    /// The mean area of a triangle, in pixels.
    pub area_px: f64,
}

impl SizeClass {
    /// The number of triangles that cover the frame once.
    #[must_use]
    pub fn of_one_layer(self) -> u32 {
        let [columns, rows] = self.most_cells();
        columns * rows * 2
    }

    /// The side of a cell of two triangles, in pixels.
    fn cell_px(self) -> f64 {
        (2.0 * self.area_px).sqrt()
    }

    /// The greatest numbers of columns and rows of cells in the frame.
    fn most_cells(self) -> [u32; 2] {
        [SIZE.width, SIZE.height].map(|side| whole(f64::from(side) / self.cell_px()))
    }
}

/// A number of cells as an integer, at least one.
fn whole(number: f64) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "cells of a side of the frame: some hundreds"
    )]
    let whole = number as u32;
    whole.max(1)
}

/// The measured size classes.
pub const CLASSES: [SizeClass; 3] = [
    SizeClass {
        name: "1 px",
        area_px: 1.0,
    },
    SizeClass {
        name: "10 px",
        area_px: 10.0,
    },
    SizeClass {
        name: "100 px",
        area_px: 100.0,
    },
];

/// The measured numbers of triangles: half decades from 10² to 10⁷.
pub const COUNTS: [u32; 11] = [
    100, 316, 1000, 3162, 10_000, 31_623, 100_000, 316_228, 1_000_000, 3_162_278, 10_000_000,
];

/// A mesh of `count` triangles.
#[must_use]
pub fn mesh(class: SizeClass, count: u32) -> Scene {
    let layers = Layers::new(class, count);
    let mut vertices = LittleEndian::with_capacity(layers.count as usize * layers.corners() * 16);
    let mut indices = LittleEndian::with_capacity(count as usize * 12);
    let mut left = count;
    for layer in 0..layers.count {
        layers.append_vertices(layer, &mut vertices);
        left -= layers.append_triangles(layer, left, &mut indices);
    }
    let buffers = vec![vertices.into_bytes(), indices.into_bytes()];
    Scene::of_one_draw(class.name, buffers, Vec::new(), gouraud::pipeline())
}

/// Equal grids over each other, in the middle of the frame.
#[derive(Debug, Clone, Copy)]
struct Layers {
    count: u32,
    columns: u32,
    rows: u32,
    cell_px: f64,
}

impl Layers {
    fn new(class: SizeClass, triangles: u32) -> Self {
        let [most_columns, most_rows] = class.most_cells();
        let cells = triangles.div_ceil(2);
        let count = cells.div_ceil(most_columns * most_rows);
        let each = cells.div_ceil(count);
        // The same aspect ratio as the frame.
        let aspect = f64::from(SIZE.width) / f64::from(SIZE.height);
        let columns = whole((f64::from(each) * aspect).sqrt().ceil()).min(most_columns);
        Self {
            count,
            columns,
            rows: each.div_ceil(columns).min(most_rows),
            cell_px: class.cell_px(),
        }
    }

    /// The number of vertices of a layer.
    fn corners(&self) -> usize {
        (self.columns as usize + 1) * (self.rows as usize + 1)
    }

    fn append_vertices(&self, layer: u32, vertices: &mut LittleEndian) {
        let z = 1.0 - f64::from(layer + 1) / f64::from(self.count + 1);
        let seed = hash32(layer);
        let middle = [self.columns, self.rows].map(|cells| f64::from(cells) * 0.5);
        for row in 0..=self.rows {
            for column in 0..=self.columns {
                let hash = hash32(seed ^ (row * 4096 + column));
                let [red, green, blue, _] = hash.to_le_bytes();
                // Moved by up to a quarter of a cell, so that no two triangles are equal.
                let moved = |bits: u8| (f64::from(bits) / 255.0 - 0.5) * 0.5;
                let x_px = (f64::from(column) + moved(red) - middle[0]) * self.cell_px;
                let y_px = (f64::from(row) + moved(green) - middle[1]) * self.cell_px;
                vertices.reals(&[
                    x_px / f64::from(SIZE.width) * 2.0,
                    y_px / f64::from(SIZE.height) * -2.0,
                    z,
                ]);
                vertices.raw(&[red, green, blue, 255]);
            }
        }
    }

    /// Appends two counter-clockwise triangles per cell, at most `most`; returns their number.
    fn append_triangles(&self, layer: u32, most: u32, indices: &mut LittleEndian) -> u32 {
        let width = self.columns + 1;
        let first = layer * width * (self.rows + 1);
        let triangles = (self.columns * self.rows * 2).min(most);
        for triangle in 0..triangles {
            let (row, column) = (triangle / 2 / self.columns, triangle / 2 % self.columns);
            let upper_left = first + row * width + column;
            let lower_left = upper_left + width;
            if triangle % 2 == 0 {
                indices.words(&[upper_left, lower_left, lower_left + 1]);
            } else {
                indices.words(&[upper_left, lower_left + 1, upper_left + 1]);
            }
        }
        triangles
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_have_as_many_triangles_as_they_say() {
        for class in CLASSES {
            for count in [1, 2, 100, 3161, 100_000] {
                let scene = mesh(class, count);
                assert_eq!(scene.triangles(), u64::from(count), "{}", class.name);
                let vertices = u32::try_from(scene.buffers[0].len() / 16).unwrap();
                let words = scene.buffers[1].chunks_exact(4);
                let indices = words.map(|word| u32::from_le_bytes(word.try_into().unwrap()));
                assert!(indices.max().unwrap() < vertices);
            }
        }
    }

    #[test]
    fn triangles_have_their_class_s_area_and_lie_in_the_frame() {
        let scene = mesh(CLASSES[2], 1000);
        let float = |at: usize| {
            let bytes = scene.buffers[0][at..at + 4].try_into().unwrap();
            f64::from(f32::from_le_bytes(bytes))
        };
        let index = |at: usize| {
            let bytes = scene.buffers[1][at..at + 4].try_into().unwrap();
            u32::from_le_bytes(bytes) as usize * 16
        };
        let mut area_px = 0.0;
        for triangle in 0..1000 {
            let [a, b, c] = [0, 4, 8].map(|corner| {
                let vertex = index(triangle * 12 + corner);
                [float(vertex), float(vertex + 4)]
            });
            assert!([a, b, c].as_flattened().iter().all(|ndc| ndc.abs() <= 1.0));
            let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(doubled > 0.0, "counter-clockwise, y up");
            area_px += doubled * 0.5 * 640.0 * 360.0;
        }
        assert!((area_px / 1000.0 - 100.0).abs() < 5.0, "{area_px}");
    }
}
