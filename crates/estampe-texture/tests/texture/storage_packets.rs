//! Packets of texels of storage textures are stored and loaded as lanes are, one by one.

use estampe_simd::{LANES, Level, Packet};
use estampe_texture::{
    TexelDescriptor, create_storage_texture, is_storable, load_packet, storage_bytes, storage_load,
    storage_store, store_packet,
};
use estampe_types::{Limits, StorageTexture, TextureDimension, TextureFormat, Vec4};

/// Two textures of zeros with these sides.
fn textures(
    format: TextureFormat,
    (dimension, [width, height, slices]): (TextureDimension, [u32; 3]),
) -> [StorageTexture; 2] {
    let descriptor = TexelDescriptor {
        dimension,
        depth_or_layers: slices,
        ..TexelDescriptor::new_2d(width, height, format)
    };
    let limits = Limits::default();
    [(); 2].map(|()| create_storage_texture(&descriptor, None, &limits).unwrap())
}

/// Coordinates around a side, some far outside.
fn coordinates(random: &mut fastrand::Rng, side: u32) -> Packet<i32> {
    let side = side.cast_signed();
    Packet(std::array::from_fn(|_| match random.u8(..12) {
        0 => random.i32(..),
        _ => random.i32(-1..=side),
    }))
}

/// Numbers in and around the range of normalised formats, or any bits, as of integers and NaN.
fn numbers(random: &mut fastrand::Rng) -> Packet<f32> {
    let are_bits = random.bool();
    Packet(std::array::from_fn(|_| match random.u8(..8) {
        _ if are_bits => f32::from_bits(random.u32(..) >> random.u32(..32)),
        0 => f32::from_bits(random.u32(..)),
        _ => random.f32() * 3.0 - 1.5,
    }))
}

#[test]
fn packets_are_those_of_lanes() {
    let mut random = fastrand::Rng::with_seed(41);
    let (mut by_packets, mut inside, mut formats) = (0, 0, 0);
    for &format in TextureFormat::ALL.iter().filter(|one| is_storable(**one)) {
        formats += 1;
        for shape in [
            (TextureDimension::D2, [13, 9, 1]),
            (TextureDimension::D2, [5, 7, 3]),
            (TextureDimension::D3, [6, 3, 4]),
            (TextureDimension::D1, [17, 1, 1]),
        ] {
            for level in Level::all_available() {
                let [stored, wanted] = textures(format, shape);
                for _ in 0..8 {
                    let at = shape.1.map(|side| coordinates(&mut random, side));
                    let texels = [(); 4].map(|()| numbers(&mut random));
                    let mask = random.u16(..);
                    let places = at.each_ref();
                    if !store_packet(&stored, level, (places, mask), texels.each_ref()) {
                        assert!(!level.is_specialized());
                        continue;
                    }
                    by_packets += 1;
                    let mut loaded = [Packet([7.0; LANES]); 4];
                    assert!(load_packet(&stored, level, places, &mut loaded));
                    for lane in 0..LANES {
                        let place = at.each_ref().map(|axis| axis.0[lane]);
                        let [r, g, b, a] = texels.each_ref().map(|channel| channel.0[lane]);
                        let is_set = mask >> lane & 1 == 1;
                        storage_store(&wanted, is_set, place, Vec4::new(r, g, b, a));
                        inside += u32::from(is_set && wanted.index(place).is_some());
                    }
                    for lane in 0..LANES {
                        let place = at.each_ref().map(|axis| axis.0[lane]);
                        let expected = crate::array(storage_load(&wanted, place));
                        let got = loaded.each_ref().map(|channel| channel.0[lane]);
                        assert_eq!(
                            got.map(f32::to_bits),
                            expected.map(f32::to_bits),
                            "{format:?} at {}",
                            level.name()
                        );
                    }
                }
                let name = level.name();
                let [stored, wanted] = [stored, wanted].map(|one| storage_bytes(&one));
                let has_packets = level.is_specialized();
                assert!(!has_packets || stored == wanted, "{format:?} at {name}");
            }
        }
    }
    assert!(formats > 30, "{formats} formats");
    let has_packets = Level::all_available()
        .into_iter()
        .any(Level::is_specialized);
    assert!(
        !has_packets || by_packets > 1000 && inside > 3000,
        "{by_packets} packets, {inside} texels"
    );
}
