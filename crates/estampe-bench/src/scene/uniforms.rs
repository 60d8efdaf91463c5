//! Uniforms read from the bytes that the fingerprint covers, so that shaders use exactly these
//! numbers.

use estampe::Mat4;

/// The 4×4 matrix at a byte offset, by columns.
pub(super) fn matrix(bytes: &[u8], offset: usize) -> Mat4 {
    Mat4([0, 16, 32, 48].map(|column| floats(bytes, offset + column)))
}

/// The three floats at a byte offset.
pub(super) fn vector(bytes: &[u8], offset: usize) -> [f32; 3] {
    floats(bytes, offset)
}

fn floats<const N: usize>(bytes: &[u8], offset: usize) -> [f32; N] {
    let mut values = [0.0; N];
    for (value, word) in values.iter_mut().zip(bytes[offset..].as_chunks().0) {
        *value = f32::from_le_bytes(*word);
    }
    values
}
