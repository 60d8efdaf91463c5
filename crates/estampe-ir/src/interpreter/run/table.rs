//! A function for each operation and SIMD level: small functions compile fast, and none pays for
//! the registers of another one.

use super::super::instruction::{Instruction, Product};
use super::arithmetic::Arithmetic;
use super::execute::copies_and_memory;
use super::state::State;
use crate::op::{Binary, Compare, Math, Math2, Unary};

/// Executes one kind of instruction.
pub(super) type Entry<A> = fn(A, &State<'_>, &Instruction);

/// The places of the functions in [`Table::ENTRIES`].
const BINARY: usize = Unary::ALL.len();
const COMPARE: usize = BINARY + Binary::ALL.len();
const MATH: usize = COMPARE + Compare::ALL.len();
const MATH2: usize = MATH + Math::ALL.len();
const PRODUCT: usize = MATH2 + Math2::ALL.len();
const SELECT: usize = PRODUCT + PRODUCTS.len();
const FMA: usize = SELECT + 1;
const DERIVATIVE: usize = SELECT + 2;
const GATHER: usize = SELECT + 3;
const TRANSFER: usize = SELECT + 4;
const OTHER: usize = SELECT + 5;
const COUNT: usize = SELECT + 6;

const PRODUCTS: [Product; 3] = [Product::Plus, Product::Minus, Product::From];

/// The place of the function of an instruction.
pub(in super::super) fn entry_of(instruction: &Instruction) -> u8 {
    let place = match instruction {
        Instruction::Unary(kind, ..) => *kind as usize,
        Instruction::Binary(kind, ..) => BINARY + *kind as usize,
        Instruction::Compare(kind, ..) => COMPARE + *kind as usize,
        Instruction::Math(function, ..) => MATH + *function as usize,
        Instruction::Math2(function, ..) => MATH2 + *function as usize,
        Instruction::Product(kind, ..) => PRODUCT + *kind as usize,
        Instruction::Select(..) => SELECT,
        Instruction::Fma(..) => FMA,
        Instruction::Derivative(..) => DERIVATIVE,
        Instruction::LoadTable(..) | Instruction::LoadBuffer(..) => GATHER,
        Instruction::Copy(..) | Instruction::Input(..) | Instruction::Output(..) => TRANSFER,
        _ => OTHER,
    };
    u8::try_from(place).expect("fewer than 256 functions")
}

/// The functions of a SIMD level.
pub(super) struct Table<A>(std::marker::PhantomData<A>);

impl<A: Arithmetic> Table<A> {
    /// By [`entry_of`].
    pub(super) const ENTRIES: [Entry<A>; COUNT] = {
        let mut entries: [Entry<A>; COUNT] = [other::<A>; COUNT];
        macro_rules! fill {
            ($first:expr, $function:ident, $all:expr, [$($kind:literal)*]) => {
                assert!([$($kind),*].len() == $all.len());
                $(entries[$first + $kind] = $function::<A, $kind>;)*
            };
        }
        fill!(0, unary, Unary::ALL, [0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19]);
        fill!(BINARY, binary, Binary::ALL,
            [0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24]);
        fill!(COMPARE, compare, Compare::ALL, [0 1 2 3 4 5 6 7 8 9]);
        fill!(MATH, math, Math::ALL, [0 1 2 3 4 5 6 7 8 9 10 11 12]);
        fill!(MATH2, math2, Math2::ALL, [0 1]);
        fill!(PRODUCT, product, PRODUCTS, [0 1 2]);
        entries[SELECT] = select::<A>;
        entries[FMA] = fma::<A>;
        entries[DERIVATIVE] = derivative::<A>;
        entries[GATHER] = gather::<A>;
        entries[TRANSFER] = transfer::<A>;
        entries
    };
}

/// Functions whose kind is known when they are compiled.
macro_rules! of_kinds {
    ($($function:ident: $all:expr, |$level:ident, $kind:ident, $state:ident| $pattern:pat => $act:expr;)*) => {$(
        fn $function<A: Arithmetic, const KIND: usize>(
            $level: A,
            $state: &State<'_>,
            instruction: &Instruction,
        ) {
            $level.enter(
                #[inline(always)]
                move || {
                    let $kind = const { $all[KIND] };
                    if let $pattern = *instruction {
                        $act;
                    }
                },
            );
        }
    )*};
}

of_kinds! {
    unary: Unary::ALL, |level, kind, state| Instruction::Unary(_, to, a) =>
        level.unary(kind, state.slot(to), state.slot(a));
    binary: Binary::ALL, |level, kind, state| Instruction::Binary(_, to, pair) =>
        level.binary(kind, state.slot(to), state.words_of(pair));
    compare: Compare::ALL, |level, kind, state| Instruction::Compare(_, to, pair) =>
        level.compare(kind, state.mask_slot(to), state.words_of(pair));
    math: Math::ALL, |level, kind, state| Instruction::Math(_, to, x) =>
        level.math(kind, state.slot(to), state.slot(x));
    math2: Math2::ALL, |level, kind, state| Instruction::Math2(_, to, [x, y]) =>
        level.math2(kind, state.slot(to), [state.slot(x), state.slot(y)]);
    product: PRODUCTS, |level, kind, state| Instruction::Product(_, to, [a, b, c]) =>
        level.product(kind, state.slot(to), [state.word(a), state.word(b), state.word(c)]);
}

fn select<A: Arithmetic>(level: A, state: &State<'_>, instruction: &Instruction) {
    level.enter(
        #[inline(always)]
        move || {
            if let Instruction::Select(to, mask, pair) = *instruction {
                let pair = state.words_of(pair);
                level.select(state.slot(to), state.mask(mask), pair);
            }
        },
    );
}

fn fma<A: Arithmetic>(level: A, state: &State<'_>, instruction: &Instruction) {
    if let Instruction::Fma(to, three) = *instruction {
        level.fma(state.slot(to), three.map(|slot| state.slot(slot)));
    }
}

fn derivative<A: Arithmetic>(level: A, state: &State<'_>, instruction: &Instruction) {
    level.enter(
        #[inline(always)]
        move || {
            if let Instruction::Derivative(axis, precision, to, value, mask) = *instruction {
                let (value, mask) = (state.slot(value), state.mask(mask));
                level.derivative((axis, precision), state.slot(to), value, mask);
            }
        },
    );
}

fn gather<A: Arithmetic>(level: A, state: &State<'_>, instruction: &Instruction) {
    level.enter(
        #[inline(always)]
        move || match *instruction {
            Instruction::LoadTable(table, to, index) => {
                let table = &state.code.tables[table as usize];
                level.gather(state.slot(to), table, state.slot(index), 0, true);
            }
            Instruction::LoadBuffer(to, buffer, offset) => {
                state.load_buffer(level, state.slot(to), buffer, state.slot(offset));
            }
            _ => {}
        },
    );
}

/// Copies packets, with the widest registers of the SIMD level.
fn transfer<A: Arithmetic>(level: A, state: &State<'_>, instruction: &Instruction) {
    level.enter(
        #[inline(always)]
        move || match *instruction {
            Instruction::Copy(to, word) => state.copy(state.slot(to), state.word(word)),
            Instruction::Input(to, at) => state.input(state.slot(to), at),
            Instruction::Output(at, word) => state.output(at, state.word(word)),
            _ => {}
        },
    );
}

fn other<A: Arithmetic>(_: A, state: &State<'_>, instruction: &Instruction) {
    copies_and_memory(state, instruction);
}
