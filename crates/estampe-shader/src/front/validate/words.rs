//! The words of the source languages for what naga calls by the names of its representation.

use core::error::Error;

use naga::valid::Capabilities;
use naga::{Handle, ImageClass, Module, StorageAccess, Type, TypeInner};

use super::super::reflect::ValueType;

/// The source language whose words messages use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::front) enum Words {
    /// Those of WGSL; also for SPIR-V, which has no names of its own for types.
    Wgsl,
    /// Those of GLSL.
    Glsl,
}

impl Words {
    /// The name of a type in the source language.
    pub(super) fn type_name(self, module: &Module, ty: Handle<Type>) -> String {
        let kind = &module.types[ty];
        match &kind.name {
            Some(name) => format!("`{name}`"),
            None => self.inner_name(module, &kind.inner),
        }
    }

    /// The name of a type, in backquotes if it is one that the author may write.
    pub(super) fn inner_name(self, module: &Module, inner: &TypeInner) -> String {
        if let Some(kind) = ValueType::of(inner) {
            return match self {
                Self::Wgsl => format!("`{kind}`"),
                Self::Glsl => format!("`{}`", kind.glsl_name()),
            };
        }
        match *inner {
            TypeInner::Pointer { base, .. } => self.type_name(module, base),
            TypeInner::ValuePointer { size, scalar, .. } => {
                let pointed = match size {
                    Some(size) => TypeInner::Vector { size, scalar },
                    None => TypeInner::Scalar(scalar),
                };
                self.inner_name(module, &pointed)
            }
            TypeInner::Array { base, size, .. } => {
                let element = self.type_name(module, base);
                match size {
                    naga::ArraySize::Constant(size) => format!("array of {size} {element}"),
                    _ => format!("array of {element}"),
                }
            }
            TypeInner::Struct { .. } => "structure".to_owned(),
            TypeInner::Image { class, .. } => match class {
                ImageClass::Depth { .. } => "depth texture".to_owned(),
                ImageClass::Storage { access, .. } if access == StorageAccess::STORE => {
                    "write-only storage texture".to_owned()
                }
                ImageClass::Storage { .. } => "storage texture".to_owned(),
                _ => "texture".to_owned(),
            },
            TypeInner::Sampler { comparison: false } => "sampler".to_owned(),
            TypeInner::Sampler { comparison: true } => "comparison sampler".to_owned(),
            _ => "value of another kind".to_owned(),
        }
    }

    pub(super) fn type_named(self, name: &str) -> String {
        match name {
            "" => "type".to_owned(),
            name => format!("type `{name}`"),
        }
    }

    /// The name of constants that pipelines override.
    pub(super) fn overridable(self) -> &'static str {
        match self {
            Self::Wgsl => "override",
            Self::Glsl => "specialization constant",
        }
    }

    /// How the language gives a location.
    pub(super) fn location(self, location: u32) -> String {
        match self {
            Self::Wgsl => format!("@location({location})"),
            Self::Glsl => format!("layout(location = {location})"),
        }
    }

    /// The innermost cause of an error of naga, without handles.
    pub(super) fn chain(self, error: &dyn Error) -> String {
        let mut cause = error;
        while let Some(source) = cause.source() {
            cause = source;
        }
        plain(&cause.to_string())
    }
}

impl Words {
    /// The words of an error of naga alone, without handles.
    pub(in crate::front) fn plain(self, error: &dyn Error) -> String {
        plain(&error.to_string())
    }
}

/// How messages begin that speak of naga's representation, and what they mean.
const PHRASES: &[(&str, &str)] = &[
    (
        "invalid access into expression",
        "this has no such element or member: only vectors, matrices, arrays and structures have",
    ),
    (
        "can't resolve type: InvalidSubAccess",
        "this has no elements: only vectors, matrices and arrays have",
    ),
    (
        "can't resolve type: IncompatibleOperands",
        "this operator does not work with values of these types",
    ),
    (
        "Cannot apply the unary op",
        "this operator does not work with a value of this type",
    ),
    (
        "cannot apply math function",
        "a function is called with a constant of a type that it does not take",
    ),
    (
        "Array length of",
        "only arrays have a `length()` that is known",
    ),
    ("Loading of", "this cannot be loaded as a value"),
    (
        "invalid sub-access into type",
        "this has no such element or member: only vectors, matrices, arrays and structures have",
    ),
    (
        "Unable to operate on image class",
        "the function does not take textures of this kind",
    ),
    (
        "Image array index type",
        "the layer, mip level or sample is not an integer",
    ),
    (
        "Image other index type",
        "the layer, mip level or sample is not an integer",
    ),
];

