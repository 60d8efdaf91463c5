//! Machine code of random kernels against the interpreter.
#![cfg(target_arch = "x86_64")]

#[allow(
    unreachable_pub,
    clippy::cast_possible_truncation,
    reason = "a file of the tests of another crate"
)]
#[path = "../../estampe-ir/tests/random_trees/generate.rs"]
mod generate;

use estampe_ir::interface::Input;
use estampe_ir::interpreter::{self, Buffer, InputData, OutputData, Run, Stopped, cells};
use estampe_ir::lanes::Kernel;
use estampe_simd::{Level, Packet};
use estampe_x86::{Code, Isa, Scratch, Tier};
use fastrand::Rng;
use generate::{Made, OWN_WORDS, tree};
use std::sync::atomic::{AtomicU32, Ordering};

const PACKETS: usize = 3;
const LANES: usize = 16;
const INVOCATIONS: usize = PACKETS * LANES;

/// What a run is given.
struct Case {
    uniforms: [u32; 3],
    cover: [u16; PACKETS],
    read: Vec<u32>,
}

/// What a run leaves: the outputs of each invocation, and memory.
#[derive(Debug, PartialEq)]
struct Left {
    outputs: Vec<Vec<u32>>,
    written: Vec<u32>,
}

impl Case {
    fn new(random: &mut Rng) -> Self {
        let word = |random: &mut Rng| match random.u32(0..3) {
            0 => random.u32(0..5),
            1 => (random.f32() * 8.0 - 4.0).to_bits(),
            _ => random.u32(..),
        };
        Self {
            uniforms: [0; 3].map(|_| word(random)),
            cover: [0; PACKETS].map(|_| {
                if random.bool() {
                    u16::MAX
                } else {
                    random.u16(..)
                }
            }),
            read: (0..9).map(|_| word(random)).collect(),
        }
    }

    fn run(&self, kernel: &Kernel, go: &mut dyn FnMut(&Run<'_>) -> Result<(), Stopped>) -> Left {
        let index = |packet: usize, lane: usize| u32::try_from(packet * LANES + lane).unwrap();
        let indices: Vec<Packet<u32>> = (0..PACKETS)
            .map(|packet| Packet(std::array::from_fn(|lane| index(packet, lane))))
            .collect();
        let inputs = kernel.interface.inputs.iter().map(|input| match *input {
            Input::LocalInvocationIndex => InputData::words(&indices, 0, 1),
            Input::PushConstant(at) => InputData::Uniform(self.uniforms[at as usize]),
            Input::Cover => InputData::Mask(&self.cover),
            other => panic!("the trees have no input {other:?}"),
        });
        let inputs: Vec<_> = inputs.collect();
        let count = kernel.interface.outputs.len();
        let mut results = vec![Packet([0; LANES]); count * PACKETS];
        let outputs = cells(&mut results);
        let outputs: Vec<_> = (0..count)
            .map(|at| OutputData::words(outputs, at, count))
            .collect();
        let zero = || AtomicU32::new(0);
        let written: Vec<_> = std::iter::repeat_with(zero)
            .take(INVOCATIONS * OWN_WORDS as usize)
            .collect();
        let buffers = [
            Buffer::read_only(&self.read, self.read.len() * 4),
            Buffer::shared(&written, written.len() * 4),
        ];
        let run = Run {
            inputs: &inputs,
            outputs: &outputs,
            buffers: &buffers,
            ..Run::new(PACKETS)
        };
        go(&run).expect("they all end");
        let of_lane = |at: usize| {
            let of_output = |output: usize| results[at / LANES * count + output].0[at % LANES];
            (0..count).map(of_output).collect()
        };
        Left {
            outputs: (0..INVOCATIONS).map(of_lane).collect(),
            written: written
                .iter()
                .map(|word| word.load(Ordering::Relaxed))
                .collect(),
        }
    }

    fn is_covered(&self, invocation: usize) -> bool {
        self.cover[invocation / LANES] >> (invocation % LANES) & 1 == 1
    }
}

fn check(seed: u64) -> Made {
    let random = &mut Rng::with_seed(seed);
    let (tree, made) = tree(random);
    let case = Case::new(random);
    let kernel = Kernel::from_tree(&tree);

    let interpreted = interpreter::Code::new(&kernel);
    let wanted = case.run(&kernel, &mut |run| {
        interpreted.run(Level::best(), run, &mut interpreter::Scratch::default())
    });
    let mut scratch = Scratch::default();
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for tier in [Tier::Fast, Tier::Optimised] {
            let code = Code::compile(&kernel, isa, tier)
                .unwrap_or_else(|error| panic!("seed {seed}, {isa:?} {tier:?}: {error}"));
            let got = case.run(&kernel, &mut |run| {
                code.run(Level::best(), run, &mut scratch)
            });
            assert_eq!(
                wanted.written, got.written,
                "seed {seed}, {isa:?} {tier:?}: memory"
            );
            for (at, (wanted, got)) in wanted.outputs.iter().zip(&got.outputs).enumerate() {
                if case.is_covered(at) {
                    assert_eq!(
                        wanted, got,
                        "seed {seed}, {isa:?} {tier:?}: invocation {at}"
                    );
                }
            }
        }
    }
    made
}

/// Rows: none yet; the control flow of the shader compiler.
#[test]
fn random_kernels_give_what_the_interpreter_gives() {
    let (first, count) = match std::env::var("ESTAMPE_SEEDS") {
        Ok(range) => {
            let (first, count) = range.split_once('+').expect("FIRST+COUNT");
            (first.parse().unwrap(), count.parse().unwrap())
        }
        Err(_) => (0, 300),
    };
    let mut total = Made::default();
    for seed in first..first + count {
        let made = check(seed);
        total.ifs += made.ifs;
        total.loops += made.loops;
        total.early_branches += made.early_branches;
        total.stores += made.stores;
    }
    if count >= 300 {
        assert!(total.ifs > 300 && total.loops > 100, "{total:?}");
        assert!(total.early_branches > 20 && total.stores > 100, "{total:?}");
    }
}
