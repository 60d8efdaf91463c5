//! Pictures of light: OpenEXR and Radiance HDR of `estampe render` and `estampe batch`.

use super::passes::{channels, floats};
use crate::support::picture::Picture;
use crate::support::{Folder, estampe, machines};
use estampe_assets::Limits;
use estampe_assets::image::decode_hdr;
use estampe_scene::HdrImage;
use std::path::Path;

/// A triangle that emits 40 times (1, 0.5, 0.25), and one of half transparent glass before a part
/// of it.
const LAMP: &str = r#"{"asset":{"version":"2.0"},
"extensionsUsed":["KHR_materials_emissive_strength","KHR_materials_unlit"],"scene":0,
"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"mesh":1,"translation":[0,0,0.25],"scale":[0.4,0.4,1]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]},
{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":1}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0,0,0,1],"metallicFactor":1},
"emissiveFactor":[1,0.5,0.25],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":40}}},
{"pbrMetallicRoughness":{"baseColorFactor":[0,1,0,0.5]},"alphaMode":"BLEND","extensions":{"KHR_materials_unlit":{}}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],
"buffers":[{"byteLength":39,
"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAEC"}]}"#;

const LOOK: &str = "-q --size 40x40 --view front --ortho";

fn draw(words: &str, paths: &[&Path]) {
    let run = estampe(&format!("{words} {LOOK}"), paths);
    assert_eq!(run.code, 0, "{words}: {}", run.err);
}

fn hdr(path: &Path) -> HdrImage {
    let bytes = std::fs::read(path).expect("written");
    decode_hdr(&bytes, &Limits::default()).expect("a Radiance HDR")
}

/// The colours and alphas of an OpenEXR.
fn exr(path: &Path) -> Vec<[f32; 4]> {
    let channels = channels(path);
    let [r, g, b, a] = ["R", "G", "B", "A"].map(|name| floats(&channels[name]));
    (0..r.len())
        .map(|at| [r[at], g[at], b[at], a[at]])
        .collect()
}

fn assert_near(own: &[f32], right: &[f32], share: f32, what: &str) {
    for (own, right) in own.iter().zip(right) {
        assert!(
            (own - right).abs() <= right.abs() * share + 1e-3,
            "{what}: {own}, not {right}"
        );
    }
}

/// Rows: I4.
#[test]
fn what_is_brighter_than_white_stays() {
    let folder = Folder::new();
    let lamp = folder.with_file("lamp.gltf", LAMP);
    let [open, radiance, clear] = ["l.exr", "l.hdr", "c.hdr"].map(|name| folder.path(name));
    let words = "render {} -o {} --exposure -1 --background #808080";
    draw(words, &[&lamp, &open]);
    draw(words, &[&lamp, &radiance]);
    let (open, radiance) = (exr(&open), hdr(&radiance));
    assert_eq!((radiance.width, radiance.height), (40, 40));
    // The lamp above the glass, and through the glass, which adds linear green of ½.
    let (bare, covered, outside) = (14 * 40 + 8, 32 * 40 + 7, 38);
    assert_near(&open[bare], &[20.0, 10.0, 5.0, 1.0], 1e-4, "the lamp");
    assert_near(
        &open[covered],
        &[10.0, 5.5, 2.5, 1.0],
        1e-4,
        "the lamp behind glass",
    );
    let grey = 0.215_860_5;
    assert_near(
        &open[outside],
        &[grey, grey, grey, 1.0],
        1e-5,
        "the background",
    );
    // Mantissas of 8 bits, of the greatest channel.
    for (at, (read, light)) in radiance.rgb.chunks(3).zip(&open).enumerate() {
        let greatest = light[..3].iter().copied().fold(0.0, f32::max);
        for (read, light) in read.iter().zip(light) {
            assert!(
                (read - light).abs() <= greatest / 255.0,
                "{at}: {read} {light}"
            );
        }
    }
    // Without alpha nothing is the default background, as in JPEG.
    draw("render {} -o {} --background none", &[&lamp, &clear]);
    let clear = hdr(&clear).rgb[outside * 3..][..3].to_vec();
    assert_near(&clear, &[0.887_923_1; 3], 0.01, "no background");
}

#[test]
fn alpha_is_associated() {
    let folder = Folder::new();
    let lamp = folder.with_file("lamp.gltf", LAMP);
    let out = folder.path("l.exr");
    draw("render {} -o {} --background none", &[&lamp, &out]);
    let pixels = exr(&out);
    assert_eq!(pixels[38], [0.0; 4]);
    let border = { pixels.iter() }.filter(|pixel| pixel[3] > 0.0 && pixel[3] < 1.0);
    let mut count = 0;
    for pixel in border {
        let lit = [40.0, 20.0, 10.0].map(|light| light * pixel[3]);
        if pixel[1] * 2.0 <= pixel[0] + 1e-3 {
            assert_near(&pixel[..3], &lit, 1e-3, "a border of the lamp");
            count += 1;
        }
    }
    assert!(count > 10, "{count}");
}

