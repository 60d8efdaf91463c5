//! Sums of products without rounding: expansions (Shewchuk, "Adaptive Precision Floating-Point
//! Arithmetic and Fast Robust Geometric Predicates", 1997).

use std::cmp::Ordering;

/// A sum as components that do not overlap, from the least on.
#[derive(Debug, Default)]
pub(super) struct Expansion(Vec<f64>);

impl Expansion {
    /// Adds a·b·c. Exact unless a product overflows, or its last digit is below 2⁻¹⁰⁷⁴.
    pub(super) fn add_product(&mut self, a: f64, b: f64, c: f64) {
        let (high, low) = two_product(a, b);
        for factor in [low, high] {
            let (high, low) = two_product(factor, c);
            self.add(low);
            self.add(high);
        }
    }

    /// Shewchuk's Grow-Expansion, without components that are zero.
    fn add(&mut self, number: f64) {
        if number == 0.0 {
            return;
        }
        let mut carried = number;
        self.0.retain_mut(|component| {
            let (sum, error) = two_sum(carried, *component);
            carried = sum;
            *component = error;
            error != 0.0
        });
        if carried != 0.0 {
            self.0.push(carried);
        }
    }

    /// Compares the sum with zero: the last component has its sign.
    pub(super) fn sign(&self) -> Ordering {
        self.0
            .last()
            .map_or(Ordering::Equal, |last| last.total_cmp(&0.0))
    }
}

/// The rounded product and its error.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, libm::fma(a, b, -product))
}

/// The rounded sum and its error (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let virtual_b = sum - a;
    (sum, (a - (sum - virtual_b)) + (b - virtual_b))
}
