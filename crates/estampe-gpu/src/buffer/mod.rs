//! Buffers: memory for vertices, indices, uniforms, storage and indirect draws.

mod bytes;
mod error;
mod slice;
mod stores;

pub use bytes::{BufferNumber, bytes_of};
pub(crate) use bytes::{read_bytes, with_bytes, with_bytes_mut, write_bytes};
pub use error::BufferError;
pub use slice::BufferSlice;
pub use stores::BufferConflict;
pub(crate) use stores::{StoredBuffers, check_conflicts};

use crate::Limits;
use estampe_types::BufferData;
use std::ops::{Bound, Range, RangeBounds};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

bitflags::bitflags! {
    /// The uses of a buffer: WebGPU's `GPUBufferUsage`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub struct BufferUsages: u32 {
        /// Read by the host: [`Buffer::read`], [`Buffer::map_read`].
        const MAP_READ = 1;
        /// Written by the host through [`Buffer::map_write`].
        const MAP_WRITE = 1 << 1;
        /// Source of copies.
        const COPY_SRC = 1 << 2;
        /// Destination of copies and of [`Buffer::write`].
        const COPY_DST = 1 << 3;
        /// Index buffer of draws.
        const INDEX = 1 << 4;
        /// Vertex buffer of draws.
        const VERTEX = 1 << 5;
        /// Uniform buffer of shaders.
        const UNIFORM = 1 << 6;
        /// Storage buffer of shaders.
        const STORAGE = 1 << 7;
        /// Parameters of indirect draws.
        const INDIRECT = 1 << 8;
    }
}

/// Describes a buffer: WebGPU's `GPUBufferDescriptor`.
#[derive(Debug, Clone)]
pub struct BufferDescriptor<'a> {
    /// A name for error messages. Default none.
    pub label: Option<&'a str>,
    /// Bytes of the buffer.
    pub size: u64,
    /// The uses that are allowed. Default all.
    pub usage: BufferUsages,
}

impl BufferDescriptor<'_> {
    /// A buffer of this size for all uses.
    #[must_use]
    pub fn new(size: u64) -> Self {
        Self {
            label: None,
            size,
            usage: BufferUsages::all(),
        }
    }
}

/// Memory that the host writes and reads in part, and that draws, copies and shaders use. Clones
/// are handles to the same memory.
///
/// ```
/// use estampe::{BufferDescriptor, Device, DeviceDescriptor, bytes_of};
///
/// let device = Device::new(&DeviceDescriptor::default())?;
/// let buffer = device.create_buffer(&BufferDescriptor::new(12))?;
/// buffer.write(4, bytes_of(&[1.5_f32]))?;
/// let sum = buffer.map_read(0..12, |bytes| bytes.iter().map(|&b| u32::from(b)).sum::<u32>())?;
/// assert_eq!(sum, 0xC0 + 0x3F);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A draw reads what the buffer holds when its pass begins: writes by other threads meanwhile go
/// into a copy.
#[derive(Clone)]
pub struct Buffer {
    inner: Arc<Inner>,
}

struct Inner {
    label: Option<String>,
    size: u64,
    usage: BufferUsages,
    data: Mutex<BufferData>,
}

impl Buffer {
    pub(crate) fn new(
        descriptor: &BufferDescriptor<'_>,
        limits: &Limits,
    ) -> Result<Self, BufferError> {
        let size = check_size(descriptor.label, descriptor.size, limits)?;
        let data = BufferData::zeros(size).ok_or_else(|| BufferError::OutOfMemory {
            buffer: name_of(descriptor.label),
            size: descriptor.size,
        })?;
        Ok(Self::of_data(descriptor.label, descriptor.usage, data))
    }

    pub(crate) fn with_contents(
        label: Option<&str>,
        usage: BufferUsages,
        contents: &[u8],
        limits: &Limits,
    ) -> Result<Self, BufferError> {
        check_size(label, contents.len() as u64, limits)?;
        let data =
            BufferData::try_from_bytes(contents).ok_or_else(|| BufferError::OutOfMemory {
                buffer: name_of(label),
                size: contents.len() as u64,
            })?;
        Ok(Self::of_data(label, usage, data))
    }

    pub(crate) fn of_words(words: Vec<u32>, limits: &Limits) -> Result<Self, BufferError> {
        check_size(None, words.len() as u64 * 4, limits)?;
        let data = BufferData::from_words(words);
        Ok(Self::of_data(None, BufferUsages::all(), data))
    }

    fn of_data(label: Option<&str>, usage: BufferUsages, data: BufferData) -> Self {
        Self {
            inner: Arc::new(Inner {
                label: label.map(str::to_owned),
                size: data.len_bytes() as u64,
                usage,
                data: Mutex::new(data),
            }),
        }
    }

    /// The size in bytes.
    #[must_use]
    pub fn size(&self) -> u64 {
        self.inner.size
    }

    /// The uses that the buffer was created for.
    #[must_use]
    pub fn usage(&self) -> BufferUsages {
        self.inner.usage
    }

    /// The label, as messages name the buffer.
    pub(crate) fn name(&self) -> String {
        name_of(self.inner.label.as_deref())
    }

