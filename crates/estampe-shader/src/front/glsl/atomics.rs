//! Atomic functions on buffers and shared memory, which naga's GLSL does not have.
//!
//! Each call becomes that of a function written for it with an `inout` parameter. naga makes of
//! such a call a copy to a local variable, the call, and a copy back: [`mend`] makes an atomic
//! statement of it on the place that the copy goes back to, whose type becomes an atomic one.

use naga::{
    AtomicFunction, Block, Expression, Function, Handle, Literal, Module, PredeclaredType, Range,
    Span, Statement, Type, TypeInner,
};
use std::collections::{HashMap, HashSet};

use super::super::validate;
use super::Fault;
use super::body::{Scopes, State};
use super::nesting::close;
use super::token::Token;
use super::unit::Unit;
use super::write::Writer;

/// GLSL 4.60, section 8.11.
const FUNCTIONS: [(&str, AtomicFunction); 7] = [
    ("atomicAdd", AtomicFunction::Add),
    ("atomicAnd", AtomicFunction::And),
    ("atomicOr", AtomicFunction::InclusiveOr),
    ("atomicXor", AtomicFunction::ExclusiveOr),
    ("atomicMin", AtomicFunction::Min),
    ("atomicMax", AtomicFunction::Max),
    ("atomicExchange", AtomicFunction::Exchange { compare: None }),
];

/// The function that stores a value where another one is.
const COMPARE_AND_SWAP: &str = "atomicCompSwap";

/// True for the atomic functions.
pub(super) fn is_atomic(unit: &Unit, name: &str) -> bool {
    let is_one = name == COMPARE_AND_SWAP || FUNCTIONS.iter().any(|(known, _)| *known == name);
    is_one && !unit.has_function(name)
}

/// The text of the functions that stand for those that a shader uses.
pub(super) fn functions(unit: &Unit) -> String {
    let is_used = |name: &str| unit.used.contains(name) && is_atomic(unit, name);
    let mut text = String::new();
    for number in ["int", "uint"] {
        for (name, _) in FUNCTIONS.iter().filter(|(name, _)| is_used(name)) {
            let name = written(unit, name);
            text.push_str(&format!(
                "{number} {name}(inout {number} m, {number} v) {{ return m; }} "
            ));
        }
        if is_used(COMPARE_AND_SWAP) {
            let name = written(unit, COMPARE_AND_SWAP);
            text.push_str(&format!(
                "{number} {name}(inout {number} m, {number} c, {number} v, uint place) \
                 {{ return m; }} "
            ));
        }
    }
    text
}

fn written(unit: &Unit, name: &str) -> String {
    format!("{}{name}", unit.prefix)
}

impl Writer<'_> {
    /// Writes the call of an atomic function, and gives where to go on.
    pub(super) fn atomic_call(
        &mut self,
        tokens: &[Token],
        at: usize,
        scopes: &mut Scopes,
        state: &mut State,
    ) -> Result<usize, Fault> {
        let place = Some(tokens[at].place);
        let name = written(self.unit, &tokens[at].text);
        self.names.add(&name, &tokens[at].text);
        let Some(end) = close(tokens, at + 1) else {
            self.output.put(&name, place);
            return Ok(at + 1);
        };
        self.output.put(&format!("{name} ("), place);
        state.open_own_call();
        self.rewrite_range(tokens, at + 2..end, scopes, state)?;
        state.close();
        // A number whose place among the expressions the result of the statement takes.
        let more = if tokens[at].is(COMPARE_AND_SWAP) {
            ", 0u )"
        } else {
            ")"
        };
        self.output.put(more, place);
        Ok(end + 1)
    }
}

