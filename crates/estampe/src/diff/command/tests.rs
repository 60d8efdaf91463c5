//! The command end to end, on files in a temporary folder.

use std::fs;
use std::sync::atomic::{AtomicU32, Ordering};

use clap::Parser;
use serde_json::Value;

use super::*;

/// A folder that is removed after its test.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!(
            "estampe-diff-{}-{}",
            std::process::id(),
            COUNT.fetch_add(1, Ordering::Relaxed)
        );
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).expect("a writable temporary folder");
        Self(path)
    }

    fn picture(&self, name: &str, image: &Image) -> PathBuf {
        let path = self.0.join(name);
        let format = ImageFormat::from_path(&path).expect("a picture's name");
        fs::write(&path, encode(image, format).expect("a valid image")).expect("a writable folder");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[derive(Debug, Parser)]
struct Line {
    #[command(flatten)]
    args: DiffArgs,
}

/// Exit code, standard output, standard error.
fn run_with(a: &Path, b: &Path, options: &[&str]) -> (u8, String, String) {
    let line = [Path::new("diff"), a, b].map(Path::as_os_str);
    let line = line
        .into_iter()
        .chain(options.iter().map(|option| option.as_ref()));
    let args = Line::try_parse_from(line)
        .expect("a valid command line")
        .args;
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let code = run(&args, &mut out, &mut err);
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (code, text(out), text(err))
}

fn json_of(out: &str) -> Value {
    assert_eq!(out.lines().count(), 1);
    serde_json::from_str(out).expect("JSON")
}

fn grey() -> Image {
    Image::filled(20, 10, [100, 110, 120, 255])
}

/// Ten of two hundred pixels differ by 6 in green.
fn nearly_grey() -> Image {
    let mut image = grey();
    for texel in image.rgba.as_chunks_mut::<4>().0.iter_mut().take(10) {
        texel[1] += 6;
    }
    image
}

#[test]
fn the_same_picture_in_two_formats_is_identical() {
    let folder = Folder::new();
    let a = folder.picture("a.png", &nearly_grey());
    let b = folder.picture("b.tga", &nearly_grey());
    let (code, out, err) = run_with(&a, &b, &[]);
    assert_eq!(code, EXIT_SAME);
    assert!(
        out.contains("are identical.") && err.is_empty(),
        "{out}{err}"
    );
}

#[test]
fn the_limit_decides_the_result() {
    let folder = Folder::new();
    let a = folder.picture("a.png", &grey());
    let b = folder.picture("b.png", &nearly_grey());
    for (limit, code, words) in [
        ("0", EXIT_DIFFERENT, "differ.\n"),
        (
            "5",
            EXIT_DIFFERENT,
            "differ: 10 pixels by more than 5 of 255",
        ),
        ("6", EXIT_SAME, "are the same within 6 of 255"),
        ("255", EXIT_SAME, "are the same within 255 of 255"),
    ] {
        let (got, out, _) = run_with(&a, &b, &["--max", limit]);
        assert_eq!(got, code, "{limit}");
        assert!(out.contains(words), "{out}");
        assert!(out.contains("10 of 200 differ (5.00 %)"), "{out}");
        assert!(out.contains("R 0  G 6  B 0  A 0"), "{out}");
    }
    for wrong in ["256", "-1", "x"] {
        assert!(Line::try_parse_from(["diff", "a", "b", "--max", wrong]).is_err());
    }
}

#[test]
fn json_has_the_fields_that_the_help_names() {
    let folder = Folder::new();
    let a = folder.picture("a.png", &grey());
    let b = folder.picture("b.png", &nearly_grey());
    let (code, out, err) = run_with(&a, &b, &["--json", "--max", "2"]);
    assert_eq!((code, err.as_str()), (EXIT_DIFFERENT, ""));
    let json = json_of(&out);
    assert_eq!(json["a"]["width"], 20);
    assert_eq!(json["b"]["height"], 10);
    assert_eq!(json["b"]["path"], b.to_str().expect("UTF-8"));
    assert_eq!(json["same"], false);
    assert_eq!(json["identical"], false);
    assert_eq!(json["limit"], 2);
    assert_eq!(json["pixels"], 200);
    assert_eq!(json["differing_pixels"], 10);
    assert_eq!(json["pixels_over_limit"], 10);
    assert_eq!(
        json["max"],
        serde_json::json!({"r": 0, "g": 6, "b": 0, "a": 0, "all": 6})
    );
    assert_eq!(json["mean"]["g"], 0.3);
    assert_eq!(json["mean"]["all"], 0.075);
    let (mean, max) = (json["flip"]["mean"].as_f64(), json["flip"]["max"].as_f64());
    assert!(
        0.0 < mean.expect("a number") && mean < max && max < Some(1.0),
        "{out}"
    );
    assert!(json["heatmap"].is_null());
}

#[test]
fn different_sizes_are_different_in_one_sentence() {
    let folder = Folder::new();
    let a = folder.picture("a.png", &grey());
    let b = folder.picture("b.png", &Image::filled(20, 11, [0; 4]));
    let map = folder.0.join("map.png");
    let map_name = map.to_str().expect("UTF-8");
    let (code, out, _) = run_with(&a, &b, &["--max", "255", "--heatmap", map_name]);
    assert_eq!(code, EXIT_DIFFERENT);
    assert_eq!(out.lines().count(), 1);
    assert!(out.contains("20 × 10") && out.contains("20 × 11"), "{out}");
    assert!(!map.exists());
    let (code, out, _) = run_with(&a, &b, &["--json"]);
    assert_eq!(code, EXIT_DIFFERENT);
    let json = json_of(&out);
    assert!(
        json["flip"].is_null() && json["pixels"].is_null() && json["max"].is_null(),
        "{out}"
    );
    assert_eq!(json["same"], false);
}

#[test]
fn the_heat_map_is_bright_where_the_pictures_differ() {
    let folder = Folder::new();
    let mut changed = grey();
    for texel in changed
        .rgba
        .as_chunks_mut::<4>()
        .0
        .iter_mut()
        .filter(|t| t[0] == 100)
        .take(3)
    {
        *texel = [255, 255, 255, 255];
    }
    let a = folder.picture("a.png", &grey());
    let b = folder.picture("b.png", &changed);
    let map = folder.0.join("map.png");
    let (code, out, _) = run_with(&a, &b, &["--heatmap", map.to_str().expect("UTF-8")]);
    assert_eq!(code, EXIT_DIFFERENT);
    assert!(out.contains("map.png"), "{out}");
    let bytes = fs::read(&map).expect("the heat map");
    let image = decode(&bytes, &Limits::default()).expect("a PNG");
    assert_eq!((image.width, image.height), (20, 10));
    assert!(image.texel(1, 0)[0] > 128 && image.texel(19, 9)[0] < 40);
    let parts = fs::read_dir(&folder.0).expect("the folder").count();
    assert_eq!(parts, 3, "a part was left behind");
}

#[test]
fn unreadable_and_unwritable_files_are_named() {
    let folder = Folder::new();
    let a = folder.picture("a.png", &grey());
    let missing = folder.0.join("missing.png");
    let text = folder.0.join("text.png");
    fs::write(&text, "not a picture at all, only text").expect("a writable folder");
    for wrong in [&missing, &text, &folder.0] {
        for (first, second) in [(&a, wrong), (wrong, &a)] {
            let (code, out, err) = run_with(first, second, &[]);
            assert_eq!(code, EXIT_UNREADABLE);
            assert!(
                out.is_empty() && err.contains(wrong.to_str().expect("UTF-8")),
                "{err}"
            );
            assert_eq!(err.lines().count(), 1);
        }
    }
    let (code, out, _) = run_with(&a, &missing, &["--json"]);
    assert_eq!(code, EXIT_UNREADABLE);
    assert!(
        json_of(&out)["error"]
            .as_str()
            .expect("text")
            .contains("missing.png")
    );

    let (code, _, err) = run_with(&a, &a, &["--heatmap", "/nonexistent-folder/map.png"]);
    assert_eq!(code, EXIT_UNREADABLE);
    assert!(err.contains("heat map"), "{err}");
    let (code, _, err) = run_with(&a, &a, &["--heatmap", "map.gif"]);
    assert_eq!(code, EXIT_USAGE);
    assert!(err.contains(".png"), "{err}");
}
