//! SPIR-V: its words are checked, then parsed by naga.
//!
//! naga's errors name no place. The place is found again: the word of the first instruction with
//! the opcode, capability or id that the error speaks of.

use naga::front::spv;

use super::validate::Words;
use super::{ShaderError, ShaderErrors};

/// The first word of a module (SPIR-V 1.6, section 3.1).
const MAGIC: u32 = 0x0723_0203;

/// The words of the header.
const HEADER_WORDS: usize = 5;

/// The most ids of a module: naga's tables grow with the ids that are used, not with the bound.
const MOST_IDS: u32 = 4 << 20;

/// The words of a file of either byte order.
pub(super) fn words(bytes: &[u8]) -> Result<Vec<u32>, ShaderErrors> {
    let (words, rest) = bytes.as_chunks::<4>();
    if !rest.is_empty() {
        let length = bytes.len();
        return Err(ShaderError::new(format!(
            "the SPIR-V has {length} bytes, which is no whole number of 4-byte words"
        ))
        .help("the file is cut off, or not SPIR-V")
        .into());
    }
    let is_swapped = words
        .first()
        .is_some_and(|first| u32::from_be_bytes(*first) == MAGIC);
    let decode = if is_swapped {
        u32::from_be_bytes
    } else {
        u32::from_le_bytes
    };
    Ok(words.iter().map(|word| decode(*word)).collect())
}

/// Checks the words and parses them.
pub(super) fn parse(words: &[u32]) -> Result<naga::Module, ShaderErrors> {
    check(words)?;
    let options = spv::Options {
        // y of clip space is up, as in WebGPU and as wgpu reads SPIR-V.
        adjust_coordinate_space: false,
        strict_capabilities: true,
        block_ctx_dump_prefix: None,
    };
    spv::Frontend::new(words.iter().copied(), &options)
        .parse()
        .map_err(|error| describe(words, &error).into())
}

/// Checks the header and the lengths of all instructions.
fn check(words: &[u32]) -> Result<(), ShaderError> {
    if words.first() != Some(&MAGIC) {
        return Err(ShaderError::new(
            "this is not SPIR-V: the first word is not 0x07230203",
        ));
    }
    if words.len() < HEADER_WORDS {
        let length = words.len();
        return Err(ShaderError::new(format!(
            "the SPIR-V has {length} words, fewer than the 5 of the header"
        )));
    }
    if words[3] > MOST_IDS {
        let bound = words[3];
        return Err(ShaderError::new(format!(
            "word 3: the bound of ids is {bound}, more than {MOST_IDS}"
        )));
    }
    let mut at = HEADER_WORDS;
    while at < words.len() {
        let length = (words[at] >> 16) as usize;
        if length == 0 || at + length > words.len() {
            let left = words.len() - at;
            let opcode = words[at] & 0xffff;
            return Err(ShaderError::new(format!(
                "word {at}: the instruction with opcode {opcode} says it has {length} words, \
                 but {left} are left"
            )));
        }
        at += length;
    }
    Ok(())
}

/// The instructions of a checked module: the position of the first word, and all words.
fn instructions(words: &[u32]) -> impl Iterator<Item = (usize, &[u32])> {
    let mut at = HEADER_WORDS;
    core::iter::from_fn(move || {
        let length = (*words.get(at)? >> 16) as usize;
        let instruction = words.get(at..at + length)?;
        at += length.max(1);
        Some((at - length, instruction))
    })
}

fn describe(words: &[u32], error: &spv::Error) -> ShaderError {
    let with_opcode = |opcode: u32| {
        instructions(words)
            .find(|(_, instruction)| instruction[0] & 0xffff == opcode)
            .map(|(at, _)| at)
    };
    let with_operand = |operand: u32| {
        instructions(words)
            .find(|(_, instruction)| instruction[1..].contains(&operand))
            .map(|(at, _)| at)
    };
    let (message, word) = match error {
        spv::Error::UnsupportedInstruction(_, op) => (
            format!("the instruction Op{op:?} is not supported here"),
            with_opcode(*op as u32),
        ),
        spv::Error::UnknownInstruction(opcode) => (
            format!("the instruction with opcode {opcode} is unknown"),
            with_opcode(u32::from(*opcode)),
        ),
        spv::Error::InvalidParameter(op) | spv::Error::InvalidOperandCount(op, _) => (
            format!("the instruction Op{op:?} has wrong operands"),
            with_opcode(*op as u32),
        ),
        spv::Error::UnsupportedCapability(capability) => (
            format!("the capability {capability:?} is not supported"),
            capability_at(words, *capability as u32),
        ),
        spv::Error::UnknownCapability(capability) => (
            format!("the capability {capability} is unknown"),
            capability_at(words, *capability),
        ),
        spv::Error::InvalidId(id) => (
            format!("the id %{id} is not defined, or not of the kind that is needed"),
            with_operand(*id),
        ),
        spv::Error::InvalidHeader => ("the header is not that of SPIR-V".to_owned(), Some(0)),
        spv::Error::IncompleteData => ("the SPIR-V ends in the middle".to_owned(), None),
        spv::Error::UnsupportedControlFlow(id) | spv::Error::InvalidAccessType(id) => {
            (Words::Wgsl.plain(error), with_operand(*id))
        }
        other => (Words::Wgsl.plain(other), None),
    };
    match word {
        Some(word) => ShaderError::new(format!("word {word}: {message}")),
        None => ShaderError::new(message),
    }
}

fn capability_at(words: &[u32], capability: u32) -> Option<usize> {
    /// `OpCapability` (SPIR-V 1.6, section 3.49.2).
    const OP_CAPABILITY: u32 = 17;
    instructions(words)
        .find(|(_, instruction)| {
            instruction[0] & 0xffff == OP_CAPABILITY && instruction.get(1) == Some(&capability)
        })
        .map(|(at, _)| at)
}
