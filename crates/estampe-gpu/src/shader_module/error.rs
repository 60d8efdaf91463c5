//! Errors of shader modules, programs and uniforms.

use super::{ShaderErrors, ShaderStage};
use estampe_shader::lower::LowerError;
use estampe_shader::program::LinkError;

/// The reason why no program was made of shader modules.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ShaderModuleError {
    /// A constant does not exist, has no value, or has one that is not allowed.
    #[error(transparent)]
    Source(#[from] ShaderErrors),
    /// There is no such entry point.
    #[error(
        "no entry point `{name}` of the {} stage: there are {}",
        stage_name(*stage), list(there_are)
    )]
    NoEntryPoint {
        /// The name.
        name: String,
        /// The stage.
        stage: ShaderStage,
        /// The entry points of the stage.
        there_are: Vec<String>,
    },
    /// The entry point was not named, and there is none or several.
    #[error(
        "which entry point of the {} stage is meant? There are {}: name one",
        stage_name(*stage), list(there_are)
    )]
    WhichEntryPoint {
        /// The stage.
        stage: ShaderStage,
        /// The entry points of the stage.
        there_are: Vec<String>,
    },
    /// An entry point uses what is not supported, or is too large.
    #[error("entry point `{name}`: {error}")]
    Lower {
        /// The entry point.
        name: String,
        /// The reason.
        error: LowerError,
    },
    /// The stages do not fit each other.
    #[error(transparent)]
    Link(#[from] LinkError),
}

pub(super) fn stage_name(stage: ShaderStage) -> &'static str {
    match stage {
        ShaderStage::Vertex => "vertex",
        ShaderStage::Fragment => "fragment",
        ShaderStage::Compute => "compute",
    }
}

fn list(names: &[String]) -> String {
    if names.is_empty() {
        return "none".to_owned();
    }
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}

/// The reason why a uniform was not set.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum UniformError {
    /// The module has no such block.
    #[error("no uniform block `{block}`; loose uniforms of GLSL are the block of the empty name")]
    NoBlock {
        /// The name.
        block: String,
    },
    /// The block has no such uniform.
    #[error("no uniform `{name}`: there are {}", list(there_are))]
    NoUniform {
        /// The name.
        name: String,
        /// The names of the uniforms.
        there_are: Vec<String>,
    },
    /// The value has another type.
    #[error("the uniform `{name}` is {expected}, and the value is {actual}")]
    Type {
        /// The name.
        name: String,
        /// The type of the uniform.
        expected: String,
        /// The type of the value.
        actual: String,
    },
    /// An array has fewer elements.
    #[error("the uniform `{name}` has {length} elements: there is no number {index}")]
    Index {
        /// The name.
        name: String,
        /// The number of elements.
        length: u32,
        /// The index.
        index: usize,
    },
}
