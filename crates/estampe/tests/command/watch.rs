//! `estampe render --watch`.

use crate::support::{Folder, TETRAHEDRON, estampe};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Waits until the condition holds.
fn wait(what: &str, condition: impl Fn() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(
            start.elapsed() < Duration::from_secs(60),
            "waited for {what}"
        );
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// The picture once it is whole.
fn read(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_default()
}

#[test]
fn a_changed_model_is_drawn_again_until_an_interrupt() {
    let folder = Folder::new();
    folder.with_file("m.mtl", "newmtl a\nKd 0 0 1\n");
    let text = |from: &str| {
        format!(
            "mtllib m.mtl\nusemtl a\n{}",
            TETRAHEDRON.replace("v 1 0 0", from)
        )
    };
    let model = folder.with_file("m.obj", text("v 1 0 0"));
    let out = folder.path("o.png");
    let errors = std::fs::File::create(folder.path("errors.txt")).expect("writable");
    let mut child = Command::new(env!("CARGO_BIN_EXE_estampe"))
        .args([
            "render",
            "m.obj",
            "-o",
            "o.png",
            "--size",
            "16x16",
            "--watch",
            "--no-config",
        ])
        .current_dir(folder.path(""))
        .stdin(Stdio::null())
        .stderr(errors)
        .spawn()
        .expect("the command starts");
    wait("the first picture", || !read(&out).is_empty());
    let first = read(&out);
    // The lengths differ, so that coarse times of files do not matter.
    std::fs::write(&model, text("v 2.25 0 0")).expect("writable");
    wait("the picture of the changed model", || read(&out) != first);
    let second = read(&out);
    folder.with_file("m.mtl", "newmtl a\nKd 1 0.25 0\n");
    wait("the picture of the changed material", || {
        read(&out) != second
    });
    let third = read(&out);
    // An error ends nothing, and keeps the picture.
    std::fs::write(&model, "nonsense").expect("writable");
    wait("the error", || {
        !String::from_utf8_lossy(&read(&folder.path("errors.txt"))).is_empty()
            && String::from_utf8_lossy(&read(&folder.path("errors.txt")))
                .contains("estampe render: m.obj")
    });
    assert!(read(&out) == third);
    std::fs::write(&model, text("v 1 0 0.125")).expect("writable");
    wait("the picture of the mended model", || read(&out) != third);
    let interrupted = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(interrupted.expect("kill is there").success());
    let status = child.wait().expect("it ends");
    // A shell reports this as 130.
    assert_eq!(
        std::os::unix::process::ExitStatusExt::signal(&status),
        Some(2)
    );
    assert_eq!(folder.names(), ["errors.txt", "m.mtl", "m.obj", "o.png"]);
}

#[test]
fn what_cannot_be_watched_is_refused() {
    for words in [
        "render builtin:cube -o o.png --watch",
        "render - -o o.png --watch",
        "render m.obj -o - --watch",
        "render m.obj -o o.png --watch --timeout 5",
        "render m.obj -o o.bmp --watch",
    ] {
        let run = estampe(words, &[]);
        assert_eq!(run.code, 2, "{words}: {}", run.err);
    }
}
