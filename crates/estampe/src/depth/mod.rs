//! `estampe depth`: the least separation of surfaces that a depth buffer tells apart.
//!
//! ```text
//! arguments -> method (planes, format, mapping)
//!           -> table (text or JSON), and a plot as SVG or a picture
//! ```

mod arguments;
mod command;
mod plot;
mod table;

pub(crate) use arguments::DepthArgs;
pub(crate) use command::run;
