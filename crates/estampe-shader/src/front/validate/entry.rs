//! Errors in entry points and global variables, in the words of the source language.

use naga::valid::{EntryPointError, GlobalUse, GlobalVariableError, VaryingError};
use naga::{AddressSpace, ArraySize, Module, ShaderStage, TypeInner};

use super::function;
use super::words::Words;

type Message = (String, Option<String>);

/// What is wrong with an entry point.
pub(super) fn describe(
    module: &Module,
    stage: ShaderStage,
    name: &str,
    error: &EntryPointError,
    words: Words,
) -> Message {
    let entry = module
        .entry_points
        .iter()
        .find(|entry| entry.name == name && entry.stage == stage);
    let message = match error {
        EntryPointError::Function(error) => {
            if let Some(entry) = entry {
                return function::describe(module, &entry.function, error, words);
            }
            words.chain(error)
        }
        EntryPointError::Argument(index, error) => {
            let arguments = entry.map(|entry| &entry.function.arguments);
            let argument = arguments.and_then(|arguments| arguments.get(*index as usize));
            let input = match argument.and_then(|argument| argument.name.as_deref()) {
                Some(input) => format!("input `{input}` of `{name}`"),
                None => format!("input {} of `{name}`", index + 1),
            };
            return varying(module, &input, error, words);
        }
        EntryPointError::Result(error) => {
            return varying(module, &format!("output of `{name}`"), error, words);
        }
        EntryPointError::Conflict => format!("there are two entry points `{name}` of one stage"),
        EntryPointError::MissingVertexOutputPosition => match words {
            Words::Wgsl => {
                format!("vertex shader `{name}` must return `@builtin(position)`")
            }
            Words::Glsl => "the vertex shader must write `gl_Position`".to_owned(),
        },
        EntryPointError::OutOfRangeWorkgroupSize => {
            "the size of a workgroup is 1 to 16384 invocations in each direction".to_owned()
        }
        EntryPointError::BindingCollision(variable) => {
            let variable = &module.global_variables[*variable];
            let block = module.types[variable.ty].name.as_deref();
            let slot = variable.binding.as_ref();
            format!(
                "`{}` has the group and binding of another variable: {}",
                variable
                    .name
                    .as_deref()
                    .unwrap_or(block.unwrap_or_default()),
                slot.map_or(String::new(), |slot| format!(
                    "group {}, binding {}",
                    slot.group, slot.binding
                ))
            )
        }
        EntryPointError::ForbiddenStageOperations => {
            format!("`{name}` uses what its stage does not have, such as derivatives or barriers")
        }
        EntryPointError::InvalidGlobalUsage(variable, usage) => {
            let variable = &module.global_variables[*variable];
            let usage = match *usage {
                usage if usage.contains(GlobalUse::ATOMIC) => "changed by atomic operations",
                usage if usage.contains(GlobalUse::WRITE) => "written",
                _ => "read",
            };
            format!(
                "`{}` is {usage} in `{name}`, which its declaration does not allow",
                variable.name.as_deref().unwrap_or_default()
            )
        }
        EntryPointError::UnsupportedCapability(missing) => function::not_supported(*missing),
        other => format!("entry point `{name}`: {}", words.chain(other)),
    };
    (message, None)
}

