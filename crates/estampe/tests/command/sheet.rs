//! Contact sheets.

use crate::support::picture::Picture;
use crate::support::{Folder, Run, TETRAHEDRON, estampe, estampe_fed, machines};
use serde_json::{Value, json};
use std::fs;

/// A folder with two models, and one that is broken.
fn models() -> Folder {
    let folder = Folder::new();
    folder.with_file("m/b.obj", TETRAHEDRON);
    folder.with_file("m/a.obj", TETRAHEDRON.replace("v 1 0 0", "v 3 0 0"));
    folder.with_file("m/c/broken.obj", "# nothing\n");
    folder
}

/// Runs `estampe sheet` with these words, where `@` stands for the folder, and `--json`.
fn sheet(folder: &Folder, words: &str) -> (Run, Value) {
    sheet_fed(folder, words, &[])
}

fn sheet_fed(folder: &Folder, words: &str, input: &[u8]) -> (Run, Value) {
    let root = folder.path("");
    let words = words.replace('@', root.to_str().expect("UTF-8").trim_end_matches('/'));
    let run = estampe_fed(&format!("sheet --json {words}"), &[], input);
    let report = serde_json::from_slice(&run.out).unwrap_or(Value::Null);
    (run, report)
}

/// The texels of a rectangle.
fn part(picture: &Picture, [x, y, width, height]: [usize; 4]) -> Vec<[u8; 4]> {
    let rows = y..y + height;
    rows.flat_map(|y| (x..x + width).map(move |x| picture.pixel(x, y)))
        .collect()
}

fn place(cell: &Value) -> [usize; 4] {
    ["x", "y", "width", "height"].map(|key| {
        let side = cell[key].as_u64().expect("a number");
        usize::try_from(side).expect("small")
    })
}

#[test]
fn each_cell_is_the_picture_of_render() {
    let folder = models();
    let looks = "--shading flat --samples 1 --background #203040";
    let (run, report) = sheet(
        &folder,
        &format!("@/m/*.obj builtin:cube -o @/s.png --cell 40x30 --columns 2 {looks}"),
    );
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(
        report["counts"],
        json!({"drawn": 3, "failed": 0, "limit": 0})
    );
    let sheet = Picture::open(&folder.path("s.png"));
    // Two columns of 40 with three gaps of 8; two rows of 30 and labels of 20.
    assert_eq!((sheet.width, sheet.height), (104, 124));
    assert_eq!(report["output"]["rows"], 2);
    let cells = report["cells"].as_array().expect("cells");
    let (a, b) = (folder.path("m/a.obj"), folder.path("m/b.obj"));
    for (cell, model) in cells
        .iter()
        .zip([a.to_str(), b.to_str(), Some("builtin:cube")])
    {
        assert_eq!(cell["model"].as_str(), model);
        let words = format!(
            "render {} -o {{}} --size 40x30 {looks}",
            model.expect("UTF-8")
        );
        let one = folder.path("one.png");
        assert_eq!(estampe(&words, &[&one]).code, 0);
        let one = Picture::open(&one);
        assert!(
            part(&sheet, place(cell)) == part(&one, [0, 0, 40, 30]),
            "{cell}"
        );
    }
    // The gap, and a label.
    assert_eq!(sheet.pixel(4, 60), [0x20, 0x30, 0x40, 255]);
    let label = part(&sheet, [8, 38, 40, 20]);
    assert!(
        label.iter().any(|texel| texel[0] > 0xc0),
        "letters are light on dark"
    );
}

#[test]
fn sheets_do_not_depend_on_threads_or_simd_level() {
    let folder = models();
    let words = "@/m/a.obj builtin:teapot @/m/c/broken.obj --turn 3 --cell 60x40 --shadow \
                 --max-triangles 100000 -q -o @/";
    let mut first = None;
    for (number, machine) in machines().into_iter().enumerate() {
        let (name, parallel) = (format!("{number}.tga"), 1 + number % 3);
        let options = format!("{words}{name} {machine} --parallel {parallel}");
        let (run, report) = sheet(&folder, &options);
        assert_eq!(run.code, 1, "{}", run.err);
        assert_eq!(
            report["counts"],
            json!({"drawn": 6, "failed": 3, "limit": 0})
        );
        let bytes = fs::read(folder.path(&name)).expect("written");
        assert!(*first.get_or_insert(bytes.clone()) == bytes, "{machine}");
    }
}

#[test]
fn a_model_that_fails_has_a_cell_and_the_others_are_drawn() {
    let folder = models();
    let (run, report) = sheet(
        &folder,
        "@/m/c/broken.obj @/m/missing.stl builtin:sphere builtin:ball -o @/s.png --cell 100x60",
    );
    assert_eq!(run.code, 1, "{}", run.err);
    let cells = report["cells"].as_array().expect("cells");
    let statuses: Vec<&Value> = cells.iter().map(|cell| &cell["status"]).collect();
    assert_eq!(statuses, ["failed", "failed", "drawn", "failed"]);
    let error = cells[0]["error"].as_str().expect("a sentence");
    assert!(error.contains("it contains no OBJ statement"), "{error}");
    assert!(run.err.contains("error: ") && run.err.contains("missing.stl: no such file"));
    let drawn = Picture::open(&folder.path("s.png"));
    let [x, y, ..] = place(&cells[0]);
    assert_eq!(drawn.pixel(x, y), [0xf8, 0xdc, 0xd8, 255]);
    let text = part(&drawn, place(&cells[0]));
    let dark = text.iter().filter(|texel| texel[1] < 0x80).count();
    assert!(dark > 100, "{dark} texels of letters");
    // A cell that is too small for a letter is not.
    let (run, _) = sheet(&folder, "@/m/c/broken.obj -o @/t.png --cell 1x1 --gap 0");
    assert_eq!(run.code, 1, "{}", run.err);
}

