//! The function of `estampe shape`: its expressions and its kind.

use super::arguments::ShapeArgs;
use crate::failure::Failure;
use estampe_shapes::expression::{Expression, ExpressionError};

/// A parsed function. The kind follows from the variables that its expressions name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Function {
    /// y = f(x).
    ExplicitCurve(Expression),
    /// z = f(x, y).
    ExplicitSurface(Expression),
    /// Two or three coordinates over one variable, whose number among s and t is second.
    ParametricCurve(Vec<Expression>, usize),
    /// Three coordinates over s and t.
    ParametricSurface([Expression; 3]),
    /// F(x, y) = 0.
    ImplicitCurve(Expression),
    /// F(x, y, z) = 0.
    ImplicitSurface(Expression),
}

/// Variables of parametric functions.
const PARAMETERS: [&str; 2] = ["s", "t"];

impl Function {
    /// Parses the function that the options name.
    pub(super) fn parse(args: &ShapeArgs) -> Result<Self, Failure> {
        let has_range = |name: &str| args.range.iter().any(|range| range.name == name);
        let wrong = |error: ExpressionError| Failure::Usage(error.to_string());
        if let Some(text) = &args.explicit {
            let value = Expression::parse(text, &["x", "y"]).map_err(wrong)?;
            Ok(if value.uses(1) {
                Self::ExplicitSurface(value)
            } else {
                Self::ExplicitCurve(value)
            })
        } else if let Some(text) = &args.implicit {
            let value = Expression::parse_equation(text, &["x", "y", "z"]).map_err(wrong)?;
            Ok(if value.uses(2) || has_range("z") {
                Self::ImplicitSurface(value)
            } else {
                Self::ImplicitCurve(value)
            })
        } else {
            // The options hold exactly one function.
            let text = args.parametric.as_deref().unwrap_or_default();
            let coordinates = Expression::parse_list(text, &PARAMETERS).map_err(wrong)?;
            Self::parametric(coordinates, PARAMETERS.map(has_range))
        }
    }

    fn parametric(coordinates: Vec<Expression>, has_range: [bool; 2]) -> Result<Self, Failure> {
        let uses = [0, 1].map(|variable| {
            has_range[variable]
                || coordinates
                    .iter()
                    .any(|coordinate| coordinate.uses(variable))
        });
        let count = coordinates.len();
        match (uses, count) {
            ([true, true], _) => coordinates.try_into().map(Self::ParametricSurface).map_err(
                |_| {
                    Failure::Usage(format!(
                        "a surface over s and t has three coordinates, not {count}; write three \
                     expressions with commas between, or name one variable only for a curve"
                    ))
                },
            ),
            ([true, false], 2 | 3) => Ok(Self::ParametricCurve(coordinates, 0)),
            ([false, _], 2 | 3) => Ok(Self::ParametricCurve(coordinates, 1)),
            _ => Err(Failure::Usage(format!(
                "a curve has two or three coordinates, not {count}; write as many expressions \
                 with commas between"
            ))),
        }
    }

    /// The kind, for reports.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::ExplicitCurve(_) => "explicit curve",
            Self::ExplicitSurface(_) => "explicit surface",
            Self::ParametricCurve(..) => "parametric curve",
            Self::ParametricSurface(_) => "parametric surface",
            Self::ImplicitCurve(_) => "implicit curve",
            Self::ImplicitSurface(_) => "implicit surface",
        }
    }

    /// True for curves.
    pub(super) fn is_curve(&self) -> bool {
        matches!(
            self,
            Self::ExplicitCurve(_) | Self::ParametricCurve(..) | Self::ImplicitCurve(_)
        )
    }

    /// True for curves in the plane z = 0.
    pub(super) fn is_in_plane(&self) -> bool {
        match self {
            Self::ExplicitCurve(_) | Self::ImplicitCurve(_) => true,
            Self::ParametricCurve(coordinates, _) => coordinates.len() == 2,
            _ => false,
        }
    }

    /// The expressions as they were written.
    pub(super) fn texts(&self) -> Vec<&str> {
        match self {
            Self::ExplicitCurve(value)
            | Self::ExplicitSurface(value)
            | Self::ImplicitCurve(value)
            | Self::ImplicitSurface(value) => vec![value.text()],
            Self::ParametricCurve(coordinates, _) => {
                coordinates.iter().map(Expression::text).collect()
            }
            Self::ParametricSurface(coordinates) => {
                coordinates.iter().map(Expression::text).collect()
            }
        }
    }

    /// The variables whose ranges are divided into cells.
    pub(super) fn variables(&self) -> &'static [&'static str] {
        match self {
            Self::ExplicitCurve(_) => &["x"],
            Self::ExplicitSurface(_) | Self::ImplicitCurve(_) => &["x", "y"],
            Self::ParametricCurve(_, 0) => &["s"],
            Self::ParametricCurve(..) => &["t"],
            Self::ParametricSurface(_) => &PARAMETERS,
            Self::ImplicitSurface(_) => &["x", "y", "z"],
        }
    }

    /// The name of the values, if a range may cut them.
    pub(super) fn value_name(&self) -> Option<&'static str> {
        match self {
            Self::ExplicitCurve(_) => Some("y"),
            Self::ExplicitSurface(_) => Some("z"),
            _ => None,
        }
    }
}