/// Makes atomic statements of the calls.
pub(super) fn mend(module: &mut Module, unit: &Unit) -> Result<(), validate::Fault> {
    let mut atomics = HashMap::new();
    for (handle, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap_or_default();
        let Some(name) = name.strip_prefix(unit.prefix.as_str()) else {
            continue;
        };
        let result = function.result.as_ref().map(|result| result.ty);
        let known = FUNCTIONS.iter().find(|(known, _)| *known == name);
        let kind = known.map(|(_, kind)| Some(*kind));
        let kind = kind.or_else(|| (name == COMPARE_AND_SWAP).then_some(None));
        if let (Some(kind), Some(ty)) = (kind, result) {
            atomics.insert(handle, Atomic { kind, ty });
        }
    }
    if atomics.is_empty() {
        return Ok(());
    }
    let mut exchanges = HashMap::new();
    for atomic in atomics.values().filter(|atomic| atomic.kind.is_none()) {
        if let TypeInner::Scalar(scalar) = module.types[atomic.ty].inner {
            let ty = PredeclaredType::AtomicCompareExchangeWeakResult(scalar);
            exchanges.insert(atomic.ty, module.generate_predeclared_type(ty));
        }
    }
    let mut places = Vec::new();
    for (_, function) in module.functions.iter_mut() {
        let mut calls = Calls {
            atomics: &atomics,
            exchanges: &exchanges,
            places: &mut places,
        };
        let mut body = std::mem::take(&mut function.body);
        let mended = calls.block(function, &mut body);
        function.body = body;
        mended?;
    }
    for Place { global, path, span } in places {
        let ty = module.global_variables[global].ty;
        let ty = upgraded(module, ty, &path).ok_or_else(|| not_shared(span))?;
        module.global_variables[global].ty = ty;
    }
    Ok(())
}

fn not_shared(span: Span) -> validate::Fault {
    validate::Fault {
        message: "the first argument of an atomic function is a number of a buffer or of shared memory".to_owned(),
        help: Some("give a member of a buffer that is an `int` or `uint`, an element of an array of them, or a `shared` variable".to_owned()),
        spans: vec![span],
        entry_point: None,
    }
}

/// The type with an atomic number at the end of a path.
fn upgraded(module: &mut Module, ty: Handle<Type>, path: &[Part]) -> Option<Handle<Type>> {
    let Type { name, mut inner } = module.types[ty].clone();
    match (&mut inner, path) {
        (TypeInner::Atomic(_), []) => return Some(ty),
        (TypeInner::Scalar(scalar), []) => inner = TypeInner::Atomic(*scalar),
        (TypeInner::Struct { members, .. }, [Part::Member(index), rest @ ..]) => {
            let member = members.get_mut(*index as usize)?;
            member.ty = upgraded(module, member.ty, rest)?;
        }
        (TypeInner::Array { base, .. }, [_, rest @ ..]) => *base = upgraded(module, *base, rest)?,
        _ => return None,
    }
    let span = module.types.get_span(ty);
    Some(module.types.insert(Type { name, inner }, span))
}

/// A function that stands for an atomic one; `None` for that which compares.
struct Atomic {
    kind: Option<AtomicFunction>,
    ty: Handle<Type>,
}

/// A part of a place: a member of a structure, or the elements of an array.
#[derive(Clone, Copy)]
enum Part {
    Member(u32),
    Element,
}

/// A number on which an atomic function acts: its variable, and the way to it.
struct Place {
    global: Handle<naga::GlobalVariable>,
    path: Vec<Part>,
    span: Span,
}

struct Calls<'a> {
    atomics: &'a HashMap<Handle<Function>, Atomic>,
    /// The result of a comparison, by the type of its number.
    exchanges: &'a HashMap<Handle<Type>, Handle<Type>>,
    places: &'a mut Vec<Place>,
}

