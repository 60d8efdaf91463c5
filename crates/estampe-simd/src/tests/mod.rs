//! Every operation of [`Lanes`], at every SIMD level, compared with scalar code.

#![expect(clippy::cast_possible_truncation, reason = "tests know their numbers")]

use super::*;

mod blocks;
mod lookup;
mod memory;

const ODD: [f32; 20] = [
    0.0,
    -0.0,
    0.5,
    -0.5,
    1.5,
    -1.5,
    2.5,
    1e-40,
    -1e-40,
    8_388_607.5,
    -8_388_607.5,
    8_388_608.0,
    1e30,
    -1e30,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    0.999_999_94,
    -2.0,
    4_194_303.5,
];

fn packets() -> impl Iterator<Item = ([f32; LANES], [f32; LANES])> {
    (0..ODD.len()).flat_map(|shift| {
        (0..ODD.len()).map(move |stride| {
            let mut pair = ([0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                pair.0[lane] = ODD[(lane + shift) % ODD.len()];
                pair.1[lane] = ODD[(lane * (stride + 1) + shift) % ODD.len()];
            }
            pair
        })
    })
}

/// The payload of a NaN is unspecified.
fn same(got: f32, expected: f32) -> bool {
    got.to_bits() == expected.to_bits() || got.is_nan() && expected.is_nan()
}

#[inline(always)]
fn min_max_floor<S: Lanes>(s: S, a: [f32; LANES], b: [f32; LANES]) -> [[f32; LANES]; 3] {
    let (a, b) = (f32x16::load_array(s, a), f32x16::load_array(s, b));
    [
        s.min_f32(a, b).to_array(),
        s.max_f32(a, b).to_array(),
        s.floor_f32(a).to_array(),
    ]
}

#[test]
fn min_max_and_floor_are_the_scalar_ones() {
    for level in Level::all_available() {
        for (a, b) in packets() {
            let [min, max, floor] = dispatch!(level, s => min_max_floor(s, a, b));
            for lane in 0..LANES {
                let (a, b) = (a[lane], b[lane]);
                assert!(
                    same(min[lane], if a < b { a } else { b }),
                    "{level:?} min({a}, {b})"
                );
                assert!(
                    same(max[lane], if a > b { a } else { b }),
                    "{level:?} max({a}, {b})"
                );
                assert!(same(floor[lane], a.floor()), "{level:?} floor({a})");
            }
        }
    }
}

#[inline(always)]
fn round<S: Lanes>(s: S, a: [f32; LANES]) -> [i32; LANES] {
    s.round_to_i32(f32x16::load_array(s, a)).to_array()
}

#[test]
fn rounding_is_to_nearest_even() {
    let mut values = [0.0; LANES];
    for (lane, value) in values.iter_mut().enumerate() {
        *value = lane as f32 * 0.25 - 2.0;
    }
    values[0] = 4_194_303.5;
    values[1] = -4_194_303.5;
    for level in Level::all_available() {
        let rounded = dispatch!(level, s => round(s, values));
        for (rounded, value) in rounded.into_iter().zip(values) {
            assert_eq!(rounded as f32, value.round_ties_even(), "{level:?} {value}");
        }
    }
}

#[inline(always)]
fn permuted<S: Lanes>(s: S, value: [u32; LANES], order: [u32; LANES]) -> [[u32; LANES]; 2] {
    let (value, order) = (u32x16::load_array(s, value), u32x16::load_array(s, order));
    let floats: u32x16<S> = s.permute_f32(value.bitcast(), order).bitcast();
    [s.permute(value, order).to_array(), floats.to_array()]
}

#[test]
fn permutations_take_the_low_four_bits_of_the_order() {
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 4
    };
    for level in Level::all_available() {
        for _ in 0..200 {
            let (value, order) = ([0; LANES].map(|_| random()), [0; LANES].map(|_| random()));
            let expected = order.map(|at| value[at as usize % LANES]);
            let found = dispatch!(level, s => permuted(s, value, order));
            assert_eq!(found, [expected; 2], "{order:?} at {}", level.name());
        }
    }
}

