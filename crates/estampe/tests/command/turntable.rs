//! Animations of models that turn.

use super::gltf::with_choices;
use crate::support::picture::Picture;
use crate::support::{Folder, estampe, machines};
use gif::{ColorOutput, DecodeOptions};
use serde_json::{Value, json};
use std::io::Cursor;
use std::path::Path;

/// The frames of a whole picture each.
fn numbered(folder: &Folder, count: u32) -> Vec<Picture> {
    { 0..count }
        .map(|frame| Picture::open(&folder.path(&format!("f{frame:04}.png"))))
        .collect()
}

/// The first frame of a GIF, and the delays of all.
fn read_gif(path: &Path) -> (Vec<u8>, Vec<u16>) {
    let bytes = std::fs::read(path).expect("written");
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes.as_slice()).expect("a GIF");
    let (mut first, mut delays) = (Vec::new(), Vec::new());
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        delays.push(frame.delay);
        if first.is_empty() {
            first = frame.buffer.to_vec();
        }
    }
    (first, delays)
}

/// The mean difference of codes.
fn mean_difference(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let sum: u64 = a
        .iter()
        .zip(b)
        .map(|(a, b)| u64::from(a.abs_diff(*b)))
        .sum();
    sum as f64 / a.len() as f64
}

#[test]
fn each_format_holds_the_frames() {
    let folder = Folder::new();
    let words = "turntable builtin:teapot --size 64x48 --frames 5 --fps 10 -o {} -q";
    let run = estampe(words, &[&folder.path("f{frame}.png")]);
    assert_eq!(run.code, 0, "{}", run.err);
    let frames = numbered(&folder, 5);
    for pair in frames.windows(2) {
        assert!(pair[0] != pair[1], "the model turns");
    }
    let texels: Vec<Vec<u8>> = frames.iter().map(Picture::rgba).collect();

    for name in ["t.gif", "t.apng", "t.png", "t.webp", "t.y4m"] {
        let run = estampe(words, &[&folder.path(name)]);
        assert_eq!(run.code, 0, "{name}: {}", run.err);
    }
    let (first, delays) = read_gif(&folder.path("t.gif"));
    assert_eq!(delays, [10; 5]);
    let difference = mean_difference(&first, &texels[0]);
    assert!(difference < 2.0, "{difference}");

    let png = std::fs::read(folder.path("t.png")).expect("written");
    assert!(std::fs::read(folder.path("t.apng")).ok() == Some(png.clone()));
    let mut reader = { png::Decoder::new(Cursor::new(png)) }
        .read_info()
        .expect("a PNG");
    let control = reader.info().animation_control.expect("animated");
    assert_eq!((control.num_frames, control.num_plays), (5, 0));
    let mut rgb = vec![0; 64 * 48 * 3];
    reader.next_frame(&mut rgb).expect("the first frame");
    let opaque = { texels[0].chunks_exact(4) }.flat_map(|texel| &texel[..3]);
    assert!(rgb.iter().eq(opaque), "lossless");

    let webp = std::fs::read(folder.path("t.webp")).expect("written");
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(webp)).expect("a WebP");
    assert_eq!((decoder.num_frames(), decoder.has_alpha()), (5, false));
    for texels in &texels {
        let mut rgb = vec![0; decoder.output_buffer_size().expect("small")];
        assert_eq!(decoder.read_frame(&mut rgb).expect("a frame"), 100);
        let opaque = texels.chunks_exact(4).flat_map(|texel| &texel[..3]);
        assert!(rgb.iter().eq(opaque), "lossless");
    }

    let video = std::fs::read(folder.path("t.y4m")).expect("written");
    let header = video.split(|&byte| byte == b'\n').next().expect("a line");
    let header = String::from_utf8_lossy(header);
    assert!(header.starts_with("YUV4MPEG2 W64 H48 F10:1"), "{header}");
    let frame_bytes = "FRAME\n".len() + 64 * 48 * 3 / 2;
    assert_eq!(video.len(), header.len() + 1 + 5 * frame_bytes);
}

/// The camera goes around at one distance, from which the whole model is seen in each frame.
#[test]
fn the_model_stays_in_the_picture() {
    let folder = Folder::new();
    for look in [
        "",
        "--ortho",
        "--elevation 60",
        "--elevation -90",
        "--fov 90",
    ] {
        let words = format!(
            "turntable builtin:teapot --size 60x40 --frames 8 -o {{}} -q --background none {look}"
        );
        let run = estampe(&words, &[&folder.path("f{frame}.png")]);
        assert_eq!(run.code, 0, "{look}: {}", run.err);
        let mut widest = 0;
        for (at, frame) in numbered(&folder, 8).iter().enumerate() {
            let [left, top, right, bottom] = frame.extent();
            let is_inside = left > 0 && top > 0 && right < 60 && bottom < 40;
            assert!(is_inside, "{look}, frame {at}: {:?}", frame.extent());
            widest = widest.max((right - left) * 40).max((bottom - top) * 60);
        }
        // The nearest distance: some frame nearly fills the picture.
        assert!(widest > 60 * 40 * 3 / 5, "{look}: {widest}");
    }
}

