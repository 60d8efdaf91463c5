//! The arguments of an example.
//!
//! The module is private, so this program contains its file. As a test of the library it would
//! compile the whole library again.

#[path = "../src/arguments.rs"]
mod arguments;

use arguments::Arguments;
use estampe_assets::image::ImageFormat;
use estampe_ladder::{LadderError, rung};
use std::path::Path;

fn parsed(words: &[&str]) -> Result<Arguments, LadderError> {
    Arguments::parse(1, words.iter().map(std::ffi::OsString::from))
}

#[test]
fn arguments_are_an_output_and_a_model() {
    let default = parsed(&[]).unwrap();
    assert_eq!(default.output, Path::new("ladder_01_pixel.png"));
    assert_eq!(default.model, None);
    assert_eq!(default.texture, None);
    let given = parsed(&["--model", "a.obj", "-o", "b.tga"]).unwrap();
    assert_eq!(given.format, ImageFormat::Tga);
    assert_eq!(given.model.as_deref(), Some(Path::new("a.obj")));
    for wrong in [&["-o"][..], &["a.png"], &["--size", "3"], &["-o", "a.gif"]] {
        assert!(
            matches!(parsed(wrong), Err(LadderError::Usage(_))),
            "{wrong:?}"
        );
    }
}
