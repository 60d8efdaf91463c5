//! Tests of the interpreter.

mod flow;
mod listing;
mod memory;
mod ops;
mod textures;

use super::{Code, InputData, OutputData, Run, Scratch, cells};
use crate::interface::{Input, Interface, Output, Stage};
use crate::lanes::{BasicBlock, Kernel, Terminator, ValueInfo, verify};
use crate::{Op, Type, Value};
use estampe_simd::{LANES, Level, Packet};

/// The kernel of a text.
fn parsed(text: &str) -> Kernel {
    let kernel = crate::text::kernel(text).unwrap();
    verify(&kernel).unwrap();
    kernel
}

/// A kernel of one block: values are the inputs, then the results of the operations, and all
/// results of the last one are outputs.
fn straight(inputs: &[Input], ops: Vec<Op>) -> Kernel {
    let mut kernel = Kernel {
        stage: Stage::Fragment,
        interface: Interface {
            inputs: inputs.to_vec(),
            ..Interface::default()
        },
        values: Vec::new(),
        blocks: Vec::new(),
    };
    let mut block = BasicBlock {
        parameters: Vec::new(),
        ops: Vec::new(),
        terminator: Terminator::Return(Vec::new()),
    };
    let reads = (0..).zip(inputs).map(|(at, input)| match input.kind() {
        Type::Word => Op::Input(at),
        Type::Mask => Op::InputMask(at),
    });
    let mut results = Vec::new();
    for op in reads.chain(ops) {
        let first = Value(u32::try_from(kernel.values.len()).unwrap());
        let kinds = op.results();
        results = first.and_next(kinds.len());
        let mut is_uniform = match op {
            Op::Input(at) | Op::InputMask(at) => inputs[at as usize].is_uniform(),
            _ => true,
        };
        op.each_operand(|value, _| is_uniform &= kernel.values[value.index()].is_uniform);
        let info = |&kind: &Type| ValueInfo { kind, is_uniform };
        kernel.values.extend(kinds.iter().map(info));
        block.ops.push((op, first));
    }
    for (at, result) in (0..).zip(&results) {
        let output = match kernel.values[result.index()].kind {
            Type::Word => Output::Varying(at),
            Type::Mask => Output::Cover,
        };
        kernel.interface.outputs.push(output);
    }
    block.terminator = Terminator::Return(results);
    kernel.blocks.push(block);
    kernel
}

/// The words of each input in all lanes; masks are 0 and 1.
type Lanes = Vec<Vec<u32>>;

/// Runs a kernel on lanes, and returns the outputs.
fn run(code: &Code, kernel: &Kernel, level: Level, inputs: &Lanes) -> Lanes {
    let packets = inputs.first().map_or(1, |words| words.len() / LANES);
    let words: Vec<Vec<Packet<u32>>> = inputs.iter().map(|words| packed(words)).collect();
    let masks: Vec<Vec<u16>> = inputs.iter().map(|words| mask_bits(words)).collect();
    let given: Vec<InputData<'_>> = (0..inputs.len())
        .map(|at| {
            let input = kernel.interface.inputs[at];
            match input.kind() {
                Type::Word if input.is_uniform() => InputData::Uniform(inputs[at][0]),
                Type::Word => InputData::words(&words[at], 0, 1),
                Type::Mask => InputData::Mask(&masks[at]),
            }
        })
        .collect();
    let count = kernel.interface.outputs.len();
    let mut words = vec![Packet([0xDEAD_BEEF; LANES]); count * packets];
    let mut masks = vec![0; packets];
    let (words_out, masks_out) = (cells(&mut words), cells(&mut masks));
    let outputs: Vec<OutputData<'_>> = (0..count)
        .map(|at| match kernel.interface.outputs[at].kind() {
            Type::Word => OutputData::words(words_out, at, count),
            Type::Mask => OutputData::Mask(masks_out),
        })
        .collect();
    let run = Run {
        inputs: &given,
        outputs: &outputs,
        ..Run::new(packets)
    };
    code.run(level, &run, &mut Scratch::default()).unwrap();
    let of_output = |at: usize| match kernel.interface.outputs[at].kind() {
        Type::Word => (0..packets)
            .flat_map(|packet| words[packet * count + at].0)
            .collect(),
        Type::Mask => (0..packets * LANES)
            .map(|lane| u32::from(masks[lane / LANES] >> (lane % LANES) & 1))
            .collect(),
    };
    (0..count).map(of_output).collect()
}

fn packed(words: &[u32]) -> Vec<Packet<u32>> {
    let packets = words.as_chunks::<LANES>().0.iter();
    packets.map(|words| Packet(*words)).collect()
}

fn mask_bits(words: &[u32]) -> Vec<u16> {
    let packets = words.as_chunks::<LANES>().0.iter();
    packets
        .map(|words| {
            (0..LANES).fold(0, |bits, lane| {
                bits | u16::from(words[lane] & 1 == 1) << lane
            })
        })
        .collect()
}
