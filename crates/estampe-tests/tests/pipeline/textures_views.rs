//! Texture views of every dimension, format and sampler, with every sampling function, against the
//! oracle: equal bits at every SIMD level and for every kind of number.

#![expect(
    clippy::cast_possible_truncation,
    reason = "sizes and masks of small textures"
)]

use super::textures_views_answers::{Ask, Function, check, oracle};
use super::textures_views_random::{question, sampler, texture};
use estampe_reference::texture::ReferenceView;
use estampe_simd::LANES;
use estampe_tests::Random;
use estampe_texture::{LevelData, MipGeneration, SampledTexture, TexelDescriptor, TexelView};
use estampe_types::{
    AddressMode, FilterMode, Limits, SamplerDescriptor, TexelData, TexelViewDescriptor,
    TextureAspect, TextureFormat, ViewDimension,
};
use std::sync::Arc;

fn checks(
    topic: &str,
    count: u64,
    dimensions: &[ViewDimension],
    formats: &[TextureFormat],
    functions: &[Function],
) {
    for seed in 0..count {
        let random = &mut Random::new(topic, seed);
        let dimension = random.pick(dimensions);
        let texture = texture(random, dimension, formats);
        let all = texture.levels.len();
        let base = random.below(2).min(all as u32 - 1) as usize;
        let first = random.below(2).min(match dimension {
            ViewDimension::D1 | ViewDimension::D3 => 0,
            ViewDimension::Cube => texture.shape.depth_or_layers - 6,
            ViewDimension::CubeArray => 0,
            _ => texture.shape.depth_or_layers - 1,
        });
        let aspect = if texture.format.has_stencil() && random.once_in(2) {
            TextureAspect::Stencil
        } else {
            TextureAspect::All
        };
        let descriptor = TexelViewDescriptor {
            dimension: Some(dimension),
            base_mip_level: base as u32,
            base_array_layer: first,
            aspect,
            ..TexelViewDescriptor::default()
        };
        let view = TexelView::new(texture.clone(), &descriptor).expect("a view");
        let mut sampler = sampler(random, &view);
        if aspect == TextureAspect::Stencil {
            sampler = SamplerDescriptor {
                mag_filter: FilterMode::Nearest,
                min_filter: FilterMode::Nearest,
                mipmap_filter: FilterMode::Nearest,
                max_anisotropy: 1,
                compare: None,
                ..sampler
            };
        }
        let rest = texture.shape.depth_or_layers - first;
        let reference = ReferenceView {
            dimension,
            levels: [base, all - base],
            layers: match dimension {
                ViewDimension::D1 | ViewDimension::D2 | ViewDimension::D3 => [first, 1],
                ViewDimension::Cube => [first, 6],
                _ => [first, rest],
            },
            aspect,
            sampler,
            texture,
        };
        let view = SampledTexture::new(view, sampler).expect("a sampler");
        for &function in functions {
            let question = question(random, function, view.view());
            check(&view, &reference, &question);
        }
    }
}

const FUNCTIONS: [Function; 6] = [
    Function::Sample,
    Function::Bias,
    Function::Level,
    Function::Gradients,
    Function::Gather(1),
    Function::Gather(3),
];

fn formats(keep: impl Fn(TextureFormat) -> bool) -> Vec<TextureFormat> {
    let all = TextureFormat::ALL.iter().copied();
    all.filter(|&format| keep(format)).collect()
}

fn is_plain(format: TextureFormat) -> bool {
    format.is_color() && !format.is_compressed()
}

/// Rows: F2.
#[test]
fn images_and_arrays_of_every_format() {
    use ViewDimension::{D2, D2Array};
    checks(
        "views/2d",
        1200,
        &[D2, D2Array],
        TextureFormat::ALL,
        &FUNCTIONS,
    );
}

/// Rows: F2.
#[test]
fn rows_and_blocks_of_texels() {
    use ViewDimension::{D1, D3};
    checks(
        "views/1d 3d",
        900,
        &[D1, D3],
        &formats(is_plain),
        &FUNCTIONS,
    );
}

