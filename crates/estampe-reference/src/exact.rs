//! Window transform and interpolation in f64, with bounds for the error of the f32 formulas.
//!
//! In · Out: clip vertices · f64 values, each with the greatest distance of the pipeline's f32
//! result. Snapped positions are taken as they are, because snapping is a definition; everything
//! else is computed from clip space. Method: standard error analysis (Higham 2002, §3.1). Each f32
//! operation is off by at most u = 2⁻²⁴ of its result, so a chain of n operations is off by n·u of
//! the sum of the magnitudes that enter it; terms in u² are covered by 1 % of slack, underflow by a
//! small constant.

use crate::ClipVertex;
use crate::cull::doubled_area;
use crate::viewport::ViewportTransform;
use estampe_types::state::Viewport;

/// Half the distance from 1 to the next f32: 2⁻²⁴.
pub const UNIT_ROUNDOFF: f64 = 1.0 / 16_777_216.0;

/// An upper bound of all underflows of a formula together: 2⁻¹⁴⁰.
const UNDERFLOW: f64 = 7.2e-43;

/// Slack for products of errors and for the rounding of f64 itself.
const SLACK: f64 = 1.01;

/// A value and a bound for the error of its f32 counterpart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounded {
    /// The value in f64.
    pub value: f64,
    /// The greatest distance of the f32 result from the value; infinite if there is no bound.
    pub error: f64,
}

impl Bounded {
    /// Returns true if an f32 result lies within the bound.
    #[must_use]
    pub fn holds(self, computed: f32) -> bool {
        (f64::from(computed) - self.value).abs() <= self.error || self.error.is_infinite()
    }

    fn rounded(value: f64, roundings: f64, magnitude: f64) -> Self {
        Self {
            value,
            error: roundings * UNIT_ROUNDOFF * magnitude * SLACK + UNDERFLOW,
        }
    }
}

/// Window x, y, z and 1/w of a clip-space position, before x and y are snapped.
#[must_use]
pub fn window(viewport: &Viewport, clip: [f32; 4]) -> [Bounded; 4] {
    let v = viewport;
    let [x, y, z, w] = clip.map(f64::from);
    let [left, top, width, height, near, far] =
        [v.x, v.y, v.width, v.height, v.min_depth, v.max_depth].map(f64::from);
    // At most five roundings of either term: 1/w, its product with x, the product with the scale,
    // whose own rounding counts, the rounded offset, and their sum.
    let map = |value: f64, scale: f64, offset: f64| {
        let scaled = value / w * scale;
        Bounded::rounded(scaled + offset, 5.0, scaled.abs() + offset.abs())
    };
    [
        map(x, width / 2.0, left + width / 2.0),
        map(y, -height / 2.0, top + height / 2.0),
        map(z, far - near, near),
        Bounded::rounded(1.0 / w, 1.0, (1.0 / w).abs()),
    ]
}

/// A triangle in the window with the depth, 1/w and varyings of its corners in f64.
#[derive(Debug, Clone)]
pub struct Triangle {
    /// Snapped positions in pixels, ordered by (y, x).
    corners: [[f64; 2]; 3],
    depth: [Bounded; 3],
    inverse_w: [Bounded; 3],
    varyings: [Vec<f64>; 3],
}

impl Triangle {
    /// A triangle that needs no clipping; `None` if it has no area after snapping.
    #[must_use]
    pub fn new(viewport: &Viewport, vertices: &[ClipVertex; 3]) -> Option<Self> {
        let transform = ViewportTransform::new(viewport);
        let mut sorted = vertices
            .each_ref()
            .map(|vertex| (transform.place(vertex).snapped, vertex));
        sorted.sort_by_key(|(snapped, _)| [snapped[1], snapped[0]]);
        let [a, b, c] = &sorted;
        if doubled_area([a.0, b.0, c.0]) == 0 {
            return None;
        }
        let windows = sorted.map(|(_, vertex)| window(viewport, vertex.position));
        Some(Self {
            corners: sorted.map(|(snapped, _)| snapped.map(|at| f64::from(at) / 256.0)),
            depth: windows.map(|[_, _, z, _]| z),
            inverse_w: windows.map(|[_, _, _, inverse_w]| inverse_w),
            varyings: sorted
                .map(|(_, vertex)| vertex.varyings.iter().copied().map(f64::from).collect()),
        })
    }

