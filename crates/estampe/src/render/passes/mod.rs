//! Data passes: depth, normals, numbers of objects and other images of one camera, for data sets
//! and compositing.
//!
//! ```text
//! arguments → files   one OpenEXR, or a file for each pass
//!           → planes  the samples of a pass, from the picture and from the surfaces at its pixels
//!           → draw    draws what they are made of, and encodes each file
//!           → command writes and reports
//! ```

mod arguments;
mod command;
mod draw;
mod files;
mod planes;

pub(super) use arguments::OutputFormatName;
pub(crate) use arguments::{PassArgs, PassName};
pub(super) use command::{pinhole_json, run};
pub(crate) use files::{Files, PassFile, PassFormat};
pub(crate) use planes::Sources;
