//! The SIMD levels: sixteen lanes at once. Operations that are rare, or that no SIMD level has, are
//! done lane by lane.

use super::super::instruction::Product;
use super::arithmetic::Arithmetic;
use super::by_lane::ByLane;
use super::packets::{
    choose, copy, float, load, map, map2, map3, masks, splat, store, store_float,
};
use super::state::{MaskOperand, Masks, Operand, Words, quads_with_all};
use crate::op::{Axis, Binary, Compare, Math, Math2, NAN, Precision, Unary};
use estampe_format::half;
use estampe_simd::{
    Bytes, Lanes, Select, SimdBase, SimdCvtFloat, SimdCvtTruncate, SimdFloat, SimdInt, f32x16,
    i32x16, u32x16,
};
use estampe_types::{Real, maths};

#[derive(Clone, Copy)]
pub(super) struct Wide<S>(pub(super) S);

impl<S: Lanes> Arithmetic for Wide<S> {
    #[inline(always)]
    fn enter(self, work: impl FnOnce()) {
        self.0.vectorize(work);
    }

    #[inline(always)]
    fn unary(self, kind: Unary, to: Words<'_>, a: Words<'_>) {
        let s = self.0;
        macro_rules! floats {
            (|$x:ident| $result:expr) => {
                map(
                    s,
                    to,
                    a,
                    #[inline(always)]
                    |a| {
                        let $x: f32x16<S> = a.bitcast();
                        $result.bitcast()
                    },
                )
            };
        }
        match kind {
            Unary::FNeg => map(
                s,
                to,
                a,
                #[inline(always)]
                |a| a ^ splat(s, 1 << 31),
            ),
            Unary::FAbs => map(
                s,
                to,
                a,
                #[inline(always)]
                |a| a & splat(s, u32::MAX >> 1),
            ),
            Unary::FSqrt => floats!(|x| SimdFloat::sqrt(x)),
            Unary::FFloor => floats!(|x| Real::floor(x)),
            Unary::FCeil => floats!(|x| maths::ceil(x)),
            Unary::FTrunc => floats!(|x| maths::trunc(x)),
            Unary::FRound => floats!(|x| maths::round(x)),
            Unary::Canonical => map(
                s,
                to,
                a,
                #[inline(always)]
                |a| {
                    let x: f32x16<S> = a.bitcast();
                    x.simd_eq(x).select(a, splat(s, NAN))
                },
            ),
            Unary::RoundF16 => floats!(|x| half::decode_lanes(s, half::encode_lanes(s, x))),
            Unary::F16FromF32 => floats!(|x| half::encode_lanes(s, x)),
            Unary::F32FromF16 => map(
                s,
                to,
                a,
                #[inline(always)]
                |a| half::decode_lanes(s, a & splat(s, 0xFFFF)).bitcast(),
            ),
            Unary::S32FromF32 => floats!(|x| i32x16::truncate_from_precise(x)),
            Unary::U32FromF32 => floats!(|x| u32x16::truncate_from_precise(x)),
            Unary::F32FromS32 => map(
                s,
                to,
                a,
                #[inline(always)]
                |a| {
                    let a: i32x16<S> = a.bitcast();
                    f32x16::float_from(a).bitcast()
                },
            ),
            Unary::F32FromU32 => map(
                s,
                to,
                a,
                #[inline(always)]
                |a| f32x16::float_from(a).bitcast(),
            ),
            Unary::Not => map(
                s,
                to,
                a,
                #[inline(always)]
                |a| !a,
            ),
            Unary::CountOnes => map(
                s,
                to,
                a,
                #[inline(always)]
                |a| SimdInt::count_ones(a),
            ),
            Unary::ReverseBits | Unary::LeadingZeros | Unary::TrailingZeros => {
                ByLane.unary(kind, to, a);
            }
        }
    }

