//! Vertex fetch (V2): attributes from buffers, sixteen vertices at a time.
//!
//! *In* vertex and instance indices · *Out* attribute scalars, structure of arrays · *Spec* WebGPU
//! §Vertex formats. Bytes beyond a buffer's end read as zeros; what a format lacks is (0, 0, 0, 1). Integers
//! arrive as bits.

use super::rows::columns_of;
use crate::pipeline::AttributeSource;
use estampe_simd::{
    Bytes, LANES, Lanes, Packet, Select, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16,
};
use estampe_types::{Buffer, VertexEncoding, VertexFormat};

/// Which vertices a packet holds.
#[derive(Debug, Default)]
pub(crate) struct PacketIndex {
    pub(crate) vertex: Packet<u32>,
    pub(crate) instance: Packet<u32>,
    /// The draw's first instance, from which instances step.
    pub(crate) base_instance: u32,
    /// The first vertex, where lane `i` is vertex `first + i` of one instance.
    pub(crate) first: Option<u32>,
}

/// Fills `out` with the scalars of every attribute; `wanted` says how many each location has.
#[inline(always)]
pub(crate) fn fetch<S: Lanes>(
    s: S,
    sources: &[AttributeSource],
    wanted: &[usize],
    buffers: &[Buffer],
    index: &PacketIndex,
    out: &mut [Packet<f32>],
) {
    let mut rest = out;
    for (source, &wanted) in sources.iter().zip(wanted) {
        let Some((scalars, others)) = rest.split_at_mut_checked(wanted) else {
            return;
        };
        rest = others;
        let format = source.attribute.format;
        let there = wanted.min(format.components());
        let words = match buffers.get(source.buffer) {
            Some(buffer) => fetch_words(s, source, buffer, index, words_of(format, there)),
            None => [<u32x16<S> as SimdBase<S>>::splat(s, 0); 4],
        };
        let mut component = 0;
        while component < wanted {
            let value = if component < there {
                decode(s, format, &words, component)
            } else {
                SimdBase::splat(s, f32::from_bits(format.missing(component)))
            };
            value.store_array(&mut scalars[component].0);
            component += 1;
        }
    }
}

/// The words that an attribute's first components lie in.
#[inline(always)]
fn words_of(format: VertexFormat, components: usize) -> usize {
    (components * format.size_bytes() / format.components()).div_ceil(4)
}

/// One component of sixteen elements.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "a component is 0, 1, 2 or 3, and a width at most 32"
)]
fn decode<S: Lanes>(
    s: S,
    format: VertexFormat,
    words: &[u32x16<S>; 4],
    component: usize,
) -> f32x16<S> {
    let (component, bits) = match format {
        VertexFormat::Float32
        | VertexFormat::Float32x2
        | VertexFormat::Float32x3
        | VertexFormat::Float32x4 => return words[component & 3].bitcast(),
        VertexFormat::Unorm10_10_10_2 => {
            let code = words[0] >> (component as u32 * 10);
            return if component == 3 {
                float(code) * (1.0 / 3.0)
            } else {
                float(code & 0x3FF) * (1.0 / 1023.0)
            };
        }
        VertexFormat::Unorm8x4Bgra => ([2, 1, 0, 3][component & 3], 8),
        _ => (component, format.size_bytes() * 8 / format.components()),
    };
    let (word, shift) = (component * bits / 32, (component * bits % 32) as u32);
    // The code in the highest bits; from there it comes down with or without its sign.
    let down = 32 - bits as u32;
    let code = words[word & 3] << (down - shift);
    let signed: i32x16<S> = code.bitcast();
    let is_byte = bits == 8;
    match format.encoding() {
        VertexEncoding::Unorm => {
            let scale = if is_byte { 1.0 / 255.0 } else { 1.0 / 65_535.0 };
            float(code >> down) * scale
        }
        VertexEncoding::Snorm => {
            let scale = if is_byte { 1.0 / 127.0 } else { 1.0 / 32_767.0 };
            let value = f32x16::float_from(signed >> down) * scale;
            s.max_f32(value, SimdBase::splat(s, -1.0))
        }
        VertexEncoding::Uint => (code >> down).bitcast(),
        VertexEncoding::Sint => (signed >> down).bitcast(),
        VertexEncoding::Float => half(code),
    }
}

/// 16-bit floats in the upper halves of words, exactly.
#[inline(always)]
fn half<S: Lanes>(code: u32x16<S>) -> f32x16<S> {
    let magnitude = (code & 0x7FFF_0000) >> 3;
    // The exponent is 112 less than it should be; as a product that is right of denormal numbers, too.
    let as_float: f32x16<S> = magnitude.bitcast();
    let number: u32x16<S> = (as_float * f32::from_bits(0x7780_0000)).bitcast();
    let is_number = magnitude.simd_lt(0x0F80_0000);
    let number = is_number.select(number, magnitude | 0x7F80_0000);
    (number | (code & 0x8000_0000)).bitcast()
}

