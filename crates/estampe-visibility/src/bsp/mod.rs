//! BSP trees: an order from back to front that is exact, for any eye.
//!
//! The plane of a polygon divides space (Fuchs, Kedem and Naylor, "On Visible Surface Generation by
//! A Priori Tree Structures", 1980). Polygons on both sides are cut. Nothing on the eye's side of a
//! plane is hidden by anything on the other side, so
//!
//! ```text
//!   back to front = the other side ▸ polygons in the plane ▸ the eye's side
//! ```
//!
//! Sides are exact (Shewchuk): the comparisons of one tree do not contradict each other. Only the
//! corners that cuts make are rounded, to f64.
//!
//! *Splitters.* A sphere of n facets has no plane with facets on both sides, and a tree of its
//! facets' planes alone is a list: n²/2 comparisons, six minutes for 10⁵. So planes across an axis,
//! at the median, are candidates too; they hold no polygon, cut a few, and halve the rest.

mod build;
mod cut;
mod splitter;
#[cfg(test)]
mod tests;
mod tree;

pub use build::{BspError, BspOptions};
pub use tree::{BspTree, Piece};
