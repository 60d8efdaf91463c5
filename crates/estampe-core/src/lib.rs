#![forbid(unsafe_code)]
//! The pipeline: from vertices to pixels.
//!
//! ```text
//!     Draw ─▶ geometry ───────────────────────────────────────────────────┐
//!             fetch ▸ shading ▸ assembly ▸ cull ▸ clip ▸ viewport ▸ setup  │ chunks of primitives
//!                                                                         ▼
//!             ═════════════════════ tiles: plain data, the one boundary ═════════════════════
//!                                                                         │ one tile a worker
//!             attachment ◀ per_sample ◀ fragment ◀ raster ◀───────────────┘
//! ```
//!
//! Data flows one way: each stage owns the type that it gives, and the next one takes it. State is a
//! value: a descriptor is validated once into a [`RenderPipeline`], and drawing cannot fail.
//! Both sides of the boundary run in parallel: geometry in chunks cut by primitive count, never by
//! thread count, and tiles, each with its own slice of the attachments; so an image's bytes cannot
//! depend on the number of threads. The conventions and the order of every operation are in
//! `docs/NUMERICS.md`.
//!
//! The modules, in pipeline order: `layout` (which pixel is stored where), [`pipeline`] (state), `geometry`, `tiles`, `raster`, `fragment`,
//! `per_sample`, [`attachment`]; `tile_pass` and [`draw`] are the two pages that call them in order,
//! `wave` cuts draws into items, `schedule` runs them on threads, [`recording`] notes what they took.

mod layout;
pub mod pipeline;

mod geometry;

mod tiles;

mod raster;

mod fragment;

mod per_sample;

pub mod attachment;

pub mod commands;

pub mod draw;
pub mod recording;
mod schedule;
pub mod statistics;
mod tile_pass;
mod wave;

pub use attachment::{RenderTarget, RenderTargetDescriptor, TargetError};
pub use commands::{Draw, LoadOp, OcclusionQueries, RenderPass};
pub use draw::Context;
pub use pipeline::{PipelineError, RenderPipeline, RenderPipelineDescriptor};
pub use schedule::ThreadError;
pub use statistics::Statistics;
