//! Vertex fetch: the index of a vertex, and its attributes from the vertex buffers.
//!
//! In · Out: buffers and indices · four numbers per location. Spec: NUMERICS.md, *Vertex fetch*;
//! WebGPU, "vertex processing". Bytes beyond a buffer's end read as zeros. Integers are passed on
//! as the bits of f32.

use crate::arithmetic::max;
use estampe_types::state::{VertexBufferLayout, VertexStepMode};
use estampe_types::{BufferData, IndexFormat, VertexEncoding, VertexFormat};

/// Element `position` of an index buffer, plus the base vertex (modulo 2³²).
#[must_use]
pub fn index(format: IndexFormat, buffer: &BufferData, position: u32, base_vertex: i32) -> u32 {
    raw_index(format, buffer, position).wrapping_add_signed(base_vertex)
}

/// Element `position` of an index buffer, without the base vertex.
#[must_use]
pub fn raw_index(format: IndexFormat, buffer: &BufferData, position: u32) -> u32 {
    let at = |width: usize| (position as usize).saturating_mul(width);
    match format {
        IndexFormat::Uint8 => u32::from(byte_at(buffer, at(1))),
        IndexFormat::Uint16 => u32::from(u16_at(buffer, at(2))),
        IndexFormat::Uint32 => word_at(buffer, at(4)),
    }
}

/// The element of an instance-stepped buffer that an instance reads.
#[must_use]
pub fn instance_element(instance: u32, first_instance: u32, step_rate: u32) -> u32 {
    match step_rate {
        0 => first_instance,
        rate => first_instance + (instance - first_instance) / rate,
    }
}

/// The attribute at a location: from the first layout that names it; zeros if none does.
#[must_use]
pub fn attribute(
    buffers: &[(VertexBufferLayout, BufferData)],
    location: u32,
    vertex_index: u32,
    [instance_index, first_instance]: [u32; 2],
) -> [f32; 4] {
    for (layout, buffer) in buffers {
        for attribute in &layout.attributes {
            if attribute.shader_location == location {
                let element = match layout.step_mode {
                    VertexStepMode::Vertex => vertex_index,
                    VertexStepMode::Instance => {
                        instance_element(instance_index, first_instance, layout.instance_step_rate)
                    }
                };
                let offset = (element as usize)
                    .saturating_mul(layout.array_stride as usize)
                    .saturating_add(attribute.offset as usize);
                return decode(attribute.format, buffer, offset);
            }
        }
    }
    [0.0; 4]
}

/// The attribute at a byte offset, decoded; missing components are (0, 0, 0, 1).
#[must_use]
pub fn decode(format: VertexFormat, buffer: &BufferData, offset: usize) -> [f32; 4] {
    use VertexFormat as F;
    let byte = |k: usize| byte_at(buffer, offset.saturating_add(k));
    let short = |k: usize| u16_at(buffer, offset.saturating_add(2 * k));
    let word = |k: usize| word_at(buffer, offset.saturating_add(4 * k));

    let unorm = |code: u32, greatest: f32| code as f32 * (1.0 / greatest);
    let snorm = |code: i32, greatest: f32| max(code as f32 * (1.0 / greatest), -1.0);
    let signed = |code: i32| f32::from_bits(code.cast_unsigned());
    let packed = |shift: u32, bits: u32| word(0) >> shift & ((1 << bits) - 1);

    let component = |k: usize| match format {
        F::Float32 | F::Float32x2 | F::Float32x3 | F::Float32x4 => f32::from_bits(word(k)),
        F::Float16 | F::Float16x2 | F::Float16x4 => half(short(k)),
        F::Unorm8 | F::Unorm8x2 | F::Unorm8x4 => unorm(byte(k).into(), 255.0),
        F::Unorm8x4Bgra => unorm(byte([2, 1, 0, 3][k]).into(), 255.0),
        F::Unorm16 | F::Unorm16x2 | F::Unorm16x4 => unorm(short(k).into(), 65_535.0),
        F::Unorm10_10_10_2 if k == 3 => unorm(packed(30, 2), 3.0),
        F::Unorm10_10_10_2 => unorm(packed([0, 10, 20][k], 10), 1023.0),
        F::Snorm8 | F::Snorm8x2 | F::Snorm8x4 => snorm(byte(k).cast_signed().into(), 127.0),
        F::Snorm16 | F::Snorm16x2 | F::Snorm16x4 => snorm(short(k).cast_signed().into(), 32_767.0),
        F::Uint8 | F::Uint8x2 | F::Uint8x4 => f32::from_bits(byte(k).into()),
        F::Uint16 | F::Uint16x2 | F::Uint16x4 => f32::from_bits(short(k).into()),
        F::Sint8 | F::Sint8x2 | F::Sint8x4 => signed(byte(k).cast_signed().into()),
        F::Sint16 | F::Sint16x2 | F::Sint16x4 => signed(short(k).cast_signed().into()),
        // 32-bit integers are passed on as bits.
        F::Uint32 | F::Uint32x2 | F::Uint32x3 | F::Uint32x4 => f32::from_bits(word(k)),
        F::Sint32 | F::Sint32x2 | F::Sint32x3 | F::Sint32x4 => f32::from_bits(word(k)),
        other => unreachable!("vertex format {other:?} has no reader"),
    };

    let is_integer = matches!(
        format.encoding(),
        VertexEncoding::Uint | VertexEncoding::Sint
    );
    let one = if is_integer { f32::from_bits(1) } else { 1.0 };
    let mut values = [0.0, 0.0, 0.0, one];
    for (k, value) in values.iter_mut().enumerate().take(format.components()) {
        *value = component(k);
    }
    values
}

/// A 16-bit float: 1 sign, 5 exponent and 10 mantissa bits. Exact; the bits of a NaN are kept.
#[must_use]
pub fn half(code: u16) -> f32 {
    let sign = u32::from(code >> 15) << 31;
    let (exponent, mantissa) = (u32::from(code >> 10 & 0x1F), u32::from(code & 0x3FF));
    match exponent {
        // Denormal: a multiple of 2⁻²⁴.
        0 => f32::from_bits((mantissa as f32 / 16_777_216.0).to_bits() | sign),
        0x1F => f32::from_bits(sign | 0x7F80_0000 | mantissa << 13),
        _ => f32::from_bits(sign | (exponent + 112) << 23 | mantissa << 13),
    }
}

fn u16_at(buffer: &BufferData, offset: usize) -> u16 {
    u16::from_le_bytes([0, 1].map(|k| byte_at(buffer, offset.saturating_add(k))))
}

fn word_at(buffer: &BufferData, offset: usize) -> u32 {
    u32::from_le_bytes([0, 1, 2, 3].map(|k| byte_at(buffer, offset.saturating_add(k))))
}

/// A byte of a buffer, which holds little-endian words; zero beyond the end.
fn byte_at(buffer: &BufferData, offset: usize) -> u8 {
    if offset >= buffer.len_bytes() {
        return 0;
    }
    (buffer.words()[offset / 4] >> (offset % 4 * 8) & 0xFF) as u8
}
