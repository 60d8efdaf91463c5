//! Reflection: what a module exchanges with the program that runs it.
//!
//! | module | finds |
//! |---|---|
//! | [`types`] | types of values, in WebGPU's and GLSL's names |
//! | [`resources`] | bind group layout entries and the stages that see them |
//! | [`members`] | names, types and byte offsets in buffers |
//! | [`varyings`] | inputs and outputs of entry points |
//! | [`initial`] | values with which uniforms begin |
//! | [`overrides`] | pipeline-overridable constants |
//! | [`names`] | author's names for those that the GLSL pass invents |

mod initial;
mod members;
mod names;
mod overrides;
mod resources;
mod types;
mod varyings;

pub use members::{UniformBlock, UniformMember};
pub(super) use names::Names;
pub use overrides::{Override, OverrideValue};
pub use resources::{Binding, BindingKind, CombinedSampler, SampleType, Stages, TextureDimension};
pub use types::{Scalar, ValueType};
pub use varyings::Varying;

use naga::valid::ModuleInfo;

/// What a module exchanges with the program that runs it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Reflection {
    /// Bind group layout entries, by group and binding.
    pub bindings: Vec<Binding>,
    /// The contents of the buffers among the bindings, in the same order, and of the push constants
    /// last.
    pub blocks: Vec<UniformBlock>,
    /// Textures and samplers that GLSL joins in one variable. Empty for WGSL.
    pub combined_samplers: Vec<CombinedSampler>,
    /// Inputs of each entry point, by location. Built-ins are not listed.
    pub inputs: Vec<Vec<Varying>>,
    /// Outputs of each entry point, by location. For fragment shaders, the location is the index of
    /// the target. Built-ins are not listed.
    pub outputs: Vec<Vec<Varying>>,
    /// The bytes of push constants (immediate data). 0 if there are none.
    pub push_constant_size: u32,
    /// Pipeline-overridable constants (specialization constants), in the order of declaration.
    pub overrides: Vec<Override>,
}

impl Reflection {
    pub(super) fn new(module: &naga::Module, info: &ModuleInfo, names: &Names) -> Self {
        let (inputs, outputs) = varyings::find(module, names);
        Self {
            bindings: resources::find(module, info, names),
            blocks: members::find(module, names),
            combined_samplers: Vec::new(),
            inputs,
            outputs,
            push_constant_size: members::push_constant_size(module),
            overrides: overrides::find(module, names),
        }
    }

    /// The binding of a name: of a variable, or of a GLSL block.
    #[must_use]
    pub fn binding(&self, name: &str) -> Option<&Binding> {
        self.bindings.iter().find(|binding| binding.name == name)
    }

    /// The member of a buffer with a name, such as `model` or `lights[0].color`, and its block.
    /// In GLSL, loose uniforms are found by their names, and members of blocks by the block's name
    /// and theirs or, in blocks without an instance name, theirs alone.
    #[must_use]
    pub fn uniform(&self, name: &str) -> Option<(&UniformBlock, &UniformMember)> {
        let full = |block: &UniformBlock, member: &UniformMember| {
            let rest = name.strip_prefix(block.name.as_str());
            rest.and_then(|rest| rest.strip_prefix('.')) == Some(member.name.as_str())
        };
        let all = || {
            let blocks = self.blocks.iter();
            blocks.flat_map(|block| block.members.iter().map(move |member| (block, member)))
        };
        all()
            .find(|(_, member)| member.name == name)
            .or_else(|| all().find(|(block, member)| full(block, member)))
    }

    /// The input of the first entry point with a name.
    #[must_use]
    pub fn input(&self, name: &str) -> Option<&Varying> {
        self.inputs.first()?.iter().find(|input| input.name == name)
    }
}
