//! Programs evaluated by the rules of WGSL, for one invocation.

use crate::program::{
    Binary, Expression, FIRST_OWN, PRIVATE_ARRAY, PRIVATE_NUMBER, Place, Program, Statement, Type,
    Unary, Value,
};
use std::collections::HashMap;

/// How a statement ends.
enum Flow {
    Next,
    Break,
    Continue,
    Return(Value),
}

type Variables = HashMap<usize, Vec<Value>>;

struct Evaluation<'a> {
    program: &'a Program,
    /// The inputs, and what is private.
    globals: Variables,
    /// The variables of each call.
    calls: Vec<Variables>,
    /// Which statements ran.
    seen: &'a mut Seen,
}

/// How often what happened.
#[derive(Debug, Default)]
pub(crate) struct Seen {
    pub(crate) breaks: u32,
    pub(crate) continues: u32,
    pub(crate) early_returns: u32,
    pub(crate) lazy: u32,
    pub(crate) calls: u32,
    pub(crate) cases: u32,
    pub(crate) steps: u32,
}

/// The words of the colour of a fragment with these varyings. `None` if it takes too long.
pub(crate) fn evaluate(program: &Program, inputs: [f32; 4], seen: &mut Seen) -> Option<[u32; 4]> {
    let [x, y, z, w] = inputs;
    let zero = Value::I32(0);
    let globals = [
        (0, vec![Value::I32(to_i32(x))]),
        (1, vec![Value::U32(to_i32(y).cast_unsigned())]),
        (2, vec![Value::F32(z)]),
        (3, vec![Value::Bool(w > 0.0)]),
        (PRIVATE_NUMBER, vec![zero]),
        (PRIVATE_ARRAY, vec![zero; 4]),
    ];
    let mut evaluation = Evaluation {
        program,
        globals: globals.into(),
        calls: vec![Variables::new()],
        seen,
    };
    evaluation.all(&program.main)?;
    let mut words = [0; 4];
    for (word, (_, output)) in words.iter_mut().zip(&program.outputs) {
        *word = match evaluation.value(output)? {
            Value::F32(number) if number.is_nan() => 1,
            Value::F32(number) => number.to_bits(),
            other => bits(other),
        };
    }
    Some(words)
}

/// Steps after which an evaluation is given up.
const MOST_STEPS: u32 = 200_000;

#[expect(clippy::cast_possible_truncation, reason = "the number is clamped")]
/// WGSL clamps to the numbers that both types have; NaN gives 0.
fn to_i32(number: f32) -> i32 {
    if number.is_nan() {
        0
    } else {
        number.min(2_147_483_520.0) as i32
    }
}

/// See [`to_i32`].
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the number is clamped"
)]
fn to_u32(number: f32) -> u32 {
    if number.is_nan() {
        0
    } else {
        number.min(4_294_967_040.0) as u32
    }
}

fn bits(value: Value) -> u32 {
    match value {
        Value::I32(number) => number.cast_unsigned(),
        Value::U32(number) => number,
        Value::F32(number) => number.to_bits(),
        Value::Bool(is_true) => is_true.into(),
    }
}

fn is_true(value: Value) -> bool {
    value == Value::Bool(true)
}

