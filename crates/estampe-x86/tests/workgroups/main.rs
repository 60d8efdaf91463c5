//! Work-groups of many packets: machine code against the interpreter and against what is expected.
#![cfg(target_arch = "x86_64")]

mod pipelined;
mod several;

use estampe_ir::interpreter::{
    self, Buffer, InputData, NoTextures, OutputData, Run, Stopped, TextureAccess, Textures, cells,
};
use estampe_ir::lanes::Kernel;
use estampe_ir::text;
use estampe_simd::{LANES, Level, Packet};
use estampe_x86::{Code, Isa, Scratch, Tier};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU32, Ordering};

/// What a run of a work-group leaves: its output, or why it stopped, and a buffer of 64 words.
type Left = (Result<Vec<u32>, Stopped>, Vec<u32>);

/// A way to run a kernel.
type Runner<'a> = &'a mut dyn FnMut(&Run<'_>) -> Result<(), Stopped>;

/// Runs so many packets by `go`; the inputs are the index and the cover.
fn left(packets: usize, budget: u64, textures: &dyn Textures, go: Runner<'_>) -> Left {
    let lane_of = |packet: usize, lane| u32::try_from(packet * LANES + lane).unwrap();
    let index = |packet| Packet(std::array::from_fn(|lane| lane_of(packet, lane)));
    let index: Vec<Packet<u32>> = (0..packets).map(index).collect();
    let cover = vec![u16::MAX; packets];
    let memory: Vec<AtomicU32> = (0..64).map(|_| AtomicU32::new(0)).collect();
    let mut output = vec![Packet([0; LANES]); packets];
    let result = go(&Run {
        inputs: &[InputData::words(&index, 0, 1), InputData::Mask(&cover)],
        outputs: &[OutputData::words(cells(&mut output), 0, 1)],
        buffers: &[Buffer::shared(&memory, 256)],
        textures,
        budget,
        ..Run::new(packets)
    });
    let words = output.iter().flat_map(|packet| packet.0).collect();
    (result.map(|()| words), memory_words(&memory))
}

fn memory_words(memory: &[AtomicU32]) -> Vec<u32> {
    let words = memory.iter().map(|word| word.load(Ordering::Relaxed));
    words.collect()
}

/// What the interpreter and all codes leave, which is the same.
fn agreed(text: &str, packets: usize, budget: u64) -> Left {
    let kernel = text::kernel(text).unwrap();
    let code = interpreter::Code::new(&kernel);
    let mut registers = interpreter::Scratch::default();
    let interpreted = left(packets, budget, &NoTextures, &mut |run| {
        code.run(Level::best(), run, &mut registers)
    });
    for code in codes(&kernel) {
        let mut scratch = Scratch::default();
        // The second run finds what the first one left in the scratch memory.
        for _ in 0..2 {
            let compiled = left(packets, budget, &NoTextures, &mut |run| {
                code.run(Level::best(), run, &mut scratch)
            });
            assert_eq!(compiled, interpreted, "{:?}", code.isa());
        }
    }
    interpreted
}

/// Asserts what each lane of so many packets leaves; gives what is in the buffer then.
fn assert_lanes(text: &str, packets: u32, expected: impl Fn(u32) -> u32) -> Vec<u32> {
    let (found, memory) = agreed(text, packets as usize, 1 << 20);
    let expected: Vec<u32> = (0..packets * 16).map(expected).collect();
    assert_eq!(found.unwrap(), expected, "{text}");
    memory
}

fn codes(kernel: &Kernel) -> Vec<Code> {
    let available = Isa::ALL.into_iter().filter(|isa| isa.is_available());
    let tiers = |isa| [Tier::Fast, Tier::Optimised].map(|tier| (isa, tier));
    let code = |(isa, tier)| Code::compile(kernel, isa, tier).unwrap();
    available.flat_map(tiers).map(code).collect()
}

const INTERFACE: &str = "
kernel compute
input local_invocation_index
input cover
output varying(0)
buffer 0.0 written
workgroup 1024 (32, 32, 1)
b0:
  v0 = input 0
  m1 = input_mask 1
";

/// A tree of sums over 1024 invocations: a value lives across barriers of a loop.
#[test]
fn values_live_across_barriers() {
    let text = format!(
        "{INTERFACE}
  uv2 = const 512
  uv3 = const 1
  uv4 = const 0
  v5 = mul v0, v0
  store_workgroup [v0], v5, m1
  barrier
  jump b1(uv2)
b1(uv6):
  m7 = ult v0, uv6
  m8 = mand m7, m1
  v9 = add v0, uv6
  v10 = load_workgroup [v0]
  v11 = load_workgroup [v9]
  v12 = add v10, v11
  barrier
  store_workgroup [v0], v12, m8
  barrier
  uv13 = ushr uv6, uv3
  um14 = ne uv13, uv4
  branch um14 ? b1(uv13) : b2
b2:
  uv15 = load_workgroup [uv4]
  v16 = add v5, uv15
  return v16
"
    );
    let sum: u32 = (0..1024).map(|lane| lane * lane).sum();
    assert_lanes(&text, 64, |lane| sum + lane * lane);
}

/// Packets that end early do not keep the others from going on, and all see what is stored.
#[test]
fn packets_end_at_different_barriers() {
    // Packet p goes through p barriers, and stores p + 1 times to a word of its own.
    let text = format!(
        "{INTERFACE}
  uv2 = const 4
  uv3 = const 1
  uv4 = const 0
  uv5 = const 2
  v6 = ushr v0, uv2
  v7 = shl v6, uv5
  v8 = atomic add buffer 0 [v7], uv3, m1
  jump b1(uv4)
b1(uv9):
  m10 = ult uv9, v6
  branch m10 ? b2 : b3
b2:
  barrier
  v11 = atomic add buffer 0 [v7], uv3, m1
  uv12 = add uv9, uv3
  jump b1(uv12)
b3:
  v13 = atomic add workgroup [uv4], uv3, m1
  return v13
"
    );
    // The earlier packets end first, so each counts on from where the one before stopped.
    let memory = assert_lanes(&text, 6, |lane| lane);
    assert_eq!(memory[..7], [16, 32, 48, 64, 80, 96, 0]);
}

/// Stores beyond the end are dropped, loads from there are 0, and the last lane counts.
#[test]
fn words_beyond_the_end_are_dropped() {
    for (offset, is_inside) in [
        (1023_u32, true),
        (1024, false),
        (1 << 30, false),
        (1 << 31, false),
    ] {
        let text = format!(
            "{INTERFACE}
  uv2 = const {offset}
  uv3 = const 0
  v4 = mul v0, uv3
  v5 = add v4, uv2
  store_workgroup [v5], v0, m1
  barrier
  v6 = load_workgroup [v5]
  uv7 = load_workgroup [uv2]
  v8 = add v6, uv7
  return v8
"
        );
        assert_lanes(&text, 2, |_| if is_inside { 62 } else { 0 });
    }
}

/// The components of vectors are loaded together, those that are outside are 0.
#[test]
fn components_of_vectors_are_loaded_together() {
    let text = format!(
        "{INTERFACE}
  uv2 = const 2
  uv3 = const 1
  uv4 = const 3
  uv5 = const 1023
  store_workgroup [v0], v0, m1
  barrier
  v6 = shl v0, uv2
  v7 = umin v6, uv5
  v8 = load_workgroup [v7]
  v9 = add v7, uv3
  v10 = load_workgroup [v9]
  v11 = add v7, uv2
  v12 = load_workgroup [v11]
  v13 = add uv4, v7
  v14 = load_workgroup [v13]
  v15 = shl v10, uv3
  v16 = xor v8, v15
  v17 = xor v12, v14
  v18 = mul v17, uv4
  v19 = add v16, v18
  return v19
"
    );
    // 256 lanes have a vector, and the last one of those that are confined has one word.
    let word = |at: u32| if at < 17 * 16 { at } else { 0 };
    assert_lanes(&text, 17, |lane| {
        let first = (lane * 4).min(1023);
        let [a, b, c, d] = [0, 1, 2, 3].map(|at| word(first + at));
        (a ^ (b << 1)).wrapping_add((c ^ d).wrapping_mul(3))
    });
    if Isa::Avx512.is_available() {
        let kernel = text::kernel(&text).unwrap();
        let listing = Code::listing(&kernel, Isa::Avx512, Tier::Fast).unwrap();
        assert_eq!(listing.matches("vpermt2d").count(), 8);
    }
}

/// The last operation of a kernel has no result.
#[test]
fn a_kernel_may_end_with_a_store() {
    let text = INTERFACE.replacen("output varying(0)\n", "", 1);
    let text = format!("{text}  store_workgroup [v0], v0, m1\n  return\n");
    assert_lanes(&text, 2, |_| 0);
}

/// A loop with a barrier that never ends is stopped.
#[test]
fn endless_loops_with_barriers_are_stopped() {
    let text = format!(
        "{INTERFACE}
  jump b1
b1:
  barrier
  jump b1
b2:
  return v0
"
    );
    let (found, _) = agreed(&text, 3, 1000);
    assert_eq!(found, Err(Stopped::Budget));
}

/// Textures that panic.
#[derive(Debug)]
struct Panics;

impl Textures for Panics {
    fn access(&self, _: TextureAccess<'_>) {
        panic!("no texture is here");
    }
}

/// The panic of a texture goes through `Code::run`, whatever packets still wait.
#[test]
fn a_panic_ends_the_work_group() {
    let text = format!(
        "{INTERFACE}
  barrier
  uv2 = texture levels of 0 at () in m1
  barrier
  v3 = add v0, uv2
  return v3
"
    );
    let text = text.replacen("workgroup 1024", "texture_at 0.1\nworkgroup 1024", 1);
    let kernel = text::kernel(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    for code in codes(&kernel) {
        let mut scratch = Scratch::default();
        let run = || {
            left(4, 1000, &Panics, &mut |run| {
                code.run(Level::best(), run, &mut scratch)
            })
        };
        let panic = catch_unwind(AssertUnwindSafe(run)).unwrap_err();
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"no texture is here"));
    }
}

