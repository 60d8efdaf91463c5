//! Expressions of numbers: parsing, values, and exact derivatives.
//!
//! ```text
//! text -> token -> parse -> program (postfix) -> values:      f64
//!                                             -> derivatives: Dual, Jet
//! ```
//!
//! The grammar, from the weakest operator to the strongest:
//!
//! ```text
//! sum      = product { ("+" | "-") product }
//! product  = signed { ("*" | "/") signed }
//! signed   = ("-" | "+") signed | power
//! power    = primary [ "^" signed ]              so 2^3^2 is 2^9, and -2^2 is -4
//! primary  = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
//! ```
//!
//! The names are the variables that the caller declares, the constants `pi`, `e` and `tau`, and the
//! functions `sin cos tan asin acos atan atan2 sinh cosh tanh exp ln log2 sqrt abs min max floor
//! sign pow`; `min` and `max` take two or more arguments. Multiplication is always written. An
//! [`ExpressionError`] shows the text with a caret under the mistake.
//!
//! Derivatives are exact: they are computed by the chain rule along with the value (forward
//! automatic differentiation; Griewank and Walther, "Evaluating Derivatives", chapter 3), not by
//! differences. Where a function has a kink, its derivative is that of one side: `abs` and `sign`
//! have the slope 0 at 0, `floor` everywhere, `min` and `max` that of their first argument where
//! both are equal. A slope that is infinite counts as 0 in a direction in which its argument does
//! not change.
//!
//! Every operation is an f64 operation of IEEE 754 or a function of `libm`, in the order in which
//! the text is written; constant parts are computed when the text is parsed. So a value has the
//! same bits on every machine, and is the same whether derivatives are computed or not. Outside of
//! its domain a function is NaN, and so is all that depends on it.
//!
//! Input is hostile: [`MAX_LENGTH`] and [`MAX_DEPTH`] limit the text, nothing panics, and the time
//! of an evaluation is proportional to the text's length.

mod derivative;
mod error;
mod function;
mod number;
mod parse;
mod program;
mod spelling;
mod token;

pub use derivative::{Dual, Jet};
pub use error::ExpressionError;
pub use parse::{MAX_DEPTH, MAX_LENGTH};

use program::Program;

/// A parsed expression of a fixed list of variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: String,
    program: Program,
}

impl Expression {
    /// Parses an expression; `variables` are the names that it may use, in the order of the
    /// arguments of [`Self::value`].
    ///
    /// # Errors
    /// An [`ExpressionError`] with the mistake and its position.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self, ExpressionError> {
        parse::expression(text, variables)
    }

    /// Parses expressions with commas between them.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub fn parse_list(text: &str, variables: &[&str]) -> Result<Vec<Self>, ExpressionError> {
        parse::list(text, variables)
    }

    /// Parses `left = right` as `left - right`, whose roots are the equation's solutions, or an
    /// expression without `=` as itself.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub fn parse_equation(text: &str, variables: &[&str]) -> Result<Self, ExpressionError> {
        parse::equation(text, variables)
    }

    fn new(text: &str, program: Program) -> Self {
        Self {
            text: text.to_owned(),
            program,
        }
    }

    /// The text that was parsed, without spaces around it.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// True if the expression names the variable with this number.
    #[must_use]
    pub fn uses(&self, variable: usize) -> bool {
        self.program.uses(variable)
    }

    /// The value at these arguments; missing arguments are NaN.
    #[must_use]
    pub fn value(&self, arguments: &[f64]) -> f64 {
        self.program.run(arguments)
    }

    /// The value and the partial derivatives by each of N arguments.
    #[must_use]
    pub fn dual<const N: usize>(&self, arguments: [f64; N]) -> Dual<N> {
        self.program.run(&Dual::variables(arguments))
    }

    /// The value and the first and second partial derivatives by both arguments.
    #[must_use]
    pub fn jet(&self, arguments: [f64; 2]) -> Jet {
        self.program.run(&Jet::variables(arguments))
    }
}

#[cfg(test)]
mod tests;
