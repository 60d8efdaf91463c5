//! Errors of compute pipelines and dispatches.

use crate::{
    BufferConflict, BufferError, ImmediatesError, PipelineError, TextureConflict, TextureError,
};
use estampe_types::shader::ComputeStopped;

/// The rule that a compute pipeline breaks.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ComputePipelineError {
    /// Too many bind groups, bindings or immediates.
    #[error(transparent)]
    Bindings(#[from] PipelineError),
    /// A work-group is too large, or empty.
    #[error(
        "work-groups of {}x{}x{} invocations: each number is at least 1; the limit {limit_name} is {limit}",
        size[0], size[1], size[2]
    )]
    WorkgroupSize {
        /// The invocations along x, y and z.
        size: [u32; 3],
        /// The limit's name.
        limit_name: &'static str,
        /// The limit.
        limit: u32,
    },
    /// Work-groups share too much memory.
    #[error(
        "work-groups share {bytes} bytes; the limit max_compute_workgroup_storage_size is {limit}"
    )]
    WorkgroupStorage {
        /// The bytes that they share.
        bytes: u32,
        /// The limit.
        limit: u32,
    },
}

/// The reason why a dispatch was refused or stopped.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}: {kind}", name(pipeline.as_deref()))]
pub struct DispatchError {
    /// The label of the pipeline.
    pub pipeline: Option<String>,
    /// The rule that it breaks.
    pub kind: DispatchErrorKind,
}

fn name(label: Option<&str>) -> String {
    label.map_or("the dispatch".to_owned(), |label| {
        format!("the dispatch of `{label}`")
    })
}

/// The rule that a dispatch breaks. Nothing has run then, unless it was
/// [stopped](DispatchErrorKind::Stopped).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DispatchErrorKind {
    /// Too many work-groups.
    #[error(
        "{}x{}x{} work-groups; the limit max_compute_workgroups_per_dimension is {limit}",
        count[0], count[1], count[2]
    )]
    TooManyWorkgroups {
        /// The work-groups along x, y and z.
        count: [u32; 3],
        /// The limit.
        limit: u32,
    },
    /// A bind group that does not fit.
    #[error("bind group {group}: {rule}")]
    BindGroup {
        /// The number of the group.
        group: usize,
        /// The rule that it breaks.
        rule: String,
    },
    /// Too few or too many immediates.
    #[error(transparent)]
    Immediates(#[from] ImmediatesError),
    /// A buffer is written and used otherwise.
    #[error(transparent)]
    BufferUsedTwice(#[from] BufferConflict),
    /// A texture is stored to and sampled.
    #[error(transparent)]
    TextureUsedTwice(#[from] TextureConflict),
    /// A buffer that cannot be used as it is.
    #[error(transparent)]
    Buffer(#[from] BufferError),
    /// The offset of the numbers of work-groups is no multiple of 4.
    #[error("the numbers of work-groups begin at byte {0}, which is not a multiple of 4")]
    IndirectOffset(u64),
    /// A texture that cannot be used as it is.
    #[error("{group}: {error}")]
    Texture {
        /// The bind group.
        group: String,
        /// The reason.
        error: TextureError,
    },
    /// Work-groups were stopped. What they had stored until then stays.
    #[error(transparent)]
    Stopped(#[from] ComputeStopped),
}
