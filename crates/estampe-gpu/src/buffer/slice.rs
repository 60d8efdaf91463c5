//! Parts of buffers.

use super::Buffer;

/// A part of a buffer, as draws and bind groups name it.
#[derive(Debug, Clone)]
pub struct BufferSlice {
    /// The buffer.
    pub buffer: Buffer,
    /// The first byte, a multiple of 4.
    pub offset: u64,
    /// The number of bytes.
    pub size: u64,
}

impl From<&Buffer> for BufferSlice {
    /// The whole buffer.
    fn from(buffer: &Buffer) -> Self {
        Self {
            buffer: buffer.clone(),
            offset: 0,
            size: buffer.size(),
        }
    }
}