/// A message of naga without its handles (`[12]`), its debug names and a full stop at the end,
/// beginning with a small letter.
pub(in crate::front) fn plain(message: &str) -> String {
    if let Some((start, _)) = message.split_once(" values requires the `naga::valid::") {
        let kind = start.split_once(' ').map_or(start, |(_, kind)| kind);
        return match kind {
            "`f64`" => "64-bit floating point is not supported".to_owned(),
            kind => format!("the type {kind} is not supported"),
        };
    }
    let begins = |start: &str| {
        let head = message.get(..start.len());
        head.is_some_and(|head| head.eq_ignore_ascii_case(start))
    };
    let known = PHRASES.iter().find(|(start, _)| begins(start));
    if let Some((_, words)) = known {
        return (*words).to_owned();
    }
    let mut text = String::with_capacity(message.len());
    let mut rest = message;
    while let Some(open) = rest.find('[') {
        let (before, after) = rest.split_at(open);
        let close = after.find(']');
        let inside = close.map(|close| &after[1..close]);
        match (inside, close) {
            (Some(inside), Some(close))
                if !inside.is_empty() && inside.bytes().all(|byte| byte.is_ascii_digit()) =>
            {
                text.push_str(before.trim_end());
                rest = &after[close + 1..];
            }
            _ => {
                text.push_str(&rest[..=open]);
                rest = &after[1..];
            }
        }
    }
    text.push_str(rest);
    let text = text.trim_end_matches(" for expression");
    let text = text.trim().trim_end_matches('.').replace("  ", " ");
    let mut characters = text.chars();
    match (characters.next(), characters.as_str()) {
        (Some(first), rest) if !rest.starts_with(char::is_uppercase) => {
            first.to_lowercase().chain(rest.chars()).collect()
        }
        _ => text,
    }
}

/// The names of capabilities.
pub(super) fn capability(capabilities: Capabilities) -> String {
    let names = [
        (Capabilities::FLOAT64, "64-bit floating point"),
        (
            Capabilities::SHADER_INT64_ATOMIC_ALL_OPS,
            "atomic operations on 64-bit integers",
        ),
        (Capabilities::SHADER_INT16, "16-bit integers"),
        (Capabilities::PRIMITIVE_INDEX, "the index of the primitive"),
        (Capabilities::DRAW_INDEX, "the index of the draw"),
        (Capabilities::MULTIVIEW, "multiview"),
        (Capabilities::SHADER_BARYCENTRICS, "barycentric coordinates"),
        (Capabilities::MESH_SHADER, "mesh shaders"),
        (Capabilities::RAY_QUERY, "ray queries"),
        (
            Capabilities::TEXTURE_ATOMIC,
            "atomic operations on textures",
        ),
        (
            Capabilities::SHADER_FLOAT32_ATOMIC,
            "atomic operations on floats",
        ),
        (Capabilities::TEXTURE_EXTERNAL, "external textures"),
        (
            Capabilities::TEXTURE_AND_SAMPLER_BINDING_ARRAY,
            "arrays of textures and samplers",
        ),
        (
            Capabilities::BUFFER_BINDING_ARRAY,
            "arrays of uniform buffers",
        ),
        (
            Capabilities::STORAGE_BUFFER_BINDING_ARRAY,
            "arrays of storage buffers",
        ),
    ];
    let known = names.iter().find(|(flag, _)| capabilities.contains(*flag));
    known.map_or_else(
        || format!("{capabilities:?}").to_lowercase(),
        |(_, name)| (*name).to_owned(),
    )
}
