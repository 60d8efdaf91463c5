//! Rust sources as token streams: identifiers, relative paths, and code without its tests.
//!
//! A token stream shows the inside of macros (where shaders are written) and code under every
//! `cfg`. A syntax tree (`syn`) shows neither, which is why the lexer alone is used.

use proc_macro2::{Delimiter, LexError, Span, TokenStream, TokenTree};

/// A source as token trees. Comments are gone; a doc comment is a `#[doc = "…"]` attribute.
#[derive(Debug, Clone)]
pub(crate) struct RustSource {
    trees: Vec<TokenTree>,
}

/// An identifier and its line, from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Identifier {
    pub(crate) name: String,
    pub(crate) line: usize,
}

/// A path that starts at `crate`, `super` or `self`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RelativePath {
    /// The segments, the first included. The groups of a `use` are unfolded: one path per name.
    pub(crate) segments: Vec<String>,
    /// The line of its last segment, from 1.
    pub(crate) line: usize,
}

impl RustSource {
    /// Splits a source into token trees.
    ///
    /// # Errors
    /// An unclosed delimiter or literal.
    pub(crate) fn parse(text: &str) -> Result<Self, LexError> {
        let stream: TokenStream = text.parse()?;
        Ok(Self {
            trees: stream.into_iter().collect(),
        })
    }

    /// The source without the items under `#[cfg(test)]`, at any depth.
    pub(crate) fn without_test_items(&self) -> Self {
        Self {
            trees: without_test_items(&self.trees),
        }
    }

    /// The line of the last token, from 1; 0 where there is none.
    pub(crate) fn last_line(&self) -> usize {
        self.trees
            .last()
            .map_or(0, |tree| last_span(tree).end().line)
    }

    /// Every identifier and keyword, in order.
    pub(crate) fn identifiers(&self) -> Vec<Identifier> {
        let mut found = Vec::new();
        collect_identifiers(&self.trees, &mut found);
        found
    }

    /// Every path that starts at `crate`, `super` or `self`, in order.
    pub(crate) fn relative_paths(&self) -> Vec<RelativePath> {
        let mut found = Vec::new();
        collect_paths(&self.trees, &mut found);
        found
    }

    /// Returns true if the source has the inner attribute `#![level(lint)]`.
    pub(crate) fn has_inner_attribute(&self, level: &str, lint: &str) -> bool {
        let wanted = format!("{level} ({lint})");
        self.trees.windows(3).any(|window| match window {
            [hash, bang, TokenTree::Group(attribute)] => {
                is_punct(hash, '#')
                    && is_punct(bang, '!')
                    && attribute.stream().to_string() == wanted
            }
            _ => false,
        })
    }
}

fn last_span(tree: &TokenTree) -> Span {
    match tree {
        TokenTree::Group(group) => group.span_close(),
        _ => tree.span(),
    }
}

fn is_punct(tree: &TokenTree, wanted: char) -> bool {
    matches!(tree, TokenTree::Punct(punct) if punct.as_char() == wanted)
}

/// Returns true if `::` starts at `at`.
fn is_separator(trees: &[TokenTree], at: usize) -> bool {
    matches!(trees.get(at..at + 2), Some([a, b]) if is_punct(a, ':') && is_punct(b, ':'))
}

fn inner_trees(group: &proc_macro2::Group) -> Vec<TokenTree> {
    group.stream().into_iter().collect()
}

fn without_test_items(trees: &[TokenTree]) -> Vec<TokenTree> {
    let mut kept = Vec::with_capacity(trees.len());
    let mut at = 0;
    while let Some(tree) = trees.get(at) {
        if is_cfg_test(trees, at) {
            at = end_of_item(trees, at + 2);
            continue;
        }
        kept.push(match tree {
            TokenTree::Group(group) => {
                let inner = without_test_items(&inner_trees(group));
                let mut copy =
                    proc_macro2::Group::new(group.delimiter(), inner.into_iter().collect());
                copy.set_span(group.span());
                TokenTree::Group(copy)
            }
            other => other.clone(),
        });
        at += 1;
    }
    kept
}

/// Returns true if the attribute `#[cfg(test)]` starts at `at`.
fn is_cfg_test(trees: &[TokenTree], at: usize) -> bool {
    match trees.get(at..at + 2) {
        Some([hash, TokenTree::Group(attribute)]) if is_punct(hash, '#') => {
            // To write out a stream takes long, and most attributes are documentation.
            let first = attribute.stream().into_iter().next();
            let is_cfg = matches!(first, Some(TokenTree::Ident(word)) if word == "cfg");
            is_cfg && attribute.stream().to_string() == "cfg (test)"
        }
        _ => false,
    }
}

/// The position after the item that starts at `start`: behind its braces or its semicolon.
fn end_of_item(trees: &[TokenTree], start: usize) -> usize {
    let is_end = |tree: &TokenTree| match tree {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        tree => is_punct(tree, ';'),
    };
    // `use a::{b, c};` has braces and ends at its semicolon.
    let is_use = matches!(trees.get(start), Some(TokenTree::Ident(word)) if word == "use");
    let is_end = |tree: &TokenTree| {
        if is_use {
            is_punct(tree, ';')
        } else {
            is_end(tree)
        }
    };
    (start..trees.len())
        .find(|&at| is_end(&trees[at]))
        .map_or(trees.len(), |at| at + 1)
}

