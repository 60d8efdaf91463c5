//! Parametric surfaces S(s, t) on a grid.
//!
//! A rectangle of parameters is divided into cells; s runs along the image's u, to the right as
//! seen from outside, and t along its v, downwards. The outside is therefore the side of ∂S/∂t ×
//! ∂S/∂s:
//!
//! ```text
//!   (s₀,t₀)───────▶ s, u        a─────d
//!      │  ┌──┬──┬──┐            │ ╲   │     each cell: a b c, a c d,
//!      │  ├──┼──┼──┤            │   ╲ │     counter-clockwise from outside
//!      ▼  └──┴──┴──┘            b─────c
//!    t, v
//! ```
//!
//! If a row of the grid is a single point, as at a sphere's poles, its cells are triangles. Each
//! has a separate pole vertex whose u is that of the cell's middle.

//!
//! [`sheet()`] is the general form: it takes points with their derivatives, finds the normals of
//! poles as limits, closes seams, and leaves out where a function jumps or is not defined.
//! [`curve()`] does the same for curves C(t).

mod circle;
mod curves;
mod grid;
mod jet;
mod sheet;
mod solids;

pub use circle::cos_sin_turns;
pub use curves::{curve, helix};
pub use grid::{MAX_CELLS, SurfacePoint, surface};
pub(crate) use grid::{append_grid, between};
pub use jet::{SurfaceJet, numeric_jet};
pub(crate) use sheet::Draft;
pub use sheet::{Grid, Seams, sheet};
pub use solids::{plane, sphere, torus};

#[cfg(test)]
mod tests;
