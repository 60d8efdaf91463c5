//! The ranges of variables, and their division into cells.

use super::function::Function;
use crate::failure::Failure;
use estampe_shapes::expression::Expression;
use estampe_shapes::implicit::{MAX_CURVE_CELLS, MAX_SURFACE_CELLS};
use estampe_shapes::parametric::MAX_CELLS;
use std::ops::Range;

/// The maximum number of segments of a curve over one variable.
const MAX_SEGMENTS: u32 = 1 << 20;

/// `NAME=FROM:TO`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NamedRange {
    pub(super) name: String,
    pub(super) range: Range<f64>,
}

/// Parses `NAME=FROM:TO`, whose limits are expressions.
pub(super) fn named_range(text: &str) -> Result<NamedRange, String> {
    let parts = text.split_once('=').and_then(|(name, limits)| {
        let (from, to) = limits.split_once(':')?;
        Some((name.trim(), from, to))
    });
    let Some((name, from, to)) = parts else {
        return Err("write NAME=FROM:TO, as in x=-3:3 or t=0:2*pi".to_owned());
    };
    let limit = |text: &str| {
        let expression = Expression::parse(text, &[]).map_err(|error| error.to_string())?;
        let value = expression.value(&[]);
        if value.abs() <= 1e30 {
            Ok(value)
        } else {
            Err(format!(
                "`{}` is {value}; limits are numbers up to 1e30",
                text.trim()
            ))
        }
    };
    let range = limit(from)?..limit(to)?;
    if range.start == range.end {
        return Err(format!(
            "the range of {name} is empty; write two different numbers"
        ));
    }
    Ok(NamedRange {
        name: name.to_owned(),
        range,
    })
}

/// `N`, `NxM` or `NxMxK`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Resolution(Vec<u32>);

/// Parses a resolution; its limits depend on the function.
pub(super) fn resolution(text: &str) -> Result<Resolution, String> {
    let numbers = text.split(['x', 'X', '×']);
    let numbers: Option<Vec<u32>> = numbers
        .map(|number| number.parse().ok().filter(|number| *number > 0))
        .collect();
    numbers
        .filter(|numbers| numbers.len() <= 3)
        .map(Resolution)
        .ok_or_else(|| "write N, NxM or NxMxK, as in 200 or 128x64".to_owned())
}

/// Parses the radius of a tube.
pub(super) fn tube_radius(text: &str) -> Result<f64, String> {
    let radius = text.parse().ok();
    radius
        .filter(|radius| *radius > 0.0 && *radius <= 1e30)
        .ok_or_else(|| "write a number above 0".to_owned())
}

/// The ranges and cells of a function.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    /// The name and the range of each variable.
    pub(super) ranges: Vec<(&'static str, Range<f64>)>,
    /// The number of cells along each variable.
    pub(super) cells: Vec<u32>,
    /// The range of the values to keep.
    pub(super) values: Option<Range<f64>>,
}

impl Grid {
    /// The grid of a function, by the options and its defaults.
    pub(super) fn new(
        function: &Function,
        named: &[NamedRange],
        resolution: Option<&Resolution>,
    ) -> Result<Self, Failure> {
        let variables = function.variables();
        let value_name = function.value_name();
        for (number, NamedRange { name, .. }) in named.iter().enumerate() {
            if !variables.contains(&name.as_str()) && value_name != Some(name) {
                let known = variables.iter().copied().chain(value_name);
                let known: Vec<&str> = known.collect();
                return Err(Failure::Usage(format!(
                    "this {} has no range of {name:?}; there are ranges of {}",
                    function.kind(),
                    known.join(", ")
                )));
            }
            if named[..number].iter().any(|other| other.name == *name) {
                return Err(Failure::Usage(format!(
                    "--range of {name} is there twice; write one"
                )));
            }
        }
        let find = |name: &str| {
            let found = named.iter().find(|range| range.name == name);
            found.map(|named| named.range.clone())
        };
        let default = match function {
            Function::ExplicitCurve(_) | Function::ExplicitSurface(_) => -5.0..5.0,
            Function::ParametricCurve(..) | Function::ParametricSurface(_) => {
                0.0..std::f64::consts::TAU
            }
            Function::ImplicitCurve(_) | Function::ImplicitSurface(_) => -2.0..2.0,
        };
        let range = |name: &'static str| (name, find(name).unwrap_or_else(|| default.clone()));
        let ranges: Vec<_> = variables.iter().copied().map(range).collect();
        let cells = cells(function, &ranges, resolution)?;
        Ok(Self {
            values: value_name.and_then(find),
            ranges,
            cells,
        })
    }

