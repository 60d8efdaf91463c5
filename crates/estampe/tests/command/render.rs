//! `estampe render` end to end: images, their bytes, and their destinations.

use crate::support::picture::Picture;
use crate::support::{Folder, TETRAHEDRON, estampe, estampe_fed};
use estampe::Level;
use std::collections::BTreeSet;

#[test]
fn a_model_becomes_a_picture() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    let run = estampe("render {} -o {}", &[&model, &folder.path("m.png")]);
    assert_eq!((run.code, run.out.len()), (0, 0), "{}", run.err);
    assert!(run.err.contains("1024x768, 4 triangles"), "{}", run.err);
    let picture = Picture::open(&folder.path("m.png"));
    assert_eq!((picture.width, picture.height), (1024, 768));
    assert_eq!(picture.pixel(0, 0), [0xf2, 0xf2, 0xf2, 255]);
    assert!(
        picture.color_count() > 3,
        "a background, a surface and anti-aliased edges"
    );
    assert_eq!(
        folder.names(),
        ["m.obj", "m.png"],
        "nothing half-written is left"
    );
}

#[test]
fn the_bytes_depend_on_neither_threads_nor_simd() {
    let mut expected: Option<Vec<u8>> = None;
    for level in Level::all_available() {
        for threads in [1, 2, 3, 7] {
            let words = format!(
                "render builtin:teapot -o - -q --size 160x120 --threads {threads} --simd {}",
                level.name()
            );
            let run = estampe(&words, &[]);
            assert_eq!(run.code, 0, "{}", run.err);
            match &expected {
                None => expected = Some(run.out),
                Some(expected) => assert!(run.out == *expected, "{words} gives other bytes"),
            }
        }
    }
}

/// Each option of light changes the picture, which has the same bytes at every SIMD level and for
/// any number of threads.
///
/// Rows: F3.
#[test]
fn options_of_light_change_the_picture_and_depend_on_neither_threads_nor_simd() {
    let lamp = "--light pos:-1,1.6,3:ff8000:2 --light 1,0.2,0.3 --ambient 0.1";
    let mut seen = Vec::new();
    for shading in ["flat", "gouraud", "phong", "toon"] {
        for words in [
            String::new(),
            lamp.to_owned(),
            format!("{lamp} --attenuation 4"),
            "--specular none".to_owned(),
            "--specular blinn:0.7 --shininess 20".to_owned(),
            "--levels 3".to_owned(),
            "--fog 2:9,203040".to_owned(),
            format!("{lamp} --attenuation 7 --specular phong:0.6 --levels 5 --fog 12 --ortho"),
        ] {
            let mut pictures = Vec::new();
            let levels = Level::all_available();
            let threads = [1, 3].into_iter().cycle();
            for (level, threads) in levels.iter().zip(threads) {
                let machine = format!("--threads {threads} --simd {}", level.name());
                let words = format!(
                    "render builtin:torus -o - -q --size 96x72 --shading {shading} {machine} {words}"
                );
                let run = estampe(&words, &[]);
                assert_eq!(run.code, 0, "{words}: {}", run.err);
                pictures.push(run.out);
            }
            let picture = pictures.remove(0);
            let context = format!("{shading} {words}");
            assert!(pictures.iter().all(|other| *other == picture), "{context}");
            let is_toon_without_highlights = shading == "toon" && words.starts_with("--specular");
            assert_eq!(
                seen.contains(&picture),
                is_toon_without_highlights,
                "{context}"
            );
            seen.push(picture);
        }
    }
}

/// Rows: F3.
#[test]
fn n_levels_are_at_most_n_values_of_each_channel() {
    for (levels, shading) in [(2, "gouraud"), (3, "flat"), (5, "phong")] {
        let words = format!(
            "render builtin:torus -o - -q --size 96x72 --samples 1 --background none --levels {levels} \
             --shading {shading} --light 1,1,1:ffc0a0:3 --light pos:-3,1,1:80a0ff:2"
        );
        let run = estampe(&words, &[]);
        assert_eq!(run.code, 0, "{words}: {}", run.err);
        let picture = Picture::read(&run.out);
        let pixels = (0..72).flat_map(|y| (0..96).map(move |x| (x, y)));
        let mut values = vec![BTreeSet::new(); 3];
        for pixel in pixels.map(|(x, y)| picture.pixel(x, y)) {
            for (channel, values) in values.iter_mut().enumerate() {
                if pixel[3] == 255 {
                    values.insert(pixel[channel]);
                }
            }
        }
        for values in values {
            assert!((2..=levels).contains(&values.len()), "{words}: {values:?}");
            assert!(values.contains(&0), "{words}: {values:?}");
        }
    }
}

