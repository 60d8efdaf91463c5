//! Textures with samplers: a kernel's coordinates are in memory, and its colours go there.

use estampe_ir::interpreter::{TextureAccess, TextureAccesses};
use estampe_ir::op::{LevelOfDetail, TextureQuery};
use estampe_simd::{LANES, Packet, floats_of, floats_of_mut};
use estampe_texture::{PacketLod, PacketRequest, SampledTexture, compare_packets};

/// The most accesses that are done together.
pub(super) const MOST: usize = 16;

/// Samples, compares or gathers.
pub(super) fn sample(texture: &SampledTexture, access: &mut TextureAccess<'_>) {
    if !sample_common(texture, access) {
        sample_any(texture, access);
    }
}

/// One packet with two coordinates and nothing else, sampled by its quads, by gradients or in the
/// finest level, or compared in a shadow map; false if that is not what is asked, and nothing is
/// done.
#[inline]
fn sample_common(texture: &SampledTexture, access: &mut TextureAccess<'_>) -> bool {
    let op = access.op;
    let (&[mask], [_, _], None, [0, 0, 0]) =
        (access.mask, &op.coordinates[..], op.layer, op.offset)
    else {
        return false;
    };
    let [u, v] = [0, 1].map(|at| floats_of(access.coordinate(at)).first());
    let Some(uv) = u.zip(v).map(|(u, v)| [u, v]) else {
        return false;
    };
    match (op.query, &op.level) {
        (TextureQuery::Sample, LevelOfDetail::Implicit) if mask == whole_quads(mask) => {
            sample_into(texture, &at(uv, PacketLod::Implicit), access)
        }
        (TextureQuery::Sample, LevelOfDetail::Zero) => {
            let places = floats_of(access.operands()).as_chunks();
            let colors = floats_of_mut(access.results_mut()).as_chunks_mut();
            let ((each, []), (colors, [])) = (places, colors) else {
                return false;
            };
            texture.sample_each(PacketLod::Level, each, colors);
            true
        }
        (TextureQuery::Sample, LevelOfDetail::Gradient { .. }) => {
            let asked = with_gradients(floats_of(access.operands()));
            asked.is_some_and(|asked| sample_into(texture, &asked, access))
        }
        (TextureQuery::SampleCompare, _) => {
            let reference = floats_of(access.reference().unwrap_or_default()).first();
            let (Some(depths), Some(reference)) = (texture.depths(), reference) else {
                return false;
            };
            let shares = floats_of_mut(access.results_mut());
            compare_packets(depths, texture.level(), (&[uv], reference), shares);
            true
        }
        _ => false,
    }
}

/// Two coordinates, with a level of detail that takes no other operands.
#[inline(always)]
fn at<'a>([u, v]: [&'a Packet<f32>; 2], lod: PacketLod) -> PacketRequest<'a> {
    PacketRequest {
        at: [u, v, PacketRequest::ZEROS.at[2]],
        lod,
        ..PacketRequest::ZEROS
    }
}

/// Two coordinates, with their derivatives along x, then along y.
#[inline(always)]
fn with_gradients(operands: &[Packet<f32>]) -> Option<PacketRequest<'_>> {
    let [u, v, u_along_x, v_along_x, u_along_y, v_along_y] = operands else {
        return None;
    };
    let zeros = PacketRequest::ZEROS.at[2];
    Some(PacketRequest {
        gradients: [u_along_x, v_along_x, zeros, u_along_y, v_along_y, zeros],
        ..at([u, v], PacketLod::Gradients)
    })
}

/// Samples one packet; false if the access has no room for a colour.
#[inline]
fn sample_into(
    texture: &SampledTexture,
    asked: &PacketRequest<'_>,
    access: &mut TextureAccess<'_>,
) -> bool {
    let colors = floats_of_mut(access.results_mut()).first_chunk_mut();
    colors
        .map(|colors| texture.sample_request(asked, colors))
        .is_some()
}

/// Samples, compares or gathers whatever is asked.
#[inline(never)]
fn sample_any(texture: &SampledTexture, access: &mut TextureAccess<'_>) {
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

/// Samples several textures at the same coordinates, by whole quads or by gradients; false if that
/// is not what the accesses ask for, and nothing is done.
pub(super) fn sample_all(
    textures: &[Option<&SampledTexture>],
    accesses: &mut TextureAccesses<'_>,
) -> bool {
    let mask = accesses.mask();
    let Some(&Some(first)) = textures.first() else {
        return false;
    };
    if textures.len() > MOST {
        return false;
    }
    let mut all = [first; MOST];
    for (to, texture) in all.iter_mut().zip(textures) {
        let Some(texture) = texture else {
            return false;
        };
        *to = texture;
    }
    let (operands, results) = accesses.all();
    let request = match floats_of(operands) {
        [u, v] if mask == whole_quads(mask) => Some(at([u, v], PacketLod::Implicit)),
        operands => with_gradients(operands),
    };
    let (Some(request), (colors, [])) = (request, floats_of_mut(results).as_chunks_mut::<4>())
    else {
        return false;
    };
    SampledTexture::sample_requests(&all[..textures.len()], &request, colors);
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
