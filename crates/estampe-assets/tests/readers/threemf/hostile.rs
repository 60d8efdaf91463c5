//! Damaged and hostile packages.

use super::archive::{model, package, square, zip};
use super::try_read;
use estampe_assets::model::NoResources;
use estampe_assets::{AssetError, Limits, ModelFormat, parse_model};

fn fault(model: &str) -> AssetError {
    match try_read(&package(model.as_bytes(), &[], true)) {
        Err(error) => error,
        Ok(_) => panic!("{model}"),
    }
}

fn object(content: &str) -> String {
    let object = format!(r#"<object id="1">{content}</object>"#);
    model("", &object, r#"<item objectid="1"/>"#)
}

/// Rows: M7.
#[test]
fn broken_models_are_errors_with_their_place() {
    for (text, what) in [
        (
            object("<mesh>"),
            "line 6, column 22: the XML is not well-formed",
        ),
        (
            object(r#"<mesh><vertices><vertex x="0" y="1"/></vertices></mesh>"#),
            "line 6, column 32: the vertex lacks",
        ),
        (
            object(r#"<mesh><vertices><vertex x="0" y="1" z="1mm"/></vertices></mesh>"#),
            "`z` is no number",
        ),
        (
            object(r#"<mesh><triangles><triangle v1="0" v2="1"/></triangles></mesh>"#),
            "the triangle lacks",
        ),
        (
            object(r#"<mesh><triangles><triangle v1="0" v2="1" v3="-1"/></triangles></mesh>"#),
            "`v3` is no whole number",
        ),
        (
            object(r#"<mesh><vertices><vertex x=0 y="1" z="2"/></vertices></mesh>"#),
            "line 6, column 32: an attribute is not well-formed",
        ),
        (
            object(r#"<components><component objectid="2"/></components>"#),
            "line 6, column 28: the object 2 does not exist",
        ),
        (
            object(r#"<components><component objectid="1"/></components>"#),
            "line 6, column 1: the object is a component of itself",
        ),
        (
            object(r#"<components><component/></components>"#),
            "no `objectid`",
        ),
        (
            model("", "", r#"<item objectid="4"/>"#),
            "line 8, column 8: the object 4 does not exist",
        ),
        (
            model("", "", r#"<item objectid="4" transform="1 2 3"/>"#),
            "`transform` is no number",
        ),
        (
            model(
                "",
                "",
                r#"<item objectid="4" transform="1 0 0 0 1 0 0 0 1 0 0 nan"/>"#,
            ),
            "not 12 finite numbers",
        ),
        (
            model(r#"unit="parsec""#, "", ""),
            "line 2, column 1: `parsec` is no unit",
        ),
        (
            model("", "<object/>", ""),
            "line 6, column 1: the element has no `id`",
        ),
        (
            model("", r#"<object id="1"/><object id="1"/>"#, ""),
            "two objects",
        ),
        (
            "<!DOCTYPE m [<!ENTITY a \"b\">]><model/>".to_owned(),
            "line 1, column 1: the XML declares a document type",
        ),
        (String::new(), "no 3D model"),
        ("<model><build>".to_owned(), "ends within an element"),
    ] {
        let error = fault(&text);
        assert!(matches!(error, AssetError::Malformed(_)), "{text}: {error}");
        let message = error.to_string();
        assert!(
            message.starts_with("test.3mf, 3D/3dmodel.model, line "),
            "{message}"
        );
        assert!(message.contains(what), "{what}: {message}");
        assert!(!error.fault().advice.is_empty(), "{message}");
    }
}

#[test]
fn unknown_required_extensions_are_named() {
    let attributes = r#"xmlns:b="http://example.com/beams" requiredextensions="m b  q""#;
    let error = fault(&model(attributes, "", ""));
    assert!(matches!(error, AssetError::Unsupported(_)), "{error}");
    let message = error.to_string();
    assert!(
        message.contains("not read: `b` (http://example.com/beams), `q`;"),
        "{message}"
    );
}

/// Each object has ten of the one before: 10^n objects.
fn nested(depth: usize, innermost: &str) -> String {
    let mut objects = format!(r#"<object id="1">{innermost}</object>"#);
    for id in 2..=depth {
        let component = format!(r#"<component objectid="{}"/>"#, id - 1).repeat(10);
        let object = format!(r#"<object id="{id}"><components>{component}</components></object>"#);
        objects.push_str(&object);
    }
    model("", &objects, &format!(r#"<item objectid="{depth}"/>"#))
}

#[test]
fn expanded_components_are_bounded() {
    let limits = Limits {
        max_meshes: 7,
        ..Limits::default()
    };
    let text = nested(3, &square([""; 2]));
    let bytes = package(text.as_bytes(), &[], true);
    let loaded = parse_model(
        &bytes,
        ModelFormat::ThreeMf,
        "test.3mf",
        &NoResources,
        &limits,
    )
    .unwrap();
    let counts: Vec<_> = { loaded.scene.meshes.iter() }
        .map(|mesh| mesh.triangles.len())
        .collect();
    assert_eq!(counts, [2, 2, 2, 2, 2, 2, 2 * 94]);
    let empty = "<mesh/>".to_owned();
    for (depth, innermost) in [
        (12, &square([""; 2])),
        (40, &square([""; 2])),
        (12, &empty),
        (66, &empty),
        (50_000, &empty),
    ] {
        let error = fault(&nested(depth, innermost));
        assert!(
            matches!(error, AssetError::LimitExceeded(_)),
            "{depth}: {error}"
        );
    }
    let both = r#"<object id="1"><components><component objectid="2"/></components></object>
<object id="2"><components><component objectid="1"/></components></object>"#;
    let error = fault(&model("", both, r#"<item objectid="1"/>"#));
    assert!(
        error.to_string().contains("a component of itself"),
        "{error}"
    );
}

#[test]
fn elements_without_finite_corners_or_vertices_are_omitted() {
    let content = r#"<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="0" y="1" z="0"/><vertex x="nan" y="1e99" z="0"/></vertices><triangles>
<triangle v1="0" v2="1" v3="2"/><triangle v1="0" v2="1" v3="3"/>
<triangle v1="0" v2="1" v3="4"/></triangles></mesh>"#;
    let loaded = try_read(&package(object(content).as_bytes(), &[], true)).unwrap();
    assert_eq!(loaded.scene.meshes[0].triangles, [[0, 1, 2]]);
    assert_eq!(
        loaded.warnings[0].to_string(),
        "test.3mf, 3D/3dmodel.model, line 9, column 1: the triangle refers to a vertex that does \
         not exist; it is omitted"
    );
}

/// Replaces the only such bytes, or the last such ones.
fn patched(mut bytes: Vec<u8>, from: &[u8], to: &[u8]) -> Vec<u8> {
    let at = bytes
        .windows(from.len())
        .rposition(|window| window == from)
        .unwrap();
    bytes[at..at + to.len()].copy_from_slice(to);
    bytes
}

#[test]
fn broken_archives_are_errors() {
    let message = |bytes: &[u8]| try_read(bytes).expect_err("it is broken").to_string();
    assert!(message(b"").contains("no ZIP archive"));
    assert!(message(b"v 0 0 0").contains("no ZIP archive"));
    assert!(message(b"PK\x03\x04").contains("the archive has no end"));
    for name in ["../a.model", "/a", "a/./b", "a\\b", "a\0b", "a/.."] {
        let bytes = zip(&[(name, b"")], false);
        assert!(message(&bytes).contains("outside of the archive"), "{name}");
    }
    let twice = zip(&[("a", b""), ("A", b"")], false);
    assert!(message(&twice).contains("two entries have the name `A`"));
    let other = zip(&[("word/document.xml", b"")], false);
    assert!(message(&other).contains("does not name the part"));
    let good = package(object(&square([""; 2])).as_bytes(), &[], false);
    // The records of the model: its length, its place, its method, its flags and its checksum.
    let record = good
        .windows(4)
        .rposition(|window| window == b"PK\x01\x02")
        .unwrap();
    let with = |at: usize, value: &[u8]| {
        let mut bytes = good.clone();
        bytes[record + at..record + at + value.len()].copy_from_slice(value);
        message(&bytes)
    };
    assert!(with(10, &[12, 0]).contains("packed by method 12"));
    assert!(with(8, &[1, 0]).contains("is encrypted"));
    assert!(with(16, &[1, 2, 3, 4]).contains("another checksum"));
    assert!(with(24, &[9, 0, 0, 0]).contains("another length"));
    assert!(with(24, &[255, 255, 255, 127]).contains("more than the limit"));
    assert!(with(20, &[255, 255, 0, 0]).contains("overlaps"));
    assert!(with(42, &[0, 0, 0, 0]).contains("overlaps"));
    assert!(with(42, &[255, 255, 255, 255]).contains("record of an entry is damaged"));
    let target = patched(good.clone(), b"/3D/3dmodel.model", b"/../../../a.model");
    assert!(message(&target).contains("another checksum"));
}

#[test]
fn archives_that_unpack_to_much_are_refused() {
    let zeros = vec![b' '; 4 << 20];
    let bytes = package(&zeros, &[], true);
    let limits = Limits {
        max_file_bytes: 1 << 20,
        ..Limits::default()
    };
    assert!(bytes.len() < 1 << 14);
    let read = |bytes: &[u8]| {
        parse_model(
            bytes,
            ModelFormat::ThreeMf,
            "test.3mf",
            &NoResources,
            &limits,
        )
        .expect_err("it is too large")
    };
    assert!(matches!(read(&bytes), AssetError::LimitExceeded(_)));
    // A record that hides the length.
    let hidden = patched(bytes, &(4_u32 << 20).to_le_bytes(), &64_u32.to_le_bytes());
    assert!(read(&hidden).to_string().contains("another length"));
}
