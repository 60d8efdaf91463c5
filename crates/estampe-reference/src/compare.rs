//! The eight comparison functions.
//!
//! In · Out: a function and two values · whether the first passes against the second. Exact. Spec:
//! WebGPU, `GPUCompareFunction`; Vulkan 1.3, `VkCompareOp`.

use estampe_types::state::CompareFunction;
use std::cmp::Ordering;

/// Returns true if `new` passes against `stored`. If either is NaN, only `Always` and `NotEqual`
/// pass.
#[must_use]
pub fn passes<T: PartialOrd>(function: CompareFunction, new: T, stored: T) -> bool {
    use CompareFunction as F;
    let order = new.partial_cmp(&stored);
    match order {
        // Unordered: one of them is NaN.
        None => matches!(function, F::NotEqual | F::Always),
        Some(Ordering::Less) => {
            matches!(function, F::Less | F::LessEqual | F::NotEqual | F::Always)
        }
        Some(Ordering::Equal) => matches!(
            function,
            F::Equal | F::LessEqual | F::GreaterEqual | F::Always
        ),
        Some(Ordering::Greater) => matches!(
            function,
            F::Greater | F::GreaterEqual | F::NotEqual | F::Always
        ),
    }
}
