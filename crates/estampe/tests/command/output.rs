//! Written files and what is written to a terminal: interrupts, permissions, closed pipes, names.

use crate::support::{Folder, TETRAHEDRON, estampe};
use std::process::{Command, Stdio};

/// An output that is a file that is read is refused, through links too.
#[test]
fn an_output_that_is_an_input_is_refused() {
    let folder = Folder::new();
    let skin = folder.path("skin.png");
    let run = estampe("render builtin:cube -q --size 4x4 -o {}", &[&skin]);
    assert_eq!(run.code, 0, "{}", run.err);
    folder.with_file("skin.mtl", "newmtl skin\nmap_Kd skin.png\n");
    let text = format!("mtllib skin.mtl\nusemtl skin\n{TETRAHEDRON}");
    let model = folder.with_file("m.obj", &text);
    let mut outputs = vec![model.clone(), skin.clone(), folder.path("./skin.mtl")];
    for (link, of) in [("hard.png", &skin), ("hard.obj", &model)] {
        std::fs::hard_link(of, folder.path(link)).expect("links are possible");
        outputs.push(folder.path(link));
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&model, folder.path("soft.png")).expect("links are possible");
        outputs.push(folder.path("soft.png"));
    }
    let before = std::fs::read(&skin).expect("drawn");
    for output in outputs {
        let words = "render {} -o {} --output-format png --size 8x8";
        let run = estampe(words, &[&model, &output]);
        assert_eq!(run.code, 2, "{}: {}", output.display(), run.err);
        assert!(run.err.contains("this is the input"), "{}", run.err);
    }
    assert_eq!(std::fs::read(&skin).expect("there"), before);
    assert_eq!(std::fs::read_to_string(&model).expect("there"), text);
    let plain = folder.with_file("plain.obj", TETRAHEDRON);
    let words = "render {} -o {} --texture {} --size 8x8";
    let run = estampe(words, &[&plain, &skin, &skin]);
    assert_eq!(run.code, 2, "{}", run.err);
}

/// A material's name cannot reach the terminal's control sequences, nor forge a line.
#[test]
fn names_are_shown_without_control_characters() {
    let folder = Folder::new();
    folder.with_file("m.mtl", "newmtl red\u{1b}[31m\u{9b}2J\nKd 1 0 0\n");
    let text = format!("mtllib m.mtl\nusemtl red\u{1b}[31m\u{9b}2J\n{TETRAHEDRON}");
    let model = folder.with_file("m.obj", text);
    let run = estampe("info {}", &[&model]);
    let said = String::from_utf8(run.out).expect("text");
    assert!(
        said.contains("material   red\\u{1b}[31m\\u{9b}2J"),
        "{said}"
    );
    let is_control = |c: char| c.is_control() && c != '\n';
    assert!(!said.contains(is_control), "{said:?}");
    let missing = folder.path("no\u{1b}]0;title\u{7}\nestampe: done.obj");
    let run = estampe("render {} -o x.png", &[&missing]);
    assert_eq!(run.code, 1);
    assert!(!run.err.contains(is_control), "{:?}", run.err);
    assert_eq!(run.err.lines().count(), 1, "{:?}", run.err);
    let odd = folder.with_file("odd.obj", format!("mtllib \u{1b}c.mtl\n{TETRAHEDRON}"));
    let run = estampe("render {} -o {} --size 4x4", &[&odd, &folder.path("o.png")]);
    assert!(run.err.contains("warning: "), "{:?}", run.err);
    assert!(!run.err.contains(is_control), "{:?}", run.err);
}

#[cfg(unix)]
mod unix {
    use super::{Folder, estampe};
    use std::os::unix::fs::PermissionsExt;
    use std::os::unix::process::ExitStatusExt;
    use std::path::Path;
    use std::process::{Child, Command, ExitStatus, Stdio};
    use std::time::{Duration, Instant};

    #[test]
    fn a_replaced_file_keeps_its_permissions() {
        let folder = Folder::new();
        let out = folder.with_file("out.png", "old");
        for mode in [0o600, 0o664, 0o444] {
            let permissions = std::fs::Permissions::from_mode(mode);
            std::fs::set_permissions(&out, permissions).expect("it is ours");
            let run = estampe("render builtin:cube -q --size 4x4 -o {}", &[&out]);
            assert_eq!(run.code, 0, "{}", run.err);
            let now = std::fs::metadata(&out).expect("there").permissions().mode();
            assert_eq!(now & 0o7777, mode, "{now:o}");
        }
    }

