//! Texture views and samplers: they are refused if the texture lacks what they ask for; no texture,
//! even one that was put together by hand, lets them do harm; a depth image and its view compare
//! the same.

use super::descriptors::{flat, make};
use estampe_texture::{
    SampledTexture, SamplerDescriptor, TexelData, TexelDescriptor, TexelView, TexelViewDescriptor,
    TextureAspect, TextureDimension, TextureError, TextureFormat, ViewDimension,
};
use estampe_types::SampleType;

/// Rows: F2.
#[test]
fn views_and_samplers_ask_for_what_is_there() {
    let texture = std::sync::Arc::new(
        make(TexelDescriptor {
            depth_or_layers: 7,
            ..flat().with_all_levels()
        })
        .expect("an array"),
    );
    let view = |descriptor| TexelView::new(texture.clone(), &descriptor);
    let of = |dimension| TexelViewDescriptor {
        dimension: Some(dimension),
        ..TexelViewDescriptor::default()
    };
    let array = view(TexelViewDescriptor::default()).expect("all of it");
    assert_eq!(array.dimension(), ViewDimension::D2Array);
    assert_eq!((array.layer_count(), array.level_count()), (7, 3));
    assert_eq!((array.size(1), array.size(3)), ([2, 2, 1], [0; 3]));
    let cube = view(TexelViewDescriptor {
        base_array_layer: 1,
        base_mip_level: 1,
        ..of(ViewDimension::Cube)
    });
    assert_eq!(cube.expect("six layers").size(0), [2, 2, 1]);
    for refused in [
        of(ViewDimension::D3),
        of(ViewDimension::CubeArray),
        TexelViewDescriptor {
            base_array_layer: 2,
            ..of(ViewDimension::Cube)
        },
        TexelViewDescriptor {
            base_array_layer: 7,
            ..of(ViewDimension::D2)
        },
        TexelViewDescriptor {
            array_layer_count: Some(8),
            ..of(ViewDimension::D2Array)
        },
        TexelViewDescriptor {
            base_mip_level: 3,
            ..of(ViewDimension::D2)
        },
        TexelViewDescriptor {
            mip_level_count: Some(u32::MAX),
            ..of(ViewDimension::D2)
        },
        TexelViewDescriptor {
            aspect: TextureAspect::Stencil,
            ..of(ViewDimension::D2)
        },
    ] {
        let error = view(refused).expect_err("not there");
        assert!(matches!(error, TextureError::View { .. }), "{error}");
    }
    let linear = SamplerDescriptor::trilinear_repeat();
    let sampled = |format, sampler| {
        let texture = make(TexelDescriptor { format, ..flat() }).expect("a texture");
        SampledTexture::new(TexelView::of(texture).expect("a view"), sampler)
    };
    assert!(sampled(TextureFormat::Rgba32Float, linear).is_ok());
    let less = Some(estampe_types::state::CompareFunction::Less);
    for (format, sampler) in [
        (TextureFormat::R8Uint, linear),
        (TextureFormat::Stencil8, linear),
        (
            TextureFormat::R8Unorm,
            SamplerDescriptor {
                compare: less,
                ..linear
            },
        ),
        (
            TextureFormat::R8Unorm,
            SamplerDescriptor {
                max_anisotropy: 17,
                ..linear
            },
        ),
        (
            TextureFormat::R8Unorm,
            SamplerDescriptor {
                max_anisotropy: 0,
                ..linear
            },
        ),
        (
            TextureFormat::R8Unorm,
            SamplerDescriptor {
                max_anisotropy: 2,
                ..SamplerDescriptor::default()
            },
        ),
        (
            TextureFormat::R8Unorm,
            SamplerDescriptor {
                lod_min_clamp: 3.0,
                lod_max_clamp: 2.0,
                ..linear
            },
        ),
        (
            TextureFormat::R8Unorm,
            SamplerDescriptor {
                lod_min_clamp: f32::NAN,
                ..linear
            },
        ),
    ] {
        let error = sampled(format, sampler).expect_err("refused");
        assert!(matches!(error, TextureError::Sampler { .. }), "{error}");
    }
}

