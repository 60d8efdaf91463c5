//! Control flow, parameters, locals and budgets.

use super::{Lanes, parsed, run};
use crate::interpreter::{Code, Run, Scratch, Stopped};
use crate::lanes::Kernel;
use estampe_simd::{LANES, Level};

/// Runs a kernel on one input at all levels, for several numbers of packets and chunks; the results
/// must be those of a function of the lane's input.
fn check(text: &str, input: impl Fn(usize) -> u32, defined: impl Fn(u32) -> u32) {
    let kernel = parsed(text);
    for packets in [1, 2, 5, 16, 33] {
        let given: Lanes = vec![(0..packets * LANES).map(&input).collect()];
        let expected: Vec<u32> = given[0].iter().map(|&word| defined(word)).collect();
        for level in Level::all_available() {
            for chunk in [1, 2, 16] {
                let code = Code::new(&kernel).with_chunk(chunk);
                let found = run(&code, &kernel, level, &given);
                assert_eq!(found[0], expected, "{packets} packets at {}", level.name());
            }
        }
    }
}

/// Collatz: lanes leave the loop one after the other.
const COLLATZ: &str = "
kernel fragment
input varying(0)
output varying(0)
b0:
  v0 = input 0
  uv1 = const 0
  uv2 = const 1
  uv3 = const 3
  m4 = ult uv2, v0
  jump b1(v0, uv1, m4)
b1(v5, v6, m7):
  branch m7 ? b2 : b3
b2:
  v8 = ushr v5, uv2
  v9 = mul v5, uv3
  v10 = add v9, uv2
  v11 = and v5, uv2
  m12 = eq v11, uv2
  v13 = select m12, v10, v8
  v14 = select m7, v13, v5
  v15 = add v6, uv2
  v16 = select m7, v15, v6
  m17 = ult uv2, v14
  m18 = mand m17, m7
  jump b1(v14, v16, m18)
b3:
  return v6
";

#[test]
fn lanes_leave_a_loop_one_after_the_other() {
    check(
        COLLATZ,
        |lane| u32::try_from(lane * 7 % 97).unwrap(),
        |start| {
            let (mut number, mut steps) = (start, 0);
            while number > 1 {
                number = if number % 2 == 1 {
                    3 * number + 1
                } else {
                    number / 2
                };
                steps += 1;
            }
            steps
        },
    );
}

/// Nothing is copied from one iteration to the next: the loop has ten operations and two jumps.
#[test]
fn loops_compute_in_place() {
    let code = Code::new(&parsed(COLLATZ));
    let copies = code.instructions.iter().filter(|(_, instruction)| {
        use crate::interpreter::instruction::Instruction;
        matches!(
            instruction,
            Instruction::Copy(..) | Instruction::CopyMask(..)
        )
    });
    // The number of steps begins with a uniform 0.
    assert_eq!(copies.count(), 1, "{:#?}", code.instructions);
}

/// The parameters of the loop change places: a cycle of moves, of words that are uniform and of
/// words that are not.
#[test]
fn parameters_are_moved_at_once() {
    let text = "
kernel fragment
input varying(0)
output varying(0)
b0:
  v0 = input 0
  uv1 = const 1
  uv2 = const 2
  uv3 = const 5
  uv4 = const 0
  v5 = add v0, uv1
  v6 = add v0, uv2
  jump b1(v0, v5, v6, uv1, uv2, uv4)
b1(v7, v8, v9, uv10, uv11, uv12):
  um13 = ult uv12, uv3
  uv14 = add uv12, uv1
  branch um13 ? b1(v8, v9, v7, uv11, uv10, uv14) : b2
b2:
  v15 = mul v7, uv10
  v16 = mul v8, uv11
  v17 = shl v9, uv3
  v18 = add v15, v16
  v19 = add v18, v17
  return v19
";
    check(
        text,
        |lane| u32::try_from(lane * lane).unwrap(),
        |x| {
            let (mut three, mut two) = ([x, x + 1, x + 2], [1, 2]);
            for _ in 0..5 {
                three.rotate_left(1);
                two.swap(0, 1);
            }
            (three[0] * two[0])
                .wrapping_add(three[1] * two[1])
                .wrapping_add(three[2] << 5)
        },
    );
}

