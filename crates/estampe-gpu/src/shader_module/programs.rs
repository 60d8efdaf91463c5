//! Programs of entry points.

use super::error::ShaderModuleError;
use super::{ShaderModule, ShaderStage};
use estampe_shader::front::{Module, Override};
use estampe_shader::lower::lower;
use estampe_shader::program::{StageSource, TextCompute, TextProgram};

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

    pub(crate) fn program(&self, budget: u64) -> Result<TextProgram, ShaderModuleError> {
        let vertex = self.vertex.stage(ShaderStage::Vertex)?;
        let fragment = self
            .fragment
            .map(|entry| entry.stage(ShaderStage::Fragment));
        let fragment = fragment.transpose()?;
        Ok(TextProgram::new(&vertex, fragment.as_ref(), budget)?)
    }
}

impl EntryPointDescriptor<'_> {
    pub(crate) fn compute(&self, budget: u64) -> Result<TextCompute, ShaderModuleError> {
        let source = self.stage(ShaderStage::Compute)?;
        Ok(TextCompute::new(&source, budget)?)
    }

    /// Checks that the entry point can be compiled.
    pub(super) fn check(&self, stage: ShaderStage) -> Result<(), ShaderModuleError> {
        let source = self.stage(stage)?;
        match stage {
            ShaderStage::Vertex => TextProgram::new(&source, None, 0).map(|_| ())?,
            ShaderStage::Fragment => {}
            ShaderStage::Compute => TextCompute::new(&source, 0).map(|_| ())?,
        }
        Ok(())
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
        let lowered = lower(&special.module, &special.info, number.unwrap_or(usize::MAX));
        let mut source = lowered.map_err(|error| ShaderModuleError::Lower {
            name: name.to_owned(),
            error,
        })?;
        if !self.module.strict_math {
            source.contract();
        }
        Ok(source)
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

/// The values of a module's constants, by name or by the digits of their id: those that are given,
/// and 1 for others without a default.
pub(super) fn constants_of(module: &Module, given: &[(&str, f64)]) -> Vec<(String, f64)> {
    let of = |constant: &Override| {
        let id = constant.id.map(|id| id.to_string());
        let is_key =
            |key: &str| id.as_deref() == Some(key) || constant.name.as_deref() == Some(key);
        let value = given.iter().find(|(key, _)| is_key(key));
        let value = value.map(|(_, value)| *value);
        let value = value.or(constant.default.is_none().then_some(1.0))?;
        Some((id.clone().or_else(|| constant.name.clone())?, value))
    };
    module.reflection.overrides.iter().filter_map(of).collect()
}
