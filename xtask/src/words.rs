//! Words that the glossary decided against, so that names do not drift.

use crate::{Finding, Repository};

/// The spellings that match a banned word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Case {
    /// Letters of either case, and `-`, `_` or nothing in place of a space.
    Any,
    /// Exactly as written, as a whole word.
    Exact,
}

/// A word, how it is matched, and what to write instead.
const BANNED: &[(&str, Case, &str)] = &[
    (
        "screen space",
        Case::Any,
        "window space: the specifications' word",
    ),
    (
        "screen coordinate",
        Case::Any,
        "window coordinate: the specifications' word",
    ),
    (
        "homogeneous ndc",
        Case::Any,
        "NDC comes after the division: clip space is homogeneous",
    ),
    ("homogenous", Case::Any, "homogeneous"),
    ("pixel shader", Case::Any, "fragment shader"),
    (
        "object_to_world",
        Case::Exact,
        "world_from_object: a transform is named to_from",
    ),
    (
        "model_to_world",
        Case::Exact,
        "world_from_object: a transform is named to_from",
    ),
    (
        "world_to_view",
        Case::Exact,
        "view_from_world: a transform is named to_from",
    ),
    (
        "world_to_clip",
        Case::Exact,
        "clip_from_world: a transform is named to_from",
    ),
    (
        "view_to_clip",
        Case::Exact,
        "clip_from_view: a transform is named to_from",
    ),
    ("TODO", Case::Exact, "an issue"),
    ("FIXME", Case::Exact, "an issue"),
    ("XXX", Case::Exact, "an issue"),
];

/// The files that speak about the words instead of using them.
const SPEAKS_OF_WORDS: &[&str] = &["GLOSSARY.md", "STYLE.md", "xtask/src/words.rs"];

/// Checks sources and documents for banned words.
#[must_use]
pub fn check_words(repository: &Repository) -> Vec<Finding> {
    let banned: Vec<_> = BANNED.iter().map(Banned::new).collect();
    let mut findings = Vec::new();
    for file in repository.files() {
        if SPEAKS_OF_WORDS
            .iter()
            .any(|path| file.path.as_os_str() == *path)
        {
            continue;
        }
        for (index, line) in file.text.lines().enumerate() {
            let squeezed = squeezed(line);
            for banned in banned.iter().filter(|word| word.is_in(line, &squeezed)) {
                let Banned { word, instead, .. } = banned;
                let message = format!("\"{word}\": write {instead}");
                findings.push(Finding::error(&file.path, index + 1, message));
            }
        }
    }
    findings
}

/// A row of [`BANNED`].
struct Banned {
    word: &'static str,
    case: Case,
    instead: &'static str,
    /// The word as [`squeezed`] text.
    squeezed: String,
}

impl Banned {
    fn new(&(word, case, instead): &(&'static str, Case, &'static str)) -> Self {
        let squeezed = squeezed(word);
        Self {
            word,
            case,
            instead,
            squeezed,
        }
    }

    /// True if a line has the word. Its squeezed text is made once for all words.
    fn is_in(&self, line: &str, squeezed: &str) -> bool {
        match self.case {
            Case::Any => squeezed.contains(&self.squeezed),
            Case::Exact => line.match_indices(self.word).any(|(at, word)| {
                !ends_in_word(&line[..at]) && !starts_with_word(&line[at + word.len()..])
            }),
        }
    }
}

/// Lower case, without what may stand between the parts of a word. The banned words have no letters
/// beyond ASCII.
fn squeezed(text: &str) -> String {
    let mut squeezed = text.replace([' ', '-', '_'], "");
    squeezed.make_ascii_lowercase();
    squeezed
}

fn ends_in_word(text: &str) -> bool {
    text.chars().next_back().is_some_and(char::is_alphanumeric)
}

fn starts_with_word(text: &str) -> bool {
    text.chars().next().is_some_and(char::is_alphanumeric)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contains(line: &str, word: &'static str, case: Case) -> bool {
        Banned::new(&(word, case, "")).is_in(line, &squeezed(line))
    }

    #[test]
    fn every_spelling_is_found() {
        for line in [
            "in Screen Space,",
            "fn screen_space()",
            "struct ScreenSpace",
            "screen-space",
        ] {
            assert!(contains(line, "screen space", Case::Any), "{line}");
        }
        assert!(contains("// TODO: later", "TODO", Case::Exact));
        assert!(!contains(
            "the spaces of a screen",
            "screen space",
            Case::Any
        ));
        assert!(!contains("TODOS Mastodon", "TODO", Case::Exact));
    }

    #[test]
    fn findings_say_where() {
        let source = "fn a() {}\n// pixel shader\n";
        let found = check_words(&Repository::synthetic(&[
            ("crates/x/src/a.rs", source),
            ("GLOSSARY.md", source),
        ]));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].line, 2);
    }

    #[test]
    fn the_list_is_consistent() {
        for (word, _, instead) in BANNED {
            for (banned, case, _) in BANNED {
                assert!(
                    !contains(instead, banned, *case),
                    "{word}: {instead} holds {banned}"
                );
            }
        }
    }
}
