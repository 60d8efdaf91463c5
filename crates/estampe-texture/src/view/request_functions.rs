//! The functions that sample, gather and compare a [`SampledTexture`] for requests: lanes that are
//! packets in memory already.

use super::coordinates::Answers as Colors;
use super::packet::{MOST_TAPS, TapShifts};
use super::{PacketLod, PacketPlace, PacketRequest, SampledTexture, shifted};
use crate::compare::compare_packets;
use crate::{PacketPlaces, Rgba8Texture};
use estampe_simd::Packet;

/// The most textures that [`SampledTexture::sample_all_flat`] samples together.
const TOGETHER: usize = 8;

impl SampledTexture {
    /// The colours of sixteen lanes, as [`sample_with`](Self::sample_with) gives them.
    pub fn sample_request(&self, request: &PacketRequest<'_>, colors: &mut Colors) {
        match self.common().zip(request.common()) {
            Some((common, request)) => common.sample_packet(self.level, &request, colors),
            None => self.sample_lanes(request, colors),
        }
    }

    /// The colours of several requests, as [`sample_request`](Self::sample_request) gives them;
    /// those of each are `step` after those of the one before. True if the code of the SIMD level
    /// was entered once for all of them.
    ///
    /// # Panics
    /// If the step is 0.
    pub fn sample_requests(
        &self,
        requests: &[PacketRequest<'_>],
        colors: &mut [Colors],
        step: usize,
    ) -> bool {
        if self.common().is_none() && self.sample_packets(requests, colors, step) {
            return true;
        }
        for (request, colors) in requests.iter().zip(colors.iter_mut().step_by(step)) {
            self.sample_request(request, colors);
        }
        false
    }

    /// The colours of sixteen lanes, as [`sample_request`](Self::sample_request) gives them.
    #[inline]
    pub fn sample_flat(&self, at: PacketPlace<'_>, colors: &mut Colors) {
        match self.common() {
            Some(common) => common.sample_packet(self.level, &at.common(), colors),
            None => self.sample_lanes(&at.request(), colors),
        }
    }

    /// The colours of several textures at the same place, as [`sample_flat`](Self::sample_flat)
    /// gives them for each.
    pub fn sample_all_flat(textures: &[&Self], at: PacketPlace<'_>, colors: &mut [Colors]) {
        if let Some(first) = textures.first().and_then(|first| first.common())
            && textures.len() <= TOGETHER
        {
            let mut all = [first; TOGETHER];
            let mut common = all
                .iter_mut()
                .zip(textures)
                .map(|(to, texture)| texture.common().map(|common| *to = common));
            if common.all(|is_common| is_common.is_some()) {
                let all = &all[..textures.len()];
                Rgba8Texture::sample_all_packets(all, textures[0].level, &at.common(), colors);
                return;
            }
        }
        for (texture, colors) in textures.iter().zip(colors) {
            texture.sample_flat(at, colors);
        }
    }

    /// The colours at several coordinates (u, v) of the same fragments, as
    /// [`sample_request`](Self::sample_request) gives them for each, in level 0 for
    /// [`PacketLod::Level`].
    pub fn sample_each(&self, lod: PacketLod, at: &[[Packet<f32>; 2]], colors: &mut [Colors]) {
        for (at, colors) in at.chunks(MOST_TAPS).zip(colors.chunks_mut(MOST_TAPS)) {
            let others = self.sample_blocks(lod, &PacketPlaces::of_pairs(at), colors);
            self.sample_others(lod, others, at, colors);
        }
    }

    /// The colours at several shifts from one place in each packet of a batch, as
    /// [`sample_each`](Self::sample_each) gives them; a shift is added to each coordinate, and of
    /// each packet there are as many colours as shifts. [Gradients](PacketPlaces::gradients) do not
    /// count. Unless `reads_alpha`, the last channel of a colour may be anything. False, with
    /// nothing stored, if the texture is not of half floats, another level than the finest may
    /// count, or there are no shifts.
    #[must_use]
    pub fn sample_shifted(
        &self,
        lod: PacketLod,
        places: &PacketPlaces<'_>,
        (shifts, reads_alpha): (&TapShifts, bool),
        colors: &mut [Colors],
    ) -> bool {
        let each = shifts.of_taps().len();
        if !self.may_have_blocks(lod) || each == 0 {
            return false;
        }
        let batches = places.chunks(MOST_TAPS);
        for (places, colors) in batches.zip(colors.chunks_mut(MOST_TAPS * each)) {
            let others = self.sample_filter(&places, (shifts, reads_alpha), colors);
            if others.iter().all(|taps| *taps == 0) {
                continue;
            }
            let packets = places.each().zip(colors.chunks_mut(each));
            for (others, (uv, colors)) in others.into_iter().zip(packets) {
                if others != 0 {
                    let mut at = [[Packet::default(); 2]; MOST_TAPS];
                    for (at, shift) in at.iter_mut().zip(shifts.of_taps()) {
                        *at = shifted(uv, *shift);
                    }
                    self.sample_others(lod, others, &at[..each], colors);
                }
            }
        }
        true
    }

    /// Samples some of several coordinates one by one: bit `i` is number `i`.
    fn sample_others(
        &self,
        lod: PacketLod,
        others: u32,
        at: &[[Packet<f32>; 2]],
        colors: &mut [Colors],
    ) {
        let mut left = others;
        while left != 0 {
            let number = left.trailing_zeros() as usize;
            left &= left - 1;
            let (Some([u, v]), Some(colors)) = (at.get(number), colors.get_mut(number)) else {
                break;
            };
            let request = PacketRequest {
                at: [u, v, PacketRequest::ZEROS.at[2]],
                lod,
                ..PacketRequest::ZEROS
            };
            self.sample_request(&request, colors);
        }
    }

    /// The shares of sixteen lanes in the first packet, as
    /// [`sample_compare`](Self::sample_compare) gives them.
    pub fn compare_request(&self, request: &PacketRequest<'_>, shares: &mut Packet<f32>) {
        if let Some(depths) = self.depths().filter(|_| request.offset == [0; 3]) {
            let at = [[request.at[0], request.at[1]]];
            compare_packets(
                depths,
                self.level,
                (&at, request.reference),
                std::slice::from_mut(shares),
            );
            return;
        }
        let mut answers = Colors::default();
        self.compare_lanes(request, &mut answers);
        [*shares, ..] = answers;
    }

    /// A channel of four texels for sixteen lanes, as [`gather`](Self::gather) gives them.
    pub fn gather_request(&self, request: &PacketRequest<'_>, channel: usize, texels: &mut Colors) {
        self.gather_lanes(request, channel, texels);
    }

    /// The comparisons of four texels for sixteen lanes, as
    /// [`gather_compare`](Self::gather_compare) gives them.
    pub fn gather_compare_request(&self, request: &PacketRequest<'_>, results: &mut Colors) {
        self.gather_compare_lanes(request, results);
    }

    /// Samples, or compares, sixteen lanes by packet code. Returns the lanes that the scalar code
    /// sampled after all, lane `i` as bit `i`; `None` if there is no packet code. For tests.
    #[doc(hidden)]
    #[inline(never)]
    pub fn sample_by_packet(
        &self,
        request: &PacketRequest<'_>,
        compares: bool,
        colors: &mut Colors,
    ) -> Option<u32> {
        self.sample_packet(request, colors, compares)
    }

    /// Gathers a channel of sixteen lanes, or comparison results if it is `None`, by packet code.
    /// Returns the lanes that the scalar code gathered after all, lane `i` as bit `i`; `None` if
    /// there is no packet code. For tests.
    #[doc(hidden)]
    #[inline(never)]
    pub fn gather_by_packet(
        &self,
        request: &PacketRequest<'_>,
        channel: Option<usize>,
        texels: &mut Colors,
    ) -> Option<u32> {
        self.gather_packet(request, channel, texels)
    }
}
