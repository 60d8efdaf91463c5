//! Data passes of `estampe render`.

use crate::support::picture::Picture;
use crate::support::{Folder, estampe, machines};
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

/// Two squares of two materials; the nearer one is on the left.
const SQUARES: &str = "\
mtllib m.mtl\n\
v -2 -1 1\nv 0 -1 1\nv 0 1 1\nv -2 1 1\nv 0 -1 0\nv 2 -1 0\nv 2 1 0\nv 0 1 0\n\
vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
o left\nusemtl red\nf 1/1 2/2 3/3 4/4\no right\nusemtl blue\nf 5/1 6/2 7/3 8/4\n";
const MTL: &str = "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n";

/// The 16-bit codes of a PNG, with its number of channels.
fn codes(path: &Path) -> (usize, Vec<u16>) {
    let bytes = std::fs::read(path).expect("written");
    let mut reader = { png::Decoder::new(Cursor::new(bytes)) }
        .read_info()
        .expect("a PNG");
    let mut samples = vec![0; reader.output_buffer_size().expect("small")];
    let info = reader.next_frame(&mut samples).expect("an image");
    assert_eq!(info.bit_depth, png::BitDepth::Sixteen);
    let codes = samples
        .as_chunks()
        .0
        .iter()
        .map(|&code| u16::from_be_bytes(code));
    (info.color_type.samples(), codes.collect())
}

/// The channels of an OpenEXR.
pub(super) fn channels(path: &Path) -> BTreeMap<String, FlatSamples> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .expect("an OpenEXR");
    let channels = image.layer_data.channel_data.list.into_iter();
    channels
        .map(|channel| (channel.name.to_string(), channel.sample_data))
        .collect()
}

pub(super) fn floats(samples: &FlatSamples) -> Vec<f32> {
    samples.values_as_f32().collect()
}

