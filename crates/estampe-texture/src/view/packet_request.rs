//! [`PacketRequest`]: what up to sixteen lanes ask of a view, as packets in memory.
//!
//! A shader in Rust stores its lanes as packets; a compiled shader has them in memory and asks with
//! references alone.

use super::SampledTexture;
use super::coordinates::{Answers as Colors, Coordinates, Lod, packet};
use super::packet::{MOST_TAPS, TapShifts};
use crate::compare::compare_packets;
use crate::request::{Request, RequestDetail};
use crate::{PacketPlaces, Rgba8Texture};
use estampe_simd::{LANES, Packet};
use estampe_types::{Int, Real};

/// What up to sixteen lanes ask of a texture.
///
/// Packets that a request does not need are [`ZEROS`](Self::ZEROS), so that nothing is stored for
/// them.
#[derive(Debug, Clone, Copy)]
pub struct PacketRequest<'a> {
    /// The number of lanes, from the first one on: [`LANES`], or fewer.
    pub count: usize,
    /// Coordinates: as many as the view's dimension has.
    pub at: [&'a Packet<f32>; 3],
    /// Array layers, as signed integers.
    pub layer: &'a Packet<u32>,
    /// The source of the level of detail.
    pub lod: PacketLod,
    /// The bias, or the level of detail.
    pub value: &'a Packet<f32>,
    /// Derivatives of the coordinates along x, then along y.
    pub gradients: [&'a Packet<f32>; 6],
    /// The reference of comparisons.
    pub reference: &'a Packet<f32>,
    /// Offset in texels.
    pub offset: [i32; 3],
}

/// The numbers of a [`PacketRequest`] that determine the level of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PacketLod {
    /// The coordinates' differences within each 2×2 quad.
    Implicit,
    /// The same, with a bias.
    Bias,
    /// The given level.
    Level,
    /// The given derivatives.
    Gradients,
}

static FLOATS: Packet<f32> = Packet([0.0; LANES]);
static WORDS: Packet<u32> = Packet([0; LANES]);

impl PacketRequest<'static> {
    /// Sixteen lanes at zeros, with the level of detail of their quads.
    pub const ZEROS: Self = Self {
        count: LANES,
        at: [&FLOATS; 3],
        layer: &WORDS,
        lod: PacketLod::Implicit,
        value: &FLOATS,
        gradients: [&FLOATS; 6],
        reference: &FLOATS,
        offset: [0; 3],
    };
}

impl PacketRequest<'_> {
    /// Calls `ask` with the lanes from `first` on.
    #[inline(always)]
    pub(crate) fn with<R: Real, T>(
        at: &Coordinates<R>,
        lod: &Lod<R>,
        (reference, offset): (Option<R>, [i32; 3]),
        first: usize,
        ask: impl FnOnce(&PacketRequest<'_>) -> T,
    ) -> T {
        let layer = packet_of_layers(at.layer, first);
        let [u, v, w] = [
            packet(at.uvw.x, first),
            packet(at.uvw.y, first),
            packet(at.uvw.z, first),
        ];
        let (values, derivatives, references);
        let mut request = PacketRequest {
            count: if R::LANES < LANES { R::LANES } else { LANES },
            at: [&u, &v, &w],
            layer: &layer,
            offset,
            ..PacketRequest::ZEROS
        };
        match lod {
            Lod::Implicit => {}
            Lod::Bias(value) | Lod::Level(value) => {
                values = packet(*value, first);
                request.value = &values;
                request.lod = match lod {
                    Lod::Level(_) => PacketLod::Level,
                    _ => PacketLod::Bias,
                };
            }
            Lod::Gradients(dx, dy) => {
                derivatives = [
                    packet(dx.x, first),
                    packet(dx.y, first),
                    packet(dx.z, first),
                    packet(dy.x, first),
                    packet(dy.y, first),
                    packet(dy.z, first),
                ];
                let [a, b, c, d, e, f] = &derivatives;
                request.gradients = [a, b, c, d, e, f];
                request.lod = PacketLod::Gradients;
            }
        }
        if let Some(reference) = reference {
            references = packet(reference, first);
            request.reference = &references;
        }
        ask(&request)
    }

    /// A lane's coordinates.
    pub(crate) fn at(&self, lane: usize) -> [f32; 3] {
        self.at.map(|of_lanes| of_lanes.0[lane])
    }

    /// A lane's layer.
    pub(crate) fn layer(&self, lane: usize) -> i32 {
        self.layer.0[lane].cast_signed()
    }

    /// A lane's derivatives, along x and along y.
    pub(crate) fn gradients(&self, lane: usize) -> [[f32; 3]; 2] {
        let [a, b, c, d, e, f] = self.gradients.map(|of_lanes| of_lanes.0[lane]);
        [[a, b, c], [d, e, f]]
    }

    /// The first lane of a lane's quad; of a single fragment the lane itself.
    pub(crate) fn first_of_quad(&self, lane: usize) -> usize {
        if self.count >= 4 { lane & !3 } else { lane }
    }

    /// The differences within a quad that begins at a lane, along x and along y; 0 for a single
    /// fragment.
    pub(crate) fn differences(&self, first: usize) -> [[f32; 3]; 2] {
        if self.count < 4 {
            return [[0.0; 3]; 2];
        }
        [1, 2]
            .map(|other| std::array::from_fn(|k| self.at[k].0[first + other] - self.at[k].0[first]))
    }

    /// The coordinates, and where the level of detail comes from: what the common kind of texture
    /// samples. `None` if sixteen lanes ask for anything else.
    fn common(&self) -> Option<Request<'_>> {
        let detail = match self.lod {
            PacketLod::Implicit => RequestDetail::Quads,
            PacketLod::Level => RequestDetail::Level(self.value),
            PacketLod::Gradients => {
                let [ux, vx, _, uy, vy, _] = self.gradients;
                RequestDetail::Gradients([ux, vx, uy, vy])
            }
            PacketLod::Bias => return None,
        };
        let is_common = self.count == LANES && self.offset == [0; 3];
        is_common.then_some(Request {
            uv: [self.at[0], self.at[1]],
            detail,
        })
    }
}

