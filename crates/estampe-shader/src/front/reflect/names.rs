//! Author's names and types for those that the GLSL pass invents.

use std::collections::{HashMap, HashSet};

use super::ValueType;

/// From invented names to the author's. Empty for WGSL and SPIR-V.
#[derive(Debug, Clone, PartialEq, Default)]
pub(in crate::front) struct Names {
    names: HashMap<String, String>,
    types: HashMap<String, ValueType>,
    hidden: HashSet<String>,
    initial: HashMap<String, String>,
}

impl Names {
    /// Notes that `invented` stands for the author's `name`.
    pub(in crate::front) fn add(&mut self, invented: &str, name: &str) {
        self.names.insert(invented.to_owned(), name.to_owned());
    }

    /// Notes that the author declared `invented` with another type.
    pub(in crate::front) fn add_type(&mut self, invented: &str, kind: ValueType) {
        self.types.insert(invented.to_owned(), kind);
    }

    /// Notes that the author knows nothing of `invented`.
    pub(in crate::front) fn hide(&mut self, invented: &str) {
        self.hidden.insert(invented.to_owned());
    }

    /// Notes the constant that has the value with which the uniform `invented` begins.
    pub(in crate::front) fn add_initial(&mut self, invented: &str, constant: &str) {
        self.initial
            .insert(invented.to_owned(), constant.to_owned());
    }

    /// The constant that has the value with which a uniform begins.
    pub(in crate::front) fn initial(&self, name: Option<&str>) -> Option<&str> {
        self.initial.get(name?).map(String::as_str)
    }

    /// True if the author knows nothing of the name.
    pub(in crate::front) fn is_hidden(&self, name: Option<&str>) -> bool {
        name.is_some_and(|name| self.hidden.contains(name))
    }

    /// The author's name.
    pub(in crate::front) fn name(&self, name: Option<&str>) -> String {
        let name = name.unwrap_or_default();
        self.names.get(name).map_or(name, String::as_str).to_owned()
    }

    /// The type that the author declared, if it is another one than naga sees.
    pub(in crate::front) fn declared_type(&self, name: &str) -> Option<ValueType> {
        self.types.get(name).copied()
    }

    /// The message with the author's names in the place of invented ones.
    pub(in crate::front) fn in_message(&self, message: &str) -> String {
        let mut text = String::with_capacity(message.len());
        let mut word = String::new();
        for character in message.chars().chain(core::iter::once(' ')) {
            if character.is_alphanumeric() || character == '_' {
                word.push(character);
                continue;
            }
            text.push_str(self.names.get(&word).map_or(&word, |name| name));
            word.clear();
            text.push(character);
        }
        text.pop();
        text
    }
}