impl Calls<'_> {
    fn block(&mut self, function: &mut Function, block: &mut Block) -> Result<(), validate::Fault> {
        let statements: Vec<_> = std::mem::take(block).span_into_iter().collect();
        let mut left_out = HashSet::new();
        for (at, (statement, span)) in statements.iter().enumerate() {
            let mut statement = statement.clone();
            match &mut statement {
                Statement::Block(inner) => self.block(function, inner)?,
                Statement::If { accept, reject, .. } => {
                    self.block(function, accept)?;
                    self.block(function, reject)?;
                }
                Statement::Switch { cases, .. } => {
                    for case in cases {
                        self.block(function, &mut case.body)?;
                    }
                }
                Statement::Loop {
                    body, continuing, ..
                } => {
                    self.block(function, body)?;
                    self.block(function, continuing)?;
                }
                Statement::Call {
                    function: called,
                    arguments,
                    result: Some(result),
                } => {
                    if let Some(atomic) = self.atomics.get(called) {
                        let later = &statements[at + 1..];
                        let found = copied_back(function, arguments[0], later);
                        let (store, pointer) = found.ok_or_else(|| not_shared(*span))?;
                        left_out.insert(at + 1 + store);
                        let place = place(function, pointer, *span);
                        self.places.push(place.ok_or_else(|| not_shared(*span))?);
                        let values = (&arguments[..], *result);
                        self.statements((function, block), (atomic, pointer), values, *span);
                        continue;
                    }
                }
                _ => {}
            }
            if !left_out.contains(&at) {
                block.push(statement, *span);
            }
        }
        Ok(())
    }

    /// The statements of an atomic function.
    fn statements(
        &self,
        (function, block): (&mut Function, &mut Block),
        (atomic, pointer): (&Atomic, Handle<Expression>),
        (arguments, result): (&[Handle<Expression>], Handle<Expression>),
        span: Span,
    ) {
        let expressions = &mut function.expressions;
        if let Some(fun) = atomic.kind {
            expressions[result] = Expression::AtomicResult {
                ty: atomic.ty,
                comparison: false,
            };
            let statement = Statement::Atomic {
                pointer,
                fun,
                value: arguments[1],
                result: Some(result),
            };
            block.push(statement, span);
            return;
        }
        // The structure that naga's statement gives takes the place of the last argument, which
        // comes before the call's result, and that is its first member.
        let structure = arguments[3];
        debug_assert!(matches!(
            expressions[structure],
            Expression::Literal(Literal::U32(0))
        ));
        expressions[structure] = Expression::AtomicResult {
            ty: self.exchanges[&atomic.ty],
            comparison: true,
        };
        expressions[result] = Expression::AccessIndex {
            base: structure,
            index: 0,
        };
        let statement = Statement::Atomic {
            pointer,
            fun: AtomicFunction::Exchange {
                compare: Some(arguments[1]),
            },
            value: arguments[2],
            result: Some(structure),
        };
        block.push(statement, span);
        let emitted = Range::new_from_bounds(result, result);
        block.push(Statement::Emit(emitted), span);
    }
}

/// The number that a pointer leads to.
fn place(function: &Function, mut pointer: Handle<Expression>, span: Span) -> Option<Place> {
    let mut path = Vec::new();
    loop {
        pointer = match function.expressions[pointer] {
            Expression::Access { base, .. } => {
                path.push(Part::Element);
                base
            }
            Expression::AccessIndex { base, index } => {
                path.push(Part::Member(index));
                base
            }
            Expression::GlobalVariable(global) => {
                path.reverse();
                return Some(Place { global, path, span });
            }
            _ => return None,
        }
    }
}

/// The statement after a call that copies the value of an argument back, and where to.
fn copied_back(
    function: &Function,
    argument: Handle<Expression>,
    later: &[(Statement, Span)],
) -> Option<(usize, Handle<Expression>)> {
    let expressions = &function.expressions;
    let local = |handle: Handle<Expression>| match expressions[handle] {
        Expression::LocalVariable(variable) => Some(variable),
        _ => None,
    };
    let copy = local(argument)?;
    let mut stores = later.iter().enumerate();
    stores.find_map(|(at, (statement, _))| match *statement {
        Statement::Store { pointer, value } => match expressions[value] {
            Expression::Load { pointer: from } if local(from) == Some(copy) => Some((at, pointer)),
            _ => None,
        },
        _ => None,
    })
}
