//! Integer division with AVX2: the even lanes of eight, and the odd ones.
//!
//! AVX2 converts between words and binary64 only where they lie side by side. But the number
//! 2⁵² + w has the word w as its lower half, and 0x4330_0000 as its upper one:
//!
//! ```text
//!   lanes       w0 w1 w2 w3 …           w1 w3 …, moved down by 32 bits
//!   blended     w0 52 w2 52 …           w1 52 w3 52 …
//!   subtracted  f64(w0) f64(w2) …       f64(w1) f64(w3) …
//! ```
//!
//! Signed words are moved up by 2³¹ first. Quotients are rounded towards 0, and 1.5 · 2⁵² is added,
//! so that the lower halves of negative ones are their two's complement.

use super::Selector;
use super::operands::Source;
use crate::encoder::vector_op;
use crate::machine::VECTOR;
use regalloc2::VReg;

const SIGN: u32 = 1 << 31;

/// 2⁵² four times, 2⁵² + 2³¹ and 1.5 · 2⁵².
const TWO_52: [u32; 8] = four(0, 0x4330_0000);
const TWO_52_AND_31: [u32; 8] = four(SIGN, 0x4330_0000);
const TWO_52_AND_51: [u32; 8] = four(0, 0x4338_0000);

/// The odd lanes, from the second operand.
const ODD: u8 = 0b1010_1010;

/// Towards 0; "inexact" stays quiet.
const TOWARDS_ZERO: u8 = 0b1011;

/// The words of four numbers of 64 bits.
const fn four(lower: u32, upper: u32) -> [u32; 8] {
    [lower, upper, lower, upper, lower, upper, lower, upper]
}

impl Selector<'_> {
    /// The quotients of eight lanes.
    pub(super) fn quotients_of_pairs(&mut self, pair: [VReg; 2], is_signed: bool) -> VReg {
        let [[a, next_a], [b, next_b]] = pair.map(|words| self.f64_of_pairs(words, is_signed));
        let quotients = [[a, b], [next_a, next_b]]
            .map(|[a, b]| self.two(&vector_op::DIV_F64, a, Source::Register(b)));
        self.words_of_pairs(quotients)
    }

    /// The quotients of eight lanes by a word that is the same in all.
    pub(super) fn quotients_of_pairs_by_one(&mut self, [a, b]: [VReg; 2], is_signed: bool) -> VReg {
        let b = self.moved_up(b, is_signed);
        let b = self.f64_of_even(b, is_signed);
        let inverse = self.above_inverse(b);
        let quotients = self
            .f64_of_pairs(a, is_signed)
            .map(|a| self.two(&vector_op::MUL_F64, a, Source::Register(inverse)));
        self.words_of_pairs(quotients)
    }

    /// The even and the odd words as numbers.
    fn f64_of_pairs(&mut self, words: VReg, is_signed: bool) -> [VReg; 2] {
        let even = self.moved_up(words, is_signed);
        let odd = self.shift_by(&vector_op::SHR_64_BY, even, 32);
        [even, odd].map(|words| self.f64_of_even(words, is_signed))
    }

    /// Words, 2³¹ higher if they are signed.
    fn moved_up(&mut self, words: VReg, is_signed: bool) -> VReg {
        if !is_signed {
            return words;
        }
        let sign = self.constant(SIGN);
        self.two(&vector_op::XOR, words, sign)
    }

    /// The even words, moved up if they are signed, as numbers.
    fn f64_of_even(&mut self, words: VReg, is_signed: bool) -> VReg {
        let upper = self.constant_lanes(&TWO_52);
        let above = self.odd_lanes(upper, words);
        let excess = if is_signed { TWO_52_AND_31 } else { TWO_52 };
        let excess = self.constant_lanes(&excess);
        self.two(&vector_op::SUB_F64, above, excess)
    }

    /// The integers of numbers, those of the odd lanes in the second register.
    fn words_of_pairs(&mut self, numbers: [VReg; 2]) -> VReg {
        let [even, odd] = numbers.map(|number| {
            let number = Source::Register(number);
            let round = (&vector_op::ROUND_F64, VECTOR);
            let whole = self.emit(round, None, number, Some(TOWARDS_ZERO));
            let above = self.constant_lanes(&TWO_52_AND_51);
            self.two(&vector_op::ADD_F64, whole, above)
        });
        let odd = self.shift_by(&vector_op::SHL_64_BY, odd, 32);
        self.odd_lanes(Source::Register(odd), even)
    }

    /// The odd lanes of one vector among the even ones of another.
    pub(super) fn odd_lanes(&mut self, odd: Source, even: VReg) -> VReg {
        let blend = (&vector_op::BLEND_WORDS, VECTOR);
        self.emit(blend, Some(even), odd, Some(ODD))
    }
}
