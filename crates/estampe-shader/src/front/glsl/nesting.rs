//! Brackets, and a limit on how deeply a text nests, as what reads it recurses.

use super::super::Limits;
use super::Fault;
use super::token::{Kind, Token};

/// How many operators may follow each other without a bracket, for each level of `Limits::nesting`.
const OPERATORS_PER_LEVEL: usize = 8;

/// Operators and branches that follow each other.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    operators: usize,
    branches: usize,
}

impl Counts {
    /// Takes what has ended from the total.
    fn remove(&mut self, operators: &mut usize, branches: &mut usize) {
        self.operators -= core::mem::take(operators);
        self.branches -= core::mem::take(branches);
    }
}

/// The position of the bracket that closes the one at `at`. `None` if none opens there.
pub(super) fn close(tokens: &[Token], at: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (index, token) in tokens.iter().enumerate().skip(at) {
        match (token.kind, &*token.text) {
            (Kind::Sign, "(" | "[" | "{") => depth += 1,
            (Kind::Sign, ")" | "]" | "}") => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    return Some(index);
                }
            }
            _ if depth == 0 => return None,
            _ => {}
        }
    }
    None
}

/// Checks brackets, chains of operators, and chains of `else if`.
pub(super) fn check(tokens: &[Token], limits: Limits) -> Result<(), Fault> {
    let mut open: Vec<(&Token, Counts)> = Vec::new();
    // Since the last bracket, and in all.
    let (mut counts, mut total) = (Counts::default(), Counts::default());
    for (index, token) in tokens.iter().enumerate() {
        super::token::check_sign(token)?;
        let too_deep = |what: &str| {
            Err(Fault::new(format!("{what} here"), token.place)
                .help("name parts of it with variables, or move them to functions"))
        };
        match (token.kind, &*token.text) {
            (Kind::Sign, "(" | "[" | "{") => {
                open.push((token, counts));
                counts = Counts::default();
                if open.len() > limits.nesting {
                    return too_deep("brackets nest too deeply");
                }
            }
            (Kind::Sign, close @ (")" | "]" | "}")) => {
                let (opening, before) = open.pop().ok_or_else(|| {
                    Fault::new(
                        format!("nothing is open that this `{close}` closes"),
                        token.place,
                    )
                    .help("remove it, or look for a bracket that is closed too early before it")
                })?;
                let fits = matches!(
                    (&*opening.text, close),
                    ("(", ")") | ("[", "]") | ("{", "}")
                );
                if !fits {
                    return Err(Fault::new(
                        format!("`{}` is not closed before this `{close}`", opening.text),
                        token.place,
                    )
                    .help(format!("close the `{}` first", opening.text)));
                }
                total.remove(&mut counts.operators, &mut counts.branches);
                counts = before;
            }
            (Kind::Sign, "," | ";") => total.remove(&mut counts.operators, &mut 0),
            (Kind::Sign, _) => {
                counts.operators += 1;
                total.operators += 1;
                if total.operators > limits.nesting.saturating_mul(OPERATORS_PER_LEVEL) {
                    return too_deep("too many operators follow each other");
                }
            }
            (Kind::Word, "else" | "for" | "while" | "do" | "if") => {
                counts.branches += 1;
                total.branches += 1;
                if total.branches > limits.nesting.saturating_mul(2) {
                    return too_deep("too many branches follow each other");
                }
            }
            _ => {}
        }
        // A statement ends here, unless `else` goes on with it.
        let ends = token.is(";") || token.is("}");
        let in_block = open.last().is_none_or(|(opening, _)| opening.is("{"));
        if ends && in_block && !tokens.get(index + 1).is_some_and(|next| next.is("else")) {
            total.remove(&mut counts.operators, &mut counts.branches);
        }
    }
    match open.last() {
        None => Ok(()),
        Some((opening, _)) => Err(Fault::new(
            format!("this `{}` is not closed", opening.text),
            opening.place,
        )
        .help("close it, or look for a bracket that is missing after it")),
    }
}
