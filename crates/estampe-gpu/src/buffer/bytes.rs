//! Bytes of numbers, and of the little-endian words that a buffer's memory is made of.

/// A number, or an array of numbers, that buffers hold: see [`bytes_of`]. There is no `f64`, so
/// that literals become `f32`.
pub trait BufferNumber: bytemuck::NoUninit {}

macro_rules! buffer_numbers {
    ($($number:ty)*) => { $(impl BufferNumber for $number {})* };
}

buffer_numbers!(u8 i8 u16 i16 u32 i32 f32);

impl<T: BufferNumber, const N: usize> BufferNumber for [T; N] where Self: bytemuck::NoUninit {}

/// The bytes of numbers or of arrays of them, as buffers and textures hold them on little-endian
/// machines.
#[must_use]
pub fn bytes_of<T: BufferNumber>(numbers: &[T]) -> &[u8] {
    bytemuck::cast_slice(numbers)
}
/// Lets `use_bytes` see little-endian words as bytes, without a copy on little-endian machines.
pub(crate) fn with_bytes<T>(words: &[u32], use_bytes: impl FnOnce(&[u8]) -> T) -> T {
    if cfg!(target_endian = "little") {
        return use_bytes(bytemuck::cast_slice(words));
    }
    let mut bytes = vec![0; words.len() * 4];
    read_bytes(words, 0, &mut bytes);
    use_bytes(&bytes)
}

/// Lets `use_bytes` change little-endian words as bytes, without a copy on little-endian machines.
pub(crate) fn with_bytes_mut<T>(words: &mut [u32], use_bytes: impl FnOnce(&mut [u8]) -> T) -> T {
    if cfg!(target_endian = "little") {
        return use_bytes(bytemuck::cast_slice_mut(words));
    }
    let mut bytes = vec![0; words.len() * 4];
    read_bytes(words, 0, &mut bytes);
    let result = use_bytes(&mut bytes);
    write_bytes(words, 0, &bytes);
    result
}

/// Copies bytes into little-endian words.
pub(crate) fn write_bytes(words: &mut [u32], offset: usize, bytes: &[u8]) {
    if cfg!(target_endian = "little") {
        let to: &mut [u8] = bytemuck::cast_slice_mut(words);
        to[offset..][..bytes.len()].copy_from_slice(bytes);
        return;
    }
    for (at, byte) in (offset..).zip(bytes) {
        let mut word = words[at / 4].to_le_bytes();
        word[at % 4] = *byte;
        words[at / 4] = u32::from_le_bytes(word);
    }
}

/// Copies bytes from little-endian words.
pub(crate) fn read_bytes(words: &[u32], offset: usize, bytes: &mut [u8]) {
    if cfg!(target_endian = "little") {
        let from: &[u8] = bytemuck::cast_slice(words);
        bytes.copy_from_slice(&from[offset..][..bytes.len()]);
        return;
    }
    for (at, byte) in (offset..).zip(bytes) {
        *byte = words[at / 4].to_le_bytes()[at % 4];
    }
}