#[test]
fn every_shading_has_its_own_look_at_every_level() {
    let mut seen = Vec::new();
    for style in [
        "flat",
        "gouraud",
        "phong",
        "toon",
        "toon-flat",
        "toon-gouraud",
        "unlit",
        "wireframe",
        "normals",
        "depth",
        "uv",
        "face-id",
        "barycentric",
        "overdraw",
    ] {
        let levels = [Level::all_available()[0], Level::best()];
        let pictures = levels.map(|level| {
            let name = level.name();
            let words = format!(
                "render builtin:torus -o - -q --size 96x96 --shading {style} --simd {name}"
            );
            let run = estampe(&words, &[]);
            assert_eq!(run.code, 0, "{style}: {}", run.err);
            run.out
        });
        assert!(
            pictures[0] == pictures[1],
            "{style} depends on the SIMD level"
        );
        let [left, top, right, bottom] = Picture::read(&pictures[0]).extent();
        assert!(
            right > left + 40 || bottom > top + 40,
            "{style} shows the model"
        );
        assert!(!seen.contains(&pictures[0]), "{style} looks like another");
        seen.push(pictures.into_iter().next().expect("two"));
    }
}

#[test]
fn the_model_fills_the_frame_less_its_margin() {
    for (words, margin) in [
        ("--view iso", 0.05),
        ("--view top --ortho", 0.05),
        ("--azimuth 200 --elevation -35 --margin 0.2", 0.2),
        ("--fov 90 --margin 0", 0.0),
        ("--view left --ortho --margin 0.3", 0.3),
    ] {
        for (width, height) in [(200, 150), (150, 300)] {
            let size = format!("--size {width}x{height}");
            let run = estampe(&format!("render builtin:torus -o - -q {size} {words}"), &[]);
            assert_eq!(run.code, 0, "{}", run.err);
            let [left, top, right, bottom] = Picture::read(&run.out).extent();
            let border = f64::from(width.min(height)) * margin;
            let free = [left, top, width as usize - right, height as usize - bottom];
            let context = format!("{words} {size}: {free:?}");
            assert!(
                free.iter().all(|&f| f as f64 >= border - 1.0),
                "outside: {context}"
            );
            let touching = free[0].max(free[2]).min(free[1].max(free[3]));
            assert!(touching as f64 <= border + 2.0, "not tight: {context}");
            assert!(free[0].abs_diff(free[2]) <= 2, "not centred: {context}");
            assert!(free[1].abs_diff(free[3]) <= 2, "not centred: {context}");
        }
    }
}

#[test]
fn tiny_huge_and_distant_models_look_alike() {
    let folder = Folder::new();
    let scaled = |scale: &str| {
        let text = TETRAHEDRON.replace("v 1 0 0", &format!("v {scale} 0 0"));
        let text = text.replace("v 0 1 0", &format!("v 0 {scale} 0"));
        text.replace("v 0 0 1", &format!("v 0 0 {scale}"))
    };
    let picture = |text: String| {
        let model = folder.with_file("m.obj", text);
        let run = estampe("render {} -o - -q --size 120x90 --shading flat", &[&model]);
        assert_eq!(run.code, 0, "{}", run.err);
        Picture::read(&run.out)
    };
    let normal = picture(scaled("1"));
    for scale in ["1e30", "1e-30", "3e38"] {
        let other = picture(scaled(scale));
        assert_eq!(other.extent(), normal.extent(), "{scale}");
        assert_eq!(other.pixel(60, 45), normal.pixel(60, 45), "{scale}");
    }
}

#[test]
fn standard_streams_carry_models_pictures_and_reports() {
    let words = "render - --format obj -o - --size 64x48 --json";
    let run = estampe_fed(words, &[], TETRAHEDRON.as_bytes());
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.starts_with(b"\x89PNG"));
    let report: serde_json::Value = serde_json::from_str(&run.err).expect("only the report");
    assert_eq!(report["counts"]["triangles"], 4);
    assert_eq!(report["output"]["path"], "standard output");
    for stage in [
        "read", "parse", "prepare", "geometry", "raster", "encode", "write", "total",
    ] {
        assert!(
            report["timings_ms"][stage]
                .as_f64()
                .is_some_and(|ms| ms >= 0.0),
            "{stage}"
        );
    }
    let run = estampe(
        "render builtin:cube -o - -q --output-format tga --size 8x8",
        &[],
    );
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(Picture::read(&run.out).width, 8);
}

