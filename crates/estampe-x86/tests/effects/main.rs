//! Derivatives, memory and odd arguments: machine code against the interpreter.
#![cfg(target_arch = "x86_64")]

mod textures;

use estampe_ir::interface::{BufferSlot, Input, LocalArray, Output, Stage};
use estampe_ir::interpreter::{self, Buffer, InputData, OutputData, Run, Stopped, Textures, cells};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::{Atomic, Axis, Binary, Compare, Memory, Precision};
use estampe_ir::tree::Builder;
use estampe_ir::{Op, Value};
use estampe_simd::{LANES, Level, Packet};
use estampe_x86::{Code, CompileError, Isa, Scratch, Tier};
use fastrand::Rng;
use std::cell::Cell;
use std::sync::atomic::{AtomicU32, Ordering};

const PACKETS: usize = 5;

/// A way to run a kernel.
type Runner<'a> = &'a mut dyn FnMut(&Run<'_>) -> Result<(), Stopped>;

/// Runs a case in the interpreter, then in machine code of each kind, and compares what it leaves.
fn compare<T: PartialEq + std::fmt::Debug>(kernel: &Kernel, case: &mut dyn FnMut(Runner<'_>) -> T) {
    let interpreted = interpreter::Code::new(kernel);
    let mut registers = interpreter::Scratch::default();
    let wanted = case(&mut |run| interpreted.run(Level::best(), run, &mut registers));
    let mut scratch = Scratch::default();
    let mut tested = 0;
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for tier in [Tier::Fast, Tier::Optimised] {
            let code = Code::compile(kernel, isa, tier).unwrap();
            // The second run finds what the first one left in the scratch memory.
            for _ in 0..2 {
                let got = case(&mut |run| code.run(Level::best(), run, &mut scratch));
                assert_eq!(wanted, got, "{isa:?} {tier:?}");
                tested += 1;
            }
        }
    }
    assert!(tested > 0 || Isa::best().is_none());
}

/// Random floats and masks of a case.
struct Given {
    words: Vec<Packet<u32>>,
    masks: Vec<u16>,
}

impl Given {
    fn new(seed: u64, word: &mut dyn FnMut(&mut Rng) -> u32) -> Self {
        let random = &mut Rng::with_seed(seed);
        let mut words = vec![Packet([0; LANES]); PACKETS * 3];
        for packet in &mut words {
            packet.0.fill_with(|| word(random));
        }
        let masks = (0..PACKETS).map(|packet| match packet {
            0 => u16::MAX,
            1 => 0,
            _ => random.u16(..),
        });
        Self {
            words,
            masks: masks.collect(),
        }
    }

    fn inputs<'a>(&'a self, kernel: &Kernel) -> Vec<InputData<'a>> {
        let inputs = kernel.interface.inputs.iter();
        inputs
            .map(|input| match input {
                Input::Varying(at) => InputData::words(&self.words, *at as usize, 3),
                Input::FrontFacing | Input::Cover => InputData::Mask(&self.masks),
                Input::PushConstant(at) => InputData::Uniform(at + 4),
                other => panic!("no test has {other:?}"),
            })
            .collect()
    }
}

