//! Accesses to textures: operands, results and masks.

use super::parsed;
use crate::interpreter::{
    Code, InputData, OutputData, Run, Scratch, TextureAccess, Textures, cells,
};
use crate::op::TextureQuery;
use estampe_simd::{LANES, Level, Packet};
use std::cell::RefCell;

/// A texture whose results are sums of the operands, each times a number of its own.
#[derive(Debug, Default)]
struct Sums {
    stored: RefCell<Vec<u32>>,
}

impl Textures for Sums {
    fn access(&self, mut access: TextureAccess<'_>) {
        let coordinates = access.op.coordinates.len();
        let named = [
            access.layer(),
            access.level_of_detail(),
            access.reference(),
            access.sample(),
        ];
        let coordinates = (0..coordinates).map(|at| Some(access.coordinate(at)));
        let gradients = [0, 1].map(|axis| access.gradient(axis, 0));
        let operands: Vec<_> = coordinates.chain(named).chain(gradients).collect();
        for packet in 0..access.packets {
            for lane in 0..LANES {
                if access.mask[packet] >> lane & 1 == 0 {
                    continue;
                }
                let digits = operands
                    .iter()
                    .map(|operand| operand.map_or(0, |words| words[packet].0[lane]));
                let sum = digits.fold(0, |sum: u32, digit| {
                    sum.wrapping_mul(10).wrapping_add(digit)
                });
                if access.op.query == TextureQuery::Store {
                    let word = access.stored(3)[packet].0[lane];
                    self.stored.borrow_mut().push(sum * 10 + word);
                }
                for at in 0..access.results() {
                    let result = sum.wrapping_add(u32::try_from(at).unwrap() << 28);
                    access.result_mut(at)[packet].0[lane] = result;
                }
            }
        }
    }
}

/// Runs a kernel whose inputs are the lane's number, a uniform 3, and a mask; outputs are 0, 1 …
fn run(text: &str, level: Level, cover: &[u16], textures: &Sums) -> Vec<Vec<u32>> {
    let header = "kernel fragment
        input varying(0) input push_constant(0) input cover
        output varying(0) output varying(1)
        texture_at 0.0 sampler_at 0.1
        b0: v0 = input 0 uv1 = input 1 m2 = input_mask 2 ";
    let kernel = parsed(&format!("{header}{text}"));
    let packets = cover.len();
    let lanes: Vec<Packet<u32>> = (0..packets)
        .map(|_| {
            Packet(std::array::from_fn(|lane| {
                u32::try_from(lane % 10).unwrap()
            }))
        })
        .collect();
    let mut results = vec![Packet([0; LANES]); 2 * packets];
    let outputs = cells(&mut results);
    let outputs = [0, 1].map(|at| OutputData::words(outputs, at, 2));
    let run = Run {
        inputs: &[
            InputData::words(&lanes, 0, 1),
            InputData::Uniform(3),
            InputData::Mask(cover),
        ],
        outputs: &outputs,
        textures,
        ..Run::new(packets)
    };
    let code = Code::new(&kernel);
    code.run(level, &run, &mut Scratch::default()).unwrap();
    let output = |at: usize| {
        (0..packets)
            .flat_map(|packet| results[packet * 2 + at].0)
            .collect()
    };
    [0, 1].map(output).to_vec()
}

/// Lanes in the mask have these results.
fn assert_lanes(found: &[u32], cover: &[u16], expected: impl Fn(u32) -> u32) {
    for (at, &word) in found.iter().enumerate() {
        if cover[at / LANES] >> (at % LANES) & 1 == 1 {
            let lane = u32::try_from(at % LANES % 10).unwrap();
            assert_eq!(word, expected(lane), "lane {at}");
        }
    }
}

const COVER: [u16; 3] = [0xFFFF, 0x0F30, 0];

#[test]
fn accesses_are_given_their_operands_and_give_their_results() {
    for level in Level::all_available() {
        let sums = Sums::default();
        let found = run(
            "uv3 = const 7
             v4, v5, v6, v7 = texture sample of 0 sampler 0 at (v0, uv1) layer uv3 bias v0 in m2
             v8 = texture sample_compare of 0 sampler 0 at (uv3) level uv1 reference v0 in m2
             v9 = add v7, v8
             return v4, v9",
            level,
            &COVER,
            &sums,
        );
        // Digits: two coordinates, layer, level; neither reference, sample nor gradients.
        let sample = |lane: u32| (lane * 1000 + 3 * 100 + 7 * 10 + lane) * 10_000;
        assert_lanes(&found[0], &COVER, sample);
        assert_lanes(&found[1], &COVER, |lane| {
            // A coordinate, no layer, the level, the reference.
            let compared = (7 * 1000 + 3 * 10 + lane) * 1000;
            sample(lane).wrapping_add(3 << 28).wrapping_add(compared)
        });
        let found = run(
            "v3, v4, v5, v6 = texture sample of 0 sampler 0 at (uv1) gradient (v0) (uv1) in m2
             v7, v8, v9, v10 = texture load of 0 at (v0) index uv1 in m2
             return v3, v7",
            level,
            &COVER,
            &sums,
        );
        assert_lanes(&found[0], &COVER, |lane| 3_000_000 + lane * 10 + 3);
        assert_lanes(&found[1], &COVER, |lane| lane * 1_000_000 + 300);
        assert!(sums.stored.borrow().is_empty());
    }
}

/// A load that is the same in all running lanes counts in the first of them.
#[test]
fn uniform_results_are_those_of_a_lane_that_runs() {
    for level in Level::all_available() {
        for cover in [[0xFFFF], [0x8000], [0x0010]] {
            let found = run(
                "uv3, uv4, uv5, uv6 = texture load of 0 at (uv1) in m2
                 uv7 = const 1
                 uv8 = add uv3, uv7
                 return uv8, uv4",
                level,
                &cover,
                &Sums::default(),
            );
            assert_eq!(found[0], [3_000_001; LANES]);
            assert_eq!(found[1], [3_000_000 + (1 << 28); LANES]);
        }
    }
}

#[test]
fn stores_are_in_the_order_of_lanes() {
    for level in Level::all_available() {
        let sums = Sums::default();
        run(
            "texture store of 0 at (v0) stored (uv1, uv1, uv1, v0) in m2
             texture store of 0 at (uv1) stored (uv1, uv1, uv1, uv1) in m2
             return v0, v0",
            level,
            &[0x0022, 0x8000],
            &sums,
        );
        let [one, three, five] = [1, 3, 5].map(|digit| digit * 10_000_000 + digit);
        let expected = [one, five, three, three, five, three];
        assert_eq!(*sums.stored.borrow(), expected);
    }
}
