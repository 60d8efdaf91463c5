//! Textures of every dimension are created by their rules.

use estampe_format::TexelCodec;
use estampe_texture::{
    LevelData, Limits, MipGeneration, SampledTexture, SamplerDescriptor, TexelData,
    TexelDescriptor, TexelView, TexelViewDescriptor, TextureAspect, TextureDimension, TextureError,
    TextureFormat, ViewDimension,
};
use estampe_types::SampleType;

fn make(descriptor: TexelDescriptor) -> Result<TexelData, TextureError> {
    descriptor.create(&[], MipGeneration::None, &Limits::default())
}

fn flat() -> TexelDescriptor {
    TexelDescriptor::new_2d(4, 4, TextureFormat::Rgba8Unorm)
}

fn block() -> TexelDescriptor {
    TexelDescriptor {
        dimension: TextureDimension::D3,
        depth_or_layers: 4,
        ..flat()
    }
}

fn row() -> TexelDescriptor {
    TexelDescriptor {
        dimension: TextureDimension::D1,
        height: 1,
        ..flat()
    }
}

/// Descriptors, and whether an error is that of the rule that they break.
type Broken = (TexelDescriptor, fn(&TextureError) -> bool);

fn broken() -> Vec<Broken> {
    use TextureError as E;
    let (block, row) = (block(), row());
    vec![
        (
            TexelDescriptor { width: 0, ..flat() },
            (|e| matches!(e, E::Empty { .. })) as fn(&E) -> bool,
        ),
        (
            TexelDescriptor {
                height: 16_385,
                ..flat()
            },
            |e| matches!(e, E::TooLarge { limit: 16_384, .. }),
        ),
        (
            TexelDescriptor {
                width: 2049,
                ..block
            },
            |e| matches!(e, E::TooLarge { limit: 2048, .. }),
        ),
        (
            TexelDescriptor {
                depth_or_layers: 257,
                ..flat()
            },
            |e| matches!(e, E::Slices { most: 256, .. }),
        ),
        (
            TexelDescriptor {
                depth_or_layers: 0,
                ..flat()
            },
            |e| matches!(e, E::Slices { .. }),
        ),
        (
            TexelDescriptor {
                depth_or_layers: 2049,
                ..block
            },
            |e| matches!(e, E::Slices { most: 2048, .. }),
        ),
        (TexelDescriptor { height: 2, ..row }, |e| {
            matches!(e, E::Slices { height: 2, .. })
        }),
        (
            TexelDescriptor {
                format: TextureFormat::Bc1RgbaUnorm,
                ..block
            },
            |e| matches!(e, E::NotFlat { .. }),
        ),
        (
            TexelDescriptor {
                format: TextureFormat::Depth32Float,
                ..row
            },
            |e| matches!(e, E::NotFlat { .. }),
        ),
        (
            TexelDescriptor {
                mip_level_count: 4,
                ..flat()
            },
            |e| matches!(e, E::LevelCount { most: 3, actual: 4 }),
        ),
        (
            TexelDescriptor {
                mip_level_count: 0,
                ..flat()
            },
            |e| matches!(e, E::LevelCount { .. }),
        ),
        (
            TexelDescriptor {
                sample_count: 3,
                ..flat()
            },
            |e| matches!(e, E::Samples { samples: 3 }),
        ),
        (
            TexelDescriptor {
                sample_count: 4,
                mip_level_count: 2,
                ..flat()
            },
            |e| matches!(e, E::Samples { .. }),
        ),
        (
            TexelDescriptor {
                width: 16_384,
                height: 16_384,
                depth_or_layers: 256,
                ..flat()
            },
            |e| matches!(e, E::TooManyTexels { .. }),
        ),
    ]
}

/// Rows: F2, N1.
#[test]
fn rules_that_are_broken_are_named() {
    for (descriptor, is_expected) in broken() {
        let error = make(descriptor).expect_err("a broken rule");
        assert!(is_expected(&error), "{error:?} of {descriptor:?}");
        assert!(error.to_string().len() > 20);
    }
    for descriptor in [
        flat().with_all_levels(),
        block().with_all_levels(),
        row().with_all_levels(),
        TexelDescriptor {
            depth_or_layers: 256,
            ..flat()
        },
        TexelDescriptor {
            sample_count: 16,
            ..flat()
        },
        TexelDescriptor {
            width: 16_384,
            height: 1,
            ..flat()
        },
    ] {
        let texture = make(descriptor).expect("within the rules");
        assert!(texture.texels.iter().all(|word| *word == 0));
    }
}

#[test]
fn rows_that_overlap_or_end_early_are_refused() {
    let bytes = [7; 64];
    let create =
        |data: LevelData<'_>| flat().create(&[data], MipGeneration::None, &Limits::default());
    let tight = LevelData::tight(&bytes);
    assert!(create(tight).is_ok());
    for (data, is_layout) in [
        (
            LevelData {
                bytes_per_row: Some(15),
                ..tight
            },
            true,
        ),
        (
            LevelData {
                rows_per_image: Some(3),
                ..tight
            },
            true,
        ),
        (
            LevelData {
                bytes_per_row: Some(17),
                ..tight
            },
            false,
        ),
        (LevelData::tight(&bytes[..63]), false),
        (
            LevelData {
                bytes_per_row: Some(u32::MAX),
                rows_per_image: Some(u32::MAX),
                ..tight
            },
            false,
        ),
    ] {
        let error = create(data).expect_err("short");
        let is_row_layout = matches!(
            error,
            TextureError::RowLayout {
                bytes_per_row: 16,
                ..
            }
        );
        assert_eq!(is_row_layout, is_layout, "{error:?}");
    }
    let both = [tight, tight];
    let error = flat().create(&both, MipGeneration::None, &Limits::default());
    assert!(matches!(
        error,
        Err(TextureError::LevelCount { most: 1, actual: 2 })
    ));
}

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
