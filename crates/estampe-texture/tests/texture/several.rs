//! Shortcuts give the same bits: several textures sampled at the same coordinates, four packets at
//! a time, and opaque textures.

use super::{Colors, Lod, Random, noise, sample_packet};
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_texture::{
    AddressMode, FilterMode, Limits, MipGeneration, Rgba8Texture, SamplerDescriptor, TextureFormat,
    create_texture,
};
use estampe_types::{Pair, Quad, Real, Vec2, Vec4};

fn sample_both(level: Level, textures: [&Rgba8Texture; 2], uv: [[f32; LANES]; 2]) -> [Colors; 2] {
    #[inline(always)]
    fn wide<S: Lanes>(simd: S, textures: [&Rgba8Texture; 2], uv: [[f32; LANES]; 2]) -> [Colors; 2] {
        let [u, v] = uv;
        let uv = Vec2::new(f32x16::load_array(simd, u), f32x16::load_array(simd, v));
        Rgba8Texture::sample_all(textures, uv).map(|color| {
            let Vec4 { x, y, z, w } = color;
            let channels = [x.to_array(), y.to_array(), z.to_array(), w.to_array()];
            std::array::from_fn(|lane| channels.map(|channel| channel[lane]))
        })
    }
    dispatch!(level, s => wide(s, textures, uv))
}

/// Coordinates of 4×4 neighbouring pixels, at any scale, inside the texture or across its borders.
fn place(random: &mut Random) -> [[f32; LANES]; 2] {
    let step = random.unit() * random.unit() * 0.1;
    let start = [random.unit() * 1.2 - 0.1, random.unit() * 1.2 - 0.1];
    let lane = |offsets: [u8; LANES], start: f32| offsets.map(|k| start + f32::from(k) * step);
    [
        lane(estampe_simd::LANE_X, start[0]),
        lane(estampe_simd::LANE_Y, start[1]),
    ]
}

#[test]
fn several_at_once_are_those_alone() {
    use TextureFormat::{Rgba8Unorm, Rgba8UnormSrgb};
    let trilinear = SamplerDescriptor::trilinear_repeat();
    let clamped = SamplerDescriptor {
        address_mode_u: AddressMode::ClampToEdge,
        ..trilinear
    };
    let coarse = SamplerDescriptor {
        lod_min_clamp: 1.5,
        ..trilinear
    };
    let bilinear = SamplerDescriptor {
        mipmap_filter: FilterMode::Nearest,
        ..trilinear
    };
    let of = |size: [u32; 2], format, sampler| {
        Rgba8Texture::new(noise(size[0], size[1], format), sampler)
    };
    // The same texels, in levels at other offsets.
    let mut moved = noise(64, 32, Rgba8Unorm);
    for level in &mut moved.levels {
        level.offset /= 2;
    }
    let textures = [
        of([64, 32], Rgba8Unorm, trilinear),
        of([64, 32], Rgba8Unorm, trilinear),
        of([64, 33], Rgba8Unorm, trilinear),
        of([64, 32], Rgba8Unorm, clamped),
        of([64, 32], Rgba8Unorm, coarse),
        of([64, 32], Rgba8Unorm, bilinear),
        of([64, 32], Rgba8UnormSrgb, trilinear),
        Rgba8Texture::new(moved, trilinear),
    ];
    let random = &mut Random::new(77);
    for first in &textures {
        for second in &textures {
            for level in Level::all_available() {
                for _ in 0..20 {
                    let uv = place(random);
                    let both = sample_both(level, [first, second], uv);
                    let alone =
                        [first, second].map(|one| sample_packet(level, one, uv, Lod::FromQuad));
                    assert_eq!(both, alone, "{level:?} {uv:?} {first:?} {second:?}");
                }
            }
        }
    }
    let uv = Vec2::new(Quad([0.1, 0.12, 0.1, 0.12]), Quad([0.3, 0.3, 0.31, 0.31]));
    let [one, two] = Rgba8Texture::sample_all([&textures[0], &textures[3]], uv);
    assert_eq!([one, two], [textures[0].sample(uv), textures[3].sample(uv)]);
    assert_eq!(Rgba8Texture::sample_all([], uv), []);
}

