use super::*;
use crate::{AssetError, Limits};
use exr::prelude::{ReadChannels, ReadLayers};
use fastrand::Rng;
use std::io::Cursor;

fn colors(random: &mut Rng, pixels: usize) -> Vec<ExrChannel> {
    let channel = |name: &str, samples: Vec<f32>| ExrChannel {
        name: name.to_owned(),
        samples: ExrSamples::Float(samples),
    };
    ["R", "G", "B", "A"]
        .map(|name| channel(name, (0..pixels).map(|_| random.f32() * 100.0).collect()))
        .into()
}

/// Rows: I4.
#[test]
fn channels_read_back_bit_by_bit() {
    let mut random = Rng::with_seed(1);
    let size = (19, 37);
    let pixels = 19 * 37;
    let float = (0..pixels)
        .map(|_| f32::from_bits(random.u32(..0x7f80_0000)))
        .collect();
    let mut channels = colors(&mut random, pixels);
    channels.push(ExrChannel {
        name: "normal.X".to_owned(),
        samples: ExrSamples::Float(float),
    });
    channels.push(ExrChannel {
        name: "object-id.id".to_owned(),
        samples: ExrSamples::Uint((0..pixels).map(|_| random.u32(..)).collect()),
    });
    let bytes = encode_exr(size, channels.clone()).expect("valid");
    assert!(is_exr(&bytes));
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(&bytes))
        .expect("a file");
    let read = image.layer_data.channel_data.list;
    assert_eq!(read.len(), channels.len());
    for channel in channels {
        let found = { read.iter() }.find(|found| found.name.eq(channel.name.as_str()));
        let found = &found.expect("the channel").sample_data;
        match channel.samples {
            ExrSamples::Float(samples) => {
                let found: Vec<f32> = found.values_as_f32().collect();
                assert_eq!(found, samples);
            }
            ExrSamples::Uint(samples) => {
                assert_eq!(*found, exr::prelude::FlatSamples::U32(samples));
            }
        }
    }
}

/// Rows: I4.
#[test]
fn colors_are_read_and_what_is_no_light_is_dark() {
    let samples = |values: [f32; 4]| ExrSamples::Float(values.to_vec());
    let channel = |name: &str, values| ExrChannel {
        name: name.to_owned(),
        samples: samples(values),
    };
    let channels = vec![
        channel("G", [0.5, 2.0, f32::INFINITY, -1.0]),
        channel("R", [1.0, 1e4, 3.0, f32::NAN]),
        channel("B", [0.0, 0.25, 1e9, 7.0]),
        channel("normal.Z", [9.0; 4]),
    ];
    let bytes = encode_exr((2, 2), channels).expect("valid");
    let image = decode_exr(&bytes, &Limits::default()).expect("colours");
    assert_eq!((image.width, image.height), (2, 2));
    let expected = [
        [1.0, 0.5, 0.0],
        [1e4, 2.0, 0.25],
        [3.0, 65_504.0, 65_504.0],
        [0.0, 0.0, 7.0],
    ];
    assert_eq!(image.rgb, expected.as_flattened());
}

#[test]
fn wrong_channels_are_errors() {
    let channel = |name: &str, count: usize| ExrChannel {
        name: name.to_owned(),
        samples: ExrSamples::Uint(vec![0; count]),
    };
    for (size, channels) in [
        ((0, 2), vec![channel("a", 0)]),
        ((2, 2), vec![]),
        ((2, 2), vec![channel("a", 3)]),
        ((2, 2), vec![channel("a", 4), channel("a", 4)]),
        ((2, 2), vec![channel("", 4)]),
    ] {
        let result = encode_exr(size, channels);
        assert!(
            matches!(result, Err(AssetError::Malformed { .. })),
            "{result:?}"
        );
    }
    let bytes = encode_exr((2, 2), vec![channel("Y", 4)]).expect("valid");
    let error = decode_exr(&bytes, &Limits::default()).expect_err("no colours");
    assert!(
        error
            .to_string()
            .contains("without the channels R, G and B"),
        "{error}"
    );
}

/// Every prefix and random mutations end with an image or an error, and within the limits.
#[test]
fn broken_files_are_errors() {
    let mut random = Rng::with_seed(2);
    let bytes = encode_exr((13, 21), colors(&mut random, 13 * 21)).expect("valid");
    let limits = Limits {
        max_image_pixels: 1000,
        ..Limits::default()
    };
    for end in 0..bytes.len() {
        assert!(decode_exr(&bytes[..end], &limits).is_err(), "{end}");
    }
    let (mut images, mut errors) = (0, 0);
    // Most of the header's bytes are in the first 400.
    for turn in 0..6000 {
        let mut broken = bytes.clone();
        let end = if turn % 4 == 0 { broken.len() } else { 400 };
        for _ in 0..random.usize(1..4) {
            let at = random.usize(..end);
            broken[at] = random.u8(..);
        }
        match decode_exr(&broken, &limits) {
            Ok(image) => {
                assert!(u64::from(image.width) * u64::from(image.height) <= 1000);
                images += 1;
            }
            Err(_) => errors += 1,
        }
    }
    assert!(images > 100 && errors > 1000, "{images} {errors}");
    let small = Limits {
        max_image_pixels: 13 * 21 - 1,
        ..Limits::default()
    };
    let error = decode_exr(&bytes, &small).expect_err("too large");
    assert!(matches!(error, AssetError::LimitExceeded { .. }), "{error}");
}