impl Evaluation<'_> {
    fn variable(&mut self, at: usize) -> &mut Vec<Value> {
        let variables = if at < FIRST_OWN {
            &mut self.globals
        } else {
            self.calls.last_mut().expect("a call")
        };
        variables.entry(at).or_default()
    }

    fn all(&mut self, statements: &[Statement]) -> Option<Flow> {
        for statement in statements {
            match self.statement(statement)? {
                Flow::Next => {}
                flow => return Some(flow),
            }
        }
        Some(Flow::Next)
    }

    fn statement(&mut self, statement: &Statement) -> Option<Flow> {
        self.seen.steps += 1;
        if self.seen.steps > MOST_STEPS {
            return None;
        }
        match statement {
            Statement::Declare(at, _, values) => {
                let values: Option<Vec<_>> = values.iter().map(|value| self.value(value)).collect();
                *self.variable(*at) = values?;
            }
            Statement::Let(at, value) => {
                let value = self.value(value)?;
                *self.variable(*at) = vec![value];
            }
            Statement::Assign(place, value) => {
                let (at, index) = self.place(place)?;
                let value = self.value(value)?;
                self.variable(at)[index] = value;
            }
            Statement::Compound(place, sign, value) => {
                let (at, index) = self.place(place)?;
                let before = self.variable(at)[index];
                let value = self.value(value)?;
                self.variable(at)[index] = binary(*sign, before, value);
            }
            Statement::If(condition, yes, no) => {
                let way = if is_true(self.value(condition)?) {
                    yes
                } else {
                    no
                };
                return self.all(way);
            }
            Statement::Loop {
                counter,
                most,
                body,
                continuing,
                break_if,
            } => {
                for _ in 0..*most {
                    match self.all(body)? {
                        Flow::Return(value) => return Some(Flow::Return(value)),
                        Flow::Break => break,
                        Flow::Next | Flow::Continue => {}
                    }
                    self.all(continuing)?;
                    if let Some(condition) = break_if
                        && is_true(self.value(condition)?)
                    {
                        break;
                    }
                }
                let _ = counter;
            }
            Statement::For(at, end, body) => {
                *self.variable(*at) = vec![Value::I32(0)];
                loop {
                    let Value::I32(end) = self.value(end)? else {
                        unreachable!("an i32");
                    };
                    let Value::I32(now) = self.variable(*at)[0] else {
                        unreachable!("an i32");
                    };
                    if now >= end & 3 {
                        break;
                    }
                    match self.all(body)? {
                        Flow::Return(value) => return Some(Flow::Return(value)),
                        Flow::Break => break,
                        Flow::Next | Flow::Continue => {}
                    }
                    *self.variable(*at) = vec![Value::I32(now + 1)];
                }
            }
            Statement::While(_, condition, body) => {
                for _ in 0..3 {
                    if !is_true(self.value(condition)?) {
                        break;
                    }
                    match self.all(body)? {
                        Flow::Return(value) => return Some(Flow::Return(value)),
                        Flow::Break => break,
                        Flow::Next | Flow::Continue => {}
                    }
                }
            }
            Statement::Switch(selector, cases, default) => {
                let Value::I32(selector) = self.value(selector)? else {
                    unreachable!("an i32");
                };
                self.seen.cases += 1;
                let case = cases
                    .iter()
                    .find(|(selectors, _)| selectors.contains(&selector));
                let (_, body) = case.unwrap_or(&cases[*default]);
                return Some(match self.all(body)? {
                    Flow::Break => Flow::Next,
                    flow => flow,
                });
            }
            Statement::Break => {
                self.seen.breaks += 1;
                return Some(Flow::Break);
            }
            Statement::Continue => {
                self.seen.continues += 1;
                return Some(Flow::Continue);
            }
            Statement::Return(value) => return Some(Flow::Return(self.value(value)?)),
            Statement::Block(body) => return self.all(body),
        }
        Some(Flow::Next)
    }

    /// The variable and the element.
    fn place(&mut self, place: &Place) -> Option<(usize, usize)> {
        Some(match place {
            Place::Variable(at) | Place::Pointee(at) => (*at, 0),
            Place::Element(at, ty, index) => (*at, self.index(index, *ty)?),
        })
    }

    fn index(&mut self, index: &Expression, ty: Type) -> Option<usize> {
        Some((bits(self.value(index)?) % ty.len()) as usize)
    }

    fn value(&mut self, expression: &Expression) -> Option<Value> {
        Some(match expression {
            Expression::Literal(value) => *value,
            Expression::Variable(at) => self.variable(*at)[0],
            Expression::Element(at, ty, index) => {
                let index = self.index(index, *ty)?;
                self.variable(*at)[index]
            }
            Expression::Unary(kind, a) => unary(*kind, self.value(a)?),
            Expression::Binary(sign @ (Binary::LazyAnd | Binary::LazyOr), operands) => {
                let first = self.value(&operands[0])?;
                if is_true(first) == (*sign == Binary::LazyOr) {
                    self.seen.lazy += 1;
                    first
                } else {
                    self.value(&operands[1])?
                }
            }
            Expression::Binary(sign, operands) => {
                let a = self.value(&operands[0])?;
                binary(*sign, a, self.value(&operands[1])?)
            }
            Expression::Select(operands) => {
                let [no, yes, condition] = &**operands;
                let (no, yes) = (self.value(no)?, self.value(yes)?);
                if is_true(self.value(condition)?) {
                    yes
                } else {
                    no
                }
            }
            Expression::Convert(ty, a) => convert(*ty, self.value(a)?),
            Expression::Call(function, values, pointer) => {
                self.call(*function, values, *pointer)?
            }
        })
    }

    fn call(&mut self, number: usize, values: &[Expression], pointer: usize) -> Option<Value> {
        self.seen.calls += 1;
        let function = &self.program.functions[number];
        let mut variables = Variables::new();
        for ((at, _), value) in function.parameters.iter().zip(values) {
            variables.insert(*at, vec![self.value(value)?]);
        }
        let pointee = self.variable(pointer).clone();
        variables.insert(function.pointer, pointee);
        self.calls.push(variables);
        let mut result = None;
        for (at, statement) in function.body.iter().enumerate() {
            if let Flow::Return(value) = self.statement(statement)? {
                self.seen.early_returns += u32::from(at + 1 < function.body.len());
                result = Some(value);
                break;
            }
        }
        let mut variables = self.calls.pop().expect("it was pushed");
        let pointee = variables.remove(&function.pointer).expect("it is there");
        *self.variable(pointer) = pointee;
        Some(result.expect("a function ends with a return"))
    }
}

