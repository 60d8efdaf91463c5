//! The bind groups and dynamic offsets of a draw or dispatch.

use super::check::offset_alignment;
use super::{BindGroup, BindingResource};
use crate::texture::TextureView;
use crate::{BindGroupLayout, BindingType, Buffer, BufferBindingType, Limits};
use estampe_types::bindings::BoundResources;
use estampe_types::{BoundGroup, MAX_DYNAMIC_OFFSETS};
use std::ops::Range;
use std::sync::Arc;

/// A rule that the bind groups of a draw or dispatch break.
#[derive(Debug)]
pub(crate) struct BoundError {
    /// The number of the group.
    pub(crate) group: usize,
    /// The rule.
    pub(crate) rule: String,
}

/// Checks that groups have the layouts of a pipeline.
pub(crate) fn check_layouts(
    layouts: &[BindGroupLayout],
    groups: &[BindGroup],
    limits: &Limits,
) -> Result<(), BoundError> {
    let bad = |group: usize, rule: String| Err(BoundError { group, rule });
    let most = limits.max_bind_groups as usize;
    if groups.len() > most {
        return bad(most, format!("the limit max_bind_groups is {most}"));
    }
    for (index, layout) in layouts.iter().enumerate() {
        let Some(group) = groups.get(index) else {
            let rule = "the pipeline needs it, and none is bound".to_owned();
            return bad(index, rule);
        };
        if group.layout() != layout {
            let rule = format!(
                "{} has the layout {:?}, and the pipeline needs {layout:?}",
                group.name(),
                group.layout()
            );
            return bad(index, rule);
        }
    }
    Ok(())
}

/// Checks that each dynamic binding has an offset in its buffer, and that no two bindings by which
/// shaders write overlap.
pub(crate) fn check_offsets(
    groups: &[BindGroup],
    dynamic_offsets: &[u32],
    limits: &Limits,
) -> Result<(), BoundError> {
    let bad = |group: usize, rule: String| Err(BoundError { group, rule });
    let mut offsets = dynamic_offsets;
    let given = dynamic_offsets.len();
    for (index, group) in groups.iter().enumerate() {
        let count = group.dynamic_offset_count();
        let Some((of_group, others)) = offsets.split_at_checked(count) else {
            let (name, left) = (group.name(), offsets.len());
            let rule = format!(
                "{name} has {count} dynamic offsets, and {left} of the {given} that are given are \
                 left for it"
            );
            return bad(index, rule);
        };
        offsets = others;
        if count > 0
            && let Err(rule) = check_dynamic_offsets(group, of_group, limits)
        {
            return bad(index, rule);
        }
    }
    if !offsets.is_empty() {
        let used = given - offsets.len();
        let rule = format!("{given} dynamic offsets are given, and the bind groups have {used}");
        return bad(groups.len().saturating_sub(1), rule);
    }
    if groups.iter().any(BindGroup::is_written) {
        check_aliases(groups, dynamic_offsets)?;
    }
    Ok(())
}

/// Memory that shaders write.
#[derive(Debug)]
enum Written<'a> {
    Buffer(&'a Buffer, Range<u64>),
    Texture(&'a TextureView),
}

impl Written<'_> {
    fn overlaps(&self, other: &Self) -> bool {
        match (self, other) {
            (Written::Buffer(a, x), Written::Buffer(b, y)) => {
                a.is_same(b) && x.start < y.end && y.start < x.end
            }
            (Written::Texture(a), Written::Texture(b)) => {
                a.texture().is_same(b.texture()) && a.mip_levels()[0] == b.mip_levels()[0]
            }
            _ => false,
        }
    }
}

/// Checks that no two bindings by which shaders write overlap (WebGPU's *writable resource
/// aliasing*).
fn check_aliases(groups: &[BindGroup], dynamic_offsets: &[u32]) -> Result<(), BoundError> {
    let mut written: Vec<(usize, u32, Written<'_>)> = Vec::new();
    let mut offsets = dynamic_offsets;
    for (number, group) in groups.iter().enumerate() {
        let (of_group, others) = offsets.split_at(group.dynamic_offset_count());
        offsets = others;
        for (binding, resource) in group.entries() {
            let ty = group.layout().entry(*binding).map(|entry| entry.ty);
            let memory = match (ty, resource) {
                (
                    Some(BindingType::Buffer {
                        ty: BufferBindingType::Storage { read_only: false },
                        ..
                    }),
                    BindingResource::Buffer(slice),
                ) => {
                    let dynamic = group.layout().dynamic_offset_index(*binding);
                    let dynamic = dynamic.and_then(|at| of_group.get(at)).copied();
                    let start = slice.offset + u64::from(dynamic.unwrap_or(0));
                    Written::Buffer(&slice.buffer, start..start + slice.size)
                }
                (Some(BindingType::StorageTexture { .. }), BindingResource::Texture(view)) => {
                    Written::Texture(view)
                }
                _ => continue,
            };
            let same = written.iter().find(|(.., other)| other.overlaps(&memory));
            if let Some((first, at, _)) = same {
                let rule = format!(
                    "binding {binding} of {} and binding {at} of {} are the same memory, which the \
                     shader may write by both: bind parts that do not overlap",
                    group.name(),
                    groups[*first].name()
                );
                return Err(BoundError {
                    group: number,
                    rule,
                });
            }
            written.push((number, *binding, memory));
        }
    }
    Ok(())
}

fn check_dynamic_offsets(
    group: &BindGroup,
    offsets: &[u32],
    limits: &Limits,
) -> Result<(), String> {
    for (binding, resource) in group.entries() {
        let index = group.layout().dynamic_offset_index(*binding);
        let (Some(index), BindingResource::Buffer(slice)) = (index, resource) else {
            continue;
        };
        let alignment = match group.layout().entry(*binding).map(|entry| entry.ty) {
            Some(BindingType::Buffer { ty, .. }) => offset_alignment(ty, limits),
            _ => 4,
        };
        let offset = offsets.get(index).copied().unwrap_or_default();
        if !offset.is_multiple_of(alignment) {
            return Err(format!(
                "the dynamic offset {offset} of binding {binding} is not a multiple of {alignment}"
            ));
        }
        let end = slice.offset + slice.size + u64::from(offset);
        if end > slice.buffer.size() {
            return Err(format!(
                "binding {binding} with the dynamic offset {offset} ends at byte {end} of {}, which has {}",
                slice.buffer.name(),
                slice.buffer.size()
            ));
        }
    }
    Ok(())
}

/// The groups as programs see them. `resources` gives what a group binds.
pub(crate) fn bound(
    groups: &[BindGroup],
    dynamic_offsets: &[u32],
    resources: impl Fn(&BindGroup) -> Arc<BoundResources>,
) -> impl Iterator<Item = BoundGroup> {
    let mut offsets = dynamic_offsets;
    groups.iter().map(move |group| {
        let count = group.dynamic_offset_count();
        let (of_group, others) = offsets.split_at(count.min(offsets.len()));
        offsets = others;
        let mut dynamic_offsets = [0; MAX_DYNAMIC_OFFSETS];
        for (to, offset) in dynamic_offsets.iter_mut().zip(of_group) {
            *to = *offset;
        }
        BoundGroup {
            group: resources(group),
            dynamic_offsets,
        }
    })
}
