//! Signed integers of 256 bits, with the few operations that the predicates need.

use std::cmp::Ordering;

/// high · 2¹²⁸ + low, in two's complement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Wide {
    high: i128,
    low: u128,
}

impl Wide {
    /// The product of two numbers; exact.
    pub(super) fn product(a: i128, b: i128) -> Self {
        let (high, low) = magnitude_product(a.unsigned_abs(), b.unsigned_abs());
        // At most 2²⁵⁴, so the high half is at most 2¹²⁶.
        let magnitude = Self {
            high: high.cast_signed(),
            low,
        };
        if (a < 0) == (b < 0) {
            magnitude
        } else {
            magnitude.negated()
        }
    }

    /// The product with another number. The caller knows that it fits 256 bits.
    pub(super) fn times(self, factor: i128) -> Self {
        let is_negative = (self.high < 0) != (factor < 0);
        let own = if self.high < 0 { self.negated() } else { self };
        let factor = factor.unsigned_abs();
        let (carry, low) = magnitude_product(own.low, factor);
        let (overflow, high) = magnitude_product(own.high.unsigned_abs(), factor);
        debug_assert!(overflow == 0, "the bounds of the predicates hold");
        let magnitude = Self {
            high: high.wrapping_add(carry).cast_signed(),
            low,
        };
        if is_negative {
            magnitude.negated()
        } else {
            magnitude
        }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        let (low, carry) = self.low.overflowing_add(other.low);
        let high = self
            .high
            .wrapping_add(other.high)
            .wrapping_add(i128::from(carry));
        Self { high, low }
    }

    pub(super) fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    fn negated(self) -> Self {
        let (low, carry) = (!self.low).overflowing_add(1);
        Self {
            high: (!self.high).wrapping_add(i128::from(carry)),
            low,
        }
    }

    /// Compares with zero.
    pub(super) fn sign(self) -> Ordering {
        (self.high, self.low).cmp(&(0, 0))
    }
}

/// The product of two magnitudes, as its high and its low half.
fn magnitude_product(a: u128, b: u128) -> (u128, u128) {
    const HALF: u128 = u64::MAX as u128;
    let ([a1, a0], [b1, b0]) = ([a >> 64, a & HALF], [b >> 64, b & HALF]);
    let (low, middle, other, high) = (a0 * b0, a1 * b0, a0 * b1, a1 * b1);
    // Each of the three addends is below 2⁶⁴.
    let carried = (low >> 64) + (middle & HALF) + (other & HALF);
    (
        high + (middle >> 64) + (other >> 64) + (carried >> 64),
        (carried << 64) | (low & HALF),
    )
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;

    use super::*;

    /// Identities that any mistake in a carry breaks, on numbers of all lengths.
    #[test]
    fn the_arithmetic_is_that_of_a_ring() {
        let mut random = Rng::with_seed(9);
        for _ in 0..100_000 {
            let mut number = |bits: u32| {
                let number = random.i128(..) >> (127 - random.u32(..bits));
                if random.u8(..8) == 0 {
                    number | 0xFFFF_FFFF_FFFF_FFFF
                } else {
                    number
                }
            };
            let (a, b, c) = (number(88), number(88), number(59));
            let (ab, ac, bc) = (
                Wide::product(a, b),
                Wide::product(a, c),
                Wide::product(b, c),
            );
            assert_eq!(ab, Wide::product(b, a));
            assert_eq!(ab.times(c), ac.times(b));
            assert_eq!(ac.plus(bc), Wide::product(a + b, c));
            assert_eq!(ac.minus(bc), Wide::product(a - b, c));
            let sign = (a - b).signum() * c.signum();
            assert_eq!(ac.minus(bc).sign(), sign.cmp(&0));
            assert_eq!(ab.minus(ab).sign(), Ordering::Equal);
        }
    }
}