/// Loads near each other at a place that is the same in all lanes: inside, across the end, outside,
/// and where numbers wrap.
#[test]
fn words_at_uniform_places_are_loaded_together() {
    for place in [
        0,
        7,
        1016,
        1021,
        1022,
        1024,
        5000,
        u32::MAX - 2,
        u32::MAX,
        1 << 30,
        1 << 31,
    ] {
        let text = format!(
            "{INTERFACE}
  uv2 = const 0
  uv3 = const {place}
  uv4 = const 1
  uv5 = const 2
  uv6 = const 7
  v7 = add v0, v0
  v8 = add v7, uv3
  store_workgroup [v0], v8, m1
  barrier
  uv9 = load_workgroup [uv2]
  uv10 = load_workgroup [uv9]
  uv11 = add uv9, uv4
  uv12 = load_workgroup [uv11]
  uv13 = add uv5, uv9
  uv14 = load_workgroup [uv13]
  uv15 = add uv9, uv6
  uv16 = load_workgroup [uv15]
  uv17 = shl uv12, uv4
  uv18 = xor uv10, uv17
  uv19 = sub uv14, uv16
  v20 = mul uv18, uv19
  v21 = add v20, v0
  return v21
"
        );
        let word = |at: u32| match at {
            0..272 => (at * 2).wrapping_add(place),
            _ => 0,
        };
        let place_read = word(0);
        let [a, b, c, d] = [0, 1, 2, 7].map(|after| word(place_read.wrapping_add(after)));
        let product = (a ^ (b << 1)).wrapping_mul(c.wrapping_sub(d));
        assert_lanes(&text, 17, |lane| product.wrapping_add(lane));
        let kernel = text::kernel(&text).unwrap();
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            // The place of the first load, and that of the four that follow.
            let listing = Code::listing(&kernel, isa, Tier::Fast).unwrap();
            assert_eq!(listing.matches("vmovd ").count(), 2, "{isa:?}");
        }
    }
}

