//! The check of the machine code: hot code is compiled with the instructions of its SIMD level.
//!
//! Lane code is generic over a level's token and must be inlined into a *level entry*: the function
//! `vectorize_avx2` or `vectorize_avx512` of `fearless_simd`, which alone is compiled with the
//! level's instructions. One function that is not inlined runs with the baseline's instructions and
//! calls one function per lane operation; that was measured to cost 5 to 14 times. Both leave marks
//! in the symbol table and the calls of a release binary:
//!
//! 1. a lane operation has a symbol of its own (a `kernel` of `fearless_simd`, or an intrinsic of
//!    `core::core_arch`), so some caller could not take it in;
//! 2. a level entry calls a function that is generic over the token and is no level entry itself.
//!
//! Calls are found as relative `call` and `jmp` instructions whose target is the first byte of a
//! known function: without decoding the instructions between, but a wrong hit would need four bytes
//! of data that agree with a symbol's address. The rejected alternative, a search of the text that
//! `objdump` prints, needs binutils on every machine.
//!
//! The tokens of the baseline (scalar, SSE2) are left out: their code needs no entry.

use std::collections::BTreeMap;
use std::fmt;

use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};

/// The levels with an entry: the mark of the token in a symbol, and the mark of the entry.
const LEVELS: &[(&str, &str)] = &[
    ("avx2::Avx2", "::vectorize::vectorize_avx2"),
    ("avx512::Avx512", "::vectorize::vectorize_avx512"),
];

/// The tokens of the baseline, whose operations may stand alone.
const BASELINE: &[&str] = &["sse2::Sse2", "sse4_2::Sse4_2", "fallback::Fallback"];

/// Marks of a lane operation that was not inlined.
const LANE_OPERATIONS: &[&str] = &["__fearless_simd_kernel", "core::core_arch::x86"];

/// Symbols that look like offences and are none, with the reason.
const ALLOWED: &[(&str, &str)] = &[("::xsave::_xgetbv", "part of the detection of the level")];

/// The result of the check of one binary.
#[derive(Debug, Clone, Default)]
pub struct AssemblyReport {
    /// The number of level entries, which are the hot functions, in the binary.
    pub entries: usize,
    /// Messages about functions and lane operations that must be inlined and are not, one sentence
    /// each.
    pub offences: Vec<String>,
    /// The functions of ours that a level entry calls and that have no level of their own. This is
    /// right for code without lanes, and worth a look if the function is hot.
    pub calls: Vec<String>,
}

/// A binary that cannot be checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AssemblyError {
    /// The file is no object file.
    Malformed(object::Error),
    /// The file has no function symbols.
    NoSymbols,
    /// No symbol is mangled in a way that shows generic arguments.
    HidesGenerics,
    /// A level has no entry in the binary, so that the check would pass blindly.
    NoEntry {
        /// The mark that was looked for.
        wanted: &'static str,
    },
}

impl fmt::Display for AssemblyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Malformed(reason) => write!(f, "the file cannot be read: {reason}"),
            Self::NoSymbols => write!(f, "it has no symbols: was it stripped?"),
            Self::HidesGenerics => {
                write!(
                    f,
                    "built without -C symbol-mangling-version=v0: types do not show"
                )
            }
            Self::NoEntry { wanted } => {
                write!(
                    f,
                    "no function is named `{wanted}`: nothing in it runs at this level"
                )
            }
        }
    }
}

impl std::error::Error for AssemblyError {}

/// Checks an x86-64 ELF binary that was built with `-C symbol-mangling-version=v0`.
///
/// # Errors
/// [`AssemblyError`] when the binary is not such a file, or holds nothing to check.
pub fn check_binary(file: &[u8]) -> Result<AssemblyReport, AssemblyError> {
    let file = object::File::parse(file).map_err(AssemblyError::Malformed)?;
    let functions = functions_of(&file);
    if functions.is_empty() {
        return Err(AssemblyError::NoSymbols);
    }
    if !functions
        .iter()
        .any(|function| function.name.starts_with("_R"))
    {
        return Err(AssemblyError::HidesGenerics);
    }
    report(&functions)
}

/// A function of the binary.
#[derive(Debug, Clone)]
struct Function<'file> {
    /// The name, mangled as in the file.
    name: &'file str,
    /// The virtual address of its first byte.
    address: u64,
    /// Its machine code.
    code: &'file [u8],
}

/// The functions in the symbol table of `file`.
fn functions_of<'file>(file: &object::File<'file>) -> Vec<Function<'file>> {
    let function = |symbol: object::Symbol<'file, '_>| {
        let section = file.section_by_index(symbol.section_index()?).ok()?;
        let (address, len) = (symbol.address(), symbol.size());
        Some(Function {
            name: symbol.name().ok()?,
            address,
            code: section.data_range(address, len).ok()??,
        })
    };
    file.symbols()
        .filter(|symbol| symbol.kind() == SymbolKind::Text)
        .filter_map(function)
        .collect()
}

