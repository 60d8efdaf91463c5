//! A model opens regular files below its own folder only.

use crate::model::{Folder, NoResources, ResourceError, Resources};
use std::fs;
use std::path::PathBuf;

/// A temporary folder with `model/inner/Wood 1.png` and `secret.txt`.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let root = std::env::temp_dir().join(format!("estampe-{name}-{}", std::process::id()));
        fs::create_dir_all(root.join("model/inner")).unwrap();
        fs::write(root.join("model/inner/Wood 1.png"), b"wood").unwrap();
        fs::write(root.join("secret.txt"), b"secret").unwrap();
        Self(root)
    }

    fn folder(&self) -> Folder {
        Folder::of_model(&self.0.join("model/model.obj"))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn files_below_the_folder_are_found_however_they_are_spelled() {
    let scratch = Scratch::new("spelling");
    let folder = scratch.folder();
    let found = folder.resolve("inner/Wood 1.png").unwrap();
    assert_eq!(folder.read(&found, 4).unwrap(), b"wood");
    for name in [
        "inner\\Wood 1.png",
        ".\\inner/./Wood 1.png",
        "INNER/wood 1.PNG",
        "inner//Wood 1.png",
    ] {
        assert_eq!(folder.resolve(name).as_ref(), Ok(&found), "{name}");
    }
    assert_eq!(
        folder.resolve("inner/missing.png"),
        Err(ResourceError::NotFound)
    );
    assert_eq!(folder.resolve(""), Err(ResourceError::NotFound));
    assert_eq!(folder.resolve("a\0b"), Err(ResourceError::NotFound));
    assert_eq!(
        folder.resolve(&"x".repeat(10_000)),
        Err(ResourceError::NotFound)
    );
    assert_eq!(folder.resolve("inner"), Err(ResourceError::NotRegular));
    assert_eq!(folder.read(&found, 3), Err(ResourceError::TooLarge(3)));
    assert_eq!(
        NoResources.resolve("inner/Wood 1.png"),
        Err(ResourceError::Unavailable)
    );
}

#[test]
fn nothing_outside_is_opened() {
    let scratch = Scratch::new("outside");
    let folder = scratch.folder();
    let absolute = scratch.0.join("secret.txt");
    for name in [
        absolute.to_str().unwrap(),
        "../secret.txt",
        "..\\secret.txt",
        "inner/../../secret.txt",
        "inner/..",
        "/etc/passwd",
        "\\etc\\passwd",
        "C:\\secret.txt",
        "C:secret.txt",
    ] {
        assert_eq!(folder.resolve(name), Err(ResourceError::Outside), "{name}");
    }
    assert_eq!(
        folder.read(absolute.to_str().unwrap(), 100),
        Err(ResourceError::Outside)
    );
}

#[cfg(unix)]
#[test]
fn links_that_leave_the_folder_and_special_files_are_refused() {
    use std::os::unix::fs::symlink;
    let scratch = Scratch::new("links");
    let model = scratch.0.join("model");
    symlink("../secret.txt", model.join("out.txt")).unwrap();
    symlink("..", model.join("up")).unwrap();
    symlink("inner/Wood 1.png", model.join("in.png")).unwrap();
    symlink("loop", model.join("loop")).unwrap();
    symlink("/dev/zero", model.join("zero")).unwrap();
    let folder = scratch.folder();
    assert_eq!(folder.resolve("out.txt"), Err(ResourceError::Outside));
    assert_eq!(folder.resolve("up/secret.txt"), Err(ResourceError::Outside));
    assert_eq!(folder.resolve("zero"), Err(ResourceError::Outside));
    assert_eq!(folder.resolve("loop"), Err(ResourceError::NotFound));
    assert!(
        folder.resolve("in.png").unwrap().ends_with("Wood 1.png"),
        "links inside are fine"
    );

    // A pipe: opening it would wait for a writer for ever.
    let pipe = model.join("pipe.png");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    if made.is_ok_and(|status| status.success()) {
        assert_eq!(folder.resolve("pipe.png"), Err(ResourceError::NotRegular));
    } else {
        eprintln!("skipped: mkfifo is not here");
    }
    let socket = std::os::unix::net::UnixListener::bind(model.join("socket"));
    if socket.is_ok() {
        assert_eq!(folder.resolve("socket"), Err(ResourceError::NotRegular));
    }
}
