//! Triangle set-up: sorted vertices and the planes of depth, 1/w and varyings.
//!
//! In · Out: three window vertices · planes, which give a value at any point of the window.
//! Precision: f32 in the order of NUMERICS.md, *Planes*; positions are exact.

use crate::WindowVertex;
use crate::cull::doubled_area;

/// A triangle with its vertices sorted by (y, x), so that later stages do not depend on their given
/// order.
#[derive(Debug, Clone, PartialEq)]
pub struct SortedTriangle {
    /// The vertices, the uppermost first; of equal y, the leftmost first.
    pub vertices: [WindowVertex; 3],
    /// Twice their signed area, in (1/256 pixel)²; not 0.
    pub doubled_area: i64,
}

impl SortedTriangle {
    /// Sorts the vertices; `None` if the triangle has no area.
    #[must_use]
    pub fn new(mut vertices: [WindowVertex; 3]) -> Option<Self> {
        // The sort is stable: of equal positions (which have no area anyway) the first given stays
        // first.
        vertices.sort_by_key(|vertex| [vertex.snapped[1], vertex.snapped[0]]);
        let doubled_area = doubled_area([0, 1, 2].map(|k: usize| vertices[k].snapped));
        (doubled_area != 0).then_some(Self {
            vertices,
            doubled_area,
        })
    }

    /// The snapped positions, sorted.
    #[must_use]
    pub fn corners(&self) -> [[i32; 2]; 3] {
        [0, 1, 2].map(|k: usize| self.vertices[k].snapped)
    }

    /// The plane through three values at the sorted vertices.
    ///
    /// With e₁, e₂ the differences of the values and d₁, d₂ those of the positions, the gradient
    /// solves e₁ = g·d₁, e₂ = g·d₂ (Cramer's rule):
    ///
    /// ```text
    /// ∂p/∂x = (e₁·dy₂ − e₂·dy₁)·r      ∂p/∂y = (e₂·dx₁ − e₁·dx₂)·r      r = 65536 ÷ D
    /// ```
    #[must_use]
    pub fn plane(&self, values: [f32; 3]) -> Plane {
        let corners = self.corners();
        let difference =
            |k: usize, axis: usize| (corners[k][axis] - corners[0][axis]) as f32 * (1.0 / 256.0);
        let (dx1, dy1) = (difference(1, 0), difference(1, 1));
        let (dx2, dy2) = (difference(2, 0), difference(2, 1));
        let r = 65_536.0 / self.doubled_area as f32;
        let e1 = values[1] - values[0];
        let e2 = values[2] - values[0];
        Plane {
            origin: corners[0].map(|subpixels| subpixels as f32 / 256.0),
            value: values[0],
            per_x: (e1 * dy2 - e2 * dy1) * r,
            per_y: (e2 * dx1 - e1 * dx2) * r,
        }
    }
}

/// A value that is affine in window x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// The point at which it is `value`: the first sorted vertex, in pixels.
    pub origin: [f32; 2],
    /// The value at `origin`.
    pub value: f32,
    /// ∂/∂x, in values per pixel.
    pub per_x: f32,
    /// ∂/∂y, in values per pixel.
    pub per_y: f32,
}

impl Plane {
    /// The value at a point of the window, in pixels.
    #[must_use]
    pub fn at(&self, [x, y]: [f32; 2]) -> f32 {
        self.value + ((x - self.origin[0]) * self.per_x + (y - self.origin[1]) * self.per_y)
    }
}