/// Runs with word outputs; returns them.
fn words_of(
    kernel: &Kernel,
    given: &Given,
    buffers: &[Buffer<'_>],
    textures: &dyn Textures,
    go: Runner<'_>,
) -> Vec<Packet<u32>> {
    let count = kernel.interface.outputs.len();
    let mut words = vec![Packet([0; LANES]); count * PACKETS];
    let out = cells(&mut words);
    let outputs: Vec<_> = (0..count)
        .map(|at| OutputData::words(out, at, count))
        .collect();
    let run = Run {
        inputs: &given.inputs(kernel),
        outputs: &outputs,
        buffers,
        textures,
        ..Run::new(PACKETS)
    };
    go(&run).unwrap();
    words
}

fn finish(builder: Builder, results: &[Value]) -> Kernel {
    let outputs = (0..).map(Output::Varying).zip(results.iter().copied());
    Kernel::from_tree(&builder.finish(outputs.collect()))
}

/// A mask as a word.
fn word_of_mask(builder: &mut Builder, mask: Value) -> Value {
    let [yes, no] = [builder.word(1), builder.word(0)];
    builder.select(mask, yes, no)
}

#[test]
fn derivatives_and_quads() {
    let mut b = Builder::new(Stage::Fragment);
    let value = b.input(Input::Varying(0));
    let mask = b.input(Input::FrontFacing);
    let always = b.mask(true);
    let mut results = Vec::new();
    for &axis in Axis::ALL {
        for &precision in Precision::ALL {
            for mask in [mask, always] {
                results.push(b.op1(Op::Derivative {
                    axis,
                    precision,
                    value,
                    mask,
                }));
            }
        }
    }
    for lane in 0..4 {
        for mask in [mask, always] {
            results.push(b.op1(Op::QuadLane { lane, value, mask }));
        }
    }
    let quads = b.op1(Op::QuadAny(mask));
    results.push(word_of_mask(&mut b, quads));
    let kernel = finish(b, &results);
    let given = Given::new(1, &mut |random| (random.f32() * 8.0 - 4.0).to_bits());
    compare(&kernel, &mut |go| {
        words_of(&kernel, &given, &[], &interpreter::NoTextures, go)
    });
}

fn written(b: &mut Builder) {
    b.interface_mut().buffers.push(BufferSlot {
        group: 0,
        binding: 0,
        is_written: true,
    });
}

#[test]
fn memory_changes_in_the_order_of_lanes() {
    let mut b = Builder::new(Stage::Compute);
    written(&mut b);
    let [offset, value, other] = [0, 1, 2].map(|at| b.input(Input::Varying(at)));
    let mask = b.input(Input::Cover);
    let memory = Memory::Buffer(0);
    let mut results = Vec::new();
    for &kind in Atomic::ALL {
        let before = b.op(Op::Atomic {
            kind,
            memory,
            offset,
            value,
            mask,
        });
        // The result of a store is not used.
        if kind != Atomic::Store {
            results.extend(before);
        }
        b.op(Op::StoreBuffer {
            buffer: 0,
            offset: other,
            value: offset,
            mask,
        });
    }
    // Code stores halves of words where nothing uses what was there before.
    b.op(Op::Atomic {
        kind: Atomic::StoreHalf,
        memory,
        offset,
        value: other,
        mask,
    });
    let exchanged = b.op(Op::CompareExchange {
        memory,
        offset,
        expected: other,
        value,
        mask,
    });
    results.push(exchanged[0]);
    results.push(word_of_mask(&mut b, exchanged[1]));
    results.push(b.op1(Op::LoadBuffer { buffer: 0, offset }));
    // The same offset in all lanes, of memory that changes.
    let uniform = b.input(Input::PushConstant(0));
    results.push(b.op1(Op::LoadBuffer {
        buffer: 0,
        offset: uniform,
    }));
    results.push(b.op1(Op::BufferBytes(0)));
    let kernel = finish(b, &results);
    // 11 words, of which the last one is not whole; offsets go beyond.
    let given = Given::new(2, &mut |random| match random.u32(0..20) {
        0 => random.u32(..),
        _ => random.u32(0..60),
    });
    compare(&kernel, &mut |go| {
        let words: Vec<AtomicU32> = (0..11).map(AtomicU32::new).collect();
        let buffers = [Buffer::shared(&words, 42)];
        let outputs = words_of(&kernel, &given, &buffers, &interpreter::NoTextures, go);
        let left: Vec<u32> = words
            .iter()
            .map(|word| word.load(Ordering::Relaxed))
            .collect();
        (outputs, left)
    });
    // A buffer that is bound for reading alone does not change.
    compare(&kernel, &mut |go| {
        let words: Vec<u32> = (0..11).collect();
        let buffers = [Buffer::read_only(&words, 44)];
        words_of(&kernel, &given, &buffers, &interpreter::NoTextures, go)
    });
}

#[test]
fn words_beyond_a_buffer_are_zeros() {
    let mut b = Builder::new(Stage::Fragment);
    b.interface_mut().buffers = vec![BufferSlot {
        group: 0,
        binding: 0,
        is_written: false,
    }];
    let mut results = Vec::new();
    for offset in [0, 4, 7, 20, 400, 1 << 20, u32::MAX] {
        let offset = b.word(offset);
        results.push(b.op1(Op::LoadBuffer { buffer: 0, offset }));
    }
    let varying = b.input(Input::Varying(0));
    let uniform = b.input(Input::PushConstant(3));
    for offset in [varying, uniform] {
        results.push(b.op1(Op::LoadBuffer { buffer: 0, offset }));
    }
    let kernel = finish(b, &results);
    let given = Given::new(3, &mut |random| random.u32(0..64));
    for bytes in [0, 3, 4, 6, 20, 24, 40] {
        compare(&kernel, &mut |go| {
            let words: Vec<u32> = (100..110).collect();
            let buffers = [Buffer::read_only(&words, bytes)];
            words_of(&kernel, &given, &buffers, &interpreter::NoTextures, go)
        });
    }
    compare(&kernel, &mut |go| {
        words_of(&kernel, &given, &[], &interpreter::NoTextures, go)
    });
}

#[test]
fn arrays_of_lanes() {
    let mut b = Builder::new(Stage::Fragment);
    b.interface_mut().locals = vec![
        LocalArray {
            words: 0,
            init: vec![9],
        },
        LocalArray {
            words: 6,
            init: vec![5, 6, 7],
        },
        LocalArray {
            words: 5,
            init: vec![1, 2, 3, 4],
        },
        LocalArray {
            words: 0,
            init: Vec::new(),
        },
    ];
    let [index, value, other] = [0, 1, 2].map(|at| b.input(Input::Varying(at)));
    let [mask, always] = [b.input(Input::FrontFacing), b.mask(true)];
    let [two, three, nine] = [2, 3, 9].map(|word| b.word(word));
    // The last array but one is a table; the first one has no words, and nor has the last.
    for array in [0, 1] {
        let stores = [
            (three, other, always),
            (index, value, mask),
            (two, value, mask),
            (nine, value, mask),
            (other, index, always),
            (nine, value, always),
        ];
        for (index, value, mask) in stores {
            b.op(Op::StoreLocal {
                array,
                index,
                value,
                mask,
            });
        }
    }
    let mut results = Vec::new();
    for array in [0, 1, 2, 3] {
        for index in [index, other, two, three, nine] {
            results.push(b.op1(Op::LoadLocal { array, index }));
        }
    }
    let kernel = finish(b, &results);
    let given = Given::new(4, &mut |random| match random.u32(0..10) {
        0 => random.u32(..),
        _ => random.u32(0..8),
    });
    compare(&kernel, &mut |go| {
        words_of(&kernel, &given, &[], &interpreter::NoTextures, go)
    });
}

#[test]
fn arguments_that_are_short_or_missing() {
    let mut b = Builder::new(Stage::Fragment);
    let [x, y, z] = [0, 1, 2].map(|at| b.input(Input::Varying(at)));
    let mask = b.input(Input::Cover);
    let facing = b.input(Input::FrontFacing);
    let uniform = b.input(Input::PushConstant(0));
    let sum = b.binary(Binary::Add, x, y);
    let sum = b.binary(Binary::Add, sum, z);
    let sum = b.binary(Binary::Add, sum, uniform);
    let chosen = b.select(facing, sum, x);
    let less = b.compare(Compare::ULt, x, y);
    let kept = b.op1(Op::MaskBinary(
        estampe_ir::op::MaskBinary::And,
        [mask, less],
    ));
    let outputs = vec![
        (Output::Varying(0), sum),
        (Output::Cover, kept),
        (Output::Varying(1), chosen),
        (Output::Varying(2), z),
    ];
    let kernel = Kernel::from_tree(&b.finish(outputs));
    let given = Given::new(6, &mut |random| random.u32(..));
    let floats: Vec<Packet<f32>> = (0..4).map(|at| Packet([at as f32; LANES])).collect();
    let inputs = [
        // A packet too few, of three.
        InputData::words(&given.words[..PACKETS * 3 - 4], 0, 3),
        InputData::floats(&floats, 1, usize::MAX / 2),
        InputData::Uniform(9),
    ];
    for count in 0..=6 {
        compare(&kernel, &mut |go| {
            let mut covers = given.masks.clone();
            let shared: &[Cell<u16>] = cells(&mut covers);
            let masks = [
                InputData::SharedMask(shared),
                InputData::Uniform(2),
                InputData::Mask(&[3]),
            ];
            // In the order in which the tree names them.
            let given: Vec<InputData<'_>> = kernel
                .interface
                .inputs
                .iter()
                .map(|input| match input {
                    Input::Varying(at) => inputs[*at as usize],
                    Input::Cover => masks[0],
                    Input::FrontFacing => masks[1 + count % 2],
                    _ => InputData::Uniform(4),
                })
                .take(count)
                .collect();
            let mut words = [0; 2].map(|_| vec![Packet([1; LANES]); PACKETS * 2]);
            // Where outputs share a place, the one that is kept is unspecified.
            let [first, second] = words.each_mut().map(|words| cells(words));
            let outputs = [
                OutputData::words(first, 0, 2),
                OutputData::Mask(&shared[..PACKETS - 1]),
                // Beyond the end from the fourth packet on.
                OutputData::words(second, 1, 3),
            ];
            let run = Run {
                inputs: &given,
                outputs: &outputs,
                ..Run::new(PACKETS)
            };
            go(&run).unwrap();
            (words, covers)
        });
    }
}

#[test]
fn loops_without_end_are_stopped() {
    let mut b = Builder::new(Stage::Fragment);
    let x = b.input(Input::Varying(0));
    let zero = b.word(0);
    let done = b.block(1);
    let again = b.start_loop(&[zero]);
    let counter = again.parameters[0];
    let is_over = b.compare(Compare::Eq, counter, x);
    b.start_if(is_over);
    b.branch(done, &[counter]);
    b.end_if();
    let one = b.word(1);
    let next = b.binary(Binary::Add, counter, one);
    b.branch(again.label, &[next]);
    b.end_loop();
    let result = b.end_block()[0];
    let kernel = finish(b, &[result]);
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for tier in [Tier::Fast, Tier::Optimised] {
            let code = Code::compile(&kernel, isa, tier).unwrap();
            let run_with = |word: u32, budget: u64| {
                let words = [Packet([word; LANES])];
                let run = Run {
                    inputs: &[InputData::words(&words, 0, 1), InputData::Mask(&[u16::MAX])],
                    budget,
                    ..Run::new(1)
                };
                code.run(Level::best(), &run, &mut Scratch::default())
            };
            assert_eq!(run_with(1000, 2000), Ok(()));
            assert_eq!(run_with(1000, 500), Err(Stopped::Budget));
            assert_eq!(run_with(u32::MAX, 1 << 20), Err(Stopped::Budget));
            assert_eq!(run_with(0, 0), Ok(()));
        }
    }
}

