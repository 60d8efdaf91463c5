//! Rows of each form, and broken ones.

use super::{decode_hdr, encode_hdr, is_hdr};
use crate::{AssetError, Limits};
use estampe_scene::HdrImage;

fn file(size: &str, rows: &[u8]) -> Vec<u8> {
    let header = format!("#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n\n{size}\n");
    [header.as_bytes(), rows].concat()
}

fn decoded(bytes: &[u8]) -> Result<HdrImage, AssetError> {
    decode_hdr(bytes, &Limits::default())
}

/// 2⁰ is the exponent code 129 with mantissa 128.
const ONE: [u8; 4] = [128, 64, 0, 129];

#[test]
fn texels_have_their_exponent_in_common() {
    let image = decoded(&file(
        "-Y 1 +X 3",
        &[&ONE[..], &[255, 1, 0, 136], &[9, 9, 9, 0]].concat(),
    ));
    let image = image.expect("three texels");
    assert_eq!((image.width, image.height), (3, 1));
    assert_eq!(image.rgb, [1.0, 0.5, 0.0, 255.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
}

/// Rows: I4.
#[test]
fn rows_in_runs_are_read_component_by_component() {
    let rows = [
        &[2, 2, 0, 9][..],
        // Red: nine times 128. Green: 4 values, then a run of 5.
        &[137, 128],
        &[4, 64, 32, 16, 8, 133, 4],
        // Blue and exponents.
        &[137, 0],
        &[137, 129],
    ];
    let image = decoded(&file("-Y 1 +X 9", &rows.concat())).expect("a row in runs");
    let green: Vec<f32> = image.rgb.chunks(3).map(|texel| texel[1]).collect();
    let expected = [64, 32, 16, 8, 4, 4, 4, 4, 4].map(|code: u8| f32::from(code) / 128.0);
    assert_eq!(green, expected);
    assert!(
        image
            .rgb
            .chunks(3)
            .all(|texel| texel[0] == 1.0 && texel[2] == 0.0)
    );
}

#[test]
fn old_runs_repeat_the_texel_before() {
    let rows = [&ONE[..], &[1, 1, 1, 3], &[0, 0, 0, 0]].concat();
    let image = decoded(&file("-Y 1 +X 5", &rows)).expect("a repeated texel");
    let red: Vec<f32> = image.rgb.chunks(3).map(|texel| texel[0]).collect();
    assert_eq!(red, [1.0, 1.0, 1.0, 1.0, 0.0]);
    // 2 + 1·256 times.
    let rows = [&ONE[..], &[1, 1, 1, 2], &[1, 1, 1, 1]].concat();
    let image = decoded(&file("-Y 1 +X 259", &rows)).expect("two counts");
    assert!(image.rgb.chunks(3).all(|texel| texel[0] == 1.0));
}

#[test]
fn orientation_and_exposure_are_those_of_the_header() {
    let rows = [ONE, [0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]].concat();
    let place = |size| {
        let image = decoded(&file(size, &rows)).expect("four texels");
        image.rgb.chunks(3).position(|texel| texel[0] == 1.0)
    };
    assert_eq!(place("-Y 2 +X 2"), Some(0));
    assert_eq!(place("+Y 2 +X 2"), Some(2));
    assert_eq!(place("-Y 2 -X 2"), Some(1));
    let text = "#?RGBE\r\nEXPOSURE=2\r\nEXPOSURE= 4\r\n\r\n-Y 1 +X 1\r\n";
    let exposed = decoded(&[text.as_bytes(), &ONE].concat()).expect("a texel");
    assert_eq!(exposed.rgb, [0.125, 0.0625, 0.0]);
}

/// Rows: I4.
#[test]
fn what_is_written_is_read_again() {
    let mut rgb = vec![
        0.0, 1.0, 0.5, 1000.0, 3.0, 0.25, 1e-30, 0.0, 1e30, 1.0, 1.0, 1.0,
    ];
    rgb.extend([f32::NAN, -1.0, 0.999_99, f32::INFINITY, f32::MAX, 0.0]);
    let image = HdrImage {
        width: 3,
        height: 2,
        rgb,
    };
    let bytes = encode_hdr(&image).expect("six texels");
    assert!(is_hdr(&bytes));
    let read = decoded(&bytes).expect("written here");
    for (written, read) in image.rgb.chunks(3).zip(read.rgb.chunks(3)) {
        // The greatest number is 255 · 2¹¹⁹.
        let most = 255.0 * libm::exp2f(119.0);
        let written = [0, 1, 2].map(|k| written[k].clamp(0.0, most).max(0.0));
        let greatest = written.into_iter().fold(0.0, f32::max);
        for (written, read) in written.into_iter().zip(read) {
            assert!(
                (written - read).abs() <= greatest / 128.0,
                "{written} {read}"
            );
        }
    }
    let empty = HdrImage {
        width: 0,
        height: 2,
        rgb: Vec::new(),
    };
    assert!(encode_hdr(&empty).is_err());
}

/// Rows of all lengths and patterns come back, and even ones are small.
///
/// Rows: I4.
#[test]
fn rows_are_written_in_runs() {
    let mut random = fastrand::Rng::with_seed(11);
    for width in [1, 7, 8, 9, 127, 128, 129, 255, 300, 0x7fff, 0x8000] {
        let mut rgb = Vec::new();
        // Runs of any length of colours that come back exactly.
        while rgb.len() < width * 6 {
            let color = [0; 3].map(|_| f32::from(random.u8(..)) / 16.0);
            let count = random.usize(1..200).min(width * 2 - rgb.len() / 3);
            let greatest = color.into_iter().fold(0.0, f32::max);
            let color = if greatest >= 8.0 {
                color
            } else {
                [8.0, 4.0, 0.5]
            };
            rgb.extend(color.repeat(if random.bool() { count } else { 1 }));
        }
        let image = HdrImage {
            width: u32::try_from(width).expect("small"),
            height: 2,
            rgb,
        };
        let bytes = encode_hdr(&image).expect("two rows");
        let read = decoded(&bytes).expect("written here");
        assert!(read == image, "{width}");
    }
    let even = HdrImage {
        width: 1000,
        height: 10,
        rgb: vec![2.5; 30_000],
    };
    let bytes = encode_hdr(&even).expect("ten rows");
    // Four components of eight runs, two bytes each, and the beginning of the row.
    assert!(bytes.len() < 10 * 68 + 100, "{}", bytes.len());
    assert!(decoded(&bytes).expect("written here") == even);
}

#[test]
fn errors_say_what_is_wrong_and_where() {
    let error = |bytes: &[u8]| decoded(bytes).expect_err("broken").to_string();
    assert!(error(b"P6\n").contains("begins with #?"));
    assert!(error(b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n").contains("XYZ"));
    assert!(error(b"#?RADIANCE\nEXPOSURE=0\n\n").contains("EXPOSURE is no number"));
    assert!(error(&file("+X 4 -Y 4", &[])).contains("turned by +X -Y"));
    assert!(error(&file("-Y 0 +X 4", &[])).contains("is no size"));
    assert!(error(&file("-Y 2 +X 2", &ONE)).contains("ends"));
    assert!(error(&file("-Y 1 +X 9", &[2, 2, 0, 8, 0, 0])).contains("has not 9 texels"));
    assert!(error(&file("-Y 1 +X 9", &[2, 2, 0, 9, 140, 1])).contains("does not fit its row"));
    assert!(error(&file("-Y 1 +X 2", &[1, 1, 1, 2])).contains("does not fit its row"));
    let huge = decoded(&file("-Y 4000000000 +X 4000000000", &[0; 64]));
    assert!(matches!(huge, Err(AssetError::LimitExceeded(_))));
    // A small file cannot ask for the memory of a large one.
    assert!(error(&file("-Y 16000 +X 16000", &[0; 64])).contains("ends before its rows"));
}

#[test]
fn prefixes_and_mutations_are_errors_or_images() {
    let runs = [
        &[2, 2, 0, 9][..],
        &[137, 128],
        &[4, 64, 32, 16, 8, 133, 4],
        &[137, 0],
        &[137, 129],
    ];
    let old = [&ONE[..], &[1, 1, 1, 8]];
    let good = [
        file("-Y 1 +X 9", &runs.concat()),
        file("-Y 1 +X 9", &old.concat()),
    ];
    let mut random = fastrand::Rng::with_seed(7);
    let mut images = 0;
    for bytes in &good {
        for length in 0..bytes.len() {
            assert!(decoded(&bytes[..length]).is_err(), "{length} bytes");
        }
        for _ in 0..5000 {
            let mut changed = bytes.clone();
            for _ in 0..random.usize(1..4) {
                let at = random.usize(..changed.len());
                changed[at] = random.u8(..);
            }
            if let Ok(image) = decoded(&changed) {
                assert!(
                    image
                        .rgb
                        .iter()
                        .all(|number| number.is_finite() && *number >= 0.0)
                );
                images += 1;
            }
        }
    }
    assert!(images > 1000, "{images}");
}