/// The first words of an attribute of sixteen elements, what lies beyond the buffer's end zero; at least
/// `count` of the four are there.
///
/// Vertices that follow one another, as in a dense range, are rows of words at a fixed distance. Elsewhere
/// words are gathered one by one.
#[inline(always)]
fn fetch_words<S: Lanes>(
    s: S,
    source: &AttributeSource,
    buffer: &Buffer,
    index: &PacketIndex,
    count: usize,
) -> [u32x16<S>; 4] {
    let (stride, offset) = (source.stride as usize, source.attribute.offset as usize);
    let words = buffer.words();
    let is_aligned = stride.is_multiple_of(4) && offset.is_multiple_of(4);
    if let (Some(first), false, true) = (index.first, source.per_instance, is_aligned) {
        let stride = stride / 4;
        let start = (first as usize)
            .saturating_mul(stride)
            .saturating_add(offset / 4);
        let end = start.saturating_add((LANES - 1) * stride + if count == 1 { 1 } else { 4 });
        if let Some(rows) = words.get(start..end) {
            return strided(s, rows, stride, count == 1);
        }
    }
    let stepped;
    let lanes = match source.step_rate {
        _ if !source.per_instance => &index.vertex,
        1 => &index.instance,
        rate => {
            stepped = step(index, rate);
            &stepped
        }
    };
    let mut out = [<u32x16<S> as SimdBase<S>>::splat(s, 0); 4];
    let lanes = u32x16::load_array_ref(s, &lanes.0);
    let whole = whole_elements(source, buffer);
    let inside = lanes.simd_lt(<u32x16<S> as SimdBase<S>>::splat(s, whole));
    let is_inside = s.bits_of_mask(inside) == u16::MAX;
    for (word, out) in out.iter_mut().take(count).enumerate() {
        *out = if is_aligned && is_inside {
            let stride = <u32x16<S> as SimdBase<S>>::splat(s, source.stride / 4);
            let first = u32::try_from(offset / 4 + word).unwrap_or(u32::MAX);
            let at = lanes * stride + <u32x16<S> as SimdBase<S>>::splat(s, first);
            s.gather(words, at)
        } else {
            let mut values = [0; LANES];
            for (value, &index) in values.iter_mut().zip(lanes.as_slice()) {
                let element = (index as usize).saturating_mul(stride);
                *value = buffer.word_at((offset + word * 4).saturating_add(element));
            }
            u32x16::load_array(s, values)
        };
    }
    out
}

/// The elements of instances that share one between `rate` of them, or all of them.
#[inline(never)]
fn step(index: &PacketIndex, rate: u32) -> Packet<u32> {
    let first = index.base_instance;
    let of = |instance: u32| {
        let steps = instance.wrapping_sub(first).checked_div(rate);
        first.wrapping_add(steps.unwrap_or(0))
    };
    Packet(index.instance.0.map(of))
}

/// Words of sixteen rows that are `stride` words apart: the first four, or the first one.
#[inline(always)]
fn strided<S: Lanes>(s: S, rows: &[u32], stride: usize, is_single: bool) -> [u32x16<S>; 4] {
    if is_single {
        let mut values = [0; LANES];
        for (lane, value) in values.iter_mut().enumerate() {
            *value = rows[lane * stride];
        }
        return [u32x16::load_array(s, values); 4];
    }
    let mut quads = [&[0; 4]; LANES];
    for (lane, quad) in quads.iter_mut().enumerate() {
        if let Some(row) = rows[lane * stride..].first_chunk() {
            *quad = row;
        }
    }
    columns_of(s, &quads)
}

/// How many elements hold an attribute whole.
#[inline(always)]
fn whole_elements(source: &AttributeSource, buffer: &Buffer) -> u32 {
    let end = source.attribute.offset as usize + source.attribute.format.size_bytes();
    match (buffer.len_bytes().checked_sub(end), source.stride) {
        (None, _) => 0,
        (Some(_), 0) => u32::MAX,
        (Some(spare), stride) => u32::try_from(spare / stride as usize + 1).unwrap_or(u32::MAX),
    }
}

/// Codes of at most 16 bits as floats.
#[inline(always)]
fn float<S: Lanes>(code: u32x16<S>) -> f32x16<S> {
    let signed: i32x16<S> = code.bitcast();
    f32x16::float_from(signed)
}
