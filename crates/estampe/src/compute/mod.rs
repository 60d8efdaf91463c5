//! `estampe compute`: runs a compute shader.
//!
//! ```text
//! source -> module -> program -> resources (buffers from files) -> dispatch -> buffers to files
//! ```

mod arguments;
mod command;

pub(crate) use arguments::ComputeArgs;
pub(crate) use command::run;
