//! The time of a fragment in the interpreter: Blinn-Phong with two lights, about 300 operations.
//!
//! `cargo run --release -p estampe-ir --example interpreter_speed [SIMD level]`

#![expect(clippy::print_stdout, reason = "the program prints its measurements")]

mod lit_fragment;

use estampe_ir::interface::Input;
use estampe_ir::interpreter::{Buffer, Code, InputData, OutputData, Run, Scratch, cells};
use estampe_ir::lanes::Kernel;
use estampe_simd::{LANES, Level, Packet};
use lit_fragment::blinn_phong;
use std::time::Instant;

/// Packets of a call: those of a tile of 64 by 64 pixels.
const PACKETS: usize = 256;

fn main() {
    let kernel = Kernel::from_tree(&blinn_phong());
    let ops: usize = kernel.blocks.iter().map(|block| block.ops.len()).sum();
    let begin = Instant::now();
    let code = Code::new(&kernel);
    let compiled = begin.elapsed();
    let [instructions, registers] = code.size();
    println!(
        "{ops} operations, {instructions} instructions, {registers} registers, {compiled:?} to compile"
    );
    let mut random = fastrand::Rng::with_seed(1);
    let packet = |_| Packet([(); LANES].map(|()| random.f32() + 0.1));
    let varyings: Vec<Packet<f32>> = (0..PACKETS * 9).map(packet).collect();
    let uniforms: Vec<u32> = (0..64).map(|k| (k as f32 * 0.125).to_bits()).collect();
    let inputs: Vec<InputData<'_>> = kernel
        .interface
        .inputs
        .iter()
        .map(|input| match input {
            Input::Varying(at) => InputData::floats(&varyings, *at as usize, 9),
            _ => InputData::Uniform(1),
        })
        .collect();
    let mut colors = vec![Packet([0.0; LANES]); PACKETS * 4];
    let colors = cells(&mut colors);
    let outputs = [0, 1, 2, 3].map(|at| OutputData::floats(colors, at, 4));
    let buffers = [Buffer::read_only(&uniforms, 256)];
    let run = Run {
        inputs: &inputs,
        outputs: &outputs,
        buffers: &buffers,
        ..Run::new(PACKETS)
    };
    let mut scratch = Scratch::default();
    let chosen = std::env::args().nth(1);
    for level in Level::all_available() {
        if chosen.as_ref().is_some_and(|name| name != level.name()) {
            continue;
        }
        for chunk in [1, 2, 4, 8, 16] {
            let code = code.clone().with_chunk(chunk);
            let mut best = f64::INFINITY;
            for _ in 0..200 {
                let begin = Instant::now();
                code.run(level, &run, &mut scratch).expect("no loops");
                best = best.min(begin.elapsed().as_secs_f64());
            }
            let fragment = best * 1e9 / (PACKETS * LANES) as f64;
            let level = level.name();
            println!("{level:8} {chunk:2} packets an operation: {fragment:6.2} ns a fragment");
        }
    }
}
