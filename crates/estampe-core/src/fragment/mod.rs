//! Fragment shading (F1, R5): interpolates the shader's inputs and runs the shader, packets at a
//! time.
//!
//! *In* coverage and primitives · *Out* colours, discards, depths · *Space* window · *Precision*
//! f32 in the order of `docs/NUMERICS.md`.
//!
//! Packets of all primitives of a draw that meet in a tile are queued, so that the program is
//! entered for sixteen at once; the order of the queue is the order of the primitives, which
//! blending keeps.

pub(crate) mod alpha_test;

pub(crate) mod interpolate;

pub(crate) mod quad;

pub(crate) mod place;

pub(crate) mod fill;

pub(crate) mod last_packet;

mod centroid;

pub(crate) mod cross_fragments;

mod vertex_rows;

pub(crate) mod cross_triangle;

pub(crate) mod cross_line;

pub(crate) mod queue;
