//! What is valid and cannot be lowered, refused where the text still has its places.

use super::{Fault, Words};
use naga::valid::{FunctionInfo, GlobalUse, ModuleInfo};
use naga::{
    AddressSpace, Binding, Block, EntryPoint, Handle, Module, ShaderStage, Span, Statement, Type,
    TypeInner,
};

/// Checks a valid module.
pub(super) fn check(module: &Module, info: &ModuleInfo, words: Words) -> Result<(), Fault> {
    for (handle, function) in module.functions.iter() {
        check_sums(module, &function.body, &info[handle])?;
    }
    for (index, entry) in module.entry_points.iter().enumerate() {
        let info = info.get_entry_point(index);
        check_sums(module, &entry.function.body, info)?;
        check_interface(module, entry, words)?;
        check_memory(module, entry, info)?;
    }
    Ok(())
}

fn fault(message: String, span: Span) -> Fault {
    Fault {
        message,
        help: None,
        spans: vec![span],
        entry_point: None,
    }
}

/// Refuses sums and the like of 64-bit integers over a subgroup.
fn check_sums(module: &Module, block: &Block, info: &FunctionInfo) -> Result<(), Fault> {
    for (statement, span) in block.span_iter() {
        match statement {
            Statement::SubgroupCollectiveOperation { argument, .. } => {
                let inner = info[*argument].ty.inner_with(&module.types);
                if inner.scalar().is_some_and(|scalar| scalar.width == 8) {
                    let message = "sums of 64-bit integers in subgroups are not supported";
                    return Err(fault(message.to_owned(), *span));
                }
            }
            Statement::Block(block) => check_sums(module, block, info)?,
            Statement::If { accept, reject, .. } => {
                check_sums(module, accept, info)?;
                check_sums(module, reject, info)?;
            }
            Statement::Switch { cases, .. } => {
                for case in cases {
                    check_sums(module, &case.body, info)?;
                }
            }
            Statement::Loop {
                body, continuing, ..
            } => {
                check_sums(module, body, info)?;
                check_sums(module, continuing, info)?;
            }
            _ => {}
        }
    }
    Ok(())
}

/// Refuses inputs and outputs of 64-bit numbers: attributes, varyings and targets have none.
fn check_interface(module: &Module, entry: &EntryPoint, words: Words) -> Result<(), Fault> {
    let arguments = entry.function.arguments.iter();
    let inputs = arguments.map(|argument| (argument.ty, argument.binding.as_ref()));
    let result = entry.function.result.iter();
    let outputs = result.map(|result| (result.ty, result.binding.as_ref()));
    let wide = inputs
        .chain(outputs)
        .find_map(|(ty, binding)| wide_location(module, ty, binding));
    let Some((location, ty)) = wide else {
        return Ok(());
    };
    Err(Fault {
        message: format!(
            "{} of `{}` is {}, but numbers of 64 bits are neither inputs nor outputs",
            words.location(location),
            entry.name,
            words.type_name(module, ty)
        ),
        help: Some("pass the low and the high 32 bits apart".to_owned()),
        spans: Vec::new(),
        entry_point: Some(entry.name.clone()),
    })
}

fn wide_location(
    module: &Module,
    ty: Handle<Type>,
    binding: Option<&Binding>,
) -> Option<(u32, Handle<Type>)> {
    match (binding, &module.types[ty].inner) {
        (Some(Binding::Location { location, .. }), inner) => {
            let is_wide = inner.scalar().is_some_and(|scalar| scalar.width == 8);
            is_wide.then_some((*location, ty))
        }
        (None, TypeInner::Struct { members, .. }) => members
            .iter()
            .filter(|member| member.binding.is_some())
            .find_map(|member| wide_location(module, member.ty, member.binding.as_ref())),
        _ => None,
    }
}

/// Refuses a work-group's memory outside of compute shaders.
fn check_memory(module: &Module, entry: &EntryPoint, info: &FunctionInfo) -> Result<(), Fault> {
    if entry.stage == ShaderStage::Compute {
        return Ok(());
    }
    for (handle, variable) in module.global_variables.iter() {
        if variable.space == AddressSpace::WorkGroup && info[handle] != GlobalUse::empty() {
            let name = variable.name.as_deref().unwrap_or_default();
            let message = format!(
                "`{name}` is memory of a work-group, and `{}` has none",
                entry.name
            );
            let span = module.global_variables.get_span(handle);
            return Err(Fault {
                help: Some("only compute shaders have work-groups".to_owned()),
                ..fault(message, span)
            });
        }
    }
    Ok(())
}
