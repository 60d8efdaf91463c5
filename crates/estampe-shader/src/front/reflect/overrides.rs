//! Pipeline-overridable constants.

use naga::{Expression, Literal};

use super::{Names, Scalar, ValueType};

/// A pipeline-overridable constant (specialization constant).
#[derive(Debug, Clone, PartialEq)]
pub struct Override {
    /// The name, if the source has one.
    pub name: Option<String>,
    /// The id, if the source has one. Values are then given by the id's digits.
    pub id: Option<u16>,
    /// The type.
    pub kind: Scalar,
    /// The default. `None` if the program must give a value.
    pub default: Option<OverrideValue>,
}

/// The default of a pipeline-overridable constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OverrideValue {
    /// A number; 0 and 1 for truth values.
    Number(f64),
    /// An expression of other pipeline-overridable constants.
    Expression,
}

/// The pipeline-overridable constants of a module, in the order of declaration.
pub(super) fn find(module: &naga::Module, names: &Names) -> Vec<Override> {
    let overrides = module.overrides.iter();
    overrides
        .filter_map(|(_, constant)| {
            let ValueType::Scalar(kind) = ValueType::of(&module.types[constant.ty].inner)? else {
                return None;
            };
            // Expressions in the source that depend on constants are nameless ones.
            if constant.name.is_none() && constant.id.is_none() {
                return None;
            }
            Some(Override {
                name: constant.name.as_deref().map(|name| names.name(Some(name))),
                id: constant.id,
                kind,
                default: constant
                    .init
                    .map(|init| match module.global_expressions[init] {
                        Expression::Literal(literal) => OverrideValue::Number(number(literal)),
                        Expression::ZeroValue(_) => OverrideValue::Number(0.0),
                        _ => OverrideValue::Expression,
                    }),
            })
        })
        .collect()
}

#[expect(
    clippy::cast_precision_loss,
    reason = "reflection gives numbers as WebGPU takes them"
)]
fn number(literal: Literal) -> f64 {
    match literal {
        Literal::F64(value) | Literal::AbstractFloat(value) => value,
        Literal::F32(value) => f64::from(value),
        Literal::F16(value) => f64::from(value),
        Literal::U16(value) => f64::from(value),
        Literal::I16(value) => f64::from(value),
        Literal::U32(value) => f64::from(value),
        Literal::I32(value) => f64::from(value),
        Literal::U64(value) => value as f64,
        Literal::I64(value) | Literal::AbstractInt(value) => value as f64,
        Literal::Bool(value) => f64::from(u8::from(value)),
    }
}
