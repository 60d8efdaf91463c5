//! Vertex fetch (V2): attributes from buffers, sixteen vertices at a time.
//!
//! *In* vertex and instance indices · *Out* attribute scalars, structure of arrays · *Spec* WebGPU
//! §Vertex formats. Bytes beyond a buffer's end read as zeros; what a format lacks is (0, 0, 0, 1).
//! Integers arrive as bits.
//!
//! The formats of most meshes are fetched by a kernel of their own: with all of WebGPU's
//! formats in it, it took twice the time for those few, and a frame of small triangles 7 % more.

use super::ahead::prefetch;
use crate::bounds::transpose::components_of;
use crate::pipeline::{AttributeSource, Decoding};
use estampe_format::vertex::VertexCodec;
use estampe_simd::{
    Bytes, LANES, Lanes, Level, Packet, SimdBase, SimdCvtFloat, dispatch, f32x16, i32x16, u32x16,
};
use estampe_types::BufferData;

/// Vertices are prefetched as many before they are fetched: two batches.
const AHEAD: usize = 16 * LANES;

/// The vertex and instance indices of a packet's lanes.
#[derive(Debug, Default)]
pub(crate) struct PacketIndex {
    pub(crate) vertex: Packet<u32>,
    pub(crate) instance: Packet<u32>,
    /// The first vertex, where lane `i` is vertex `first + i` of one instance.
    pub(crate) first: Option<u32>,
}

/// Fills `out` with the scalars of every attribute but those that [`fetch_rare`] reads; `wanted`
/// says how many each location has.
#[inline(always)]
pub(crate) fn fetch<S: Lanes>(
    s: S,
    sources: &[AttributeSource],
    wanted: &[usize],
    buffers: &[BufferData],
    index: &PacketIndex,
    out: &mut [Packet<f32>],
) {
    let mut rest = out;
    for (source, &wanted) in sources.iter().zip(wanted) {
        let Some((scalars, others)) = rest.split_at_mut_checked(wanted) else {
            return;
        };
        rest = others;
        // Each format has loops of its own: one for all, which asks for the format of each
        // component, is slower.
        let there = wanted.min(source.components);
        let words = match source.decoding {
            Decoding::Float32 => there,
            Decoding::Unorm8 => 1,
            Decoding::Unorm16 => there.div_ceil(2),
            Decoding::Rare => continue,
        };
        let words = match buffers.get(source.buffer) {
            Some(buffer) => fetch_words(s, source, buffer, index, words),
            None => [<u32x16<S> as SimdBase<S>>::splat(s, 0); 4],
        };
        let (found, missing) = scalars.split_at_mut(there);
        match source.decoding {
            Decoding::Float32 => {
                for (scalar, word) in found.iter_mut().zip(words) {
                    let value: f32x16<S> = word.bitcast();
                    value.store_array(&mut scalar.0);
                }
            }
            Decoding::Unorm8 => {
                for (scalar, shift) in found.iter_mut().zip([0, 8, 16, 24]) {
                    let value = float((words[0] >> shift) & 0xFF) * (1.0 / 255.0);
                    value.store_array(&mut scalar.0);
                }
            }
            Decoding::Unorm16 | Decoding::Rare => {
                for (pair, word) in found.chunks_mut(2).zip(words) {
                    for (scalar, shift) in pair.iter_mut().zip([0, 16]) {
                        let value = float((word >> shift) & 0xFFFF) * (1.0 / 65_535.0);
                        value.store_array(&mut scalar.0);
                    }
                }
            }
        }
        for (component, scalar) in (there..).zip(missing) {
            let value = if component == 3 { 1.0 } else { 0.0 };
            scalar.0 = [value; LANES];
        }
    }
}

