//! Every kind of number gives the bits of the naive implementation.

use super::*;
use estampe_texture::{AddressMode, FilterMode};
use estampe_types::Quad;

const ODD: [f32; 18] = [
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    1e30,
    -1e30,
    16_777_217.0,
    -1e9,
    0.0,
    -0.0,
    1.0,
    -1.0,
    2.0,
    0.5,
    1e-40,
    -1e-10,
    0.999_999_94,
    1.000_000_1,
    -0.5,
];

const SIZES: [(u32, u32); 7] = [(1, 1), (1, 7), (5, 1), (3, 5), (8, 8), (64, 32), (13, 70)];

fn samplers() -> Vec<SamplerDescriptor> {
    let modes = [
        AddressMode::ClampToEdge,
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
    ];
    let filters = [FilterMode::Nearest, FilterMode::Linear];
    let mut samplers = Vec::new();
    for (index, bits) in (0..24_usize).enumerate() {
        samplers.push(SamplerDescriptor {
            address_mode_u: modes[bits % 3],
            address_mode_v: modes[(bits + index / 3) % 3],
            mag_filter: filters[bits & 1],
            min_filter: filters[bits >> 1 & 1],
            mipmap_filter: filters[bits >> 2 & 1],
            lod_min_clamp: if bits % 5 == 4 { 0.75 } else { 0.0 },
            lod_max_clamp: if bits % 7 == 6 { 1.5 } else { 32.0 },
            ..SamplerDescriptor::default()
        });
    }
    samplers.push(SamplerDescriptor::trilinear_repeat());
    samplers
}

/// A packet of quads, each with derivatives of its own; sometimes with odd values in it.
fn packet(random: &mut Random, with_odd: bool) -> [[f32; LANES]; 2] {
    let mut uv = [[0.0; LANES]; 2];
    let spread = [0.0, 0.002, 0.02, 0.2, 2.0][random.bits() as usize % 5];
    let origin = [random.unit() * 4.0 - 2.0, random.unit() * 4.0 - 2.0];
    for (values, origin) in uv.iter_mut().zip(origin) {
        for value in values {
            let at = origin + (random.unit() - 0.5) * spread;
            let is_odd = with_odd && random.bits().is_multiple_of(8);
            *value = if is_odd {
                ODD[random.bits() as usize % ODD.len()]
            } else {
                at
            };
        }
    }
    uv
}

fn assert_same(got: [f32; 4], expected: [f32; 4], what: impl Fn() -> String) {
    assert_eq!(
        got.map(f32::to_bits),
        expected.map(f32::to_bits),
        "{got:?} is not {expected:?}: {}",
        what()
    );
}

/// Rows: F2, U3.
#[test]
fn packets_quads_and_fragments_give_the_bits_of_the_naive_text() {
    let mut random = Random::new(7);
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Rgba8UnormSrgb] {
        for (width, height) in SIZES {
            let texture = std::sync::Arc::new(noise(width, height, format));
            for sampler in samplers() {
                let sampled = Rgba8Texture::new(texture.clone(), sampler);
                for round in 0..6 {
                    let uv = packet(&mut random, round % 2 == 1);
                    check_packet(&sampled, uv);
                }
            }
        }
    }
}

fn check_packet(sampled: &Rgba8Texture, [u, v]: [[f32; LANES]; 2]) {
    let mut lods = [0.0; LANES];
    for (lane, lod) in lods.iter_mut().enumerate() {
        let quad = lane & !3;
        let first = |values: &[f32; LANES]| [values[quad], values[quad + 1], values[quad + 2]];
        *lod = naive::lod_of_quad(sampled, first(&u), first(&v));
    }
    let expected: Colors = std::array::from_fn(|i| naive::sample(sampled, u[i], v[i], lods[i]));
    let what = |kind: &str, lane: usize| {
        let level = sampled.texture().levels[0];
        format!(
            "{kind}, lane {lane}, u {:e}, v {:e}, λ {}, {}×{} {:?}, {:?}",
            u[lane],
            v[lane],
            lods[lane],
            level.width,
            level.height,
            sampled.texture().format,
            sampled.sampler()
        )
    };
    for level in Level::all_available() {
        let implicit = sample_packet(level, sampled, [u, v], Lod::FromQuad);
        let explicit = sample_packet(level, sampled, [u, v], Lod::Given(lods));
        for lane in 0..LANES {
            assert_same(implicit[lane], expected[lane], || what(level.name(), lane));
            assert_same(explicit[lane], expected[lane], || what(level.name(), lane));
        }
    }
    for quad in (0..LANES).step_by(4) {
        let of = |values: &[f32; LANES]| Quad(std::array::from_fn(|i| values[quad + i]));
        let Vec4 { x, y, z, w } = sampled.sample(Vec2::new(of(&u), of(&v)));
        for i in 0..4 {
            let got = [x.0[i], y.0[i], z.0[i], w.0[i]];
            assert_same(got, expected[quad + i], || what("quad", quad + i));
        }
    }
    for lane in 0..LANES {
        let uv = Vec2::new(u[lane], v[lane]);
        let got = array(sampled.sample_level(uv, lods[lane]));
        assert_same(got, expected[lane], || what("fragment", lane));
        let alone = naive::sample(sampled, uv.x, uv.y, f32::NEG_INFINITY);
        assert_same(array(sampled.sample(uv)), alone, || what("lone", lane));
    }
}

