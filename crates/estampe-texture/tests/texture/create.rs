//! Creation: sizes, levels, mip generation, errors.

use estampe_format::srgb::{self, LINEAR_FROM_SRGB};
use estampe_texture::{
    MipGeneration, TexelData, TextureError, TextureFormat, create_texture,
    create_texture_with_levels,
};
use estampe_types::Limits;

fn full(width: u32, height: u32, format: TextureFormat, rgba: &[u8]) -> TexelData {
    let limits = Limits::default();
    create_texture(width, height, format, rgba, MipGeneration::Full, &limits).expect("valid")
}

fn level(texture: &TexelData, index: usize) -> Vec<[u8; 4]> {
    let level = texture.levels[index];
    let start = level.offset as usize;
    let texels = &texture.texels[start..start + (level.width * level.height) as usize];
    texels.iter().map(|texel| texel.to_le_bytes()).collect()
}

/// Rows: F2.
#[test]
fn levels_halve_rounding_down_to_one_texel() {
    let texture = full(13, 6, TextureFormat::Rgba8Unorm, &[9; 13 * 6 * 4]);
    let sizes: Vec<_> = texture.levels.iter().map(|l| (l.width, l.height)).collect();
    assert_eq!(sizes, [(13, 6), (6, 3), (3, 1), (1, 1)]);
    let offsets: Vec<_> = texture.levels.iter().map(|l| l.offset).collect();
    assert_eq!(offsets, [0, 78, 96, 99]);
    assert_eq!(texture.texels.len(), 100);
    assert!(texture.texels.iter().all(|t| t.to_le_bytes() == [9; 4]));
}

#[test]
fn bytes_lie_red_lowest_and_rows_from_the_top() {
    let rgba: Vec<u8> = (1..=16).collect();
    let texture = full(2, 2, TextureFormat::Rgba8Unorm, &rgba);
    assert_eq!(
        texture.texels[..4],
        [0x0403_0201, 0x0807_0605, 0x0C0B_0A09, 0x100F_0E0D]
    );
}

#[test]
fn unorm_boxes_round_half_up_and_keep_channels_apart() {
    let rgba = [
        [255, 0, 0, 255],
        [255, 0, 1, 255],
        [255, 1, 1, 255],
        [255, 0, 1, 254],
    ];
    let texture = full(2, 2, TextureFormat::Rgba8Unorm, rgba.as_flattened());
    // (0 + 0 + 1 + 0)/4 = 0.25, (0 + 1 + 1 + 1)/4 = 0.75, 1019/4 = 254.75.
    assert_eq!(level(&texture, 1), [[255, 0, 1, 255]]);
}

#[test]
fn odd_sides_leave_the_last_out_and_single_ones_count_twice() {
    let row: Vec<u8> = [10, 20, 90].iter().flat_map(|&c| [c; 4]).collect();
    let texture = full(3, 1, TextureFormat::Rgba8Unorm, &row);
    assert_eq!(level(&texture, 1), [[15; 4]]);
}

/// Rows: F2.
#[test]
fn srgb_boxes_are_means_of_light_and_alpha_is_not() {
    let rgba = [
        [0, 0, 200, 0],
        [255, 0, 200, 255],
        [0, 0, 200, 0],
        [255, 8, 200, 255],
    ];
    let texture = full(2, 2, TextureFormat::Rgba8UnormSrgb, rgba.as_flattened());
    let half = srgb::encode(0.5);
    let quarter = srgb::encode(LINEAR_FROM_SRGB[8] / 4.0);
    assert_eq!(level(&texture, 1), [[half, quarter, 200, 128]]);
    assert_eq!(half, 188);
}

#[test]
fn given_levels_are_kept() {
    let (base, half) = ([1; 4 * 2 * 4], [2; 2 * 4]);
    let limits = Limits::default();
    let format = TextureFormat::Rgba8Unorm;
    let texture = create_texture_with_levels((4, 2), format, &[&base, &half], &limits);
    let texture = texture.expect("a chain may end early");
    assert_eq!(level(&texture, 0), [[1; 4]; 8]);
    assert_eq!(level(&texture, 1), [[2; 4]; 2]);
}

#[test]
fn each_broken_rule_is_named() {
    let limits = Limits {
        max_texture_dimension_2d: 64,
        ..Limits::default()
    };
    let format = TextureFormat::Rgba8Unorm;
    let make = |width, height, bytes: usize, format| {
        let bytes = vec![0; bytes];
        create_texture(width, height, format, &bytes, MipGeneration::Full, &limits)
            .expect_err("invalid")
    };
    let empty = TextureError::Empty {
        width: 0,
        height: 3,
    };
    assert_eq!(make(0, 3, 0, format), empty);
    let too_large = make(3, 65, 3 * 65 * 4, format);
    assert_eq!(
        too_large.to_string(),
        "3×65 texels exceed the limit max_texture_dimension_2d = 64"
    );
    let bytes = TextureError::ByteCount {
        level: 0,
        expected: 24,
        actual: 23,
    };
    assert_eq!(make(3, 2, 23, format), bytes);
    let depth = TextureFormat::Depth32Float;
    assert_eq!(make(1, 1, 4, depth), TextureError::Format { format: depth });

    let chain = |levels: &[&[u8]]| {
        create_texture_with_levels((2, 1), format, levels, &limits).expect_err("invalid")
    };
    let count = |actual| TextureError::LevelCount { most: 2, actual };
    assert_eq!(chain(&[]), count(0));
    assert_eq!(chain(&[&[0; 8], &[0; 4], &[0; 4]]), count(3));
    let second = TextureError::ByteCount {
        level: 1,
        expected: 4,
        actual: 8,
    };
    assert_eq!(chain(&[&[0; 8], &[0; 8]]), second);
}

#[test]
fn offsets_never_overflow_whatever_the_limit() {
    let limits = Limits {
        max_texture_dimension_2d: u32::MAX,
        ..Limits::default()
    };
    let format = TextureFormat::Rgba8Unorm;
    let huge = u32::MAX;
    let error = create_texture(huge, huge, format, &[], MipGeneration::Full, &limits);
    assert!(matches!(error, Err(TextureError::TooManyTexels { .. })));
}