#[test]
fn formats_follow_the_name_and_transparency_is_straight() {
    let folder = Folder::new();
    let words = "render builtin:sphere -o {} -q --size 64x64 --background none";
    for name in ["a.png", "a.tga", "a.jpg", "a.JPEG", "a.webp"] {
        let run = estampe(words, &[&folder.path(name)]);
        assert_eq!(run.code, 0, "{name}: {}", run.err);
    }
    let png = Picture::open(&folder.path("a.png"));
    assert_eq!(png.pixel(0, 0), [0, 0, 0, 0]);
    assert_eq!(png.pixel(32, 32)[3], 255);
    let edges: Vec<[u8; 4]> = (0..64).map(|x| png.pixel(x, 10)).collect();
    let soft: Vec<_> = edges.iter().filter(|p| (1..255).contains(&p[3])).collect();
    assert!(!soft.is_empty(), "edges are anti-aliased");
    assert!(
        soft.iter().all(|p| p[1] > 60),
        "their colour is the surface's, not darkened: {soft:?}"
    );
    let tga = Picture::open(&folder.path("a.tga"));
    assert_eq!(tga.pixel(32, 10), png.pixel(32, 10));
    let webp = Picture::open_webp(&folder.path("a.webp"));
    assert!(webp == png, "lossless, with straight alpha");
    let run = estampe(
        "render builtin:sphere -o - -q --size 64x64 --background none --output-format webp",
        &[],
    );
    assert!(std::fs::read(folder.path("a.webp")).ok() == Some(run.out));
    let jpeg = Picture::open(&folder.path("a.jpg"));
    let corner = jpeg.pixel(1, 1);
    assert!(
        corner[0].abs_diff(0xf2) <= 2,
        "the default background lies under transparency: {corner:?}"
    );
}

#[test]
fn options_have_their_documented_effect() {
    let picture = |words: &str| {
        let run = estampe(
            &format!("render builtin:cube -o - -q --size 80x60 {words}"),
            &[],
        );
        assert_eq!(run.code, 0, "{words}: {}", run.err);
        Picture::read(&run.out)
    };
    assert_eq!(
        picture("--background 102030").pixel(0, 0),
        [0x10, 0x20, 0x30, 255]
    );
    let bare = picture("--samples 1 --shading unlit --view front");
    assert_eq!(bare.color_count(), 2, "no anti-aliasing, one colour");
    // The front is lit by a light from +z, and only by ambient light from one at −z.
    let front = picture("--view front --light 0,0,1").pixel(40, 30);
    let behind = picture("--view front --light 0,0,-1").pixel(40, 30);
    assert!(front[0] > 150 && behind[0] < 110, "{front:?} {behind:?}");
    let dark = picture("--view front --light 0,0,-1 --ambient 0").pixel(40, 30);
    assert_eq!(dark, [0, 0, 0, 255]);
    // With front faces culled, the inside of the back is visible.
    let inside = picture("--view front --cull front --shading depth").pixel(40, 30);
    let outside = picture("--view front --cull back --shading depth").pixel(40, 30);
    assert!(outside[0] > inside[0], "{outside:?} {inside:?}");
    // From a distance of 50 the cube is a dot in the middle: 60 pixels show 2·50·tan 17.5° = 31.5.
    let [left, _, right, _] = picture("--eye 0,0,50 --target 0,0,0").extent();
    assert!(
        (3..=6).contains(&(right - left)) && left + right == 80,
        "{left} to {right}"
    );
}

#[test]
fn up_turns_the_model_as_documented() {
    let folder = Folder::new();
    // A rod along z.
    let model = folder.with_file(
        "rod.obj",
        "v -1 -1 -9\nv 1 -1 -9\nv 1 1 -9\nv -1 1 -9\nv -1 -1 9\nv 1 -1 9\nv 1 1 9\nv -1 1 9\n\
         f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 1 4 3 2\nf 5 6 7 8\n",
    );
    let is_upright = |words: &str| {
        let run = estampe(
            &format!("render {{}} -o - -q --size 90x90 --ortho {words}"),
            &[&model],
        );
        assert_eq!(run.code, 0, "{}", run.err);
        let [left, top, right, bottom] = Picture::read(&run.out).extent();
        bottom - top > 3 * (right - left)
    };
    assert!(!is_upright("--view right --up auto"), "OBJ is Y-up");
    assert!(is_upright("--view right --up z"));
    assert!(is_upright("--view right --up 0,0,1"));
    assert!(is_upright("--view top --up y"));
    assert!(is_upright("--eye 9,0,0 --up 0,0,1"));
}

#[test]
fn links_are_followed_and_devices_written_in_place() {
    let folder = Folder::new();
    let words = "render builtin:plane -o {} -q --size 16x16 --output-format png";
    #[cfg(unix)]
    {
        let real = folder.with_file("real.png", b"old");
        std::os::unix::fs::symlink(&real, folder.path("link.png")).expect("links are possible");
        assert_eq!(estampe(words, &[&folder.path("link.png")]).code, 0);
        assert!(folder.path("link.png").is_symlink());
        assert_eq!(Picture::open(&real).width, 16);
        let null = std::path::Path::new("/dev/null");
        assert_eq!(estampe(words, &[null]).code, 0);
        assert!(!null.is_file(), "/dev/null is still a device");
    }
    assert_eq!(estampe(words, &[&folder.path("new")]).code, 0);
    assert!(folder.names().iter().all(|name| !name.contains("part")));
}
