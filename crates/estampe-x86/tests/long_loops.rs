//! Kernels with long loops, of which a pass runs two packets with AVX2, too, against the
//! interpreter.
#![cfg(target_arch = "x86_64")]

use estampe_ir::interface::{BufferSlot, Input, Output, Stage};
use estampe_ir::interpreter::{self, Buffer, InputData, OutputData, Run, cells};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::{Axis, Binary, Compare, Math, Precision, Unary};
use estampe_ir::tree::Builder;
use estampe_ir::{Op, Value};
use estampe_simd::{LANES, Level, Packet};
use estampe_x86::{Code, Isa, Scratch, Tier};
use fastrand::Rng;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// The operations of a loop.
const OPERATIONS: usize = 100;

/// The words of the buffer.
const WORDS: u32 = 32;

/// A word that is made of two others: integers, floats, choices, neighbours, or, if there may be
/// calls, what code does not do itself.
fn operation(random: &mut Rng, b: &mut Builder, [x, y]: [Value; 2], has_calls: bool) -> Value {
    let cover = b.input(Input::Cover);
    match random.u8(..if has_calls { 12 } else { 9 }) {
        0 => b.binary(Binary::Add, x, y),
        1 => b.binary(Binary::Xor, x, y),
        2 => b.binary(Binary::Mul, x, y),
        3 => {
            let mask = b.compare(Compare::SLt, x, y);
            b.select(mask, y, x)
        }
        4 => b.op1(Op::Derivative {
            axis: Axis::X,
            precision: Precision::Fine,
            value: x,
            mask: cover,
        }),
        5 => {
            let float = b.unary(Unary::F32FromS32, x);
            let (sine, scale) = (b.math(Math::Sin, float), b.float(1e4));
            let result = b.binary(Binary::FMul, sine, scale);
            b.unary(Unary::S32FromF32, result)
        }
        6 | 7 => {
            let floats = [x, y].map(|word| b.unary(Unary::F32FromS32, word));
            let kinds = [Binary::FAdd, Binary::FMul, Binary::FMin, Binary::FDiv];
            let result = b.binary(kinds[random.usize(..kinds.len())], floats[0], floats[1]);
            b.unary(Unary::S32FromF32, result)
        }
        8 => {
            let four = b.word(4);
            let offset = b.binary(Binary::And, x, four);
            b.op1(Op::LoadBuffer { buffer: 0, offset })
        }
        9 => b.unary(Unary::ReverseBits, x),
        10 => b.unary(Unary::CountOnes, x),
        _ => b.binary(Binary::UDiv, x, y),
    }
}

/// A loop whose lanes end at different times, and a store, if there is one, of which the last one
/// counts where several are to the same word.
fn kernel(random: &mut Rng, (has_calls, has_store): (bool, bool)) -> Kernel {
    let mut b = Builder::new(Stage::Fragment);
    for is_written in [false, true] {
        b.interface_mut().buffers.push(BufferSlot {
            group: 0,
            binding: u32::from(is_written),
            is_written,
        });
    }
    let mask = b.input(Input::Cover);
    let inputs = [0, 1].map(|at| b.input(Input::Varying(at)));
    let [zero, one, three] = [0, 1, 3].map(|word| b.word(word));
    let limit = b.binary(Binary::And, inputs[0], three);
    let done = b.block(2);
    let open = b.start_loop(&[inputs[0], inputs[1], zero]);
    let [first, second, counter] = [0, 1, 2].map(|at| open.parameters[at]);
    let is_over = b.compare(Compare::ULt, limit, counter);
    b.start_if(is_over);
    b.branch(done, &[first, second]);
    b.end_if();
    let mut words = vec![inputs[0], inputs[1], first, second];
    for _ in 0..OPERATIONS {
        // Each needs the one before, so that all are needed.
        let last = words.len() - 1;
        let pair = [last, random.usize(last.saturating_sub(9)..last)].map(|at| words[at]);
        words.push(operation(random, &mut b, pair, has_calls));
    }
    let next = b.binary(Binary::Add, counter, one);
    b.branch(
        open.label,
        &[words[words.len() - 1], words[words.len() - 2], next],
    );
    b.end_loop();
    let results = b.end_block();
    if has_store {
        let places = b.word(WORDS * 8 - 4);
        let offset = b.binary(Binary::And, inputs[1], places);
        b.op(Op::StoreBuffer {
            buffer: 1,
            offset,
            value: results[0],
            mask,
        });
    }
    let outputs = [0, 1].map(Output::Varying).into_iter();
    Kernel::from_tree(&b.finish(outputs.zip(results).collect()))
}

