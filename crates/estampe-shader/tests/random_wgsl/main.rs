//! Random programs in WGSL give what their statements mean: one invocation at a time, interpreted
//! in lanes at every SIMD level, and as machine code of every instruction set and tier.

mod evaluate;
mod generate;
mod program;
mod write;

use estampe_ir::interface::{Input, Output};
use estampe_ir::interpreter::{self, InputData, OutputData, Run, Stopped, cells};
use estampe_ir::lanes::{self, Kernel};
use estampe_ir::op::TextureOp;
use estampe_ir::tree::{self, Surroundings, Tree};
use estampe_shader::front::{Options, Source, load};
use estampe_shader::lower::lower;
use estampe_simd::{LANES, Level, Packet};
use estampe_x86::{Code, Isa, Scratch, Tier};
use evaluate::Seen;
use fastrand::Rng;
use std::ops::Range;
use std::time::{Duration, Instant};

/// Two run together where code runs pairs, and one alone.
const PACKETS: usize = 3;
const FRAGMENTS: usize = PACKETS * LANES;
/// Jumps backwards: far more than a program makes.
const BUDGET: u64 = 1 << 24;

type Words = [u32; 4];

/// A fragment whose varyings are four numbers.
struct Fragment<'a> {
    tree: &'a Tree,
    varyings: [f32; 4],
    none: Vec<u32>,
}

impl Surroundings for Fragment<'_> {
    fn input(&mut self, at: usize) -> u32 {
        match self.tree.interface.inputs[at] {
            Input::Varying(scalar) => self.varyings[scalar as usize].to_bits(),
            Input::Cover => 1,
            other => panic!("{other:?} is not given"),
        }
    }
    fn buffer(&mut self, _at: usize) -> &mut Vec<u32> {
        &mut self.none
    }
    fn workgroup(&mut self) -> &mut Vec<u32> {
        &mut self.none
    }
    fn texture(&mut self, _op: &TextureOp, _operands: &[u32]) -> Vec<u32> {
        Vec::new()
    }
}

/// The colour of one invocation.
fn alone(tree: &Tree, varyings: [f32; 4]) -> Words {
    let mut fragment = Fragment {
        tree,
        varyings,
        none: Vec::new(),
    };
    let words = tree::evaluate(tree, &mut fragment, BUDGET).expect("it ends");
    [0, 1, 2, 3].map(|component| {
        let color = Output::Color {
            target: 0,
            component,
        };
        let at = tree.interface.outputs.iter().position(|one| *one == color);
        words[at.expect("a colour")]
    })
}

