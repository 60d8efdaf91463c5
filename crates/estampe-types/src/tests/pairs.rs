//! Packet pairs: lanes, masks and tables, and shaders that run two or four packets at a time.

use crate::shader::{AtATime, FragmentBatch, VertexOut};
use crate::{
    Bindings, FragmentIn, FragmentOut, Int, Pair, Program, Quad, Real, ShaderProgram, Vec2, Vec4,
    VertexIn, shader,
};
use estampe_simd::{LANES, Level, Packet};

const NUMBERS: Pair<Quad> = Pair(Quad([1.0, 2.0, 3.0, 4.0]), Quad([5.0, 6.0, 7.0, 8.0]));

#[test]
fn lanes_of_the_second_come_after_the_first() {
    assert_eq!(<Pair<Quad> as Real>::LANES, 8);
    let lanes: Vec<f32> = (0..8).map(|lane| NUMBERS.lane(lane)).collect();
    assert_eq!(lanes, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    let made = NUMBERS.with_lanes(|lane| lane as f32 + 1.0);
    assert_eq!(made, NUMBERS);
    assert_eq!(
        (5..8).map(|lane| NUMBERS.to_int().lane(lane)).sum::<i32>(),
        21
    );
}

#[test]
fn a_mask_has_a_bit_for_each_lane_of_both() {
    let mask = NUMBERS.lt(NUMBERS.splat(2.0)) | NUMBERS.gt(NUMBERS.splat(7.0));
    assert_eq!(<Pair<Quad> as Real>::mask_bits(mask), 0b1000_0001);
    for (limit, any) in [(1.0, false), (2.0, true), (8.0, true)] {
        let below = NUMBERS.lt(NUMBERS.splat(limit));
        assert_eq!(<Pair<Quad> as Real>::any(below), any, "below {limit}");
    }
    let above = NUMBERS.gt(NUMBERS.splat(7.5));
    assert!(<Pair<Quad> as Real>::any(above), "only in the second half");
}

#[test]
fn pairs_of_pairs_have_the_lanes_of_four_numbers() {
    type Four<R> = Pair<Pair<R>>;
    let four = Pair(NUMBERS, NUMBERS + 8.0);
    assert_eq!(<Four<Quad> as Real>::LANES, 16);
    assert!((0..16).all(|lane| four.lane(lane) == lane as f32 + 1.0));
    assert_eq!(four.with_lanes(|lane| lane as f32 + 1.0), four);
    let ends = four.lt(2.0) | four.gt(15.0);
    assert_eq!(<Four<Quad> as Real>::mask_bits(ends), 0x8001);
    assert!(<Four<Quad> as Real>::any(four.gt(15.5)), "only in the last");
    assert!(!<Four<Quad> as Real>::any(four.gt(16.0)));
}

#[test]
fn tables_are_read_by_both() {
    let table: Vec<u32> = (0..32).map(|n| n * n).collect();
    let index = NUMBERS.to_int();
    let corners = index.gather_square(&table, 10);
    for (corner, offset) in corners.into_iter().zip([0, 1, 10, 11]) {
        for lane in 0..8 {
            let at = lane as i32 + 1 + offset;
            assert_eq!(corner.lane(lane), at * at, "lane {lane} + {offset}");
        }
    }
    assert_eq!(index.gather(&table).lane(6), 49);
}

/// A shader that uses all inputs and writes all outputs.
struct StepsTowardsOne;

shader! {
    impl Shader for StepsTowardsOne {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, Vec2<R>> {
            VertexOut::new(Vec4::new(at.x, at.y, input.real(0.0), input.real(1.0)), at)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, at: Vec2<R>) -> FragmentOut<R> {
            let mut x = at.x;
            for _ in 0..64 {
                let below = x.lt(x.splat(1.0));
                if !R::any(below) {
                    break;
                }
                x = R::select(below, x + at.y, x);
            }
            let second = R::select(input.front_facing, input.position.x, x.ddx());
            FragmentOut::color(Vec4::new(x, at.x, at.y, second))
                .with_color(1, input.position)
                .with_depth(x * 0.25)
                .discard_unless(second.gt(x - 0.7))
        }
    }
}

/// The coverage and the output bits for some packets: shaded so many at a time, or as the level
/// does.
fn shade(at_a_time: Option<AtATime>, level: Level, count: usize) -> (Vec<u16>, Vec<u32>) {
    let numbers = |scalars: usize| -> Vec<Packet<f32>> {
        let number = |n: usize| (n * 7919 % 1009) as f32 / 1024.0 + 0.015_625;
        (0..count * scalars)
            .map(|packet| Packet(std::array::from_fn(|lane| number(packet * LANES + lane))))
            .collect()
    };
    let mut coverage: Vec<u16> = (0..count).map(|packet| 0xFFFF >> (packet % 5)).collect();
    let mut colors = vec![Packet([0.0; LANES]); count * 8];
    let mut depths = vec![Packet([0.0; LANES]); count];
    let front_facing: Vec<u16> = (0..count)
        .map(|packet| 0x35A7_u16.rotate_left(packet as u32))
        .collect();
    let program = ShaderProgram::new(StepsTowardsOne);
    let bindings = Bindings::default();
    let batch = FragmentBatch {
        varyings: &numbers(2),
        positions: &numbers(4),
        front_facing: &front_facing,
        coverage: &mut coverage,
        colors: &mut colors,
        depths: &mut depths,
        ..FragmentBatch::default()
    };
    match at_a_time {
        Some(packets) => program.run_fragments_by(packets, level, &bindings, batch),
        None => program.run_fragments(level, &bindings, batch),
    }
    let bits = colors
        .iter()
        .chain(&depths)
        .flat_map(|packet| packet.0)
        .map(f32::to_bits);
    (coverage, bits.collect())
}

#[test]
fn several_packets_at_a_time_give_the_bits_of_one() {
    // With `None` as the level does: four at a time and then two, two and then one, or one.
    assert!(ShaderProgram::new(StepsTowardsOne).loops_long());
    for count in [0, 1, 2, 4, 5, 11] {
        let expected = shade(Some(AtATime::One), Level::all_available()[0], count);
        for level in Level::all_available() {
            for packets in [
                Some(AtATime::One),
                Some(AtATime::Two),
                Some(AtATime::Four),
                None,
            ] {
                assert_eq!(
                    shade(packets, level, count),
                    expected,
                    "{count} packets at {level:?}, at a time: {packets:?}"
                );
            }
        }
        if count == 5 {
            let all: Vec<u16> = (0..5).map(|packet| 0xFFFF >> packet).collect();
            assert!(expected.0 != all && expected.0.iter().any(|&kept| kept != 0));
        }
    }
}
