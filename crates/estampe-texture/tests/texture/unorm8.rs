//! Packets of 8-bit texels are loaded and stored as those of all formats are.

use estampe_simd::{
    Bytes, LANES, Lanes, Level, SimdBase, dispatch, f32x16, i32x16, mask32x16, u32x16,
};
use estampe_texture::{
    MipGeneration, TexelDescriptor, TexelView, create_storage_texture, create_texture,
    storage_bytes, storage_store, store_unorm8,
};
use estampe_types::{Limits, TextureFormat, Vec4};

const SIDES: [u32; 2] = [13, 9];

fn bits<S: Lanes>(texels: [f32x16<S>; 4]) -> [[u32; LANES]; 4] {
    let mut all = [[0; LANES]; 4];
    for (channel, to) in texels.into_iter().zip(&mut all) {
        let words: u32x16<S> = channel.bitcast();
        words.store_array(to);
    }
    all
}

fn check<S: Lanes>(s: S, random: &mut fastrand::Rng, inside: &mut u32) {
    let [width, height] = SIDES;
    let bytes: Vec<u8> = (0..width * height * 4).map(|_| random.u8(..)).collect();
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm] {
        let descriptor = TexelDescriptor::new_2d(width, height, format);
        let limits = Limits::default();
        let none = MipGeneration::None;
        let texture = create_texture(width, height, format, &bytes, none, &limits).unwrap();
        let view = TexelView::of(texture).unwrap();
        let (words, sides) = view.unorm8_words().unwrap();
        assert_eq!((words, sides), (&view.texture().texels[..], SIDES));
        let stored = [(); 2].map(|()| create_storage_texture(&descriptor, None, &limits).unwrap());
        let zero = <i32x16<S> as SimdBase<S>>::splat(s, 0);
        for _ in 0..20 {
            let [x, y] = [(); 2].map(|()| {
                let lanes: [i32; LANES] = std::array::from_fn(|_| match random.u32(0..12) {
                    0 => random.i32(..),
                    _ => random.i32(-2..15),
                });
                i32x16::load_array(s, lanes)
            });
            let found = view.load_unorm8(s, [x, y]).unwrap();
            let wanted = view.fetch([x, y, zero], zero, zero);
            let wanted = bits([wanted.x, wanted.y, wanted.z, wanted.w]);
            assert_eq!(bits(found), wanted);
            *inside += u32::from(wanted.concat().iter().any(|word| *word != 0));
            let channels = [(); 4].map(|()| {
                let lanes: [f32; LANES] = std::array::from_fn(|_| match random.u32(0..12) {
                    0 => f32::from_bits(random.u32(..)),
                    _ => random.f32() * 1.2 - 0.1,
                });
                f32x16::load_array(s, lanes)
            });
            let mask = random.u16(..);
            assert!(store_unorm8(s, &stored[0], ([x, y], mask), channels));
            let lanes: mask32x16<S> = s.mask_from_bits(mask);
            let [r, g, b, a] = channels;
            storage_store(&stored[1], lanes, [x, y, zero], Vec4::new(r, g, b, a));
        }
        assert_eq!(storage_bytes(&stored[0]), storage_bytes(&stored[1]));
    }
}

#[test]
fn packets_are_those_of_the_code_for_all_formats() {
    let mut random = fastrand::Rng::with_seed(8);
    let mut inside = 0;
    for level in Level::all_available() {
        dispatch!(level, s => check(s, &mut random, &mut inside));
    }
    assert!(inside > 10);
}
