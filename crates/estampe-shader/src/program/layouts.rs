//! Bind group layouts of what the stages of a program use.

use super::{LinkError, StageSource};
use estampe_types::{BindGroupLayout, BindGroupLayoutEntry, BindingType, Limits};

/// The layouts of the groups up to the last one that a stage uses. A resource that several stages
/// use is there once; a buffer is as large as the stage that needs more of it says.
pub(super) fn of_stages<'a>(
    stages: impl Iterator<Item = &'a StageSource>,
) -> Result<Vec<BindGroupLayout>, LinkError> {
    // Groups beyond this are refused when a pipeline is created; here they must not take memory.
    let most = Limits::default().max_bind_groups as usize + 1;
    let mut groups: Vec<Vec<BindGroupLayoutEntry>> = Vec::new();
    for (group, entry) in stages.flat_map(|stage| &stage.bindings) {
        let group_at = (*group as usize).min(most - 1);
        if groups.len() <= group_at {
            groups.resize_with(group_at + 1, Vec::new);
        }
        let entries = &mut groups[group_at];
        match entries.iter_mut().find(|one| one.binding == entry.binding) {
            None => entries.push(*entry),
            Some(before) => {
                before.ty = both(before.ty, entry.ty).ok_or(LinkError::Binding {
                    group: *group,
                    binding: entry.binding,
                    vertex: before.ty,
                    fragment: entry.ty,
                })?;
            }
        }
    }
    let layouts = groups.iter().map(|entries| BindGroupLayout::new(entries));
    Ok(layouts
        .map(|layout| layout.expect("each binding is there once"))
        .collect())
}

/// The resource that serves both.
fn both(a: BindingType, b: BindingType) -> Option<BindingType> {
    let (
        BindingType::Buffer {
            ty,
            has_dynamic_offset,
            min_binding_size: of_a,
        },
        BindingType::Buffer {
            ty: type_of_b,
            min_binding_size: of_b,
            ..
        },
    ) = (a, b)
    else {
        return (a == b).then_some(a);
    };
    (ty == type_of_b).then_some(BindingType::Buffer {
        ty,
        has_dynamic_offset,
        min_binding_size: of_a.max(of_b),
    })
}
