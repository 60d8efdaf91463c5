//! The buffers that a draw or dispatch binds, as a kernel numbers them.

use estampe_ir::interface::BufferSlot;
use estampe_ir::interpreter::Buffer;
use estampe_types::Bindings;

/// The buffers that take no allocation, as a shader is given new ones for each batch.
const FEW: usize = 4;

/// The buffers of a stage. Those that are not bound are empty.
#[derive(Debug)]
pub(super) enum BoundBuffers<'a> {
    None,
    Few([Buffer<'a>; FEW], usize),
    Many(Vec<Buffer<'a>>),
}

impl<'a> BoundBuffers<'a> {
    /// The buffers of these slots among the resources that a draw binds.
    #[inline(always)]
    pub(super) fn new(bindings: &'a Bindings, slots: &[BufferSlot]) -> Self {
        match slots.len() {
            0 => Self::None,
            count @ ..=FEW => {
                let mut few = [Buffer::default(); FEW];
                for (to, slot) in few.iter_mut().zip(slots) {
                    *to = buffer(bindings, slot);
                }
                Self::Few(few, count)
            }
            _ => Self::Many(slots.iter().map(|slot| buffer(bindings, slot)).collect()),
        }
    }

    /// All of them, in the order of the slots.
    #[inline(always)]
    pub(super) fn all(&self) -> &[Buffer<'a>] {
        match self {
            Self::None => &[],
            Self::Few(few, count) => few.get(..*count).unwrap_or_default(),
            Self::Many(all) => all,
        }
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
