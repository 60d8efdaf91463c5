//! Random kernels with every operation that is compiled, and the comparison of machine code with
//! the interpreter. Shared by the fuzzer and by the tests.
//!
//! | module | has |
//! |---|---|
//! | [`generate`] | random control flow |
//! | [`operations`] | random operations |
//! | [`case`] | inputs, memory and textures of a run, and what it leaves |
//! | [`hits`] | which operations occurred |

mod case;
mod generate;
mod hits;
mod operations;

use case::Case;
use estampe_ir::interpreter::{self, Stopped};
use estampe_ir::lanes::Kernel;
use estampe_simd::Level;
use estampe_x86::{Code, Isa, Scratch, Tier};
use fastrand::Rng;
pub(crate) use hits::Hits;

/// The statements of a large kernel.
const LARGE: u32 = 400;

/// Memory that is kept from one kernel to the next, as a renderer does.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    registers: interpreter::Scratch,
    scratch: Scratch,
}

/// Compares machine code of a random kernel with the interpreter: each instruction set that is
/// here, each tier. Counts the kernel's operations.
///
/// # Errors
/// What differs, with the kernel's text.
pub(crate) fn check(
    seed: u64,
    statements: u32,
    memory: &mut Memory,
    hits: &mut Hits,
) -> Result<(), String> {
    let random = &mut Rng::with_seed(seed);
    let tree = generate::tree(random, statements);
    let kernel = Kernel::from_tree(&tree);
    let case = Case::new(random, &kernel);
    let interpreted = interpreter::Code::new(&kernel);
    let wanted = case.run(&mut |run| interpreted.run(Level::best(), run, &mut memory.registers));
    if wanted.result == Err(Stopped::Budget) {
        // The interpreter counts other jumps than machine code does.
        return Ok(());
    }
    hits.count(&kernel);
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for tier in [Tier::Fast, Tier::Optimised] {
            let failed = |what: &str| {
                format!("seed {seed}, {statements} statements, {isa:?} {tier:?}: {what}\n{kernel}")
            };
            let code = Code::compile(&kernel, isa, tier)
                .map_err(|error| failed(&format!("no code: {error}")))?;
            hits.count_pairs(&kernel, &code);
            let got = case.run(&mut |run| code.run(Level::best(), run, &mut memory.scratch));
            if let Some(difference) = case.difference(&wanted, &got) {
                return Err(failed(&difference));
            }
        }
    }
    Ok(())
}

/// The size of the kernel of a seed: most are small, some do not fit into the registers.
pub(crate) fn statements_of(seed: u64) -> u32 {
    match seed % 16 {
        0 => LARGE,
        1..=4 => 100,
        _ => 30,
    }
}

/// Looks for a smaller kernel of a failing seed that fails, too. Returns what it says.
pub(crate) fn smallest(seed: u64, statements: u32, found: String) -> String {
    let mut memory = Memory::default();
    (1..statements)
        .find_map(|few| check(seed, few, &mut memory, &mut Hits::default()).err())
        .unwrap_or(found)
}