#[test]
fn lanes_of_many_levels_keep_to_their_own() {
    let sampled = sampled(
        noise(256, 256, TextureFormat::Rgba8Unorm),
        SamplerDescriptor::trilinear_repeat(),
    );
    let mut random = Random::new(11);
    for _ in 0..50 {
        let mut lods = [0.0; LANES];
        for lod in &mut lods {
            *lod = random.unit() * 12.0 - 2.0;
        }
        let uv = packet(&mut random, false);
        for level in Level::all_available() {
            let got = sample_packet(level, &sampled, uv, Lod::Given(lods));
            for lane in 0..LANES {
                let expected = naive::sample(&sampled, uv[0][lane], uv[1][lane], lods[lane]);
                assert_same(got[lane], expected, || format!("{level:?}, lane {lane}"));
            }
        }
    }
}

#[test]
fn the_f32_sample_is_near_the_exact_one() {
    let sampled = sampled(
        noise(64, 32, TextureFormat::Rgba8Unorm),
        SamplerDescriptor::trilinear_repeat(),
    );
    let mut random = Random::new(23);
    for _ in 0..2000 {
        let uv = [random.unit() * 4.0 - 2.0, random.unit() * 4.0 - 2.0];
        let d = Vec2::new(random.unit() * random.unit() * 0.3, 0.0);
        let none = Vec2::new(0.0, 0.0);
        let got = array(sampled.sample_grad(Vec2::new(uv[0], uv[1]), d, none));
        let exact = naive::trilinear_f64(&sampled, uv.map(f64::from), f64::from(d.x) * 64.0);
        for (got, exact) in got.into_iter().zip(exact) {
            // λ is off by at most 6e-5, positions by 2⁻²³ · 2 · 64 texels.
            let error = (f64::from(got) - exact).abs();
            assert!(error < 1.5e-4, "{got} is {error} off at {uv:?}, {d:?}");
        }
    }
}

#[test]
fn a_texture_put_together_by_hand_cannot_harm() {
    let levels = [u32::MAX, 0, 5].map(|side| estampe_texture::MipLevel {
        width: side,
        height: side,
        offset: side,
    });
    let random = &mut Random::new(3);
    for (levels, texels) in [(vec![], vec![]), (levels.to_vec(), vec![u32::MAX; 3])] {
        let texture = std::sync::Arc::new(TexelData {
            format: TextureFormat::Rgba8Unorm,
            levels,
            texels: std::sync::Arc::new(estampe_types::Lines::from(texels)),
            is_opaque: false,
            alpha_maps: std::sync::Arc::default(),
            squares: std::sync::Arc::default(),
            shape: estampe_types::TextureShape::default(),
        });
        for mut sampler in samplers() {
            sampler.lod_min_clamp = f32::NAN;
            let sampled = Rgba8Texture::new(texture.clone(), sampler);
            for level in Level::all_available() {
                let colors = sample_packet(level, &sampled, packet(random, true), Lod::FromQuad);
                assert!(
                    colors
                        .as_flattened()
                        .iter()
                        .all(|c| (0.0..=1.0).contains(c))
                );
            }
            let alone = array(sampled.sample(Vec2::new(f32::MAX, 0.3)));
            assert!(alone.iter().all(|c| (0.0..=1.0).contains(c)));
        }
    }
}
