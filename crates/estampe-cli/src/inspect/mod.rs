//! `estampe inspect`: everything that happened to one pixel of a picture.
//!
//! [`arguments`] has the options, [`command`] runs them, and [`text`] and [`json`] write the
//! history.

mod arguments;
mod command;
mod json;
mod text;

pub(crate) use arguments::InspectArgs;
pub(crate) use command::run;