/// Rows: I4.
#[test]
fn codes_of_the_light_are_the_picture() {
    let folder = Folder::new();
    let (light, png) = (folder.path("l.exr"), folder.path("p.png"));
    for look in [
        "--shading pbr --tone-map none --roughness 0.2",
        "--shading phong",
        "--shading toon --background navy",
        "--shading unlit --color #ff880080 --background none",
        "--shading wireframe --samples 1",
        "--background linear:gold,teal",
    ] {
        for out in [&light, &png] {
            draw(&format!("render builtin:torus -o {{}} {look}"), &[out]);
        }
        let picture = Picture::open(&png);
        for (at, light) in exr(&light).into_iter().enumerate() {
            let [.., alpha] = picture.pixel(at % 40, at / 40);
            assert!(
                (f32::from(alpha) - light[3] * 255.0).abs() <= 1.0,
                "{look}: {at}"
            );
            if alpha == 255 {
                let codes = [0, 1, 2].map(|k| estampe::srgb::encode(light[k]));
                let own = picture.pixel(at % 40, at / 40);
                // Blended edges are rounded twice.
                let most = if look.contains("wireframe") { 2 } else { 1 };
                for (own, right) in own.into_iter().zip(codes) {
                    assert!(own.abs_diff(right) <= most, "{look}: {at}: {own} {right}");
                }
            }
        }
    }
}

/// Rows: X5.
#[test]
fn light_does_not_depend_on_threads_or_simd_level() {
    let folder = Folder::new();
    let lamp = folder.with_file("lamp.gltf", LAMP);
    for method in ["sorted", "exact", "weighted"] {
        for name in ["l.exr", "l.hdr"] {
            let mut first = None;
            for how in machines() {
                let out = folder.path(name);
                let words = format!("render {{}} -o {{}} {how} --transparency {method}");
                draw(&words, &[&lamp, &out]);
                let bytes = std::fs::read(&out).expect("written");
                let expected = first.get_or_insert_with(|| bytes.clone());
                assert!(*expected == bytes, "{name}, {method}, {how}");
            }
        }
    }
}

#[test]
fn passes_and_batches_have_the_same_light() {
    let folder = Folder::new();
    let lamp = folder.with_file("lamp.gltf", LAMP);
    let (alone, together) = (folder.path("alone.exr"), folder.path("together.exr"));
    draw("render {} -o {}", &[&lamp, &alone]);
    draw(
        "render {} -o {} --pass color,depth,albedo",
        &[&lamp, &together],
    );
    assert!(exr(&alone) == exr(&together));
    let albedo = floats(&channels(&together)["albedo.R"]);
    assert!(
        albedo[14 * 40 + 8] > 30.0,
        "emitted light is added to the albedo"
    );

    let single = folder.path("single.hdr");
    draw("render {} -o {}", &[&lamp, &single]);
    draw("batch {} -o {}", &[&lamp, &folder.path("{stem}-many.hdr")]);
    let bytes = |name: &str| std::fs::read(folder.path(name)).expect("written");
    assert!(bytes("lamp-many.hdr") == bytes("single.hdr"));
    draw(
        "render {} -o {} --pass color,albedo",
        &[&lamp, &folder.path("p-{pass}.hdr")],
    );
    assert!(bytes("p-color.hdr") == bytes("single.hdr"));
    assert!(
        bytes("p-albedo.hdr") == bytes("single.hdr"),
        "emitted light and unlit glass"
    );
    let run = estampe(
        &format!("render {{}} -o - --output-format hdr {LOOK}"),
        &[&lamp],
    );
    assert!(run.out == bytes("single.hdr"), "{}", run.err);
    // Light of one picture lights another.
    draw(
        "render builtin:sphere -o {} --shading pbr --hdri {}",
        &[&folder.path("lit.png"), &single],
    );
}

#[test]
fn what_cannot_be_light_is_an_error() {
    let folder = Folder::new();
    for (out, options, problem) in [
        ("a.hdr", "--pass depth", "holds one picture"),
        ("a.hdr", "--pass color,albedo", "holds one picture"),
        ("{pass}.hdr", "--pass color,normal", "holds one picture"),
        ("a.hdr", "--preview=blocks", "8 bits a channel"),
        ("a.hdr", "--size 0x4", "1 to 16384"),
        ("a.exr", "--size 20000x4", "1 to 16384"),
        // A picture of codes has room in this limit.
        (
            "a.exr",
            "--size 100x100 --max-memory 700000",
            "--max-memory",
        ),
        (
            "a.hdr",
            "--size 100x100 --max-memory 700000",
            "--max-memory",
        ),
    ] {
        let run = estampe(
            &format!("render builtin:cube -o {{}} {options}"),
            &[&folder.path(out)],
        );
        assert_ne!(run.code, 0, "{out} {options}");
        assert!(run.err.contains(problem), "{out} {options}: {}", run.err);
    }
    assert!(folder.names().is_empty(), "{:?}", folder.names());
    let fits = "render builtin:cube -q -o {} --size 100x100 --max-memory 700000";
    assert_eq!(estampe(fits, &[&folder.path("a.png")]).code, 0);
}
