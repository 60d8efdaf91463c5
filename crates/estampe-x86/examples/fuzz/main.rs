//! Compares machine code of random kernels with the interpreter, on both instruction sets and both
//! tiers, until the time is over or something differs.
//!
//! `cargo run --release -p estampe-x86 --example fuzz -- --seconds 60 --seed 1`

#![expect(clippy::print_stdout, reason = "the program prints how far it is")]

mod kernels;

use kernels::{Hits, Memory, check, smallest, statements_of};
use std::process::ExitCode;
use std::time::{Duration, Instant};

const USAGE: &str = "usage: fuzz [--seconds N] [--seed S]";

/// The seconds and the first seed.
fn arguments(mut words: impl Iterator<Item = String>) -> Option<[u64; 2]> {
    let mut numbers = [10, 0];
    while let Some(word) = words.next() {
        let at = ["--seconds", "--seed"]
            .iter()
            .position(|name| *name == word)?;
        numbers[at] = words.next()?.parse().ok()?;
    }
    Some(numbers)
}

fn main() -> ExitCode {
    let Some([seconds, first]) = arguments(std::env::args().skip(1)) else {
        println!("{USAGE}");
        return ExitCode::from(2);
    };
    let begin = Instant::now();
    let mut shown = begin;
    let (mut memory, mut hits) = (Memory::default(), Hits::default());
    let mut seed = first;
    while begin.elapsed() < Duration::from_secs(seconds) {
        let statements = statements_of(seed);
        if let Err(found) = check(seed, statements, &mut memory, &mut hits) {
            println!("{}", smallest(seed, statements, found));
            return ExitCode::FAILURE;
        }
        seed = seed.wrapping_add(1);
        if shown.elapsed() > Duration::from_secs(1) {
            shown = Instant::now();
            let (kernels, ops) = (seed.wrapping_sub(first), hits.total());
            println!("{kernels} kernels, {ops} operations, next seed {seed}");
        }
    }
    let kernels = seed.wrapping_sub(first);
    println!("{kernels} kernels agree; not hit: {:?}", hits.missing());
    ExitCode::SUCCESS
}
