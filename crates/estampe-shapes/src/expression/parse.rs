//! The parser: recursive descent from tokens to a program.

use std::ops::Range;

use super::Expression;
use super::error::ExpressionError;
use super::function::{CALLABLES, CONSTANTS, Callable, Pair};
use super::program::{Program, Step};
use super::spelling::nearest;
use super::token::{Token, TokenKind, tokens};

/// The maximum length of an expression's text, in bytes.
pub const MAX_LENGTH: usize = 10_000;

/// The maximum depth of parentheses, powers and signs inside each other.
pub const MAX_DEPTH: usize = 64;

type Parsed<T> = Result<T, ExpressionError>;

/// Parses one expression.
pub(super) fn expression(text: &str, variables: &[&str]) -> Parsed<Expression> {
    let mut parser = Parser::new(text, variables)?;
    let program = parser.program()?;
    parser.end("one expression is wanted here; remove what follows")?;
    Ok(Expression::new(text.trim(), program))
}

/// Parses expressions with commas between them.
pub(super) fn list(text: &str, variables: &[&str]) -> Parsed<Vec<Expression>> {
    let mut parser = Parser::new(text, variables)?;
    let mut parsed = Vec::new();
    loop {
        let start = parser.here().start;
        let program = parser.program()?;
        let end = parser.here().start;
        parsed.push(Expression::new(text[start..end].trim(), program));
        if !parser.takes(b',') {
            parser.end("remove what follows")?;
            return Ok(parsed);
        }
    }
}

/// Parses `left = right`, or an expression.
pub(super) fn equation(text: &str, variables: &[&str]) -> Parsed<Expression> {
    let mut parser = Parser::new(text, variables)?;
    let mut program = parser.program()?;
    if parser.takes(b'=') {
        let start = parser.here().start;
        let right = parser.program()?;
        let end = parser.here().start;
        program = program
            .minus(right)
            .ok_or_else(|| too_deep(text, start..end))?;
    }
    parser.end("an equation has one `=`; remove what follows")?;
    Ok(Expression::new(text.trim(), program))
}

struct Parser<'a> {
    text: &'a str,
    variables: &'a [&'a str],
    tokens: Vec<Token>,
    /// The number of the next token.
    at: usize,
    depth: usize,
    program: Program,
}

