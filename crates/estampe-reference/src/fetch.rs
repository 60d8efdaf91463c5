//! Vertex fetch: which vertex it is, and its attributes from the buffers.
//!
//! In · Out: buffers and indices · four numbers per location. Spec: NUMERICS.md, *Vertex fetch*;
//! WebGPU, "vertex processing". What lies beyond a buffer's end reads as zeros.

use estampe_types::state::{VertexBufferLayout, VertexStepMode};
use estampe_types::{Buffer, IndexFormat, VertexFormat};

/// 1/65535, rounded to f32.
const INVERSE_65535: f32 = 1.0 / 65_535.0;

/// What a component that the buffer's format lacks reads as: (0, 0, 0, 1).
const MISSING: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// Element `position` of an index buffer, plus the base vertex (modulo 2³²).
#[must_use]
pub fn index(format: IndexFormat, buffer: &Buffer, position: u32, base_vertex: i32) -> u32 {
    let at = |width: usize| (position as usize).saturating_mul(width);
    let stored = match format {
        IndexFormat::Uint8 => u32::from(buffer.byte(at(1))),
        IndexFormat::Uint16 => u32::from(u16_at(buffer, at(2))),
        IndexFormat::Uint32 => buffer.word_at(at(4)),
    };
    stored.wrapping_add_signed(base_vertex)
}

/// The attribute at a location: from the first layout that names it, zeros if none does.
#[must_use]
pub fn attribute(
    buffers: &[(VertexBufferLayout, Buffer)],
    location: u32,
    vertex_index: u32,
    instance_index: u32,
) -> [f32; 4] {
    for (layout, buffer) in buffers {
        for attribute in &layout.attributes {
            if attribute.shader_location == location {
                let element = match layout.step_mode {
                    VertexStepMode::Vertex => vertex_index,
                    VertexStepMode::Instance => instance_index,
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

/// The numbers at a byte offset, filled up with (0, 0, 0, 1).
#[must_use]
pub fn decode(format: VertexFormat, buffer: &Buffer, offset: usize) -> [f32; 4] {
    let mut values = MISSING;
    let width = format.size_bytes() / format.components();
    for (component, value) in values.iter_mut().enumerate().take(format.components()) {
        let at = offset.saturating_add(component * width);
        // The width of a component tells its kind: every format so far is one of these three.
        *value = match width {
            1 => f32::from(buffer.byte(at)) * crate::color::INVERSE_255,
            2 => f32::from(u16_at(buffer, at)) * INVERSE_65535,
            _ => f32::from_bits(buffer.word_at(at)),
        };
    }
    values
}

fn u16_at(buffer: &Buffer, offset: usize) -> u16 {
    u16::from_le_bytes([buffer.byte(offset), buffer.byte(offset.saturating_add(1))])
}
