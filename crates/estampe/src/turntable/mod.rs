//! `estampe turntable`: an animation of a model that turns once around.
//!
//! ```text
//! arguments -> input -> poses (of --animate) -> orbit (one distance for all frames)
//!           -> renderer, frame by frame -> output (GIF, APNG, WebP, Y4M or numbered pictures)
//! ```

mod arguments;
mod command;
mod orbit;
mod output;
mod poses;

pub(crate) use arguments::TurntableArgs;
pub(crate) use command::run;
pub(crate) use orbit::{Orbit, turned};
