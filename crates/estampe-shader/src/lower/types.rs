//! The scalars of a type. A 64-bit integer counts as two: its low word, and its high word.

use super::{LowerError, Lowered};
use estampe_ir::Type;
use naga::{ArraySize, Handle, Module, Scalar, ScalarKind, TypeInner};

/// The most scalars of a value.
const MAX_SCALARS: u64 = 1 << 16;

/// The kind of a scalar that fits a word or a mask.
pub(super) fn kind_of(scalar: Scalar) -> Lowered<Type> {
    match (scalar.kind, scalar.width) {
        (ScalarKind::Bool, _) => Ok(Type::Mask),
        (ScalarKind::Float | ScalarKind::Sint | ScalarKind::Uint, 4) | (ScalarKind::Float, 2) => {
            Ok(Type::Word)
        }
        (ScalarKind::Float, 8) => Err(LowerError::Unsupported("64-bit floats")),
        _ => Err(LowerError::Unsupported("numbers of this width")),
    }
}

/// True for integers of 64 bits, which are two words.
pub(super) fn is_wide(scalar: Scalar) -> bool {
    matches!(scalar.kind, ScalarKind::Sint | ScalarKind::Uint) && scalar.width == 8
}

/// The words or masks of a scalar.
pub(super) fn words(scalar: Scalar) -> u32 {
    if is_wide(scalar) { 2 } else { 1 }
}

/// The scalars of a type, in order: components, columns, elements, members.
pub(super) fn scalars(module: &Module, inner: &TypeInner) -> Lowered<Vec<Scalar>> {
    let mut out = Vec::new();
    add(module, inner, &mut out)?;
    Ok(out)
}

pub(super) fn scalars_of(module: &Module, ty: Handle<naga::Type>) -> Lowered<Vec<Scalar>> {
    scalars(module, &module.types[ty].inner)
}

/// The types of the values of a type.
pub(super) fn kinds(module: &Module, ty: Handle<naga::Type>) -> Lowered<Vec<Type>> {
    scalars_of(module, ty)?.into_iter().map(kind_of).collect()
}

fn add(module: &Module, inner: &TypeInner, out: &mut Vec<Scalar>) -> Lowered<()> {
    let mut repeat = |scalar: Scalar, count: usize| {
        let word = if is_wide(scalar) { Scalar::U32 } else { scalar };
        kind_of(word)?;
        let count = count * words(scalar) as usize;
        out.extend(std::iter::repeat_n(word, count));
        Ok(())
    };
    match *inner {
        TypeInner::Atomic(scalar) if is_wide(scalar) => {
            Err(LowerError::Unsupported("64-bit atomics"))
        }
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => repeat(scalar, 1),
        TypeInner::Vector { size, scalar } => repeat(scalar, size as usize),
        TypeInner::Matrix {
            columns,
            rows,
            scalar,
        } => repeat(scalar, columns as usize * rows as usize),
        TypeInner::Array { base, size, .. } => {
            let ArraySize::Constant(count) = size else {
                return Err(LowerError::Unsupported("values of arrays of unknown size"));
            };
            let element = scalars_of(module, base)?;
            if element.len() as u64 * u64::from(count.get()) + out.len() as u64 > MAX_SCALARS {
                return Err(LowerError::TooLarge);
            }
            for _ in 0..count.get() {
                out.extend(&element);
            }
            Ok(())
        }
        TypeInner::Struct { ref members, .. } => {
            for member in members {
                add(module, &module.types[member.ty].inner, out)?;
            }
            Ok(())
        }
        _ => Err(LowerError::Unsupported("values of this type")),
    }
}

/// What an index selects: the type of the part, and where it begins.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// The type of the part.
    pub(super) inner: TypeInner,
    /// Its first scalar for index 0, and the scalars from one index to the next.
    pub(super) scalars: [u32; 2],
    /// The same in bytes of memory that is shared with the host.
    pub(super) bytes: [u32; 2],
    /// The number of indices; `None` if it is known at run time.
    pub(super) count: Option<u32>,
}

/// The part of a type that an index selects; of structs the member of this constant index.
pub(super) fn part(module: &Module, inner: &TypeInner, index: Option<u32>) -> Lowered<Part> {
    let count = |list: &[Scalar]| u32::try_from(list.len()).unwrap_or(u32::MAX);
    Ok(match *inner {
        TypeInner::Vector { size, scalar } => Part {
            inner: TypeInner::Scalar(scalar),
            scalars: [0, words(scalar)],
            bytes: [0, u32::from(scalar.width)],
            count: Some(size as u32),
        },
        TypeInner::Matrix {
            columns,
            rows,
            scalar,
        } => {
            let padded = if rows as u32 == 3 { 4 } else { rows as u32 };
            Part {
                inner: TypeInner::Vector { size: rows, scalar },
                scalars: [0, rows as u32],
                bytes: [0, padded * u32::from(scalar.width)],
                count: Some(columns as u32),
            }
        }
        TypeInner::Array { base, size, stride } => Part {
            inner: module.types[base].inner.clone(),
            scalars: [0, count(&scalars_of(module, base)?)],
            bytes: [0, stride],
            count: match size {
                ArraySize::Constant(count) => Some(count.get()),
                _ => None,
            },
        },
        TypeInner::Struct { ref members, .. } => {
            let index = index.ok_or(LowerError::Unsupported("indices of structs"))?;
            let mut before = 0;
            for member in members.iter().take(index as usize) {
                before += count(&scalars_of(module, member.ty)?);
            }
            let member = members.get(index as usize);
            let member = member.ok_or(LowerError::Unsupported("members that do not exist"))?;
            return Ok(Part {
                inner: module.types[member.ty].inner.clone(),
                scalars: [before, 0],
                bytes: [member.offset, 0],
                count: Some(1),
            });
        }
        _ => return Err(LowerError::Unsupported("indices of this type")),
    })
}