#[test]
fn threads_share_code() {
    const fn is_shared<T: Send + Sync>() {}
    is_shared::<Code>();
    const fn is_sent<T: Send>() {}
    is_sent::<Scratch>();
    let mut b = Builder::new(Stage::Vertex);
    let index = b.input(Input::VertexIndex);
    let square = b.binary(Binary::Mul, index, index);
    let kernel = finish(b, &[square]);
    let Some(isa) = Isa::best() else { return };
    let code = Code::compile(&kernel, isa, Tier::Fast).unwrap();
    std::thread::scope(|scope| {
        for thread in 0..4_u32 {
            let code = &code;
            scope.spawn(move || {
                let indices = [Packet([thread; LANES])];
                let mut squares = [Packet([0; LANES])];
                let run = Run {
                    inputs: &[InputData::words(&indices, 0, 1)],
                    outputs: &[OutputData::words(cells(&mut squares), 0, 1)],
                    ..Run::new(1)
                };
                code.run(Level::best(), &run, &mut Scratch::default())
                    .unwrap();
                assert_eq!(squares[0].0, [thread * thread; LANES]);
            });
        }
    });
}

#[test]
fn what_is_not_compiled_is_refused() {
    let Some(isa) = Isa::best() else { return };
    let mut b = Builder::new(Stage::Fragment);
    b.interface_mut().locals = vec![LocalArray {
        words: u32::MAX,
        init: vec![1],
    }];
    let index = b.input(Input::Varying(0));
    let value = b.op1(Op::LoadLocal { array: 0, index });
    let mask = b.mask(true);
    b.op(Op::StoreLocal {
        array: 0,
        index,
        value,
        mask,
    });
    let kernel = finish(b, &[value]);
    let refused = Code::compile(&kernel, isa, Tier::Fast).unwrap_err();
    assert_eq!(refused, CompileError::TooLarge);
}
