//! A model opens regular files below its own folder only, and below the folders of the user.

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

/// A model of `model/source`, with files in and beside its folder.
fn scattered(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    for file in [
        "model/source/maps/deep/Bark.png",
        "model/source/oak/bark.png",
        "model/source/pine/bark.png",
        "model/textures/leaf.png",
        "model/elsewhere/needle.png",
        "library/stone/grey.png",
    ] {
        let path = scratch.0.join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, file).unwrap();
    }
    scratch
}

/// The content of the file that a search finds.
fn searched(folder: &Folder, name: &str) -> Result<String, ResourceError> {
    let found = folder.search(name)?;
    let bytes = folder.read(&found, 100)?;
    Ok(String::from_utf8(bytes).unwrap())
}

#[test]
fn textures_are_searched_by_their_own_name() {
    let scratch = scattered("search");
    let folder = Folder::of_model(&scratch.0.join("model/source/tree.obj"));
    for (name, found) in [
        // The nearest one, the first by name; then the one with more parts of the path.
        ("bark.png", "source/oak/bark.png"),
        ("D:\\work\\bark.png", "source/oak/bark.png"),
        ("/home/someone/PINE/bark.png", "source/pine/bark.png"),
        ("../maps/deep/Bark.png", "source/maps/deep/Bark.png"),
        ("C:bark.png", "source/oak/bark.png"),
        ("LEAF.PNG", "textures/leaf.png"),
    ] {
        assert_eq!(
            searched(&folder, name),
            Ok(format!("model/{found}")),
            "{name}"
        );
    }
    for name in [
        "needle.png",
        "grey.png",
        "../elsewhere/needle.png",
        "secret.txt",
    ] {
        let error = searched(&folder, name).unwrap_err().to_string();
        let last = name.rsplit('/').next().unwrap();
        assert_eq!(
            error,
            format!(
                "there is no file `{last}` in the model's folder or `../textures`, or below; \
                 copy it there, or add its folder as a root"
            )
        );
    }
    for name in ["", "..", "a/..", "\0"] {
        assert_eq!(
            folder.search(name),
            Err(ResourceError::NotFound),
            "{name:?}"
        );
    }
    // Without a search, what is beside the folder is outside.
    let leaf = scratch.0.join("model/textures/leaf.png");
    assert_eq!(
        folder.resolve("../textures/leaf.png"),
        Err(ResourceError::Outside)
    );
    assert!(folder.read(leaf.to_str().unwrap(), 100).is_ok());
    let needle = scratch.0.join("model/elsewhere/needle.png");
    let refused = folder.read(needle.to_str().unwrap(), 100);
    assert_eq!(refused, Err(ResourceError::Outside));
}

#[test]
fn roots_are_further_folders() {
    let scratch = scattered("roots");
    let path = scratch.0.join("model/source/tree.obj");
    let missing = scratch.0.join("missing");
    let library = scratch.0.join("library");
    let folder = Folder::of_model(&path).with_roots(&[missing, library.clone()]);
    let read = |folder: &Folder, name: &str| {
        let found = folder.resolve(name)?;
        Ok(String::from_utf8(folder.read(&found, 100)?).unwrap())
    };
    let absolute = library.join("stone/grey.png");
    for name in [
        "stone/grey.png",
        "Stone\\GREY.png",
        "../../library/stone/grey.png",
        absolute.to_str().unwrap(),
    ] {
        assert_eq!(
            read(&folder, name),
            Ok("library/stone/grey.png".to_owned()),
            "{name}"
        );
    }
    assert_eq!(
        searched(&folder, "E:/grey.png"),
        Ok("library/stone/grey.png".to_owned())
    );
    assert_eq!(
        read(&folder, "oak/../oak/bark.png"),
        Ok("model/source/oak/bark.png".to_owned())
    );
    for name in [
        "../elsewhere/needle.png",
        "../../secret.txt",
        "/etc/passwd",
        "../../library",
    ] {
        assert_eq!(read(&folder, name), Err(ResourceError::Outside), "{name}");
    }
    let error = folder.search("none.png").unwrap_err().to_string();
    let root = format!("the root `{}`", library.display());
    assert!(
        error.contains(&format!("`../textures` or {root}, or below")),
        "{error}"
    );

    let piped = Folder::none();
    assert_eq!(
        piped.resolve("stone/grey.png"),
        Err(ResourceError::Unavailable)
    );
    assert_eq!(piped.search("grey.png"), Err(ResourceError::Unavailable));
    let piped = piped.with_roots(&[library]);
    assert_eq!(
        read(&piped, "stone/grey.png"),
        Ok("library/stone/grey.png".to_owned())
    );
    assert!(searched(&piped, "x/grey.png").is_ok());
}

#[test]
fn a_search_ends() {
    let scratch = Scratch::new("ends");
    let many = scratch.0.join("model/many");
    fs::create_dir_all(&many).unwrap();
    for i in 0..10_001 {
        fs::write(many.join(i.to_string()), b"").unwrap();
    }
    let folder = scratch.folder();
    // The folder with too many files is left out as a whole; what comes before it is not.
    assert!(folder.search("x/wood 1.png").is_ok());
    let error = folder.search("7").unwrap_err().to_string();
    assert!(
        error.contains("the model's folder (of which the first 3 entries) or below"),
        "{error}"
    );
}

#[cfg(unix)]
#[test]
fn a_search_follows_no_link_out() {
    use std::os::unix::fs::symlink;
    let scratch = scattered("search-links");
    let source = scratch.0.join("model/source");
    symlink("../../secret.txt", source.join("secret.txt")).unwrap();
    symlink("../elsewhere", source.join("link")).unwrap();
    symlink("oak/bark.png", source.join("alias.png")).unwrap();
    symlink("../library", scratch.0.join("model/texture")).unwrap();
    let folder = Folder::of_model(&source.join("tree.obj"));
    for name in ["secret.txt", "needle.png", "grey.png"] {
        let error = searched(&folder, name).unwrap_err();
        assert!(
            matches!(error, ResourceError::NotFoundIn { .. }),
            "{name}: {error}"
        );
    }
    assert_eq!(
        searched(&folder, "alias.png"),
        Ok("model/source/oak/bark.png".to_owned())
    );
}
