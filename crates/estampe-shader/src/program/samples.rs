//! Textures with samplers: a kernel's coordinates are in memory, and its colours go there.

use estampe_ir::interpreter::{TextureAccess, TextureAccesses};
use estampe_ir::op::{LevelOfDetail, TextureOp, TextureQuery};
use estampe_simd::{LANES, Packet, floats_of, floats_of_mut};
use estampe_texture::{PacketLod, PacketPlace, PacketRequest, SampledTexture, compare_packets};

/// The most accesses that are done together.
pub(super) const MOST: usize = 16;

/// Samples, compares or gathers whatever is asked.
#[inline(never)]
pub(super) fn sample(texture: &SampledTexture, access: &mut TextureAccess<'_>) {
    for packet in 0..access.packets {
        let asked = request(access, packet);
        let whole = whole_quads(access.mask[packet]);
        let takes_derivatives = matches!(asked.lod, PacketLod::Implicit | PacketLod::Bias);
        let are_whole = whole == access.mask[packet] || !takes_derivatives;
        if access.packets == 1 && are_whole {
            let query = access.op.query;
            answer(
                texture,
                (query, &asked),
                floats_of_mut(access.results_mut()),
            );
            continue;
        }
        let mut colors = [Packet::default(); 4];
        answer(texture, (access.op.query, &asked), &mut colors);
        if !are_whole {
            // Of the other quads some lanes have no coordinates: each lane is sampled alone.
            let mut alone = [Packet::default(); 4];
            let asked = PacketRequest {
                lod: PacketLod::Gradients,
                ..asked
            };
            answer(texture, (access.op.query, &asked), &mut alone);
            for (color, alone) in colors.iter_mut().zip(alone) {
                for lane in (0..LANES).filter(|lane| whole >> lane & 1 == 0) {
                    color.0[lane] = alone.0[lane];
                }
            }
        }
        for (at, color) in colors.iter().enumerate().take(access.results()) {
            floats_of_mut(access.result_mut(at))[packet] = *color;
        }
    }
}

/// Samples one or several textures at the same coordinates, by whole quads or by gradients; false
/// if that is not what the accesses ask for, and nothing is done.
#[inline(always)]
pub(super) fn sample_all<'a>(
    accesses: &mut TextureAccesses<'_>,
    sampled: impl Fn(&TextureOp) -> Option<&'a SampledTexture>,
) -> bool {
    let (ops, mask) = (accesses.ops, accesses.mask());
    let (operands, results) = accesses.all();
    let places = floats_of(operands);
    let at = match places.len() {
        2 if mask == whole_quads(mask) => places.first_chunk().map(PacketPlace::Quads),
        6 => places.first_chunk().map(PacketPlace::Gradients),
        _ => None,
    };
    let Some(at) = at else {
        return false;
    };
    let (colors, []) = floats_of_mut(results).as_chunks_mut::<4>() else {
        return false;
    };
    if let ([op], [colors]) = (ops, &mut *colors) {
        let Some(texture) = sampled(op) else {
            return false;
        };
        texture.sample_flat(at, colors);
        return true;
    }
    let Some(first) = ops.first().and_then(&sampled).filter(|_| ops.len() <= MOST) else {
        return false;
    };
    let mut all = [first; MOST];
    for (to, op) in all.iter_mut().zip(ops) {
        let Some(texture) = sampled(op) else {
            return false;
        };
        *to = texture;
    }
    SampledTexture::sample_all_flat(&all[..ops.len()], at, colors);
    true
}

/// Samples a texture at several coordinates; false if that is not what the accesses ask for, and
/// nothing is done.
pub(super) fn sample_each(
    texture: Option<&SampledTexture>,
    accesses: &mut TextureAccesses<'_>,
) -> bool {
    let Some((texture, first)) = texture.zip(accesses.ops.first()) else {
        return false;
    };
    let mask = accesses.mask();
    let lod = match first.level {
        LevelOfDetail::Zero => PacketLod::Level,
        LevelOfDetail::Implicit if mask == whole_quads(mask) => PacketLod::Implicit,
        _ => return false,
    };
    let (operands, results) = accesses.all();
    let ((each, []), (colors, [])) = (
        floats_of(operands).as_chunks(),
        floats_of_mut(results).as_chunks_mut(),
    ) else {
        return false;
    };
    texture.sample_each(lod, each, colors);
    true
}

