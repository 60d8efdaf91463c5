//! `estampe depth` end to end: tables, plots, mistakes.

use crate::support::Folder;
use crate::support::shell::run;
use serde_json::Value;

/// The rows of a table in JSON: distance, separation.
fn separations(line: &str) -> Vec<(f64, Option<f64>)> {
    let done = run(&format!("{line} --json"), &Folder::new());
    assert_eq!(done.code, 0, "{line}: {}", done.err);
    let object: Value = serde_json::from_slice(&done.out).expect("one object");
    let rows = object["rows"].as_array().expect("rows");
    let row = |row: &Value| {
        (
            row["distance"].as_f64().expect("a number"),
            row["separation"].as_f64(),
        )
    };
    rows.iter().map(row).collect()
}

/// More bits, a farther near plane, reversed floats and logarithms resolve finer; the separation
/// grows with the square of the distance, or with the distance.
/// Rows: D2.
#[test]
fn the_table_shows_the_remedies() {
    let at = |options: &str, z: u32| {
        let rows = separations(&format!("estampe depth --far 1000 {options} --at {z}"));
        rows[0].1.unwrap_or(f64::INFINITY)
    };
    let plain = at("--near 0.01 --format d24", 500);
    assert!((1.0..10.0).contains(&plain), "{plain}");
    let cures = [
        ("--near 1 --format d24", 50.0),
        ("--near 0.01 --format d24 --log", 10_000.0),
        ("--near 0.01 --format d32f --reversed", 10_000.0),
    ];
    for (options, factor) in cures {
        let cured = at(options, 500);
        assert!(cured * factor < plain, "{options}: {cured} {plain}");
    }
    assert!(at("--near 0.01 --format d16", 500) > 30.0 * plain);
    // A float with depth 1 at the far plane gains nothing.
    let float = at("--near 0.01 --format d32f", 500);
    assert!((0.3..3.0).contains(&(float / plain)), "{float} {plain}");
    // Ten times the distance: a hundred times the separation of a hyperbola, ten times that of a
    // logarithm.
    let ratio = at("--near 1 --format d16", 200) / at("--near 1 --format d16", 20);
    assert!((70.0..140.0).contains(&ratio), "{ratio}");
    let ratio = at("--near 1 --format d16 --log", 200) / at("--near 1 --format d16 --log", 20);
    assert!((9.0..11.0).contains(&ratio), "{ratio}");
}

#[test]
fn the_table_has_a_row_for_each_distance() {
    let rows = separations("estampe depth --near 0.5 --far 100 --format d24");
    let distances: Vec<f64> = rows.iter().map(|row| row.0).collect();
    assert_eq!(distances, [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0]);
    assert!(rows.iter().all(|row| row.1.is_some()));
    let rows = separations("estampe depth --near 0.001 --far inf --format d16 --at 5 --at 500");
    assert!(rows[0].1.is_some() && rows[1].1.is_none(), "{rows:?}");

    let folder = Folder::new();
    let done = run(
        "estampe depth --near 0.001 --far inf --format d16 --at 500",
        &folder,
    );
    let text = String::from_utf8(done.out).expect("text");
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(
        text.starts_with("d16, near 0.001, far inf (far/near inf)\n"),
        "{text}"
    );
    assert!(
        text.contains("- : no surface up to the far plane is told apart"),
        "{text}"
    );
    let done = run(
        "estampe depth --near 0.001 --far 5 --format d32f -q",
        &folder,
    );
    assert!(done.code == 0 && done.out.is_empty() && done.err.is_empty());
}

/// Rows: D2.
#[test]
fn plots_are_svg_or_pictures() {
    let folder = Folder::new();
    let command = "estampe depth --near 0.1 --far 1000 --format d24";
    for (output, start) in [
        ("-o a.svg", &b"<svg "[..]),
        ("-o a.PNG", b"\x89PNG"),
        ("-o a.jpg", b"\xff\xd8"),
        ("-o b --output-format svg", b"<svg "),
    ] {
        let done = run(&format!("{command} {output}"), &folder);
        assert_eq!(done.code, 0, "{output}: {}", done.err);
        assert!(
            done.out.starts_with(b"d24, near 0.1"),
            "the table is printed too"
        );
        let name = output.split(' ').nth(1).expect("a name");
        let bytes = std::fs::read(folder.path(name)).expect("written");
        assert!(bytes.starts_with(start), "{output}");
    }
    let svg = std::fs::read_to_string(folder.path("a.svg")).expect("text");
    for text in [
        "d24 measured",
        "d24 formula",
        "d16",
        "d32f",
        "least separation",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    let done = run(
        &format!("{command} -o - --output-format svg --json"),
        &folder,
    );
    assert_eq!(String::from_utf8_lossy(&done.out), svg);
    let object: Value = serde_json::from_str(&done.err).expect("one object");
    assert_eq!(object["output"]["bytes"], svg.len());
    assert_eq!(object["output"]["format"], "svg");
}

#[test]
fn mistakes_are_errors_that_say_what_to_do() {
    let folder = Folder::new();
    for (options, code, said) in [
        ("--near 0 --far 10 --format d24", 2, "above 0"),
        ("--near -1 --far 10 --format d24", 2, "above 0"),
        ("--near 1 --far 1 --format d24", 2, "beyond the near plane"),
        ("--near 5 --far 1 --format d24", 2, "beyond the near plane"),
        ("--near 1 --far nan --format d24", 2, "or inf"),
        ("--near 1e-31 --far 1 --format d24", 2, "1e-30"),
        (
            "--near 1 --far inf --format d24 --log",
            2,
            "finite far plane",
        ),
        ("--near 1 --far 10 --format d25", 2, "d24"),
        ("--near 1 --far 10", 2, "--format"),
        (
            "--near 1 --far 10 --format d24 --at 11",
            2,
            "between the planes",
        ),
        ("--near 1 --far 10 --format d24 -o -", 2, "--output-format"),
        ("--near 1 --far 10 --format d24 -o plot.gif", 2, ".svg"),
        (
            "--near 1 --far 10 --format d24 -o p.svg --size 10x10",
            2,
            "at least",
        ),
        ("--near 1 --far 10 --format d24 -o no/plot.svg", 3, "folder"),
    ] {
        let done = run(&format!("estampe depth {options}"), &folder);
        assert_eq!(done.code, code, "{options}: {}", done.err);
        assert!(done.err.contains(said), "{options}: {}", done.err);
        assert!(done.out.is_empty(), "{options}");
    }
    assert!(folder.names().is_empty());
    let done = run(
        "estampe depth --near 2 --far 1 --format d16 --json",
        &folder,
    );
    let object: Value = serde_json::from_slice(&done.out).expect("one object");
    assert_eq!(object["exit_code"], 2);
}