#[inline(always)]
fn permuted_in_window<S: Lanes>(
    s: S,
    values: &[f32; LANES],
    order: [u32; LANES],
) -> Option<[f32; LANES]> {
    let window = Window::new(s, u32x16::load_array(s, order))?;
    Some(window.permute_f32(s, values).to_array())
}

#[test]
fn windows_hold_eight_neighbours_of_each_half() {
    let mut values = [0.0; LANES];
    for (value, number) in values.iter_mut().zip(0u8..) {
        *value = f32::from(number) * 1.25;
    }
    let mut state = 3u32;
    let mut random = |below: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) % below
    };
    for level in Level::all_available() {
        for _ in 0..1000 {
            let first = [random(16), random(16)];
            let reach = 1 + random(10);
            let mut order = [0; LANES];
            let mut is_window = true;
            for (lane, at) in order.iter_mut().enumerate() {
                let first = first[lane / 8];
                *at = (first + if lane % 8 == 0 { 0 } else { random(reach) }).min(15);
                is_window &= *at - first.min(8) < 8;
            }
            let found = dispatch!(level, s => permuted_in_window(s, &values, order));
            match found {
                Some(found) => assert_eq!(found, order.map(|at| values[at as usize])),
                None => assert!(!is_window || level.name() != "avx2", "{order:?}"),
            }
        }
    }
}

#[test]
fn bits_are_listed_in_ascending_order() {
    for level in Level::all_available() {
        for bits in 0..=u16::MAX {
            let mut out = [u32::MAX; LANES];
            let count = dispatch!(level, s => s.list_bits(bits, 96, &mut out));
            let expected: Vec<u32> = (0..16).filter(|bit| bits >> bit & 1 == 1).collect();
            let expected: Vec<u32> = expected.into_iter().map(|bit| 96 + bit).collect();
            assert_eq!(out[..count], expected, "{bits:#x} at {}", level.name());
        }
    }
}

#[test]
fn bits_of_words_are_listed_in_ascending_order() {
    let mut state = 7_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state ^ state >> 16
    };
    for level in Level::all_available() {
        for turn in 0..2000 {
            let bits = match turn {
                0 => 0,
                1 => u32::MAX,
                _ if turn % 2 == 0 => random() & random(),
                _ => random() | random(),
            };
            let mut out = [u16::MAX; 32];
            let count = dispatch!(level, s => s.list_bits_of_word(bits, 992, &mut out));
            let expected: Vec<u16> = (0..32).filter(|bit| bits >> bit & 1 == 1).collect();
            let expected: Vec<u16> = expected.into_iter().map(|bit| 992 + bit).collect();
            assert_eq!(out[..count], expected, "{bits:#x} at {}", level.name());
            let half = out.first_chunk().unwrap();
            let wide = dispatch!(level, s => s.widen(half).to_array());
            assert_eq!(wide, half.map(u32::from), "{}", level.name());
        }
    }
}

#[inline(always)]
fn packed<S: Lanes>(s: S, lanes: u16, values: [u32; LANES]) -> (usize, [[u32; LANES]; 2]) {
    let packing = Packing::new(s, lanes);
    let mut order = [0; LANES];
    packing.store_order(&mut order);
    let packing = Packing::load(s, &order, lanes);
    let values = u32x16::load_array(s, values);
    let (mut words, mut floats) = ([u32::MAX; LANES], [0.0; LANES]);
    packing.store(s, values, &mut words);
    packing.store_f32(s, values.bitcast(), &mut floats);
    (packing.count(), [words, floats.map(f32::to_bits)])
}

#[test]
fn lanes_are_packed_in_their_order() {
    let mut values = [0; LANES];
    for (value, number) in values.iter_mut().zip(1..) {
        *value = number * 0x0101_0101;
    }
    for level in Level::all_available() {
        for lanes in (0..=u16::MAX).step_by(5) {
            let of_lanes = (0..LANES).filter(|lane| lanes >> lane & 1 == 1);
            let expected: Vec<u32> = of_lanes.map(|lane| values[lane]).collect();
            let (count, found) = dispatch!(level, s => packed(s, lanes, values));
            for found in found {
                assert_eq!(found[..count], expected, "{lanes:#x} at {}", level.name());
            }
        }
    }
}

