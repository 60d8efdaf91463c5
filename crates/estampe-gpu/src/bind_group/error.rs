//! Errors of bind groups and their layouts.

use crate::{BindingType, BufferError, TextureError};

/// The reason why a bind group or a layout was not created.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BindGroupError {
    /// Two entries of a layout have the same binding number.
    #[error("two entries of a bind group layout have the same binding number")]
    BindingTwice,
    /// Too many bindings, or too many with a dynamic offset.
    #[error("{count} {what} exceed the limit {limit_name} = {limit}")]
    TooMany {
        /// The number of them.
        count: usize,
        /// The kind of bindings.
        what: &'static str,
        /// The limit's name.
        limit_name: &'static str,
        /// The limit.
        limit: u32,
    },
    /// A layout entry without resource.
    #[error("binding {binding} of {group} is {expected}, and there is no resource for it")]
    Missing {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
        /// The kind of resource.
        expected: BindingType,
    },
    /// A resource that the layout does not name, or one that is given twice.
    #[error("binding {binding} of {group} is given twice, or is not in the layout")]
    Unexpected {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
    },
    /// A resource of another kind.
    #[error("binding {binding} of {group} is {expected}, and the resource is {actual}")]
    Kind {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
        /// The kind of resource in the layout.
        expected: BindingType,
        /// The resource.
        actual: String,
    },
    /// An offset or size that a buffer binding cannot have.
    #[error(
        "binding {binding} of {group} is {size} bytes at offset {offset} of a buffer: the offset must be a \
         multiple of {alignment}, the size {least} to {most} bytes"
    )]
    BufferRange {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
        /// The offset in bytes.
        offset: u64,
        /// The size in bytes.
        size: u64,
        /// The multiple that the offset must be of.
        alignment: u32,
        /// The least size.
        least: u64,
        /// The greatest size.
        most: u64,
    },
    /// A buffer cannot be bound.
    #[error("binding {binding} of {group}: {error}")]
    Buffer {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
        /// The reason.
        error: BufferError,
    },
    /// A texture or its sampler cannot be bound.
    #[error("binding {binding} of {group}: {error}")]
    Texture {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
        /// The reason.
        error: TextureError,
    },
}
