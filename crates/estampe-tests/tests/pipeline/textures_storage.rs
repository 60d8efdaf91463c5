//! Storage textures: stores, loads, sampling and readback; write masks, borders, threads.

#![expect(
    clippy::cast_possible_truncation,
    reason = "sizes and masks of small textures"
)]

use estampe_reference::texture::texel::TexelReader;
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_tests::Random;
use estampe_texture::{
    LevelData, MipGeneration, StorageTexture, TexelDescriptor, TexelView, TextureError,
    create_storage_texture, storage_bytes, storage_load, storage_store, storage_texture_to_texture,
};
use estampe_types::{
    Bindings, BoundGroup, BoundResource, BoundResources, Limits, Quad, Real, SampleType,
    TexelEncoding, TextureAspect, TextureDimension, TextureFormat, Vec4,
};

type Places = [[i32; LANES]; 3];
type Values = [[f32; LANES]; 4];

#[inline(always)]
fn ints<R: Real>(like: R, from: &[i32; LANES], first: usize) -> R::Int {
    let bits = like.with_lanes(|lane| f32::from_bits(from[first + lane].cast_unsigned()));
    Real::to_bits(bits)
}

#[inline(always)]
fn store<R: Real>(
    texture: &StorageTexture,
    like: R,
    (places, values, mask): (&Places, &Values, u16),
    first: usize,
) {
    let at = [
        ints(like, &places[0], first),
        ints(like, &places[1], first),
        ints(like, &places[2], first),
    ];
    let number = |k: usize| like.with_lanes(|lane| values[k][first + lane]);
    let chosen = like.with_lanes(|lane| f32::from(mask >> (first + lane) & 1));
    let chosen = chosen.gt(chosen.splat(0.5));
    let value = Vec4::new(number(0), number(1), number(2), number(3));
    storage_store(texture, chosen, at, value);
}

fn store_packet(level: Level, texture: &StorageTexture, what: (&Places, &Values, u16)) {
    #[inline(always)]
    fn wide<S: Lanes>(simd: S, texture: &StorageTexture, what: (&Places, &Values, u16)) {
        let zero: f32x16<S> = SimdBase::splat(simd, 0.0);
        store(texture, zero, what, 0);
    }
    dispatch!(level, s => wide(s, texture, what));
}

fn load_packet(level: Level, texture: &StorageTexture, places: &Places) -> Values {
    #[inline(always)]
    fn wide<S: Lanes>(simd: S, texture: &StorageTexture, places: &Places) -> Values {
        let zero: f32x16<S> = SimdBase::splat(simd, 0.0);
        let at = [
            ints(zero, &places[0], 0),
            ints(zero, &places[1], 0),
            ints(zero, &places[2], 0),
        ];
        let Vec4 { x, y, z, w } = storage_load(texture, at);
        [x.to_array(), y.to_array(), z.to_array(), w.to_array()]
    }
    dispatch!(level, s => wide(s, texture, places))
}

fn is_storable(format: TextureFormat) -> bool {
    format.is_color()
        && !format.is_compressed()
        && !format.is_srgb()
        && format.encoding() != TexelEncoding::SharedExponent
}

/// The greatest error of a stored number: half a step of the format, for numbers around ±4.
fn step(format: TextureFormat, channel: usize, value: f32) -> f32 {
    use TexelEncoding as E;
    let relative = value.abs().max(1e-4);
    match format.encoding() {
        E::Unorm8 => 0.501 / 255.0,
        E::Snorm8 => 0.501 / 127.0,
        E::Unorm16 => 0.51 / 65535.0,
        E::Snorm16 => 0.51 / 32767.0,
        E::Unorm10_2 => 0.501 / if channel == 3 { 3.0 } else { 1023.0 },
        E::Float16 => relative / 2048.0,
        E::Ufloat11_10 => relative / if channel == 2 { 64.0 } else { 128.0 },
        _ => 0.0,
    }
}

/// The value clamped to the format's range.
fn confined(format: TextureFormat, value: f32) -> f32 {
    use TexelEncoding as E;
    match format.encoding() {
        E::Unorm8 | E::Unorm16 | E::Unorm10_2 => value.clamp(0.0, 1.0),
        E::Snorm8 | E::Snorm16 => value.clamp(-1.0, 1.0),
        E::Ufloat11_10 => value.max(0.0),
        _ => value,
    }
}