/// A side is executed if one lane of the chunk needs it, and lanes that do not keep their words.
#[test]
fn branches_are_taken_if_any_lane_is_set() {
    let text = "
kernel fragment
input varying(0)
output varying(0)
b0:
  v0 = input 0
  uv1 = const 1000
  uv2 = const 3
  m3 = ult uv1, v0
  branch m3 ? b1 : b2(v0)
b1:
  v4 = mul v0, uv2
  v5 = select m3, v4, v0
  jump b2(v5)
b2(v6):
  um7 = any m3
  uv8 = const 0
  v9 = select um7, v6, v0
  return v9
";
    check(
        text,
        |lane| {
            let lane = u32::try_from(lane).unwrap();
            if lane % 100 == 50 { lane + 1001 } else { lane }
        },
        |x| if x > 1000 { x * 3 } else { x },
    );
}

/// Each lane writes and reads its own words; places beyond the end are those of the documentation.
#[test]
fn arrays_belong_to_the_lane() {
    let text = "
kernel fragment
input varying(0)
output varying(0)
local 4 [10, 11]
local 3 [100, 200, 300]
b0:
  v0 = input 0
  uv1 = const 2
  uv2 = const 7
  m3 = ult v0, uv2
  um4 = mask true
  v5 = and v0, uv2
  store_local 0 [v5], v0, m3
  store_local 0 [uv1], v5, um4
  store_local 0 [uv2], v5, um4
  v6 = load_local 0 [v5]
  v7 = load_local 0 [uv1]
  v8 = load_local 0 [uv2]
  uv9 = load_local 1 [uv1]
  v10 = load_local 1 [v5]
  v11 = shl v6, uv1
  v12 = add v11, v7
  v13 = shl v12, uv1
  v14 = add v13, v8
  v15 = add v14, uv9
  v16 = add v15, v10
  return v16
";
    check(
        text,
        |lane| u32::try_from(lane % 23).unwrap(),
        |x| {
            let mut array = [10, 11, 0, 0];
            let table = [100, 200, 300];
            let at = x as usize & 7;
            if x < 7 && at < 4 {
                array[at] = x;
            }
            array[2] = x & 7;
            let sum = (array[at.min(3)] << 2) + array[2];
            (sum << 2) + array[3] + 300 + table[at.min(2)]
        },
    );
}

#[test]
fn an_endless_loop_is_stopped() {
    let kernel =
        parsed("kernel vertex b0: jump b1 b1: um0 = mask true branch um0 ? b1 : b2 b2: return");
    let code = Code::new(&kernel);
    for level in Level::all_available() {
        for budget in [0, 1, 1000] {
            let run = Run {
                budget,
                ..Run::new(3)
            };
            let ended = code.run(level, &run, &mut Scratch::default());
            assert_eq!(ended, Err(Stopped::Budget));
        }
    }
}

#[test]
fn registers_that_do_not_fit_into_memory_are_an_error() {
    let mut kernel = parsed(
        "kernel vertex local 1 b0: uv0 = const 1 um1 = mask true store_local 0 [uv0], uv0, um1 return",
    );
    let run_it = |kernel: &Kernel| {
        let code = Code::new(kernel);
        code.run(
            Level::best(),
            &Run::new(usize::MAX / 64),
            &mut Scratch::default(),
        )
    };
    kernel.interface.workgroup_words = 1;
    assert_eq!(run_it(&kernel), Err(Stopped::Memory));
}

#[test]
fn missing_inputs_are_zero_and_missing_outputs_are_dropped() {
    let kernel = parsed(COLLATZ);
    let code = Code::new(&kernel);
    assert_eq!(
        code.run(Level::best(), &Run::new(2), &mut Scratch::default()),
        Ok(())
    );
    assert_eq!(
        code.run(Level::best(), &Run::new(0), &mut Scratch::default()),
        Ok(())
    );
}
