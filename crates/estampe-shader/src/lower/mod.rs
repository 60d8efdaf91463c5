//! An entry point of a module to a tree.
//!
//! In · Out: a checked naga module · a [`Tree`](estampe_ir::tree::Tree), one invocation's view.
//! Calls are inlined, vectors, matrices, arrays, structs and 64-bit integers are taken apart into
//! 32-bit words, and variables become values: each scalar of a variable that is never indexed by a
//! number that the shader computes is a *slot*, which has a value at each place. Constructs hand
//! over the slots that they may change. Variables that are indexed so are arrays of the invocation.
//!
//! | file | does |
//! |---|---|
//! | `types` | the scalars of a type |
//! | `summary` | what a function changes, and which variables are indexed |
//! | `pointer` | places: slots, arrays, buffers, immediates, the work-group's memory; loads and stores |
//! | `half_memory` | 16-bit floats in buffers |
//! | `entry` | inputs and outputs of an entry point |
//! | `bindings` | what it binds |
//! | `call` | calls that are inlined, and the variables of functions |
//! | `statement` | statements and their effects |
//! | `flow` | `if`, loops and switches, and the slots that they hand over |
//! | `subgroup` | what the invocations of a quad exchange |
//! | `expression`, `arithmetic`, `math`, `half`, `image` | values |
//! | `wide` | 64-bit integers: two words |
//! | `gradients` | the level of detail of textures that are sampled at varyings as they are |

mod arithmetic;
mod bindings;
mod call;
mod entry;
mod expression;
mod flow;
mod gradients;
mod half;
mod half_memory;
mod image;
mod math;
mod pointer;
mod statement;
mod subgroup;
mod summary;
mod types;
mod wide;

use crate::program::{StageSource, VaryingSlot};
use estampe_ir::Value;
use estampe_ir::interface::{Output, Stage};
use estampe_ir::tree::{Builder, passes};
use estampe_types::SampleType;
use naga::valid::ModuleInfo;
use naga::{Function, GlobalVariable, Handle, Module, ShaderStage};
use pointer::Pointer;
use std::collections::HashMap;
use summary::Summaries;

/// The most values of a tree, which bounds memory and time.
const MAX_VALUES: usize = 1_000_000;

/// The deepest nesting of calls.
const MAX_CALLS: usize = 128;

/// Why a module cannot be lowered.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LowerError {
    /// The module has no such entry point.
    #[error("there is no entry point number {0}")]
    NoEntryPoint(usize),
    /// Something that is not implemented.
    #[error("{0} are not supported yet")]
    Unsupported(&'static str),
    /// The shader is too large when its calls are inlined.
    #[error(
        "the shader has more than {MAX_VALUES} operations when its functions are inlined: make \
         arrays and functions smaller, or call them in a loop"
    )]
    TooLarge,
}

/// The value of an expression.
#[derive(Debug, Clone)]
enum Operand {
    /// The scalars, in the order of the type.
    Scalars(Vec<Value>),
    /// A place.
    Pointer(Pointer),
    /// A texture or sampler.
    Resource(Handle<GlobalVariable>),
}

/// Lowers an entry point.
///
/// # Errors
/// [`LowerError`] if it uses something that is not supported, or is too large.
pub fn lower(
    module: &Module,
    info: &ModuleInfo,
    entry_point: usize,
) -> Result<StageSource, LowerError> {
    let point = module.entry_points.get(entry_point);
    let point = point.ok_or(LowerError::NoEntryPoint(entry_point))?;
    let stage = match point.stage {
        ShaderStage::Vertex => Stage::Vertex,
        ShaderStage::Fragment => Stage::Fragment,
        ShaderStage::Compute => Stage::Compute,
        _ => return Err(LowerError::Unsupported("mesh, task and ray shaders")),
    };
    let mut lowering = Lowering {
        module,
        info,
        summaries: Summaries::new(module),
        builder: Builder::new(stage),
        slots: Vec::new(),
        globals: HashMap::new(),
        tables: HashMap::new(),
        cover: 0,
        calls: 0,
        varyings: Vec::new(),
        color_types: Vec::new(),
        outputs: Vec::new(),
        immediate_size: 0,
    };
    lowering.builder.interface_mut().workgroup_size = match stage {
        Stage::Compute => point.workgroup_size,
        Stage::Vertex | Stage::Fragment => [0; 3],
    };
    let function = info.get_entry_point(entry_point);
    let bindings = bindings::bindings(module, function)?;
    lowering.entry_point(point, function)?;
    let mut tree = lowering.builder.finish(lowering.outputs);
    passes::optimise(&mut tree);
    gradients::take_gradients(&mut tree, &lowering.varyings);
    Ok(StageSource {
        tree,
        varyings: lowering.varyings,
        color_types: lowering.color_types,
        bindings,
        immediate_size: lowering.immediate_size,
    })
}

struct Lowering<'a> {
    module: &'a Module,
    info: &'a ModuleInfo,
    summaries: Summaries,
    builder: Builder,
    /// The value of each slot.
    slots: Vec<Value>,
    globals: HashMap<Handle<GlobalVariable>, Operand>,
    /// The arrays of constants, by their words.
    tables: HashMap<Vec<u32>, u32>,
    /// The slot of the mask of invocations that have effects.
    cover: usize,
    /// The calls that are being inlined.
    calls: usize,
    varyings: Vec<VaryingSlot>,
    /// The type of each colour, by location.
    color_types: Vec<Option<SampleType>>,
    outputs: Vec<(Output, Value)>,
    /// The bytes of the immediates up to the last one that is read.
    immediate_size: u32,
}

/// A function that is being inlined.
struct Frame<'a> {
    function: &'a Function,
    info: &'a naga::valid::FunctionInfo,
    arguments: Vec<Operand>,
    locals: HashMap<Handle<naga::LocalVariable>, Pointer>,
    /// Expressions that were evaluated.
    done: HashMap<Handle<naga::Expression>, Operand>,
    /// Where `return` goes.
    leave: flow::Exit,
    /// Where `break` and `continue` go, innermost last.
    breaks: Vec<flow::Exit>,
    continues: Vec<flow::Exit>,
}

type Lowered<T> = Result<T, LowerError>;
