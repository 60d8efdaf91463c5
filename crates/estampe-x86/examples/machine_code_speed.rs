//! The time of a fragment in machine code, and the time that it takes to make it: Blinn-Phong with
//! two lights, about 300 operations.
//!
//! `cargo run --release -p estampe-x86 --example machine_code_speed`

#![expect(clippy::print_stdout, reason = "the program prints its measurements")]

#[path = "../../estampe-ir/examples/lit_fragment/mod.rs"]
mod lit_fragment;

use estampe_ir::interface::Input;
use estampe_ir::interpreter::{self, Buffer, InputData, OutputData, Run, cells};
use estampe_ir::lanes::Kernel;
use estampe_simd::{LANES, Level, Packet};
use estampe_x86::{Code, Isa, Scratch, Tier};
use lit_fragment::blinn_phong;
use std::time::Instant;

/// Packets of a call: those of a tile of 64 by 64 pixels.
const PACKETS: usize = 256;

/// The shortest of many times, in nanoseconds.
fn best(times: usize, mut work: impl FnMut()) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..times {
        let begin = Instant::now();
        work();
        best = best.min(begin.elapsed().as_secs_f64() * 1e9);
    }
    best
}

fn main() {
    let kernel = Kernel::from_tree(&blinn_phong());
    let ops: usize = kernel.blocks.iter().map(|block| block.ops.len()).sum();
    println!("{ops} operations");
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
    let level = Level::best();
    let fragments = |packets: usize| (packets * LANES) as f64;
    let interpreted = interpreter::Code::new(&kernel);
    let mut registers = interpreter::Scratch::default();
    let time = best(200, || {
        interpreted
            .run(level, &run, &mut registers)
            .expect("no loops");
    });
    println!(
        "interpreter: {:.2} ns a fragment",
        time / fragments(PACKETS)
    );
    let mut scratch = Scratch::default();
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for tier in [Tier::Fast, Tier::Optimised] {
            let make = || Code::compile(&kernel, isa, tier).expect("an available instruction set");
            let made = best(100, || drop(make()));
            let code = make();
            let run_of = |packets: usize| Run { packets, ..run };
            let [many, few] = [PACKETS, 1].map(|packets| {
                let run = run_of(packets);
                // The clock takes longer than a packet.
                let calls = PACKETS / packets;
                let time = best(2000, || {
                    for _ in 0..calls {
                        code.run(level, &run, &mut scratch).expect("no loops");
                    }
                });
                time / fragments(PACKETS)
            });
            println!(
                "{:7}{tier:?}: {many:.2} ns a fragment, {few:.2} in calls of one packet; {:.0} µs to \
                 compile, {} bytes",
                isa.name(),
                made / 1e3,
                code.instructions().len(),
            );
        }
    }
}
