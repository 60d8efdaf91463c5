//! `estampe batch`: draws many models in one process.
//!
//! ```text
//! arguments -> inputs (globs, lists) or job_file -> plan (template, views, shard)
//!           -> pool: record (up to date?) -> job (read, draw, encode, write) -> record
//!           -> summary, report
//! ```
//!
//! A file that fails ends alone. Pictures and records are written whole or not at all, so a process
//! that is killed at any instant leaves nothing that the next one would trust wrongly.

mod arguments;
mod command;
pub(crate) mod deadline;
pub(crate) mod inputs;
mod job;
mod job_file;
mod lines;
mod look;
mod option_table;
mod plan;
mod pool;
mod record;
mod summary;
mod template;

pub(crate) use arguments::BatchArgs;
pub(crate) use command::run;
pub(crate) use lines::Lines;
pub(crate) use option_table::{OptionTable, schema};
