//! Each type, depth and origin, from fixtures whose colours are written out.

use super::{Fixture, TOP_LEFT};
use crate::image::tga::decode;
use crate::{AssetError, Limits};

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];
const WHITE: [u8; 4] = [255; 4];

#[track_caller]
fn check(fixture: &Fixture, expected: &[[u8; 4]]) {
    let image = decode(&fixture.bytes(), &Limits::default()).expect("a valid file");
    assert_eq!(
        (image.width, image.height),
        (fixture.width.into(), fixture.height.into())
    );
    assert_eq!(image.rgba.as_chunks::<4>().0, expected, "{fixture:?}");
}

#[track_caller]
fn refusal(fixture: &Fixture) -> AssetError {
    decode(&fixture.bytes(), &Limits::default()).expect_err("a wrong file")
}

/// Rows: I1.
#[test]
fn true_colour_of_24_bits_is_stored_blue_first() {
    let texels = [0, 0, 255, 0, 255, 0, 255, 0, 0, 30, 20, 10];
    check(
        &Fixture::new(2, 24, (2, 2), &texels),
        &[RED, GREEN, BLUE, [10, 20, 30, 255]],
    );
}

/// Rows: I1.
#[test]
fn five_bit_channels_are_spread_over_the_whole_range() {
    // ARRRRRGG GGGBBBBB, little-endian: red, green, blue, and (3, 27, 14) with the top bit set.
    let texels = [0x00, 0x7c, 0xe0, 0x03, 0x1f, 0x00, 0x6e, 0x8f];
    let expected = [RED, GREEN, BLUE, [25, 222, 115, 255]];
    for depth in [15, 16] {
        check(&Fixture::new(2, depth, (4, 1), &texels), &expected);
    }
}

#[test]
fn the_top_bit_of_16_is_alpha_only_where_the_extension_area_says_so() {
    let mut fixture = Fixture::new(2, 16, (2, 1), &[0xff, 0xff, 0xff, 0x7f]);
    fixture.descriptor |= 1;
    check(&fixture, &[WHITE, WHITE]);
    fixture.attributes = Some(3);
    check(&fixture, &[WHITE, [255, 255, 255, 0]]);
    fixture.attributes = Some(0);
    check(&fixture, &[WHITE, WHITE]);
}

/// Rows: I1.
#[test]
fn alpha_of_32_bits_follows_the_attributes_type() {
    let mut fixture = Fixture::new(2, 32, (2, 1), &[1, 2, 3, 0, 40, 60, 80, 128]);
    let opaque = [[3, 2, 1, 255], [80, 60, 40, 255]];
    let straight = [[3, 2, 1, 0], [80, 60, 40, 128]];
    check(&fixture, &opaque);
    fixture.descriptor |= 8;
    check(&fixture, &straight);
    for (attributes, expected) in [
        (0, opaque),
        (1, opaque),
        (2, opaque),
        (3, straight),
        // Premultiplied: 80 · 255 / 128 = 159.4, 60 → 119.5, 40 → 79.7; without alpha, black.
        (4, [[0, 0, 0, 0], [159, 120, 80, 128]]),
        (200, straight),
    ] {
        fixture.attributes = Some(attributes);
        check(&fixture, &expected);
    }
}

/// Rows: I1.
#[test]
fn grey_may_carry_alpha() {
    check(
        &Fixture::new(3, 8, (2, 1), &[0, 77]),
        &[[0, 0, 0, 255], [77, 77, 77, 255]],
    );
    let mut fixture = Fixture::new(3, 16, (2, 1), &[0, 255, 77, 5]);
    check(&fixture, &[[0, 0, 0, 255], [77, 77, 77, 255]]);
    fixture.descriptor |= 8;
    check(&fixture, &[[0, 0, 0, 255], [77, 77, 77, 5]]);
}

/// Rows: I1.
#[test]
fn colour_maps_have_entries_of_four_widths() {
    for (bits, map_bytes, colors) in [
        (15, &[0x00, 0x7c, 0x1f, 0x80][..], [RED, BLUE]),
        (16, &[0x00, 0x7c, 0x1f, 0x80], [RED, BLUE]),
        (24, &[0, 255, 0, 255, 255, 255], [GREEN, WHITE]),
        (32, &[0, 255, 0, 9, 0, 0, 255, 255], [GREEN, RED]),
    ] {
        let mut fixture = Fixture::new(1, 8, (3, 1), &[1, 0, 1]);
        fixture.map = Some((0, 2, bits));
        fixture.map_bytes = map_bytes.to_vec();
        check(&fixture, &[colors[1], colors[0], colors[1]]);
    }
}

#[test]
fn map_entries_of_32_bits_have_alpha_when_the_descriptor_says_so() {
    let mut fixture = Fixture::new(1, 8, (1, 1), &[0]);
    fixture.map = Some((0, 1, 32));
    fixture.map_bytes = vec![3, 2, 1, 77];
    fixture.descriptor |= 8;
    check(&fixture, &[[1, 2, 3, 77]]);
}

/// Rows: I1.
#[test]
fn the_first_entry_shifts_the_indices() {
    let mut fixture = Fixture::new(1, 8, (3, 1), &[200, 202, 201]);
    fixture.map = Some((200, 3, 24));
    fixture.map_bytes = vec![0, 0, 255, 0, 255, 0, 255, 0, 0];
    check(&fixture, &[RED, BLUE, GREEN]);

    // Indices of 16 bits reach further maps.
    fixture.depth = 16;
    fixture.map = Some((1000, 3, 24));
    fixture.texels = vec![0xe9, 3, 0xe8, 3, 0xea, 3];
    check(&fixture, &[GREEN, RED, BLUE]);
}

