//! The commands of README.md draw the pictures that it shows, byte for byte.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe --test command readme_page` writes the pictures anew:
//! look at each that changed.

use crate::support::Folder;
use crate::support::shell::run;
use std::path::Path;

/// The largest picture of the page, in bytes.
const MAX_PICTURE: usize = 300_000;

/// The command by cargo, before its words.
const BY_CARGO: &str = "cargo run --release -p estampe -- ";

/// A picture whose command has inputs that are not shown.
const WITHOUT_INPUTS: &str = "heatmap.png";

/// The commands and the names of their pictures in `docs/images`, except those of other pages,
/// which have folders of their own.
fn commands(page: &str) -> Vec<(String, String)> {
    let mut commands = Vec::new();
    let mut link = "";
    for line in page.lines() {
        if let Some((_, rest)) = line.split_once("](docs/images/") {
            link = rest.split(')').next().unwrap_or_default();
        }
        let row = line.strip_prefix("| `estampe ");
        let words = match (line.strip_prefix(BY_CARGO), row) {
            (Some(words), _) => Some(words),
            (_, Some(row)) => row.split_once("` |").map(|(words, _)| words),
            _ => None,
        };
        if let Some(words) = words
            && !link.contains('/')
            && link != WITHOUT_INPUTS
        {
            commands.push((format!("estampe {words}"), link.to_owned()));
        }
    }
    commands
}

#[test]
fn the_commands_of_the_page_draw_its_pictures() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(root.join("README.md")).expect("the page is there");
    let commands = commands(&page);
    assert!(commands.len() > 5, "{commands:?}");
    assert!(
        commands[0].0.starts_with("estampe render builtin:teapot"),
        "the first command is that of cargo"
    );
    let is_update = std::env::var_os("UPDATE_PICTURES").is_some();
    for (command, picture) in commands {
        let folder = Folder::new();
        let done = run(&command, &folder);
        assert_eq!(done.code, 0, "{command}: {}", done.err);
        let names = folder.names();
        let [name] = &names[..] else {
            panic!("{command} writes {names:?}");
        };
        let bytes = std::fs::read(folder.path(name)).expect("written");
        assert!(
            bytes.len() <= MAX_PICTURE,
            "{picture} has {} bytes",
            bytes.len()
        );
        let committed = root.join("docs/images").join(&picture);
        if is_update {
            std::fs::write(&committed, &bytes).expect("the folder of pictures is writable");
        }
        let expected = std::fs::read(&committed);
        assert!(
            expected.is_ok_and(|expected| expected == bytes),
            "{picture} is not what `{command}` draws; UPDATE_PICTURES=1 writes it anew"
        );
    }
}