/// The fields of a texture are public: no value in them may do harm.
#[test]
fn views_of_textures_put_together_by_hand_cannot_harm() {
    use estampe_texture::{Coordinates, Lod};
    use estampe_types::{Quad, Vec3};
    let sides = [0, 1, 7, 16_384, u32::MAX];
    let random = &mut super::Random::new(77);
    let mut views = 0;
    for round in 0..30_000_u32 {
        let pick = |random: &mut super::Random| sides[random.bits() as usize % sides.len()];
        let levels = (0..random.bits() % 4)
            .map(|_| {
                let side = pick(random);
                estampe_texture::MipLevel {
                    width: side,
                    height: if random.bits().is_multiple_of(2) {
                        side
                    } else {
                        pick(random)
                    },
                    offset: pick(random),
                }
            })
            .collect();
        let dimension = [
            TextureDimension::D1,
            TextureDimension::D2,
            TextureDimension::D3,
        ];
        let texture = TexelData {
            format: TextureFormat::ALL[round as usize % TextureFormat::ALL.len()],
            levels,
            texels: std::sync::Arc::new(vec![0x3F80_0000; random.bits() as usize % 50].into()),
            is_opaque: true,
            alpha_maps: std::sync::Arc::default(),
            squares: std::sync::Arc::default(),
            shape: estampe_texture::TextureShape {
                dimension: dimension[random.bits() as usize % 3],
                depth_or_layers: [0, 1, 6, 12, 1 << 14, u32::MAX][random.bits() as usize % 6],
                samples: [0, 1, 1, 1, 4, u32::MAX][random.bits() as usize % 6],
            },
        };
        use ViewDimension as V;
        let dimension = [V::D1, V::D2, V::D2Array, V::Cube, V::CubeArray, V::D3];
        let descriptor = TexelViewDescriptor {
            dimension: Some(dimension[random.bits() as usize % 6]),
            base_mip_level: random.bits() % 3,
            base_array_layer: if random.bits().is_multiple_of(4) {
                pick(random)
            } else {
                0
            },
            ..TexelViewDescriptor::default()
        };
        let Ok(view) = TexelView::new(texture, &descriptor) else {
            continue;
        };
        views += 1;
        let ints = |random: &mut super::Random| {
            Quad([0, 1, i32::MAX, 16_383].map(|k| k ^ (random.bits() % 2).cast_signed()))
        };
        let at = [ints(random), ints(random), ints(random)];
        view.fetch(at, Quad([0, 1, 0, i32::MIN]), Quad([0, 0, 3, i32::MAX]));
        let sampler = SamplerDescriptor {
            compare: view
                .texture()
                .format
                .has_depth()
                .then_some(estampe_types::state::CompareFunction::Less),
            ..if view.texture().format.sample_type() == SampleType::Uint
                || view.texture().format.sample_type() == SampleType::Sint
            {
                SamplerDescriptor::default()
            } else {
                SamplerDescriptor::trilinear_repeat()
            }
        };
        let Ok(sampled) = SampledTexture::new(view, sampler) else {
            continue;
        };
        let mut number = || Quad([0; 4].map(|_| (random.unit() - 0.5) * 8.0));
        let at = Coordinates::cube_array(
            Vec3::new(number(), number(), number()),
            Quad([i32::MIN, 0, 5, i32::MAX]),
        );
        sampled.sample_with(at, Lod::Level(number()), [i32::MAX, i32::MIN, 1]);
        sampled.gather(at, 7, [1, 2]);
        sampled.sample_compare(at, number(), Lod::Implicit, [0; 2]);
        for level in estampe_simd::Level::all_available() {
            super::sample_view_packet(level, &sampled);
        }
    }
    assert!(views > 1000, "{views}");
}

#[test]
fn a_depth_image_is_compared_the_same_as_a_texture() {
    use estampe_texture::{
        Coordinates, FilterMode, Lod, ShadowMap, sample_compare_level, texture_from_depth,
    };
    let random = &mut super::Random::new(5);
    let rows: Vec<f32> = (0..37 * 70).map(|_| random.unit()).collect();
    let image = ShadowMap::from_rows(37, 70, &rows);
    let view = TexelView::of(texture_from_depth(&image).expect("not empty")).expect("a view");
    let sampler = SamplerDescriptor {
        mag_filter: FilterMode::Linear,
        compare: Some(estampe_types::state::CompareFunction::LessEqual),
        ..SamplerDescriptor::default()
    };
    let view = SampledTexture::new(view, sampler).expect("a sampler");
    for _ in 0..2000 {
        let uv = estampe_types::Vec2::new(random.unit() * 1.2 - 0.1, random.unit() * 1.2 - 0.1);
        let reference = random.unit();
        let wanted: f32 = sample_compare_level(&image, uv, reference);
        let got = view.sample_compare(Coordinates::d2(uv), reference, Lod::Level(0.0), [0; 2]);
        assert_eq!(got.to_bits(), wanted.to_bits());
    }
    assert!(texture_from_depth(&ShadowMap::default()).is_err());
}