/// The outputs and the written words of so many packets.
fn run_with(packets: usize, seed: u64, go: &mut dyn FnMut(&Run<'_>)) -> Vec<u32> {
    let mut random = Rng::with_seed(seed);
    let inputs: Vec<Packet<u32>> = (0..packets * 2)
        .map(|_| Packet([(); LANES].map(|()| random.u32(..) >> random.u32(..32))))
        .collect();
    let covers: Vec<u16> = (0..packets).map(|_| random.u16(..)).collect();
    let mut found = vec![Packet([0; LANES]); packets * 2];
    let written: Vec<AtomicU32> = (0..WORDS).map(|_| AtomicU32::new(7)).collect();
    let outputs = cells(&mut found);
    go(&Run {
        inputs: &[
            InputData::Mask(&covers),
            InputData::words(&inputs, 0, 2),
            InputData::words(&inputs, 1, 2),
        ],
        outputs: &[
            OutputData::words(outputs, 0, 2),
            OutputData::words(outputs, 1, 2),
        ],
        buffers: &[
            Buffer::read_only(&[3, 5, 8], 12),
            Buffer::shared(&written, WORDS as usize * 4),
        ],
        ..Run::new(packets)
    });
    let words = found.iter().flat_map(|packet| packet.0);
    words
        .chain(written.iter().map(|word| word.load(Relaxed)))
        .collect()
}

#[test]
fn two_packets_of_a_pass_do_what_each_does_alone() {
    let mut random = Rng::with_seed(11);
    for round in 0..24 {
        let has = (round % 2 == 1, round % 3 > 0);
        let kernel = kernel(&mut random, has);
        let definition = interpreter::Code::new(&kernel);
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            let code = Code::compile(&kernel, isa, Tier::Optimised).unwrap();
            assert!(code.runs_pairs(), "{isa:?} {kernel}");
            let mut scratch = Scratch::default();
            for packets in 1..6 {
                let wanted = run_with(packets, round, &mut |run| {
                    let mut registers = interpreter::Scratch::default();
                    definition.run(Level::best(), run, &mut registers).unwrap();
                });
                let found = run_with(packets, round, &mut |run| {
                    code.run(Level::best(), run, &mut scratch).unwrap();
                });
                assert_eq!(found, wanted, "{isa:?}, {packets} packets: {kernel}");
            }
        }
    }
}

/// Two packets of short loops have too few registers with AVX2.
#[test]
fn short_loops_run_packets_one_by_one_with_avx2() {
    if !Isa::Avx2.is_available() {
        return;
    }
    let kernel = estampe_ir::text::kernel(
        "
kernel fragment
input varying(0)
output color(0, 0)
b0:
  v0 = input 0
  uv1 = const 1.0
  uv2 = const 8.0
  jump b1(v0)
b1(v3):
  m4 = flt v3, uv2
  um5 = any m4
  branch um5 ? b2 : b3
b2:
  v6 = fadd v3, uv1
  jump b1(v6)
b3:
  return v3
",
    );
    let code = Code::compile(&kernel.unwrap(), Isa::Avx2, Tier::Optimised).unwrap();
    assert!(!code.runs_pairs());
}