    /// The exit code of a command whose standard output is closed by its reader before it writes.
    fn with_closed_output(words: &str) -> (i32, String) {
        let mut child = Command::new(env!("CARGO_BIN_EXE_estampe"))
            .args(words.split_whitespace())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        drop(child.stdout.take());
        drop(child.stdin.take());
        let output = child.wait_with_output().expect("it ends");
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code().expect("it is not killed"), err)
    }

    #[test]
    fn a_closed_report_is_no_error_and_a_closed_picture_is_one() {
        for words in [
            "info builtin:teapot",
            "info builtin:teapot --json",
            "shader template",
            "depth --near 0.1 --far 10 --format d24",
            "inspect builtin:cube --pixel 4,4 --size 8x8",
        ] {
            assert_eq!(with_closed_output(words), (0, String::new()), "{words}");
        }
        let (code, said) = with_closed_output("render builtin:cube --size 64x64 -q -o -");
        assert_eq!(code, 3, "{said}");
        assert!(said.contains("standard output"), "{said}");
    }

    /// Sends a signal by its name.
    fn send(signal: &str, child: &Child) {
        let sent = Command::new("kill")
            .args(["-s", signal, &child.id().to_string()])
            .status();
        assert!(sent.expect("kill runs").success());
    }

    /// Stops a command in the middle of writing a large file, ends it by a signal, and returns its
    /// status. `None` if it was done before.
    fn interrupted(folder: &Folder, signal: &str) -> Option<ExitStatus> {
        let shader = folder.with_file(
            "nothing.wgsl",
            "@group(0) @binding(0) var<storage, read_write> a: array<u32>;\n\
             @compute @workgroup_size(1) fn main() { a[0] = 1u; }\n",
        );
        let out = folder.path("large.bin");
        let mut child = Command::new(env!("CARGO_BIN_EXE_estampe"))
            .arg("compute")
            .arg(&shader)
            .args(["--groups", "1", "--buffer", "0,0=zeros:134217728"])
            .arg("--write")
            .arg(format!("0,0={}", out.display()))
            .stderr(Stdio::null())
            .spawn()
            .expect("the command starts");
        let end = Instant::now() + Duration::from_secs(60);
        while parts(folder).is_empty() {
            if child.try_wait().expect("it is ours").is_some() || Instant::now() > end {
                let _ = child.kill();
                let _ = child.wait();
                return None;
            }
        }
        send("STOP", &child);
        send(signal, &child);
        if signal != "KILL" {
            send("CONT", &child);
        }
        Some(child.wait().expect("it ends"))
    }

    fn parts(folder: &Folder) -> Vec<String> {
        let names = folder.names().into_iter();
        names.filter(|name| name.ends_with(".part")).collect()
    }

    #[test]
    fn an_interrupt_leaves_no_temporary_file() {
        for (signal, number) in [("INT", 2), ("TERM", 15)] {
            let folder = Folder::new();
            let mut statuses = (0..20).filter_map(|_| interrupted(&folder, signal));
            // The file may have been complete when the signal came.
            let ended = statuses.find(|status| status.signal() == Some(number));
            assert!(ended.is_some(), "{signal}: it was never interrupted");
            assert!(parts(&folder).is_empty(), "{:?}", folder.names());
        }
    }

    /// What a killed process left is removed by the next command that writes to the folder.
    #[cfg(target_os = "linux")]
    #[test]
    fn the_temporary_file_of_a_killed_process_is_removed() {
        let folder = Folder::new();
        let left = (0..20).find(|_| {
            let _ = interrupted(&folder, "KILL");
            !parts(&folder).is_empty()
        });
        assert!(left.is_some(), "it was never killed while writing");
        let abandoned = parts(&folder).remove(0);
        // The process of this test runs.
        let mut words: Vec<String> = abandoned.split('.').map(str::to_owned).collect();
        let at = words.len() - 3;
        words[at] = std::process::id().to_string();
        let running = words.join(".");
        // Another host, where that process may run.
        words[at] = "99999999".to_owned();
        words[at - 1] = "other".to_owned();
        let elsewhere = words.join(".");
        for name in [running.as_str(), elsewhere.as_str(), ".notes.part"] {
            folder.with_file(name, "half");
        }
        let out = folder.path("out.png");
        let run = estampe(
            "render builtin:cube -q --size 4x4 -o {}",
            &[Path::new(&out)],
        );
        assert_eq!(run.code, 0, "{}", run.err);
        let mut expected = vec![running, elsewhere, ".notes.part".to_owned()];
        expected.sort();
        let mut left = parts(&folder);
        left.sort();
        assert_eq!(left, expected);
    }
}

/// Without a terminal, and with NO_COLOR, nothing has escape sequences.
#[test]
fn no_color_is_heeded() {
    for words in [
        &["render", "--help"][..],
        &["render", "builtin:cube", "--nonsense"],
        &["rendre"],
        &["render", "builtin:cube", "-o", "-", "--size", "8x8", "-q"],
        &["help"],
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_estampe"))
            .args(words)
            .env("NO_COLOR", "1")
            .env("TERM", "xterm-256color")
            .stdin(Stdio::null())
            .output()
            .expect("the command starts");
        let is_picture = words.contains(&"-q");
        assert!(!output.stderr.contains(&0x1b), "{words:?}");
        assert!(is_picture || !output.stdout.contains(&0x1b), "{words:?}");
    }
}

/// Names are bytes on Unix: a file whose name is no UTF-8 is read, drawn and named in messages.
#[cfg(target_os = "linux")]
#[test]
fn names_need_not_be_utf_8() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new();
    let name = |bytes: &[u8]| folder.path("").join(OsStr::from_bytes(bytes));
    let (model, out) = (name(b"m\xff.obj"), name(b"\xfe.png"));
    std::fs::write(&model, TETRAHEDRON).expect("writable");
    let run = estampe("render {} -o {} --size 8x8", &[&model, &out]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.contains('\u{fffd}'), "{}", run.err);
    assert!(
        std::fs::read(&out)
            .expect("written")
            .starts_with(b"\x89PNG")
    );
    let run = estampe("render {} -o {} --size 8x8 --json -q", &[&model, &out]);
    let report: serde_json::Value = serde_json::from_slice(&run.out).expect("an object");
    assert_eq!(report["counts"]["triangles"], 4);
    let missing = name(b"\xf0none.obj");
    let run = estampe("render {} -o {}", &[&missing, &out]);
    assert!(
        run.code == 1 && run.err.contains("no such file"),
        "{}",
        run.err
    );
    let run = estampe(
        "turntable {} -o {} --frames 2 --size 8x8 -q",
        &[&model, &name(b"t\xff.gif")],
    );
    assert_eq!(run.code, 0, "{}", run.err);
    let texture = estampe(
        "render {} -o {} --size 8x8 --texture {}",
        &[&model, &name(b"u.png"), &out],
    );
    assert_eq!(texture.code, 0, "{}", texture.err);
    assert_eq!(estampe("info {}", &[&model]).code, 0);
}
