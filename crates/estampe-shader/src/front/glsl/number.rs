//! Numbers of GLSL: their values, and their spelling for naga.

use super::Fault;
use super::token::Token;

/// A number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Number {
    /// An integer, and if it has the suffix `u`.
    Integer { value: u64, is_unsigned: bool },
    /// A floating-point number, and if it has the suffix `lf`.
    Float { value: f32, is_double: bool },
}

/// The number that a token spells (GLSL 4.60, section 4.1).
pub(super) fn number(token: &Token) -> Result<Number, Fault> {
    let text = &*token.text;
    let fault = |message: String, help: &str| Err(Fault::new(message, token.place).help(help));
    let lower = text.to_ascii_lowercase();
    let is_hex = lower.starts_with("0x");
    let is_float = !is_hex && lower.contains(['.', 'e', 'f']);
    if is_float {
        let (digits, is_double) = match lower.strip_suffix("lf") {
            Some(digits) => (digits, true),
            None => (lower.strip_suffix('f').unwrap_or(&lower), false),
        };
        let has_bad = digits.contains(|c: char| !c.is_ascii_digit() && !".e+-".contains(c));
        return match digits.parse::<f32>() {
            Ok(value) if value.is_infinite() => fault(
                format!("`{text}` does not fit into 32-bit floating point"),
                "the largest number is about 3.4e38",
            ),
            Ok(value) if !has_bad => Ok(Number::Float { value, is_double }),
            _ => fault(
                format!("`{text}` is no number"),
                "write it like `1.0` or `1e-3`",
            ),
        };
    }
    let (digits, is_unsigned) = match lower.strip_suffix('u') {
        Some(digits) => (digits, true),
        None => (&*lower, false),
    };
    let (digits, base) = if is_hex {
        (&digits[2.min(digits.len())..], 16)
    } else if digits.len() > 1 && digits.starts_with('0') {
        (&digits[1..], 8)
    } else {
        (digits, 10)
    };
    match u64::from_str_radix(digits, base) {
        Ok(value) if value <= u64::from(u32::MAX) && !digits.starts_with('+') => {
            Ok(Number::Integer { value, is_unsigned })
        }
        Ok(_) => fault(
            format!("`{text}` does not fit into 32 bits"),
            "use a smaller number",
        ),
        Err(_) if base == 8 && digits.bytes().all(|digit| digit.is_ascii_digit()) => fault(
            format!("`{text}` begins with 0, so it is octal, but 8 and 9 are no octal digits"),
            "remove the leading 0",
        ),
        Err(_) => fault(
            format!("`{text}` is no number"),
            "write it like `1`, `1u` or `0xff`",
        ),
    }
}

/// The number as naga reads it.
pub(super) fn spelling(token: &Token) -> Result<String, Fault> {
    Ok(match number(token)? {
        Number::Integer { value, is_unsigned } => {
            format!("{value}{}", if is_unsigned { "u" } else { "" })
        }
        Number::Float {
            is_double: true, ..
        } => {
            return Err(
                Fault::new("64-bit floating point is not supported", token.place)
                    .help("remove the suffix `lf`"),
            );
        }
        Number::Float { value, .. } => format!("{value:?}"),
    })
}

#[cfg(test)]
mod tests {
    use super::super::token::tokens;
    use super::spelling;

    fn spelled(text: &str) -> Option<String> {
        let tokens = tokens(text).expect("tokens");
        assert_eq!(tokens.len(), 1, "{text} is one token");
        spelling(&tokens[0]).ok()
    }

    #[test]
    fn numbers_keep_their_values() {
        for (text, expected) in [
            ("0", "0"),
            ("017", "15"),
            ("0xFFu", "255u"),
            ("4294967295U", "4294967295u"),
            ("1.", "1.0"),
            (".5", "0.5"),
            ("2f", "2.0"),
            ("1e-3F", "0.001"),
            ("3.0e+2", "300.0"),
            ("16777217.0", "16777216.0"),
        ] {
            assert_eq!(spelled(text).as_deref(), Some(expected), "{text}");
        }
        for text in [
            "08",
            "0x",
            "1.0x",
            "1e",
            "4294967296",
            "1e39",
            "1.0lf",
            "1_0",
            "2u2",
        ] {
            assert_eq!(spelled(text), None, "{text}");
        }
    }
}
