//! The table of least separations, as text and as JSON.

use estampe_visibility::precision::{DepthFormat, DepthMethod};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The reason why no write below fails.
const TO_STRING: &str = "a string takes all text";

/// Without a far plane the table ends at this multiple of the near plane's distance.
pub(super) const ENDLESS: f64 = 1e8;

/// The most distances of 1, 2, 5, 10, …; beyond, only powers of ten are printed.
const MOST_ROWS: usize = 25;

/// One line of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Row {
    distance: f32,
    stored: f32,
    separation: Option<f64>,
    formula: Option<f64>,
}

impl Row {
    pub(super) fn new(method: &DepthMethod, distance: f32) -> Self {
        let z = f64::from(distance);
        Self {
            distance,
            stored: method.stored(distance),
            separation: method.least_separation(z),
            formula: method.formula(z),
        }
    }

    fn json(&self) -> Value {
        json!({
            "distance": self.distance,
            "stored": self.stored,
            "separation": self.separation,
            "formula": self.formula,
        })
    }
}

/// The distances that are printed without `--at`: the near plane, and 1, 2, 5, 10, … up to the far
/// plane.
pub(super) fn distances(method: &DepthMethod) -> Vec<f32> {
    let [near, far] = method.planes().map(f64::from);
    let end = far.min(near * ENDLESS);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the exponents of f32 are small"
    )]
    let exponents = libm::log10(near).floor() as i32..=libm::log10(end).ceil() as i32;
    let round = |digits: &[i32]| -> Vec<f32> {
        let all = exponents.clone().flat_map(|exponent| {
            let power = libm::exp10(f64::from(exponent));
            digits.iter().map(move |digit| f64::from(*digit) * power)
        });
        let shown = all.filter(|z| *z > near * 1.000_001 && *z < end * 0.999_999);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "rounds to the nearest float"
        )]
        let shown = shown.map(|z| z as f32).collect();
        shown
    };
    let mut shown = round(&[1, 2, 5]);
    if shown.len() > MOST_ROWS {
        shown = round(&[1]);
    }
    shown.insert(0, method.planes()[0]);
    shown
}

/// The name of a method, as in `d24 reversed, near 0.01, far 1000`.
pub(super) fn name(method: &DepthMethod) -> String {
    let [near, far] = method.planes();
    let mapping = method.mapping();
    let reversed = if mapping.is_reversed { " reversed" } else { "" };
    let logarithmic = if mapping.is_logarithmic {
        " logarithmic"
    } else {
        ""
    };
    let format = method.format().name();
    format!("{format}{reversed}{logarithmic}, near {near}, far {far}")
}

/// The table as text.
pub(super) fn text(method: &DepthMethod, rows: &[Row]) -> String {
    let [near, far] = method.planes().map(f64::from);
    let mut out = format!("{} (far/near {})\n", name(method), short(far / near));
    let heads = ["distance", "stored", "separation", "formula"];
    let [distance, stored, separation, formula] = heads;
    writeln!(
        out,
        "{distance:>10}  {stored:>12}  {separation:>11}  {formula:>11}"
    )
    .expect(TO_STRING);
    let optional = |separation: Option<f64>| separation.map_or_else(|| "-".to_owned(), short);
    for row in rows {
        let distance = short(f64::from(row.distance));
        let stored = stored_text(method.format(), row.stored);
        let [separation, formula] = [row.separation, row.formula].map(optional);
        writeln!(
            out,
            "{distance:>10}  {stored:>12}  {separation:>11}  {formula:>11}"
        )
        .expect(TO_STRING);
    }
    if rows.iter().any(|row| row.separation.is_none()) {
        out.push_str("- : no surface up to the far plane is told apart; move the near plane away, or take more bits\n");
    }
    out
}

/// The table as JSON.
pub(super) fn json(method: &DepthMethod, rows: &[Row], output: &Value) -> Value {
    let [near, far] = method.planes();
    json!({
        "near": near,
        "far": far.is_finite().then_some(far),
        "format": method.format().name(),
        "reversed": method.mapping().is_reversed,
        "logarithmic": method.mapping().is_logarithmic,
        "rows": rows.iter().map(Row::json).collect::<Vec<_>>(),
        "output": output,
    })
}

/// A stored depth: the code of fixed-point formats, the number of floats.
fn stored_text(format: DepthFormat, stored: f32) -> String {
    match format {
        DepthFormat::Unorm16 => format!("{:.0}", f64::from(stored) * 65_535.0),
        DepthFormat::Unorm24 => format!("{:.0}", f64::from(stored) * 16_777_215.0),
        DepthFormat::Float32 => format!("{stored:.6e}"),
    }
}

/// A number in three significant digits.
fn short(number: f64) -> String {
    if !number.is_finite() {
        return "inf".to_owned();
    }
    let scientific = format!("{number:.2e}");
    let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trim = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    if (-4..6).contains(&exponent) {
        let places = usize::try_from(2 - exponent).unwrap_or(0);
        // Three digits and no more: 123456 is 123000.
        let rounded: f64 = scientific.parse().unwrap_or(number);
        trim(&format!("{rounded:.places$}"))
    } else {
        format!("{}e{exponent}", trim(digits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_visibility::precision::DepthMapping;

    #[test]
    fn numbers_have_three_digits() {
        for (number, text) in [
            (0.01, "0.01"),
            (1234.56, "1230"),
            (0.000_123_456, "0.000123"),
            (0.000_012_345, "1.23e-5"),
            (999_999.0, "1e6"),
            (1.0, "1"),
            (20.0, "20"),
            (1e30, "1e30"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(short(number), text);
        }
    }

    #[test]
    fn distances_are_round_and_few() {
        let of = |planes| {
            let method = DepthMethod::new(planes, DepthFormat::Unorm24, DepthMapping::default());
            distances(&method.expect("valid"))
        };
        assert_eq!(of([0.5, 20.0]), [0.5, 1.0, 2.0, 5.0, 10.0]);
        assert_eq!(of([1.0, 1.5]), [1.0]);
        assert!(of([1e-30, 1e30]).len() < 70);
        assert!(of([0.1, f32::INFINITY]).len() < 30);
    }
}
