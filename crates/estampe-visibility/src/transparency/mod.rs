//! Transparency: sorted, exact per pixel, or weighted without order.
//!
//! Blending mixes a fragment with what lies behind it, C = α·C_new + (1 − α)·C_old, so fragments
//! must come from the farthest on.
//!
//! | method | order | fails |
//! |---|---|---|
//! | [`Sorted`](Transparency::Sorted) | polygons by their centres | where polygons cross or overlap in cycles, as the [painter](crate::painter) |
//! | [`Exact`](Transparency::Exact) | fragments of each pixel, by depth peeling | never; a pass for each layer |
//! | [`Weighted`](Transparency::Weighted) | none: one sum for all fragments | colours are means, weighted by depth |
//!
//! *Depth peeling* (Everitt, "Interactive Order-Independent Transparency", 2001), here from the
//! farthest layer on: a pass finds, in each pixel, the depth of the farthest fragment that is
//! nearer than the layer before; a second one blends the fragments of that depth. Fragments of one
//! depth are blended in the order of submission, as sorted lists of each pixel would be.
//!
//! *Weighted blending* (McGuire and Bavoil, "Weighted Blended Order-Independent Transparency",
//! Journal of Computer Graphics Techniques 2(2), 2013) has two targets,
//!
//! ```text
//!   A = Σ (α·C, α)·w      B = Π (1 − α)      C = A_rgb/A_α · (1 − B) + C_opaque·B
//!   w = α·max(10⁻², 3·10³·(1 − d)³)          their equation 10; d is 0 near and 1 far
//! ```

mod method;
mod passes;
mod shader;
#[cfg(test)]
mod tests;

pub use method::{Transparency, draw, draw_in_order};
