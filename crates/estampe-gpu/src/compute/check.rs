//! The rules of compute pipelines and dispatches.

use super::{ComputePipelineError, Dispatch, DispatchError, DispatchErrorKind, DispatchSize};
use crate::bind_group::{BoundError, check_layouts, check_offsets};
use crate::buffer::check_conflicts;
use crate::immediates::check_immediates;
use crate::texture::check_texture_conflicts;
use crate::{BindGroup, Buffer, BufferUsages, Limits};
use estampe_types::shader::ComputeInterface;

pub(super) fn check_interface(
    interface: &ComputeInterface,
    limits: &Limits,
) -> Result<(), ComputePipelineError> {
    let size = interface.workgroup_size;
    let invocations = size.iter().map(|side| u64::from(*side)).product::<u64>();
    let side = u64::from;
    let rules = [
        (
            side(size[0]),
            "max_compute_workgroup_size_x",
            limits.max_compute_workgroup_size_x,
        ),
        (
            side(size[1]),
            "max_compute_workgroup_size_y",
            limits.max_compute_workgroup_size_y,
        ),
        (
            side(size[2]),
            "max_compute_workgroup_size_z",
            limits.max_compute_workgroup_size_z,
        ),
        (
            invocations,
            "max_compute_invocations_per_workgroup",
            limits.max_compute_invocations_per_workgroup,
        ),
    ];
    for (count, limit_name, limit) in rules {
        if count == 0 || count > u64::from(limit) {
            return Err(ComputePipelineError::WorkgroupSize {
                size,
                limit_name,
                limit,
            });
        }
    }
    let limit = limits.max_compute_workgroup_storage_size;
    let bytes = interface.workgroup_storage_bytes;
    if bytes > limit {
        return Err(ComputePipelineError::WorkgroupStorage { bytes, limit });
    }
    Ok(())
}

/// Checks a dispatch, but for numbers of work-groups that a buffer holds.
pub(crate) fn check(limits: &Limits, dispatch: &Dispatch<'_>) -> Result<(), DispatchError> {
    check_kind(limits, dispatch).map_err(|kind| of_dispatch(dispatch, kind))
}

pub(super) fn of_dispatch(dispatch: &Dispatch<'_>, kind: DispatchErrorKind) -> DispatchError {
    DispatchError {
        pipeline: dispatch.pipeline.label().map(str::to_owned),
        kind,
    }
}

pub(super) fn check_kind(
    limits: &Limits,
    dispatch: &Dispatch<'_>,
) -> Result<(), DispatchErrorKind> {
    let layouts = dispatch.pipeline.bind_group_layouts();
    let bad = |BoundError { group, rule }| DispatchErrorKind::BindGroup { group, rule };
    check_layouts(layouts, dispatch.bind_groups, limits).map_err(bad)?;
    check_offsets(dispatch.bind_groups, dispatch.dynamic_offsets, limits).map_err(bad)?;
    let needed = dispatch.pipeline.program().immediate_size();
    check_immediates(dispatch.immediates, needed, limits)?;
    let groups: Vec<&BindGroup> = dispatch.bind_groups.iter().collect();
    let indirect = match dispatch.size {
        DispatchSize::Workgroups(count) => {
            check_count(limits, count)?;
            None
        }
        DispatchSize::Indirect(buffer, offset) => {
            check_indirect(buffer, offset)?;
            Some((buffer, || "numbers of work-groups".to_owned()))
        }
    };
    check_conflicts(&groups, indirect.into_iter())?;
    Ok(check_texture_conflicts(&groups)?)
}

pub(super) fn check_count(limits: &Limits, count: [u32; 3]) -> Result<(), DispatchErrorKind> {
    let limit = limits.max_compute_workgroups_per_dimension;
    if count.iter().any(|side| *side > limit) {
        return Err(DispatchErrorKind::TooManyWorkgroups { count, limit });
    }
    Ok(())
}

fn check_indirect(buffer: &Buffer, offset: u64) -> Result<(), DispatchErrorKind> {
    buffer.require(BufferUsages::INDIRECT)?;
    if !offset.is_multiple_of(4) {
        return Err(DispatchErrorKind::IndirectOffset(offset));
    }
    buffer.range(offset, 12)?;
    Ok(())
}
