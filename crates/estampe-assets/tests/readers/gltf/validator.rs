//! The rules of `docs/gltf-rules.md`: valid files with one change each, of which Khronos's glTF
//! validator and this reader say what is expected.
//!
//! `data/gltf-rules` has three valid files that use most features, and `cases.tsv`, a line for each
//! change, with these columns:
//!
//! | column | |
//! |---|---|
//! | file | `geometry`, `skins` or `extensions`; `unreached` before it puts its nodes into a scene that is not read |
//! | change, place, value | `set` and `remove` at a JSON Pointer; `word` at a byte of the buffer, in hexadecimal digits; of the GLB form `glb` (a word), `cut` and `append` (bytes at the end), `first` (bytes that remain) |
//! | validator | `error`, `warning` or `valid`, by the validator 2.0.0-dev.3.10 |
//! | reader | `error`, `warning` or `silent` |
//! | codes | the validator's codes of that class |

use super::builder::glb;
use estampe_assets::model::{AnimationName, ModelOptions, NoResources};
use estampe_assets::{Limits, ModelFormat, ModelInput, parse_model_with};
use serde_json::{Value, json};

const CASES: &str = include_str!("../../data/gltf-rules/cases.tsv");
const PAGE: &str = include_str!("../../../../../docs/gltf-rules.md");

/// A line of the table.
struct Case<'a> {
    file: &'a str,
    change: &'a str,
    place: &'a str,
    value: &'a str,
    validator: &'a str,
    reader: &'a str,
    codes: Vec<&'a str>,
}

fn cases() -> Vec<Case<'static>> {
    let case = |line: &'static str| {
        let columns: Vec<&str> = line.split('\t').collect();
        let [file, change, place, value, validator, reader, codes] = columns[..] else {
            panic!("{line}")
        };
        Case {
            file,
            change,
            place,
            value,
            validator,
            reader,
            codes: codes.split_whitespace().collect(),
        }
    };
    CASES.lines().map(case).collect()
}

fn base(name: &str) -> Value {
    let (name, is_reached) = match name.strip_prefix("unreached ") {
        Some(name) => (name, false),
        None => (name, true),
    };
    let text = match name {
        "geometry" => include_str!("../../data/gltf-rules/geometry.gltf"),
        "skins" => include_str!("../../data/gltf-rules/skins.gltf"),
        "extensions" => include_str!("../../data/gltf-rules/extensions.gltf"),
        other => panic!("{other}"),
    };
    let mut file: Value = serde_json::from_str(text).expect("JSON");
    if !is_reached {
        let push = |list: &mut Value, value: Value| {
            let list = list.as_array_mut().expect("a list");
            list.push(value);
            list.len() - 1
        };
        let view = file["bufferViews"][0].clone();
        let mut accessor = file["accessors"][0].clone();
        accessor["bufferView"] = json!(push(&mut file["bufferViews"], view));
        let accessor = push(&mut file["accessors"], accessor);
        let mesh = json!({ "primitives": [{ "attributes": { "POSITION": accessor } }] });
        let mesh = push(&mut file["meshes"], mesh);
        let node = push(&mut file["nodes"], json!({ "mesh": mesh }));
        file["scene"] = json!(push(&mut file["scenes"], json!({ "nodes": [node] })));
    }
    file
}

/// The bytes of the buffer of a file.
fn buffer(file: &Value) -> Vec<u8> {
    let uri = file["buffers"][0]["uri"].as_str().expect("a data URI");
    let digits = uri.split(',').nth(1).expect("data").bytes();
    let value = |byte| match byte {
        b'A'..=b'Z' => byte - b'A',
        b'a'..=b'z' => byte - b'a' + 26,
        b'0'..=b'9' => byte - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let mut bytes = Vec::new();
    let (mut bits, mut count) = (0_u32, 0);
    for byte in digits.filter(|&byte| byte != b'=') {
        (bits, count) = (bits << 6 | u32::from(value(byte)), count + 6);
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count).to_le_bytes()[0]);
        }
    }
    bytes
}

