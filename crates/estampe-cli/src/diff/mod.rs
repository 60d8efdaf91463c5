//! `estampe diff`: how far two pictures are apart.
//!
//! ```text
//!   two files --command--> two images --compare--> exact counts, maximum and mean per channel
//!                                     --flip-----> perceived difference of each pixel --heatmap--> picture
//! ```
//!
//! The exact numbers decide the verdict (`--max`); the perceptual one says how much an eye would mind.

pub(crate) mod command;
pub(crate) mod compare;
pub(crate) mod flip;
pub(crate) mod heatmap;
pub(crate) mod report;

pub(crate) use command::{DiffArgs, run};
