//! Types of values: scalars, vectors and matrices.

use core::fmt;

/// The type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Scalar {
    /// A truth value.
    Bool,
    /// A signed integer of 16 bits.
    I16,
    /// An unsigned integer of 16 bits.
    U16,
    /// A signed integer of 32 bits.
    I32,
    /// An unsigned integer of 32 bits.
    U32,
    /// A signed integer of 64 bits.
    I64,
    /// An unsigned integer of 64 bits.
    U64,
    /// Binary floating point of 16 bits.
    F16,
    /// Binary floating point of 32 bits.
    F32,
    /// Binary floating point of 64 bits.
    F64,
}

impl Scalar {
    pub(crate) fn of(scalar: naga::Scalar) -> Self {
        use naga::ScalarKind::{AbstractFloat, AbstractInt, Bool, Float, Sint, Uint};
        match (scalar.kind, scalar.width) {
            (Bool, _) => Self::Bool,
            (Sint, 2) => Self::I16,
            (Sint | AbstractInt, 8) => Self::I64,
            (Sint | AbstractInt, _) => Self::I32,
            (Uint, 2) => Self::U16,
            (Uint, 8) => Self::U64,
            (Uint, _) => Self::U32,
            (Float, 2) => Self::F16,
            (Float | AbstractFloat, 8) => Self::F64,
            (Float | AbstractFloat, _) => Self::F32,
        }
    }

    /// The name in WGSL.
    #[must_use]
    pub fn wgsl_name(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::I16 => "i16",
            Self::U16 => "u16",
            Self::I32 => "i32",
            Self::U32 => "u32",
            Self::I64 => "i64",
            Self::U64 => "u64",
            Self::F16 => "f16",
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// The name in GLSL.
    #[must_use]
    pub fn glsl_name(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::I16 => "int16_t",
            Self::U16 => "uint16_t",
            Self::I32 => "int",
            Self::U32 => "uint",
            Self::I64 => "int64_t",
            Self::U64 => "uint64_t",
            Self::F16 => "float16_t",
            Self::F32 => "float",
            Self::F64 => "double",
        }
    }

    /// The letters that begin GLSL's names of vectors and matrices.
    fn glsl_prefix(self) -> &'static str {
        match self {
            Self::Bool => "b",
            Self::I16 => "i16",
            Self::U16 => "u16",
            Self::I32 => "i",
            Self::U32 => "u",
            Self::I64 => "i64",
            Self::U64 => "u64",
            Self::F16 => "f16",
            Self::F32 => "",
            Self::F64 => "d",
        }
    }
}

/// The type of a value. `Display` writes its name in WGSL.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ValueType {
    /// One number.
    Scalar(Scalar),
    /// A vector of 2 to 4 numbers.
    Vector(Scalar, u8),
    /// A matrix, stored by columns.
    Matrix {
        /// The type of its numbers.
        scalar: Scalar,
        /// The number of columns, 2 to 4.
        columns: u8,
        /// The number of rows, 2 to 4.
        rows: u8,
    },
}

impl ValueType {
    /// The type, if it is of a scalar, an atomic, a vector or a matrix.
    pub(crate) fn of(inner: &naga::TypeInner) -> Option<Self> {
        match *inner {
            naga::TypeInner::Scalar(scalar) | naga::TypeInner::Atomic(scalar) => {
                Some(Self::Scalar(Scalar::of(scalar)))
            }
            naga::TypeInner::Vector { size, scalar } => {
                Some(Self::Vector(Scalar::of(scalar), size as u8))
            }
            naga::TypeInner::Matrix {
                columns,
                rows,
                scalar,
            } => Some(Self::Matrix {
                scalar: Scalar::of(scalar),
                columns: columns as u8,
                rows: rows as u8,
            }),
            _ => None,
        }
    }

    /// The type of its numbers.
    #[must_use]
    pub fn scalar(self) -> Scalar {
        match self {
            Self::Scalar(scalar) | Self::Vector(scalar, _) | Self::Matrix { scalar, .. } => scalar,
        }
    }

    /// The name in GLSL: `vec3`, `mat4`, `uint`.
    #[must_use]
    pub fn glsl_name(self) -> String {
        match self {
            Self::Scalar(scalar) => scalar.glsl_name().to_owned(),
            Self::Vector(scalar, size) => format!("{}vec{size}", scalar.glsl_prefix()),
            Self::Matrix {
                scalar,
                columns,
                rows,
            } if columns == rows => format!("{}mat{columns}", scalar.glsl_prefix()),
            Self::Matrix {
                scalar,
                columns,
                rows,
            } => format!("{}mat{columns}x{rows}", scalar.glsl_prefix()),
        }
    }
}

impl fmt::Display for ValueType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Scalar(scalar) => f.write_str(scalar.wgsl_name()),
            Self::Vector(scalar, size) => write!(f, "vec{size}<{}>", scalar.wgsl_name()),
            Self::Matrix {
                scalar,
                columns,
                rows,
            } => write!(f, "mat{columns}x{rows}<{}>", scalar.wgsl_name()),
        }
    }
}
