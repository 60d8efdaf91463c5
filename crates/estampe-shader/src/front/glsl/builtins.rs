//! Names that the language defines, and naga has otherwise or not at all.

use estampe_ir::interface::Stage;

use super::unit::Unit;

/// What a built-in variable becomes.
pub(super) enum BuiltIn {
    /// Itself: naga has it.
    Same,
    /// Another text.
    Other(String),
    /// The colour that `gl_FragColor` is.
    Color,
    /// The colours that `gl_FragData` has.
    Colors,
    /// Not supported, and what to do.
    Unsupported(&'static str),
    /// There is no such variable in this stage.
    Unknown,
}

/// What a variable that begins with `gl_` becomes.
pub(super) fn variable(unit: &Unit, name: &str) -> BuiltIn {
    let other = |text: &str| BuiltIn::Other(text.to_owned());
    match (unit.stage, name) {
        (Stage::Vertex, "gl_VertexID" | "gl_VertexIndex") => other("int ( gl_VertexIndex )"),
        (Stage::Vertex, "gl_InstanceID" | "gl_InstanceIndex") => other("int ( gl_InstanceIndex )"),
        (Stage::Vertex, "gl_Position" | "gl_PointSize" | "gl_ClipDistance")
        | (Stage::Fragment, "gl_FragCoord" | "gl_FrontFacing" | "gl_FragDepth" | "gl_PointCoord")
        | (
            Stage::Compute,
            "gl_GlobalInvocationID"
            | "gl_LocalInvocationID"
            | "gl_WorkGroupID"
            | "gl_NumWorkGroups"
            | "gl_LocalInvocationIndex",
        ) => BuiltIn::Same,
        (Stage::Fragment, "gl_FragDepthEXT") => other("gl_FragDepth"),
        (Stage::Fragment, "gl_SampleID") => other("int ( gl_SampleID )"),
        (Stage::Fragment, "gl_FragColor") => BuiltIn::Color,
        (Stage::Fragment, "gl_FragData") => BuiltIn::Colors,
        (Stage::Compute, "gl_WorkGroupSize") => {
            let [x, y, z] = unit.workgroup_size;
            BuiltIn::Other(format!("uvec3 ( {x}u , {y}u , {z}u )"))
        }
        (_, "gl_Vertex" | "gl_Normal" | "gl_Color" | "gl_MultiTexCoord0") => {
            BuiltIn::Unsupported("declare an input, such as `in vec3 position;`")
        }
        (
            _,
            "gl_ModelViewProjectionMatrix"
            | "gl_ModelViewMatrix"
            | "gl_ProjectionMatrix"
            | "gl_NormalMatrix"
            | "gl_LightSource"
            | "gl_FrontMaterial",
        ) => BuiltIn::Unsupported("declare a uniform, such as `uniform mat4 model;`"),
        (_, "gl_FrontColor" | "gl_BackColor" | "gl_TexCoord") => {
            BuiltIn::Unsupported("declare an output, such as `out vec4 color;`")
        }
        (_, "gl_PrimitiveID" | "gl_Layer" | "gl_ViewportIndex" | "gl_DrawID") => {
            BuiltIn::Unsupported("hand the number to the shader as an input or uniform")
        }
        (
            _,
            "gl_DepthRange"
            | "gl_SampleMask"
            | "gl_SampleMaskIn"
            | "gl_SamplePosition"
            | "gl_NumSamples"
            | "gl_HelperInvocation"
            | "gl_CullDistance"
            | "gl_BaseVertex"
            | "gl_BaseInstance",
        ) => BuiltIn::Unsupported("do without it"),
        _ => BuiltIn::Unknown,
    }
}

/// The built-in variables of a stage.
pub(super) fn variables(stage: Stage) -> &'static [&'static str] {
    match stage {
        Stage::Vertex => &[
            "gl_Position",
            "gl_PointSize",
            "gl_ClipDistance",
            "gl_VertexID",
            "gl_InstanceID",
        ],
        Stage::Fragment => &[
            "gl_FragCoord",
            "gl_FrontFacing",
            "gl_FragDepth",
            "gl_PointCoord",
            "gl_FragColor",
            "gl_FragData",
            "gl_SampleID",
        ],
        Stage::Compute => &[
            "gl_GlobalInvocationID",
            "gl_LocalInvocationID",
            "gl_WorkGroupID",
            "gl_NumWorkGroups",
            "gl_LocalInvocationIndex",
            "gl_WorkGroupSize",
        ],
    }
}

/// The function of today for one of GLSL 120, ES 100, or an extension of them.
pub(super) fn legacy_function(name: &str) -> Option<&'static str> {
    Some(match name {
        "texture1D" | "texture2D" | "texture3D" | "textureCube" | "shadow2DEXT" => "texture",
        "texture1DProj" | "texture2DProj" | "texture3DProj" => "textureProj",
        "texture1DLod" | "texture2DLod" | "texture3DLod" | "textureCubeLod" | "texture2DLodEXT"
        | "textureCubeLodEXT" => "textureLod",
        "texture2DProjLod" | "texture2DProjLodEXT" => "textureProjLod",
        "texture2DGradEXT" | "texture2DGradARB" | "textureCubeGradEXT" | "textureCubeGradARB" => {
            "textureGrad"
        }
        _ => return None,
    })
}

/// True for functions that order memory: naga's barriers and atomics do so themselves.
pub(super) fn is_memory_barrier(name: &str) -> bool {
    matches!(
        name,
        "memoryBarrier"
            | "memoryBarrierShared"
            | "memoryBarrierBuffer"
            | "memoryBarrierImage"
            | "groupMemoryBarrier"
    )
}

/// True for a word that naga keeps for itself, but which the version leaves to the author.
pub(super) fn is_naga_word(unit: &Unit, word: &str) -> bool {
    let version = unit.version.number;
    let is_new = |desktop: u32, es: u32| match unit.version.is_es {
        true => version < es,
        false => version < desktop,
    };
    match word {
        "buffer" => is_new(430, 310),
        "sample" => is_new(400, 320),
        "shared" | "restrict" | "readonly" | "writeonly" => is_new(420, 310),
        "float16_t" | "f16vec2" | "f16vec3" | "f16vec4" | "f16mat2" | "f16mat3" | "f16mat4" => true,
        _ if super::types::is_separate(word) => !unit.is_vulkan,
        _ if super::types::is_image(word) => is_new(420, 310),
        "uint" | "uvec2" | "uvec3" | "uvec4" => is_new(130, 300),
        "smooth" | "noperspective" | "flat" | "case" | "default" | "switch" => is_new(130, 300),
        _ => false,
    }
}
