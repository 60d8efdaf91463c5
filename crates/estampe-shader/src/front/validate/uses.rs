//! Places of types: naga's errors in types have none where the type is one of the language.

use naga::{Function, Handle, Module, Span, Type, TypeInner};

/// The place of a type, else that of the first declaration with it.
pub(super) fn place(module: &Module, ty: Handle<Type>) -> Option<Span> {
    let own = module.types.get_span(ty);
    if own.is_defined() {
        return Some(own);
    }
    declaration(module, ty).or_else(|| {
        // Types come after those that they hold.
        let mut holders = module.types.iter().filter(|(_, one)| holds(&one.inner, ty));
        holders.find_map(|(holder, _)| place(module, holder))
    })
}

/// The first declaration with a type, which has a place.
fn declaration(module: &Module, ty: Handle<Type>) -> Option<Span> {
    let globals = module.global_variables.iter();
    let globals = globals
        .filter(|(_, variable)| variable.ty == ty)
        .map(|(handle, _)| module.global_variables.get_span(handle));
    let constants = module.constants.iter();
    let constants = constants
        .filter(|(_, constant)| constant.ty == ty)
        .map(|(handle, _)| module.constants.get_span(handle));
    let overrides = module.overrides.iter();
    let overrides = overrides
        .filter(|(_, one)| one.ty == ty)
        .map(|(handle, _)| module.overrides.get_span(handle));
    let functions = module.functions.iter().flat_map(|(handle, function)| {
        let whole = takes_or_returns(function, ty).then(|| module.functions.get_span(handle));
        locals(function, ty).chain(whole)
    });
    let entries = module.entry_points.iter();
    let entries = entries.flat_map(|entry| locals(&entry.function, ty));
    let mut all = globals
        .chain(constants)
        .chain(overrides)
        .chain(functions)
        .chain(entries);
    all.find(Span::is_defined)
}

fn locals(function: &Function, ty: Handle<Type>) -> impl Iterator<Item = Span> {
    let variables = function.local_variables.iter();
    variables
        .filter(move |(_, variable)| variable.ty == ty)
        .map(|(handle, _)| function.local_variables.get_span(handle))
}

fn takes_or_returns(function: &Function, ty: Handle<Type>) -> bool {
    let result = function.result.as_ref();
    function.arguments.iter().any(|argument| argument.ty == ty)
        || result.is_some_and(|result| result.ty == ty)
}

/// True if a type holds another directly.
fn holds(inner: &TypeInner, ty: Handle<Type>) -> bool {
    match inner {
        TypeInner::Array { base, .. }
        | TypeInner::BindingArray { base, .. }
        | TypeInner::Pointer { base, .. } => *base == ty,
        TypeInner::Struct { members, .. } => members.iter().any(|member| member.ty == ty),
        _ => false,
    }
}
