//! Types of GLSL, as declarations at file scope use them.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use super::super::reflect::{Scalar, ValueType};
use super::token::Place;

/// The most members of a structure, with those of its members: what walks over them is bounded.
const MOST_MEMBERS: usize = 4096;

/// A type: a name, and the sizes of arrays, the outermost first; 0 for `[]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Type {
    pub name: Rc<str>,
    pub dimensions: Vec<u32>,
}

impl Type {
    pub(super) fn element(&self) -> Self {
        Self {
            name: self.name.clone(),
            dimensions: self.dimensions.get(1..).unwrap_or_default().to_vec(),
        }
    }

    /// The type as the author writes it.
    pub(super) fn shown(&self) -> String {
        let sizes = self.dimensions.iter().map(|size| match size {
            0 => "[]".to_owned(),
            size => format!("[{size}]"),
        });
        format!("{}{}", self.name, sizes.collect::<String>())
    }
}

/// A member of a structure or block.
#[derive(Debug, Clone)]
pub(super) struct Member {
    pub name: Rc<str>,
    pub place: Place,
    pub ty: Type,
    /// The byte that `layout(offset = …)` says.
    pub offset: Option<u32>,
}

/// The structures of a shader by name.
#[derive(Debug, Clone, Default)]
pub(super) struct Structures {
    /// True if textures and samplers apart are types, as in Vulkan.
    has_separate: bool,
    members: HashMap<Rc<str>, Rc<[Member]>>,
    /// The structures that hold samplers.
    with_samplers: HashSet<Rc<str>>,
    /// The structures that hold nothing but samplers.
    without_values: HashSet<Rc<str>>,
    /// How many members each structure has with those of its members.
    weights: HashMap<Rc<str>, usize>,
    /// The names in the order of declaration.
    pub order: Vec<(Rc<str>, Place)>,
}

impl Structures {
    /// No structures. In Vulkan, textures and samplers apart are types.
    pub(super) fn new(is_vulkan: bool) -> Self {
        Self {
            has_separate: is_vulkan,
            ..Self::default()
        }
    }

    /// Adds a structure. False if it has no members, or too many with those of its members.
    #[must_use]
    pub(super) fn insert(&mut self, name: Rc<str>, place: Place, members: Vec<Member>) -> bool {
        let weight = |member: &Member| {
            self.weights
                .get(&member.ty.name)
                .map_or(1, |inner| inner + 1)
        };
        let weight = members.iter().map(weight).sum();
        if !(1..=MOST_MEMBERS).contains(&weight) {
            return false;
        }
        self.weights.insert(name.clone(), weight);
        if members.iter().any(|member| self.has_sampler(&member.ty)) {
            self.with_samplers.insert(name.clone());
        }
        if !members.iter().any(|member| self.has_value(&member.ty)) {
            self.without_values.insert(name.clone());
        }
        self.members.insert(name.clone(), members.into());
        self.order.push((name, place));
        true
    }

    pub(super) fn get(&self, name: &str) -> Option<&Rc<[Member]>> {
        self.members.get(name)
    }

    /// True if the name is that of a type of the language or of the shader.
    pub(super) fn is_type(&self, name: &str) -> bool {
        self.members.contains_key(name)
            || is_built_in(name)
            || self.has_separate && is_separate(name)
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.order.iter().map(|(name, _)| &**name)
    }

    /// True if values of the type hold samplers.
    pub(super) fn has_sampler(&self, ty: &Type) -> bool {
        sampler(&ty.name).is_some() || self.with_samplers.contains(&ty.name)
    }

    /// True if values of the type hold something else than samplers.
    pub(super) fn has_value(&self, ty: &Type) -> bool {
        let is_opaque = sampler(&ty.name).is_some() || is_image(&ty.name) || is_separate(&ty.name);
        !is_opaque && !self.without_values.contains(&ty.name)
    }

    /// True if two shaders mean the same by a type: structures are compared member by member.
    pub(super) fn is_same(&self, ty: &Type, others: &Self, other: &Type) -> bool {
        if ty.dimensions != other.dimensions {
            return false;
        }
        match (self.get(&ty.name), others.get(&other.name)) {
            (None, None) => ty.name == other.name,
            (Some(mine), Some(theirs)) => {
                mine.len() == theirs.len()
                    && mine.iter().zip(theirs.iter()).all(|(mine, theirs)| {
                        mine.name == theirs.name && self.is_same(&mine.ty, others, &theirs.ty)
                    })
            }
            _ => false,
        }
    }

    /// The scalars and vectors that a value consists of, as what follows its name: `.position`,
    /// `[2]`. Matrices are columns. `None` if there are more than `most`.
    pub(super) fn leaves(&self, ty: &Type, most: usize) -> Option<Vec<(String, ValueType)>> {
        let mut leaves = Vec::new();
        self.add_leaves(ty, String::new(), most, &mut leaves)?;
        Some(leaves)
    }

    fn add_leaves(
        &self,
        ty: &Type,
        path: String,
        most: usize,
        leaves: &mut Vec<(String, ValueType)>,
    ) -> Option<()> {
        if let Some(&size) = ty.dimensions.first() {
            let element = ty.element();
            for index in 0..size {
                self.add_leaves(&element, format!("{path}[{index}]"), most, leaves)?;
            }
            return Some(());
        }
        if let Some(members) = self.get(&ty.name) {
            for member in members.iter() {
                self.add_leaves(&member.ty, format!("{path}.{}", member.name), most, leaves)?;
            }
            return Some(());
        }
        match value_type(&ty.name)? {
            ValueType::Matrix {
                scalar,
                columns,
                rows,
            } => {
                for column in 0..columns {
                    leaves.push((format!("{path}[{column}]"), ValueType::Vector(scalar, rows)));
                }
            }
            value => leaves.push((path, value)),
        }
        (leaves.len() <= most).then_some(())
    }
}

