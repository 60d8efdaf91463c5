//! Validation: naga's, with all its checks and the capabilities that estampe has.
//!
//! | capability | why |
//! |---|---|
//! | immediates | push constants of WebGPU and Vulkan |
//! | clip and cull distances | user clip planes; GLSL's `gl_ClipDistance` |
//! | sample-rate shading | `sample_index`, `sample` interpolation |
//! | dual-source blending | a second colour of the fragment shader |
//! | early depth test | GLSL's `early_fragment_tests`, WGSL's `early_depth_test` |
//! | cube arrays, 16-bit normalized storage | formats and views that textures have |
//! | f16, f16 packed in f32, 64-bit integers | exact in software on every machine |
//! | subgroups | quads on every machine, whatever its registers hold |
//!
//! Refused: 64-bit floats and atomics, 16-bit integers, ray queries and pipelines, mesh and task
//! shaders, multiview, barycentrics, binding arrays, atomics on textures and on floats, external
//! textures, cooperative matrices, `primitive_index` and `draw_index`: nothing below executes them.

mod entry;
mod function;
mod support;
mod uses;
mod words;

pub(super) use words::{Words, plain};

use naga::valid::{
    Capabilities, ModuleInfo, TypeError, ValidationError, ValidationFlags, Validator,
};
use naga::{Span, WithSpan};

/// What shaders may use.
pub(super) const CAPABILITIES: Capabilities = Capabilities::IMMEDIATES
    .union(Capabilities::CLIP_DISTANCES)
    .union(Capabilities::CULL_DISTANCE)
    .union(Capabilities::MULTISAMPLED_SHADING)
    .union(Capabilities::DUAL_SOURCE_BLENDING)
    .union(Capabilities::EARLY_DEPTH_TEST)
    .union(Capabilities::CUBE_ARRAY_TEXTURES)
    .union(Capabilities::STORAGE_TEXTURE_16BIT_NORM_FORMATS)
    .union(Capabilities::SUBGROUP)
    .union(Capabilities::SUBGROUP_BARRIER)
    .union(Capabilities::SHADER_FLOAT16)
    .union(Capabilities::SHADER_FLOAT16_IN_FLOAT32)
    .union(Capabilities::SHADER_INT64);

/// What is wrong with a module, and where in the text that naga read.
#[derive(Debug)]
pub(super) struct Fault {
    /// What is wrong, in the words of the source language.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// The places that naga knows, innermost first.
    pub spans: Vec<Span>,
    /// The entry point that it is in, if it is in one.
    pub entry_point: Option<String>,
}

/// Checks a module.
pub(super) fn check(module: &naga::Module, words: Words) -> Result<ModuleInfo, Fault> {
    let info = Validator::new(ValidationFlags::all(), CAPABILITIES)
        .validate(module)
        .map_err(|error| describe(module, &error, words))?;
    support::check(module, &info, words)?;
    Ok(info)
}

/// Checks a module all of whose overrides have values.
pub(super) fn check_resolved(module: &naga::Module, words: Words) -> Result<ModuleInfo, Fault> {
    Validator::new(ValidationFlags::all(), CAPABILITIES)
        .validate_resolved_overrides(module)
        .map_err(|error| describe(module, &error, words))
}

/// An error of naga's validator in the words of the source language.
pub(super) fn describe(
    module: &naga::Module,
    error: &WithSpan<ValidationError>,
    words: Words,
) -> Fault {
    // A place inside a function says more than the function's.
    let known = error.spans().filter(|(span, _)| span.is_defined());
    let (functions, inside): (Vec<_>, Vec<_>) =
        known.partition(|(_, what)| what.starts_with("naga::ir::Function ["));
    let mut spans: Vec<Span> = inside
        .into_iter()
        .chain(functions)
        .map(|(span, _)| *span)
        .collect();
    if spans.is_empty() {
        // Types of the language have no place: what is declared with them has.
        let ty = match error.as_inner() {
            ValidationError::Type { handle, .. } => Some(*handle),
            ValidationError::Layouter(error) => Some(error.ty),
            _ => None,
        };
        spans.extend(ty.and_then(|ty| uses::place(module, ty)));
    }
    let entry_point = match error.as_inner() {
        ValidationError::EntryPoint { name, .. } => Some(name.clone()),
        _ => None,
    };
    let (message, help) = match error.as_inner() {
        ValidationError::Function { handle, source, .. } => {
            function::describe(module, &module.functions[*handle], source, words)
        }
        ValidationError::EntryPoint {
            stage,
            name,
            source,
        } => entry::describe(module, *stage, name, source, words),
        ValidationError::GlobalVariable { name, source, .. } => {
            entry::describe_variable(module, name, source, words)
        }
        ValidationError::Type {
            source: TypeError::MissingCapability(missing),
            ..
        } => (function::not_supported(*missing), None),
        ValidationError::Type {
            source: source @ TypeError::WidthError(_),
            ..
        } => (words.chain(source), None),
        ValidationError::Type {
            name,
            source: TypeError::InvalidDynamicArray(member, _),
            ..
        } => (
            format!(
                "{}: `{member}` has no size and is not the last member",
                words.type_named(name)
            ),
            Some("give it a size, or move it to the end".to_owned()),
        ),
        ValidationError::Layouter(error) => {
            let ty = words.type_name(module, error.ty);
            (format!("{ty} is too large: {}", words.chain(error)), None)
        }
        ValidationError::Type { name, source, .. } => (
            format!("{}: {}", words.type_named(name), words.chain(source)),
            None,
        ),
        ValidationError::Constant { name, source, .. } => {
            (format!("constant `{name}`: {}", words.chain(source)), None)
        }
        ValidationError::Override { name, source, .. } => {
            let message = format!("{} `{name}`: {}", words.overridable(), words.chain(source));
            (message, None)
        }
        ValidationError::ArraySizeError { .. } => {
            ("the size of an array must be at least 1".to_owned(), None)
        }
        other => (words.chain(other), None),
    };
    Fault {
        message,
        help,
        spans,
        entry_point,
    }
}