impl<'a> Parser<'a> {
    fn new(text: &'a str, variables: &'a [&'a str]) -> Parsed<Self> {
        debug_assert!(
            variables.len() <= 32,
            "a program has a bit for each variable"
        );
        if text.len() > MAX_LENGTH {
            let end = (0..=MAX_LENGTH).rev().find(|&at| text.is_char_boundary(at));
            let end = end.unwrap_or(0);
            let message = format!(
                "the expression has {} bytes; {MAX_LENGTH} are allowed",
                text.len()
            );
            return Err(ExpressionError::new(text, end..end, message));
        }
        Ok(Self {
            text,
            variables,
            tokens: tokens(text)?,
            at: 0,
            depth: 0,
            program: Program::default(),
        })
    }

    /// Parses a whole sum into a program of its own.
    fn program(&mut self) -> Parsed<Program> {
        self.program = Program::default();
        self.sum()?;
        Ok(std::mem::take(&mut self.program))
    }

    fn kind(&self) -> TokenKind {
        self.tokens[self.at].kind
    }

    /// The place of the next token.
    fn here(&self) -> Range<usize> {
        self.tokens[self.at].span.clone()
    }

    /// Moves to the next token; the last one, the end, stays.
    fn advance(&mut self) {
        self.at = (self.at + 1).min(self.tokens.len() - 1);
    }

    /// Takes the mark if it is next.
    fn takes(&mut self, mark: u8) -> bool {
        let is_next = self.kind() == TokenKind::Mark(mark);
        if is_next {
            self.advance();
        }
        is_next
    }

    fn fails<T>(&self, span: Range<usize>, message: impl Into<String>) -> Parsed<T> {
        Err(ExpressionError::new(self.text, span, message))
    }

    /// Checks that the text ends here.
    fn end(&self, advice: &str) -> Parsed<()> {
        let here = self.here();
        let written = &self.text[here.clone()];
        match self.kind() {
            TokenKind::End => Ok(()),
            TokenKind::Mark(b')') => self.fails(here, "there is no `(` for this `)`; remove it"),
            TokenKind::Mark(b'=') => self.fails(
                here,
                "an equation is not possible here; write one side of it",
            ),
            TokenKind::Mark(_) => {
                self.fails(here, format!("`{written}` is not possible here; {advice}"))
            }
            TokenKind::Name | TokenKind::Number(_) => self.fails(here, self.missing_operator()),
        }
    }

    /// The message if a number, a name or `(` directly follows a complete operand.
    fn missing_operator(&self) -> String {
        let next = &self.text[self.here()];
        let before = &self.tokens[self.at.saturating_sub(1)];
        let before = &self.text[before.span.clone()];
        format!("an operator is missing between `{before}` and `{next}`; to multiply, write `*`")
    }

    fn push(&mut self, step: Step, span: Range<usize>) -> Parsed<()> {
        if self.program.push(step) {
            Ok(())
        } else {
            Err(too_deep(self.text, span))
        }
    }

    fn sum(&mut self) -> Parsed<()> {
        self.product()?;
        loop {
            let pair = match self.kind() {
                TokenKind::Mark(b'+') => Pair::Add,
                TokenKind::Mark(b'-') => Pair::Subtract,
                _ => return Ok(()),
            };
            self.advance();
            self.product()?;
            self.program.combine(pair);
        }
    }

    fn product(&mut self) -> Parsed<()> {
        self.signed()?;
        loop {
            let pair = match self.kind() {
                TokenKind::Mark(b'*') => Pair::Multiply,
                TokenKind::Mark(b'/') => Pair::Divide,
                TokenKind::Mark(b'(') | TokenKind::Name | TokenKind::Number(_) => {
                    return self.fails(self.here(), self.missing_operator());
                }
                _ => return Ok(()),
            };
            self.advance();
            if pair == Pair::Multiply && self.kind() == TokenKind::Mark(b'*') {
                return self.fails(
                    self.here(),
                    "`**` is not an operator; for a power write `^`",
                );
            }
            self.signed()?;
            self.program.combine(pair);
        }
    }

    /// Every nesting passes through here, so that the depth is counted here.
    fn signed(&mut self) -> Parsed<()> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(too_deep(self.text, self.here()));
        }
        if self.takes(b'-') {
            self.signed()?;
            self.program.replace(Step::Negate);
        } else if self.takes(b'+') {
            self.signed()?;
        } else {
            self.primary()?;
            if self.takes(b'^') {
                self.signed()?;
                self.program.combine(Pair::Power);
            }
        }
        self.depth -= 1;
        Ok(())
    }

    fn primary(&mut self) -> Parsed<()> {
        let here = self.here();
        match self.kind() {
            TokenKind::Number(value) => {
                self.advance();
                self.push(Step::Constant(value), here)
            }
            TokenKind::Name => {
                self.advance();
                if self.takes(b'(') {
                    self.call(here)
                } else {
                    self.name(here)
                }
            }
            TokenKind::Mark(b'(') => {
                self.advance();
                self.sum()?;
                if self.takes(b')') {
                    return Ok(());
                }
                self.not_closed(here)
            }
            TokenKind::End if self.tokens.len() == 1 => self.fails(
                here,
                "the expression is empty; write a number, a name or a function",
            ),
            TokenKind::End => self.fails(
                here,
                "the expression ends too early; write a number, a name or `(` here",
            ),
            TokenKind::Mark(_) => {
                let written = &self.text[here.clone()];
                let message = format!("write a number, a name or `(` before this `{written}`");
                self.fails(here, message)
            }
        }
    }

    /// A variable or constant.
    fn name(&mut self, here: Range<usize>) -> Parsed<()> {
        let name = &self.text[here.clone()];
        if let Some(number) = self.variables.iter().position(|known| *known == name) {
            let number = u8::try_from(number).unwrap_or(u8::MAX);
            return self.push(Step::Variable(number), here);
        }
        if let Some((_, value)) = CONSTANTS.iter().find(|(known, _)| *known == name) {
            return self.push(Step::Constant(*value), here);
        }
        if CALLABLES.iter().any(|(known, _)| *known == name) {
            let message = format!("`{name}` is a function; write its argument, as in `{name}( )`");
            return self.fails(here, message);
        }
        let constants = CONSTANTS.iter().map(|(known, _)| *known);
        let known = self.variables.iter().copied().chain(constants);
        let advice = match nearest(name, known) {
            // A single letter is near to every other one.
            Some(near) if name.len() > 1 => format!("did you mean `{near}`?"),
            _ => match self.variables {
                [] => "the constants are `pi`, `e` and `tau`".to_owned(),
                [only] => format!("the variable is `{only}`"),
                [others @ .., last] => {
                    let others = others.join("`, `");
                    format!("the variables are `{others}` and `{last}`")
                }
            },
        };
        let shown = shortened(name);
        self.fails(here, format!("unknown name `{shown}`; {advice}"))
    }

    /// The arguments of a function, behind its opening parenthesis.
    fn call(&mut self, name_span: Range<usize>) -> Parsed<()> {
        let name = &self.text[name_span.clone()];
        let Some((_, callable)) = CALLABLES.iter().find(|(known, _)| *known == name) else {
            return self.unknown_function(name_span);
        };
        let open = self.tokens[self.at - 1].span.clone();
        if self.kind() == TokenKind::Mark(b')') {
            return self.fails(
                name_span,
                format!("`{name}` needs an argument in its parentheses"),
            );
        }
        let mut count = 1_usize;
        self.sum()?;
        while self.takes(b',') {
            self.sum()?;
            count += 1;
            if let (Callable::Many(pair), true) = (callable, count >= 2) {
                self.program.combine(*pair);
            }
            if count > MAX_DEPTH {
                return Err(too_deep(self.text, self.here()));
            }
        }
        let end = self.here().end;
        if !self.takes(b')') {
            return self.not_closed(open);
        }
        let wants = match callable {
            Callable::One(function) if count == 1 => {
                self.program.replace(Step::Apply(*function));
                return Ok(());
            }
            Callable::Two(pair) if count == 2 => {
                self.program.combine(*pair);
                return Ok(());
            }
            Callable::Many(_) if count >= 2 => return Ok(()),
            Callable::One(_) => "1 argument",
            Callable::Two(_) => "2 arguments",
            Callable::Many(_) => "2 or more arguments",
        };
        let message = format!("`{name}` takes {wants}, not {count}");
        self.fails(name_span.start..end, message)
    }

    fn unknown_function<T>(&self, span: Range<usize>) -> Parsed<T> {
        let name = &self.text[span.clone()];
        let is_number = self.variables.contains(&name)
            || CONSTANTS.iter().any(|(constant, _)| *constant == name);
        if is_number {
            let message = format!("`{name}` is not a function; to multiply, write `{name}*(`");
            return self.fails(span, message);
        }
        let known = CALLABLES.iter().map(|(known, _)| *known);
        let advice = match nearest(name, known.clone()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("there are {}", known.collect::<Vec<_>>().join(", ")),
        };
        let shown = shortened(name);
        self.fails(span, format!("unknown function `{shown}`; {advice}"))
    }

    /// The error if a parenthesis is open where something else than `)` follows.
    fn not_closed<T>(&self, open: Range<usize>) -> Parsed<T> {
        match self.kind() {
            TokenKind::End => self.fails(open, "this `(` is not closed; add a `)`"),
            TokenKind::Name | TokenKind::Number(_) => {
                self.fails(self.here(), self.missing_operator())
            }
            TokenKind::Mark(_) => {
                let here = self.here();
                let written = &self.text[here.clone()];
                self.fails(
                    here,
                    format!("`{written}` is not possible here; close the `(` before it"),
                )
            }
        }
    }
}

fn too_deep(text: &str, span: Range<usize>) -> ExpressionError {
    let message = format!(
        "the expression is nested too deeply; at most {MAX_DEPTH} levels of parentheses, powers \
         and signs are possible"
    );
    ExpressionError::new(text, span, message)
}

/// The name for a message, which a hostile one must not fill.
fn shortened(name: &str) -> String {
    const SHOWN: usize = 24;
    // Names are ASCII.
    match name.get(..SHOWN) {
        Some(start) if name.len() > SHOWN => format!("{start}…"),
        _ => name.to_owned(),
    }
}
