//! Random textures, samplers and arguments of sampling functions, for tests of texture views.

use super::textures_views_answers::{Ask, Function};
use estampe_tests::Random;
use estampe_texture::{LevelData, MipGeneration, TexelDescriptor, TexelView};
use estampe_types::state::CompareFunction;
use estampe_types::{
    AddressMode, BorderColor, FilterMode, Limits, SampleType, SamplerDescriptor, TexelData,
    TextureDimension, TextureFormat, ViewDimension,
};
use std::sync::Arc;

pub(super) fn texture(
    random: &mut Random,
    dimension: ViewDimension,
    formats: &[TextureFormat],
) -> Arc<TexelData> {
    use ViewDimension as V;
    let sides = [1, 2, 3, 5, 8, 13, 16];
    let format = random.pick(formats);
    let width = random.pick(&sides);
    let (height, slices) = match dimension {
        V::D1 => (1, 1),
        V::D2 => (random.pick(&sides), 1 + random.below(2)),
        V::D2Array => (random.pick(&sides), 1 + random.below(5)),
        V::Cube => (width, 6 + random.below(3)),
        V::CubeArray => (width, 6 * (1 + random.below(3))),
        V::D3 => (random.pick(&sides), random.pick(&sides)),
    };
    let descriptor = TexelDescriptor {
        dimension: match dimension {
            V::D1 => TextureDimension::D1,
            V::D3 => TextureDimension::D3,
            _ => TextureDimension::D2,
        },
        depth_or_layers: slices,
        ..TexelDescriptor::new_2d(width, height, format)
    };
    let mut descriptor = descriptor.with_all_levels();
    descriptor.mip_level_count -= random.below(descriptor.mip_level_count);
    let shape = estampe_types::TextureShape {
        dimension: descriptor.dimension,
        depth_or_layers: slices,
        samples: 1,
    };
    // Different noise in each mip level, so that no level can be mistaken for another.
    let levels: Vec<Vec<u8>> = (0..descriptor.mip_level_count as usize)
        .map(|level| {
            let [block_width, block_height] = format.block_size();
            let columns = (width >> level).max(1).div_ceil(block_width);
            let rows = (height >> level).max(1).div_ceil(block_height);
            let blocks = columns * rows * shape.slices(level);
            noise(random, format, blocks as usize)
        })
        .collect();
    let data: Vec<_> = levels.iter().map(|bytes| LevelData::tight(bytes)).collect();
    let made = descriptor.create(&data, MipGeneration::None, &Limits::default());
    Arc::new(made.expect("a valid texture"))
}

/// Random bytes of this many blocks; floats are mostly of ordinary magnitude.
fn noise(random: &mut Random, format: TextureFormat, blocks: usize) -> Vec<u8> {
    use estampe_types::TexelEncoding as E;
    let count = blocks * format.block_bytes() as usize;
    let is_odd = random.once_in(4);
    match format.encoding() {
        E::Float32 | E::Depth32 if !is_odd => (0..count / 4)
            .flat_map(|_| random.unit().to_le_bytes())
            .collect(),
        E::Float16 if !is_odd => (0..count / 2)
            .flat_map(|_| [random.byte(), 0x30 | random.byte() & 0x8F])
            .collect(),
        _ => (0..count).map(|_| random.byte()).collect(),
    }
}

pub(super) fn sampler(random: &mut Random, view: &TexelView) -> SamplerDescriptor {
    use AddressMode as A;
    let modes = [
        A::ClampToEdge,
        A::Repeat,
        A::MirrorRepeat,
        A::MirrorOnce,
        A::ClampToBorder,
    ];
    let kind = view.texture().format.sample_type();
    let filters = match kind {
        SampleType::Uint | SampleType::Sint => [FilterMode::Nearest; 2],
        SampleType::Float | SampleType::Depth => [FilterMode::Nearest, FilterMode::Linear],
    };
    use CompareFunction as C;
    let functions = [
        C::Never,
        C::Less,
        C::Equal,
        C::LessEqual,
        C::Greater,
        C::NotEqual,
        C::GreaterEqual,
        C::Always,
    ];
    let is_anisotropic = filters[1] == FilterMode::Linear && random.once_in(3);
    let mut filter = || {
        if is_anisotropic {
            FilterMode::Linear
        } else {
            random.pick(&filters)
        }
    };
    let [mag_filter, min_filter, mipmap_filter] = [filter(), filter(), filter()];
    SamplerDescriptor {
        address_mode_u: random.pick(&modes),
        address_mode_v: random.pick(&modes),
        address_mode_w: random.pick(&modes),
        mag_filter,
        min_filter,
        mipmap_filter,
        lod_min_clamp: random.pick(&[0.0, 0.0, 0.5, 2.0]),
        lod_max_clamp: random.pick(&[32.0, 32.0, 2.0]),
        lod_bias: random.pick(&[0.0, 0.0, 0.7, -1.3, 40.0]),
        max_anisotropy: if is_anisotropic {
            random.pick(&[2, 3, 8, 16])
        } else {
            1
        },
        border_color: random.pick(&[
            BorderColor::TransparentBlack,
            BorderColor::OpaqueBlack,
            BorderColor::OpaqueWhite,
        ]),
        compare: (kind == SampleType::Depth).then(|| random.pick(&functions)),
    }
}

pub(super) fn question(random: &mut Random, function: Function, view: &TexelView) -> Ask {
    let is_cube = matches!(
        view.dimension(),
        ViewDimension::Cube | ViewDimension::CubeArray
    );
    let spread = random.pick(&[0.001, 0.02, 0.2, 2.0]);
    let origin = [0; 3].map(|_| random.range(-2.0, 2.0));
    let with_odd = random.once_in(3);
    let at = origin.map(|origin| {
        std::array::from_fn(|_| {
            if with_odd && random.once_in(8) {
                random.odd_number()
            } else if random.once_in(6) {
                // Between texels, on edges and on corners.
                (random.below(33) as f32 - 16.0) / 8.0
            } else {
                origin + random.range(-spread, spread)
            }
        })
    });
    let slope = random.pick(&[0.01, 0.1, 1.0]);
    let mut offset = [0; 3];
    if !is_cube && random.once_in(2) {
        offset = offset.map(|_| random.below(17).cast_signed() - 8);
    }
    Ask {
        function,
        at,
        layer: std::array::from_fn(|_| random.below(8).cast_signed() - 1),
        value: std::array::from_fn(|_| {
            if with_odd && random.once_in(9) {
                random.odd_number()
            } else if random.once_in(3) {
                // Exactly one mip level.
                random.below(4) as f32
            } else {
                random.range(-2.0, 6.0)
            }
        }),
        gradients: [0; 6].map(|_| {
            let skew = random.pick(&[0.05, 1.0]);
            std::array::from_fn(|_| random.range(-slope, slope) * skew)
        }),
        reference: std::array::from_fn(|_| {
            if random.once_in(5) {
                random.odd_number()
            } else {
                random.range(-0.1, 1.1)
            }
        }),
        offset,
    }
}
