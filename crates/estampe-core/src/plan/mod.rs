//! The plan: draws as plain values that the stages follow.
//!
//! [`pass_check`] refuses a pass that does not fit its target. A pass's draws are cut into
//! [`draw_batch`]es by the [`draw_cursor`], so that memory is bounded whatever is drawn; most
//! passes are one batch. A batch holds [`sub_draw`]s, each with the vertices and primitives of a
//! draw or of part of one ([`index_range`] finds the vertices, of indices
//! by [`index_extremes`]), and the [`draw_state`]s that they
//! share. [`chunk_plan`] divides a batch's primitives among the workers of the geometry side.
//! [`tile_plan`] resolves a sub-draw's state for the tile side; its path is chosen in `tile_path`.

pub(crate) mod pass_check;

pub(crate) mod draw_state;

pub(crate) mod sub_draw;

mod index_range;

mod index_extremes;

pub(crate) mod draw_batch;

pub(crate) mod draw_cursor;

pub(crate) mod chunk_plan;

pub(crate) mod tile_plan;