    /// A part of the buffer, in bytes; `..` is all of it. What is beyond the buffer's end is an
    /// error where the slice is used.
    #[must_use]
    pub fn slice(&self, range: impl RangeBounds<u64>) -> BufferSlice {
        let offset = match range.start_bound() {
            Bound::Included(first) => *first,
            Bound::Excluded(before) => before.saturating_add(1),
            Bound::Unbounded => 0,
        };
        let end = match range.end_bound() {
            Bound::Included(last) => last.saturating_add(1),
            Bound::Excluded(end) => *end,
            Bound::Unbounded => self.size(),
        };
        BufferSlice {
            buffer: self.clone(),
            offset,
            size: end.saturating_sub(offset),
        }
    }

    /// Writes bytes at an offset (WebGPU's `writeBuffer`).
    ///
    /// # Errors
    /// [`BufferError`] if the bytes do not fit, or the buffer has no [`BufferUsages::COPY_DST`].
    pub fn write(&self, offset: u64, bytes: &[u8]) -> Result<(), BufferError> {
        self.require(BufferUsages::COPY_DST)?;
        let range = self.range(offset, bytes.len() as u64)?;
        write_bytes(self.lock().words_mut(), range.start, bytes);
        Ok(())
    }

    /// Reads bytes from an offset on.
    ///
    /// # Errors
    /// [`BufferError`] if the range ends beyond the buffer, or the buffer has no
    /// [`BufferUsages::MAP_READ`].
    pub fn read(&self, offset: u64, bytes: &mut [u8]) -> Result<(), BufferError> {
        self.require(BufferUsages::MAP_READ)?;
        let range = self.range(offset, bytes.len() as u64)?;
        read_bytes(self.lock().words(), range.start, bytes);
        Ok(())
    }

    /// Lets `use_bytes` see a range of the buffer, without a copy on little-endian machines. It
    /// must not use this buffer otherwise, as it would wait for itself.
    ///
    /// # Errors
    /// [`BufferError`] as for [`Buffer::read`].
    pub fn map_read<T>(
        &self,
        range: Range<u64>,
        use_bytes: impl FnOnce(&[u8]) -> T,
    ) -> Result<T, BufferError> {
        self.require(BufferUsages::MAP_READ)?;
        let range = self.range(range.start, range.end.saturating_sub(range.start))?;
        Ok(with_bytes(self.lock().words(), |bytes| {
            use_bytes(&bytes[range])
        }))
    }

    /// Lets `use_bytes` change a range of the buffer, without a copy on little-endian machines. The
    /// bytes are those of the buffer before. It must not use this buffer otherwise, as it would
    /// wait for itself.
    ///
    /// # Errors
    /// [`BufferError`] if the range ends beyond the buffer, or the buffer has no
    /// [`BufferUsages::MAP_WRITE`].
    pub fn map_write<T>(
        &self,
        range: Range<u64>,
        use_bytes: impl FnOnce(&mut [u8]) -> T,
    ) -> Result<T, BufferError> {
        self.require(BufferUsages::MAP_WRITE)?;
        let range = self.range(range.start, range.end.saturating_sub(range.start))?;
        Ok(with_bytes_mut(self.lock().words_mut(), |bytes| {
            use_bytes(&mut bytes[range])
        }))
    }

    /// The contents as they are now; later writes do not change them.
    pub(crate) fn data(&self) -> BufferData {
        self.lock().clone()
    }

    pub(crate) fn lock(&self) -> MutexGuard<'_, BufferData> {
        // Plain data: after a panic elsewhere it is as good as before.
        let data = &self.inner.data;
        data.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn out_of_memory(&self) -> BufferError {
        BufferError::OutOfMemory {
            buffer: self.name(),
            size: self.size(),
        }
    }

    /// A number that tells buffers apart.
    pub(crate) fn id(&self) -> usize {
        Arc::as_ptr(&self.inner).addr()
    }

    /// Returns true if both are handles to the same memory.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.inner, &other.inner)
    }

    pub(crate) fn require(&self, needed: BufferUsages) -> Result<(), BufferError> {
        if self.inner.usage.contains(needed) {
            return Ok(());
        }
        Err(BufferError::Usage {
            buffer: self.name(),
            needed,
        })
    }

    /// A range of bytes, if it lies in the buffer.
    pub(crate) fn range(&self, offset: u64, len: u64) -> Result<Range<usize>, BufferError> {
        let range = offset..offset.saturating_add(len);
        let within = |at: u64| usize::try_from(at).ok().filter(|_| at <= self.size());
        match (within(range.start), within(range.end)) {
            (Some(start), Some(end)) => Ok(start..end),
            _ => Err(BufferError::Range {
                buffer: self.name(),
                range,
                size: self.size(),
            }),
        }
    }
}

impl std::fmt::Debug for Buffer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Buffer({}, {} bytes)", self.name(), self.size())
    }
}

fn name_of(label: Option<&str>) -> String {
    label.map_or("a buffer".to_owned(), |label| {
        format!("the buffer `{label}`")
    })
}

fn check_size(label: Option<&str>, size: u64, limits: &Limits) -> Result<usize, BufferError> {
    let limit = limits.max_buffer_size;
    usize::try_from(size)
        .ok()
        .filter(|_| size <= limit)
        .ok_or_else(|| BufferError::TooLarge {
            buffer: name_of(label),
            size,
            limit,
        })
}