/// The same in a buffer of 64 words, whose places are bytes.
#[test]
fn words_of_buffers_at_uniform_places_are_loaded_together() {
    for place in [
        0,
        6,
        28,
        200,
        243,
        244,
        252,
        256,
        u32::MAX - 3,
        u32::MAX - 7,
        1 << 30,
        1 << 31,
    ] {
        let text = format!(
            "{INTERFACE}
  uv2 = const 0
  uv3 = const {place}
  uv4 = const 4
  uv5 = const 8
  uv6 = const 1
  uv7 = const 2
  v8 = mul v0, v0
  v9 = add v8, uv3
  v10 = shl v0, uv7
  store_buffer 0 [v10], v9, m1
  barrier
  uv11 = load_buffer 0 [uv2]
  uv12 = load_buffer 0 [uv11]
  uv13 = add uv11, uv4
  uv14 = load_buffer 0 [uv13]
  uv15 = add uv5, uv11
  uv16 = load_buffer 0 [uv15]
  uv17 = shl uv14, uv6
  uv18 = xor uv12, uv17
  uv19 = mul uv18, uv16
  v20 = add uv19, v0
  return v20
"
        );
        let word = |at: u32| match at / 4 {
            number @ 0..64 => (number * number).wrapping_add(place),
            _ => 0,
        };
        let place_read = word(0);
        let [a, b, c] = [0, 4, 8].map(|after| word(place_read.wrapping_add(after)));
        let product = (a ^ (b << 1)).wrapping_mul(c);
        assert_lanes(&text, 17, |lane| product.wrapping_add(lane));
    }
}
