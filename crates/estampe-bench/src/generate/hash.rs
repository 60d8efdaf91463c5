//! Pseudo-random numbers from integers, by hashing.

/// Chris Wellons' *lowbias32*: every input bit reaches every output bit with a bias below 0.2.
#[must_use]
pub fn hash32(key: u32) -> u32 {
    let mixed = (key ^ (key >> 16)).wrapping_mul(0x7FEB_352D);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x846C_A68B);
    mixed ^ (mixed >> 16)
}

/// The hash as a number in 0..1: its upper 24 bits, exact in binary32 too.
#[must_use]
pub fn unit_hash(key: u32) -> f64 {
    f64::from(hash32(key) >> 8) / f64::from(1 << 24)
}
