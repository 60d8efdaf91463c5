//! `estampe shader reflect` end to end, as text and JSON.

use crate::support::Folder;
use crate::support::shell::run;
use serde_json::{Value, json};

const WGSL: &str = "\
struct Light { color: vec3f, reach: f32 }
struct Frame { clip: mat4x4f, lights: array<Light, 2>, weights: array<vec4f, 3> }
override count: u32 = 3;
@id(7) override half: bool;
@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(2) var wood: texture_2d<f32>;
@group(0) @binding(3) var linear: sampler;
@group(1) @binding(0) var<storage, read_write> words: array<u32>;
struct Out { @builtin(position) at: vec4f, @location(0) uv: vec2f, @location(1) @interpolate(flat) n: u32 }
@vertex fn vs(@location(0) position: vec3f) -> Out { return Out(frame.clip * vec4f(position, 1.0), position.xy, 1u); }
@fragment fn fs(in: Out) -> @location(0) vec4f { return textureSample(wood, linear, in.uv) * frame.weights[in.n]; }
@compute @workgroup_size(8, 4) fn fill(@builtin(local_invocation_index) i: u32) { words[i] = select(count, 0u, half); }
";

fn reflect(folder: &Folder, words: &str) -> Value {
    let done = run(&format!("estampe shader reflect {words} --json"), folder);
    assert_eq!((done.code, &*done.err), (0, ""), "{words}");
    serde_json::from_slice(&done.out).expect("one object")
}

/// Rows: G2.
#[test]
fn everything_that_a_module_exchanges_is_listed() {
    let folder = Folder::new();
    folder.with_file("a.wgsl", WGSL);
    let object = reflect(&folder, "a.wgsl");
    let entries = &object["entry_points"];
    let names: Vec<&Value> = (0..3).map(|at| &entries[at]["name"]).collect();
    assert_eq!(names, [&json!("vs"), &json!("fs"), &json!("fill")]);
    assert_eq!(entries[0]["workgroup_size"], Value::Null);
    assert_eq!(entries[2]["workgroup_size"], json!([8, 4, 1]));
    let position = json!({"name": "position", "location": 0, "type": "vec3<f32>", "flat": false});
    assert_eq!(entries[0]["inputs"], json!([position]));
    assert_eq!(entries[1]["inputs"][1]["flat"], true);

    let bindings = &object["bindings"];
    assert_eq!(bindings[0]["size"], 64 + 2 * 16 + 3 * 16);
    assert_eq!(bindings[0]["stages"], json!(["vertex", "fragment"]));
    let members = bindings[0]["members"].as_array().expect("members");
    let places: Vec<_> = members
        .iter()
        .map(|one| (&one["name"], &one["offset"]))
        .collect();
    let expected = [
        ("clip", 0),
        ("lights[0].color", 64),
        ("lights[0].reach", 76),
        ("lights[1].color", 80),
        ("lights[1].reach", 92),
        ("weights", 96),
    ];
    assert_eq!(places.len(), expected.len());
    for (place, (name, offset)) in places.iter().zip(expected) {
        assert_eq!(*place, (&json!(name), &json!(offset)));
    }
    assert_eq!(members[5]["array_length"], 3);
    assert_eq!(members[0]["matrix_stride"], 16);
    assert_eq!(bindings[1]["type"], "2d f32");
    assert_eq!(bindings[2]["kind"], "sampler");
    assert_eq!(
        (&bindings[3]["group"], &bindings[3]["read_only"]),
        (&json!(1), &json!(false))
    );
    assert_eq!(bindings[3]["members"][0]["array_length"], 0);
    let count = json!({"name": "count", "id": null, "type": "u32", "default": 3.0});
    assert_eq!(object["constants"][0], count);
    assert_eq!(
        (
            &object["constants"][1]["id"],
            &object["constants"][1]["default"]
        ),
        (&json!(7), &Value::Null)
    );
    assert_eq!(object["push_constants"], Value::Null);

    let done = run("estampe shader reflect a.wgsl", &folder);
    let text = String::from_utf8(done.out).expect("text");
    for line in [
        "compute `fill`, work-groups of 8x4x1\n",
        "  input 1: u32 `n`, flat\n",
        "binding 0,0: uniform buffer `frame`, 144 bytes, vertex and fragment\n",
        "     64: vec3<f32> `lights[0].color`\n",
        "     96: vec4<f32> `weights`, 3 times every 16 bytes\n",
        "binding 0,2: texture 2d f32 `wood`, fragment\n",
        "binding 1,0: storage buffer `words`, 4 bytes, compute\n",
        "constant `half`, id 7: bool, without a default\n",
    ] {
        assert!(text.contains(line), "{line}in\n{text}");
    }
}

