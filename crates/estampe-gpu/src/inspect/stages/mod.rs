//! Any stage can be inspected: what each stage of the pipeline makes of a pass.
//!
//! [`Device::inspect_stages`](crate::Device::inspect_stages) runs a pass with the reference
//! pipeline over all pixels, in bands of tiles on the device's threads, and returns the vertices,
//! what clipping left of the primitives, the tiles that they are binned to, counts of each pixel,
//! and the blocks that hierarchical z rejects.
//!
//! Pixels, vertices and pieces are facts about the drawn image: the two pipelines agree bit by bit.
//! Tiles and blocks are optimisations, which the reference pipeline lacks. They are computed by the
//! rules of the fast one, which are documented at [`PassStages::tiles_of`] and [`BlockCounts`].

mod band;
mod bins;
mod cut;
mod geometry;
mod hidden_blocks;
mod pass_stages;
mod run;

pub use pass_stages::{
    BlockCounts, ClipOutcome, PassStages, PixelCounts, PolygonVertex, StagePiece, StagePrimitive,
    StageVertex,
};
pub(crate) use run::inspect_stages;
