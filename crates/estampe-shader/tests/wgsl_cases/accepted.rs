//! What is accepted as a result.

use super::types::{Type, number, words};
use serde_json::Value;

/// True if a case accepts the words of a result.
pub(crate) fn is_accepted(accepted: &Value, result: &[u32]) -> bool {
    if let Some(alternatives) = accepted.get("data").and_then(Value::as_array) {
        return alternatives.iter().any(|one| is_accepted(one, result));
    }
    if let Some(value) = accepted.get("val") {
        let ty = Type::named(value["t"].as_str().expect("a type"));
        let expected = words(&value["v"], ty.scalar);
        return expected == result[..expected.len()];
    }
    let mut intervals = Vec::new();
    for key in ["iv", "ivv", "ivm"] {
        if let Some(value) = accepted.get(key) {
            collect(value, &mut intervals);
        }
    }
    // Cases that cannot be expressed accept everything.
    intervals.iter().zip(result).all(|([low, high], word)| {
        let number = f64::from(f32::from_bits(*word));
        let is_any = *low == f64::NEG_INFINITY && *high == f64::INFINITY;
        is_any || (*low <= number && number <= *high)
    })
}

/// The intervals, which are pairs at the lowest level.
fn collect(value: &Value, intervals: &mut Vec<[f64; 2]>) {
    match value.as_array().map(Vec::as_slice) {
        Some([low, high]) if !low.is_array() => intervals.push([number(low), number(high)]),
        Some(parts) => parts.iter().for_each(|part| collect(part, intervals)),
        None => {}
    }
}
