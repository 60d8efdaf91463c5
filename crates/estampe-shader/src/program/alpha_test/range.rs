//! Ranges: what is known of a value.
//!
//! Operations on floats are rounded alike for all operands, so a sum, product or quotient of bounds
//! bounds all sums, products or quotients between them. Where a bound is not finite, nothing is
//! known.

use estampe_ir::op::{Binary, Compare, MaskBinary, Unary};

/// What is known of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Known {
    /// Nothing.
    Nothing,
    /// The word.
    Word(u32),
    /// A float that is not NaN, and its bounds.
    Range(Range),
    /// The mask.
    Mask(bool),
}

/// Bounds of a float, which are finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub(super) least: f32,
    pub(super) most: f32,
}

impl Range {
    pub(super) fn new(least: f32, most: f32) -> Self {
        Self { least, most }
    }

    /// The range of some numbers, if all are finite.
    fn of(numbers: &[f32]) -> Known {
        let mut all = Self::new(f32::INFINITY, f32::NEG_INFINITY);
        for number in numbers {
            if !number.is_finite() {
                return Known::Nothing;
            }
            all = Self::new(all.least.min(*number), all.most.max(*number));
        }
        Known::Range(all)
    }
}

impl Known {
    pub(super) fn mask(self) -> Option<bool> {
        match self {
            Self::Mask(mask) => Some(mask),
            _ => None,
        }
    }

    /// Bounds, if it is a float.
    pub(super) fn range(self) -> Option<Range> {
        match self {
            Self::Range(range) => Some(range),
            Self::Word(word) => {
                let number = f32::from_bits(word);
                number.is_finite().then_some(Range::new(number, number))
            }
            _ => None,
        }
    }

    fn word(self) -> Option<u32> {
        match self {
            Self::Word(word) => Some(word),
            _ => None,
        }
    }

    /// What is known of either.
    pub(super) fn join(self, other: Self) -> Self {
        if self == other {
            return self;
        }
        match (self.range(), other.range()) {
            (Some(a), Some(b)) => Range::of(&[a.least, a.most, b.least, b.most]),
            _ => Self::Nothing,
        }
    }

    pub(super) fn unary(self, kind: Unary) -> Self {
        if let Self::Word(word) = self {
            return Self::Word(kind.evaluate(word));
        }
        let Some(Range { least, most }) = self.range() else {
            return Self::Nothing;
        };
        let of = |number: f32| f32::from_bits(kind.evaluate(number.to_bits()));
        match kind {
            Unary::FNeg
            | Unary::FFloor
            | Unary::FCeil
            | Unary::FTrunc
            | Unary::FRound
            | Unary::Canonical
            | Unary::RoundF16 => Range::of(&[of(least), of(most)]),
            Unary::FSqrt if least >= 0.0 => Range::of(&[of(least), of(most)]),
            Unary::FAbs if least <= 0.0 && most >= 0.0 => Range::of(&[0.0, of(least), of(most)]),
            Unary::FAbs => Range::of(&[of(least), of(most)]),
            _ => Self::Nothing,
        }
    }

    pub(super) fn binary(self, kind: Binary, other: Self) -> Self {
        if let (Self::Word(a), Self::Word(b)) = (self, other) {
            return Self::Word(kind.evaluate([a, b]));
        }
        let (Some(a), Some(b)) = (self.range(), other.range()) else {
            return Self::Nothing;
        };
        let all = [
            [a.least, b.least],
            [a.least, b.most],
            [a.most, b.least],
            [a.most, b.most],
        ];
        let of_all =
            || Range::of(&all.map(|pair| f32::from_bits(kind.evaluate(pair.map(f32::to_bits)))));
        match kind {
            Binary::FAdd | Binary::FSub | Binary::FMul | Binary::FMin | Binary::FMax => of_all(),
            Binary::FDiv if b.least > 0.0 || b.most < 0.0 => of_all(),
            _ => Self::Nothing,
        }
    }

    /// a · b + c, rounded once.
    pub(super) fn fma([a, b, c]: [Self; 3]) -> Self {
        if let (Some(a), Some(b), Some(c)) = (a.word(), b.word(), c.word()) {
            return Self::Word(estampe_ir::op::fma([a, b, c]));
        }
        let (Some(a), Some(b), Some(c)) = (a.range(), b.range(), c.range()) else {
            return Self::Nothing;
        };
        let mut all = [0.0; 8];
        for (at, number) in all.iter_mut().enumerate() {
            let of = |range: Range, bit: usize| [range.least, range.most][at >> bit & 1].to_bits();
            *number = f32::from_bits(estampe_ir::op::fma([of(a, 0), of(b, 1), of(c, 2)]));
        }
        Range::of(&all)
    }

