//! Data passes: depth, normals, numbers of objects and other images of one camera, for data sets
//! and compositing.
//!
//! ```text
//! arguments → files   one OpenEXR, or a file for each pass
//!           → planes  the samples of a pass, from the picture and from the surfaces at its pixels
//!           → command draws, encodes and writes
//! ```

mod arguments;
mod command;
mod files;
mod planes;

pub(super) use arguments::{OutputFormatName, PassArgs};
pub(super) use command::run;
pub(super) use files::Files;
