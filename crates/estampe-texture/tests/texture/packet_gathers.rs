//! Gathers of sixteen lanes give the bits that each lane gives alone, and need the scalar code for
//! borders alone.

use super::Random;
use super::offsets::{Asked, has_borders, has_packet_code, sampled_of};
use super::requests::bits;
use estampe_simd::{LANES, Level, Packet};
use estampe_texture::{TextureFormat, ViewDimension};

#[test]
fn lanes_are_gathered_as_alone() {
    use ViewDimension as V;
    let random = &mut Random::new(52);
    let (mut without_borders, mut outside, mut inside) = (0, 0, 0);
    let [mut passed, mut failed] = [0; 2];
    for &format in TextureFormat::ALL {
        for dimension in [V::D2, V::D2Array] {
            for round in 0..12 {
                let Some(sampled) = sampled_of(format, dimension, random) else {
                    break;
                };
                let is_compared = sampled.sampler().compare.is_some();
                let channel = (!is_compared || round % 3 == 0).then_some(round % 5);
                let asked = Asked::new(&sampled, random);
                let alone = asked.one_by_one(|request, texels| match channel {
                    Some(channel) => sampled.gather_request(request, channel, texels),
                    None => sampled.gather_compare_request(request, texels),
                });
                for level in Level::all_available() {
                    let sampled = sampled.clone().at_level(level);
                    let mut texels = [Packet([7.0; LANES]); 4];
                    let again = sampled.gather_by_packet(&asked.request(), channel, &mut texels);
                    let has_code = has_packet_code(format) && !level.is_scalar();
                    assert_eq!(again.is_some(), has_code, "{format:?} {}", level.name());
                    let Some(again) = again else {
                        continue;
                    };
                    if has_borders(&sampled, 2) {
                        outside += again.count_ones();
                        inside += again.count_zeros() - 16;
                    } else {
                        assert_eq!(again, 0, "{format:?} {:?}", sampled.sampler());
                        without_borders += 1;
                    }
                    assert_eq!(
                        bits(&texels),
                        bits(&alone),
                        "{format:?} {dimension:?} {:?}, channel {channel:?} at {}: {:?}, {:?}",
                        sampled.view().size(0),
                        level.name(),
                        asked.request(),
                        sampled.sampler()
                    );
                    let results = texels.iter().flat_map(|packet| packet.0);
                    for result in results.filter(|_| channel.is_none()) {
                        passed += u32::from(result == 1.0);
                        failed += u32::from(result == 0.0);
                    }
                    let mut again = [Packet([7.0; LANES]); 4];
                    match channel {
                        Some(channel) => {
                            sampled.gather_request(&asked.request(), channel, &mut again);
                        }
                        None => sampled.gather_compare_request(&asked.request(), &mut again),
                    }
                    assert_eq!(bits(&again), bits(&texels));
                }
            }
        }
    }
    assert!(
        without_borders > 500 && outside > 1000 && inside > 1000,
        "{without_borders} {outside} {inside}"
    );
    assert!(passed > 500 && failed > 500, "{passed} {failed}");
}

/// Packet code is for images: cubes continue across their edges, and lines and volumes give zeros.
#[test]
fn other_dimensions_are_gathered_one_by_one() {
    let random = &mut Random::new(53);
    for dimension in [ViewDimension::D1, ViewDimension::D3] {
        let sampled = sampled_of(TextureFormat::R32Float, dimension, random);
        let sampled = sampled.expect("numbers have all dimensions");
        let asked = Asked::new(&sampled, random);
        let mut texels = [Packet([7.0; LANES]); 4];
        let again = sampled.gather_by_packet(&asked.request(), Some(0), &mut texels);
        assert_eq!(again, None);
        sampled.gather_request(&asked.request(), 0, &mut texels);
        assert_eq!(texels, [Packet::default(); 4]);
    }
}
