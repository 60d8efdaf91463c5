//! Loops of work-groups that are pipelined: machine code against the interpreter.

use super::{INTERFACE, agreed};
use estampe_ir::text;
use estampe_x86::{Code, Isa, Tier};
use iced_x86::{Decoder, DecoderOptions, Mnemonic};
use std::fmt::Write;

/// A kernel with a loop that runs so often, of sums of what a random body makes of the words that
/// the invocations stored.
fn sums_of_random_bodies(random: &mut fastrand::Rng, trips: u32, sums: usize) -> String {
    let mut text = format!(
        "{INTERFACE}
  uv2 = const 1
  uv3 = const 0
  uv4 = const {trips}
  uv5 = const 16
  uv6 = const 1.0
  v7 = shl v0, uv5
  v8 = add v7, uv6
  store_workgroup [v0], v8, m1
  barrier
  jump b1(uv3{})
",
        ", v8".repeat(sums)
    );
    let of_sum = |sum: usize| format!("v{}", 10 + sum);
    let parameters: String = (0..sums).map(|sum| format!(", {}", of_sum(sum))).collect();
    let mut next = 10 + sums;
    let test = next;
    write!(
        text,
        "b1(uv9{parameters}):
  um{test} = ult uv9, uv4
  branch um{test} ? b2 : b3
b2:
"
    )
    .unwrap();
    next += 1;
    let mut add = |text: &mut String, operation: &str| {
        writeln!(text, "  v{next} = {operation}").unwrap();
        next += 1;
        format!("v{}", next - 1)
    };
    let uniform = |text: &mut String, value: &str| {
        // The name says that all lanes have it.
        *text = text.replace(&format!("  {value} = "), &format!("  u{value} = "));
        format!("u{value}")
    };
    let load = add(&mut text, "load_workgroup [uv9]");
    let load = uniform(&mut text, &load);
    let root = add(&mut text, &format!("fsqrt {load}"));
    let root = uniform(&mut text, &root);
    let mut values = vec!["v8".to_owned(), "uv6".to_owned(), load, root];
    for _ in 0..random.usize(70..110) {
        let near = |random: &mut fastrand::Rng, values: &[String]| {
            let back = random.usize(1..=values.len().min(6));
            values[values.len() - back].clone()
        };
        let a = near(random, &values);
        let b = match random.u8(..8) {
            0 => of_sum(random.usize(..sums)),
            1 => values[random.usize(..values.len())].clone(),
            _ => near(random, &values),
        };
        let operation = match random.u8(..16) {
            0 => format!("fsqrt {a}"),
            1 => format!("fdiv uv6, {a}"),
            2..6 => format!("fadd {a}, {b}"),
            6..9 => format!("fsub {a}, {b}"),
            9..12 => format!("fmax {a}, {b}"),
            _ => format!("fmul {a}, {b}"),
        };
        let made = add(&mut text, &operation);
        let varies = |value: &String| value.starts_with('v');
        let is_binary = operation.contains(", ") && !operation.starts_with("fdiv");
        let is_uniform = !varies(&a) && (!is_binary || !varies(&b));
        values.push(if is_uniform {
            uniform(&mut text, &made)
        } else {
            made
        });
    }
    let mut arguments = add(&mut text, "add uv9, uv2");
    arguments = uniform(&mut text, &arguments);
    for sum in 0..sums {
        let value = &values[values.len() - 1 - random.usize(..10)];
        let grown = add(&mut text, &format!("fadd {}, {value}", of_sum(sum)));
        // Sums may change places.
        write!(arguments, ", {grown}").unwrap();
    }
    write!(text, "  jump b1({arguments})\nb3:\n").unwrap();
    let mut total = of_sum(0);
    for sum in 1..sums {
        total = add(&mut text, &format!("fadd {total}, {}", of_sum(sum)));
    }
    let total = add(&mut text, &format!("canonical {total}"));
    writeln!(text, "  return {total}").unwrap();
    text
}

/// The square roots among the instructions.
fn roots(text: &str, (isa, tier): (Isa, Tier)) -> usize {
    let code = Code::compile(&text::kernel(text).unwrap(), isa, tier).unwrap();
    let decoder = Decoder::new(64, code.instructions(), DecoderOptions::NONE);
    let instructions = decoder.into_iter();
    instructions
        .filter(|one| one.mnemonic() == Mnemonic::Vsqrtps)
        .count()
}

/// The first half of an iteration is computed beside the one before, and nothing shows it, however
/// often a loop runs.
#[test]
fn pipelined_loops_give_what_the_interpreter_gives() {
    let random = &mut fastrand::Rng::with_seed(5);
    let mut pipelined = 0;
    for trips in [0, 1, 2, 3, 17, 32].repeat(8) {
        let sums = random.usize(1..6);
        let text = sums_of_random_bodies(random, trips, sums);
        agreed(&text, 2, 1 << 20).0.unwrap();
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            let fast = roots(&text, (isa, Tier::Fast));
            let optimised = roots(&text, (isa, Tier::Optimised));
            pipelined += usize::from(optimised > fast);
            assert!(optimised == fast || isa == Isa::Avx512);
        }
    }
    let has_isa = Isa::Avx512.is_available();
    assert!(pipelined > 24 || !has_isa, "{pipelined} of 48 are");
}

/// A loop that stores stays as it is: its loads may see it.
#[test]
fn loops_with_effects_are_not_pipelined() {
    let random = &mut fastrand::Rng::with_seed(6);
    let text = sums_of_random_bodies(random, 9, 3);
    let text = text.replace(
        "  jump b1(uv1",
        "  store_workgroup [v0], v10, m1\n  jump b1(uv1",
    );
    assert!(text.matches("store_workgroup").count() == 2, "{text}");
    agreed(&text, 2, 1 << 20).0.unwrap();
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        let [fast, optimised] = [Tier::Fast, Tier::Optimised].map(|tier| roots(&text, (isa, tier)));
        assert_eq!(fast, optimised);
    }
}

/// The square roots after which the next one follows at once, but for moves.
fn roots_in_a_row(text: &str, isa: Isa) -> usize {
    let code = Code::compile(&text::kernel(text).unwrap(), isa, Tier::Optimised).unwrap();
    let decoder = Decoder::new(64, code.instructions(), DecoderOptions::NONE);
    let mnemonics = decoder.into_iter().map(|one| one.mnemonic());
    let others: Vec<Mnemonic> = mnemonics
        .filter(|one| !matches!(one, Mnemonic::Vmovups | Mnemonic::Vmovaps))
        .collect();
    let pairs = others.windows(2);
    pairs
        .filter(|pair| **pair == [Mnemonic::Vsqrtps; 2])
        .count()
}

/// Where far more values live than AVX2 has registers, the halves of a packet take turns.
#[test]
fn halves_take_turns_in_loops_of_many_sums() {
    let random = &mut fastrand::Rng::with_seed(7);
    let mut in_a_row = [0; 2];
    for round in 0..24 {
        let has_many = round % 2;
        let sums = [random.usize(1..4), random.usize(34..50)][has_many];
        let trips = random.u32(..20);
        let text = sums_of_random_bodies(random, trips, sums);
        agreed(&text, 2, 1 << 20).0.unwrap();
        if Isa::Avx2.is_available() {
            in_a_row[has_many] += roots_in_a_row(&text, Isa::Avx2);
        }
    }
    // Two roots of one half may follow each other, too, but those of both halves do not.
    let [few, many] = in_a_row;
    let is_told = few > 24 && many * 4 < few;
    assert!(is_told || !Isa::Avx2.is_available(), "{in_a_row:?}");
}
