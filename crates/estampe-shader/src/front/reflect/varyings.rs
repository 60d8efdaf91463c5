//! Inputs and outputs of entry points.

use naga::{Handle, Type, TypeInner};

use super::{Names, ValueType};

/// A value that an entry point takes or gives at a location.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Varying {
    /// The name: of the argument, member or variable. Empty if the source has none.
    pub name: String,
    /// The location; for outputs of fragment shaders, the index of the target.
    pub location: u32,
    /// The type.
    pub kind: ValueType,
    /// True for the second colour of dual-source blending.
    pub is_second_source: bool,
    /// True if the value is that of one vertex, and not interpolated.
    pub is_flat: bool,
}

/// The inputs and outputs of all entry points, by location.
pub(super) fn find(module: &naga::Module, names: &Names) -> (Vec<Vec<Varying>>, Vec<Vec<Varying>>) {
    let entries = module.entry_points.iter();
    entries
        .map(|entry| {
            let mut inputs = Vec::new();
            for argument in &entry.function.arguments {
                let name = argument.name.as_deref();
                push(
                    &mut inputs,
                    module,
                    names,
                    name,
                    argument.ty,
                    &argument.binding,
                );
            }
            let mut outputs = Vec::new();
            if let Some(result) = &entry.function.result {
                push(
                    &mut outputs,
                    module,
                    names,
                    None,
                    result.ty,
                    &result.binding,
                );
            }
            inputs.sort_by_key(|varying: &Varying| (varying.location, varying.is_second_source));
            outputs.sort_by_key(|varying: &Varying| (varying.location, varying.is_second_source));
            (inputs, outputs)
        })
        .unzip()
}

fn push(
    list: &mut Vec<Varying>,
    module: &naga::Module,
    names: &Names,
    name: Option<&str>,
    ty: Handle<Type>,
    binding: &Option<naga::Binding>,
) {
    match (binding, &module.types[ty].inner) {
        (None, TypeInner::Struct { members, .. }) => {
            for member in members {
                let name = member.name.as_deref();
                // Members of interface structures are no structures: this does not recurse again.
                if member.binding.is_some() {
                    push(list, module, names, name, member.ty, &member.binding);
                }
            }
        }
        (
            &Some(naga::Binding::Location {
                location,
                interpolation,
                blend_src,
                ..
            }),
            inner,
        ) => {
            if let Some(kind) = ValueType::of(inner) {
                list.push(Varying {
                    name: names.name(name),
                    location,
                    kind,
                    is_second_source: blend_src == Some(1),
                    is_flat: interpolation == Some(naga::Interpolation::Flat),
                });
            }
        }
        _ => {}
    }
}