    #[inline(always)]
    fn binary(self, kind: Binary, to: Words<'_>, pair: [Operand<'_>; 2]) {
        let s = self.0;
        macro_rules! words {
            (|$a:ident, $b:ident| $result:expr) => {
                map2(
                    s,
                    to,
                    pair,
                    #[inline(always)]
                    |$a, $b| $result,
                )
            };
        }
        macro_rules! floats {
            (|$x:ident, $y:ident| $result:expr) => {
                map2(
                    s,
                    to,
                    pair,
                    #[inline(always)]
                    |a, b| {
                        let ($x, $y): (f32x16<S>, f32x16<S>) = (a.bitcast(), b.bitcast());
                        $result.bitcast()
                    },
                )
            };
        }
        macro_rules! signed {
            (|$x:ident, $y:ident| $result:expr) => {
                map2(
                    s,
                    to,
                    pair,
                    #[inline(always)]
                    |a, b| {
                        let ($x, $y): (i32x16<S>, i32x16<S>) = (a.bitcast(), b.bitcast());
                        $result.bitcast()
                    },
                )
            };
        }
        match kind {
            Binary::FAdd => floats!(|x, y| x + y),
            Binary::FSub => floats!(|x, y| x - y),
            Binary::FMul => floats!(|x, y| x * y),
            Binary::FDiv => floats!(|x, y| x / y),
            Binary::FMin => floats!(|x, y| s.min_f32(x, y)),
            Binary::FMax => floats!(|x, y| s.max_f32(x, y)),
            Binary::Add => words!(|a, b| a + b),
            Binary::Sub => words!(|a, b| a - b),
            Binary::Mul => words!(|a, b| a * b),
            Binary::And => words!(|a, b| a & b),
            Binary::Or => words!(|a, b| a | b),
            Binary::Xor => words!(|a, b| a ^ b),
            Binary::SMin => signed!(|x, y| SimdBase::min(x, y)),
            Binary::SMax => signed!(|x, y| SimdBase::max(x, y)),
            Binary::UMin => words!(|a, b| SimdBase::min(a, b)),
            Binary::UMax => words!(|a, b| SimdBase::max(a, b)),
            Binary::Shl | Binary::UShr | Binary::SShr => self.shift(kind, to, pair),
            Binary::UMulHigh
            | Binary::SMulHigh
            | Binary::SDiv
            | Binary::SRem
            | Binary::UDiv
            | Binary::URem => ByLane.binary(kind, to, pair),
        }
    }

    #[inline(always)]
    fn product(self, kind: Product, to: Words<'_>, [a, b, c]: [Operand<'_>; 3]) {
        let s = self.0;
        let Operand::Many(a) = a else {
            return ByLane.product(kind, to, [a, b, c]);
        };
        match kind {
            Product::Plus => map3(
                s,
                to,
                a,
                [b, c],
                #[inline(always)]
                |a, b, c| a * b + c,
            ),
            Product::Minus => map3(
                s,
                to,
                a,
                [b, c],
                #[inline(always)]
                |a, b, c| a * b - c,
            ),
            Product::From => map3(
                s,
                to,
                a,
                [b, c],
                #[inline(always)]
                |a, b, c| c - a * b,
            ),
        }
    }

    #[inline(always)]
    fn fma(self, to: Words<'_>, three: [Words<'_>; 3]) {
        ByLane.fma(to, three);
    }

    #[inline(always)]
    fn compare(self, kind: Compare, to: Masks<'_>, pair: [Operand<'_>; 2]) {
        let s = self.0;
        macro_rules! words {
            (|$a:ident, $b:ident| $result:expr) => {
                masks(
                    s,
                    to,
                    pair,
                    #[inline(always)]
                    |$a, $b| $result,
                )
            };
        }
        macro_rules! as_type {
            ($kind:ident, |$x:ident, $y:ident| $result:expr) => {
                masks(
                    s,
                    to,
                    pair,
                    #[inline(always)]
                    |a, b| {
                        let ($x, $y): ($kind<S>, $kind<S>) = (a.bitcast(), b.bitcast());
                        $result
                    },
                )
            };
        }
        match kind {
            Compare::FEq => as_type!(f32x16, |x, y| x.simd_eq(y)),
            Compare::FNe => as_type!(f32x16, |x, y| !x.simd_eq(y)),
            Compare::FLt => as_type!(f32x16, |x, y| x.simd_lt(y)),
            Compare::FLe => as_type!(f32x16, |x, y| x.simd_le(y)),
            Compare::Eq => words!(|a, b| a.simd_eq(b)),
            Compare::Ne => words!(|a, b| !a.simd_eq(b)),
            Compare::SLt => as_type!(i32x16, |x, y| x.simd_lt(y)),
            Compare::SLe => as_type!(i32x16, |x, y| x.simd_le(y)),
            Compare::ULt => words!(|a, b| a.simd_lt(b)),
            Compare::ULe => words!(|a, b| a.simd_le(b)),
        }
    }

    #[inline(always)]
    fn select(self, to: Words<'_>, mask: MaskOperand<'_>, [yes, no]: [Operand<'_>; 2]) {
        let s = self.0;
        let mask = match mask {
            MaskOperand::Many(mask) => mask,
            MaskOperand::One(bits) => return copy(s, to, if bits == 0 { no } else { yes }),
        };
        let places = to.iter().zip(mask);
        match (yes, no) {
            (Operand::Many(yes), Operand::Many(no)) => {
                for (((to, mask), yes), no) in places.zip(yes).zip(no) {
                    store(to, choose(s, mask, load(s, yes), load(s, no)));
                }
            }
            (Operand::Many(yes), Operand::One(no)) => {
                let no = splat(s, no);
                for ((to, mask), yes) in places.zip(yes) {
                    store(to, choose(s, mask, load(s, yes), no));
                }
            }
            (Operand::One(yes), Operand::Many(no)) => {
                let yes = splat(s, yes);
                for ((to, mask), no) in places.zip(no) {
                    store(to, choose(s, mask, yes, load(s, no)));
                }
            }
            (Operand::One(yes), Operand::One(no)) => {
                let (yes, no) = (splat(s, yes), splat(s, no));
                for (to, mask) in places {
                    store(to, choose(s, mask, yes, no));
                }
            }
        }
    }

    #[inline(always)]
    fn math(self, function: Math, to: Words<'_>, x: Words<'_>) {
        let s = self.0;
        macro_rules! floats {
            ($name:ident) => {
                map(
                    s,
                    to,
                    x,
                    #[inline(always)]
                    |x| {
                        let x: f32x16<S> = x.bitcast();
                        maths::$name(x).bitcast()
                    },
                )
            };
        }
        match function {
            Math::Sin => floats!(sin),
            Math::Cos => floats!(cos),
            Math::Tan => floats!(tan),
            Math::Asin => floats!(asin),
            Math::Acos => floats!(acos),
            Math::Atan => floats!(atan),
            Math::Sinh => floats!(sinh),
            Math::Cosh => floats!(cosh),
            Math::Tanh => floats!(tanh),
            Math::Exp => floats!(exp),
            Math::Exp2 => floats!(exp2),
            Math::Log => floats!(log),
            Math::Log2 => floats!(log2),
        }
    }

    #[inline(always)]
    fn math2(self, function: Math2, to: Words<'_>, pair: [Words<'_>; 2]) {
        let s = self.0;
        let [x, y] = pair;
        for ((to, x), y) in to.iter().zip(x).zip(y) {
            let (x, y) = (float(s, x), float(s, y));
            store_float(
                to,
                match function {
                    Math2::Pow => maths::pow(x, y),
                    Math2::Atan2 => maths::atan2(x, y),
                },
            );
        }
    }

    #[inline(always)]
    fn derivative(
        self,
        way: (Axis, Precision),
        to: Words<'_>,
        value: Words<'_>,
        mask: MaskOperand<'_>,
    ) {
        let s = self.0;
        let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
        for (packet, (to, value)) in to.iter().zip(value).enumerate() {
            let x: f32x16<S> = load(s, value).bitcast();
            let step = match way {
                (Axis::X, Precision::Fine) => Real::ddx(x),
                (Axis::Y, Precision::Fine) => Real::ddy(x),
                (Axis::X, Precision::Coarse) => Real::ddx_coarse(x),
                (Axis::Y, Precision::Coarse) => Real::ddy_coarse(x),
            };
            let whole = s.mask_from_bits(quads_with_all(mask.packet(packet)));
            store(to, whole.select(step, zero).bitcast());
        }
    }

    #[inline(always)]
    fn gather(self, to: Words<'_>, table: &[u32], index: Words<'_>, shift: u32, is_clamped: bool) {
        let s = self.0;
        let len = u32::try_from(table.len()).unwrap_or(u32::MAX);
        let (len, zero) = (splat(s, len), splat(s, 0));
        for (to, index) in to.iter().zip(index) {
            let index = load(s, index) >> shift;
            let element = s.gather(table, index);
            let element = if is_clamped {
                element
            } else {
                index.simd_lt(len).select(element, zero)
            };
            store(to, element);
        }
    }
}
