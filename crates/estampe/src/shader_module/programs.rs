//! Programs of entry points.

use super::error::ShaderModuleError;
use super::{ShaderModule, ShaderStage};
use estampe_shader::front::Module;
use estampe_shader::lower::lower;
use estampe_shader::program::{StageSource, TextCompute, TextProgram};
use estampe_types::Program;
use estampe_types::shader::ComputeProgram;
use std::sync::Arc;

/// An entry point of a module: WebGPU's `GPUProgrammableStage`.
#[derive(Debug, Clone, Copy)]
pub struct EntryPointDescriptor<'a> {
    /// The module.
    pub module: &'a ShaderModule,
    /// The name. Default the only entry point of the stage.
    pub name: Option<&'a str>,
    /// Values of pipeline-overridable constants, by name or by the digits of their id. Default
    /// none: those of the text.
    pub constants: &'a [(&'a str, f64)],
}

impl<'a> EntryPointDescriptor<'a> {
    /// The only entry point of its stage.
    #[must_use]
    pub fn new(module: &'a ShaderModule) -> Self {
        Self {
            module,
            name: None,
            constants: &[],
        }
    }
}

/// The stages of a render pipeline.
#[derive(Debug, Clone, Copy)]
pub struct ProgramDescriptor<'a> {
    /// The vertex shader.
    pub vertex: EntryPointDescriptor<'a>,
    /// The fragment shader; none to draw depths alone. Default that of the same module, if it has
    /// one.
    pub fragment: Option<EntryPointDescriptor<'a>>,
}

impl<'a> ProgramDescriptor<'a> {
    /// The vertex shader and the fragment shader of a module.
    #[must_use]
    pub fn new(module: &'a ShaderModule) -> Self {
        let of_module = EntryPointDescriptor::new(module);
        let is_fragment = |stage: ShaderStage| stage == ShaderStage::Fragment;
        let has_fragment = module.entry_points().any(|entry| is_fragment(entry.stage));
        Self {
            vertex: of_module,
            fragment: has_fragment.then_some(of_module),
        }
    }

    pub(crate) fn program(&self, budget: u64) -> Result<Arc<dyn Program>, ShaderModuleError> {
        let vertex = self.vertex.stage(ShaderStage::Vertex)?;
        let fragment = self
            .fragment
            .map(|entry| entry.stage(ShaderStage::Fragment));
        let fragment = fragment.transpose()?;
        Ok(Arc::new(TextProgram::new(
            &vertex,
            fragment.as_ref(),
            budget,
        )?))
    }
}

impl EntryPointDescriptor<'_> {
    pub(crate) fn compute(
        &self,
        budget: u64,
    ) -> Result<Arc<dyn ComputeProgram>, ShaderModuleError> {
        let source = self.stage(ShaderStage::Compute)?;
        Ok(Arc::new(TextCompute::new(&source, budget)?))
    }

    fn stage(&self, stage: ShaderStage) -> Result<StageSource, ShaderModuleError> {
        let (module, name) = self.find(stage)?;
        let constants = self.constants.iter();
        let constants: Vec<_> = constants
            .map(|(name, value)| ((*name).to_owned(), *value))
            .collect();
        // Only what the entry point uses needs values.
        let special = module.specialize(Some((stage, name)), &constants)?;
        let of_stage =
            |entry: &estampe_shader::front::EntryPoint| entry.stage == stage && entry.name == name;
        let number = special.entry_points.iter().position(of_stage);
        // An entry point that is not there is refused by `lower`.
        lower(&special.module, &special.info, number.unwrap_or(usize::MAX)).map_err(|error| {
            ShaderModuleError::Lower {
                name: name.to_owned(),
                error,
            }
        })
    }

    fn find(&self, stage: ShaderStage) -> Result<(&Module, &str), ShaderModuleError> {
        let of_stage = |module: &'_ Module| -> Vec<String> {
            let entries = module.entry_points.iter();
            let entries = entries.filter(|entry| entry.stage == stage);
            entries.map(|entry| entry.name.clone()).collect()
        };
        let mut found = Vec::new();
        for module in &*self.module.modules {
            for entry in &module.entry_points {
                let is_named = self.name.is_none_or(|name| name == entry.name);
                if entry.stage == stage && is_named {
                    found.push((module, &*entry.name));
                }
            }
        }
        if let [one] = found[..] {
            return Ok(one);
        }
        let there_are = self.module.modules.iter().flat_map(of_stage).collect();
        Err(match self.name {
            Some(name) => ShaderModuleError::NoEntryPoint {
                name: name.to_owned(),
                stage,
                there_are,
            },
            None => ShaderModuleError::WhichEntryPoint { stage, there_are },
        })
    }
}
