//! Errors of buffers.

use super::BufferUsages;
use std::ops::Range;

/// The reason why a buffer was not created, written or read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BufferError {
    /// The buffer exceeds a limit.
    #[error("{buffer} of {size} bytes exceeds the limit max_buffer_size = {limit}")]
    TooLarge {
        /// The buffer.
        buffer: String,
        /// Its size in bytes.
        size: u64,
        /// The limit in bytes.
        limit: u64,
    },
    /// The system has not enough memory.
    #[error("no memory for {buffer} of {size} bytes")]
    OutOfMemory {
        /// The buffer.
        buffer: String,
        /// Its size in bytes.
        size: u64,
    },
    /// A range that ends beyond the buffer.
    #[error(
        "bytes {}..{} of {buffer}, which has {size}: use a range inside the buffer",
        range.start, range.end
    )]
    Range {
        /// The buffer.
        buffer: String,
        /// The range in bytes.
        range: Range<u64>,
        /// The size of the buffer in bytes.
        size: u64,
    },
    /// A use that the buffer was not created for.
    #[error("{buffer} was created without BufferUsages::{}: add it to its usage", names(*needed))]
    Usage {
        /// The buffer.
        buffer: String,
        /// The use.
        needed: BufferUsages,
    },
}

fn names(usages: BufferUsages) -> String {
    let names: Vec<&str> = usages.iter_names().map(|(name, _)| name).collect();
    names.join(" | ")
}
