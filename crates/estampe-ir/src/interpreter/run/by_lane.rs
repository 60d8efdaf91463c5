//! The scalar level: each lane by the definitions of [`crate::op`].

use super::super::instruction::Product;
use super::arithmetic::Arithmetic;
use super::state::{MaskOperand, Masks, Operand, Words, quads_with_all};
use crate::op::{Axis, Binary, Compare, Math, Math2, Precision, Unary, fma};
use estampe_simd::{LANES, Lane, Packet};

#[derive(Clone, Copy)]
pub(super) struct ByLane;

impl Arithmetic for ByLane {
    #[inline(always)]
    fn enter(self, work: impl FnOnce()) {
        work();
    }

    #[inline(always)]
    fn unary(self, kind: Unary, to: Words<'_>, a: Words<'_>) {
        for (to, a) in to.iter().zip(a) {
            to.set(Packet(a.get().0.map(|a| kind.evaluate(a))));
        }
    }

    #[inline(always)]
    fn binary(self, kind: Binary, to: Words<'_>, pair: [Operand<'_>; 2]) {
        each(to, pair, |pair| kind.evaluate(pair));
    }

    #[inline(always)]
    fn product(self, kind: Product, to: Words<'_>, three: [Operand<'_>; 3]) {
        let [a, b, c] = three;
        for (packet, to) in to.iter().enumerate() {
            let [mut words, b, c] = [a, b, c].map(|operand| operand.packet(packet));
            for lane in 0..LANES {
                let product = Binary::FMul.evaluate([words[lane], b[lane]]);
                words[lane] = match kind {
                    Product::Plus => Binary::FAdd.evaluate([product, c[lane]]),
                    Product::Minus => Binary::FSub.evaluate([product, c[lane]]),
                    Product::From => Binary::FSub.evaluate([c[lane], product]),
                };
            }
            to.set(Packet(words));
        }
    }

    #[inline(always)]
    fn fma(self, to: Words<'_>, three: [Words<'_>; 3]) {
        each(to, three.map(Operand::Many), fma);
    }

    #[inline(always)]
    fn compare(self, kind: Compare, to: Masks<'_>, pair: [Operand<'_>; 2]) {
        for (packet, to) in to.iter().enumerate() {
            let [a, b] = pair.map(|operand| operand.packet(packet));
            let mut bits = 0;
            for lane in 0..LANES {
                bits |= u16::from(kind.evaluate([a[lane], b[lane]])) << lane;
            }
            to.set(bits);
        }
    }

    #[inline(always)]
    fn select(self, to: Words<'_>, mask: MaskOperand<'_>, [yes, no]: [Operand<'_>; 2]) {
        for (packet, to) in to.iter().enumerate() {
            let [mut words, yes] = [no, yes].map(|operand| operand.packet(packet));
            for lane in Lane::all_of(mask.packet(packet)) {
                words[lane.get()] = yes[lane.get()];
            }
            to.set(Packet(words));
        }
    }

    #[inline(always)]
    fn math(self, function: Math, to: Words<'_>, x: Words<'_>) {
        for (to, x) in to.iter().zip(x) {
            let result = |x| function.evaluate(f32::from_bits(x)).to_bits();
            to.set(Packet(x.get().0.map(result)));
        }
    }

    #[inline(always)]
    fn math2(self, function: Math2, to: Words<'_>, pair: [Words<'_>; 2]) {
        each(to, pair.map(Operand::Many), |pair| {
            function.evaluate(pair.map(f32::from_bits)).to_bits()
        });
    }

    #[inline(always)]
    fn derivative(
        self,
        (axis, precision): (Axis, Precision),
        to: Words<'_>,
        value: Words<'_>,
        mask: MaskOperand<'_>,
    ) {
        for (packet, (to, value)) in to.iter().zip(value).enumerate() {
            let (value, whole) = (value.get().0, quads_with_all(mask.packet(packet)));
            let mut result = [0; LANES];
            for (lane, result) in result.iter_mut().enumerate() {
                // The lane of the quad from which the step along the axis begins.
                let (step, across) = match axis {
                    Axis::X => (1, 2),
                    Axis::Y => (2, 1),
                };
                let from = match precision {
                    Precision::Fine => lane & !3 | lane & across,
                    Precision::Coarse => lane & !3,
                };
                if whole >> lane & 1 == 1 {
                    *result = Binary::FSub.evaluate([value[from + step], value[from]]);
                }
            }
            to.set(Packet(result));
        }
    }

    #[inline(always)]
    fn gather(self, to: Words<'_>, table: &[u32], index: Words<'_>, shift: u32, is_clamped: bool) {
        for (to, index) in to.iter().zip(index) {
            let element = |index: u32| {
                let element = table.get((index >> shift) as usize).copied();
                let last = table.last().copied().filter(|_| is_clamped);
                element.or(last).unwrap_or(0)
            };
            to.set(Packet(index.get().0.map(element)));
        }
    }
}

/// Sets each lane of a register to a function of the operands' lanes.
#[inline(always)]
fn each<const N: usize>(to: Words<'_>, operands: [Operand<'_>; N], word: impl Fn([u32; N]) -> u32) {
    for (packet, to) in to.iter().enumerate() {
        let operands = operands.map(|operand| operand.packet(packet));
        let mut result = [0; LANES];
        for (lane, result) in result.iter_mut().enumerate() {
            *result = word(operands.map(|words| words[lane]));
        }
        to.set(Packet(result));
    }
}
