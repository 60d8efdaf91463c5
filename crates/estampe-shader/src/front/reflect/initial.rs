//! Values with which GLSL's uniforms begin.

use naga::{ArraySize, Expression, Handle, Literal, Type, TypeInner};

/// The most words of a value.
const MOST_WORDS: usize = 1 << 16;

/// The words of the constant of a name, in the order of its type. `None` if the value is not one of
/// 32-bit numbers.
pub(super) fn words(module: &naga::Module, constant: &str) -> Option<Vec<u32>> {
    let mut constants = module.constants.iter();
    let (_, found) = constants.find(|(_, one)| one.name.as_deref() == Some(constant))?;
    let mut words = Vec::new();
    add(module, found.init, &mut words)?;
    Some(words)
}

fn add(module: &naga::Module, handle: Handle<Expression>, words: &mut Vec<u32>) -> Option<()> {
    match module.global_expressions[handle] {
        Expression::Literal(literal) => words.push(match literal {
            Literal::F32(number) => number.to_bits(),
            Literal::U32(number) => number,
            Literal::I32(number) => number.cast_unsigned(),
            Literal::Bool(is_true) => u32::from(is_true),
            _ => return None,
        }),
        Expression::Constant(constant) => add(module, module.constants[constant].init, words)?,
        Expression::ZeroValue(ty) => {
            let count = words.len() + components(module, ty)?;
            words.resize(count, 0);
        }
        Expression::Compose { ref components, .. } => {
            for component in components {
                add(module, *component, words)?;
            }
        }
        Expression::Splat { size, value } => {
            for _ in 0..size as usize {
                add(module, value, words)?;
            }
        }
        _ => return None,
    }
    (words.len() <= MOST_WORDS).then_some(())
}

/// The numbers that a value of a type consists of.
fn components(module: &naga::Module, ty: Handle<Type>) -> Option<usize> {
    let count = match module.types[ty].inner {
        TypeInner::Scalar(_) => 1,
        TypeInner::Vector { size, .. } => size as usize,
        TypeInner::Matrix { columns, rows, .. } => columns as usize * rows as usize,
        TypeInner::Array { base, size, .. } => {
            let ArraySize::Constant(length) = size else {
                return None;
            };
            components(module, base)?.checked_mul(length.get() as usize)?
        }
        TypeInner::Struct { ref members, .. } => {
            let mut count = 0_usize;
            for member in members {
                count = count.checked_add(components(module, member.ty)?)?;
            }
            count
        }
        _ => return None,
    };
    (count <= MOST_WORDS).then_some(count)
}
