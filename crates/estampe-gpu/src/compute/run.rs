//! Running a dispatch.

use super::check::{check_count, check_kind, of_dispatch};
use super::{Dispatch, DispatchError, DispatchErrorKind, DispatchSize};
use crate::bind_group::bound;
use crate::buffer::StoredBuffers;
use crate::immediates::immediate_words;
use crate::texture::{Reservations, StoredTextures};
use crate::{BindGroup, Device};
use estampe_types::Bindings;
use estampe_types::bindings::BoundResources;
use estampe_types::shader::{
    ComputeProgram, ComputeStopped, TextureReads, WorkgroupOrder, Workgroups,
};
use std::ops::Range;
use std::sync::Arc;

/// The parts into which a dispatch is divided for each thread, so that all end together.
const PARTS_PER_THREAD: u64 = 8;

/// Runs a dispatch.
pub(crate) fn dispatch(device: &Device, dispatch: &Dispatch<'_>) -> Result<(), DispatchError> {
    run(device, dispatch).map_err(|kind| of_dispatch(dispatch, kind))
}

fn run(device: &Device, dispatch: &Dispatch<'_>) -> Result<(), DispatchErrorKind> {
    check_kind(device.limits(), dispatch)?;
    let count = match dispatch.size {
        DispatchSize::Workgroups(count) => count,
        DispatchSize::Indirect(buffer, offset) => {
            let first = usize::try_from(offset).unwrap_or(usize::MAX);
            let data = buffer.data();
            let count = [0, 4, 8].map(|at| data.word_at(first.saturating_add(at)));
            check_count(device.limits(), count)?;
            count
        }
    };
    let _awake = (count != [1; 3]).then(|| device.context().awake());
    let groups = distinct(dispatch.bind_groups);
    let reserved = Reservations::new(groups.iter().flat_map(|group| group.texture_uses()));
    let mut textures = StoredTextures::in_place();
    let buffers = StoredBuffers::in_place(&groups)?;
    let mut resources: Vec<(usize, Arc<BoundResources>)> = Vec::new();
    for group in &groups {
        let bound = group.resources(device.context(), (&mut textures, &buffers), |_| {
            TextureReads::ALL
        });
        let bound = bound.map_err(|error| DispatchErrorKind::Texture {
            group: group.name(),
            error,
        })?;
        resources.push((group.id(), bound));
    }
    let groups = bound(dispatch.bind_groups, dispatch.dynamic_offsets, |group| {
        let found = resources.iter().find(|(id, _)| *id == group.id());
        found.map_or_else(Arc::default, |(_, bound)| Arc::clone(bound))
    });
    let bindings = Bindings {
        groups: groups.collect(),
        immediates: immediate_words(dispatch.immediates).collect(),
        ..Bindings::default()
    };
    let program = &**dispatch.pipeline.program();
    let stopped = run_workgroups(device, program, &bindings, count);
    // Nobody else holds the words that were stored to from now on.
    drop(bindings);
    drop(resources);
    textures.finish();
    drop(buffers);
    drop(reserved);
    Ok(stopped?)
}

/// Runs all work-groups: in order, or on all threads if their order cannot be seen.
fn run_workgroups(
    device: &Device,
    program: &dyn ComputeProgram,
    bindings: &Bindings,
    count: [u32; 3],
) -> Result<(), ComputeStopped> {
    let total = count.iter().map(|side| u64::from(*side)).product::<u64>();
    let run = |range: Range<u64>| {
        let work = Workgroups { count, range };
        program.run_workgroups(device.level(), bindings, &work)
    };
    let threads = device.threads() as u64;
    if threads == 1 || program.order(bindings, count) == WorkgroupOrder::InOrder {
        return run(0..total);
    }
    let parts = total.min(threads * PARTS_PER_THREAD);
    // No overflow: a dispatch has less than 2⁴⁸ work-groups, and there are few parts.
    let part = |number: u64| total * number / parts;
    let mut parts: Vec<_> = (0..parts)
        .map(|number| (part(number)..part(number + 1), Ok(())))
        .collect();
    device.context().for_each(&mut parts, |(range, stopped)| {
        *stopped = run(range.clone());
    });
    parts.into_iter().try_for_each(|(_, stopped)| stopped)
}

/// Each group once.
fn distinct(groups: &[BindGroup]) -> Vec<&BindGroup> {
    let mut groups: Vec<&BindGroup> = groups.iter().collect();
    groups.sort_by_key(|group| group.id());
    groups.dedup_by_key(|group| group.id());
    groups
}