    pub(super) fn compare(self, kind: Compare, other: Self) -> Self {
        if let (Self::Word(a), Self::Word(b)) = (self, other) {
            return Self::Mask(kind.evaluate([a, b]));
        }
        let (Some(a), Some(b)) = (self.range(), other.range()) else {
            return Self::Nothing;
        };
        let (is_below, is_above) = (a.most < b.least, a.least > b.most);
        let known = match kind {
            Compare::FLt if is_below => Some(true),
            Compare::FLt if a.least >= b.most => Some(false),
            Compare::FLe if a.most <= b.least => Some(true),
            Compare::FLe if is_above => Some(false),
            Compare::FEq if is_below || is_above => Some(false),
            Compare::FNe if is_below || is_above => Some(true),
            _ => None,
        };
        known.map_or(Self::Nothing, Self::Mask)
    }

    pub(super) fn mask_not(self) -> Self {
        self.mask().map_or(Self::Nothing, |mask| Self::Mask(!mask))
    }

    pub(super) fn mask_binary(self, kind: MaskBinary, other: Self) -> Self {
        let known = match (kind, self.mask(), other.mask()) {
            (MaskBinary::And, Some(false), _) | (MaskBinary::And, _, Some(false)) => Some(false),
            (MaskBinary::Or, Some(true), _) | (MaskBinary::Or, _, Some(true)) => Some(true),
            (MaskBinary::AndNot, Some(false), _) | (MaskBinary::AndNot, _, Some(true)) => {
                Some(false)
            }
            (_, Some(a), Some(b)) => Some(match kind {
                MaskBinary::And => a && b,
                MaskBinary::Or => a || b,
                MaskBinary::Xor => a != b,
                MaskBinary::AndNot => a && !b,
            }),
            _ => None,
        };
        known.map_or(Self::Nothing, Self::Mask)
    }

    /// The difference of two such values of neighbours.
    pub(super) fn difference(self) -> Self {
        match self.range() {
            Some(Range { least, most }) => Range::of(&[least - most, most - least]),
            None => Self::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number from a range, its ends now and then.
    fn among(random: &mut fastrand::Rng, Range { least, most }: Range) -> f32 {
        match random.u32(0..6) {
            0 => least,
            1 => most,
            _ => (least + random.f32() * (most - least)).clamp(least, most),
        }
    }

    fn range(random: &mut fastrand::Rng) -> Range {
        let mut end = || match random.u32(0..10) {
            0 => 0.0,
            1 => 1.0,
            2 => f32::MAX,
            3 => f32::MIN_POSITIVE / 8.0,
            _ => (random.f32() - 0.5) * 10.0_f32.powi(random.i32(-3..4)),
        };
        let (a, b) = (end(), end());
        Range::new(a.min(b), a.max(b))
    }

    /// What is known of a result holds of the result of any numbers of the ranges.
    #[test]
    fn results_are_in_their_ranges() {
        let random = &mut fastrand::Rng::with_seed(5);
        let (mut ranges, mut masks) = (0, 0);
        for _ in 0..60_000 {
            let of = [(); 3].map(|()| range(random));
            let [a, b, c] = of.map(Known::Range);
            let numbers = of.map(|of| among(random, of).to_bits());
            let [x, y, _] = numbers;
            let unary = *random.choice(Unary::ALL).expect("there are some");
            let binary = *random.choice(Binary::ALL).expect("there are some");
            let compare = *random.choice(Compare::ALL).expect("there are some");
            for (known, word) in [
                (a.unary(unary), unary.evaluate(x)),
                (a.binary(binary, b), binary.evaluate([x, y])),
                (Known::fma([a, b, c]), estampe_ir::op::fma(numbers)),
                (a.join(b), x),
            ] {
                let Some(Range { least, most }) = known.range() else {
                    assert_eq!(known, Known::Nothing);
                    continue;
                };
                let number = f32::from_bits(word);
                let is_inside = (least..=most).contains(&number);
                assert!(is_inside, "{unary:?} {binary:?} {of:?} {number} {known:?}");
                ranges += 1;
            }
            if let Some(mask) = a.compare(compare, b).mask() {
                assert_eq!(mask, compare.evaluate([x, y]), "{compare:?} {of:?}");
                masks += 1;
            }
        }
        assert!(ranges > 60_000 && masks > 5000, "{ranges}, {masks}");
    }
}
