//! Groups: samples of several textures at one place, made before the shader runs.

use super::nondependent::{CHANNELS, TOGETHER};
use super::read_place::{MOST, Place};
use super::textures::BoundTextures;
use estampe_simd::Packet;
use estampe_texture::{PacketLod, PacketRequest, SampledTexture, TapShifts};

/// Reads at the same place.
#[derive(Debug)]
pub(super) struct Group {
    pub(super) place: Place,
    /// The positions in the interface of each read's texture and sampler.
    pub(super) textures: Vec<[u32; 2]>,
    /// True if the last channel of a read may be read.
    pub(super) reads_alpha: bool,
}

impl Group {
    /// Samples packets of `stride` scalars; the texels of a packet are those of its textures.
    pub(super) fn sample(
        &self,
        textures: &BoundTextures<'_>,
        (scalars, stride): (&[Packet<f32>], usize),
        texels: &mut [[Packet<f32>; CHANNELS]],
    ) {
        let each = self.textures.len();
        let mut sampled = [None; MOST];
        for (to, [texture, sampler]) in sampled.iter_mut().zip(&self.textures) {
            *to = textures.sampled(*texture, *sampler);
        }
        let sampled = &sampled[..each.min(MOST)];
        if let (Some((places, lod)), Some(first)) = (self.place.flat(scalars, stride), sampled[0]) {
            let mut all = [first; MOST];
            let mut known = all.iter_mut().zip(sampled);
            let are_known = known.all(|(to, one)| one.map(|one| *to = one).is_some());
            let is_common = are_known
                && lod != PacketLod::Level
                && SampledTexture::sample_places(&all[..each], &places, texels);
            if is_common {
                return;
            }
            let shifts = (&TapShifts::UNSHIFTED, self.reads_alpha);
            if each == 1
                && lod != PacketLod::Gradients
                && first.sample_shifted(lod, &places, shifts, texels)
            {
                return;
            }
        }
        let mut packets = scalars.chunks_exact(stride.max(1));
        for texels in texels.chunks_mut(TOGETHER * each) {
            let mut requests = [PacketRequest::ZEROS; TOGETHER];
            let mut count = 0;
            for (asked, scalars) in requests.iter_mut().zip(&mut packets) {
                self.place.ask(scalars, asked);
                count += 1;
            }
            for (texture, first) in sampled.iter().zip(0..) {
                let Some(texels) = texels.get_mut(first..) else {
                    break;
                };
                match texture {
                    Some(texture) => {
                        texture.sample_requests(&requests[..count], texels, each);
                    }
                    None => texels.iter_mut().step_by(each).for_each(clear),
                }
            }
        }
    }
}

fn clear(texel: &mut [Packet<f32>; CHANNELS]) {
    *texel = [Packet::default(); CHANNELS];
}
