//! Little-endian encoding of numbers: the one place where binary64 becomes binary32.

use super::Matrix;

/// Bytes of a vertex, index or uniform buffer, written in order.
#[derive(Debug, Clone, Default)]
pub struct LittleEndian {
    bytes: Vec<u8>,
}

impl LittleEndian {
    /// An empty buffer with capacity for `len_bytes`.
    #[must_use]
    pub fn with_capacity(len_bytes: usize) -> Self {
        Self {
            bytes: Vec::with_capacity(len_bytes),
        }
    }

    /// Appends numbers, each rounded to binary32.
    pub fn reals(&mut self, values: &[f64]) {
        for &value in values {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "the rounding to binary32 that the definition asks for"
            )]
            let rounded = value as f32;
            self.bytes.extend(rounded.to_le_bytes());
        }
    }

    /// Appends a matrix, column by column, each number rounded to binary32.
    pub fn matrix(&mut self, matrix: &Matrix) {
        for column in &matrix.columns {
            self.reals(column);
        }
    }

    /// Appends 32-bit integers.
    pub fn words(&mut self, values: &[u32]) {
        for value in values {
            self.bytes.extend(value.to_le_bytes());
        }
    }

    /// Appends zeros up to a length; the bytes are no longer than that.
    pub fn pad_to(&mut self, len_bytes: u32) {
        self.bytes.resize(len_bytes as usize, 0);
    }

    /// Appends bytes unchanged.
    pub fn raw(&mut self, values: &[u8]) {
        self.bytes.extend(values);
    }

    /// Appends numbers in 0..256, each rounded down to a byte.
    pub fn color(&mut self, channels: [f64; 4]) {
        for channel in channels {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a whole number in 0..=255"
            )]
            let byte = channel.floor() as u8;
            self.bytes.push(byte);
        }
    }

    /// The number of written bytes.
    #[must_use]
    pub fn len_bytes(&self) -> usize {
        self.bytes.len()
    }

    /// The written bytes.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}