fn varying(module: &Module, what: &str, error: &VaryingError, words: Words) -> Message {
    let mut help = None;
    let message = match error {
        VaryingError::MissingBinding => {
            help = Some("give it `@location(…)` or `@builtin(…)`".to_owned());
            format!("{what} has no location")
        }
        VaryingError::MemberMissingBinding(member) => {
            help = Some("give each member `@location(…)` or `@builtin(…)`".to_owned());
            format!("{what}: member {} has no location", member + 1)
        }
        VaryingError::BindingCollision { location } => {
            format!("{what}: {} is given twice", words.location(*location))
        }
        VaryingError::NotIOShareableType(ty) | VaryingError::InvalidType(ty) => {
            let kind = words.type_name(module, *ty);
            format!("{what} is {kind}, but only numbers and vectors of them pass between stages")
        }
        VaryingError::InvalidBuiltInStage(builtin) => {
            let builtin = builtin_name(&format!("{builtin:?}"));
            format!("{what}: its stage has no built-in `{builtin}` there")
        }
        VaryingError::InvalidBuiltInType(builtin, _) => {
            let builtin = builtin_name(&format!("{builtin:?}"));
            format!("{what}: the built-in `{builtin}` has another type")
        }
        VaryingError::DuplicateBuiltIn(builtin) => {
            let builtin = builtin_name(&format!("{builtin:?}"));
            format!("{what}: the built-in `{builtin}` is given twice")
        }
        VaryingError::InvalidInterpolationForInteger => {
            let advice = match words {
                Words::Wgsl => "add `@interpolate(flat)`",
                Words::Glsl => "add `flat`",
            };
            help = Some(advice.to_owned());
            format!("{what} is an integer, which is not interpolated")
        }
        VaryingError::UnsupportedCapability(missing) => {
            format!("{what}: {}", function::not_supported(*missing))
        }
        other => format!("{what}: {}", words.chain(other)),
    };
    (message, help)
}

/// WGSL's name of a built-in value from naga's: `FragDepth` becomes `frag_depth`.
fn builtin_name(name: &str) -> String {
    let name = name.split([' ', '(', '{']).next().unwrap_or_default();
    let name = name.replace("WorkGroup", "Workgroup");
    let mut spelled = String::new();
    for character in name.chars() {
        if character.is_uppercase() && !spelled.is_empty() {
            spelled.push('_');
        }
        spelled.extend(character.to_lowercase());
    }
    spelled
}

/// What is wrong with a global variable.
pub(super) fn describe_variable(
    module: &Module,
    name: &str,
    error: &GlobalVariableError,
    words: Words,
) -> Message {
    let variables = module.global_variables.iter();
    let ty = variables
        .filter(|(_, variable)| variable.name.as_deref().unwrap_or_default() == name)
        .map(|(_, variable)| variable.ty)
        .next();
    let is_unsized = ty.is_some_and(|ty| match &module.types[ty].inner {
        TypeInner::Array { size, .. } => *size == ArraySize::Dynamic,
        _ => false,
    });
    let name = match (name, ty.and_then(|ty| module.types[ty].name.as_deref())) {
        ("", Some(block)) => block,
        _ => name,
    };
    let mut help = None;
    let message = match error {
        GlobalVariableError::MissingTypeFlags { .. } if is_unsized => {
            help = Some("only a storage buffer may end with an array without a size".to_owned());
            format!("`{name}` has a type that a buffer or variable of its kind cannot hold")
        }
        GlobalVariableError::MissingTypeFlags { .. } | GlobalVariableError::InvalidType(_) => {
            help = Some(
                "buffers hold numbers, vectors, matrices, and arrays and structures of them; \
                 use an unsigned integer in the place of a `bool`"
                    .to_owned(),
            );
            format!("`{name}` has a type that a buffer or variable of its kind cannot hold")
        }
        GlobalVariableError::UnsupportedCapability(missing) => {
            format!("`{name}`: {}", function::not_supported(*missing))
        }
        GlobalVariableError::InvalidBinding => match words {
            Words::Wgsl => {
                help =
                    Some("buffers, textures and samplers have `@group(…) @binding(…)`".to_owned());
                format!(
                    "`{name}` must have a group and a binding if it is a resource, and none if not"
                )
            }
            Words::Glsl => format!("`{name}` has no set and binding"),
        },
        GlobalVariableError::Alignment(space, ty, disalignment) => {
            let buffer = match space {
                AddressSpace::Uniform => "a uniform buffer",
                _ => "a buffer",
            };
            let ty = words.type_name(module, *ty);
            let why = words.chain(disalignment);
            format!("`{name}`: the layout of {ty} does not fit {buffer}: {why}")
        }
        GlobalVariableError::InvalidImmediateType(_) => {
            help = Some("immediates hold 32-bit and 64-bit numbers".to_owned());
            format!("`{name}` has a type that immediates cannot hold")
        }
        GlobalVariableError::InitializerType => {
            format!("the value given to `{name}` has another type than the variable")
        }
        other => format!("variable `{name}`: {}", words.chain(other)),
    };
    (message, help)
}