/// Stores the layers of the lanes from `first` on: sixteen, or all if there are fewer.
#[inline(always)]
fn packet_of_layers<I: Int>(layer: I, first: usize) -> Packet<u32> {
    let mut lanes = Packet::default();
    let all = <I::Real as Real>::LANES;
    let count = if all < LANES { all } else { LANES };
    for (lane, to) in lanes.0.iter_mut().enumerate().take(count) {
        *to = layer.lane_to_store(first + lane).cast_unsigned();
    }
    lanes
}

/// Two coordinates of sixteen lanes, and where their level of detail comes from: a request that is
/// one reference.
#[derive(Debug, Clone, Copy)]
pub enum PacketPlace<'a> {
    /// Coordinates whose differences within quads count.
    Quads(&'a [Packet<f32>; 2]),
    /// Coordinates, then their derivatives along x, then along y.
    Gradients(&'a [Packet<f32>; 6]),
}

impl<'a> PacketPlace<'a> {
    /// The same as a request for the common kind of texture.
    #[inline(always)]
    fn common(self) -> Request<'a> {
        match self {
            Self::Quads([u, v]) => Request {
                uv: [u, v],
                detail: RequestDetail::Quads,
            },
            Self::Gradients([u, v, ux, vx, uy, vy]) => Request {
                uv: [u, v],
                detail: RequestDetail::Gradients([ux, vx, uy, vy]),
            },
        }
    }

    /// The same as a request.
    #[inline(always)]
    fn request(self) -> PacketRequest<'a> {
        let zeros = &FLOATS;
        match self {
            Self::Quads([u, v]) => PacketRequest {
                at: [u, v, zeros],
                ..PacketRequest::ZEROS
            },
            Self::Gradients([u, v, ux, vx, uy, vy]) => PacketRequest {
                at: [u, v, zeros],
                lod: PacketLod::Gradients,
                gradients: [ux, vx, zeros, uy, vy, zeros],
                ..PacketRequest::ZEROS
            },
        }
    }
}

/// Coordinates, moved.
#[must_use]
pub fn shifted(uv: [&Packet<f32>; 2], shift: [f32; 2]) -> [Packet<f32>; 2] {
    let [mut u, mut v] = uv.map(|of| *of);
    for (of, by) in [&mut u, &mut v].into_iter().zip(shift) {
        for lane in &mut of.0 {
            *lane += by;
        }
    }
    [u, v]
}

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
        *texels = self.gather_lanes(request, channel);
    }

    /// The comparisons of four texels for sixteen lanes, as
    /// [`gather_compare`](Self::gather_compare) gives them.
    pub fn gather_compare_request(&self, request: &PacketRequest<'_>, results: &mut Colors) {
        *results = self.gather_compare_lanes(request);
    }
}