#[test]
fn colours_that_the_map_lacks_are_located() {
    for (texels, index, byte) in [([200, 199], 199, 28), ([203, 200], 203, 27)] {
        let mut fixture = Fixture::new(1, 8, (2, 1), &texels);
        fixture.map = Some((200, 3, 24));
        fixture.map_bytes = vec![0; 9];
        let message = refusal(&fixture).to_string();
        assert!(
            message.contains(&format!("byte {byte}: colour {index} of")),
            "{message}"
        );
    }
}

#[test]
fn the_image_id_and_an_unused_map_are_skipped() {
    let mut fixture = Fixture::new(2, 24, (1, 1), &[0, 255, 0]);
    fixture.id = vec![0xaa; 255];
    check(&fixture, &[GREEN]);
    fixture.map = Some((7, 3, 16));
    fixture.map_bytes = vec![0xbb; 6];
    check(&fixture, &[GREEN]);
}

/// Rows: I1.
#[test]
fn four_origins() {
    let texels = [1, 2, 3, 4, 5, 6];
    for (origin, expected) in [
        (0x20, [1, 2, 3, 4, 5, 6]), // top left
        (0x30, [3, 2, 1, 6, 5, 4]), // top right
        (0x00, [4, 5, 6, 1, 2, 3]), // bottom left
        (0x10, [6, 5, 4, 3, 2, 1]), // bottom right
    ] {
        let packets: Vec<u8> = [5].into_iter().chain(texels).collect();
        for (kind, bytes) in [(3, texels.to_vec()), (11, packets)] {
            let mut fixture = Fixture::new(kind, 8, (3, 2), &bytes);
            fixture.descriptor = origin;
            check(&fixture, &expected.map(|grey| [grey, grey, grey, 255]));
        }
    }
}

/// Rows: I1.
#[test]
fn interleaved_rows_are_put_in_order() {
    for (order, stored) in [(0x40, [0, 2, 4, 1, 3]), (0x80, [0, 4, 1, 2, 3])] {
        let mut fixture = Fixture::new(3, 8, (1, 5), &stored);
        fixture.descriptor = TOP_LEFT | order;
        check(
            &fixture,
            &[0, 1, 2, 3, 4].map(|grey| [grey, grey, grey, 255]),
        );
    }
    let mut fixture = Fixture::new(3, 8, (1, 1), &[0]);
    fixture.descriptor = 0xc0;
    assert!(refusal(&fixture).to_string().contains("byte 17"));
}

/// Rows: I1.
#[test]
fn packets_of_every_depth_run_and_repeat() {
    let grey = |values: &[u8]| values.iter().map(|&v| [v, v, v, 255]).collect::<Vec<_>>();
    check(
        &Fixture::new(11, 8, (5, 1), &[0x82, 9, 1, 7, 8]),
        &grey(&[9, 9, 9, 7, 8]),
    );
    check(
        &Fixture::new(10, 16, (3, 1), &[0x81, 0x00, 0x7c, 0, 0xe0, 0x03]),
        &[RED, RED, GREEN],
    );
    check(
        &Fixture::new(10, 24, (3, 1), &[0, 255, 0, 0, 0x81, 0, 0, 255]),
        &[BLUE, RED, RED],
    );
    check(
        &Fixture::new(10, 32, (3, 1), &[0x82, 0, 255, 0, 1]),
        &[GREEN, GREEN, GREEN],
    );
    let mut mapped = Fixture::new(9, 8, (4, 1), &[0x82, 1, 0, 0]);
    mapped.map = Some((0, 2, 24));
    mapped.map_bytes = vec![0, 0, 255, 255, 0, 0];
    check(&mapped, &[BLUE, BLUE, BLUE, RED]);
}

/// Rows: I1.
#[test]
fn packets_may_cross_rows_and_are_cut_at_the_last_texel() {
    let expected = [5, 5, 5, 5, 6, 7].map(|grey| [grey, grey, grey, 255]);
    check(&Fixture::new(11, 8, (3, 2), &[0x83, 5, 1, 6, 7]), &expected);
    let expected = [5; 6].map(|grey| [grey, grey, grey, 255]);
    check(&Fixture::new(11, 8, (3, 2), &[0xff, 5]), &expected);
    let expected = [1, 2, 3, 4, 5, 6].map(|grey| [grey, grey, grey, 255]);
    check(
        &Fixture::new(11, 8, (3, 2), &[0x7f, 1, 2, 3, 4, 5, 6]),
        &expected,
    );
}

/// Rows: I1.
#[test]
fn headers_that_contradict_themselves_are_refused() {
    let good = Fixture::new(2, 24, (1, 1), &[0; 3]);
    let mut no_map = Fixture::new(1, 8, (1, 1), &[0]);
    assert!(matches!(refusal(&no_map), AssetError::Malformed(_)));
    no_map.map = Some((0, 1, 8));
    assert!(matches!(refusal(&no_map), AssetError::Unsupported(_)));
    for size in [(0, 1), (1, 0)] {
        let fixture = Fixture {
            width: size.0,
            height: size.1,
            ..good.clone()
        };
        assert!(matches!(refusal(&fixture), AssetError::Malformed(_)));
    }
    for (kind, depth) in [
        (0, 24),
        (4, 24),
        (32, 8),
        (2, 8),
        (2, 0),
        (3, 24),
        (10, 255),
        (11, 15),
    ] {
        let fixture = Fixture {
            kind,
            depth,
            ..good.clone()
        };
        assert!(
            matches!(refusal(&fixture), AssetError::Unsupported(_)),
            "{kind} {depth}"
        );
    }
}
