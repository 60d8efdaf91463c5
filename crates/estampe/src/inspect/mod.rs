//! `estampe inspect`: everything that happened to one pixel of a picture, or what a stage made of
//! all of it.
//!
//! [`arguments`] has the options, [`command`] runs them, [`text`] and [`json`] write the history,
//! and [`stages`] draws the stages.

mod arguments;
mod command;
mod json;
mod stages;
mod text;

pub(crate) use arguments::InspectArgs;
pub(crate) use command::run;