/// The colours of both textures, and of the first one alone, in each of four packets.
type OfFour = [[Colors; 3]; 4];

/// Samples four packets at a time.
fn sample_four(level: Level, both: [&Rgba8Texture; 2], uv: &[[[f32; LANES]; 2]; 4]) -> OfFour {
    #[inline(always)]
    fn wide<S: Lanes>(simd: S, both: [&Rgba8Texture; 2], uv: &[[[f32; LANES]; 2]; 4]) -> OfFour {
        let zero: f32x16<S> = SimdBase::splat(simd, 0.0);
        let zero = Pair(Pair(zero, zero), Pair(zero, zero));
        let axis = |k: usize| zero.with_lanes(|lane| uv[lane / LANES][k][lane % LANES]);
        let uv = Vec2::new(axis(0), axis(1));
        let [first, second] = Rgba8Texture::sample_all(both, uv);
        let colors = [first, second, both[0].sample(uv)];
        let of_lane = |color: &Vec4<Pair<Pair<f32x16<S>>>>, lane: usize| {
            let Vec4 { x, y, z, w } = color;
            [x.lane(lane), y.lane(lane), z.lane(lane), w.lane(lane)]
        };
        std::array::from_fn(|packet| {
            let lanes = |color| std::array::from_fn(|lane| of_lane(color, packet * LANES + lane));
            colors.each_ref().map(lanes)
        })
    }
    dispatch!(level, s => wide(s, both, uv))
}

#[test]
fn four_packets_at_a_time_are_those_alone() {
    let trilinear = SamplerDescriptor::trilinear_repeat();
    let textures = [(64, 32), (64, 33)]
        .map(|(width, height)| (noise(width, height, TextureFormat::Rgba8Unorm), trilinear))
        .map(|(texture, sampler)| Rgba8Texture::new(texture, sampler));
    let [first, second] = &textures;
    let random = &mut Random::new(41);
    for level in Level::all_available() {
        for _ in 0..100 {
            let uv: [_; 4] = std::array::from_fn(|_| place(random));
            let found = sample_four(level, [first, second], &uv);
            for (found, uv) in found.iter().zip(uv) {
                let alone = [first, second, first]
                    .map(|texture| sample_packet(level, texture, uv, Lod::FromQuad));
                assert_eq!(*found, alone, "{level:?} {uv:?}");
            }
        }
    }
}

#[test]
fn alpha_that_is_left_out_is_one() {
    let rgba = |alpha: u8| -> Vec<u8> {
        let mut bytes = Random::new(9).bytes(32 * 32 * 4);
        for texel in bytes.chunks_exact_mut(4) {
            texel[3] = 255;
        }
        bytes[7] = alpha;
        bytes
    };
    let make = |alpha| {
        let (format, mips) = (TextureFormat::Rgba8Unorm, MipGeneration::Full);
        create_texture(32, 32, format, &rgba(alpha), mips, &Limits::default()).expect("valid")
    };
    assert!(!make(254).is_opaque);
    let texture = make(255);
    assert!(texture.is_opaque);
    let mut plain = texture.clone();
    plain.is_opaque = false;
    let trilinear = SamplerDescriptor::trilinear_repeat();
    let textures = [texture, plain].map(|texture| Rgba8Texture::new(texture, trilinear));
    let random = &mut Random::new(5);
    for level in Level::all_available() {
        for _ in 0..200 {
            let uv = place(random);
            let [quick, plain] =
                [0, 1].map(|k| sample_packet(level, &textures[k], uv, Lod::FromQuad));
            assert_eq!(quick, plain, "{level:?} {uv:?}");
        }
    }
}
