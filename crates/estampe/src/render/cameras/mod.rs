//! `--cameras`: a picture, or passes, for each camera of a file.
//!
//! ```text
//! arguments -> file (JSON, checked by path) -> command (draws and writes each camera)
//! ```

mod arguments;
mod command;
mod file;
mod matrix;
mod schema;

pub(crate) use arguments::CamerasArgs;
pub(super) use command::{Shots, run};
pub(crate) use file::{NamedCamera, read};
pub(crate) use schema::schema;