#[test]
fn the_first_frame_follows_the_last() {
    let folder = Folder::new();
    // A cube looks the same after a quarter of the turn, and the lights go with the camera.
    let words = "turntable builtin:cube --size 50x50 --frames 8 -o {} -q";
    let run = estampe(words, &[&folder.path("f{frame}.png")]);
    assert_eq!(run.code, 0, "{}", run.err);
    let frames = numbered(&folder, 8);
    for at in 0..8 {
        let (frame, quarter) = (frames[at].rgba(), frames[(at + 2) % 8].rgba());
        let difference = mean_difference(&frame, &quarter);
        assert!(difference < 0.5, "{at}: {difference}");
        let eighth = frames[(at + 1) % 8].rgba();
        assert!(mean_difference(&frame, &eighth) > 1.0, "{at}");
    }
}

/// Rows: X5.
#[test]
fn animations_do_not_depend_on_threads_or_simd_level() {
    let folder = Folder::new();
    for name in ["t.gif", "t.webp"] {
        let mut first = None;
        for how in machines() {
            let words = format!("turntable builtin:torus --size 40x30 --frames 4 -o {{}} -q {how}");
            let run = estampe(&words, &[&folder.path(name)]);
            assert_eq!(run.code, 0, "{how}: {}", run.err);
            let bytes = std::fs::read(folder.path(name)).expect("written");
            let expected = first.get_or_insert_with(|| bytes.clone());
            assert!(*expected == bytes, "{name}, {how}");
        }
    }
}

#[test]
fn animations_of_the_model_play_during_the_turn() {
    let folder = Folder::new();
    let model = {
        let two_sided = "\"doubleSided\":true,\"pbrMetallicRoughness\"";
        let text = with_choices().replace("\"pbrMetallicRoughness\"", two_sided);
        folder.with_file("m.gltf", text)
    };
    let words = "turntable {} --size 40x40 --frames 4 -o {} -q --background none";
    let run = estampe(words, &[&model, &folder.path("s.gif")]);
    assert_eq!(run.code, 0, "{}", run.err);
    for out in ["f{frame}.png", "t.gif"] {
        let run = estampe(&format!("{words} --animate"), &[&model, &folder.path(out)]);
        assert_eq!(run.code, 0, "{}", run.err);
    }
    // It slides by 4 along x, and stays in the picture.
    let frames = numbered(&folder, 4);
    // In the other frames it is seen from its edge.
    for (at, frame) in frames.iter().enumerate().step_by(2) {
        let [left, top, right, bottom] = frame.extent();
        let is_inside = left > 0 && top > 0 && right < 40 && bottom < 40;
        assert!(is_inside && left < right, "{at}: {:?}", frame.extent());
    }
    let [at_rest, animated] = ["s.gif", "t.gif"].map(|name| std::fs::read(folder.path(name)));
    assert!(at_rest.expect("written") != animated.expect("written"));
}

#[test]
fn the_report_says_what_was_written() {
    let folder = Folder::new();
    let out = folder.path("t.gif");
    let words = "turntable builtin:cube --size 20x10 --frames 3 --fps 12.5 -o {} --json";
    let run = estampe(words, &[&out]);
    assert_eq!(run.code, 0, "{}", run.err);
    let report: Value = serde_json::from_slice(&run.out).expect("one object");
    assert_eq!(report["model"], "builtin:cube");
    let bytes = std::fs::metadata(&out).expect("written").len();
    assert_eq!(
        report["output"],
        json!({ "path": out, "format": "gif", "width": 20, "height": 10, "frames": 3,
            "frames_per_second": 12.5, "bytes": bytes })
    );
    let words = "turntable builtin:cube --size 16x16 --frames 2 -o - --output-format y4m";
    let run = estampe(words, &[]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.out.starts_with(b"YUV4MPEG2 "),
        "video on standard output"
    );
}

#[test]
fn wrong_options_are_errors_before_anything_is_written() {
    let folder = Folder::new();
    for (out, options, problem) in [
        ("t.gif", "--eye 1,2,3", "fix the camera"),
        ("t.gif", "--fps 51", "at most 50 frames in a second"),
        ("t.jpg", "", "JPEG and TGA hold one picture"),
        ("t{frame}.gif", "", "hold all frames in one file"),
        ("t", "", "does not show the format"),
        ("t.gif", "--frames 0", "1..=100000"),
        ("t.gif", "--animate", "the model has no animation"),
        ("t.gif", "--size 16384x16384", "more than the limit"),
    ] {
        let words = format!("turntable builtin:cube -o {{}} {options}");
        let run = estampe(&words, &[&folder.path(out)]);
        assert_ne!(run.code, 0, "{out} {options}");
        assert!(run.err.contains(problem), "{out} {options}: {}", run.err);
    }
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}
