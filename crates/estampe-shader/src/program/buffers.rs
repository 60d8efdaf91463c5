//! The buffers that a draw or dispatch binds, as a kernel numbers them.

use estampe_ir::interface::BufferSlot;
use estampe_ir::interpreter::Buffer;
use estampe_types::Bindings;

/// The buffers that take no allocation, as a shader is given new ones for each batch.
const FEW: usize = 4;

/// The buffers of a stage. Those that are not bound are empty.
#[derive(Debug)]
pub(super) struct BoundBuffers<'a> {
    few: [Buffer<'a>; FEW],
    /// All, if they are more than a few.
    more: Vec<Buffer<'a>>,
    count: usize,
}

impl<'a> BoundBuffers<'a> {
    /// The buffers of these slots among the resources that a draw binds.
    #[inline]
    pub(super) fn new(bindings: &'a Bindings, slots: &[BufferSlot]) -> Self {
        let mut buffers = Self {
            few: [Buffer::default(); FEW],
            more: Vec::new(),
            count: slots.len(),
        };
        if slots.len() <= FEW {
            for (to, slot) in buffers.few.iter_mut().zip(slots) {
                *to = buffer(bindings, slot);
            }
        } else {
            buffers.more = slots.iter().map(|slot| buffer(bindings, slot)).collect();
        }
        buffers
    }

    /// All of them, in the order of the slots.
    #[inline]
    pub(super) fn all(&self) -> &[Buffer<'a>] {
        self.few.get(..self.count).unwrap_or(&self.more)
    }
}

fn buffer<'a>(bindings: &'a Bindings, slot: &BufferSlot) -> Buffer<'a> {
    if *slot == BufferSlot::IMMEDIATES {
        let words = &bindings.immediates[..];
        return Buffer::read_only(words, words.len() * 4);
    }
    let (group, binding) = (slot.group, slot.binding);
    if let Some((buffer, range)) = bindings.buffer(group, binding) {
        let words = buffer.words().get(range.start / 4..).unwrap_or_default();
        return Buffer::read_only(words, range.len());
    }
    let stored = bindings.storage_buffer(group, binding);
    stored.map_or_else(Buffer::default, |(buffer, range)| {
        let words = buffer.words().get(range.start / 4..).unwrap_or_default();
        Buffer::shared(words, range.len())
    })
}
