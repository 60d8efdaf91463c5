//! Errors of expressions, shown with a caret under the mistake.

use std::fmt;
use std::ops::Range;

/// A mistake in the text of an expression.
///
/// Its [`Display`](fmt::Display) form has three lines: the problem with advice, the text, and carets
/// under the mistake. Of a long text only the part around the mistake is shown.
///
/// ```text
/// unknown function `sni`; did you mean `sin`?
///   sni(x) + 1
///   ^^^
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    message: String,
    text: String,
    span: Range<usize>,
}

/// The number of characters around a mistake that are shown.
const SHOWN_WIDTH: usize = 72;

impl ExpressionError {
    /// A mistake at these bytes of the text.
    pub(super) fn new(text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            text: text.to_owned(),
            span,
        }
    }

    /// The problem and advice, in one line without a full stop.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The bytes of the text where the mistake is; empty if something is missing there.
    #[must_use]
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Each character takes one column; a tab or line break would move the carets.
        let shown = |c: char| if c.is_control() { ' ' } else { c };
        let characters: Vec<char> = self.text.chars().map(shown).collect();
        let column = |byte: usize| {
            let before = self.text.char_indices().take_while(|&(at, _)| at < byte);
            before.count()
        };
        let start = column(self.span.start);
        let end = column(self.span.end).max(start + 1);

        // The shown part: all of a short text, else a window with the mistake a third into it.
        let first = if characters.len() <= SHOWN_WIDTH {
            0
        } else {
            let latest = characters.len() - SHOWN_WIDTH;
            start.saturating_sub(SHOWN_WIDTH / 3).min(latest)
        };
        let last = (first + SHOWN_WIDTH).min(characters.len());
        let window: String = characters[first..last].iter().collect();
        let (before, after) = (
            if first > 0 { "…" } else { "" },
            if last < characters.len() { "…" } else { "" },
        );
        let indent = start - first + before.chars().count();
        let carets = end.min(last.max(start + 1)) - start;
        write!(
            f,
            "{}\n  {before}{window}{after}\n  {:indent$}{}",
            self.message,
            "",
            "^".repeat(carets)
        )
    }
}

impl std::error::Error for ExpressionError {}