#[inline(always)]
fn replaced<S: Lanes>(s: S, lanes: u16, old: [u32; LANES], new: [u32; LANES]) -> [[u32; LANES]; 4] {
    let (mut by_bits, mut by_mask) = (old, old);
    let (mut floats_by_bits, mut floats_by_mask) =
        (old.map(f32::from_bits), old.map(f32::from_bits));
    let (new, mask) = (u32x16::load_array(s, new), s.mask_from_bits(lanes));
    s.replace(&mut by_bits, lanes, new);
    s.replace_masked(&mut by_mask, mask, new);
    s.replace_f32(&mut floats_by_bits, lanes, new.bitcast());
    s.replace_masked_f32(&mut floats_by_mask, mask, new.bitcast());
    [
        by_bits,
        by_mask,
        floats_by_bits.map(f32::to_bits),
        floats_by_mask.map(f32::to_bits),
    ]
}

#[test]
fn the_lanes_of_a_mask_are_replaced() {
    let (mut old, mut new) = ([0; LANES], [0; LANES]);
    for (lane, (old, new)) in (1u32..).zip(old.iter_mut().zip(&mut new)) {
        (*old, *new) = (lane * 0x0123_4567, lane * 0x0765_4321);
    }
    for level in Level::all_available() {
        for lanes in (0..=u16::MAX).step_by(13).chain([u16::MAX]) {
            let mut expected = old;
            for (lane, expected) in expected.iter_mut().enumerate() {
                if lanes >> lane & 1 == 1 {
                    *expected = new[lane];
                }
            }
            let found = dispatch!(level, s => replaced(s, lanes, old, new));
            assert_eq!(found, [expected; 4], "{lanes:#x} at {}", level.name());
        }
    }
}

#[inline(always)]
fn round_trip<S: Lanes>(s: S, bits: u16) -> u16 {
    let signs = s.sign_bits(signs(s, bits));
    let bits = s.bits_of_mask(s.mask_from_bits(bits));
    assert_eq!(signs, bits);
    bits
}

/// Numbers whose sign bits are given.
#[inline(always)]
fn signs<S: Lanes>(s: S, bits: u16) -> i32x16<S> {
    let mut numbers = [0; LANES];
    for (lane, number) in numbers.iter_mut().enumerate() {
        let large = [0, 1, 0x8000, 0x1_0000, i32::MAX][lane % 5];
        *number = if bits >> lane & 1 == 1 { !large } else { large };
    }
    i32x16::load_array(s, numbers)
}

#[test]
fn masks_keep_their_bits() {
    for level in Level::all_available() {
        for bits in (0..=u16::MAX).step_by(257) {
            assert_eq!(
                dispatch!(level, s => round_trip(s, bits)),
                bits,
                "{level:?}"
            );
        }
    }
}

#[test]
fn lanes_are_in_morton_order() {
    for lane in 0..LANES as u8 {
        let x = (lane & 1) | (lane >> 1 & 2);
        let y = (lane >> 1 & 1) | (lane >> 2 & 2);
        assert_eq!(
            (LANE_X[lane as usize], LANE_Y[lane as usize]),
            (x, y),
            "lane {lane}"
        );
    }
}

#[test]
fn levels_are_found_by_name() {
    let scalar = Level::named("scalar").map(Level::name);
    #[cfg(scalar_level)]
    assert_eq!(scalar, Ok("scalar"));
    #[cfg(not(scalar_level))]
    assert!(matches!(
        scalar,
        Err(LevelError::NotBuiltIn { name: "scalar", .. })
    ));
    assert_eq!(
        Level::named("auto").map(Level::name),
        Ok(Level::best().name())
    );
    assert!(matches!(
        Level::named("avx9000"),
        Err(LevelError::Unknown(_))
    ));
    #[cfg(target_arch = "x86_64")]
    assert!(matches!(
        Level::named("neon"),
        Err(LevelError::Missing { name: "neon", .. })
    ));
}

#[test]
fn a_packet_is_uniform_if_no_lane_differs() {
    assert!(Packet([7_u32; LANES]).is_uniform() && Packet([-7_i32; LANES]).is_uniform());
    for lane in 0..LANES {
        let mut packet = Packet([-1_i32; LANES]);
        packet.0[lane] = i32::MAX;
        assert!(!packet.is_uniform(), "lane {lane}");
    }
}
