//! The bind group layouts of a pipeline against those that its shader declares.

use super::PipelineError;
use estampe_types::{BindGroupLayout, BindingType};

/// Checks that the layouts of a pipeline have every binding that a shader declares, of the same
/// kind. They may have more, dynamic offsets, and another least size of a buffer.
///
/// # Errors
/// [`PipelineError::Binding`].
pub fn check_declared(
    declared: &[BindGroupLayout],
    layouts: &[BindGroupLayout],
) -> Result<(), PipelineError> {
    for (group, layout) in declared.iter().enumerate() {
        for entry in layout.entries() {
            let given = layouts
                .get(group)
                .and_then(|layout| layout.entry(entry.binding));
            let given = given.map(|given| given.ty);
            if !given.is_some_and(|given| is_same_kind(given, entry.ty)) {
                return Err(PipelineError::Binding {
                    group,
                    binding: entry.binding,
                    shader: entry.ty,
                    layout: given,
                });
            }
        }
    }
    Ok(())
}

fn is_same_kind(a: BindingType, b: BindingType) -> bool {
    match (a, b) {
        (BindingType::Buffer { ty: a, .. }, BindingType::Buffer { ty: b, .. }) => a == b,
        _ => a == b,
    }
}
