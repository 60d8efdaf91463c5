//! Mip levels that are made with a texture are means of the level above, in every format.

use estampe_format::TexelCodec;
use estampe_texture::{
    LevelData, Limits, MipGeneration, TexelDescriptor, TextureDimension, TextureError,
    TextureFormat,
};
use estampe_types::SampleType;

/// Rows: F2.
#[test]
fn levels_are_means() {
    for &format in TextureFormat::ALL {
        for dimension in [TextureDimension::D2, TextureDimension::D3] {
            if format.is_compressed() && dimension == TextureDimension::D3 {
                continue;
            }
            check_levels(format, dimension);
        }
    }
}

fn check_levels(format: TextureFormat, dimension: TextureDimension) {
    let descriptor = TexelDescriptor {
        dimension,
        depth_or_layers: 3,
        ..TexelDescriptor::new_2d(13, 6, format)
    };
    let descriptor = descriptor.with_all_levels();
    let [block_width, block_height] = format.block_size();
    let blocks = 13_u32.div_ceil(block_width) * 6_u32.div_ceil(block_height) * 3;
    // Noise whose floats are ordinary numbers.
    let random = &mut super::Random::new(format.block_bytes() * 7);
    let mut bytes = random.bytes((blocks * format.block_bytes()) as usize);
    let channel = format.block_bytes() as usize / format.components();
    if format.block_bytes() >= 2 && !format.is_compressed() {
        let high = |byte: u8| 0x38 | byte & 0x83;
        bytes
            .iter_mut()
            .skip(channel.max(1) - 1)
            .step_by(channel.max(1))
            .for_each(|b| *b = high(*b));
    }
    let data = [LevelData::tight(&bytes)];
    let made = descriptor.create(&data, MipGeneration::Full, &Limits::default());
    if format.sample_type() != SampleType::Float {
        if dimension == TextureDimension::D2 || format.is_color() {
            assert!(
                matches!(made, Err(TextureError::MipGeneration { .. })),
                "{format:?}"
            );
        }
        return;
    }
    let texture = made.unwrap_or_else(|error| panic!("{format:?}: {error}"));
    let codec = TexelCodec::new(texture.stored_format());
    let value = |level: usize, at: [usize; 3]| {
        let size = texture.levels[level];
        let index = (at[2] * size.height as usize + at[1]) * size.width as usize + at[0];
        let begin = (size.offset as usize + index) * codec.words();
        codec.decode(&texture.texels[begin..begin + codec.words()])
    };
    for level in 1..texture.levels.len() {
        let [width, height] = [0, 1].map(|k| {
            let size = |l: usize| [texture.levels[l].width, texture.levels[l].height][k] as usize;
            [size(level), size(level - 1)]
        });
        let slices = [level, level - 1].map(|level| texture.shape.slices(level) as usize);
        for at in 0..width[0] * height[0] * slices[0] {
            let at = [
                at % width[0],
                at / width[0] % height[0],
                at / width[0] / height[0],
            ];
            let two = |at: usize, above: usize| [2 * at, (2 * at + 1).min(above - 1)];
            let columns = two(at[0], width[1]);
            let rows = two(at[1], height[1]);
            let planes = match dimension {
                TextureDimension::D3 => two(at[2], slices[1]),
                _ => [at[2]; 2],
            };
            let mut sum = [0.0; 4];
            for index in 0..8 {
                let of = [columns[index & 1], rows[index >> 1 & 1], planes[index >> 2]];
                for (sum, x) in sum.iter_mut().zip(value(level - 1, of)) {
                    *sum += f64::from(x) / 8.0;
                }
            }
            let got = value(level, at);
            for k in 0..4 {
                // Half a code of the coarsest format near such a number: 2⁻⁵ of it, or 1/6 of two
                // bits.
                let tolerance = match texture.stored_format() {
                    TextureFormat::Rgb10a2Unorm if k == 3 => 0.17,
                    TextureFormat::Rgba8UnormSrgb => 0.006,
                    TextureFormat::Rg11b10Ufloat => sum[k].abs() / 60.0 + 1e-6,
                    TextureFormat::Rgb9e5Ufloat => {
                        sum.iter().fold(0.0_f64, |m, x| m.max(*x)) / 500.0
                    }
                    stored if stored.block_bytes() as usize == stored.components() => 0.0041,
                    _ => sum[k].abs() / 1000.0 + 1e-3,
                };
                let error = (f64::from(got[k]) - sum[k]).abs();
                assert!(
                    error <= tolerance,
                    "{format:?} {dimension:?} level {level} {at:?} channel {k}: {got:?} is not {sum:?}"
                );
            }
        }
    }
}
