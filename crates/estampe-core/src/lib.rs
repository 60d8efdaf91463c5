#![forbid(unsafe_code)]
//! The pipeline: from vertices to pixels.
//!
//! ```text
//!     Draws ─▶ plan: batches of sub-draws, states resolved once
//!                │
//!                ▼  geometry, in slices of vertices, then in chunks of primitives
//!     fetch ▸ vertex shader ▸ viewport transform ──▶ assembly ▸ cull ─────▸ set-up ▸ binning
//!                                                                └▸ clip ▸─┘  detour, where needed
//!                │
//!     ═══════════▼══════════ bounds: chunks of plain data, the one boundary ══════════════════
//!                │
//!                ▼  one tile a worker
//!     raster ▸ fragment ▸ per_sample ▸ attachment
//! ```
//!
//! The viewport transform is part of vertex shading, so that culling compares window positions. The
//! detour computes the clip-space positions of its vertices again, cuts, and takes the pieces to
//! the window.
//!
//! Data flows one way: each stage owns the type that it gives, and the next one takes it. State is
//! a value: a descriptor is validated once into a [`RenderPipeline`], a pass is checked before
//! anything is drawn, and drawing cannot fail after that. Both sides of the boundary run in
//! parallel: geometry in chunks cut by the draws, never by thread count, and tiles, each with its
//! own slice of the attachments; so an image's bytes cannot depend on the number of threads. The
//! conventions and the order of every operation are in `docs/NUMERICS.md`.
//!
//! The modules, in pipeline order: `layout` (which pixel is stored where), [`pipeline`] (state),
//! `plan`, `geometry`, `bounds`, `raster`, `fragment`, `per_sample`, [`attachment`]; [`draw`] and
//! `tile_pass` are the two pages that call them in order, `schedule` runs them on threads,
//! [`profile`] measures them, `recycle` keeps memory from pass to pass.

mod depth_format;
mod layout;
pub mod pipeline;

mod plan;

mod amplification;

mod geometry;

mod bounds;

mod raster;

mod fragment;

mod per_sample;

pub mod attachment;

pub mod commands;

mod amplified_pass;
pub mod draw;
pub mod profile;
mod recycle;
mod schedule;
mod segments;
pub mod statistics;
mod tile_pass;
pub mod tile_path;
mod transfer;

pub use amplification::domain::TessellatedDomain;
pub use attachment::{
    ColorResolve, ColorRows, ColorTexels, DepthStencilTexels, ImageSize, RenderTarget, ResolveMode,
    TargetShape, row_order_words,
};
pub use commands::{
    Discards, Draw, DrawIter, DrawList, LoadOp, OcclusionQueries, PassControl, RenderPass,
    ViewportScissor,
};
pub use draw::Context;
pub use pipeline::{
    PipelineError, RenderPipeline, RenderPipelineDescriptor, TessellationState,
    check_bind_group_layouts, check_declared, check_immediates,
};
pub use plan::pass_check::{DrawChecker, DrawNeeds, RenderPassError};
pub use recycle::recycled;
pub use schedule::{Awake, ThreadError, ThreadPool, ThreadPoolBuilder};
pub use statistics::Statistics;
pub use tile_path::{PathCounts, TilePath};
