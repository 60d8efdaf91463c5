//! Pages of the documentation whose commands draw their pictures.

use crate::shell::run;
use crate::support::Folder;
use std::collections::BTreeSet;
use std::path::Path;

/// The largest picture of a page, in bytes.
const MAX_PICTURE: usize = 40_000;

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

/// Runs the lines of the `sh` blocks of the document of this name, and compares the PNG files that
/// they write with those in the folder of its pictures, byte for byte; each must be shown on the
/// page. A block that names a
/// file after its language, as in "```mtl clay.mtl", is written to that file first. Returns the
/// number of pictures.
///
/// If the environment variable `UPDATE_PICTURES` is set, the pictures are written anew.
pub(crate) fn check_page(name: &str) -> usize {
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
            for line in block.lines {
                let done = run(line, &folder);
                assert_eq!(done.code, 0, "{line}: {}", done.err);
            }
        }
    }

    let mut drawn = BTreeSet::new();
    for picture in folder.names() {
        if !picture.ends_with(".png") {
            continue;
        }
        let bytes = std::fs::read(folder.path(&picture)).expect("written");
        assert!(
            bytes.len() <= MAX_PICTURE,
            "{picture} has {} bytes",
            bytes.len()
        );
        let committed = pictures.join(&picture);
        if is_update {
            std::fs::create_dir_all(&pictures).expect("the folder of images is writable");
            std::fs::write(&committed, &bytes).expect("the folder of pictures is writable");
        }
        let expected = std::fs::read(&committed);
        assert!(
            expected.is_ok_and(|expected| expected == bytes),
            "{picture} is not the page's picture; UPDATE_PICTURES=1 writes it anew"
        );
        assert!(
            page.contains(&format!("](images/{name}/{picture})")),
            "{picture} is not shown"
        );
        drawn.insert(picture);
    }
    let committed = std::fs::read_dir(&pictures).expect("the folder of pictures");
    let committed: BTreeSet<String> = committed
        .map(|entry| {
            let entry = entry.expect("readable");
            entry.file_name().to_string_lossy().into_owned()
        })
        .collect();
    assert_eq!(
        drawn, committed,
        "each picture is drawn by a command of the page"
    );
    drawn.len()
}
