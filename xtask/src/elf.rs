//! Just enough of the ELF format for the check of the assembly: the functions of a 64-bit
//! little-endian file, their names and their bytes.
//!
//! Source: Tool Interface Standard, Executable and Linking Format 1.2, and its 64-bit supplement. A
//! crate for object files would be a hundred times what is needed here.

use std::ops::Range;

/// One function symbol.
#[derive(Debug, Clone)]
pub(crate) struct Function<'file> {
    /// The name, mangled as in the file.
    pub(crate) name: &'file str,
    /// The virtual address of its first byte.
    pub(crate) address: u64,
    /// Its machine code.
    pub(crate) code: &'file [u8],
}

const SECTION_HEADER_LEN: usize = 64;
const SYMBOL_LEN: usize = 24;
const SECTION_IS_SYMBOL_TABLE: u32 = 2;
const SYMBOL_IS_FUNCTION: u8 = 2;

/// The functions in the symbol table of `file`; the message says why there are none.
pub(crate) fn functions(file: &[u8]) -> Result<Vec<Function<'_>>, &'static str> {
    const MAGIC_64_LITTLE: &[u8] = &[0x7f, b'E', b'L', b'F', 2, 1];
    if !file.starts_with(MAGIC_64_LITTLE) {
        return Err("it is no 64-bit little-endian ELF file");
    }
    let sections = sections(file).ok_or("its section headers are malformed")?;
    let symbols = sections
        .iter()
        .find(|section| section.kind == SECTION_IS_SYMBOL_TABLE)
        .ok_or("it has no symbol table: was it stripped?")?;
    let table = bytes(file, &symbols.range).ok_or("its symbol table is malformed")?;
    let names = sections
        .get(symbols.link)
        .and_then(|section| bytes(file, &section.range))
        .ok_or("its symbol names are malformed")?;
    Ok(table
        .chunks_exact(SYMBOL_LEN)
        .filter_map(|s| function(file, &sections, names, s))
        .collect())
}

fn function<'file>(
    file: &'file [u8],
    sections: &[Section],
    names: &'file [u8],
    symbol: &[u8],
) -> Option<Function<'file>> {
    if symbol[4] & 0xf != SYMBOL_IS_FUNCTION {
        return None;
    }
    let name_bytes = names.get(usize::try_from(u32_at(symbol, 0)?).ok()?..)?;
    let name_len = name_bytes.iter().position(|&byte| byte == 0)?;
    let section = sections.get(usize::from(u16_at(symbol, 6)?))?;
    let (address, len) = (u64_at(symbol, 8)?, u64_at(symbol, 16)?);
    let start = address
        .checked_sub(section.address)?
        .checked_add(section.range.start)?;
    Some(Function {
        name: std::str::from_utf8(&name_bytes[..name_len]).ok()?,
        address,
        code: bytes(file, &(start..start.checked_add(len)?))?,
    })
}

struct Section {
    kind: u32,
    address: u64,
    range: Range<u64>,
    link: usize,
}

fn sections(file: &[u8]) -> Option<Vec<Section>> {
    let table = usize::try_from(u64_at(file, 0x28)?).ok()?;
    let count = usize::from(u16_at(file, 0x3c)?);
    (0..count)
        .map(|index| {
            let start = table.checked_add(index * SECTION_HEADER_LEN)?;
            let header = file.get(start..)?.get(..SECTION_HEADER_LEN)?;
            let offset = u64_at(header, 24)?;
            Some(Section {
                kind: u32_at(header, 4)?,
                address: u64_at(header, 16)?,
                range: offset..offset.checked_add(u64_at(header, 32)?)?,
                link: usize::try_from(u32_at(header, 40)?).ok()?,
            })
        })
        .collect()
}

fn bytes<'file>(file: &'file [u8], range: &Range<u64>) -> Option<&'file [u8]> {
    file.get(usize::try_from(range.start).ok()?..usize::try_from(range.end).ok()?)
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}

fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    Some(u64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?))
}
