//! Names, types and byte offsets of what is in buffers.

use naga::{AddressSpace, ArraySize, Handle, Type, TypeInner};

use super::{Names, ValueType, initial};

/// The most members that are listed of one block: arrays of structures are listed element by
/// element, and may have millions.
const MOST_MEMBERS: usize = 4096;

/// How deeply structures may nest in a name.
const DEEPEST: usize = 32;

/// The contents of a buffer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UniformBlock {
    /// The name of the variable; in GLSL that of the block, empty for loose uniforms.
    pub name: String,
    /// The bind group and binding; `None` for push constants.
    pub slot: Option<(u32, u32)>,
    /// The bytes of the block. A run-time sized array at its end counts as one element.
    pub size: u32,
    /// The members, by offset. At most 4096 are listed.
    pub members: Vec<UniformMember>,
}

/// A scalar, vector or matrix in a buffer, or an array of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UniformMember {
    /// The name from the block on: `model`, `lights[0].color`, `weights` for an array.
    pub name: String,
    /// The type, that of an element for arrays.
    pub kind: ValueType,
    /// The number of elements: `None` if it is not an array, `Some(0)` if the buffer's size tells.
    pub array_length: Option<u32>,
    /// The bytes from one element to the next. 0 if it is not an array.
    pub array_stride: u32,
    /// The bytes from one column of a matrix to the next. 0 for other types.
    pub matrix_stride: u32,
    /// The bytes from the block's start.
    pub offset: u32,
    /// The value that the shader gives it: the words of its components, column after column,
    /// element after element, without gaps. `None` if there is none, which only GLSL's uniforms may
    /// have.
    pub initial_value: Option<Vec<u32>>,
}

impl UniformMember {
    /// The words of its components. A run-time sized array has none.
    fn words(&self) -> usize {
        let components = match self.kind {
            ValueType::Scalar(_) => 1,
            ValueType::Vector(_, rows) => u32::from(rows),
            ValueType::Matrix { columns, rows, .. } => u32::from(columns) * u32::from(rows),
        };
        (components * self.array_length.unwrap_or(1)) as usize
    }
}

/// The buffers of a module in the order of group and binding, and its push constants.
pub(super) fn find(module: &naga::Module, names: &Names) -> Vec<UniformBlock> {
    let mut blocks = Vec::new();
    for (_, variable) in module.global_variables.iter() {
        let slot = match variable.space {
            AddressSpace::Uniform | AddressSpace::Storage { .. } => match &variable.binding {
                Some(binding) => Some((binding.group, binding.binding)),
                None => continue,
            },
            AddressSpace::Immediate => None,
            _ => continue,
        };
        let kind = &module.types[variable.ty];
        let mut members = Vec::new();
        let mut walk = Walk {
            module,
            names,
            members: &mut members,
        };
        match &kind.inner {
            TypeInner::Struct { .. } => walk.visit("", None, variable.ty, 0, 0),
            _ => {
                let name = names.name(variable.name.as_deref());
                walk.visit(&name, variable.name.as_deref(), variable.ty, 0, 0);
            }
        }
        let name = variable.name.as_deref().or(kind.name.as_deref());
        blocks.push(UniformBlock {
            name: names.name(name),
            slot,
            size: kind.inner.size(module.to_ctx()),
            members,
        });
    }
    // `false` sorts first: the push constants are last.
    blocks.sort_by_key(|block| (block.slot.is_none(), block.slot));
    blocks
}

/// The bytes of push constants of a module.
pub(super) fn push_constant_size(module: &naga::Module) -> u32 {
    let variables = module.global_variables.iter();
    variables
        .filter(|(_, variable)| variable.space == AddressSpace::Immediate)
        .map(|(_, variable)| module.types[variable.ty].inner.size(module.to_ctx()))
        .max()
        .unwrap_or(0)
}

struct Walk<'a> {
    module: &'a naga::Module,
    names: &'a Names,
    members: &'a mut Vec<UniformMember>,
}

impl Walk<'_> {
    /// Lists what is in a value of type `ty` at `offset`. `invented` is the name that naga knows.
    fn visit(
        &mut self,
        name: &str,
        invented: Option<&str>,
        ty: Handle<Type>,
        offset: u32,
        depth: usize,
    ) {
        if self.members.len() >= MOST_MEMBERS || depth > DEEPEST {
            return;
        }
        match &self.module.types[ty].inner {
            TypeInner::Struct { members, .. } => {
                for member in members {
                    if self.names.is_hidden(member.name.as_deref()) {
                        continue;
                    }
                    let last = self.names.name(member.name.as_deref());
                    let path = if name.is_empty() {
                        last
                    } else {
                        format!("{name}.{last}")
                    };
                    let offset = offset.saturating_add(member.offset);
                    let first = self.members.len();
                    self.visit(&path, member.name.as_deref(), member.ty, offset, depth + 1);
                    if let Some(constant) = self.names.initial(member.name.as_deref()) {
                        let words = initial::words(self.module, constant);
                        give(&mut self.members[first..], &words.unwrap_or_default());
                    }
                }
            }
            TypeInner::Array { base, size, stride } => {
                let length = match size {
                    ArraySize::Constant(length) => length.get(),
                    ArraySize::Pending(_) | ArraySize::Dynamic => 0,
                };
                let inner = &self.module.types[*base].inner;
                if ValueType::of(inner).is_some() {
                    self.push(name, invented, inner, offset, Some((length, *stride)));
                    return;
                }
                for index in 0..length.max(1) {
                    if self.members.len() >= MOST_MEMBERS {
                        return;
                    }
                    let offset = offset.saturating_add(index.saturating_mul(*stride));
                    self.visit(&format!("{name}[{index}]"), None, *base, offset, depth + 1);
                }
            }
            inner => self.push(name, invented, inner, offset, None),
        }
    }

    fn push(
        &mut self,
        name: &str,
        invented: Option<&str>,
        inner: &TypeInner,
        offset: u32,
        array: Option<(u32, u32)>,
    ) {
        let Some(kind) = ValueType::of(inner) else {
            return;
        };
        let declared = invented.and_then(|invented| self.names.declared_type(invented));
        let mut member = UniformMember {
            name: name.to_owned(),
            kind: declared.unwrap_or(kind),
            array_length: array.map(|(length, _)| length),
            array_stride: array.map_or(0, |(_, stride)| stride),
            matrix_stride: column_stride(inner),
            offset,
            initial_value: None,
        };
        // A matrix that naga sees as an array of columns.
        if let (Some(ValueType::Matrix { columns, .. }), Some((length, stride))) = (declared, array)
        {
            let elements = length / u32::from(columns);
            member.matrix_stride = stride;
            member.array_length = (elements > 1).then_some(elements);
            member.array_stride = if elements > 1 {
                stride * u32::from(columns)
            } else {
                0
            };
        }
        self.members.push(member);
    }
}

/// Divides the words of a value among the members that it consists of.
fn give(members: &mut [UniformMember], mut words: &[u32]) {
    for member in members {
        let Some((own, rest)) = words.split_at_checked(member.words()) else {
            return;
        };
        member.initial_value = Some(own.to_vec());
        words = rest;
    }
}

/// The bytes from one column of a matrix to the next: vectors of three take the room of four.
fn column_stride(inner: &TypeInner) -> u32 {
    match *inner {
        TypeInner::Matrix { rows, scalar, .. } => {
            (rows as u32).next_power_of_two() * u32::from(scalar.width)
        }
        _ => 0,
    }
}
