//! The geometry side: from a draw's vertices to set-up primitives in bins.
//!
//! [`plan`] is the draw's state as all stages read it. The stages, in the order in which data
//! flows: [`fetch`] reads attributes; [`shading`] runs the vertex shader and takes its vertices
//! through the [`viewport`] to the window, where they wait as [`shaded_vertices`]; [`assembly`]
//! joins vertices into primitives, in [`groups`] of sixteen, for each [`run`]; [`cull`] drops most
//! triangles ([`facing`] says which side is culled); [`setup`] sorts vertices ([`vertex_order`]),
//! drops triangles that cover no sample ([`cull_uncovered`]), lets sixteen gather ([`waiting`]),
//! makes planes and moves those of depth ([`depth_bias`]); [`binning`] finds tiles, those
//! of large triangles by [`tile_edges`]. [`filled`] is the loop over these, and [`chunk`] its
//! entry. [`ahead`] prefetches what comes next.
//!
//! The exceptions: [`restart`] assembles primitives where indices may end them; [`clip_detour`]
//! takes the few primitives that leave the view volume through [`clip`], with positions and
//! distances that [`clip_positions`] computes again; [`polygon_mode`], [`lines`] and [`points`]
//! draw what is no filled triangle, in the shape that [`line_style`] says.
//!
//! Each vertex is shaded once: the dense index range of a sub-draw is shaded as a whole before its
//! primitives are assembled.

pub(crate) mod plan;

mod ahead;

pub(crate) mod fetch;

pub(crate) mod viewport;

pub(crate) mod shaded_vertices;

pub(crate) mod shading;

pub(crate) mod assembly;

pub(crate) mod groups;

pub(crate) mod run;

pub(crate) mod facing;

pub(crate) mod cull;

pub(crate) mod cull_uncovered;

pub(crate) mod depth_bias;

mod vertex_order;
mod waiting;

mod rectangles;

pub(crate) mod setup;

mod tile_edges;

pub(crate) mod binning;

mod filled;
mod gathered;

pub(crate) mod restart;

pub(crate) mod clip;

pub(crate) mod clip_positions;

mod clip_detour;

mod polygon_mode;

mod lines;

mod points;

pub(crate) mod line_style;

pub(crate) mod chunk;
