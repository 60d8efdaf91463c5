//! Presets of the configuration file.

use crate::support::{Folder, Run, TETRAHEDRON};
use std::process::Command;

const CONFIG: &str = "[default]\nsize = \"40x30\"\nview = \"front\"\n\n[clay]\ncolor = \"tan\"\n\
                      light = [\"1,2,3\", \"-1,0.5,1:0.4\"]\nshadow = true\nsamples = 1\n";

/// Runs the command in the folder, whose `home` has the user's configuration.
fn run_in(folder: &Folder, words: &str) -> Run {
    let output = Command::new(env!("CARGO_BIN_EXE_estampe"))
        .args(words.split_whitespace())
        .current_dir(folder.path(""))
        .env("XDG_CONFIG_HOME", folder.path("home"))
        .env("APPDATA", folder.path("home"))
        .output();
    output.expect("the command starts").into()
}

/// The picture of these words, by `render m.obj`.
fn picture(folder: &Folder, words: &str) -> Vec<u8> {
    let run = run_in(folder, &format!("render m.obj -o - -q {words}"));
    assert_eq!(run.code, 0, "{words}: {}", run.err);
    run.out
}

#[test]
fn presets_are_options_and_the_command_line_wins() {
    let folder = Folder::new();
    folder.with_file("m.obj", TETRAHEDRON);
    folder.with_file("estampe.toml", CONFIG);
    let of = |words: &str| picture(&folder, words);
    let default = "--no-config --size 40x30";
    assert!(of("") == of(&format!("{default} --view front")));
    assert!(of("--size 50x30") == of("--no-config --size 50x30 --view front"));
    // Options that exclude those of a table replace them.
    assert!(of("--azimuth 50") == of(&format!("{default} --azimuth 50")));
    assert!(of("--eye 3,2,5") == of(&format!("{default} --eye 3,2,5")));
    let clay = format!("{default} --color tan --shadow --samples 1");
    let lights = "--light 1,2,3 --light -1,0.5,1:0.4";
    assert!(of("--preset clay") == of(&format!("{clay} --view front {lights}")));
    assert!(of("--preset=clay --light 0,0,1") == of(&format!("{clay} --view front --light 0,0,1")));
    assert!(
        of("--preset clay --color=red --view top")
            == of(&format!(
                "{default} --color red --shadow --samples 1 --view top {lights}"
            ))
    );
}

#[test]
fn every_command_that_draws_has_presets() {
    let folder = Folder::new();
    folder.with_file("m.obj", TETRAHEDRON);
    folder.with_file("looks.toml", CONFIG);
    folder.with_file(
        "jobs.toml",
        "[[jobs]]\ninput = \"m.obj\"\noutput = \"job.png\"\noptions = { azimuth = 40, color = \"red\" }\n",
    );
    let preset = "--config looks.toml --preset clay";
    let expected = picture(&folder, preset);
    for words in [
        "batch m.obj -o {stem}.png",
        "turntable m.obj -o {frame}.png --frames 2",
        "inspect m.obj --pixel 3,4",
        "shape --explicit x*y -o shape.png",
        "batch --job-file jobs.toml",
    ] {
        let run = run_in(&folder, &format!("{words} {preset}"));
        assert_eq!(run.code, 0, "{words}: {}", run.err);
    }
    let read = |name: &str| std::fs::read(folder.path(name)).expect(name);
    assert!(read("m.png") == expected);
    let job = "--no-config --size 40x30 --azimuth 40 --color red --shadow --samples 1 --light 1,2,3 \
               --light -1,0.5,1:0.4";
    assert!(read("job.png") == picture(&folder, job));
    for name in ["0000.png", "shape.png"] {
        assert!(read(name).starts_with(b"\x89PNG"));
    }
}

#[test]
fn the_file_is_searched_and_listed() {
    let folder = Folder::new();
    folder.with_file("m.obj", TETRAHEDRON);
    let none = run_in(&folder, "presets");
    assert!(
        none.code == 0 && none.out.starts_with(b"there is no"),
        "{}",
        none.err
    );
    folder.with_file("home/estampe/config.toml", "[mine]\nsize = \"8x8\"\n");
    let of_user = picture(&folder, "--preset mine");
    assert!(of_user == picture(&folder, "--no-config --size 8x8"));
    // The file of the working folder is taken in its place.
    folder.with_file("estampe.toml", CONFIG);
    assert_eq!(run_in(&folder, "render m.obj -o - --preset mine").code, 2);
    let listed = String::from_utf8(run_in(&folder, "presets").out).expect("UTF-8");
    for part in [
        "estampe.toml",
        "clay\n",
        "default (always)",
        "--light=-1,0.5,1:0.4",
    ] {
        assert!(listed.contains(part), "{listed}");
    }
    let listed = run_in(&folder, "presets --config home/estampe/config.toml");
    assert!(String::from_utf8_lossy(&listed.out).contains("mine"));
}

#[test]
fn mistakes_in_the_file_have_its_line() {
    let folder = Folder::new();
    folder.with_file("m.obj", TETRAHEDRON);
    for (config, words, said) in [
        (
            "[a]\ncolor = \"tan\"\nsizee = \"1x1\"\n",
            "",
            "estampe.toml:3: unknown option `sizee`",
        ),
        ("[a]\nsize = \"1\"\n", "", "estampe.toml:2: "),
        ("[a]\nshadow = \"yes\"\n", "", "estampe.toml:2: "),
        ("[a]\nthreads = 2\n", "", "option of the command line"),
        ("[a]\npreset = \"b\"\n", "", "option of the command line"),
        ("size = \"8x8\"\n", "", "estampe.toml:1: "),
        ("[a\n", "", "estampe.toml:1: "),
        ("", "--preset a", "has no presets"),
        ("[b]\n", "--preset a", "has b"),
        ("", "--preset", "--preset"),
        ("", "--no-config --preset a", "cannot be used"),
    ] {
        folder.with_file("estampe.toml", config);
        let run = run_in(&folder, &format!("render m.obj -o - {words}"));
        assert_eq!(run.code, 2, "{config} {words}: {}", run.err);
        assert!(run.err.contains(said), "{config} {words}: {}", run.err);
    }
    folder.with_file("estampe.toml", [0xff, 0xfe, 0]);
    assert_eq!(run_in(&folder, "render m.obj -o -").code, 2);
    assert_eq!(
        run_in(&folder, "render m.obj -o - --config none.toml").code,
        1
    );
    // Help needs no file, and other commands have no presets.
    assert_eq!(run_in(&folder, "render --help").code, 0);
    assert_eq!(run_in(&folder, "info m.obj").code, 0);
}