/// Rows: F2.
#[test]
fn stored_texels_are_loaded_and_read_back() {
    for (number, &format) in TextureFormat::ALL.iter().enumerate() {
        if !is_storable(format) {
            let refused = create_storage_texture(
                &TexelDescriptor::new_2d(4, 4, format),
                None,
                &Limits::default(),
            );
            assert!(matches!(refused, Err(TextureError::NotStorable { .. })));
            continue;
        }
        let random = &mut Random::new("storage", number as u64);
        let descriptor = TexelDescriptor {
            dimension: random.pick(&[TextureDimension::D2, TextureDimension::D3]),
            depth_or_layers: 3,
            ..TexelDescriptor::new_2d(7, 5, format)
        };
        let make =
            || create_storage_texture(&descriptor, None, &Limits::default()).expect("storable");
        let is_integer = format.sample_type() != SampleType::Float;
        for level in Level::all_available() {
            let texture = make();
            let quads = make();
            let mut expected = vec![None; 7 * 5 * 3];
            for _ in 0..12 {
                let side = |random: &mut Random, n: u32| random.below(n + 3).cast_signed() - 1;
                let mut places: Places = [[0; LANES]; 3];
                let mut values: Values = [[0.0; LANES]; 4];
                for lane in 0..LANES {
                    let at = [side(random, 7), side(random, 5), side(random, 3)];
                    for k in 0..3 {
                        places[k][lane] = at[k];
                    }
                    for of_channel in &mut values {
                        of_channel[lane] = if is_integer {
                            f32::from_bits(random.below(2))
                        } else {
                            random.range(-0.5, 4.0)
                        };
                    }
                }
                let mask = random.below(0x1_0000) as u16;
                store_packet(level, &texture, (&places, &values, mask));
                for first in (0..LANES).step_by(4) {
                    store(&quads, Quad([0.0; 4]), (&places, &values, mask), first);
                }
                // Lanes store in order in this implementation, though the API does not guarantee
                // it.
                for lane in 0..LANES {
                    let [x, y, z] = [0, 1, 2].map(|k| places[k][lane]);
                    let is_there =
                        (0..7).contains(&x) && (0..5).contains(&y) && (0..3).contains(&z);
                    if mask >> lane & 1 == 1 && is_there {
                        let at = (z * 5 + y) * 7 + x;
                        expected[usize::try_from(at).expect("inside")] =
                            Some([0, 1, 2, 3].map(|k| values[k][lane]));
                    }
                }
            }
            assert_eq!(storage_bytes(&texture), storage_bytes(&quads), "{format:?}");
            check_contents(level, &texture, &expected, is_integer);
        }
    }
}

fn check_contents(
    level: Level,
    texture: &StorageTexture,
    expected: &[Option<[f32; 4]>],
    is_integer: bool,
) {
    let format = texture.format();
    let sampled = storage_texture_to_texture(texture, MipGeneration::None).expect("a texture");
    let reader = TexelReader {
        format: sampled.stored_format(),
        aspect: TextureAspect::All,
    };
    let words = sampled.words_per_texel();
    let view = TexelView::of(sampled.clone()).expect("a view");
    for (index, expected) in expected.iter().enumerate() {
        let [x, y, z] = [index % 7, index / 7 % 5, index / 35].map(|k| k as i32);
        let places: Places = [[x; LANES], [y; LANES], [z; LANES]];
        let loaded = load_packet(level, texture, &places).map(|channel| channel[3]);
        let fetched = view.fetch([x, y, z], 0, 0);
        let fetched = [fetched.x, fetched.y, fetched.z, fetched.w];
        assert_eq!(
            loaded.map(f32::to_bits),
            fetched.map(f32::to_bits),
            "{format:?}"
        );
        let units = reader.units(&sampled.texels[index * words..][..words]);
        let factors = reader.factors();
        for k in 0..4 {
            let is_stored = k < format.components();
            if is_integer {
                assert_eq!(units[k].to_bits(), loaded[k].to_bits(), "{format:?}");
                if let (Some(wanted), true) = (expected, is_stored) {
                    assert_eq!(loaded[k].to_bits(), wanted[k].to_bits(), "{format:?}");
                }
                continue;
            }
            assert_eq!(units[k] * factors[k], loaded[k], "{format:?}");
            let wanted = match expected {
                Some(wanted) if is_stored => confined(format, wanted[k]),
                _ if k == 3 && !is_stored => 1.0,
                _ => 0.0,
            };
            let error = (loaded[k] - wanted).abs();
            assert!(
                error <= step(format, k, wanted),
                "{format:?} channel {k}: {} is not {wanted}",
                loaded[k]
            );
        }
    }
}