#[test]
fn models_over_a_limit_have_a_cell() {
    let folder = models();
    for limit in [
        "--max-triangles 2",
        "--timeout 0.000001",
        "--max-memory 9000",
    ] {
        let words = format!("builtin:plane @/m/a.obj -o @/s.png --cell 32x32 {limit}");
        let (run, report) = sheet(&folder, &words);
        assert_eq!(run.code, 1, "{limit}: {}", run.err);
        assert_eq!(report["cells"][1]["status"], "limit", "{limit}: {report}");
    }
}

#[test]
fn views_are_columns_of_several_models() {
    let folder = models();
    let words =
        "@/m/a.obj @/m/b.obj -o @/s.png --cell 24x24 --labels none --gap 0 --views front,top,iso";
    let (run, report) = sheet(&folder, words);
    assert_eq!(run.code, 0, "{}", run.err);
    let output = &report["output"];
    assert_eq!([&output["columns"], &output["rows"]], [3, 2]);
    assert_eq!([&output["width"], &output["height"]], [72, 48]);
    assert_eq!(report["cells"][4]["view"], "top");
    let (run, report) = sheet(
        &folder,
        "builtin:cube -o @/t.png --turn 16 --azimuth -90 --cell 9x9",
    );
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(report["cells"][1]["view"], "292.5°");
}

#[test]
fn lists_come_on_standard_input() {
    let folder = models();
    let list = format!(
        "{}\n\n{}\n",
        folder.path("m/b.obj").display(),
        folder.path("m/a.obj").display()
    );
    let (run, report) = sheet_fed(&folder, "- -o @/s.png --cell 9x9", list.as_bytes());
    assert_eq!(run.code, 0, "{}", run.err);
    let name = report["cells"][0]["model"].as_str();
    assert!(name.is_some_and(|name| name.ends_with("b.obj")), "{report}");
    let (run, _) = sheet_fed(&folder, "- -o @/s.png", b"\n");
    assert_eq!(run.code, 1, "{}", run.err);
}

#[test]
fn wrong_usage_is_an_error_before_anything_is_written() {
    let folder = models();
    folder.with_file("m/t.mtl", "newmtl t\nmap_Kd t.png\n");
    folder.with_file("m/t.obj", format!("mtllib t.mtl\nusemtl t\n{TETRAHEDRON}"));
    let texture = folder.path("m/t.png");
    assert_eq!(
        estampe("render builtin:plane -o {} --size 4x4 -q", &[&texture]).code,
        0
    );
    let before = fs::read(&texture).expect("drawn");
    for (words, problem) in [
        ("builtin:cube -o @/s.gif", ".gif is no format of pictures"),
        (
            "builtin:cube -o @/s.png --cell 9000x9 --turn 1000 --columns 1000",
            "16384 a side",
        ),
        ("builtin:cube -o @/s.png --turn 0", "1..=1000"),
        (
            "builtin:cube -o @/s.png --turn 3 --eye 1,1,1",
            "cannot be used with",
        ),
        (
            "builtin:cube -o @/s.png --views top --turn 3",
            "cannot be used with",
        ),
        (
            "builtin:cube -o @/s.png --size 9x9",
            "unexpected argument '--size'",
        ),
        ("@/m/*.stl -o @/s.png", "no file matches"),
        (
            "@/m/a.obj -o @/m/a.obj --output-format png",
            "would be overwritten",
        ),
        ("@/m/t.obj -o @/m/t.png", "would be overwritten"),
        (
            "builtin:cube -o @/s.png --texture @/none.png",
            "no such file",
        ),
        ("-o @/s.png", "<INPUT>..."),
    ] {
        let (run, _) = sheet(&folder, words);
        assert!(run.code == 1 || run.code == 2, "{words}: {}", run.err);
        assert!(run.err.contains(problem), "{words}: {}", run.err);
        assert!(!folder.path("s.png").exists(), "{words}");
    }
    assert!(fs::read(&texture).is_ok_and(|after| after == before));
}

/// Gaps and strips of labels have the colour and the alpha of what is behind the models.
#[test]
fn gaps_have_the_background() {
    let folder = models();
    let words =
        "builtin:cube builtin:torus -o @/s.png --cell 40x30 --columns 2 --labels none --gap 6";
    let texels = |background: &str| {
        let (run, _) = sheet(&folder, &format!("{words} --background {background}"));
        assert_eq!(run.code, 0, "{}", run.err);
        let sheet = Picture::open(&folder.path("s.png"));
        assert_eq!((sheet.width, sheet.height), (98, 42));
        // A gap, and the corner of a cell.
        [sheet.pixel(2, 20), sheet.pixel(48, 20), sheet.pixel(6, 6)]
    };
    for background in ["#ff0000", "#ff000080", "#12345678", "none", "tan"] {
        let [border, gap, cell] = texels(background);
        assert_eq!([border, gap], [cell; 2], "{background}");
    }
    let [border, gap, cell] = texels("linear:#000000,#ffffff");
    assert!(border == gap && border[3] == 255, "{border:?}");
    assert!(
        cell[0] < border[0] && border[0] < 200,
        "{cell:?} {border:?}"
    );
    let [border, ..] = texels("radial:#00ff00,transparent");
    assert_eq!(border, [0, 255, 0, 128]);
}