    /// The range of a variable by its number.
    pub(super) fn range(&self, variable: usize) -> Range<f64> {
        self.ranges[variable].1.clone()
    }
}

/// The number of cells along each variable. One number is that of each variable; of an implicit
/// function that of the longest side, so that cells are as long as wide.
fn cells(
    function: &Function,
    ranges: &[(&str, Range<f64>)],
    resolution: Option<&Resolution>,
) -> Result<Vec<u32>, Failure> {
    let (default, most, is_implicit) = match function {
        Function::ExplicitCurve(_) | Function::ParametricCurve(..) => (1000, MAX_SEGMENTS, false),
        Function::ExplicitSurface(_) | Function::ParametricSurface(_) => (128, MAX_CELLS, false),
        Function::ImplicitCurve(_) => (256, MAX_CURVE_CELLS, true),
        Function::ImplicitSurface(_) => (64, MAX_SURFACE_CELLS, true),
    };
    let default = [default];
    let numbers = resolution.map_or(&default[..], |resolution| &resolution.0);
    if let Some(bad) = numbers.iter().find(|number| **number > most) {
        let kind = function.kind();
        return Err(Failure::Usage(format!(
            "--resolution {bad}: at most {most} cells along a variable are possible for this {kind}"
        )));
    }
    match *numbers {
        [one] if is_implicit => {
            let length = |range: &Range<f64>| (range.end - range.start).abs();
            let lengths: Vec<f64> = ranges.iter().map(|(_, range)| length(range)).collect();
            let longest = lengths.iter().copied().fold(0.0, f64::max);
            let share = |length: f64| libm::rint(f64::from(one) * length / longest).max(1.0);
            // The shares are from 1 to `one`.
            let whole = |share: f64| (1..=one).rev().find(|n| f64::from(*n) <= share);
            Ok(lengths
                .into_iter()
                .map(|length| whole(share(length)).unwrap_or(1))
                .collect())
        }
        [one] => Ok(vec![one; ranges.len()]),
        _ if numbers.len() == ranges.len() => Ok(numbers.to_vec()),
        _ => Err(Failure::Usage(format!(
            "--resolution has {} numbers, but this {} has {}; write one number, or one for each \
             variable",
            numbers.len(),
            function.kind(),
            match ranges.len() {
                1 => "1 variable".to_owned(),
                count => format!("{count} variables"),
            }
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_expressions() {
        let range = |text: &str| named_range(text).map(|named| (named.name, named.range));
        assert_eq!(range("x=-3:3"), Ok(("x".to_owned(), -3.0..3.0)));
        let pi = std::f64::consts::PI;
        assert_eq!(
            range(" t = -pi/2 : 2^3 "),
            Ok(("t".to_owned(), -pi / 2.0..8.0))
        );
        for (wrong, said) in [
            ("", "write NAME=FROM:TO"),
            ("x=3", "write NAME=FROM:TO"),
            ("-3:3", "write NAME=FROM:TO"),
            ("x=1:1", "is empty"),
            ("x=0:1/0", "is inf"),
            ("x=0:sqrt(-1)", "is NaN"),
            ("x=0:y", "unknown name `y`"),
            ("x=:1", "is empty"),
            ("x=0:1:2", "unknown character `:`"),
        ] {
            let error = range(wrong).unwrap_err();
            assert!(error.contains(said), "{wrong}: {error}");
        }
    }

    #[test]
    fn resolutions_are_one_to_three_numbers() {
        assert_eq!(resolution("5"), Ok(Resolution(vec![5])));
        assert_eq!(resolution("5x6X7"), Ok(Resolution(vec![5, 6, 7])));
        for wrong in ["", "0", "5x", "x5", "1x2x3x4", "-5", "1.5", "5x0"] {
            assert!(resolution(wrong).is_err(), "{wrong}");
        }
        assert!(tube_radius("0.1").is_ok());
        for wrong in ["0", "-1", "nan", "inf", "x"] {
            assert!(tube_radius(wrong).is_err(), "{wrong}");
        }
    }
}
