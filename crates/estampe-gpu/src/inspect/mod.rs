//! Any pixel explains itself: everything that happened to one pixel in a pass.
//!
//! [`Device::inspect`](crate::Device::inspect) runs a pass again, with the reference pipeline in
//! place of the fast one, on the 2×2 pixels around one pixel, and writes down what touches it. The
//! two pipelines agree bit by bit, so the history ends with the pixel that
//! [`Device::render`](crate::Device::render) draws. Attachments and storage textures stay as they
//! are.

mod amplified;
mod history;
mod initial;
mod oracle_draw;
mod record;
mod run;
mod stages;

pub use history::{
    EmittedRecord, FragmentRecord, InspectedVertex, PieceVertex, PixelHistory, PrimitiveKind,
    PrimitiveOrigin, PrimitiveRecord, SampleRecord, SampleValues, TessellatedRecord,
    TessellatedVertex,
};
pub use run::InspectError;
pub(crate) use run::inspect;
pub(crate) use stages::inspect_stages;
pub use stages::{
    BlockCounts, ClipOutcome, PassStages, PixelCounts, PolygonVertex, StagePiece, StagePrimitive,
    StageVertex,
};

/// The result of a sample's tests.
pub use estampe_reference::per_sample::Outcome as TestOutcome;
