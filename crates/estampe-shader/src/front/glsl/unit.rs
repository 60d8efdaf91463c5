//! A shader taken apart into its declarations.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use estampe_ir::interface::Stage;

use super::preprocess::Version;
use super::token::{Place, Token};
use super::types::{Member, Structures, Type};

/// What a variable at file scope is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Storage {
    /// A variable of the invocation.
    Private,
    Const,
    In,
    Out,
    Uniform,
    Buffer,
    Shared,
}

/// A word of `layout(…)`.
#[derive(Debug, Clone)]
pub(super) struct LayoutWord {
    pub name: Rc<str>,
    pub value: Option<i64>,
    pub place: Place,
}

/// The qualifiers of a declaration. Those that change nothing here are left out: precision,
/// `invariant`, `precise`, `restrict`, `volatile`, `coherent`.
#[derive(Debug, Clone, Default)]
pub(super) struct Qualifiers {
    pub storage: Option<(Storage, Place)>,
    /// `flat`, `smooth`, `noperspective`, `centroid`, `sample`.
    pub interpolation: Vec<Rc<str>>,
    /// `readonly`, `writeonly`.
    pub memory: Vec<Rc<str>>,
    pub layout: Vec<LayoutWord>,
    pub place: Option<Place>,
}

impl Qualifiers {
    pub(super) fn storage(&self) -> Storage {
        self.storage
            .map_or(Storage::Private, |(storage, _)| storage)
    }

    /// The value of a word of `layout`.
    pub(super) fn value(&self, name: &str) -> Option<u32> {
        let word = self.layout.iter().rev().find(|word| &*word.name == name)?;
        u32::try_from(word.value?).ok()
    }

    /// A word of `layout` that is there.
    pub(super) fn layout_word(&self, name: &str) -> Option<&LayoutWord> {
        self.layout.iter().find(|word| &*word.name == name)
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.layout.iter().any(|word| &*word.name == name)
    }
}

/// A variable at file scope.
#[derive(Debug, Clone)]
pub(super) struct Variable {
    pub name: Rc<str>,
    pub place: Place,
    pub ty: Type,
    pub qualifiers: Rc<Qualifiers>,
    pub init: Vec<Token>,
    /// What names its parts between stages: its name, or that of its block.
    pub link_name: String,
}

/// An interface block, or a uniform or storage buffer.
#[derive(Debug, Clone)]
pub(super) struct Block {
    pub name: Rc<str>,
    pub place: Place,
    pub members: Vec<Member>,
    /// The name of the instance. Without one, the members are at file scope.
    pub instance: Option<Rc<str>>,
    pub qualifiers: Rc<Qualifiers>,
}

/// A parameter of a function.
#[derive(Debug, Clone)]
pub(super) struct Parameter {
    /// `const`, `in`, `out` or `inout`, or nothing.
    pub direction: &'static str,
    pub ty: Type,
    pub name: Option<Rc<str>>,
    pub place: Place,
}

/// A function, or its prototype.
#[derive(Debug, Clone)]
pub(super) struct Function {
    pub name: Rc<str>,
    pub place: Place,
    pub result: Type,
    pub parameters: Vec<Parameter>,
    /// The body with its braces. Empty for a prototype.
    pub body: Vec<Token>,
}

/// A declaration at file scope.
#[derive(Debug, Clone)]
pub(super) enum Item {
    Variable(Variable),
    Block(Block),
    Function(Function),
}

/// A shader.
#[derive(Debug)]
pub(super) struct Unit {
    pub stage: Stage,
    pub version: Version,
    pub is_vulkan: bool,
    pub structures: Structures,
    pub items: Vec<Item>,
    /// Integer constants at file scope.
    pub constants: HashMap<Rc<str>, i64>,
    /// The invocations of a work-group.
    pub workgroup_size: [u32; 3],
    pub has_early_tests: bool,
    /// The number of clip distances: declared, or the largest constant index.
    pub clip_distances: u32,
    /// All names that the text uses in functions and initial values.
    pub used: HashSet<Rc<str>>,
    /// What begins the names that the pass invents. No name of the text begins so.
    pub prefix: String,
}

impl Unit {
    pub(super) fn variables(&self) -> impl Iterator<Item = &Variable> {
        self.items.iter().filter_map(|item| match item {
            Item::Variable(variable) => Some(variable),
            _ => None,
        })
    }

    pub(super) fn functions(&self) -> impl Iterator<Item = &Function> {
        self.items.iter().filter_map(|item| match item {
            Item::Function(function) => Some(function),
            _ => None,
        })
    }

    /// True if a loose uniform has the name.
    pub(super) fn is_uniform(&self, name: &str) -> bool {
        self.variables().any(|variable| {
            &*variable.name == name && variable.qualifiers.storage() == Storage::Uniform
        })
    }

    /// True if the text has a function with the name.
    pub(super) fn has_function(&self, name: &str) -> bool {
        self.functions().any(|function| &*function.name == name)
    }
}
