//! Pictures of the stages: what each stage of the pipeline made of the whole frame.
//!
//! Each stage has a file that draws its [`Sheet`] and counts its totals: [`vertex`], [`clip`],
//! [`bin`], [`raster`], [`fragment`] (also for blend) and [`depth`]. [`sheet`] lays out panels and
//! legends, [`heat`] has the colours.

mod bin;
mod clip;
mod depth;
mod fragment;
mod heat;
mod raster;
mod sheet;
mod totals;
mod vertex;

use crate::failure::Failure;
use clap::ValueEnum;
use estampe::Device;
use estampe_renderer::FrameStages;
use estampe_scene::Image;
use totals::Totals;

/// The stages of the pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StageName {
    /// Vertices in every space
    Vertex,
    /// Primitives inside, clipped and dropped
    Clip,
    /// Tiles and the pieces in each
    Bin,
    /// Barycentric coordinates of the visible pieces
    Raster,
    /// Runs of the fragment shader at each pixel
    Fragment,
    /// Stored depths, and blocks that hierarchical z rejects
    Depth,
    /// Colours stored at each pixel
    Blend,
    /// Every stage, each in a file of its own
    All,
}

impl StageName {
    /// The stages, without [`StageName::All`].
    pub(super) const EACH: [Self; 7] = [
        Self::Vertex,
        Self::Clip,
        Self::Bin,
        Self::Raster,
        Self::Fragment,
        Self::Depth,
        Self::Blend,
    ];

    /// The name on the command line.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Clip => "clip",
            Self::Bin => "bin",
            Self::Raster => "raster",
            Self::Fragment => "fragment",
            Self::Depth => "depth",
            Self::Blend => "blend",
            Self::All => "all",
        }
    }
}

/// The picture of a stage and its totals.
pub(super) struct Shown {
    pub(super) image: Image,
    pub(super) totals: Totals,
}

/// Draws a stage of a frame.
pub(super) fn show(
    stage: StageName,
    frame: &FrameStages,
    device: &Device,
) -> Result<Shown, Failure> {
    let (sheet, totals) = match stage {
        StageName::Vertex => vertex::sheet(frame, device)?,
        StageName::Clip => clip::sheet(&frame.stages, device)?,
        StageName::Bin => bin::sheet(&frame.stages, device)?,
        StageName::Raster => raster::sheet(&frame.stages),
        StageName::Fragment => fragment::runs(&frame.stages),
        StageName::Depth => depth::sheet(&frame.stages),
        StageName::Blend | StageName::All => fragment::stored(&frame.stages),
    };
    let image = sheet.draw(device)?;
    Ok(Shown { image, totals })
}
