//! Pages of the documentation whose commands draw their pictures.

use crate::support::Folder;
use crate::support::shell::run;
use std::collections::BTreeSet;
use std::path::Path;

/// The largest picture of a page, in bytes.
const MAX_PICTURE: usize = 60_000;

/// The comment after a command that fails, before its exit code.
const EXIT_CODE: &str = " # exit code ";

/// A fenced block of a page: the words after its fence, and its lines.
struct Block<'a> {
    info: &'a str,
    lines: Vec<&'a str>,
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let mut blocks = Vec::new();
    let mut open: Option<Block<'_>> = None;
    for line in page.lines() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(info), None) => {
                let lines = Vec::new();
                open = Some(Block { info, lines });
            }
            (None, Some(block)) => block.lines.push(line),
            (None, None) => {}
        }
    }
    blocks
}

/// Runs the commands of the page of this name, the lines of its `sh` blocks that begin with
/// `estampe`, and compares the pictures that they write with those in the page's folder of
/// `docs/images`, byte for byte; each must be shown on the page. A block that names a file after
/// its language, as in "```mtl clay.mtl", is written to that file first. A command succeeds, or
/// ends with the exit code of the comment after it, "# exit code 1". Returns the names of the
/// pictures.
///
/// If the environment variable `UPDATE_PICTURES` is set, the pictures are written anew.
pub(crate) fn check_page(name: &str) -> BTreeSet<String> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let page = std::fs::read_to_string(docs.join(name).with_extension("md"));
    let page = page.expect("the page is there");
    let pictures = docs.join("images").join(name);
    let is_update = std::env::var_os("UPDATE_PICTURES").is_some();
    let folder = Folder::new();
    for block in blocks(&page) {
        if let Some((_, file)) = block.info.split_once(' ') {
            folder.with_file(file, block.lines.join("\n") + "\n");
        } else if block.info == "sh" {
            let commands = block.lines.into_iter();
            for line in commands.filter(|line| line.starts_with("estampe ")) {
                let (line, code) = line.split_once(EXIT_CODE).unwrap_or((line, "0"));
                let done = run(line, &folder);
                assert_eq!(done.code.to_string(), code, "{line}: {}", done.err);
            }
        }
    }

    let is_picture = |name: &String| {
        let extension = Path::new(name).extension();
        extension.is_some_and(|extension| ["png", "svg", "gif"].iter().any(|e| extension == *e))
    };
    let drawn: BTreeSet<String> = folder.names().into_iter().filter(is_picture).collect();
    for picture in &drawn {
        let bytes = std::fs::read(folder.path(picture)).expect("written");
        assert!(
            bytes.len() <= MAX_PICTURE,
            "{picture} has {} bytes",
            bytes.len()
        );
        let committed = pictures.join(picture);
        if is_update {
            std::fs::create_dir_all(&pictures).expect("the folder of images is writable");
            std::fs::write(&committed, &bytes).expect("the folder of pictures is writable");
        }
        let expected = std::fs::read(&committed);
        assert!(
            expected.is_ok_and(|expected| expected == bytes),
            "{picture} is not the page's picture; UPDATE_PICTURES=1 writes it anew"
        );
        let link = format!("](images/{name}/{picture})");
        assert!(page.contains(&link), "{picture} is not shown");
    }
    drawn
}

/// The names of the pictures of a page.
#[allow(
    dead_code,
    reason = "only some pages draw all of their pictures by commands"
)]
pub(crate) fn committed(name: &str) -> BTreeSet<String> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let entries = std::fs::read_dir(docs.join("images").join(name)).expect("the folder");
    let entries = entries.map(|entry| entry.expect("readable").file_name());
    entries
        .map(|name| name.to_string_lossy().into_owned())
        .collect()
}