fn unary(kind: Unary, a: Value) -> Value {
    match (kind, a) {
        (Unary::Negate, Value::I32(a)) => Value::I32(a.wrapping_neg()),
        (Unary::Negate, Value::F32(a)) => Value::F32(-a),
        (Unary::Complement, Value::I32(a)) => Value::I32(!a),
        (Unary::Complement, Value::U32(a)) => Value::U32(!a),
        (Unary::Not, Value::Bool(a)) => Value::Bool(!a),
        (Unary::Abs, Value::I32(a)) => Value::I32(a.wrapping_abs()),
        (Unary::Abs, Value::F32(a)) => Value::F32(a.abs()),
        (Unary::Floor, Value::F32(a)) => Value::F32(a.floor()),
        (Unary::Sqrt, Value::F32(a)) => Value::F32(a.sqrt()),
        other => unreachable!("{other:?}"),
    }
}

fn binary(sign: Binary, a: Value, b: Value) -> Value {
    match (a, b) {
        (Value::I32(a), Value::I32(b)) => of_i32(sign, a, b),
        (Value::U32(a), Value::U32(b)) => of_u32(sign, a, b),
        (Value::I32(a), Value::U32(b)) => match sign {
            Binary::ShiftLeft => Value::I32(a.wrapping_shl(b)),
            Binary::ShiftRight => Value::I32(a.wrapping_shr(b)),
            _ => unreachable!("{sign:?}"),
        },
        (Value::F32(a), Value::F32(b)) => match sign {
            Binary::Add => Value::F32(a + b),
            Binary::Subtract => Value::F32(a - b),
            Binary::Multiply => Value::F32(a * b),
            Binary::Divide => Value::F32(a / b),
            #[expect(clippy::float_cmp, reason = "WGSL's equality")]
            Binary::Equal => Value::Bool(a == b),
            Binary::Less => Value::Bool(a < b),
            _ => unreachable!("{sign:?}"),
        },
        (Value::Bool(a), Value::Bool(b)) => Value::Bool(match sign {
            Binary::And => a & b,
            Binary::Or => a | b,
            Binary::Equal => a == b,
            _ => unreachable!("{sign:?}"),
        }),
        other => unreachable!("{other:?}"),
    }
}

fn of_i32(sign: Binary, a: i32, b: i32) -> Value {
    Value::I32(match sign {
        Binary::Add => a.wrapping_add(b),
        Binary::Subtract => a.wrapping_sub(b),
        Binary::Multiply => a.wrapping_mul(b),
        // x ÷ 0 is x, and so is the least number ÷ −1; the remainders are 0.
        Binary::Divide => a.checked_div(b).unwrap_or(a),
        Binary::Remainder => a.checked_rem(b).unwrap_or(0),
        Binary::And => a & b,
        Binary::Or => a | b,
        Binary::Xor => a ^ b,
        Binary::Equal => return Value::Bool(a == b),
        Binary::Less => return Value::Bool(a < b),
        _ => unreachable!("{sign:?}"),
    })
}

fn of_u32(sign: Binary, a: u32, b: u32) -> Value {
    Value::U32(match sign {
        Binary::Add => a.wrapping_add(b),
        Binary::Subtract => a.wrapping_sub(b),
        Binary::Multiply => a.wrapping_mul(b),
        Binary::Divide => a.checked_div(b).unwrap_or(a),
        Binary::Remainder => a.checked_rem(b).unwrap_or(0),
        Binary::And => a & b,
        Binary::Or => a | b,
        Binary::Xor => a ^ b,
        Binary::ShiftLeft => a.wrapping_shl(b),
        Binary::ShiftRight => a.wrapping_shr(b),
        Binary::Equal => return Value::Bool(a == b),
        Binary::Less => return Value::Bool(a < b),
        _ => unreachable!("{sign:?}"),
    })
}

fn convert(ty: Type, a: Value) -> Value {
    match (ty, a) {
        (Type::I32, Value::F32(a)) => Value::I32(to_i32(a)),
        (Type::U32, Value::F32(a)) => Value::U32(to_u32(a)),
        (Type::I32, other) => Value::I32(bits(other).cast_signed()),
        (Type::U32, other) => Value::U32(bits(other)),
        (Type::F32, Value::I32(a)) => Value::F32(a as f32),
        (Type::F32, Value::U32(a)) => Value::F32(a as f32),
        (Type::F32, Value::Bool(a)) => Value::F32(if a { 1.0 } else { 0.0 }),
        (Type::Bool, Value::F32(a)) => Value::Bool(a != 0.0),
        (Type::Bool, other) => Value::Bool(bits(other) != 0),
        (_, other) => other,
    }
}
