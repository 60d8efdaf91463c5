//! `estampe man`: a manual page of each subcommand.

use crate::support::{Folder, estampe, subcommands};
use std::collections::BTreeSet;
use std::fs;

#[test]
fn every_subcommand_has_a_page() {
    let folder = Folder::new();
    let run = estampe("man --output {}", &[&folder.path("man1")]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let mut expected = BTreeSet::from(["estampe.1".to_owned()]);
    for command in subcommands("") {
        expected.insert(format!("estampe-{command}.1"));
        if command == "shader" {
            let nested = subcommands("shader").into_iter();
            expected.extend(nested.map(|nested| format!("estampe-shader-{nested}.1")));
        }
    }
    let entries = fs::read_dir(folder.path("man1")).expect("the folder is made");
    let mut found = BTreeSet::new();
    for entry in entries {
        let entry = entry.expect("readable");
        let name = entry.file_name().to_string_lossy().into_owned();
        let page = fs::read_to_string(entry.path()).expect("readable");
        let title = page.lines().find(|line| line.starts_with(".TH "));
        let title = title.unwrap_or_else(|| panic!("{name} has no title"));
        let stem = name.trim_end_matches(".1");
        assert!(title.starts_with(&format!(".TH {stem} 1 ")), "{title}");
        let version = concat!("\"estampe ", env!("CARGO_PKG_VERSION"), "\"");
        assert!(title.contains(version), "{title}");
        found.insert(name);
    }
    assert_eq!(found, expected);
}

#[test]
fn the_help_does_not_list_the_command() {
    assert!(!subcommands("").contains(&"man".to_owned()));
}

#[test]
fn a_folder_that_cannot_be_made_is_an_error() {
    let folder = Folder::new();
    let file = folder.with_file("file", "");
    let run = estampe("man --output {}", &[&file.join("man1")]);
    assert_eq!(run.code, 3);
    assert!(run.err.contains("--output"), "{}", run.err);
}
