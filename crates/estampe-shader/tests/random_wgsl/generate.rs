//! Random programs, which end.

use crate::program::{
    Binary, Expression, FIRST_OWN, Function, PRIVATE_ARRAY, PRIVATE_NUMBER, Place, Program,
    SCALARS, Statement, Type, Unary, Value,
};
use fastrand::Rng;

/// A variable that can be seen.
#[derive(Debug, Clone, Copy)]
struct Variable {
    at: usize,
    ty: Type,
    is_mutable: bool,
}

struct Generator<'a> {
    random: &'a mut Rng,
    next: usize,
    visible: Vec<Variable>,
    functions: Vec<Function>,
    /// The parameter that is a pointer, in a function.
    pointer: Option<usize>,
    /// The type of the function's result; none in the entry point.
    result: Option<Type>,
    /// The loops and switches around, innermost last; true for loops.
    breakable: Vec<bool>,
    in_continuing: bool,
    /// Statements that may still be made.
    left: u32,
}

pub(crate) fn program(random: &mut Rng) -> Program {
    let mut generator = Generator {
        random,
        next: FIRST_OWN,
        visible: Vec::new(),
        functions: Vec::new(),
        pointer: None,
        result: None,
        breakable: Vec::new(),
        in_continuing: false,
        left: 0,
    };
    for _ in 0..generator.random.usize(0..4) {
        let function = generator.function();
        generator.functions.push(function);
    }
    generator.pointer = None;
    generator.result = None;
    generator.visible = globals();
    for (at, ty) in SCALARS.into_iter().enumerate() {
        generator.visible.push(Variable {
            at,
            ty,
            is_mutable: false,
        });
    }
    generator.left = 40;
    let pointee = generator.declare(Type::I32);
    let mut main = vec![pointee];
    main.extend(generator.statements(12));
    let outputs = std::array::from_fn(|_| {
        let ty = SCALARS[generator.random.usize(..4)];
        (ty, generator.expression(ty, 3))
    });
    Program {
        functions: generator.functions,
        main,
        outputs,
    }
}

fn globals() -> Vec<Variable> {
    [(PRIVATE_NUMBER, Type::I32), (PRIVATE_ARRAY, Type::Array)]
        .map(|(at, ty)| Variable {
            at,
            ty,
            is_mutable: true,
        })
        .into()
}

