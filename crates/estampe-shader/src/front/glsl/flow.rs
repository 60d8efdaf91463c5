//! Control flow that naga reads otherwise than GLSL has it, brought to forms that it reads right.
//!
//! | written | becomes | because |
//! |---|---|---|
//! | `do S while (c);` | `for (bool go = true; go; go = (c)) S` | `continue` in `S` goes on with `c` |
//! | `a && b` | `(a ? b : false)` | `b` is evaluated only if `a` is true |
//! | `a \|\| b` | `(a ? true : b)` | `b` is evaluated only if `a` is false |
//!
//! The last two only where `b` can be told from a value that is always computed: where it calls a
//! function of the author, or assigns (GLSL 4.60, sections 5.9 and 6.3).

use core::ops::Range;

use super::nesting::close;
use super::token::{Kind, Place, Token};
use super::unit::Unit;

/// The body of a function with these forms rewritten. `invent` gives names that the author does
/// not use.
pub(super) fn rewrite(
    unit: &Unit,
    body: &[Token],
    invent: &mut dyn FnMut(&str) -> String,
) -> Vec<Token> {
    let mut flow = Flow {
        unit,
        tokens: body,
        invent,
        out: Vec::with_capacity(body.len()),
    };
    flow.statements(0..body.len());
    flow.out
}

struct Flow<'a> {
    unit: &'a Unit,
    tokens: &'a [Token],
    invent: &'a mut dyn FnMut(&str) -> String,
    out: Vec<Token>,
}

