//! Sines in loops, which take fewer steps where all angles are small, against the interpreter.
#![cfg(target_arch = "x86_64")]

use estampe_ir::interpreter::{self, InputData, OutputData, Run, cells};
use estampe_ir::lanes::Kernel;
use estampe_ir::text;
use estampe_simd::{LANES, Level, Packet};
use estampe_x86::{Code, Isa, Scratch, Tier};

const PACKETS: usize = 65;

/// Two sines in each of eight iterations, of which one is of a product with a power of two.
const KERNEL: &str = "
kernel fragment
input varying(0)
input varying(1)
output color(0, 0)
b0:
  v0 = input 0
  v1 = input 1
  uv2 = const 0
  uv3 = const 8
  uv4 = const 1
  uv5 = const 2.0
  jump b1(uv2, v0)
b1(uv6, v7):
  um8 = ult uv6, uv3
  branch um8 ? b2 : b3
b2:
  v9 = fmul v7, uv5
  v10 = sin v9
  v11 = fadd v1, v7
  v12 = sin v11
  v13 = fadd v10, v12
  v14 = fmul v13, v1
  uv15 = add uv6, uv4
  jump b1(uv15, v14)
b3:
  return v7
";

/// Numbers around the bounds of small angles, and those that have no angle.
fn number(random: &mut fastrand::Rng, has_large: bool) -> f32 {
    let small = random.f32().mul_add(8.0, -4.0);
    match random.u8(..12) {
        0 if has_large => f32::from_bits(random.u32(..)),
        1 if has_large => random.f32().mul_add(0.01, 1.0) * 65536.0 * std::f32::consts::PI,
        2 if has_large => -65535.5 * std::f32::consts::PI,
        3 => small * 100.0,
        4 => small * f32::MIN_POSITIVE,
        5 => -0.0,
        _ => small,
    }
}

fn run_with(inputs: &[Packet<f32>], go: &mut dyn FnMut(&Run<'_>)) -> Vec<u32> {
    let mut found = vec![Packet([0; LANES]); PACKETS];
    go(&Run {
        inputs: &[
            InputData::floats(inputs, 0, 2),
            InputData::floats(inputs, 1, 2),
        ],
        outputs: &[OutputData::words(cells(&mut found), 0, 1)],
        ..Run::new(PACKETS)
    });
    let canonical = |word: u32| {
        if f32::from_bits(word).is_nan() {
            f32::NAN.to_bits()
        } else {
            word
        }
    };
    let words = found.iter().flat_map(|packet| packet.0);
    words.map(canonical).collect()
}

#[test]
fn sines_in_loops_have_the_bits_of_the_definition() {
    let kernel: Kernel = text::kernel(KERNEL).unwrap();
    let definition = interpreter::Code::new(&kernel);
    let mut random = fastrand::Rng::with_seed(5);
    for round in 0..40 {
        let inputs = std::iter::repeat_with(|| {
            let mut packet = Packet([0.0; LANES]);
            packet.0.fill_with(|| number(&mut random, round % 2 == 1));
            packet
        });
        let inputs: Vec<Packet<f32>> = inputs.take(2 * PACKETS).collect();
        let wanted = run_with(&inputs, &mut |run| {
            let mut registers = interpreter::Scratch::default();
            definition.run(Level::best(), run, &mut registers).unwrap();
        });
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            for tier in [Tier::Fast, Tier::Optimised] {
                let code = Code::compile(&kernel, isa, tier).unwrap();
                let found = run_with(&inputs, &mut |run| {
                    let mut scratch = Scratch::default();
                    code.run(Level::best(), run, &mut scratch).unwrap();
                });
                assert_eq!(found, wanted, "{isa:?} {tier:?}");
            }
        }
    }
}

/// Steps that are fused are those of small angles.
#[test]
fn small_angles_are_told_apart_in_loops() {
    let in_loop = text::kernel(KERNEL).unwrap();
    let once = KERNEL.replace("jump b1(uv15, v14)", "jump b3(v14)");
    let once = once
        .replace("? b2 : b3\n", "? b2 : b3(v7)\n")
        .replace("b3:\n  return v7", "b3(v16):\n  return v16");
    let once = text::kernel(&once).unwrap_or_else(|error| panic!("{error}\n{once}"));
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        let fused = [&in_loop, &once].map(|kernel| {
            let listing = Code::listing(kernel, isa, Tier::Fast).unwrap();
            listing.matches("vfmadd").count()
        });
        assert!(fused[0] >= 3 && fused[1] == 0, "{isa:?} {fused:?}");
    }
}
