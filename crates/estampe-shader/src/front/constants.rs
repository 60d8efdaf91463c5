//! Values of pipeline-overridable constants.

use naga::ShaderStage;
use naga::back::PipelineConstants;
use naga::back::pipeline_constants::{PipelineConstantError, process_overrides};
use naga::valid::ModuleInfo;

use super::reflect::Reflection;
use super::validate::{self, Fault, Words};
use super::{ShaderError, suggest};

/// Why constants could not be given their values.
pub(super) enum Rejected {
    /// An error without a place in the text.
    Constant(ShaderError),
    /// With the values, the module is not valid.
    Module(Fault),
}

/// The module with values in the place of its overrides. With an entry point, only what that uses
/// is kept.
pub(super) fn resolve(
    module: &naga::Module,
    info: &ModuleInfo,
    reflection: &Reflection,
    entry: Option<(ShaderStage, &str)>,
    values: &[(String, f64)],
    words: Words,
) -> Result<(naga::Module, ModuleInfo), Rejected> {
    let constants = keys(reflection, values).map_err(Rejected::Constant)?;
    let resolved = process_overrides(module, info, entry, &constants);
    let (module, _) = resolved.map_err(|error| describe(module, &error, words))?;
    let module = module.into_owned();
    // naga checks the result with all capabilities.
    let info = validate::check_resolved(&module, words).map_err(Rejected::Module)?;
    Ok((module, info))
}

/// The values by naga's keys: the digits of the id, or the name if there is no id.
fn keys(
    reflection: &Reflection,
    values: &[(String, f64)],
) -> Result<PipelineConstants, ShaderError> {
    let mut constants = PipelineConstants::default();
    for (key, value) in values {
        let found = reflection.overrides.iter().find(|constant| {
            let by_id = constant.id.is_some_and(|id| key.parse() == Ok(id));
            by_id || constant.name.as_deref() == Some(key)
        });
        let Some(found) = found else {
            let error = ShaderError::new(format!("the shader has no constant `{key}`"));
            let names = reflection
                .overrides
                .iter()
                .filter_map(|one| one.name.as_deref());
            return Err(match suggest::nearest(key, names) {
                Some(near) => error.help(format!("did you mean `{near}`?")),
                None => {
                    error.help("constants are named by their name, or by the digits of their id")
                }
            });
        };
        let key = match (found.id, &found.name) {
            (Some(id), _) => id.to_string(),
            (None, Some(name)) => name.clone(),
            (None, None) => continue,
        };
        constants.insert(key, *value);
    }
    Ok(constants)
}

fn describe(module: &naga::Module, error: &PipelineConstantError, words: Words) -> Rejected {
    let error = match error {
        PipelineConstantError::MissingValue(key) => {
            // naga calls constants by their ids.
            let has_key = |id: Option<u16>| id.is_some_and(|id| id.to_string() == *key);
            let mut overrides = module.overrides.iter();
            let found = overrides.find(|(_, constant)| has_key(constant.id));
            let name = found.and_then(|(_, constant)| constant.name.as_ref());
            let name = name.unwrap_or(key);
            let message = format!("the constant `{name}` has neither a value nor a default");
            ShaderError::new(message).help("give it a value among the options' constants")
        }
        PipelineConstantError::NotFound(name) => {
            ShaderError::new(format!("the shader has no constant `{name}`"))
        }
        PipelineConstantError::SrcNeedsToBeFinite => {
            ShaderError::new("the value of a constant is infinite or not a number")
        }
        PipelineConstantError::DstRangeTooSmall => {
            ShaderError::new("the value of a constant is out of the range of its type")
        }
        PipelineConstantError::ValidationError(error) => {
            return Rejected::Module(validate::describe(module, error, words));
        }
        PipelineConstantError::NegativeWorkgroupSize => {
            ShaderError::new("a constant makes the size of the workgroup 0 or negative")
        }
        other => ShaderError::new(words.plain(other)),
    };
    Rejected::Constant(error)
}