impl Generator<'_> {
    fn new_variable(&mut self, ty: Type, is_mutable: bool) -> usize {
        let at = self.next;
        self.next += 1;
        self.visible.push(Variable { at, ty, is_mutable });
        at
    }

    fn function(&mut self) -> Function {
        self.visible = globals();
        let parameters: Vec<_> = (0..self.random.usize(0..3))
            .map(|_| {
                let ty = self.scalar();
                (self.new_variable(ty, false), ty)
            })
            .collect();
        let pointer = self.next;
        self.next += 1;
        let result = self.scalar();
        (self.pointer, self.result, self.left) = (Some(pointer), Some(result), 12);
        let own = self.declare(Type::I32);
        let mut body = vec![own];
        body.extend(self.statements(6));
        if !ends(&body) {
            body.push(Statement::Return(self.expression(result, 2)));
        }
        Function {
            parameters,
            pointer,
            result,
            body,
        }
    }

    fn scalar(&mut self) -> Type {
        SCALARS[self.random.usize(..4)]
    }

    fn declare(&mut self, ty: Type) -> Statement {
        let count = ty.len() as usize;
        let values = (0..count)
            .map(|_| self.expression(ty.element(), 2))
            .collect();
        Statement::Declare(self.new_variable(ty, true), ty, values)
    }

    /// Statements of a block. What they declare is not seen after it.
    fn statements(&mut self, most: usize) -> Vec<Statement> {
        let count = self.random.usize(1..=most);
        let mut all = Vec::new();
        for _ in 0..count {
            if self.left == 0 || ends(&all) {
                break;
            }
            self.left -= 1;
            let statement = self.statement();
            all.push(statement);
        }
        all
    }

    fn block(&mut self, most: usize) -> Vec<Statement> {
        let seen = self.visible.len();
        let all = self.statements(most);
        self.visible.truncate(seen);
        all
    }

    fn statement(&mut self) -> Statement {
        let depth = self.breakable.len();
        match self.random.u32(0..20) {
            0 | 1 => {
                let types = [
                    Type::I32,
                    Type::U32,
                    Type::F32,
                    Type::Bool,
                    Type::Array,
                    Type::Vector,
                ];
                let ty = types[self.random.usize(..6)];
                self.declare(ty)
            }
            2 | 3 => {
                let ty = self.scalar();
                let value = self.expression(ty, 3);
                Statement::Let(self.new_variable(ty, false), value)
            }
            4..=6 => {
                let condition = self.expression(Type::Bool, 3);
                let yes = self.block(4);
                let no = if self.random.bool() {
                    self.block(4)
                } else {
                    Vec::new()
                };
                Statement::If(condition, yes, no)
            }
            7 if depth < 3 => self.loop_statement(),
            8 if depth < 3 => {
                let end = self.expression(Type::I32, 2);
                let seen = self.visible.len();
                let at = self.new_variable(Type::I32, false);
                let body = self.in_loop(4);
                self.visible.truncate(seen);
                Statement::For(at, end, body)
            }
            9 if depth < 3 => {
                let condition = self.expression(Type::Bool, 2);
                let counter = self.next;
                self.next += 1;
                Statement::While(counter, condition, self.in_loop(4))
            }
            10 | 11 if depth < 3 => self.switch(),
            12 if depth > 0 && !self.in_continuing => Statement::Break,
            13 if self.breakable.contains(&true) && !self.in_continuing => Statement::Continue,
            14 if self.result.is_some() && !self.in_continuing => {
                let result = self.result.expect("it is some");
                Statement::Return(self.expression(result, 2))
            }
            15 => Statement::Block(self.block(3)),
            _ => self.assignment(),
        }
    }

    fn in_loop(&mut self, most: usize) -> Vec<Statement> {
        self.breakable.push(true);
        let body = self.block(most);
        self.breakable.pop();
        body
    }

    fn loop_statement(&mut self) -> Statement {
        let counter = self.next;
        self.next += 1;
        let body = self.in_loop(5);
        let was = std::mem::replace(&mut self.in_continuing, true);
        // `continue` and `break` of what is around do not leave it.
        let around = std::mem::take(&mut self.breakable);
        let continuing: Vec<_> = (0..self.random.usize(0..3))
            .map(|_| self.assignment())
            .collect();
        let break_if = self.random.bool().then(|| self.expression(Type::Bool, 2));
        self.breakable = around;
        self.in_continuing = was;
        Statement::Loop {
            counter,
            most: self.random.i32(1..4),
            body,
            continuing,
            break_if,
        }
    }

    fn switch(&mut self) -> Statement {
        let selector = self.expression(Type::I32, 2);
        let count = self.random.usize(1..4);
        self.breakable.push(false);
        let cases: Vec<_> = (0..count)
            .map(|case| {
                let case = i32::try_from(case).expect("a few") * 2 - 1;
                let selectors = if self.random.bool() {
                    vec![case]
                } else {
                    vec![case, case + 1]
                };
                (selectors, self.block(3))
            })
            .collect();
        self.breakable.pop();
        Statement::Switch(selector, cases, self.random.usize(..count))
    }

    fn assignment(&mut self) -> Statement {
        let mutable: Vec<_> = self
            .visible
            .iter()
            .filter(|one| one.is_mutable)
            .copied()
            .collect();
        let (place, ty) = match self.pointer {
            Some(pointer) if self.random.u32(0..4) == 0 => (Place::Pointee(pointer), Type::I32),
            _ => {
                let variable = mutable[self.random.usize(..mutable.len())];
                match variable.ty {
                    Type::Array | Type::Vector => {
                        let index = self.expression(Type::U32, 2);
                        let place = Place::Element(variable.at, variable.ty, index);
                        (place, variable.ty.element())
                    }
                    ty => (Place::Variable(variable.at), ty),
                }
            }
        };
        let signs: &[Binary] = match ty {
            Type::I32 | Type::U32 => &[
                Binary::Add,
                Binary::Subtract,
                Binary::Multiply,
                Binary::And,
                Binary::Xor,
            ],
            Type::F32 => &[Binary::Add, Binary::Subtract, Binary::Multiply],
            _ => &[],
        };
        if !signs.is_empty() && self.random.u32(0..3) == 0 {
            let sign = signs[self.random.usize(..signs.len())];
            return Statement::Compound(place, sign, self.expression(ty, 2));
        }
        Statement::Assign(place, self.expression(ty, 3))
    }

    fn literal(&mut self, ty: Type) -> Expression {
        let random = &mut self.random;
        Expression::Literal(match ty {
            Type::I32 => Value::I32([-2, 1, 2, 7, 1000, i32::MAX, -i32::MAX][random.usize(..7)]),
            Type::U32 => Value::U32([1, 2, 3, 31, 0x8000_0000, u32::MAX][random.usize(..6)]),
            Type::F32 => Value::F32([0.5, -1.0, 3.25, 1e-3, 1e9][random.usize(..5)]),
            _ => Value::Bool(random.bool()),
        })
    }

    /// A variable of a type, or a conversion of one.
    fn leaf(&mut self, ty: Type) -> Expression {
        let all: Vec<_> = self
            .visible
            .iter()
            .filter(|one| one.ty.element() == ty)
            .copied()
            .collect();
        if !all.is_empty() {
            let variable = all[self.random.usize(..all.len())];
            return match variable.ty {
                Type::Array | Type::Vector => {
                    let index = Expression::Literal(Value::U32(self.random.u32(0..4)));
                    Expression::Element(variable.at, variable.ty, Box::new(index))
                }
                _ => Expression::Variable(variable.at),
            };
        }
        Expression::Convert(ty, Box::new(Expression::Variable(PRIVATE_NUMBER)))
    }

    /// An expression that is no constant.
    fn expression(&mut self, ty: Type, depth: u32) -> Expression {
        if depth == 0 || self.random.u32(0..5) == 0 {
            return self.leaf(ty);
        }
        match self.random.u32(0..10) {
            0 => {
                let from = self.scalar();
                Expression::Convert(ty, Box::new(self.expression(from, depth - 1)))
            }
            1 => {
                let [no, yes] = [0, 1].map(|_| self.expression(ty, depth - 1));
                let condition = self.expression(Type::Bool, depth - 1);
                Expression::Select(Box::new([no, yes, condition]))
            }
            2 => self.call(ty).unwrap_or_else(|| self.leaf(ty)),
            3 => {
                let kinds: &[Unary] = match ty {
                    Type::I32 => &[Unary::Negate, Unary::Complement, Unary::Abs],
                    Type::U32 => &[Unary::Complement],
                    Type::F32 => &[Unary::Negate, Unary::Abs, Unary::Floor, Unary::Sqrt],
                    _ => &[Unary::Not],
                };
                let kind = kinds[self.random.usize(..kinds.len())];
                Expression::Unary(kind, Box::new(self.expression(ty, depth - 1)))
            }
            4 => {
                let of = self.visible.iter().filter(|one| one.ty.element() == ty);
                let wide: Vec<_> = of.filter(|one| one.ty.len() > 1).copied().collect();
                if wide.is_empty() {
                    return self.leaf(ty);
                }
                let variable = wide[self.random.usize(..wide.len())];
                let index = self.expression(Type::U32, depth - 1);
                Expression::Element(variable.at, variable.ty, Box::new(index))
            }
            _ => self.binary(ty, depth),
        }
    }

    fn binary(&mut self, ty: Type, depth: u32) -> Expression {
        use Binary as B;
        let (signs, operands): (&[Binary], Type) = match ty {
            Type::I32 | Type::U32 => (
                &[
                    B::Add,
                    B::Subtract,
                    B::Multiply,
                    B::Divide,
                    B::Remainder,
                    B::And,
                    B::Or,
                    B::Xor,
                    B::ShiftLeft,
                    B::ShiftRight,
                ],
                ty,
            ),
            Type::F32 => (&[B::Add, B::Subtract, B::Multiply, B::Divide], ty),
            _ => match self.random.u32(0..3) {
                0 => (&[B::And, B::Or, B::Equal], Type::Bool),
                1 => (&[B::LazyAnd, B::LazyOr], Type::Bool),
                _ => (&[B::Equal, B::Less], SCALARS[self.random.usize(..3)]),
            },
        };
        let sign = signs[self.random.usize(..signs.len())];
        let shifts = matches!(sign, B::ShiftLeft | B::ShiftRight);
        let first = self.expression(operands, depth - 1);
        let of_second = if shifts { Type::U32 } else { operands };
        let second = if self.random.u32(0..3) == 0 && operands != Type::Bool {
            self.literal(of_second)
        } else {
            self.expression(of_second, depth - 1)
        };
        Expression::Binary(sign, Box::new([first, second]))
    }

    /// A call of a function with a result of this type.
    fn call(&mut self, ty: Type) -> Option<Expression> {
        let functions = self.functions.iter().enumerate();
        let fitting: Vec<_> = functions
            .filter(|(_, function)| function.result == ty)
            .map(|(number, function)| (number, function.parameters.clone()))
            .collect();
        let pointees = self.visible.iter();
        let pointees = pointees.filter(|one| one.is_mutable && one.ty == Type::I32);
        let own: Vec<_> = pointees
            .filter(|one| one.at >= FIRST_OWN)
            .copied()
            .collect();
        if fitting.is_empty() || own.is_empty() {
            return None;
        }
        let (number, parameters) = fitting[self.random.usize(..fitting.len())].clone();
        let values = parameters
            .iter()
            .map(|(_, ty)| self.expression(*ty, 1))
            .collect();
        Some(Expression::Call(
            number,
            values,
            own[self.random.usize(..own.len())].at,
        ))
    }
}

/// True if nothing after these statements is reached.
fn ends(statements: &[Statement]) -> bool {
    matches!(
        statements.last(),
        Some(Statement::Break | Statement::Continue | Statement::Return(_))
    )
}
