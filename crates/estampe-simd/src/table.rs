//! A table with an element for each byte.

/// 256 elements, to be looked up by bytes.
#[derive(Debug, Clone)]
pub struct ByteTable {
    /// The elements.
    pub(crate) elements: [u32; 256],
    /// Their first bytes, their second ones, and so on.
    #[cfg_attr(not(target_arch = "x86_64"), expect(dead_code, reason = "for AVX-512"))]
    pub(crate) bytes: [Bytes; 4],
}

/// Aligned like the registers that they are loaded into.
#[derive(Debug, Clone)]
#[repr(align(64))]
#[cfg_attr(
    not(target_arch = "x86_64"),
    allow(dead_code, reason = "only the levels of x86-64 read it")
)]
pub(crate) struct Bytes(pub(crate) [u8; 256]);

impl ByteTable {
    /// A table of these elements.
    #[must_use]
    pub fn new(elements: [u32; 256]) -> Self {
        let bytes = [0, 1, 2, 3].map(|k| Bytes(elements.map(|element| element.to_le_bytes()[k])));
        Self { elements, bytes }
    }

    /// The element of a byte.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, byte: u8) -> u32 {
        self.elements[usize::from(byte)]
    }
}
