//! Command lines as people type them, with words in single quotes.

use crate::support::{Folder, Run};
use std::process::Command;

/// Runs a command line that begins with `estampe`, in the folder.
pub(crate) fn run(line: &str, folder: &Folder) -> Run {
    let words = words(line);
    assert_eq!(words.first().map(String::as_str), Some("estampe"), "{line}");
    let output = Command::new(env!("CARGO_BIN_EXE_estampe"))
        .args(&words[1..])
        .current_dir(folder.path(""))
        .output();
    output.expect("the command starts").into()
}

/// The words of a command line; single quotes keep spaces together.
fn words(line: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut word: Option<String> = None;
    let mut is_quoted = false;
    for c in line.chars() {
        if c == '\'' {
            is_quoted = !is_quoted;
            word.get_or_insert_default();
        } else if c.is_whitespace() && !is_quoted {
            words.extend(word.take());
        } else {
            word.get_or_insert_default().push(c);
        }
    }
    words.extend(word);
    words
}