/// Rows: G1.
#[test]
fn loose_uniforms_of_glsl_have_offsets() {
    let folder = Folder::new();
    let text = "uniform mat4 model;\nuniform float size = 0.5 * 3.0;\nuniform sampler2D wood;\n\
                attribute vec3 position;\nvarying vec2 uv;\n\
                void main() { uv = texture2DLod(wood, position.xy, 0.0).xy; gl_Position = model * vec4(position * size, 1.0); }\n";
    folder.with_file("a.glsl", text);
    let object = reflect(&folder, "a.glsl --stage vertex");
    assert_eq!(object["entry_points"][0]["outputs"][0]["name"], "uv");
    let members = &object["bindings"][0]["members"];
    assert_eq!(
        (&members[1]["name"], &members[1]["offset"]),
        (&json!("size"), &json!(64))
    );
    assert_eq!(members[1]["initial_value"], json!([1.5]));
    assert_eq!(members[0]["initial_value"], Value::Null);
    let done = run("estampe shader reflect a.glsl --stage vertex", &folder);
    let text = String::from_utf8(done.out).expect("text");
    assert!(text.contains("     64: f32 `size` = 1.5\n"), "{text}");
    assert_eq!(object["samplers"][0]["name"], "wood");
    let done = run("estampe shader reflect missing.glsl --json", &folder);
    assert_eq!(done.code, 1);
    let object: Value = serde_json::from_slice(&done.out).expect("one object");
    assert_eq!(object["exit_code"], 1);
}

/// Rows: G1, G2.
#[test]
fn immediates_have_offsets() {
    let folder = Folder::new();
    folder.with_file(
        "a.wgsl",
        "struct P { at: vec2f, tint: vec3f, n: u32 }\nvar<immediate> p: P;\n\
         @fragment fn fs() -> @location(0) vec4f { return vec4f(p.tint * p.at.x, f32(p.n)); }\n",
    );
    folder.with_file(
        "a.frag",
        "#version 450\nlayout(push_constant) uniform P { float list[3]; layout(offset = 32) vec4 tint; } p;\n\
         layout(location = 0) out vec4 color;\nvoid main() { color = p.tint * p.list[1]; }\n",
    );
    let member = |name: &str, kind: &str, offset: u32| {
        json!({
            "name": name, "type": kind, "offset": offset,
            "array_length": null, "array_stride": 0, "matrix_stride": 0, "initial_value": null,
        })
    };
    let mut list = member("list", "f32", 0);
    (list["array_length"], list["array_stride"]) = (json!(3), json!(4));
    let of_wgsl = [
        member("at", "vec2<f32>", 0),
        member("tint", "vec3<f32>", 16),
        member("n", "u32", 28),
    ];
    let of_glsl = [list, member("tint", "vec4<f32>", 32)];
    for (file, name, size, members) in [
        ("a.wgsl", "p", 32, &of_wgsl[..]),
        ("a.frag", "P", 48, &of_glsl[..]),
    ] {
        let object = reflect(&folder, file);
        let expected = json!({"name": name, "size": size, "members": members});
        assert_eq!(object["push_constants"], expected);
    }
    let done = run("estampe shader reflect a.wgsl", &folder);
    let text = String::from_utf8(done.out).expect("text");
    let expected = "immediates (push constants) `p`, 32 bytes\n      0: vec2<f32> `at`\n";
    assert!(text.contains(expected), "{text}");
}
