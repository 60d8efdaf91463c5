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
//! The last two are those of [`estampe_transparency`], which works for draws of any kind.

mod method;
mod passes;
mod shader;
#[cfg(test)]
mod tests;

pub use method::{Transparency, draw, draw_in_order};
