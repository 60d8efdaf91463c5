//! A loaded module: checked, with its entry points and reflection.

use estampe_ir::interface::Stage;
use naga::ShaderStage;
use naga::valid::ModuleInfo;

use super::constants::{self, Rejected};
use super::reflect::{Names, Reflection};
use super::validate::Words;
use super::{ShaderError, ShaderErrors, guard};

/// A checked shader.
#[derive(Debug, Clone)]
pub struct Module {
    /// The module, valid for estampe's capabilities.
    pub module: naga::Module,
    /// What validation found out: types, uses of variables, uniformity.
    pub info: ModuleInfo,
    /// The entry points, in the order of `module.entry_points`.
    pub entry_points: Vec<EntryPoint>,
    /// What the module exchanges with the program that runs it.
    pub reflection: Reflection,
    pub(super) names: Names,
    pub(super) words: Words,
}

/// An entry point of a module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EntryPoint {
    /// The name; `main` in GLSL.
    pub name: String,
    /// The stage.
    pub stage: Stage,
    /// The invocations of a work-group along x, y and z; zeros in other stages than compute.
    /// Ones where overrides without a value yet give the size.
    pub workgroup_size: [u32; 3],
}

/// The stage, if estampe has it.
pub(super) fn stage(stage: ShaderStage) -> Option<Stage> {
    match stage {
        ShaderStage::Vertex => Some(Stage::Vertex),
        ShaderStage::Fragment => Some(Stage::Fragment),
        ShaderStage::Compute => Some(Stage::Compute),
        _ => None,
    }
}

/// naga's name of a stage.
pub(super) fn naga_stage(stage: Stage) -> ShaderStage {
    match stage {
        Stage::Vertex => ShaderStage::Vertex,
        Stage::Fragment => ShaderStage::Fragment,
        Stage::Compute => ShaderStage::Compute,
    }
}

impl Module {
    /// A checked module with its reflection.
    pub(super) fn new(
        module: naga::Module,
        info: ModuleInfo,
        names: Names,
        words: Words,
    ) -> Result<Self, ShaderErrors> {
        let mut entry_points = Vec::new();
        for entry in &module.entry_points {
            let name = entry.name.clone();
            let Some(stage) = stage(entry.stage) else {
                let stage = format!("{:?}", entry.stage).to_lowercase();
                let message = format!("entry point `{name}`: the {stage} stage is not supported");
                return Err(ShaderError::new(message).into());
            };
            entry_points.push(EntryPoint {
                name,
                stage,
                workgroup_size: entry.workgroup_size,
            });
        }
        let reflection = Reflection::new(&module, &info, &names);
        Ok(Self {
            module,
            info,
            entry_points,
            reflection,
            names,
            words,
        })
    }

    /// The module with values for its pipeline-overridable constants, by name or by the digits of
    /// their id. With the name of an entry point, only what that uses is kept, and constants that
    /// it does not use need no value.
    ///
    /// # Errors
    ///
    /// If a constant does not exist, has neither value nor default, or has a value that its type or
    /// use does not allow; if there is no such entry point.
    pub fn specialize(
        &self,
        entry: Option<(Stage, &str)>,
        constants: &[(String, f64)],
    ) -> Result<Self, ShaderErrors> {
        if let Some((stage, name)) = entry {
            let mut entries = self.entry_points.iter();
            if !entries.any(|entry| entry.stage == stage && entry.name == name) {
                return Err(ShaderError::new(format!(
                    "there is no entry point `{name}` of the {} stage",
                    format!("{stage:?}").to_lowercase()
                ))
                .into());
            }
        }
        guard::run(|| {
            let entry = entry.map(|(stage, name)| (naga_stage(stage), name));
            let words = self.words;
            let (module, info) = constants::resolve(
                &self.module,
                &self.info,
                &self.reflection,
                entry,
                constants,
                words,
            )
            .map_err(|rejected| match rejected {
                Rejected::Constant(error) => error,
                Rejected::Module(fault) => ShaderError {
                    help: fault.help,
                    ..ShaderError::new(self.names.in_message(&fault.message))
                },
            })?;
            let mut specialized = Self::new(module, info, self.names.clone(), words)?;
            // naga keeps the declarations of constants that have values now.
            specialized.reflection.overrides.clear();
            let combined = &self.reflection.combined_samplers;
            specialized
                .reflection
                .combined_samplers
                .clone_from(combined);
            Ok(specialized)
        })
    }
}
