//! The thumbnailer file for desktops (`desktop/estampe.thumbnailer`): its command draws a picture.

use crate::support::picture::Picture;
use crate::support::{Folder, Run, TETRAHEDRON};
use std::process::Command;

const THUMBNAILER: &str = include_str!("../../desktop/estampe.thumbnailer");

/// The value of a key.
fn value(key: &str) -> &'static str {
    let mut values = THUMBNAILER.lines().filter_map(|line| line.split_once('='));
    let found = values.find(|(found, _)| *found == key);
    found.unwrap_or_else(|| panic!("{key} is in the file")).1
}

/// Desktops give the program a file without extension that already exists.
#[test]
fn the_command_line_draws_a_thumbnail() {
    let folder = Folder::new();
    let model = folder.with_file("one model.obj", TETRAHEDRON);
    let thumbnail = folder.with_file("thumbnail.XJ3A1Z", "");
    let mut words = value("Exec").split(' ');
    assert_eq!(words.next(), Some("estampe"));
    assert_eq!(value("TryExec"), "estampe");
    let mut command = Command::new(env!("CARGO_BIN_EXE_estampe"));
    for word in words {
        match word {
            "%i" => command.arg(&model),
            "%o" => command.arg(&thumbnail),
            word => command.arg(word.replace("%s", "128")),
        };
    }
    let run = Run::from(command.output().expect("the command starts"));
    assert_eq!((run.code, run.out, run.err.as_str()), (0, vec![], ""));

    let bytes = std::fs::read(&thumbnail).expect("the thumbnail is written");
    assert!(bytes.starts_with(b"\x89PNG"));
    let picture = Picture::read(&bytes);
    assert_eq!((picture.width, picture.height), (128, 128));
    assert_eq!(picture.pixel(0, 0)[3], 0, "the background is transparent");
    assert!(picture.color_count() > 8, "a model is seen");
}

#[test]
fn the_file_has_its_group_and_media_types() {
    assert!(THUMBNAILER.starts_with("[Thumbnailer Entry]\n"));
    let types: Vec<&str> = value("MimeType").split_terminator(';').collect();
    assert!(types.contains(&"model/gltf-binary"), "{types:?}");
    assert!(value("MimeType").ends_with(';'));
}