/// Rows: F2.
#[test]
fn cubes_without_seams() {
    use ViewDimension::{Cube, CubeArray};
    let formats = formats(|format| is_plain(format) || format.block_size() == [4, 4]);
    checks(
        "views/cubes",
        1200,
        &[Cube, CubeArray],
        &formats,
        &FUNCTIONS,
    );
}

/// Rows: F2.
#[test]
fn comparisons_with_every_function() {
    use ViewDimension::{Cube, CubeArray, D2, D2Array};
    let depths = formats(TextureFormat::has_depth);
    let functions = [
        Function::Compare,
        Function::CompareLevel,
        Function::GatherCompare,
        Function::Sample,
        Function::Gather(0),
    ];
    let dimensions = [D2, D2Array, Cube, CubeArray];
    checks("views/compare", 900, &dimensions, &depths, &functions);
}

/// Rows: F2.
#[test]
fn common_2d_views_equal_the_oracle() {
    // `SampledTexture` passes these views to `Rgba8Texture`; the oracle samples all views with the
    // same code.
    let formats = [
        TextureFormat::Rgba8Unorm,
        TextureFormat::Bgra8UnormSrgb,
        TextureFormat::Bc1RgbaUnorm,
    ];
    for seed in 0..400 {
        let random = &mut Random::new("views/common", seed);
        let texture = texture(random, ViewDimension::D2Array, &formats);
        let texture = TexelData {
            shape: estampe_types::TextureShape::default(),
            ..TexelData::clone(&texture)
        };
        // The first layer with its first mip level.
        let texture = Arc::new(TexelData {
            levels: texture.levels[..1].to_vec(),
            ..texture
        });
        let view = TexelView::of(texture.clone()).expect("a view");
        let sampler = SamplerDescriptor {
            mag_filter: random.pick(&[FilterMode::Nearest, FilterMode::Linear]),
            address_mode_u: random.pick(&[AddressMode::Repeat, AddressMode::MirrorRepeat]),
            ..SamplerDescriptor::default()
        };
        let reference = ReferenceView {
            texture,
            dimension: ViewDimension::D2,
            levels: [0, 1],
            layers: [0, 1],
            aspect: TextureAspect::All,
            sampler,
        };
        let view = SampledTexture::new(view, sampler).expect("a sampler");
        let question = Ask {
            offset: [0; 3],
            ..question(random, Function::Sample, view.view())
        };
        check(&view, &reference, &question);
    }
}

#[test]
fn a_mip_level_of_weight_zero_has_no_effect() {
    // In lanes beside some that mix two levels: ∞ times a weight of 0 would be NaN.
    let bytes = [0.5_f32; 16].map(f32::to_le_bytes);
    let (one, infinity) = (
        [1.0_f32; 4].map(f32::to_le_bytes),
        f32::INFINITY.to_le_bytes(),
    );
    let data = [
        LevelData::tight(bytes.as_flattened()),
        LevelData::tight(one.as_flattened()),
        LevelData::tight(&infinity),
    ];
    let descriptor = TexelDescriptor::new_2d(4, 4, TextureFormat::R32Float).with_all_levels();
    let texture = descriptor.create(&data, MipGeneration::None, &Limits::default());
    let texture = Arc::new(texture.expect("a texture"));
    let sampler = SamplerDescriptor {
        mipmap_filter: FilterMode::Linear,
        ..SamplerDescriptor::default()
    };
    let reference = ReferenceView::of_image(texture.clone(), sampler);
    let view = TexelView::of(texture).expect("a view");
    let view = SampledTexture::new(view, sampler).expect("a sampler");
    let question = Ask {
        function: Function::Level,
        at: [[0.25; LANES]; 3],
        layer: [0; LANES],
        value: std::array::from_fn(|lane| 1.0 + (lane % 3) as f32 * 0.25),
        gradients: [[0.0; LANES]; 6],
        reference: [0.0; LANES],
        offset: [0; 3],
    };
    check(&view, &reference, &question);
    assert_eq!(
        oracle(&reference, &question, 0, false),
        [1.0, 0.0, 0.0, 1.0]
    );
    assert_eq!(oracle(&reference, &question, 1, false)[0], f32::INFINITY);
}
