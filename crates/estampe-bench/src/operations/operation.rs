//! What is measured.

use super::textures::Access;
use super::{memory, numbers, textures};

/// A group of operations, a part of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// Arithmetic and functions of floats.
    Floats,
    /// Arithmetic and bits of integers.
    Integers,
    /// Branches and loops.
    Control,
    /// Arrays with computed indices, memory of buffers and of work-groups.
    Memory,
    /// Functions of subgroups.
    Subgroups,
    /// Samples of textures.
    Samples,
    /// Loads and stores of texels.
    Texels,
}

impl Group {
    /// The name on the command line and in the table.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Floats => "floats",
            Self::Integers => "integers",
            Self::Control => "control-flow",
            Self::Memory => "memory",
            Self::Subgroups => "subgroups",
            Self::Samples => "samples",
            Self::Texels => "texels",
        }
    }
}

/// An operation of shaders as text.
#[derive(Debug, Clone, PartialEq)]
pub struct Operation {
    /// Its part of the table.
    pub group: Group,
    /// Its name on the command line and in the table.
    pub name: &'static str,
    pub(super) body: Body,
}

/// How a kernel does an operation.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Body {
    /// An expression of a float x.
    Float(&'static str),
    /// An expression of a word x, and the invocation's number i in its work-group.
    Word(&'static str),
    /// An access to a texture.
    Texture(Access),
}

impl Operation {
    /// Every operation, in the order of the table.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        let mut add = |group: Group, name: &'static str, body: Body| {
            all.push(Self { group, name, body });
        };
        for &(name, expression) in numbers::FLOATS {
            add(Group::Floats, name, Body::Float(expression));
        }
        for &(name, expression) in numbers::INTEGERS {
            add(Group::Integers, name, Body::Word(expression));
        }
        for &(name, expression) in memory::CONTROL_FLOW {
            add(Group::Control, name, Body::Word(expression));
        }
        for &(name, expression) in memory::MEMORY {
            add(Group::Memory, name, Body::Word(expression));
        }
        for &(name, expression) in memory::SUBGROUPS {
            add(Group::Subgroups, name, Body::Word(expression));
        }
        for &(name, access) in textures::SAMPLES {
            add(Group::Samples, name, Body::Texture(access));
        }
        for &(name, access) in textures::TEXELS {
            add(Group::Texels, name, Body::Texture(access));
        }
        all
    }
}
