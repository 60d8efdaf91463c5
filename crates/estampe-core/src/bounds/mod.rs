//! The boundary between geometry and tiles: the plain data that both sides name.
//!
//! Geometry sets primitives up and writes them to [`chunk`]s, tiles read the chunks that reach
//! them ([`chunk_index`]) in order, and nothing flows back. Threads take the dearest tiles first
//! ([`tile_costs`]).
//!
//! A chunk holds [`primitives`] and [`lines`], most of them in [`packets`], and their [`bins`],
//! whose memory has [limits](bin_limits).
//! [`pixel_rect`], [`sample_rect`], [`plane`], [`triangle_edges`] and [`transpose`] are the values
//! and operations that both sides use. No module here names a stage.

pub(crate) mod pixel_rect;

pub(crate) mod sample_rect;

pub(crate) mod lane_order;

pub(crate) mod plane;

pub(crate) mod transpose;

pub(crate) mod primitives;

pub(crate) mod lines;

pub(crate) mod slabs;

pub(crate) mod packets;

pub(crate) mod triangle_edges;

pub(crate) mod bin_limits;

pub(crate) mod bins;

pub(crate) mod chunk;

pub(crate) mod chunk_index;

pub(crate) mod tile_costs;