/// The scalar, vector or matrix of a name.
pub(super) fn value_type(name: &str) -> Option<ValueType> {
    let scalar = |prefix: &str| {
        Some(match prefix {
            "" => Scalar::F32,
            "b" => Scalar::Bool,
            "i" => Scalar::I32,
            "u" => Scalar::U32,
            "d" => Scalar::F64,
            _ => return None,
        })
    };
    let size = |digit: &str| match digit {
        "2" => Some(2),
        "3" => Some(3),
        "4" => Some(4),
        _ => None,
    };
    Some(match name {
        "bool" => ValueType::Scalar(Scalar::Bool),
        "int" => ValueType::Scalar(Scalar::I32),
        "uint" => ValueType::Scalar(Scalar::U32),
        "float" => ValueType::Scalar(Scalar::F32),
        "double" => ValueType::Scalar(Scalar::F64),
        _ => {
            if let Some((prefix, length)) = name.split_once("vec") {
                return Some(ValueType::Vector(scalar(prefix)?, size(length)?));
            }
            let (prefix, sizes) = name.split_once("mat")?;
            let (columns, rows) = sizes.split_once('x').unwrap_or((sizes, sizes));
            let (columns, rows) = (size(columns)?, size(rows)?);
            match scalar(prefix)? {
                scalar @ (Scalar::F32 | Scalar::F64) => ValueType::Matrix {
                    scalar,
                    columns,
                    rows,
                },
                _ => return None,
            }
        }
    })
}

/// A combined texture and sampler: naga's type of the texture, and if it compares.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SamplerType {
    pub texture: String,
    pub is_shadow: bool,
}

impl SamplerType {
    /// naga's type of the sampler.
    pub(super) fn sampler(&self) -> &'static str {
        if self.is_shadow {
            "samplerShadow"
        } else {
            "sampler"
        }
    }
}

/// The combined texture and sampler of a name, such as `sampler2D` or `usampler3D`.
pub(super) fn sampler(name: &str) -> Option<SamplerType> {
    let (prefix, rest) = name.split_once("sampler")?;
    let (rest, is_shadow) = match rest.strip_suffix("Shadow") {
        Some(rest) => (rest, true),
        None => (rest, false),
    };
    let is_known = match rest {
        "1D" | "2D" | "Cube" | "1DArray" | "2DArray" | "CubeArray" => true,
        "3D" | "2DMS" | "2DMSArray" => !is_shadow,
        _ => false,
    };
    let has_kind = prefix.is_empty() || !is_shadow && matches!(prefix, "i" | "u");
    (is_known && has_kind).then(|| SamplerType {
        texture: format!("{prefix}texture{rest}"),
        is_shadow,
    })
}

/// Types that exist in GLSL, but not here.
pub(super) fn is_unsupported(name: &str) -> bool {
    let is_one = |name: &str| {
        matches!(
            name,
            "sampler2DRect"
                | "sampler2DRectShadow"
                | "samplerBuffer"
                | "samplerExternalOES"
                | "image2DRect"
                | "imageBuffer"
                | "imageCube"
                | "imageCubeArray"
                | "image2DMS"
                | "image2DMSArray"
                | "atomic_uint"
                | "subpassInput"
        )
    };
    is_one(name) || name.strip_prefix(['i', 'u']).is_some_and(is_one)
}

/// True for storage textures: `image2D`, `uimage3D`.
pub(super) fn is_image(name: &str) -> bool {
    let is_one = |name: &str| {
        matches!(
            name,
            "image1D" | "image2D" | "image3D" | "image1DArray" | "image2DArray"
        )
    };
    is_one(name) || name.strip_prefix(['i', 'u']).is_some_and(is_one)
}

/// True for textures and samplers of Vulkan, which GLSL does not combine.
pub(super) fn is_separate(name: &str) -> bool {
    let rest = name.strip_prefix(['i', 'u']).unwrap_or(name);
    matches!(name, "sampler" | "samplerShadow")
        || rest.strip_prefix("texture").is_some_and(|dimension| {
            matches!(
                dimension,
                "1D" | "2D"
                    | "3D"
                    | "Cube"
                    | "1DArray"
                    | "2DArray"
                    | "CubeArray"
                    | "2DMS"
                    | "2DMSArray"
            )
        })
}

fn is_built_in(name: &str) -> bool {
    name == "void" || value_type(name).is_some() || sampler(name).is_some() || is_image(name)
}

/// Names of types that are mistyped most.
pub(super) const TYPES: &[&str] = &[
    "bool",
    "bvec2",
    "bvec3",
    "bvec4",
    "float",
    "int",
    "ivec2",
    "ivec3",
    "ivec4",
    "mat2",
    "mat3",
    "mat4",
    "sampler2D",
    "sampler2DArray",
    "sampler2DShadow",
    "sampler3D",
    "samplerCube",
    "uint",
    "uvec2",
    "uvec3",
    "uvec4",
    "vec2",
    "vec3",
    "vec4",
    "void",
];