fn word(bytes: &mut [u8], place: &str, value: &str) {
    let at: usize = place.parse().expect("a byte");
    let value = u32::from_str_radix(value, 16).expect("hexadecimal digits");
    bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
}

/// The file of a case.
fn changed(case: &Case<'_>) -> Vec<u8> {
    let mut file = base(case.file);
    let container = |file: &Value| {
        let mut json = file.clone();
        json["buffers"][0]
            .as_object_mut()
            .expect("a buffer")
            .remove("uri");
        glb(json.to_string().as_bytes(), &buffer(file))
    };
    let count = || case.place.parse::<usize>().expect("a number");
    match case.change {
        "as is" => {}
        "set" | "remove" => {
            let (parent, key) = case.place.rsplit_once('/').expect("a pointer");
            let parent = file.pointer_mut(parent).expect("the parent is there");
            let value = || serde_json::from_str(case.value).expect("JSON");
            match parent {
                Value::Array(list) => {
                    let at: usize = key.parse().expect("an index");
                    if case.change == "remove" {
                        list.remove(at);
                    } else if at == list.len() {
                        list.push(value());
                    } else {
                        list[at] = value();
                    }
                }
                Value::Object(map) if case.change == "remove" => drop(map.remove(key)),
                Value::Object(map) => drop(map.insert(key.to_owned(), value())),
                _ => panic!("{}", case.place),
            }
        }
        "word" => {
            let mut bytes = buffer(&file);
            word(&mut bytes, case.place, case.value);
            let data = super::builder::base64(&bytes);
            file["buffers"][0]["uri"] =
                json!(format!("data:application/octet-stream;base64,{data}"));
        }
        "glb" => {
            let mut bytes = container(&file);
            word(&mut bytes, case.place, case.value);
            return bytes;
        }
        "cut" => {
            let mut bytes = container(&file);
            bytes.truncate(bytes.len() - count());
            return bytes;
        }
        "append" => {
            let mut bytes = container(&file);
            bytes.resize(bytes.len() + count(), 0);
            return bytes;
        }
        "first" => {
            let mut bytes = container(&file);
            bytes.truncate(count());
            return bytes;
        }
        other => panic!("{other}"),
    }
    file.to_string().into_bytes()
}

/// Rows: M7.
#[test]
fn each_change_is_an_error_a_warning_or_nothing_as_the_table_says() {
    let options = ModelOptions {
        animation: Some(AnimationName::First),
        time_s: 0.25,
        ..ModelOptions::default()
    };
    let mut wrong = Vec::new();
    for case in cases() {
        let bytes = changed(&case);
        let input = ModelInput {
            bytes: &bytes,
            format: ModelFormat::Gltf,
            name: "a.gltf",
            resources: &NoResources,
        };
        let (found, message) = match parse_model_with(&input, &options, &Limits::default()) {
            Err(error) => ("error", error.to_string()),
            Ok(loaded) => match &loaded.warnings[..] {
                [] => ("silent", String::new()),
                [first, ..] => ("warning", first.to_string()),
            },
        };
        if found != case.reader {
            let Case {
                file,
                change,
                place,
                value,
                ..
            } = case;
            wrong.push(format!(
                "{file}: {change} {place} {value}: {found}, not {}: {message}",
                case.reader
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_code_of_the_table_stands_on_the_page() {
    let (_, unchecked) = PAGE.split_once("## Not checked").expect("a section");
    let mut silent = 0;
    for case in cases().iter().filter(|case| case.validator == "error") {
        for code in &case.codes {
            assert!(PAGE.contains(&format!("`{code}`")), "{code}");
        }
        if case.reader == "silent" {
            silent += 1;
            for code in &case.codes {
                assert!(unchecked.contains(&format!("`{code}`")), "{code}");
            }
        }
    }
    assert!(
        silent > 30,
        "{silent} changes that only the validator refuses"
    );
}
