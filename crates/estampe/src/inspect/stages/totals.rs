//! The totals of a stage, as a line of text and as JSON.

use serde_json::{Map, Value};

/// Named numbers in order.
#[derive(Debug, Default)]
pub(in crate::inspect) struct Totals {
    /// The words of the line, such as "12 clipped".
    words: Vec<String>,
    numbers: Map<String, Value>,
}

impl Totals {
    /// Adds a number with its name in JSON and the words after it in text.
    pub(super) fn count(mut self, name: &str, words: &str, count: impl Into<u64>) -> Self {
        let count = count.into();
        self.words.push(format!("{count} {words}"));
        self.numbers.insert(name.to_owned(), count.into());
        self
    }

    /// Adds a number with two digits after the point.
    pub(super) fn mean(mut self, name: &str, words: &str, sum: u64, count: u64) -> Self {
        let mean = sum as f64 / count.max(1) as f64;
        self.words.push(format!("{mean:.2} {words}"));
        self.numbers.insert(name.to_owned(), mean.into());
        self
    }

    /// Adds what is only in JSON.
    pub(super) fn value(mut self, name: &str, value: Value) -> Self {
        self.numbers.insert(name.to_owned(), value);
        self
    }

    pub(in crate::inspect) fn text(&self) -> String {
        self.words.join(", ")
    }

    pub(in crate::inspect) fn json(&self) -> Value {
        Value::Object(self.numbers.clone())
    }
}
