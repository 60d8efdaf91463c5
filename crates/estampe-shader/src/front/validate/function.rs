//! Errors in functions, in the words of the source language.

use naga::front::Typifier;
use naga::proc::ResolveContext;
use naga::valid::{CallError, ComposeError, ExpressionError, FunctionError, LocalVariableError};
use naga::{BinaryOperator, Expression, Function, Handle, Module, TypeInner, UnaryOperator};

use super::words::{Words, capability, plain};

type Message = (String, Option<String>);

/// What is wrong in a function.
pub(super) fn describe(
    module: &Module,
    function: &Function,
    error: &FunctionError,
    words: Words,
) -> Message {
    let types = Types {
        module,
        function,
        words,
    };
    let message = match error {
        FunctionError::Expression { handle, source } => return expression(&types, *handle, source),
        FunctionError::LocalVariable { name, source, .. } => match source {
            LocalVariableError::InitializerType => {
                format!("the value given to `{name}` has another type than the variable")
            }
            other => format!("variable `{name}`: {}", words.chain(other)),
        },
        FunctionError::InvalidReturnType {
            expression,
            expected_ty,
        } => {
            let expected = expected_ty.map(|ty| words.type_name(module, ty));
            let given = expression.map(|value| types.of(value));
            match (expected, given) {
                (Some(expected), Some(given)) => {
                    format!("this returns {given}, but the function returns {expected}")
                }
                (Some(expected), None) => {
                    let function = function.name.as_deref().unwrap_or("main");
                    format!("function `{function}` must return {expected} on every path")
                }
                (None, _) => "this returns a value, but the function returns nothing".to_owned(),
            }
        }
        FunctionError::InvalidIfType(value) => {
            format!("the condition is {}, not `bool`", types.of(*value))
        }
        FunctionError::InvalidSwitchType(value) => {
            format!("`switch` takes an integer, not {}", types.of(*value))
        }
        FunctionError::InvalidStoreTypes { pointer, value } => format!(
            "{} cannot be assigned to {}",
            types.of(*value),
            types.of(*pointer)
        ),
        FunctionError::InvalidCall { function, error } => {
            let called = module.functions[*function].name.as_deref();
            return call(&types, called.unwrap_or("the function"), error, *function);
        }
        FunctionError::MissingCapability(missing) => return missing_capability(*missing),
        FunctionError::BreakOutsideOfLoopOrSwitch => {
            "`break` outside of a loop or `switch`".to_owned()
        }
        FunctionError::ContinueOutsideOfLoop => "`continue` outside of a loop".to_owned(),
        FunctionError::InvalidStorePointer(_) => {
            let help = match words {
                Words::Wgsl => "assign to `var`s, and to storage buffers that are `read_write`",
                Words::Glsl => {
                    "inputs, uniforms and constants are read only: copy them to a variable"
                }
            };
            return (
                "this cannot be assigned to".to_owned(),
                Some(help.to_owned()),
            );
        }
        FunctionError::InvalidArgumentType { name, .. } => {
            format!("parameter `{name}` has a type that functions do not take")
        }
        FunctionError::InvalidArgumentPointerSpace { name, .. } => format!(
            "parameter `{name}` is a pointer to memory of another kind than `function`, `private` \
             and `workgroup`"
        ),
        FunctionError::ConflictingSwitchCase(value) => {
            let value = match value {
                naga::SwitchValue::I32(value) => value.to_string(),
                naga::SwitchValue::U32(value) => format!("{value}u"),
                _ => "default".to_owned(),
            };
            format!("`switch` has the case {value} more than once")
        }
        other => words.chain(other),
    };
    (message, None)
}

fn missing_capability(missing: naga::valid::Capabilities) -> Message {
    (not_supported(missing), None)
}

/// That something is not supported.
pub(super) fn not_supported(missing: naga::valid::Capabilities) -> String {
    let what = capability(missing);
    let verb = if what.ends_with('s') { "are" } else { "is" };
    format!("{what} {verb} not supported")
}

fn call(types: &Types<'_>, name: &str, error: &CallError, function: Handle<Function>) -> Message {
    let message = match error {
        CallError::ArgumentCount { required, seen } => {
            let (plural, verb) = (plural(*required), verb(*seen));
            format!("`{name}` takes {required} argument{plural}, but {seen} {verb} given")
        }
        CallError::ArgumentType {
            index,
            required,
            seen_expression,
        } => {
            let argument = types.module.functions[function].arguments.get(*index);
            let argument = argument.and_then(|argument| argument.name.as_deref());
            let which = match argument {
                Some(argument) => format!("argument `{argument}`"),
                None => format!("argument {}", index + 1),
            };
            let required = types.words.type_name(types.module, *required);
            let seen = types.of(*seen_expression);
            match required == seen {
                true => format!("{which} of `{name}` points to memory of another kind"),
                false => format!("{which} of `{name}` is {required}, but {seen} is given"),
            }
        }
        other => format!("call of `{name}`: {}", types.words.chain(other)),
    };
    (message, None)
}