#[test]
fn a_png_for_each_pass() {
    let folder = Folder::new();
    folder.with_file("m.mtl", MTL);
    let model = folder.with_file("m.obj", SQUARES);
    let words = "render {} -o {} --pass color,depth,normal,albedo,object-id,material-id,uv \
                 --size 40x20 --ortho --eye 0,0,5 --target 0,0,0 --json --background none";
    let run = estampe(words, &[&model, &folder.path("p-{pass}.png")]);
    assert_eq!(run.code, 0, "{}", run.err);
    let report: Value = serde_json::from_slice(&run.out).expect("one object");
    assert_eq!(report["outputs"].as_array().map(Vec::len), Some(7));
    assert_eq!(report["objects"], json!(["left", "right"]));
    assert_eq!(report["materials"], json!(["red", "blue"]));
    assert_eq!(report["camera"]["projection"], "orthographic");
    assert_eq!(report["camera"]["pinhole"], Value::Null);

    let path = |pass: &str| folder.path(&format!("p-{pass}.png"));
    // Left, right and outside of the squares.
    let (left, right, outside) = (10 * 40 + 14, 10 * 40 + 26, 0);
    let (channels, depth) = codes(&path("depth"));
    assert_eq!(channels, 1);
    assert_eq!([depth[left], depth[right], depth[outside]], [4000, 5000, 0]);
    let (channels, normal) = codes(&path("normal"));
    assert_eq!(channels, 3);
    assert_eq!(normal[left * 3..][..3], [32768, 32768, 65535]);
    assert_eq!(normal[..3], [0; 3]);
    for pass in ["object-id", "material-id"] {
        let (_, ids) = codes(&path(pass));
        assert_eq!([ids[left], ids[right], ids[outside]], [1, 2, 0], "{pass}");
    }
    let (_, uv) = codes(&path("uv"));
    assert!(
        uv[left * 3] > uv[(left - 1) * 3] && uv[left * 3 + 2] == 0,
        "u grows to the right"
    );
    let albedo = Picture::open(&path("albedo"));
    assert_eq!(albedo.pixel(14, 10), [255, 0, 0, 255]);
    assert_eq!(albedo.pixel(26, 10), [0, 0, 255, 255]);
    assert_eq!(albedo.pixel(0, 0)[3], 0);

    let plain = "render {} -o {} --size 40x20 --ortho --eye 0,0,5 --target 0,0,0 --background none";
    let run = estampe(plain, &[&model, &folder.path("plain.png")]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(Picture::open(&folder.path("plain.png")) == Picture::open(&path("color")));
}

/// Each position is projected by K, R and t to the centre of its pixel.
///
/// Rows: I3.
#[test]
fn one_open_exr_for_all_passes() {
    let folder = Folder::new();
    let (out, png) = (folder.path("t.exr"), folder.path("t-{pass}.png"));
    let words = "render builtin:teapot --size 48x36 --json -o {} --pass";
    let all = "color,depth,normal,albedo,position,object-id,material-id,uv";
    let run = estampe(&format!("{words} {all}"), &[&out]);
    assert_eq!(run.code, 0, "{}", run.err);
    let report: Value = serde_json::from_slice(&run.out).expect("one object");
    let run = estampe(&format!("{words} depth --depth-unit 0.0002"), &[&png]);
    assert_eq!(run.code, 0, "{}", run.err);

    let channels = channels(&out);
    let names: Vec<&str> = channels.keys().map(String::as_str).collect();
    let expected = "A B G R Z albedo.A albedo.B albedo.G albedo.R material-id.id normal.X normal.Y \
                    normal.Z object-id.id position.X position.Y position.Z uv.U uv.V";
    assert_eq!(names, expected.split(' ').collect::<Vec<_>>());
    let pinhole = &report["camera"]["pinhole"];
    let number = |value: &Value| value.as_f64().expect("a number");
    let row = |matrix: &Value, at: usize| [0, 1, 2].map(|column| number(&matrix[at][column]));
    let k = [0, 1, 2].map(|at| row(&pinhole["K"], at));
    let r = [0, 1, 2].map(|at| row(&pinhole["R"], at));
    let t = [0, 1, 2].map(|at| number(&pinhole["t"][at]));
    let position = ["position.X", "position.Y", "position.Z"].map(|name| floats(&channels[name]));
    let normal = ["normal.X", "normal.Y", "normal.Z"].map(|name| floats(&channels[name]));
    let (depth, (_, codes)) = (floats(&channels["Z"]), codes(&folder.path("t-depth.png")));
    let FlatSamples::U32(objects) = &channels["object-id.id"] else {
        panic!("numbers of objects are integers");
    };
    let mut covered = 0;
    for at in 0..48 * 36 {
        assert_eq!(objects[at] == 0, depth[at] == 0.0);
        if objects[at] == 0 {
            assert_eq!(codes[at], 0);
            continue;
        }
        covered += 1;
        let p = [0, 1, 2].map(|axis| f64::from(position[axis][at]));
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let seen = [0, 1, 2].map(|axis| dot(r[axis], p) + t[axis]);
        assert!(
            (seen[2] - f64::from(depth[at])).abs() < 1e-4,
            "{seen:?} {}",
            depth[at]
        );
        let x = dot(k[0], seen) / seen[2] - (at % 48) as f64;
        let y = dot(k[1], seen) / seen[2] - (at / 48) as f64;
        // The nearest point of the triangle may be next to the centre.
        assert!(
            (x - 0.5).abs() < 0.01 && (y - 0.5).abs() < 0.01,
            "{at}: {x} {y}"
        );
        let length = [0, 1, 2]
            .map(|axis| f64::from(normal[axis][at]))
            .map(|n| n * n);
        assert!((length.iter().sum::<f64>() - 1.0).abs() < 1e-5);
        assert!((f64::from(codes[at]) * 2e-4 - f64::from(depth[at])).abs() < 1.1e-4);
    }
    assert!(covered > 300, "{covered}");
    // The background is linear.
    assert!(
        (floats(&channels["R"])[0] - 0.887_923_1).abs() < 1e-5,
        "{}",
        floats(&channels["R"])[0]
    );
}

#[test]
fn pictures_and_panoramas_are_open_exr_too() {
    let folder = Folder::new();
    let sky = folder.path("sky.exr");
    let run = estampe("render builtin:sphere --size 32x16 -q -o {}", &[&sky]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(channels(&sky).len(), 4);
    let lit = folder.path("lit.png");
    let words = "render builtin:sphere --size 16x16 -q --shading pbr --hdri {} -o {}";
    let run = estampe(words, &[&sky, &lit]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(Picture::open(&lit).color_count() > 4);
    let out = estampe(
        "render builtin:cube --size 8x8 -q -o - --output-format exr",
        &[],
    );
    assert!(
        out.out.starts_with(&[0x76, 0x2f, 0x31, 0x01]),
        "{}",
        out.err
    );
}

#[test]
fn passes_that_cannot_be_written_are_errors() {
    let folder = Folder::new();
    for (out, options, problem) in [
        ("a.png", "--pass depth", "written as OpenEXR"),
        ("{pass}.jpg", "--pass depth", "written as OpenEXR"),
        ("{pass}.png", "--pass position", "cannot hold positions"),
        (
            "{pass}.png",
            "--pass depth --depth-unit 0.000001",
            "larger --depth-unit",
        ),
        ("a.exr", "--pass depht", "invalid value"),
        ("a.exr", "--pass depth --depth-unit 0", "above 0"),
    ] {
        let words = format!("render builtin:cube --size 8x8 -o {{}} {options}");
        let run = estampe(&words, &[&folder.path(out)]);
        assert_ne!(run.code, 0, "{out} {options}");
        assert!(run.err.contains(problem), "{out} {options}: {}", run.err);
    }
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

/// Rows: X5.
#[test]
fn passes_do_not_depend_on_threads_or_simd_level() {
    let folder = Folder::new();
    let mut first = None;
    for how in machines() {
        let out = folder.path("t.exr");
        let words = format!(
            "render builtin:teapot --size 40x30 -q -o {{}} {how} --pass color,normal,depth,position"
        );
        let run = estampe(&words, &[&out]);
        assert_eq!(run.code, 0, "{how}: {}", run.err);
        let bytes = std::fs::read(&out).expect("written");
        let expected = first.get_or_insert_with(|| bytes.clone());
        assert!(*expected == bytes, "{how}");
    }
}
