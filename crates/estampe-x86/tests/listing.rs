//! Listings, compared with an independent disassembler.
#![cfg(target_arch = "x86_64")]

use estampe_ir::interface::{Input, Output, Stage};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::{Binary, Compare, Math};
use estampe_ir::tree::Builder;
use estampe_x86::{Code, Isa, Tier};
use iced_x86::{Decoder, DecoderOptions};

/// A loop that adds sines of a varying until the sum is large.
fn kernel() -> Kernel {
    let mut b = Builder::new(Stage::Fragment);
    let x = b.input(Input::Varying(0));
    let limit = b.float(8.0);
    let one = b.float(1.0);
    let done = b.block(1);
    let open = b.start_loop(&[x]);
    let sum = open.parameters[0];
    let is_done = b.compare(Compare::FLe, limit, sum);
    b.start_if(is_done);
    b.branch(done, &[sum]);
    b.end_if();
    let sine = b.math(Math::Sin, sum);
    let step = b.binary(Binary::FMul, sine, sine);
    let next = b.binary(Binary::FAdd, sum, step);
    let next = b.binary(Binary::FAdd, next, one);
    b.branch(open.label, &[next]);
    b.end_loop();
    let sum = b.end_block()[0];
    let color = |component| Output::Color {
        target: 0,
        component,
    };
    Kernel::from_tree(&b.finish(vec![(color(0), sum), (color(1), x)]))
}

/// Each line has the address, the bytes and the mnemonic that the disassembler finds.
#[test]
fn listings_are_what_a_disassembler_reads() {
    let kernel = kernel();
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for tier in [Tier::Fast, Tier::Optimised] {
            let code = Code::compile(&kernel, isa, tier).expect("it is small");
            let listing = Code::listing(&kernel, isa, tier).expect("it is small");
            let bytes = code.instructions();
            let mut decoder = Decoder::with_ip(64, bytes, 0, DecoderOptions::NONE);
            let lines = listing.lines().take_while(|line| *line != "; constants");
            let lines = lines.filter(|line| line.starts_with("  "));
            let mut count = 0;
            for line in lines {
                let instruction = decoder.decode();
                assert!(!instruction.is_invalid(), "{line}");
                let (start, end) = (instruction.ip(), instruction.next_ip());
                let range = usize::try_from(start).unwrap()..usize::try_from(end).unwrap();
                let hex: Vec<String> = bytes[range]
                    .iter()
                    .map(|byte| format!("{byte:02x}"))
                    .collect();
                let expected = format!("  {start:06x}  {:33} ", hex.join(" "));
                let text = line.strip_prefix(&expected);
                let text = text.unwrap_or_else(|| panic!("{line} is not {expected}"));
                let mnemonic = format!("{:?}", instruction.mnemonic()).to_lowercase();
                assert_eq!(text.split(' ').next(), Some(&*mnemonic), "{line}");
                count += 1;
            }
            assert_eq!(
                decoder.position(),
                bytes.len(),
                "all instructions are listed"
            );
            assert!(count > 50, "{listing}");
            for part in ["; packets one by one", "; constants", "{1to16}", "jb L"] {
                let is_there = listing.contains(part) || isa == Isa::Avx2 && part == "{1to16}";
                assert!(is_there, "{part} in {listing}");
            }
        }
    }
}

/// In a loop, a pass computes the iteration of one packet before that of the other one.
#[test]
fn packets_of_a_pass_loop_one_after_the_other() {
    if !Isa::Avx512.is_available() {
        return;
    }
    let listing = Code::listing(&kernel(), Isa::Avx512, Tier::Optimised).expect("it is small");
    let (_, pair) = listing.split_once("; two packets").expect("it runs pairs");
    // A sine confines what it is the sine of.
    let order: Vec<&str> = pair
        .lines()
        .filter_map(|line| {
            ["vminps", "vmaxps"]
                .into_iter()
                .find(|one| line.contains(one))
        })
        .collect();
    assert_eq!(order, ["vminps", "vmaxps", "vminps", "vmaxps"], "{pair}");
}

/// The sign of a sine is turned by the units for floats, which made it.
#[test]
fn logic_of_floats_stays_in_the_units_for_floats() {
    if !Isa::Avx2.is_available() {
        return;
    }
    let listing = Code::listing(&kernel(), Isa::Avx2, Tier::Optimised).expect("it is small");
    assert!(listing.contains(" vxorps ymm"), "{listing}");
}