/// Rows: F2.
#[test]
fn uploaded_bytes_are_kept() {
    let bytes: Vec<u8> = (0..4 * 3 * 2 * 4).collect();
    for format in [TextureFormat::Bgra8Unorm, TextureFormat::Rg16Sint] {
        let descriptor = TexelDescriptor {
            depth_or_layers: 2,
            ..TexelDescriptor::new_2d(4, 3, format)
        };
        let data = Some(LevelData::tight(&bytes));
        let texture = create_storage_texture(&descriptor, data, &Limits::default());
        let texture = texture.expect("storable");
        assert_eq!(storage_bytes(&texture), bytes);
        let bound = BoundResource::StorageTexture(texture.clone());
        let group = BoundResources {
            entries: vec![(3, bound)],
        };
        let bindings = Bindings {
            groups: vec![BoundGroup {
                group: group.into(),
                ..BoundGroup::default()
            }],
            ..Bindings::default()
        };
        // The binding is the same texture, not a copy.
        let found = bindings.storage_texture(0, 3).expect("bound");
        storage_store::<f32>(found, true, [1, 0, 0], Vec4::repeat(0.0));
        assert_eq!(storage_bytes(&texture)[4..8], [0; 4]);
        assert!(bindings.storage_texture(0, 2).is_none() && bindings.sampler(0, 3).is_none());
        let short = Some(LevelData::tight(&bytes[1..]));
        assert!(create_storage_texture(&descriptor, short, &Limits::default()).is_err());
    }
}

/// Rows: F2.
#[test]
fn threads_store_side_by_side() {
    let descriptor = TexelDescriptor::new_2d(256, 256, TextureFormat::Rgba32Uint);
    let texture = create_storage_texture(&descriptor, None, &Limits::default()).expect("storable");
    std::thread::scope(|scope| {
        for thread in 0..4_i32 {
            let texture = texture.clone();
            scope.spawn(move || {
                for y in 0..256 {
                    for x in (0..256).filter(|x| (x + y) % 4 == thread) {
                        let value = Vec4::repeat(f32::from_bits((y * 256 + x).cast_unsigned()));
                        storage_store::<f32>(&texture, true, [x, y, 0], value);
                    }
                }
            });
        }
    });
    let bytes = storage_bytes(&texture);
    let words = bytes.as_chunks::<4>().0;
    assert_eq!(words.len(), 4 << 16);
    for (index, word) in words.iter().enumerate() {
        assert_eq!(u32::from_le_bytes(*word) as usize, index / 4);
    }
}

/// Rows: F2, N1.
#[test]
fn large_ones_hold_their_corners() {
    let descriptor = TexelDescriptor::new_2d(8192, 8192, TextureFormat::R8Unorm);
    let texture = create_storage_texture(&descriptor, None, &Limits::default()).expect("storable");
    for (x, y) in [(0, 0), (8191, 0), (0, 8191), (8191, 8191)] {
        storage_store::<f32>(&texture, true, [x, y, 0], Vec4::repeat(1.0));
        storage_store::<f32>(&texture, false, [x / 2, y, 0], Vec4::repeat(0.5));
        assert_eq!(storage_load(&texture, [x, y, 0]).x, 1.0);
        assert_eq!(storage_load(&texture, [x + 8192, y, 0]).w, 0.0);
    }
    let bytes = storage_bytes(&texture);
    assert_eq!(bytes.len(), 8192 * 8192);
    assert_eq!(bytes.iter().filter(|byte| **byte != 0).count(), 4);
    let too_many = TexelDescriptor {
        depth_or_layers: 256,
        ..descriptor
    };
    assert!(create_storage_texture(&too_many, None, &Limits::default()).is_err());
}
