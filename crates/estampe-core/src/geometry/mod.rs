//! The geometry side: from a draw's vertices to set-up primitives in bins.
//!
//! The stages, in order: [`fetch`] reads attributes, [`shading`] runs the vertex shader and projects
//! its vertices, [`assembly`] joins vertices into primitives ([`restart`] does where indices may end them), [`cull`]
//! drops most of the triangles sixteen at a time and [`between`] those that lie between samples, [`clip`] cuts the
//! few that need it, [`viewport`] is the way from clip
//! space to the window, [`setup`] sorts vertices and makes planes ([`depth_bias`] moves those of depth), [`binning`]
//! finds tiles; [`line_style`] says what shape lines have; [`rows`] is how
//! vertices, one after the other in memory, become lanes.
//!
//! Each vertex is shaded once: an item's dense index range is shaded as a whole before its primitives
//! are assembled.

pub(crate) mod viewport;

pub(crate) mod rows;

pub(crate) mod fetch;

pub(crate) mod shading;

pub(crate) mod positions;

pub(crate) mod assembly;

pub(crate) mod restart;

pub(crate) mod cull;

pub(crate) mod between;

pub(crate) mod clip;

pub(crate) mod line_style;

pub(crate) mod binning;

pub(crate) mod depth_bias;

pub(crate) mod setup;

pub(crate) mod chunk;
