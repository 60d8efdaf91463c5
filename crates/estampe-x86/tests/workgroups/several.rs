//! Several work-groups in one call leave what they leave one by one.

use super::{Runner, codes, memory_words};
use estampe_ir::interpreter::{Buffer, InputData, Run, Stopped};
use estampe_ir::lanes::Kernel;
use estampe_ir::text;
use estampe_simd::{LANES, Level, Packet};
use estampe_x86::{Code, Scratch};
use std::sync::atomic::AtomicU32;

/// Work-groups whose invocations each add to a word of a buffer; those of row 3 jump often.
const ADDS: &str = "
kernel compute
input local_invocation_index
input workgroup_id(0)
input cover
input workgroup_id(1)
buffer 0.0 written
b0:
  v0 = input 0
  uv1 = input 1
  m2 = input_mask 2
  uv3 = input 3
  uv4 = const 7
  uv5 = const 63
  uv6 = const 2
  uv7 = const 1
  uv8 = const 0
  uv9 = mul uv3, uv4
  uv10 = add uv9, uv1
  jump b1(uv8)
b1(uv11):
  uv12 = add uv11, uv7
  um13 = ult uv12, uv10
  branch um13 ? b1(uv12) : b2
b2:
  v14 = mul v0, uv10
  v15 = and v14, uv5
  v16 = shl v15, uv6
  v17 = add v0, uv12
  v18 = atomic add buffer 0 [v16], v17, m2
  return
";

/// The words of a buffer after these work-groups of so many packets.
fn words(packets: usize, budget: u64, go: Runner<'_>) -> (Result<(), Stopped>, Vec<u32>) {
    let lane_of = |packet: usize, lane| u32::try_from(packet * LANES + lane).unwrap();
    let index = |packet| Packet(std::array::from_fn(|lane| lane_of(packet, lane)));
    let index: Vec<Packet<u32>> = (0..packets).map(index).collect();
    let cover = vec![0x7FFF; packets];
    let memory: Vec<AtomicU32> = (0..64).map(|_| AtomicU32::new(0)).collect();
    let [x, y] = [InputData::Uniform(5); 2];
    let inputs = [
        InputData::words(&index, 0, 1),
        x,
        InputData::Mask(&cover),
        y,
    ];
    let result = go(&Run {
        inputs: &inputs,
        buffers: &[Buffer::shared(&memory, 256)],
        budget,
        ..Run::new(packets)
    });
    (result, memory_words(&memory))
}

const IDS: [[u32; 3]; 5] = [[0, 0, 0], [3, 0, 0], [1, 1, 0], [2, 3, 9], [4, 2, 1]];

fn assert_same(text: &str, budget: u64) -> Vec<Result<(), Stopped>> {
    let kernel: Kernel = text::kernel(text).unwrap();
    let mut results = Vec::new();
    for code in codes(&kernel) {
        for packets in [1, 2, 3, 4, 7] {
            let level = Level::best();
            let together = words(packets, budget, &mut |run| {
                code.run_workgroups(level, run, &IDS, &mut Scratch::default())
            });
            let one_by_one = words(packets, budget, &mut |run| {
                IDS.into_iter().try_for_each(|id| one(&code, id, run))
            });
            assert_eq!(together, one_by_one, "{:?}, {packets} packets", code.isa());
            results.push(together.0);
        }
    }
    results
}

fn one(code: &Code, [x, y, _]: [u32; 3], run: &Run<'_>) -> Result<(), Stopped> {
    let [x, y] = [x, y].map(InputData::Uniform);
    let inputs = [run.inputs[0], x, run.inputs[2], y];
    let run = Run {
        inputs: &inputs,
        ..*run
    };
    code.run(Level::best(), &run, &mut Scratch::default())
}

#[test]
fn work_groups_without_barriers_run_one_after_the_other() {
    assert!(assert_same(ADDS, 1 << 20).iter().all(Result::is_ok));
    // The fourth has 23 jumps.
    let results = assert_same(ADDS, 20);
    assert!(results.iter().all(|result| *result == Err(Stopped::Budget)));
}

/// The same sums, through memory of the work-group, of which each finds zeros.
#[test]
fn work_groups_with_barriers_run_one_after_the_other() {
    let interface = "workgroup 128 (32, 4, 1)\nb0:";
    let stores = "
  v17 = add v0, uv12
  v19 = load_workgroup [v0]
  v20 = add v17, v19
  store_workgroup [v0], v20, m2
  barrier
  v21 = xor v0, uv7
  v22 = load_workgroup [v21]
  v18 = atomic add buffer 0 [v16], v22, m2";
    let text = ADDS.replace("b0:", interface);
    let text = text.replace("\n  v17 = add v0, uv12", stores);
    let text = text.replace("\n  v18 = atomic add buffer 0 [v16], v17, m2", "");
    assert!(text.contains("barrier") && text.contains("workgroup 128"));
    assert!(assert_same(&text, 1 << 20).iter().all(Result::is_ok));
}