/// The role of a function in the check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    /// Compiled with a level's instructions.
    Entry,
    /// A lane operation, which must not have a symbol.
    LaneOperation,
    /// Generic over a level's token, and no entry.
    Generic,
    /// Without lanes.
    Plain,
}

fn report(functions: &[Function<'_>]) -> Result<AssemblyReport, AssemblyError> {
    let names: Vec<String> = functions
        .iter()
        .map(|function| shown_name(function.name))
        .collect();
    for (_, wanted) in LEVELS {
        if !names.iter().any(|name| name.contains(wanted)) {
            return Err(AssemblyError::NoEntry { wanted });
        }
    }
    let parts: Vec<Part> = names.iter().map(|name| part(name)).collect();
    let calls = calls(functions);
    let mut callers = vec![Vec::new(); functions.len()];
    for (caller, callees) in calls.iter().enumerate() {
        for &callee in callees {
            callers[callee].push(caller);
        }
    }
    let enters_level = |index: usize| {
        calls[index]
            .iter()
            .any(|&callee| parts[callee] == Part::Entry)
    };

    let mut report = AssemblyReport::default();
    let mut operations_of: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (index, name) in names.iter().enumerate() {
        let callers = &callers[index];
        let entry = callers.iter().find(|&&caller| parts[caller] == Part::Entry);
        match (parts[index], entry) {
            (Part::Entry, _) => report.entries += 1,
            (Part::LaneOperation, _) if callers.is_empty() => {
                operations_of
                    .entry("an unknown function")
                    .or_default()
                    .push(name);
            }
            (Part::LaneOperation, _) => {
                for &caller in callers {
                    operations_of.entry(&names[caller]).or_default().push(name);
                }
            }
            (Part::Generic, Some(&entry)) if !enters_level(index) => {
                report.offences.push(format!(
                    "`{name}` leaves its level: `{}` calls it, where it must be inlined",
                    names[entry]
                ));
            }
            (Part::Generic | Part::Plain, Some(&entry)) if name.contains("estampe") => {
                report
                    .calls
                    .push(format!("`{name}`, called by `{}`", names[entry]));
            }
            (Part::Generic | Part::Plain, _) => {}
        }
    }
    report
        .offences
        .extend(operations_of.iter().map(|(caller, operations)| {
            format!(
                "lane operations are not inlined into `{caller}`: {}",
                operations.join(", ")
            )
        }));
    report.offences.sort();
    report.calls.sort();
    Ok(report)
}

/// A demangled name without what every name of the lanes repeats.
fn shown_name(mangled: &str) -> String {
    let mut name = format!("{:#}", rustc_demangle::demangle(mangled));
    for repeated in [
        "fearless_simd::generated::simd_trait::",
        "fearless_simd::generated::",
    ] {
        name = name.replace(repeated, "");
    }
    name
}

fn part(name: &str) -> Part {
    let has_one_of = |marks: &[&str]| marks.iter().any(|mark| name.contains(mark));
    if LEVELS.iter().any(|(_, entry)| name.contains(entry)) {
        Part::Entry
    } else if ALLOWED.iter().any(|(allowed, _)| name.contains(allowed)) {
        Part::Plain
    } else if has_one_of(LANE_OPERATIONS) && !has_one_of(BASELINE) {
        Part::LaneOperation
    } else if LEVELS.iter().any(|(token, _)| name.contains(token)) {
        Part::Generic
    } else {
        Part::Plain
    }
}

/// For each function, the indices of the functions that it calls or jumps to directly.
fn calls(functions: &[Function<'_>]) -> Vec<Vec<usize>> {
    let by_address: BTreeMap<u64, usize> = functions
        .iter()
        .enumerate()
        .map(|(index, function)| (function.address, index))
        .collect();
    functions
        .iter()
        .map(|function| {
            let mut callees: Vec<usize> = branch_targets(function)
                .filter_map(|target| by_address.get(&target).copied())
                .collect();
            callees.sort_unstable();
            callees.dedup();
            callees
        })
        .collect()
}

/// The target of each `call rel32` and `jmp rel32`, if the bytes are one (Intel SDM, volume 2:
/// opcodes E8 and E9, the displacement counted from the next instruction).
fn branch_targets<'file>(function: &'file Function<'_>) -> impl Iterator<Item = u64> + 'file {
    const CALL: u8 = 0xe8;
    const JUMP: u8 = 0xe9;
    function
        .code
        .windows(5)
        .zip(function.address..)
        .filter_map(|(bytes, address)| {
            let &[CALL | JUMP, a, b, c, d] = bytes else {
                return None;
            };
            let displacement = i64::from(i32::from_le_bytes([a, b, c, d]));
            Some(address.wrapping_add(5).wrapping_add_signed(displacement))
        })
}

#[cfg(test)]
mod tests;
