//! Textures sampled at varyings with gradients: each lane has the level of its own derivatives.

use super::{Colors, Random, noise};
use estampe_simd::{LANES, Lanes, Level, Packet, SimdBase, dispatch, f32x16};
use estampe_texture::{
    AddressMode, PacketLod, PacketPlace, PacketRequest, SampledTexture, SamplerDescriptor,
    TexelView, TextureFormat,
};
use estampe_types::{Vec2, Vec4, WithGradient};

/// (u, v), and its derivatives along x and y.
type Varying = [[f32; LANES]; 6];

fn sample(level: Level, textures: [&SampledTexture; 2], varying: &Varying) -> [Colors; 3] {
    #[inline(always)]
    fn wide<S: Lanes>(s: S, textures: [&SampledTexture; 2], of: &Varying) -> [Colors; 3] {
        let load = |at: usize| f32x16::load_array(s, of[at]);
        let at = WithGradient {
            value: Vec2::new(load(0), load(1)),
            ddx: Vec2::new(load(2), load(3)),
            ddy: Vec2::new(load(4), load(5)),
        };
        let [first, second] = SampledTexture::sample_all(textures, at);
        [textures[0].sample(at), first, second].map(|color| {
            let Vec4 { x, y, z, w } = color;
            let channels = [x.to_array(), y.to_array(), z.to_array(), w.to_array()];
            std::array::from_fn(|lane| channels.map(|channel| channel[lane]))
        })
    }
    dispatch!(level, s => wide(s, textures, varying))
}

/// The colour of one lane alone, through the code for any texture.
fn alone(texture: &SampledTexture, varying: &Varying, lane: usize) -> [f32; 4] {
    let only = varying.map(|of| Packet([of[lane]; LANES]));
    let [u, v, ux, vx, uy, vy] = &only;
    let zeros = PacketRequest::ZEROS.at[2];
    let request = PacketRequest {
        count: 1,
        at: [u, v, zeros],
        lod: PacketLod::Gradients,
        gradients: [ux, vx, zeros, uy, vy, zeros],
        ..PacketRequest::ZEROS
    };
    let mut colors = [Packet::default(); 4];
    texture.sample_request(&request, &mut colors);
    colors.map(|channel| channel.0[0])
}

/// Neighbouring pixels of one triangle, or of several with levels of their own.
fn varying(random: &mut Random) -> Varying {
    let is_one = random.bits().is_multiple_of(2);
    let scale = random.unit() * random.unit() * 0.2;
    let mut of = [0; 6].map(|_| (random.unit() - 0.5) * scale);
    let place = [random.unit() * 1.2 - 0.1, random.unit() * 1.2 - 0.1];
    let mut lanes = [[0.0; 6]; LANES];
    for (lane, to) in lanes.iter_mut().enumerate() {
        if !is_one && lane % 4 == 0 {
            of = of.map(|_| (random.unit() - 0.5) * 0.2);
        }
        let at = |axis: usize| place[axis] + of[axis] * lane as f32 * 0.1;
        *to = [at(0), at(1), of[2], of[3], of[4], of[5]];
    }
    std::array::from_fn(|scalar| lanes.map(|of_lane| of_lane[scalar]))
}

#[test]
fn lanes_have_the_levels_of_their_own_derivatives() {
    let trilinear = SamplerDescriptor::trilinear_repeat();
    let clamped = SamplerDescriptor {
        address_mode_u: AddressMode::ClampToEdge,
        ..trilinear
    };
    let anisotropic = SamplerDescriptor {
        max_anisotropy: 4,
        ..trilinear
    };
    let of = |side: u32, format, sampler| {
        let view = TexelView::of(noise(side, 32, format)).expect("a texture of one image");
        SampledTexture::new(view, sampler).expect("a sampler that fits")
    };
    use TextureFormat::{Rgba8Unorm, Rgba8UnormSrgb};
    // Alike, of two sizes, with two samplers, and of another kind.
    let pairs = [
        [
            of(64, Rgba8Unorm, trilinear),
            of(64, Rgba8UnormSrgb, trilinear),
        ],
        [of(64, Rgba8Unorm, trilinear), of(32, Rgba8Unorm, trilinear)],
        [of(64, Rgba8Unorm, clamped), of(64, Rgba8Unorm, trilinear)],
        [
            of(64, Rgba8Unorm, anisotropic),
            of(64, Rgba8Unorm, trilinear),
        ],
    ];
    assert!(pairs[0][0].common().is_some() && pairs[3][0].common().is_none());
    let mut random = Random::new(51);
    for level in Level::all_available() {
        let pairs = pairs
            .clone()
            .map(|pair| pair.map(|texture| texture.at_level(level)));
        for round in 0..200 {
            let varying = varying(&mut random);
            let [first, second] = &pairs[round % pairs.len()];
            let [of_first, all_first, all_second] = sample(level, [first, second], &varying);
            for lane in 0..LANES {
                let expected = [first, first, second].map(|of| alone(of, &varying, lane));
                let got = [of_first[lane], all_first[lane], all_second[lane]];
                let bits = |of: [[f32; 4]; 3]| of.map(|color| color.map(f32::to_bits));
                assert_eq!(
                    bits(got),
                    bits(expected),
                    "{level:?}, round {round}, lane {lane}"
                );
            }
            // As a compiled shader asks.
            let packets = varying.map(Packet);
            let mut together = [[Packet::default(); 4]; 2];
            let at = PacketPlace::Gradients(&packets);
            SampledTexture::sample_all_flat(&[first, second], at, &mut together);
            for (colors, texture) in together.iter().zip([first, second]) {
                for lane in 0..LANES {
                    let got = colors.map(|channel| channel.0[lane].to_bits());
                    let expected = alone(texture, &varying, lane).map(f32::to_bits);
                    assert_eq!(got, expected, "{level:?}, round {round}, lane {lane}");
                }
            }
        }
    }
}
