//! Numbers as text.

use std::fmt::Write as _;

/// Appends a space and the shortest decimal number that is read back as the same f32; very small
/// and very large ones with an exponent.
pub(super) fn append(text: &mut String, number: f32) {
    let size = number.abs();
    let is_plain = size == 0.0 || (1e-4..1e7).contains(&size);
    // Writing into a `String` cannot fail. Adding zero turns −0 into 0.
    let _ = if is_plain {
        write!(text, " {}", number + 0.0)
    } else {
        write!(text, " {number:e}")
    };
}

/// Appends several numbers.
pub(super) fn append_all(text: &mut String, numbers: impl IntoIterator<Item = f32>) {
    for number in numbers {
        append(text, number);
    }
}
