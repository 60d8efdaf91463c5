//! Tessellation (V3) and geometry shaders (V4): the stages that make more primitives of those of a
//! draw.
//!
//! ```text
//! elements ─▶ vertices ─▶ [tessellate: control ▸ levels ▸ domain ▸ evaluate]
//!                                                     ─▶ [geometry] ─▶ pieces
//! ```
//!
//! A pipeline with such a stage holds two others: one that shades vertices, and one whose vertex
//! shader reads finished *records* from a buffer and passes them through. An amplified draw becomes
//! *pieces*, each a buffer of records and a list of indices, which are drawn by the second pipeline
//! like any other draw. So everything from assembly on knows nothing of these stages, and a draw
//! without them costs nothing.
//!
//! A draw is cut into parts of its primitives, and what these make into units whose memory is
//! bounded, whatever its levels. Both depend on the draw alone; units are worked on in parallel and
//! their pieces keep the order of the draw, so the image does not depend on threads.
//!
//! * [`elements`]: the vertices of each patch or primitive, over instances and restarts;
//! * [`vertices`]: shading them, and their records;
//! * [`subdivision`], [`domain`]: the tessellator;
//! * [`tessellate`]: patches to primitives;
//! * [`geometry`]: primitives to pieces;
//! * [`piece`]: what is drawn.

pub(crate) mod amplify;
pub(crate) mod domain;
mod elements;
mod geometry;
pub(crate) mod piece;
mod subdivision;
mod tessellate;
mod vertices;
