//! Integer expressions: conditions of `#if`, sizes of arrays, numbers in `layout`.

use super::super::Fault;
use super::super::number::{Number, number};
use super::super::token::{Kind, Place, Token};

/// How deeply expressions nest.
const DEEPEST: u32 = 64;

/// The value of an expression. Names have the values that `value_of` gives.
pub(in crate::front::glsl) fn evaluate(
    tokens: &[Token],
    whole: Place,
    value_of: &dyn Fn(&str) -> Option<i64>,
) -> Result<i64, Fault> {
    let mut parser = Parser {
        tokens,
        at: 0,
        whole,
        value_of,
        depth: 0,
    };
    let value = parser.binary(0)?;
    match tokens.get(parser.at) {
        None => Ok(value),
        Some(extra) => Err(Fault::new(
            format!("`{}` does not belong here", extra.text),
            extra.place,
        )
        .help("the expression ends before it")),
    }
}

struct Parser<'a> {
    tokens: &'a [Token],
    at: usize,
    whole: Place,
    value_of: &'a dyn Fn(&str) -> Option<i64>,
    depth: u32,
}

/// The binary operators and how tightly they bind.
const OPERATORS: &[(&str, u8)] = &[
    ("||", 1),
    ("&&", 2),
    ("|", 3),
    ("^", 4),
    ("&", 5),
    ("==", 6),
    ("!=", 6),
    ("<", 7),
    (">", 7),
    ("<=", 7),
    (">=", 7),
    ("<<", 8),
    (">>", 8),
    ("+", 9),
    ("-", 9),
    ("*", 10),
    ("/", 10),
    ("%", 10),
];

impl Parser<'_> {
    fn next(&mut self) -> Option<&Token> {
        let token = self.tokens.get(self.at);
        self.at += 1;
        token
    }

    fn binary(&mut self, weakest: u8) -> Result<i64, Fault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(Fault::new("this expression nests too deeply", self.whole));
        }
        let mut left = self.unary()?;
        loop {
            let operator = self
                .tokens
                .get(self.at)
                .and_then(|token| OPERATORS.iter().find(|(sign, _)| token.is(sign)));
            let Some(&(sign, strength)) = operator else {
                break;
            };
            if strength <= weakest {
                break;
            }
            let place = self.tokens[self.at].place;
            self.at += 1;
            let right = self.binary(strength)?;
            left = apply(sign, left, right)
                .ok_or_else(|| Fault::new("this divides by zero", place))?;
        }
        self.depth -= 1;
        Ok(left)
    }

    fn unary(&mut self) -> Result<i64, Fault> {
        let whole = self.whole;
        let Some(token) = self.next() else {
            return Err(Fault::new("an integer expression is missing here", whole)
                .help("write a number, or numbers with operators"));
        };
        let token = token.clone();
        match (token.kind, &*token.text) {
            (Kind::Number, _) => match number(&token)? {
                Number::Integer { value, .. } => Ok(i64::try_from(value).unwrap_or(i64::MAX)),
                Number::Float { .. } => Err(Fault::new(
                    format!("`{}` is no integer", token.text),
                    token.place,
                )),
            },
            (Kind::Sign, "(") => {
                let value = self.binary(0)?;
                match self.next() {
                    Some(close) if close.is(")") => Ok(value),
                    _ => Err(Fault::new("this `(` is not closed", token.place).help("add `)`")),
                }
            }
            (Kind::Sign, "+" | "-" | "!" | "~") => {
                self.depth += 1;
                if self.depth > DEEPEST {
                    return Err(Fault::new("this expression nests too deeply", whole));
                }
                let value = self.unary()?;
                self.depth -= 1;
                Ok(match &*token.text {
                    "-" => value.wrapping_neg(),
                    "!" => i64::from(value == 0),
                    "~" => !value,
                    _ => value,
                })
            }
            (Kind::Word, name) => match (self.value_of)(name) {
                Some(value) => Ok(value),
                None => Err(Fault::new(
                    format!("`{name}` has no integer value here"),
                    token.place,
                )),
            },
            (Kind::Sign, sign) => Err(Fault::new(
                format!("expected an integer, found `{sign}`"),
                token.place,
            )),
        }
    }
}

fn apply(sign: &str, left: i64, right: i64) -> Option<i64> {
    let shift = |amount: i64| u32::try_from(amount).unwrap_or(u32::MAX);
    Some(match sign {
        "||" => i64::from(left != 0 || right != 0),
        "&&" => i64::from(left != 0 && right != 0),
        "|" => left | right,
        "^" => left ^ right,
        "&" => left & right,
        "==" => i64::from(left == right),
        "!=" => i64::from(left != right),
        "<" => i64::from(left < right),
        ">" => i64::from(left > right),
        "<=" => i64::from(left <= right),
        ">=" => i64::from(left >= right),
        "<<" => left.checked_shl(shift(right)).unwrap_or(0),
        ">>" => left.checked_shr(shift(right)).unwrap_or(0),
        "+" => left.wrapping_add(right),
        "-" => left.wrapping_sub(right),
        "*" => left.wrapping_mul(right),
        "/" => left.checked_div(right)?,
        _ => left.checked_rem(right)?,
    })
}

#[cfg(test)]
mod tests {
    use super::super::super::token::{Place, tokens};
    use super::evaluate;

    fn value(text: &str) -> Option<i64> {
        let tokens = tokens(text).expect("tokens");
        let known = |name: &str| (name == "N").then_some(4);
        evaluate(&tokens, Place::default(), &known).ok()
    }

    #[test]
    fn operators_bind_as_in_c() {
        for (text, expected) in [
            ("1 + 2 * 3", 7),
            ("(1 + 2) * 3", 9),
            ("10 - 4 - 3", 3),
            ("1 << 3 | 1", 9),
            ("7 & 3 == 3", 1),
            ("!0 && 2 > 1 || 0", 1),
            ("-N + ~0", -5),
            ("N % 3 ^ 6", 7),
            ("1 << 64", 0),
        ] {
            assert_eq!(value(text), Some(expected), "{text}");
        }
        for text in [
            "",
            "1 +",
            "(1",
            "1 / 0",
            "M",
            "1.0",
            "1 2",
            "9223372036854775808 / 0",
        ] {
            assert_eq!(value(text), None, "{text}");
        }
        assert_eq!(value(&"(".repeat(100_000)), None);
        assert_eq!(value(&"-".repeat(100_000)), None);
    }
}
