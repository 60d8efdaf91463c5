//! `estampe sheet`: many models, or the views of one, as labelled cells of one picture.
//!
//! ```text
//! arguments -> models (files, globs, lists) × views -> layout (cells, size of the sheet)
//!           -> pool -> job (read, draw each view, copy it into the sheet; or its problem as text)
//!           -> encode -> output (complete or not at all), report
//! ```
//!
//! Cells are drawn side by side by any number of threads, each to its own place, so the sheet has
//! the same bytes. A frame is copied when it is drawn: the memory is that of the sheet, and of a
//! model and a frame for each thread.

mod arguments;
mod command;
mod job;
mod layout;
mod models;
mod paint;
mod pool;
mod report;
mod views;
mod wrap;

pub(crate) use arguments::SheetArgs;
pub(crate) use command::run;