fn collect_identifiers(trees: &[TokenTree], found: &mut Vec<Identifier>) {
    for tree in trees {
        match tree {
            TokenTree::Ident(name) => found.push(Identifier {
                name: name.to_string(),
                line: name.span().start().line,
            }),
            TokenTree::Group(group) => collect_identifiers(&inner_trees(group), found),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}

fn collect_paths(trees: &[TokenTree], found: &mut Vec<RelativePath>) {
    let mut at = 0;
    while let Some(tree) = trees.get(at) {
        let continues_path = at >= 2 && is_separator(trees, at - 2);
        match tree {
            TokenTree::Ident(word)
                if (word == "crate" || word == "super" || word == "self")
                    && is_separator(trees, at + 1)
                    && !continues_path =>
            {
                at = unfold(trees, at, &[], found);
                continue;
            }
            TokenTree::Group(group) => collect_paths(&inner_trees(group), found),
            _ => {}
        }
        at += 1;
    }
}

/// Adds the paths of one path tree (`a::b`, `a::{b, c::d}`, `a::*`) and returns where it ends.
fn unfold(
    trees: &[TokenTree],
    start: usize,
    prefix: &[String],
    found: &mut Vec<RelativePath>,
) -> usize {
    let mut segments = prefix.to_vec();
    let mut at = start;
    let mut line = 0;
    while let Some(tree) = trees.get(at) {
        match tree {
            TokenTree::Ident(name) => segments.push(name.to_string()),
            TokenTree::Punct(star) if star.as_char() == '*' => segments.push("*".to_owned()),
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
                let inner = inner_trees(group);
                for branch in inner.split(|tree| is_punct(tree, ',')) {
                    unfold(branch, 0, &segments, found);
                }
                return at + 1;
            }
            _ => break,
        }
        line = tree.span().start().line;
        at += 1;
        if !is_separator(trees, at) {
            break;
        }
        at += 2;
    }
    if segments.len() > prefix.len() {
        found.push(RelativePath { segments, line });
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> RustSource {
        RustSource::parse(text).expect("the text is made of Rust's tokens")
    }

    fn paths_of(text: &str) -> Vec<String> {
        let paths = source(text).relative_paths();
        paths.iter().map(|path| path.segments.join("::")).collect()
    }

    fn names_of(source: &RustSource) -> String {
        let names: Vec<String> = source
            .identifiers()
            .into_iter()
            .map(|found| found.name)
            .collect();
        names.join(" ")
    }

    #[test]
    fn comments_and_literals_are_no_identifiers() {
        let text = "a // x\nb /* c /* d */ e */ \"g \\\" h\" 'i' r#\"l \" m\"# br\"n\" m!{ p(q) }";
        assert_eq!(names_of(&source(text)), "a b m p q");
        let lines: Vec<usize> = source("a\n\n/* \n */ b")
            .identifiers()
            .iter()
            .map(|i| i.line)
            .collect();
        assert_eq!(lines, [1, 4]);
    }

    #[test]
    fn an_unclosed_delimiter_is_an_error() {
        for text in ["\"a", "r#\"a\"", "{", ")"] {
            assert!(RustSource::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn groups_are_unfolded() {
        let text =
            "use crate::{raster::{edge::Edge, *}, tiles as t, self};\nlet x = super::cull();";
        assert_eq!(
            paths_of(text),
            [
                "crate::raster::edge::Edge",
                "crate::raster::*",
                "crate::tiles",
                "crate::self",
                "super::cull"
            ]
        );
    }

    #[test]
    fn paths_inside_expressions_and_macros_are_seen() {
        assert_eq!(
            paths_of("dispatch!(|| crate::raster::run(self.x, a::super_b, pub(crate) fn))"),
            ["crate::raster::run"]
        );
        assert_eq!(
            paths_of("crate::f::<super::T>(self::g())"),
            ["crate::f", "super::T", "self::g"]
        );
    }

    #[test]
    fn test_items_are_removed() {
        let text = "fn a() {} #[cfg(test)] mod tests { fn b() { {} } } #[cfg(test)] use c::{x};\n\
                    mod m { #[cfg(test)] fn e() {} } fn d() {}";
        assert_eq!(
            names_of(&source(text).without_test_items()),
            "fn a mod m fn d"
        );
    }

    #[test]
    fn the_last_line_is_that_of_the_last_token() {
        assert_eq!(source("").last_line(), 0);
        assert_eq!(source("fn a() {\n}\n// b\n").last_line(), 2);
    }

    #[test]
    fn inner_attributes_are_found() {
        let root = source("//! Text.\n#![forbid(unsafe_code)]\n");
        assert!(root.has_inner_attribute("forbid", "unsafe_code"));
        assert!(!root.has_inner_attribute("deny", "unsafe_code"));
        assert!(
            !source("#[forbid(unsafe_code)] fn f() {}")
                .has_inner_attribute("forbid", "unsafe_code")
        );
    }
}