/// The colours of all fragments, of a run.
fn in_lanes(
    kernel: &Kernel,
    varyings: &[[f32; 4]],
    mut execute: impl FnMut(&Run<'_>) -> Result<(), Stopped>,
) -> Vec<Words> {
    let packets: Vec<_> = (0..PACKETS * 4)
        .map(|at| {
            Packet(std::array::from_fn(|lane| {
                varyings[at / 4 * LANES + lane][at % 4]
            }))
        })
        .collect();
    let inputs = kernel.interface.inputs.iter().map(|input| match *input {
        Input::Varying(scalar) => InputData::floats(&packets, scalar as usize, 4),
        Input::Cover => InputData::Uniform(1),
        other => panic!("{other:?} is not given"),
    });
    let inputs: Vec<_> = inputs.collect();
    let mut colors = [Packet([0; LANES]); PACKETS * 4];
    let to = cells(&mut colors);
    let outputs = kernel.interface.outputs.iter().map(|output| match *output {
        Output::Color { component, .. } => OutputData::words(to, component as usize, 4),
        _ => OutputData::Dropped,
    });
    let outputs: Vec<_> = outputs.collect();
    execute(&Run {
        inputs: &inputs,
        outputs: &outputs,
        budget: BUDGET,
        ..Run::new(PACKETS)
    })
    .expect("it ends");
    (0..FRAGMENTS)
        .map(|at| [0, 1, 2, 3].map(|k: usize| colors[at / LANES * 4 + k].0[at % LANES]))
        .collect()
}

/// Small numbers, which reach every case, and some that are not.
fn varyings(random: &mut Rng) -> Vec<[f32; 4]> {
    let mut number = || match random.u32(0..8) {
        0 => [0.0, -0.0, f32::INFINITY, f32::NAN, 3e9, -3e9][random.usize(..6)],
        1 => random.f32() * 1e6 - 5e5,
        2 | 3 => random.f32() * 2.0 - 1.0,
        #[expect(clippy::cast_precision_loss, reason = "small numbers")]
        _ => random.i32(-4..8) as f32,
    };
    (0..FRAGMENTS).map(|_| [0; 4].map(|_| number())).collect()
}

fn check(seed: u64, seen: &mut Seen) {
    let random = &mut Rng::with_seed(seed);
    let program = generate::program(random);
    let inputs = varyings(random);
    let text = write::wgsl(&program);
    seen.steps = 0;
    let wanted: Option<Vec<Words>> = inputs
        .iter()
        .map(|varyings| evaluate::evaluate(&program, *varyings, seen))
        .collect();
    let Some(wanted) = wanted else {
        return;
    };
    let module = load(Source::Wgsl(&text), &Options::default());
    let module = module.unwrap_or_else(|errors| panic!("seed {seed}: {errors}\n{text}"));
    let stage = lower(&module.module, &module.info, 0);
    let tree = stage
        .unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"))
        .tree;
    tree::verify(&tree).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
    let compare = |what: &str, got: &[Words]| {
        for (at, (wanted, got)) in wanted.iter().zip(got).enumerate() {
            let inputs = inputs[at];
            assert_eq!(
                wanted, got,
                "seed {seed}, {what}, fragment {at} of {inputs:?}\n{text}"
            );
        }
    };
    let one_by_one: Vec<_> = inputs
        .iter()
        .map(|varyings| alone(&tree, *varyings))
        .collect();
    compare("one by one", &one_by_one);
    let kernel = Kernel::from_tree(&tree);
    lanes::verify(&kernel).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
    let bytecode = interpreter::Code::new(&kernel);
    for level in Level::all_available() {
        let mut scratch = interpreter::Scratch::default();
        let got = in_lanes(&kernel, &inputs, |run| {
            bytecode.run(level, run, &mut scratch)
        });
        compare(level.name(), &got);
    }
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for tier in [Tier::Fast, Tier::Optimised] {
            let code = Code::compile(&kernel, isa, tier);
            let code = code.unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
            let mut scratch = Scratch::default();
            let got = in_lanes(&kernel, &inputs, |run| {
                code.run(Level::best(), run, &mut scratch)
            });
            compare(&format!("{isa:?} {tier:?}"), &got);
        }
    }
}

#[test]
fn random_programs_give_what_their_statements_mean() {
    let mut seen = Seen::default();
    for seed in 0..200 {
        check(seed, &mut seen);
    }
    let counts = [
        seen.breaks,
        seen.continues,
        seen.early_returns,
        seen.lazy,
        seen.calls,
        seen.cases,
    ];
    assert!(counts.iter().all(|count| *count > 300), "{seen:?}");
}

/// Seconds between two lines of progress.
const REPORT: Duration = Duration::from_secs(5);

/// `RANDOM_WGSL=FIRST..END` chooses which of the programs run, so that processes can share them.
/// Lines of progress are printed with `--nocapture`.
#[test]
#[ignore = "takes a quarter of an hour in a release build: a hundred thousand programs"]
fn random_programs_give_what_their_statements_mean_at_length() {
    let range = std::env::var("RANDOM_WGSL").unwrap_or_else(|_| "0..100000".to_owned());
    let range = range_of(&range).expect("RANDOM_WGSL is a range of numbers, as in 0..50000");
    let mut seen = Seen::default();
    let began = Instant::now();
    let mut reported = began;
    for number in range.clone() {
        check(1 << 32 | u64::from(number), &mut seen);
        if reported.elapsed() >= REPORT {
            reported = Instant::now();
            report(number + 1 - range.start, range.len(), began.elapsed());
        }
    }
    report(range.end - range.start, range.len(), began.elapsed());
    assert!(seen.calls > 0, "{seen:?}");
}

fn report(done: u32, of: usize, elapsed: Duration) {
    eprintln!("{done} of {of} programs, {} s", elapsed.as_secs());
}

/// The range that is written `FIRST..END`, if it is one and is not empty.
fn range_of(text: &str) -> Option<Range<u32>> {
    let (first, end) = text.split_once("..")?;
    let range = first.trim().parse().ok()?..end.trim().parse().ok()?;
    (range.start < range.end).then_some(range)
}

#[test]
fn ranges_are_read() {
    assert_eq!(range_of("20..30"), Some(20..30));
    for wrong in ["", "20", "30..30", "30..20", "a..b", "0..4294967296"] {
        assert_eq!(range_of(wrong), None, "{wrong}");
    }
}