/// The first words of an attribute of sixteen elements, what lies beyond the buffer's end zero; at
/// least `count` of the four are there.
///
/// Vertices that follow one another, as in a dense range, are rows of words at a fixed distance.
/// Elsewhere words are gathered one by one.
#[inline(always)]
fn fetch_words<S: Lanes>(
    s: S,
    source: &AttributeSource,
    buffer: &BufferData,
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
            // The attributes behind it lie in the same lines.
            if offset == 0 {
                prefetch(s, words, start + AHEAD * stride, LANES * stride);
            }
            return strided(s, rows, stride, count == 1);
        }
    }
    let lanes = if source.per_instance {
        &index.instance
    } else {
        &index.vertex
    };
    let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
    let mut out = [splat(0); 4];
    let lanes = u32x16::load_array_ref(s, &lanes.0);
    let are_below = |count| s.bits_of_mask(lanes.simd_lt(splat(count))) == u16::MAX;
    // Where gathers take longer than loads, three words or four are loads of four.
    if const { S::LOADS_PAIRS }
        && count > 2
        && is_aligned
        && are_below(whole_elements(source, buffer, 16))
    {
        let first = u32::try_from(offset / 4).unwrap_or(u32::MAX);
        return s.gather_four(words, lanes * splat(source.stride / 4) + splat(first));
    }
    let size = source.attribute.format.size_bytes();
    let is_inside = are_below(whole_elements(source, buffer, size));
    for (word, out) in out.iter_mut().take(count).enumerate() {
        *out = if is_aligned && is_inside {
            let first = u32::try_from(offset / 4 + word).unwrap_or(u32::MAX);
            s.gather(words, lanes * splat(source.stride / 4) + splat(first))
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
    components_of(s, &quads)
}

/// Returns the number of elements that hold so many bytes, from an attribute on, completely inside
/// the buffer.
#[inline(always)]
fn whole_elements(source: &AttributeSource, buffer: &BufferData, bytes: usize) -> u32 {
    let end = source.attribute.offset as usize + bytes;
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

/// Fills `out` with the attributes of formats that are not common, and those that several instances
/// share; `first_instance` is the draw's.
#[inline(never)]
pub(crate) fn fetch_rare(
    level: Level,
    sources: &[AttributeSource],
    wanted: &[usize],
    buffers: &[BufferData],
    (index, first_instance): (&PacketIndex, u32),
    out: &mut [Packet<f32>],
) {
    let mut rest = out;
    for (source, &wanted) in sources.iter().zip(wanted) {
        let Some((scalars, others)) = rest.split_at_mut_checked(wanted) else {
            return;
        };
        rest = others;
        if source.decoding == Decoding::Rare {
            let index = &PacketIndex {
                vertex: index.vertex,
                instance: step(&index.instance, first_instance, source.step_rate),
                first: index.first,
            };
            fetch_one(level, source, buffers, index, scalars);
        }
    }
}

fn fetch_one(
    level: Level,
    source: &AttributeSource,
    buffers: &[BufferData],
    index: &PacketIndex,
    out: &mut [Packet<f32>],
) {
    let format = source.attribute.format;
    let (found, missing) = out.split_at_mut(out.len().min(source.components));
    match buffers.get(source.buffer) {
        Some(buffer) => dispatch!(level, s => decode(s, source, buffer, index, found)),
        None => found.fill(Packet([0.0; LANES])),
    }
    for (component, out) in (found.len()..).zip(missing) {
        out.0 = [f32::from_bits(format.missing(component)); LANES];
    }
}

/// The components of an attribute of any format, from the words that hold them.
#[inline(always)]
fn decode<S: Lanes>(
    s: S,
    source: &AttributeSource,
    buffer: &BufferData,
    index: &PacketIndex,
    out: &mut [Packet<f32>],
) {
    let codec = VertexCodec::new(source.attribute.format);
    let words = fetch_words(s, source, buffer, index, codec.words(out.len()));
    for (component, out) in out.iter_mut().enumerate() {
        codec
            .decode_lanes(s, &words, component)
            .store_array(&mut out.0);
    }
}

/// The elements of instances that share one between `rate` of them, or all of them.
fn step(instances: &Packet<u32>, first: u32, rate: u32) -> Packet<u32> {
    let of = |instance: u32| {
        let steps = instance.wrapping_sub(first).checked_div(rate);
        first.wrapping_add(steps.unwrap_or(0))
    };
    Packet(instances.0.map(of))
}
