//! A limit on chains of operators and of `else` in WGSL: naga limits brackets, and recurses along
//! chains without a limit.

use super::lines::Lines;
use super::{Limits, ShaderError};

/// How many operators may follow each other, for each level of `Limits::nesting`.
const OPERATORS_PER_LEVEL: usize = 8;

/// How many `else` may follow each other, for each level of `Limits::nesting`.
const BRANCHES_PER_LEVEL: usize = 2;

/// The signs that expressions nest along.
const OPERATORS: &[u8] = b"+-*/%&|^<>=!~.";

/// Operators and branches since the last end of what they belong to.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    operators: usize,
    branches: usize,
}

/// Checks the chains of a text. Wrong brackets are left to naga.
pub(super) fn check(text: &str, limits: Limits) -> Result<(), ShaderError> {
    let bytes = text.as_bytes();
    let mut open: Vec<Counts> = Vec::new();
    // Since the last bracket, and in all that is open.
    let (mut counts, mut total) = (Counts::default(), Counts::default());
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        if let Some(end) = comment(text, at) {
            at = end;
            continue;
        }
        let is_name = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
        let length = bytes[at..].iter().take_while(|byte| is_name(byte)).count();
        match byte {
            _ if &bytes[at..at + length] == b"else" => {
                counts.branches += 1;
                total.branches += 1;
            }
            b'(' | b'[' | b'{' => {
                // An index is a link of a chain too.
                counts.operators += 1;
                total.operators += 1;
                open.push(core::mem::take(&mut counts));
            }
            b')' | b']' | b'}' => {
                total.operators -= counts.operators;
                total.branches -= counts.branches;
                counts = open.pop().unwrap_or_default();
                if byte == b'}' {
                    total.operators -= core::mem::take(&mut counts.operators);
                    let rest = skip_space(text, at + 1);
                    if !text[rest..].starts_with("else") {
                        total.branches -= core::mem::take(&mut counts.branches);
                    }
                }
            }
            b',' | b';' => total.operators -= core::mem::take(&mut counts.operators),
            _ if OPERATORS.contains(&byte) => {
                counts.operators += 1;
                total.operators += 1;
            }
            _ => {}
        }
        let what = if total.operators > limits.nesting.saturating_mul(OPERATORS_PER_LEVEL) {
            "operators"
        } else if total.branches > limits.nesting.saturating_mul(BRANCHES_PER_LEVEL) {
            "branches"
        } else {
            at += length.max(1);
            continue;
        };
        return Err(
            ShaderError::new(format!("too many {what} follow each other here"))
                .at(&Lines::new(text), at, at + 1)
                .help("name parts of it with `let`, or move them to functions"),
        );
    }
    Ok(())
}

/// The end of the white space and comments from `at` on.
fn skip_space(text: &str, mut at: usize) -> usize {
    loop {
        let rest = &text[at..];
        let space = rest.len() - rest.trim_start().len();
        at += space;
        match comment(text, at) {
            Some(end) => at = end,
            None => return at,
        }
    }
}

/// The end of the comment that begins at `at` (WGSL, section 3.3).
fn comment(text: &str, at: usize) -> Option<usize> {
    let bytes = &text.as_bytes()[at..];
    if bytes.starts_with(b"//") {
        let is_end =
            |character: char| matches!(character, '\n'..='\r' | '\u{85}' | '\u{2028}' | '\u{2029}');
        return Some(text[at..].find(is_end).map_or(text.len(), |end| at + end));
    }
    if !bytes.starts_with(b"/*") {
        return None;
    }
    let mut depth = 0_usize;
    let mut inside = 0;
    while inside < bytes.len() {
        match &bytes[inside..] {
            [b'/', b'*', ..] => {
                depth += 1;
                inside += 2;
            }
            [b'*', b'/', ..] => {
                depth -= 1;
                inside += 2;
                if depth == 0 {
                    return Some(at + inside);
                }
            }
            _ => inside += 1,
        }
    }
    Some(text.len())
}
