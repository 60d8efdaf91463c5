//! Loading: from a source to a checked module.

use estampe_ir::interface::Stage;

use super::lines::Lines;
use super::reflect::Names;
use super::validate::{self, Fault, Words};
use super::{Module, Options, ShaderError, ShaderErrors, Source, chains, glsl, guard, spirv, wgsl};

/// Loads a shader: parses and checks it, and finds what it exchanges with the program.
///
/// # Errors
///
/// If the source is not valid, uses what estampe does not have (see [`ShaderError`] for what is
/// told), or exceeds the options' limits.
pub fn load(source: Source<'_>, options: &Options) -> Result<Module, ShaderErrors> {
    let loaded = check_size(source, options).and_then(|()| match source {
        Source::Wgsl(text) => guard::run(|| load_wgsl(text, options)),
        Source::Glsl { text, stage } => guard::run(|| glsl::load(text, stage, options)),
        Source::SpirV(words) => guard::run(|| load_spirv(words)),
        Source::SpirVBytes(bytes) => {
            spirv::words(bytes).and_then(|words| guard::run(|| load_spirv(&words)))
        }
    });
    let loaded = loaded.and_then(|module| match &options.constants {
        Some(constants) => module.specialize(None, constants),
        None => Ok(module),
    });
    loaded.map_err(|errors| errors.in_file(options.file.as_deref()))
}

/// Loads a vertex and a fragment shader of one pipeline. In GLSL, the outputs of the one and the
/// inputs of the other are linked by name, and the loose uniforms of both share one block, so that
/// a uniform that both declare is one. Sources of other languages are loaded one by one.
///
/// # Errors
///
/// As for [`load`], and if the fragment shader has an input that the vertex shader does not write,
/// or writes with another type.
pub fn load_pair(
    vertex: (Source<'_>, &Options),
    fragment: (Source<'_>, &Options),
) -> Result<(Module, Module), ShaderErrors> {
    let (
        Source::Glsl {
            text: vertex_text,
            stage: Stage::Vertex,
        },
        Source::Glsl {
            text: fragment_text,
            stage: Stage::Fragment,
        },
    ) = (vertex.0, fragment.0)
    else {
        return Ok((load(vertex.0, vertex.1)?, load(fragment.0, fragment.1)?));
    };
    let in_file = |options: &Options, errors: ShaderErrors| errors.in_file(options.file.as_deref());
    check_size(vertex.0, vertex.1).map_err(|errors| in_file(vertex.1, errors))?;
    check_size(fragment.0, fragment.1).map_err(|errors| in_file(fragment.1, errors))?;
    let pair = glsl::load_pair((vertex_text, vertex.1), (fragment_text, fragment.1))?;
    let specialize = |module: Module, options: &Options| match &options.constants {
        Some(constants) => module.specialize(None, constants),
        None => Ok(module),
    };
    let first = specialize(pair.0, vertex.1).map_err(|errors| in_file(vertex.1, errors))?;
    let second = specialize(pair.1, fragment.1).map_err(|errors| in_file(fragment.1, errors))?;
    Ok((first, second))
}

fn check_size(source: Source<'_>, options: &Options) -> Result<(), ShaderErrors> {
    let bytes = match source {
        Source::Wgsl(text) | Source::Glsl { text, .. } => text.len(),
        Source::SpirV(words) => words.len().saturating_mul(4),
        Source::SpirVBytes(bytes) => bytes.len(),
    };
    let most = options.limits.source_bytes;
    if bytes > most {
        return Err(ShaderError::new(format!(
            "the shader has {bytes} bytes, more than the limit of {most}"
        ))
        .into());
    }
    Ok(())
}

fn load_wgsl(text: &str, options: &Options) -> Result<Module, ShaderErrors> {
    chains::check(text, options.limits)?;
    let module = wgsl::parse(text)?;
    let info = validate::check(&module, Words::Wgsl).map_err(|fault| placed(text, fault))?;
    Module::new(module, info, Names::default(), Words::Wgsl)
}

/// The fault at its place in the text.
fn placed(text: &str, fault: Fault) -> ShaderError {
    let error = ShaderError {
        help: fault.help,
        ..ShaderError::new(fault.message)
    };
    let of_entry = || {
        let name = fault.entry_point.as_deref()?;
        wgsl::declaration(text, name)
    };
    match fault
        .spans
        .first()
        .and_then(|span| span.to_range())
        .or_else(of_entry)
    {
        Some(range) => error.at(&Lines::new(text), range.start, range.end),
        None => error,
    }
}

fn load_spirv(words: &[u32]) -> Result<Module, ShaderErrors> {
    let module = spirv::parse(words)?;
    let info = validate::check(&module, Words::Wgsl).map_err(|fault| ShaderError {
        help: fault.help,
        ..ShaderError::new(fault.message)
    })?;
    Module::new(module, info, Names::default(), Words::Wgsl)
}
