//! The option of cameras.

use clap::Args;
use std::path::PathBuf;

/// Cameras of a data set.
#[derive(Debug, Clone, Args)]
pub(crate) struct CamerasArgs {
    /// Draw the model once for each pinhole camera of a JSON file
    ///
    /// A list of {name, width, height, K, R, t}, as --json --pass prints them: a point p is seen at
    /// the pixel K (R p + t), x right, y down, z forward. Without a name the number, from 0000;
    /// without a size that of --size. The output has {camera} in its name, or in its folder.
    /// `estampe schema cameras` prints the schema.
    #[arg(long, value_name = "FILE", help_heading = "Data passes")]
    #[arg(conflicts_with_all = [
        "view", "azimuth", "elevation", "eye", "camera", "target", "fov", "ortho", "zoom",
    ])]
    pub(crate) cameras: Option<PathBuf>,
}
