//! GLSL as people write it, brought to the GLSL of Vulkan that naga reads.

use estampe_ir::interface::Stage;

use super::{Module, Options, ShaderError, ShaderErrors};

/// Loads a shader of one stage.
pub(super) fn load(_text: &str, _stage: Stage, _options: &Options) -> Result<Module, ShaderErrors> {
    Err(ShaderError::new("GLSL is not read yet").into())
}

/// Loads a vertex and a fragment shader, linked by name.
pub(super) fn load_pair(
    _vertex: (&str, &Options),
    _fragment: (&str, &Options),
) -> Result<(Module, Module), ShaderErrors> {
    Err(ShaderError::new("GLSL is not read yet").into())
}
