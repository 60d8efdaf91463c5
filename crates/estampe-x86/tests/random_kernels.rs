//! A second of the fuzzer `examples/fuzz`, which hits every operation that is compiled.
#![cfg(target_arch = "x86_64")]

#[path = "../examples/fuzz/kernels/mod.rs"]
mod kernels;

use estampe_x86::Isa;
use kernels::{Hits, Memory, check, smallest, statements_of};

#[test]
fn random_kernels_give_what_the_interpreter_gives() {
    let (mut memory, mut hits) = (Memory::default(), Hits::default());
    for seed in 0..400 {
        let statements = statements_of(seed);
        if let Err(found) = check(seed, statements, &mut memory, &mut hits) {
            panic!("{}", smallest(seed, statements, found));
        }
    }
    assert!(hits.missing().is_empty(), "not hit: {:?}", hits.missing());
    assert!(hits.total() > 10_000 || Isa::best().is_none());
}
