//! Texels as an attachment stores them are those of rows, at the pixels of fragments.

use super::Random;
use estampe_simd::{LANE_X, LANE_Y, LANES, Level, Packet};
use estampe_texture::{
    Limits, MipGeneration, TexelData, TexelDescriptor, TexelView, TextureFormat, TiledTexels,
    TiledWords,
};
use estampe_types::morton::spread;
use estampe_types::{Lines, TextureFormat as F};
use std::sync::Arc;

/// The formats that are read in tiles.
const FORMATS: [F; 5] = [
    F::Rgba8Unorm,
    F::Rgba8UnormSrgb,
    F::Rgba16Float,
    F::R32Float,
    F::Depth32Float,
];

/// A texture of random texels.
fn rows(format: TextureFormat, [width, height]: [u32; 2], random: &mut Random) -> TexelData {
    let descriptor = TexelDescriptor::new_2d(width, height, format);
    let made = descriptor.create(&[], MipGeneration::None, &Limits::default());
    let mut texture = made.expect("it is small");
    let words = texture.texels.iter();
    let words = words.map(|_| (random.bits() << 8) ^ random.bits());
    texture.texels = Arc::new(words.collect::<Vec<u32>>().into());
    texture
}

/// The words of a texture in storage order; beyond its edges there is what is no texel of it.
fn tiled(texture: &TexelData) -> Vec<u32> {
    let (level, words) = (texture.levels[0], texture.words_per_texel());
    let blocks = [level.width, level.height].map(|side| side.div_ceil(64) as usize);
    let mut tiled = vec![0x1234_5678; blocks[0] * blocks[1] * 4096 * words];
    for y in 0..level.height {
        for x in 0..level.width {
            let block = (y / 64) as usize * blocks[0] + (x / 64) as usize;
            let pixel = block * 4096 + (spread(x % 64) | spread(y % 64) << 1) as usize;
            let texel = (y * level.width + x) as usize * words;
            for word in 0..words {
                let at = (pixel / LANES * words + word) * LANES + pixel % LANES;
                tiled[at] = texture.texels[texel + word];
            }
        }
    }
    tiled
}

fn tiled_texels(texture: &TexelData) -> Option<TiledTexels> {
    let words = tiled(texture);
    let words = match texture.format.has_depth() {
        true => {
            let depths: Vec<f32> = words.into_iter().map(f32::from_bits).collect();
            TiledWords::Depths(Arc::new(Lines::from(depths)))
        }
        false => TiledWords::Colors(Arc::new(Lines::from(words))),
    };
    let level = texture.levels[0];
    TiledTexels::new(texture.format, [level.width, level.height], words)
}

/// Positions of packets: blocks as they are stored, others, and pixels anywhere; inside and
/// outside.
fn positions(random: &mut Random, count: usize) -> Vec<[Packet<f32>; 4]> {
    let position = |kind: usize| {
        let mut first = [random.bits() % 180, random.bits() % 90];
        if kind % 4 < 2 {
            first = first.map(|at| at / 4 * 4);
        }
        let (mut x, mut y) = (Packet::default(), Packet::default());
        for lane in 0..LANES {
            let mut at = [
                first[0] + u32::from(LANE_X[lane]),
                first[1] + u32::from(LANE_Y[lane]),
            ];
            if kind % 4 == 3 {
                at = [random.bits() % 180, random.bits() % 90];
            }
            (x.0[lane], y.0[lane]) = (at[0] as f32 + 0.5, at[1] as f32 + 0.25);
        }
        [x, y, Packet::default(), Packet::default()]
    };
    (0..count).map(position).collect()
}

#[test]
fn texels_in_tiles_are_those_of_rows() {
    let random = &mut Random::new(61);
    let (mut inside, mut outside) = (0, 0);
    for size in [[1, 1], [64, 64], [150, 70], [66, 3]] {
        let textures = FORMATS.map(|format| rows(format, size, random));
        let tiles = textures
            .each_ref()
            .map(|texture| tiled_texels(texture).expect("it is known"));
        let views = textures.map(|texture| TexelView::of(texture).expect("it has a level"));
        // The second one is left as it is.
        let mut all = tiles.each_ref().map(Some);
        all[1] = None;
        let positions = positions(random, 64);
        for level in Level::all_available()
            .into_iter()
            .filter(|level| !level.is_scalar())
        {
            let mut texels = vec![[Packet([7.0; LANES]); 4]; positions.len() * FORMATS.len()];
            TiledTexels::fetch_at_pixels(&all, level, &positions, &mut texels);
            let packets = positions.iter().zip(texels.chunks(FORMATS.len()));
            for ([x, y, ..], texels) in packets {
                for ((view, texels), tiles) in views.iter().zip(texels).zip(&all) {
                    for lane in 0..LANES {
                        #[expect(clippy::cast_possible_truncation, reason = "small positions")]
                        let [x, y] = [x, y].map(|place| place.0[lane] as i32);
                        let expected = match tiles {
                            Some(_) => crate::array(view.fetch([x, y, 0], 0, 0)),
                            None => [7.0; 4],
                        };
                        let got = texels.each_ref().map(|channel| channel.0[lane].to_bits());
                        let what = format!("{level:?} {size:?} ({x}, {y})");
                        assert_eq!(got, expected.map(f32::to_bits), "{what}");
                        let is_inside = x < size[0].cast_signed() && y < size[1].cast_signed();
                        *[&mut outside, &mut inside][usize::from(is_inside)] += 1;
                    }
                }
            }
        }
    }
    for level in Level::all_available()
        .into_iter()
        .filter(|level| !level.is_scalar())
    {
        TiledTexels::fetch_at_pixels(&[], level, &positions(random, 3), &mut []);
    }
    assert!(inside > 1000 && outside > 1000, "{inside}, {outside}");
}

#[test]
fn other_formats_and_missing_words_have_no_tiles() {
    let random = &mut Random::new(62);
    for &format in TextureFormat::ALL {
        let descriptor = TexelDescriptor::new_2d(8, 8, format);
        let made = descriptor.create(&[], MipGeneration::None, &Limits::default());
        if made.is_err() || format.is_compressed() {
            continue;
        }
        let texture = rows(format, [8, 8], random);
        assert_eq!(
            tiled_texels(&texture).is_some(),
            FORMATS.contains(&format),
            "{format:?}"
        );
    }
    let short = TiledWords::Colors(Arc::new(Lines::from(vec![0; 4095])));
    assert!(TiledTexels::new(F::Rgba8Unorm, [8, 8], short.clone()).is_none());
    assert!(TiledTexels::new(F::Rgba8Unorm, [u32::MAX; 2], short.clone()).is_none());
    assert!(TiledTexels::new(F::Rgba8Unorm, [0, 8], short).is_none());
    let colors = TiledWords::Colors(Arc::new(Lines::from(vec![0; 4096])));
    assert!(TiledTexels::new(F::Depth32Float, [8, 8], colors).is_none());
    let depths = TiledWords::Depths(Arc::new(Lines::from(vec![0.0; 4096])));
    assert!(TiledTexels::new(F::R32Float, [8, 8], depths).is_none());
}
