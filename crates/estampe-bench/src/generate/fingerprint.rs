//! FNV-1a hash of generated data: generators with equal hashes agree on every byte.

/// A running 64-bit FNV-1a hash (Fowler, Noll, Vo; `draft-eastlake-fnv`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Fingerprint {
    const OFFSET_BASIS: u64 = 0xCBF2_9CE4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01B3;

    /// Adds bytes to the hash.
    pub fn update(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |hash, &byte| {
            (hash ^ u64::from(byte)).wrapping_mul(Self::PRIME)
        });
    }

    /// The hash of all bytes so far.
    #[must_use]
    pub fn value(self) -> u64 {
        self.0
    }
}

impl Default for Fingerprint {
    /// The hash of no bytes.
    fn default() -> Self {
        Self(Self::OFFSET_BASIS)
    }
}
