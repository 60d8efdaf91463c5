//! `estampe diff`: measures the difference of two images.
//!
//! ```text
//!   two files --command--> two images --compare--> exact counts, maximum and mean per channel
//!                                     --flip-----> perceived difference of each pixel
//!   perceived difference --heatmap--> image
//! ```
//!
//! The exact numbers decide the result (`--max`); FLIP measures the perceived difference.

pub(crate) mod command;
pub(crate) mod compare;
pub(crate) mod flip;
pub(crate) mod heatmap;
pub(crate) mod report;

pub(crate) use command::{DiffArgs, run};
