//! Random trees and their kernels: the verifier accepts them, and their texts are read back.
//! Kernels in which something was exchanged are refused, or run without a panic.

#[path = "random_trees/generate.rs"]
mod generate;

use estampe_ir::Value;
use estampe_ir::interface::Input;
use estampe_ir::interpreter::{Buffer, Code, InputData, Run, Scratch};
use estampe_ir::lanes::{self, BlockId, Kernel, Terminator};
use estampe_ir::{text, tree};
use estampe_simd::{Level, Packet};
use fastrand::Rng;
use std::sync::atomic::AtomicU32;

fn kernel(random: &mut Rng) -> (tree::Tree, Kernel) {
    let (tree, _) = generate::tree(random);
    let kernel = Kernel::from_tree(&tree);
    (tree, kernel)
}

#[test]
fn texts_are_read_back() {
    let mut random = Rng::with_seed(23);
    let mut blocks = 0;
    for turn in 0..300 {
        let (tree, kernel) = kernel(&mut random);
        lanes::verify(&kernel).unwrap_or_else(|error| panic!("turn {turn}: {error}\n{kernel}"));
        let again = text::tree(&tree.to_string()).expect("a text of a tree");
        assert_eq!(again.to_string(), tree.to_string());
        tree::verify(&again).expect("the same tree");
        let again = text::kernel(&kernel.to_string()).expect("a text of a kernel");
        assert_eq!(again.to_string(), kernel.to_string());
        assert_eq!(again, with_normal_results(kernel));
        blocks += again.blocks.len();
    }
    assert!(blocks > 1000, "{blocks}");
}

/// Gives operations without results the value 0, as texts do.
fn with_normal_results(mut kernel: Kernel) -> Kernel {
    for (op, first) in kernel.blocks.iter_mut().flat_map(|block| &mut block.ops) {
        if op.results().is_empty() {
            *first = Value(0);
        }
    }
    kernel
}

#[test]
fn broken_kernels_are_refused_or_run() {
    let mut random = Rng::with_seed(29);
    let (mut refused, mut ran) = (0, 0);
    for _ in 0..1500 {
        let (_, mut kernel) = kernel(&mut random);
        for _ in 0..random.u32(1..3) {
            damage(&mut kernel, &mut random);
        }
        if lanes::verify(&kernel).is_err() {
            refused += 1;
            continue;
        }
        let level = random.choice(Level::all_available()).expect("a level");
        run(&kernel, level);
        ran += 1;
    }
    assert!(refused > 300 && ran > 100, "{refused} {ran}");
}

fn damage(kernel: &mut Kernel, random: &mut Rng) {
    let values = u32::try_from(kernel.values.len()).expect("few values");
    let value = Value(random.u32(0..values + 2));
    let blocks = u32::try_from(kernel.blocks.len()).expect("few blocks");
    let at = random.usize(0..kernel.blocks.len());
    let block = &mut kernel.blocks[at];
    match random.u32(0..7) {
        0 | 1 if !block.ops.is_empty() => {
            let at = random.usize(0..block.ops.len());
            let (op, _) = &mut block.ops[at];
            op.each_operand_mut(|operand, _| *operand = value);
        }
        2 if block.ops.len() > 1 => {
            let (a, b) = (
                random.usize(0..block.ops.len()),
                random.usize(0..block.ops.len()),
            );
            block.ops.swap(a, b);
        }
        3 => {
            for jump in block.terminator.jumps_mut() {
                jump.to = BlockId(random.u32(0..=blocks));
            }
        }
        4 => {
            for argument in block
                .terminator
                .jumps_mut()
                .flat_map(|jump| &mut jump.arguments)
            {
                *argument = value;
            }
        }
        5 => {
            let info = &mut kernel.values[random.usize(0..values as usize)];
            info.is_uniform = !info.is_uniform;
        }
        _ => match &mut block.terminator {
            Terminator::Branch { mask, any, none } => {
                *mask = value;
                std::mem::swap(any, none);
            }
            Terminator::Return(values) => values.iter_mut().for_each(|one| *one = value),
            Terminator::Jump(_) => {}
        },
    }
}

fn run(kernel: &Kernel, level: Level) {
    let index = [Packet(std::array::from_fn(|lane| {
        u32::try_from(lane).expect("few")
    }))];
    let inputs = kernel.interface.inputs.iter().map(|input| match input {
        Input::Cover => InputData::Mask(&[0x7FF3]),
        Input::LocalInvocationIndex => InputData::words(&index, 0, 1),
        _ => InputData::Uniform(3),
    });
    let inputs: Vec<_> = inputs.collect();
    let written: Vec<AtomicU32> = (0..64).map(AtomicU32::new).collect();
    let buffers = [
        Buffer::read_only(&[1, 2, 3], 12),
        Buffer::shared(&written, 250),
    ];
    let run = Run {
        inputs: &inputs,
        buffers: &buffers,
        budget: 10_000,
        ..Run::new(2)
    };
    // Exchanged jumps may make endless loops.
    let _ended = Code::new(kernel).run(level, &run, &mut Scratch::default());
}
