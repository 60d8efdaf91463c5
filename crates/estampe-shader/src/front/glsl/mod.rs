//! GLSL as people write it, brought to the GLSL of Vulkan that naga reads.
//!
//! ```text
//! text ─► tokens ─► preprocess ─► declare ─► link ──────┬─► write ─► naga ─► validation
//!                                 (Unit)     resources ─┘   body
//! ```
//!
//! | module | does |
//! |---|---|
//! | `token`, `number` | tokens with their places, comments, joined lines; numbers |
//! | `preprocess` | `#define`, `#if` and the other directives |
//! | `nesting` | brackets, and a limit on how deeply the text nests |
//! | `declare`, `items`, `qualify`, `unit`, `types` | the declarations at file scope |
//! | `link` | locations of inputs and outputs, by name between two stages |
//! | `resources`, `opaque` | groups and bindings; combined textures and samplers |
//! | `host` | types that buffers hold otherwise: `bool`, `mat2`, small structures |
//! | `write`, `uniforms`, `output` | the rewritten text, and the author's places in it |
//! | `flow` | control flow that naga reads otherwise |
//! | `body`, `order`, `indices`, `builtins` | functions and initial values, token by token |
//! | `prelude` | functions that naga does not have, in GLSL |
//! | `choice` | samplers at computed indices |
//! | `gather`, `atomics` | functions that naga has in WGSL alone |
//! | `mend` | what naga's modules of GLSL lack |
//! | `errors`, `functions`, `fault` | naga's errors in the words of GLSL |
//!
//! What differs from OpenGL: `gl_FragCoord.y` counts from the top, as in WebGPU; `gl_InstanceID`
//! counts from the first instance of the draw; samplers in arrays that are handed to functions need
//! a constant index; `double` and subroutines are not there.

mod atomics;
mod body;
mod builtins;
mod choice;
mod declare;
mod errors;
mod fault;
mod flow;
mod functions;
mod gather;
mod host;
mod indices;
mod items;
mod link;
mod mend;
mod nesting;
mod number;
mod opaque;
mod order;
mod output;
mod prelude;
mod preprocess;
mod qualify;
mod resources;
mod token;
mod types;
mod uniforms;
mod unit;
mod write;

use estampe_ir::interface::Stage;

use super::lines::Lines;
use super::module::naga_stage;
use super::reflect::{CombinedSampler, Names};
use super::source::{ClipSpace, Dialect};
use super::validate::{self, Words};
use super::{Module, Options, ShaderErrors, guard};
use errors::Origin;
use fault::Fault;
use link::Locations;
use output::Output;
use resources::Resources;
use unit::Unit;

/// The most errors that are told of one shader.
const MOST_ERRORS: usize = 20;

/// Loads a shader of one stage.
pub(super) fn load(text: &str, stage: Stage, options: &Options) -> Result<Module, ShaderErrors> {
    let in_text = |fault: Fault| ShaderErrors::from(fault.in_text(&Lines::new(text)));
    let units = [read(text, stage, options).map_err(in_text)?];
    let resources =
        resources::number(&units, options.group).map_err(|(_, fault)| in_text(fault))?;
    let locations = link::locations(&units[0], None).map_err(in_text)?;
    finish(text, &units, 0, &resources, &locations, options)
}

/// Loads a vertex and a fragment shader, linked by name.
pub(super) fn load_pair(
    vertex: (&str, &Options),
    fragment: (&str, &Options),
) -> Result<(Module, Module), ShaderErrors> {
    let sources = [vertex, fragment];
    let error = |index: usize, fault: Fault| {
        let (text, options) = sources[index];
        let errors = ShaderErrors::from(fault.in_text(&Lines::new(text)));
        errors.in_file(options.file.as_deref())
    };
    guard::run(|| {
        let units = [
            read(vertex.0, Stage::Vertex, vertex.1).map_err(|fault| error(0, fault))?,
            read(fragment.0, Stage::Fragment, fragment.1).map_err(|fault| error(1, fault))?,
        ];
        let resources = resources::number(&units, vertex.1.group)
            .map_err(|(index, fault)| error(index, fault))?;
        let of_vertex = link::locations(&units[0], None).map_err(|fault| error(0, fault))?;
        let outputs = link::outputs(&units[0], &of_vertex);
        let of_fragment =
            link::locations(&units[1], Some(&outputs)).map_err(|fault| error(1, fault))?;
        let finish = |index: usize, locations: &Locations| {
            let (text, options) = sources[index];
            finish(text, &units, index, &resources, locations, options)
                .map_err(|errors| errors.in_file(options.file.as_deref()))
        };
        Ok((finish(0, &of_vertex)?, finish(1, &of_fragment)?))
    })
}