/// Compares the texels of a shadow map at several coordinates with one depth; false if the texture
/// is none, and nothing is done.
pub(super) fn compare_all(
    texture: Option<&SampledTexture>,
    accesses: &mut TextureAccesses<'_>,
) -> bool {
    let Some((texture, depths)) = texture.and_then(|one| Some((one, one.depths()?))) else {
        return false;
    };
    let ops = accesses.ops;
    let (operands, shares) = accesses.all();
    let (mut left, shares) = (floats_of(operands), floats_of_mut(shares));
    let (Some(zeros), true) = (left.first(), ops.len() <= MOST) else {
        return false;
    };
    // Shadow maps have one level: gradients between the coordinates and the reference do not count.
    let have_gradients = left.len() != 3 * ops.len();
    let (mut at, mut reference) = ([[zeros; 2]; MOST], zeros);
    for (at, op) in at.iter_mut().zip(ops) {
        let words = if have_gradients { op.words() } else { 3 };
        let Some((operands, others)) = left.split_at_checked(words) else {
            return false;
        };
        let [u, v, .., of_op] = operands else {
            return false;
        };
        (*at, reference, left) = ([u, v], of_op, others);
    }
    compare_packets(
        depths,
        texture.level(),
        (&at[..ops.len()], reference),
        shares,
    );
    true
}

/// Stores as many packets as the query gives.
#[inline]
fn answer(
    texture: &SampledTexture,
    (query, asked): (TextureQuery, &PacketRequest<'_>),
    results: &mut [Packet<f32>],
) {
    let Some(share) = results.first_mut() else {
        return;
    };
    if query == TextureQuery::SampleCompare {
        texture.compare_request(asked, share);
        return;
    }
    let Some(colors) = results.first_chunk_mut() else {
        return;
    };
    match query {
        TextureQuery::Gather(channel) => {
            texture.gather_request(asked, usize::from(channel), colors);
        }
        TextureQuery::GatherCompare => texture.gather_compare_request(asked, colors),
        _ => texture.sample_request(asked, colors),
    }
}

/// What a packet of an access asks for.
#[inline]
fn request<'a>(access: &TextureAccess<'a>, packet: usize) -> PacketRequest<'a> {
    let mut asked = PacketRequest::ZEROS;
    let floats = |words: &'a [Packet<u32>]| &floats_of(words)[packet];
    for (axis, at) in asked.at.iter_mut().enumerate() {
        if axis < access.op.coordinates.len() {
            *at = floats(access.coordinate(axis));
        }
    }
    asked.offset = access.op.offset;
    if let Some(layer) = access.layer() {
        asked.layer = &layer[packet];
    }
    if let Some(reference) = access.reference() {
        asked.reference = floats(reference);
    }
    if let Some(value) = access.level_of_detail() {
        asked.value = floats(value);
    }
    asked.lod = match &access.op.level {
        LevelOfDetail::Implicit => PacketLod::Implicit,
        LevelOfDetail::Bias(_) => PacketLod::Bias,
        LevelOfDetail::Zero | LevelOfDetail::Explicit(_) => PacketLod::Level,
        LevelOfDetail::Gradient { .. } => PacketLod::Gradients,
    };
    let (along_x, along_y) = asked.gradients.split_at_mut(3);
    for (axis, gradients) in [along_x, along_y].into_iter().enumerate() {
        for (coordinate, gradient) in gradients.iter_mut().enumerate() {
            if coordinate < access.op.coordinates.len()
                && let Some(words) = access.gradient(axis, coordinate)
            {
                *gradient = floats(words);
            }
        }
    }
    asked
}

/// The lanes of quads that are wholly in a mask.
fn whole_quads(mask: u16) -> u16 {
    let pairs = mask & mask >> 1;
    let firsts = pairs & pairs >> 2 & 0x1111;
    firsts * 0xF
}

#[cfg(test)]
mod tests {
    use super::whole_quads;

    #[test]
    fn quads_count_only_if_all_of_their_lanes_run() {
        assert_eq!(whole_quads(0xFFFF), 0xFFFF);
        assert_eq!(whole_quads(0xF7F0), 0xF0F0);
        assert_eq!(whole_quads(0x8EEF), 0x000F);
    }
}
