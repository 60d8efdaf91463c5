//! `estampe shape`: meshes a function, as a model or a picture.
//!
//! ```text
//! arguments -> function (expressions, kind) + grid (ranges, cells)
//!           -> mesh (curve or surface)
//!           -> command: a model's file, or a picture by the stages of `estampe render`
//! ```

mod arguments;
mod command;
mod function;
mod grid;
mod mesh;

pub(crate) use arguments::ShapeArgs;
pub(crate) use command::run;
