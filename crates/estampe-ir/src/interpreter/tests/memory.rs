//! Buffers, work-group memory, atomics and their order.

use super::parsed;
use crate::interpreter::{Buffer, Code, InputData, OutputData, Run, Scratch, cells};
use crate::lanes::Kernel;
use crate::op::Atomic;
use estampe_simd::{LANES, Level, Packet};
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

fn packets(count: usize, word: impl Fn(usize) -> u32) -> Vec<Packet<u32>> {
    let packet = |packet| Packet(std::array::from_fn(|lane| word(packet * LANES + lane)));
    (0..count).map(packet).collect()
}

fn shared(words: &[u32]) -> Vec<AtomicU32> {
    words.iter().copied().map(AtomicU32::new).collect()
}

fn words(of: &[AtomicU32]) -> Vec<u32> {
    of.iter().map(|word| word.load(Relaxed)).collect()
}

/// Runs a kernel on words and masks as inputs; the words of output 0.
fn run(
    kernel: &Kernel,
    level: Level,
    inputs: &[InputData<'_>],
    buffers: &[Buffer<'_>],
    count: usize,
) -> Vec<u32> {
    let mut result = vec![Packet([0; LANES]); count];
    let outputs = [OutputData::words(cells(&mut result), 0, 1)];
    let run = Run {
        inputs,
        outputs: &outputs,
        buffers,
        ..Run::new(count)
    };
    let code = Code::new(kernel);
    code.run(level, &run, &mut Scratch::default()).unwrap();
    result.iter().flat_map(|packet| packet.0).collect()
}

/// Offsets at words, inside of words, at the end and far beyond it.
fn offset(lane: usize) -> u32 {
    let lane = u32::try_from(lane).unwrap();
    match lane % 5 {
        0 => u32::MAX - lane % 7,
        1 => lane % 41,
        _ => lane * 4 % 48,
    }
}

#[test]
fn loads_outside_of_the_bound_range_are_zero() {
    let load = "
kernel compute
input local_invocation_index
output varying(0)
buffer 0.0
b0:
  v0 = input 0
  v1 = load_buffer 0 [v0]
  uv2 = buffer_bytes 0
  uv3 = const 4
  uv4 = load_buffer 0 [uv3]
  uv5 = load_buffer 0 [uv2]
  v6 = add v1, uv2
  v7 = add v6, uv4
  v8 = add v7, uv5
  return v8
";
    let read_only = parsed(load);
    let written = parsed(&load.replace("buffer 0.0", "buffer 0.0 written"));
    let memory: Vec<u32> = (0..12).map(|word| word * 1000 + 1).collect();
    for bytes in [0, 3, 4, 30, 48, 1000] {
        let bound = bytes.min(48);
        let expected = |lane: usize| {
            let at = offset(lane) as usize & !3;
            let word = |at: usize| if at + 4 <= bound { memory[at / 4] } else { 0 };
            word(at) + word(4) + u32::try_from(bound).unwrap()
        };
        let expected: Vec<u32> = (0..5 * LANES).map(expected).collect();
        let offsets = packets(5, offset);
        let inputs = [InputData::words(&offsets, 0, 1)];
        for level in Level::all_available() {
            let buffers = [Buffer::read_only(&memory, bytes)];
            assert_eq!(run(&read_only, level, &inputs, &buffers, 5), expected);
            let memory = shared(&memory);
            let buffers = [Buffer::shared(&memory, bytes)];
            assert_eq!(run(&read_only, level, &inputs, &buffers, 5), expected);
            assert_eq!(run(&written, level, &inputs, &buffers, 5), expected);
        }
    }
}

/// The last lane wins, packet after packet, whatever a chunk would be: what a packet stores, the
/// next one loads.
#[test]
fn stores_are_in_the_order_of_lanes() {
    let kernel = parsed(
        "
kernel compute
input local_invocation_index
input cover
output varying(0)
buffer 0.0 written
b0:
  v0 = input 0
  m1 = input_mask 1
  uv2 = const 8
  uv3 = const 60
  v4 = and v0, uv3
  v5 = load_buffer 0 [v4]
  v6 = add v5, v0
  store_buffer 0 [v4], v6, m1
  store_buffer 0 [uv2], v0, m1
  v7 = load_buffer 0 [uv2]
  return v7
",
    );
    let cover: Vec<u16> = vec![0xFFFF, 0x7F0F, 0, 0x0001];
    let offsets = packets(4, |lane| u32::try_from(lane * 3 % 50).unwrap());
    for bytes in [0, 40, 64] {
        let mut expected = vec![5; 16];
        let mut read = Vec::new();
        for (packet, bits) in cover.iter().enumerate() {
            let lanes: Vec<usize> = (0..LANES).filter(|lane| bits >> lane & 1 == 1).collect();
            let offset = |lane: usize| offsets[packet].0[lane];
            let place = |lane: usize| (offset(lane) & 60) as usize / 4;
            let is_inside = |place: usize| place * 4 + 4 <= bytes;
            let loaded: Vec<u32> = (0..LANES)
                .map(|lane| {
                    if is_inside(place(lane)) {
                        expected[place(lane)]
                    } else {
                        0
                    }
                })
                .collect();
            for &lane in lanes.iter().filter(|&&lane| is_inside(place(lane))) {
                expected[place(lane)] = loaded[lane] + offset(lane);
            }
            for &lane in lanes.iter().filter(|_| is_inside(2)) {
                expected[2] = offset(lane);
            }
            read.extend([if is_inside(2) { expected[2] } else { 0 }; LANES]);
        }
        for level in Level::all_available() {
            let memory = shared(&[5; 16]);
            let inputs = [InputData::words(&offsets, 0, 1), InputData::Mask(&cover)];
            let buffers = [Buffer::shared(&memory, bytes)];
            assert_eq!(run(&kernel, level, &inputs, &buffers, 4), read);
            assert_eq!(words(&memory), expected);
        }
    }
}

/// Atomics of all kinds, on buffers and on the memory of a work-group, lane after lane.
#[test]
fn atomics_are_in_the_order_of_lanes() {
    let mut random = fastrand::Rng::with_seed(17);
    for memory in ["buffer 0", "workgroup"] {
        for &kind in Atomic::ALL {
            // Work-group memory starts with zeros: a first operation stores to it.
            let text = format!(
                "
kernel compute
input local_invocation_index
input cover
input local_invocation_id(0)
output varying(0)
buffer 0.0 written
workgroup 4 (48, 1, 1)
b0:
  v0 = input 0
  m1 = input_mask 1
  v2 = input 2
  uv3 = const 2
  um4 = mask true
  v5 = shl v0, uv3
  v6 = select um4, {place}, v0
  v7 = atomic xor {memory} [v6], v2, m1
  v8 = atomic {kind} {memory} [v6], v2, m1
  v9 = add v7, v8
  barrier
  v10 = atomic load {memory} [v6], v2, m1
  v11 = add v9, v10
  return v11
",
                place = if memory == "workgroup" { "v0" } else { "v5" },
                kind = kind.name(),
            );
            let kernel = parsed(&text);
            let cover: Vec<u16> = (0..3).map(|_| random.u16(..)).collect();
            let places = packets(3, |lane| u32::try_from(lane * 7 % 6).unwrap());
            let operands: Vec<u32> = (0..48).map(|_| random.u32(..)).collect();
            let operand = packets(3, |lane| operands[lane]);
            let mut expected = [0; 4];
            let mut results = vec![0_u32; 48];
            // A packet does all that comes before the barrier, then the next one does.
            let before = (0..3).flat_map(|packet| [(packet, Atomic::Xor), (packet, kind)]);
            let after = (0..3).map(|packet| (packet, Atomic::Load));
            for (packet, kind) in before.chain(after) {
                for lane in packet * LANES..(packet + 1) * LANES {
                    let is_set = cover[packet] >> (lane % LANES) & 1 == 1;
                    let place = places[packet].0[lane % LANES] as usize;
                    if is_set && place < 4 {
                        let before = expected[place];
                        expected[place] = kind.evaluate([before, operands[lane]]);
                        // What a store reads is not used: the interpreter gives 0.
                        if kind != Atomic::Store {
                            results[lane] = results[lane].wrapping_add(before);
                        }
                    }
                }
            }
            for level in Level::all_available() {
                let memory = shared(&[0; 4]);
                let inputs = [
                    InputData::words(&places, 0, 1),
                    InputData::Mask(&cover),
                    InputData::words(&operand, 0, 1),
                ];
                let buffers = [Buffer::shared(&memory, 16)];
                let found = run(&kernel, level, &inputs, &buffers, 3);
                assert_eq!(found, results, "{text} at {}", level.name());
                if text.contains("xor buffer") {
                    assert_eq!(words(&memory), expected);
                }
            }
        }
    }
}

/// One lane alone finds the word that all look for.
#[test]
fn one_lane_wins_a_compare_exchange() {
    for (memory, place) in [("buffer 0", 4), ("workgroup", 1)] {
        let kernel = parsed(&format!(
            "
kernel compute
input local_invocation_index
input cover
output varying(0)
buffer 0.0 written
workgroup 2 (32, 1, 1)
b0:
  v0 = input 0
  m1 = input_mask 1
  uv2 = const 0
  uv3 = const {place}
  uv4 = const 100
  v5, m6 = compare_exchange {memory} [uv3], uv2, v0, m1
  v7 = add v5, uv4
  v8 = select m6, v7, v5
  return v8
"
        ));
        let lanes = packets(2, |lane| u32::try_from(lane + 1).unwrap());
        let cover = [0xFFF0, 0xFFFF];
        for level in Level::all_available() {
            let memory = shared(&[0; 2]);
            let inputs = [InputData::words(&lanes, 0, 1), InputData::Mask(&cover)];
            let buffers = [Buffer::shared(&memory, 8)];
            let found = run(&kernel, level, &inputs, &buffers, 2);
            let expected = |lane: usize| match lane {
                0..4 => 0,
                4 => 100,
                _ => 5,
            };
            assert_eq!(found, (0..32).map(expected).collect::<Vec<_>>());
        }
    }
}

/// A tree of sums over a work-group of 1024 invocations: all of it goes through each barrier.
#[test]
fn a_work_group_goes_through_barriers_as_a_whole() {
    let kernel = parsed(
        "
kernel compute
input local_invocation_index
input cover
output varying(0)
workgroup 1024 (32, 32, 1)
b0:
  v0 = input 0
  m1 = input_mask 1
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
  return uv15
",
    );
    let index = packets(64, |lane| u32::try_from(lane).unwrap());
    let cover = [0xFFFF; 64];
    let sum: u32 = (0..1024).map(|lane| lane * lane).sum();
    for level in Level::all_available() {
        let inputs = [InputData::words(&index, 0, 1), InputData::Mask(&cover)];
        let found = run(&kernel, level, &inputs, &[], 64);
        assert_eq!(found, [sum; 1024]);
    }
}