impl Flow<'_> {
    fn is(&self, at: usize, text: &str) -> bool {
        self.tokens.get(at).is_some_and(|token| token.is(text))
    }

    fn copy(&mut self, range: Range<usize>) {
        self.out.extend_from_slice(&self.tokens[range]);
    }

    fn add(&mut self, kind: Kind, text: &str, place: Place) {
        self.out.push(Token::new(kind, text, place));
    }

    fn statements(&mut self, range: Range<usize>) {
        let mut at = range.start;
        while at < range.end {
            at = self.statement(at, range.end);
        }
    }

    /// Writes the statement at a place, and gives where the next one starts.
    fn statement(&mut self, at: usize, end: usize) -> usize {
        if at >= end {
            return end;
        }
        match &*self.tokens[at].text {
            "{" => self.group(at),
            "do" => self.do_while(at, end),
            "if" | "while" | "for" | "switch" if self.is(at + 1, "(") => {
                self.copy(at..at + 1);
                let body = self.group(at + 1);
                let after = self.statement(body, end);
                if self.is(at, "if") && after < end && self.is(after, "else") {
                    self.copy(after..after + 1);
                    return self.statement(after + 1, end);
                }
                after
            }
            "case" | "default" => {
                let colon = (at..end).find(|&at| self.is(at, ":"));
                let after = colon.map_or(end, |colon| colon + 1);
                self.copy(at..after);
                after
            }
            _ => {
                let stop = self.find(at..end, |token| token.is(";")).unwrap_or(end);
                self.expression(at..stop);
                let after = (stop + 1).min(end);
                self.copy(stop..after);
                after
            }
        }
    }

    /// Writes a group in brackets: statements in braces after a statement, expressions otherwise.
    fn group(&mut self, open: usize) -> usize {
        let Some(close) = close(self.tokens, open) else {
            self.copy(open..self.tokens.len());
            return self.tokens.len();
        };
        self.copy(open..open + 1);
        if self.is(open, "{") {
            self.statements(open + 1..close);
        } else {
            self.expression(open + 1..close);
        }
        self.copy(close..close + 1);
        close + 1
    }

    fn do_while(&mut self, at: usize, end: usize) -> usize {
        let place = self.tokens[at].place;
        let start = self.out.len();
        let name = (self.invent)("go");
        let header = [
            "for", "(", "bool", &name, "=", "true", ";", &name, ";", &name, "=",
        ];
        for text in header {
            let is_word = text.starts_with(|first: char| first.is_alphabetic() || first == '_');
            let kind = if is_word { Kind::Word } else { Kind::Sign };
            self.add(kind, text, place);
        }
        let header_end = self.out.len();
        let after = self.statement(at + 1, end);
        let condition = after + 1;
        let close = close(self.tokens, condition).filter(|_| self.is(after, "while"));
        let Some(close) = close.filter(|&close| self.is(close + 1, ";")) else {
            // naga says what is wrong with it.
            self.out.truncate(start);
            self.copy(at..after);
            return after;
        };
        let body = self.out.split_off(header_end);
        self.group(condition);
        self.add(Kind::Sign, ")", self.tokens[close].place);
        self.out.extend(body);
        close + 2
    }

    /// Writes an expression, a list of them, or a declaration.
    fn expression(&mut self, range: Range<usize>) {
        let mut at = range.start;
        while at < range.end {
            let stop = self.find(at..range.end, is_boundary).unwrap_or(range.end);
            self.chain(at..stop, 0);
            let after = (stop + 1).min(range.end);
            self.copy(stop..after);
            at = after;
        }
    }

    /// Writes operands of a logical operator, from the one that binds least to that which binds
    /// most.
    fn chain(&mut self, range: Range<usize>, level: usize) {
        let Some(&sign) = ["||", "^^", "&&"].get(level) else {
            return self.operand(range);
        };
        let mut starts = vec![range.start];
        while let Some(at) = self.find(starts[starts.len() - 1]..range.end, |token| token.is(sign))
        {
            starts.push(at + 1);
        }
        let operands: Vec<_> = (0..starts.len())
            .map(|index| {
                let end = starts.get(index + 1).map_or(range.end, |next| next - 1);
                starts[index]..end
            })
            .collect();
        let is_lazy = |flow: &Self, operand: &Range<usize>| {
            sign != "^^" && operand.start > range.start && flow.has_effects(operand.clone())
        };
        for operand in &operands {
            if is_lazy(self, operand) {
                self.add(Kind::Sign, "(", self.tokens[operand.start - 1].place);
            }
        }
        for operand in operands {
            if operand.start == range.start {
                self.chain(operand, level + 1);
                continue;
            }
            let place = self.tokens[operand.start - 1].place;
            if !is_lazy(self, &operand) {
                self.copy(operand.start - 1..operand.start);
                self.chain(operand, level + 1);
            } else if sign == "&&" {
                self.add(Kind::Sign, "?", place);
                self.chain(operand, level + 1);
                self.add(Kind::Sign, ":", place);
                self.add(Kind::Word, "false", place);
                self.add(Kind::Sign, ")", place);
            } else {
                self.add(Kind::Sign, "?", place);
                self.add(Kind::Word, "true", place);
                self.add(Kind::Sign, ":", place);
                self.chain(operand, level + 1);
                self.add(Kind::Sign, ")", place);
            }
        }
    }

    /// Writes what holds no logical operator outside of brackets.
    fn operand(&mut self, range: Range<usize>) {
        let mut at = range.start;
        while at < range.end {
            let is_open = ["(", "[", "{"].iter().any(|open| self.is(at, open));
            match close(self.tokens, at).filter(|_| is_open) {
                Some(close) => {
                    self.copy(at..at + 1);
                    self.expression(at + 1..close);
                    self.copy(close..close + 1);
                    at = close + 1;
                }
                None => {
                    self.copy(at..at + 1);
                    at += 1;
                }
            }
        }
    }

    /// The first token outside of brackets of which something is true.
    fn find(&self, range: Range<usize>, test: impl Fn(&Token) -> bool) -> Option<usize> {
        let mut depth = 0_usize;
        for at in range {
            match &*self.tokens[at].text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                _ if depth == 0 && test(&self.tokens[at]) => return Some(at),
                _ => {}
            }
        }
        None
    }

    /// True if it may be seen whether these tokens are evaluated.
    fn has_effects(&self, range: Range<usize>) -> bool {
        range.into_iter().any(|at| {
            let token = &self.tokens[at];
            let is_call = token.is_word() && self.is(at + 1, "(");
            is_call && self.unit.has_function(&token.text)
                || token.is("++")
                || token.is("--")
                || super::body::is_assignment(token)
        })
    }
}

/// True for what no operand of a logical operator reaches across.
fn is_boundary(token: &Token) -> bool {
    let signs = [",", ";", "?", ":"];
    signs.iter().any(|sign| token.is(sign))
        || token.is("return")
        || super::body::is_assignment(token)
}
