//! Vertex fetch (V2): attributes from buffers, sixteen vertices at a time.
//!
//! *In* vertex and instance indices · *Out* attribute scalars, structure of arrays · *Spec* WebGPU
//! §Vertex formats. Bytes beyond a buffer's end read as zeros; what a format lacks is (0, 0, 0, 1).

use crate::pipeline::AttributeSource;
use estampe_simd::{Bytes, LANES, Lanes, Packet, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16};
use estampe_types::{Buffer, VertexFormat};

/// Fills `out` with the scalars of every attribute; `wanted` says how many each location has.
#[inline(always)]
pub(crate) fn fetch<S: Lanes>(
    s: S,
    sources: &[AttributeSource],
    wanted: &[usize],
    buffers: &[Buffer],
    [vertex, instance]: [&Packet<u32>; 2],
    out: &mut [Packet<f32>],
) {
    let mut next = out.iter_mut();
    for (source, &wanted) in sources.iter().zip(wanted) {
        let index = if source.per_instance {
            instance
        } else {
            vertex
        };
        let index = u32x16::load_array_ref(s, &index.0);
        let mut element = Element::new(source, buffers.get(source.buffer));
        let inside = index.simd_lt(<u32x16<S> as SimdBase<S>>::splat(s, element.count));
        element.is_inside = s.bits_of_mask(inside) == u16::MAX;
        for component in 0..wanted {
            let value = if component < source.attribute.format.components() {
                element.component(s, index, component)
            } else {
                SimdBase::splat(s, if component == 3 { 1.0 } else { 0.0 })
            };
            if let Some(packet) = next.next() {
                value.store_array(&mut packet.0);
            }
        }
    }
}

/// One attribute in its buffer.
struct Element<'a> {
    buffer: Option<&'a Buffer>,
    format: VertexFormat,
    stride: u32,
    offset: u32,
    /// How many elements hold the attribute whole.
    count: u32,
    /// Whether all sixteen elements that are wanted are among those.
    is_inside: bool,
}

impl<'a> Element<'a> {
    #[inline(always)]
    fn new(source: &AttributeSource, buffer: Option<&'a Buffer>) -> Self {
        let (offset, stride) = (source.attribute.offset, source.stride);
        let end = offset as usize + source.attribute.format.size_bytes();
        let spare = buffer.and_then(|buffer| buffer.len_bytes().checked_sub(end));
        let count = match (spare, stride) {
            (None, _) => 0,
            (Some(_), 0) => u32::MAX,
            (Some(spare), stride) => u32::try_from(spare / stride as usize + 1).unwrap_or(u32::MAX),
        };
        Self {
            buffer,
            format: source.attribute.format,
            stride,
            offset,
            count,
            is_inside: false,
        }
    }

    /// One component of sixteen elements.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a component is 0, 1, 2 or 3"
    )]
    fn component<S: Lanes>(&self, s: S, index: u32x16<S>, component: usize) -> f32x16<S> {
        match self.format {
            VertexFormat::Float32
            | VertexFormat::Float32x2
            | VertexFormat::Float32x3
            | VertexFormat::Float32x4 => self.word(s, index, component * 4).bitcast(),
            VertexFormat::Unorm8x2 | VertexFormat::Unorm8x4 => {
                let word = self.word(s, index, 0);
                let code = (word >> (component as u32 * 8)) & 0xFF;
                float(code) * (1.0 / 255.0)
            }
            VertexFormat::Unorm16x2 | VertexFormat::Unorm16x4 => {
                let word = self.word(s, index, component / 2 * 4);
                let code = (word >> (component as u32 % 2 * 16)) & 0xFFFF;
                float(code) * (1.0 / 65_535.0)
            }
            // `VertexFormat` grows; a format without a reader cannot pass for zeros unnoticed.
            other => unreachable!("vertex format {other:?} has no reader"),
        }
    }

    /// The word at a byte of sixteen elements, what lies beyond the buffer's end zero.
    #[inline(always)]
    fn word<S: Lanes>(&self, s: S, index: u32x16<S>, byte: usize) -> u32x16<S> {
        let Some(buffer) = self.buffer else {
            return SimdBase::splat(s, 0);
        };
        let start = self.offset as usize + byte;
        if self.is_inside && self.stride.is_multiple_of(4) && start.is_multiple_of(4) {
            let stride = <u32x16<S> as SimdBase<S>>::splat(s, self.stride / 4);
            let first = u32::try_from(start / 4).unwrap_or(u32::MAX);
            return s.gather(
                buffer.words(),
                index * stride + <u32x16<S> as SimdBase<S>>::splat(s, first),
            );
        }
        let mut words = [0; LANES];
        for (word, &index) in words.iter_mut().zip(index.as_slice()) {
            let element = (index as usize).saturating_mul(self.stride as usize);
            *word = buffer.word_at(start.saturating_add(element));
        }
        u32x16::load_array(s, words)
    }
}

/// Codes of at most 16 bits as floats.
#[inline(always)]
fn float<S: Lanes>(code: u32x16<S>) -> f32x16<S> {
    let signed: i32x16<S> = code.bitcast();
    f32x16::float_from(signed)
}
