//! Small programs: what is written as WGSL, and what is evaluated.

/// The type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Type {
    I32,
    U32,
    F32,
    Bool,
    /// `array<i32, 4>`.
    Array,
    /// `vec3f`.
    Vector,
}

/// The types of expressions.
pub(crate) const SCALARS: [Type; 4] = [Type::I32, Type::U32, Type::F32, Type::Bool];

/// A number or a truth value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Value {
    I32(i32),
    U32(u32),
    F32(f32),
    Bool(bool),
}

/// An operator or function of one operand, of the operand's type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unary {
    Negate,
    Complement,
    Not,
    Abs,
    Floor,
    Sqrt,
}

/// An operator of two operands of one type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    And,
    Or,
    Xor,
    /// By an amount below 32, a `u32`.
    ShiftLeft,
    ShiftRight,
    Equal,
    Less,
    /// `&&` and `||`, whose second operand may not be evaluated.
    LazyAnd,
    LazyOr,
}

/// An expression of a scalar type.
#[derive(Debug, Clone)]
pub(crate) enum Expression {
    Literal(Value),
    Variable(usize),
    /// An element of an array or a vector: the index is a `u32`, taken modulo the length.
    Element(usize, Type, Box<Self>),
    Unary(Unary, Box<Self>),
    Binary(Binary, Box<[Self; 2]>),
    /// `select(if_false, if_true, condition)`.
    Select(Box<[Self; 3]>),
    /// A conversion to a type.
    Convert(Type, Box<Self>),
    /// A call of a function: its values, and the `i32` variable to which it gets a pointer.
    Call(usize, Vec<Self>, usize),
}

/// What is assigned to.
#[derive(Debug, Clone)]
pub(crate) enum Place {
    Variable(usize),
    Element(usize, Type, Expression),
    /// What the pointer, a function's last parameter, points to.
    Pointee(usize),
}

#[derive(Debug, Clone)]
pub(crate) enum Statement {
    /// `var`: of an array or a vector one expression for each element.
    Declare(usize, Type, Vec<Expression>),
    /// `let`.
    Let(usize, Expression),
    Assign(Place, Expression),
    /// `+=` and the like.
    Compound(Place, Binary, Expression),
    If(Expression, Vec<Self>, Vec<Self>),
    /// A loop that its own counter ends, after so many iterations.
    Loop {
        counter: usize,
        most: i32,
        body: Vec<Self>,
        continuing: Vec<Self>,
        break_if: Option<Expression>,
    },
    /// `for` over a new variable, up to an `i32` of which the lowest bits count.
    For(usize, Expression, Vec<Self>),
    /// `while`, with a counter of its own.
    While(usize, Expression, Vec<Self>),
    /// Cases of one or more selectors; the one at the number is the default, too.
    Switch(Expression, Vec<(Vec<i32>, Vec<Self>)>, usize),
    Break,
    Continue,
    Return(Expression),
    Block(Vec<Self>),
}

/// A function of scalars and, last, a pointer to an `i32`.
#[derive(Debug, Clone)]
pub(crate) struct Function {
    pub(crate) parameters: Vec<(usize, Type)>,
    pub(crate) pointer: usize,
    pub(crate) result: Type,
    /// It ends with a return.
    pub(crate) body: Vec<Statement>,
}

/// A fragment shader. Variables 0 to 3 are its inputs, an `i32`, a `u32`, an `f32` and a `bool`;
/// 4 is a private `i32`, 5 a private `array<i32, 4>`; both are zeros at first.
#[derive(Debug, Clone)]
pub(crate) struct Program {
    /// Each calls only those before it.
    pub(crate) functions: Vec<Function>,
    pub(crate) main: Vec<Statement>,
    /// The results, all of a scalar type.
    pub(crate) outputs: [(Type, Expression); 4],
}

pub(crate) const PRIVATE_NUMBER: usize = 4;
pub(crate) const PRIVATE_ARRAY: usize = 5;
/// The first variable that a program declares.
pub(crate) const FIRST_OWN: usize = 6;

impl Type {
    /// The number of elements of an array or a vector.
    pub(crate) fn len(self) -> u32 {
        match self {
            Self::Array => 4,
            Self::Vector => 3,
            _ => 1,
        }
    }

    /// The type of the elements.
    pub(crate) fn element(self) -> Self {
        match self {
            Self::Array => Self::I32,
            Self::Vector => Self::F32,
            scalar => scalar,
        }
    }
}
