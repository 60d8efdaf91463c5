//! The painter's algorithm: polygons drawn from the farthest on, each over those before it.
//!
//! A sort by one number per polygon is fast, and wrong: a large polygon may be nearer in one part
//! of the picture and farther in another. Even the best order does not always exist: polygons that
//! cross, and three or more that overlap in a cycle, have none, and must be cut
//! ([`bsp`](crate::bsp)).
//!
//! [`by_pairs`] compares all pairs (Newell, Newell and Sancha, "A Solution to the Hidden Surface
//! Problem", 1972, test and reorder pairs until none is wrong): it finds an order if there is one,
//! and names the polygons for which there is none.

mod pairs;
mod sort;
#[cfg(test)]
mod tests;

pub use pairs::{MAX_POLYGONS, PairwiseOrder, TooManyPolygons, by_pairs};
pub use sort::{by_centre, by_farthest_corner};