fn expression(types: &Types<'_>, value: Handle<Expression>, error: &ExpressionError) -> Message {
    let words = types.words;
    let message = match error {
        ExpressionError::InvalidBinaryOperandTypes {
            op,
            lhs_type,
            rhs_type,
            ..
        } => format!(
            "`{}` does not work with {} and {}",
            operator(*op),
            words.inner_name(types.module, lhs_type),
            words.inner_name(types.module, rhs_type)
        ),
        ExpressionError::InvalidUnaryOperandType(op, operand) => {
            let sign = match op {
                UnaryOperator::Negate => "-",
                UnaryOperator::LogicalNot => "!",
                UnaryOperator::BitwiseNot => "~",
            };
            format!("`{sign}` does not work with {}", types.of(*operand))
        }
        ExpressionError::SelectConditionNotABool { actual } => format!(
            "the condition is {}, not `bool`",
            words.inner_name(types.module, actual)
        ),
        ExpressionError::SelectValuesTypeMismatch { accept, reject } => format!(
            "both choices must have one type, but these are {} and {}",
            words.inner_name(types.module, accept),
            words.inner_name(types.module, reject)
        ),
        ExpressionError::Compose(compose) => compose_error(types, value, compose),
        ExpressionError::InvalidIndexType(index) => {
            format!("an index must be an integer, not {}", types.of(*index))
        }
        ExpressionError::IndexOutOfBounds(base, index) => {
            format!("index {index} is beyond the end of {}", types.of(*base))
        }
        ExpressionError::NegativeIndex(_) => "an index must not be negative".to_owned(),
        ExpressionError::InvalidBaseType(base) => {
            format!("{} has no elements or members", types.of(*base))
        }
        ExpressionError::InvalidArgumentType(function, index, argument) => format!(
            "argument {} of `{}` must not be {}",
            index + 1,
            function_name(&format!("{function:?}")),
            types.of(*argument)
        ),
        ExpressionError::WrongArgumentCount(function) => format!(
            "`{}` is called with a wrong number of arguments",
            function_name(&format!("{function:?}"))
        ),
        ExpressionError::InvalidImageCoordinateType(_, coordinate) => format!(
            "the texture's coordinates must not be {}",
            types.of(*coordinate)
        ),
        ExpressionError::ComparisonSamplingMismatch { .. } => {
            "a comparison takes a depth texture, a comparison sampler and a reference; \
             other sampling takes none of them"
                .to_owned()
        }
        ExpressionError::InvalidDerivative => {
            "derivatives are taken of floating-point scalars and vectors only".to_owned()
        }
        ExpressionError::MissingCapabilities(missing) => return missing_capability(*missing),
        other => words.chain(other),
    };
    (message, None)
}

fn compose_error(types: &Types<'_>, value: Handle<Expression>, error: &ComposeError) -> String {
    let built = types.of(value);
    match error {
        ComposeError::Type(_) => format!("{built} cannot be built from values"),
        ComposeError::ComponentCount { given, expected } => {
            let (plural, verb) = (plural(*expected as usize), verb(*given as usize));
            format!("{built} is built from {expected} component{plural}, but {given} {verb} given")
        }
        ComposeError::ComponentType { index } => {
            let part = match &types.function.expressions[value] {
                Expression::Compose { components, .. } => components.get(*index as usize),
                _ => None,
            };
            let part = part.map_or_else(|| "this".to_owned(), |part| types.of(*part));
            format!("argument {} of {built} must not be {part}", index + 1)
        }
    }
}

/// The ending of the plural.
fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

fn verb(count: usize) -> &'static str {
    if count == 1 { "is" } else { "are" }
}

/// A function's name from naga's: `InverseSqrt` becomes `inverseSqrt`.
fn function_name(name: &str) -> String {
    plain(name)
}

fn operator(operator: BinaryOperator) -> &'static str {
    match operator {
        BinaryOperator::Add => "+",
        BinaryOperator::Subtract => "-",
        BinaryOperator::Multiply => "*",
        BinaryOperator::Divide => "/",
        BinaryOperator::Modulo => "%",
        BinaryOperator::Equal => "==",
        BinaryOperator::NotEqual => "!=",
        BinaryOperator::Less => "<",
        BinaryOperator::LessEqual => "<=",
        BinaryOperator::Greater => ">",
        BinaryOperator::GreaterEqual => ">=",
        BinaryOperator::And => "&",
        BinaryOperator::ExclusiveOr => "^",
        BinaryOperator::InclusiveOr => "|",
        BinaryOperator::LogicalAnd => "&&",
        BinaryOperator::LogicalOr => "||",
        BinaryOperator::ShiftLeft => "<<",
        BinaryOperator::ShiftRight => ">>",
    }
}

/// The types of a function's expressions, as text.
struct Types<'a> {
    module: &'a Module,
    function: &'a Function,
    words: Words,
}

impl Types<'_> {
    /// The name of an expression's type. For a pointer, that of what it points to.
    fn of(&self, value: Handle<Expression>) -> String {
        let context = ResolveContext::with_locals(
            self.module,
            &self.function.local_variables,
            &self.function.arguments,
        );
        let mut types = Typifier::new();
        match types.grow(value, &self.function.expressions, &context) {
            Ok(()) => {
                let inner: &TypeInner = types.get(value, &self.module.types);
                match types_handle(&types, value) {
                    Some(ty) => self.words.type_name(self.module, ty),
                    None => self.words.inner_name(self.module, inner),
                }
            }
            Err(_) => "a value of unknown type".to_owned(),
        }
    }
}

fn types_handle(types: &Typifier, value: Handle<Expression>) -> Option<Handle<naga::Type>> {
    types[value].handle()
}