/// Reads the declarations of a text.
fn read(text: &str, stage: Stage, options: &Options) -> Result<Unit, Fault> {
    let raw = token::tokens(text)?;
    let dialect = options.dialect.unwrap_or_else(|| dialect(&raw));
    let is_vulkan = dialect == Dialect::Vulkan;
    let source = preprocess::preprocess(text, raw, &options.defines, is_vulkan, options.limits)?;
    nesting::check(&source.tokens, options.limits)?;
    declare::unit(source, stage, is_vulkan)
}

/// The dialect of a text: see [`Options::dialect`].
fn dialect(tokens: &[token::Token]) -> Dialect {
    let is_vulkan = tokens.iter().enumerate().any(|(at, token)| {
        let next = |ahead: usize| tokens.get(at + ahead);
        match &*token.text {
            "push_constant" | "constant_id" | "gl_VertexIndex" | "gl_InstanceIndex" => true,
            "set" => {
                next(1).is_some_and(|next| next.is("=")) && at > 0 && {
                    let before = &tokens[at - 1];
                    before.is("(") || before.is(",")
                }
            }
            "uniform" => next(1).is_some_and(|ty| {
                types::is_separate(&ty.text) && next(2).is_some_and(token::Token::is_word)
            }),
            _ => false,
        }
    });
    if is_vulkan {
        Dialect::Vulkan
    } else {
        Dialect::OpenGl
    }
}

/// Writes a shader for naga, parses and checks it.
fn finish(
    text: &str,
    units: &[Unit],
    index: usize,
    resources: &Resources,
    locations: &Locations,
    options: &Options,
) -> Result<Module, ShaderErrors> {
    let unit = &units[index];
    let lines = Lines::new(text);
    let clip_space = options.clip_space.unwrap_or(match unit.is_vulkan {
        true => ClipSpace::Webgpu,
        false => ClipSpace::OpenGl,
    });
    let writer = write::Writer::new(units, index, resources, locations, clip_space);
    let (output, names) = writer.write().map_err(|fault| fault.in_text(&lines))?;
    let mut module = parse(text, unit, &output, &names)?;
    let mended = mend::mend(&mut module, unit);
    let origin = Origin {
        text,
        unit,
        output: &output,
        names: &names,
    };
    let info = mended
        .and_then(|()| validate::check(&module, Words::Glsl))
        .map_err(|fault| errors::validation_fault(&origin, fault).in_text(&lines))?;
    let mut module = Module::new(module, info, names, Words::Glsl)?;
    module.reflection.combined_samplers = combined(&module, resources);
    Ok(module)
}

fn parse(
    text: &str,
    unit: &Unit,
    output: &Output,
    names: &Names,
) -> Result<naga::Module, ShaderErrors> {
    let options = naga::front::glsl::Options::from(naga_stage(unit.stage));
    let parsed = naga::front::glsl::Frontend::default().parse(&options, &output.text);
    parsed.map_err(|errors| {
        let origin = Origin {
            text,
            unit,
            output,
            names,
        };
        let lines = Lines::new(text);
        let mut found: Vec<_> = Vec::new();
        for error in errors.errors.iter().take(MOST_ERRORS) {
            let error = errors::parse_fault(&origin, error).in_text(&lines);
            if !found.contains(&error) {
                found.push(error);
            }
        }
        ShaderErrors { errors: found }
    })
}

/// The combined textures and samplers that a module has.
fn combined(module: &Module, resources: &Resources) -> Vec<CombinedSampler> {
    let bindings = &module.reflection.bindings;
    let is_there = |slot: (u32, u32)| {
        bindings
            .iter()
            .any(|binding| (binding.group, binding.binding) == slot)
    };
    let all = resources
        .combined
        .iter()
        .filter(|(_, pair)| is_there(pair.texture));
    let mut found: Vec<_> = all
        .map(|(name, pair)| CombinedSampler {
            name: name.clone(),
            texture: pair.texture,
            sampler: pair.sampler,
            unit: pair.unit,
        })
        .collect();
    found.sort_by_key(|pair| pair.texture);
    found
}