    /// Depth at a point in pixels, not clamped to the viewport's range.
    #[must_use]
    pub fn depth(&self, at: [f64; 2]) -> Bounded {
        self.plane(self.depth, at)
    }

    /// 1/w at a point in pixels.
    #[must_use]
    pub fn inverse_w(&self, at: [f64; 2]) -> Bounded {
        self.plane(self.inverse_w, at)
    }

    /// No-perspective varying `k` at a point in pixels.
    #[must_use]
    pub fn no_perspective(&self, k: usize, at: [f64; 2]) -> Bounded {
        let exact = |value| Bounded { value, error: 0.0 };
        self.plane(
            self.varyings.each_ref().map(|varyings| exact(varyings[k])),
            at,
        )
    }

    /// Smooth varying `k` at a point in pixels: (A/w) ÷ (1/w). The bound is infinite where 1/w may
    /// be 0.
    ///
    /// With N and Q off by δN and δQ, the quotient A is off by (δN − A·δQ) ÷ (Q + δQ); the division
    /// and the product then round once each.
    #[must_use]
    pub fn smooth(&self, k: usize, at: [f64; 2]) -> Bounded {
        let over_w = [0, 1, 2].map(|v: usize| {
            let value = self.varyings[v][k] * self.inverse_w[v].value;
            Bounded::rounded(value, 2.0, value.abs())
        });
        let n = self.plane(over_w, at);
        let q = self.plane(self.inverse_w, at);
        let value = n.value / q.value;
        let least_q = q.value.abs() - q.error;
        if least_q <= 0.0 {
            return Bounded {
                value,
                error: f64::INFINITY,
            };
        }
        let carried = (n.error + value.abs() * q.error) / least_q;
        let rounded = Bounded::rounded(value, 2.0, value.abs() + carried);
        Bounded {
            value,
            error: carried + rounded.error,
        }
    }

    /// The plane through values at the corners. From the vertices' values to the result of
    /// `p₀ + ((X − x₀)·∂p/∂x + (Y − y₀)·∂p/∂y)` no term is rounded more than ten times: e, its
    /// product, their difference, D, r, the product with r, X − x₀, its product, the two sums.
    fn plane(&self, values: [Bounded; 3], [x, y]: [f64; 2]) -> Bounded {
        let [origin, b, c] = self.corners;
        let [dx1, dy1] = [b[0] - origin[0], b[1] - origin[1]];
        let [dx2, dy2] = [c[0] - origin[0], c[1] - origin[1]];
        let area = dx1 * dy2 - dx2 * dy1;
        let (to_x, to_y) = (x - origin[0], y - origin[1]);
        // The weights of e₁ and e₂, and the magnitudes of the terms of their sums.
        let weights = [
            (to_x * dy2 - to_y * dx2) / area,
            (to_y * dx1 - to_x * dy1) / area,
        ];
        let sizes = [
            ((to_x * dy2).abs() + (to_y * dx2).abs()) / area.abs(),
            ((to_y * dx1).abs() + (to_x * dy1).abs()) / area.abs(),
        ];

        let [p0, p1, p2] = values;
        let e = [p1.value - p0.value, p2.value - p0.value];
        let value = p0.value + (e[0] * weights[0] + e[1] * weights[1]);
        let magnitude = p0.value.abs() + e[0].abs() * sizes[0] + e[1].abs() * sizes[1];
        // The errors of the corners' values, carried through the weights.
        let carried =
            p0.error + (p1.error + p0.error) * sizes[0] + (p2.error + p0.error) * sizes[1];
        let rounded = Bounded::rounded(value, 10.0, magnitude + carried);
        Bounded {
            value,
            error: carried * SLACK + rounded.error,
        }
    }
}
