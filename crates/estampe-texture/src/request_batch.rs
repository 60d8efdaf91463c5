//! Many packets of one batch in one call: the coordinates lie where a pipeline put them.
//!
//! The code of a SIMD level is entered once for all packets, and nothing is copied for a packet.

use crate::request::{Request, RequestDetail, stored};
use crate::view::{Answers, load, packet};
use crate::{Rgba8Texture, SampledTexture};
use estampe_simd::{LANES, Lanes, Level, Packet, SimdBase, dispatch, f32x16};
use estampe_types::{Real, Vec2};

/// Two coordinates and their derivatives for each packet of a batch.
#[derive(Debug, Clone, Copy)]
pub struct PacketPlaces<'a> {
    /// The scalars of all packets, those of each packet one after the other.
    pub scalars: &'a [Packet<f32>],
    /// The scalars of a packet: more than each of the numbers below.
    pub stride: usize,
    /// The scalars that are u and v.
    pub at: [usize; 2],
    /// The scalars that are their derivatives along x, then along y; `None` where differences
    /// within quads count.
    pub gradients: Option<[usize; 4]>,
}

impl<'a> PacketPlaces<'a> {
    /// A list of coordinates (u, v).
    #[inline(always)]
    pub(crate) fn of_pairs(at: &'a [[Packet<f32>; 2]]) -> Self {
        Self {
            scalars: at.as_flattened(),
            stride: 2,
            at: [0, 1],
            gradients: None,
        }
    }

    /// Parts of so many packets each, of fewer at the end.
    pub(crate) fn chunks(&self, packets: usize) -> impl Iterator<Item = Self> + use<'a> {
        let places = *self;
        let scalars = self.scalars.chunks(packets * self.stride.max(1));
        scalars.map(move |scalars| Self { scalars, ..places })
    }

    /// The coordinates of each packet.
    #[inline(always)]
    pub(crate) fn each(&self) -> impl Iterator<Item = [&'a Packet<f32>; 2]> + use<'a> {
        let [u, v] = self.at;
        self.packets().map(
            #[inline(always)]
            move |scalars| [&scalars[u], &scalars[v]],
        )
    }

    /// The coordinate u of a packet.
    #[inline(always)]
    pub(crate) fn u_of(&self, packet: usize) -> Option<&'a Packet<f32>> {
        self.scalars.get(packet * self.stride + self.at[0])
    }

    /// The scalars of each packet.
    #[inline(always)]
    pub(crate) fn packets(&self) -> std::slice::ChunksExact<'a, Packet<f32>> {
        self.scalars.chunks_exact(self.stride.max(1))
    }

    /// The coordinates of the packet with these scalars.
    #[inline(always)]
    fn uv<R: Real>(&self, like: R, scalars: &[Packet<f32>]) -> Vec2<R> {
        let [u, v] = self.at;
        Vec2::new(load(like, &scalars[u], 0), load(like, &scalars[v], 0))
    }

    /// What the packet with these scalars asks for. Code that samples makes it anew for a function
    /// that is not inlined: a request of which another function has the address is in memory, and
    /// its parts are read before they have arrived there.
    #[inline(always)]
    fn request<'s>(&self, scalars: &'s [Packet<f32>]) -> Request<'s> {
        let [u, v] = self.at;
        Request {
            uv: [&scalars[u], &scalars[v]],
            detail: match self.gradients {
                Some([ux, vx, uy, vy]) => RequestDetail::Gradients([
                    &scalars[ux],
                    &scalars[vx],
                    &scalars[uy],
                    &scalars[vy],
                ]),
                None => RequestDetail::Quads,
            },
        }
    }
}

/// The most textures that are sampled together.
const TOGETHER: usize = 8;

impl SampledTexture {
    /// The colours of several textures at the same places: of each packet as many as there are
    /// textures, as [`sample_all_flat`](Self::sample_all_flat) gives them. False if textures are
    /// not of the [common](Self::common) kind, or too many, and nothing is done.
    #[must_use]
    pub fn sample_places(
        textures: &[&Self],
        places: &PacketPlaces<'_>,
        colors: &mut [Answers],
    ) -> bool {
        let Some(first) = textures.first().and_then(|first| first.common()) else {
            return false;
        };
        let level = textures[0].level;
        let mut common = [first; TOGETHER];
        if textures.len() > TOGETHER {
            return false;
        }
        for (to, texture) in common.iter_mut().zip(textures) {
            let Some(texture) = texture.common() else {
                return false;
            };
            *to = texture;
        }
        let common = &common[..textures.len()];
        match common {
            [texture] => texture.sample_batch(level, places, colors),
            _ if common.iter().all(|other| first.is_like(other)) => {
                first.sample_batch_alike(common, level, places, colors);
            }
            _ => sample_each_packet(common, level, places, colors),
        }
        true
    }
}

fn sample_each_packet(
    textures: &[&Rgba8Texture],
    level: Level,
    places: &PacketPlaces<'_>,
    colors: &mut [Answers],
) {
    let packets = places.packets().zip(colors.chunks_mut(textures.len()));
    for (scalars, colors) in packets {
        Rgba8Texture::sample_all_packets(textures, level, &places.request(scalars), colors);
    }
}

/// The packets whose levels of detail are found before the first of them is sampled: a batch.
const AT_ONCE: usize = 16;

/// The levels of detail of some packets, and the guesses of their finer levels.
///
/// A level of detail is a logarithm: a chain of operations that takes as long as loading texels
/// does. Where each packet's came just before its texels, it filled the instructions that the
/// processor looks ahead, and the texels of the next packet waited.
struct Details {
    lods: [Packet<f32>; AT_ONCE],
    guesses: [i32; AT_ONCE],
}

impl Details {
    const NONE: Self = Self {
        lods: [Packet([0.0; LANES]); AT_ONCE],
        guesses: [0; AT_ONCE],
    };
}

impl Rgba8Texture {
    /// Finds the levels of detail of packets, at most [`AT_ONCE`].
    #[inline(always)]
    fn find_details<S: Lanes>(&self, zero: f32x16<S>, places: &PacketPlaces<'_>, to: &mut Details) {
        let details = to.lods.iter_mut().zip(&mut to.guesses);
        for (scalars, (to, to_guess)) in places.packets().zip(details) {
            let (_, lod, guess) = self.place(&places.request(scalars), zero, 0);
            (*to, *to_guess) = (packet(lod, 0), guess);
        }
    }

    /// Samples packets of one texture.
    #[inline(never)]
    fn sample_batch(&self, level: Level, places: &PacketPlaces<'_>, colors: &mut [Answers]) {
        dispatch!(@specialized level, s => {
            let zero: f32x16<_> = SimdBase::splat(s, 0.0);
            let mut details = Details::NONE;
            for (places, colors) in places.chunks(AT_ONCE).zip(colors.chunks_mut(AT_ONCE)) {
                self.find_details(zero, &places, &mut details);
                let of_packets = details.lods.iter().zip(&details.guesses);
                let packets = places.packets().zip(colors.iter_mut());
                for ((scalars, colors), (lod, guess)) in packets.zip(of_packets) {
                    let uv = places.uv(zero, scalars);
                    match self.inside(uv, load(zero, lod, 0), *guess) {
                        Some(inside) => {
                            *colors = stored(inside.color(&self.texture, self.is_srgb));
                        }
                        None => self.sample_rare_place(s.as_level(), (&places, scalars), colors),
                    }
                }
            }
        }, others => sample_each_packet(&[self], level, places, colors));
    }

    /// Samples a packet that is not the common case.
    #[inline(never)]
    fn sample_rare_place(
        &self,
        level: Level,
        (places, scalars): (&PacketPlaces<'_>, &[Packet<f32>]),
        colors: &mut Answers,
    ) {
        self.sample_rare_packet(level, &places.request(scalars), colors);
    }

    /// Samples packets of several textures that are [alike](Self::is_like): the footprint in this
    /// one serves all.
    #[inline(never)]
    fn sample_batch_alike(
        &self,
        textures: &[&Self],
        level: Level,
        places: &PacketPlaces<'_>,
        colors: &mut [Answers],
    ) {
        dispatch!(@specialized level, s => {
            let zero: f32x16<_> = SimdBase::splat(s, 0.0);
            let mut details = Details::NONE;
            let each = textures.len();
            for (places, colors) in places.chunks(AT_ONCE).zip(colors.chunks_mut(AT_ONCE * each)) {
                self.find_details(zero, &places, &mut details);
                let of_packets = details.lods.iter().zip(&details.guesses);
                let packets = places.packets().zip(colors.chunks_mut(each));
                for ((scalars, colors), (lod, guess)) in packets.zip(of_packets) {
                    let uv = places.uv(zero, scalars);
                    let Some(inside) = self.inside(uv, load(zero, lod, 0), *guess) else {
                        self.sample_rare_alike_place(
                            textures,
                            s.as_level(),
                            (&places, scalars),
                            colors,
                        );
                        continue;
                    };
                    for (texture, colors) in textures.iter().zip(colors) {
                        *colors = stored(inside.color(&texture.texture, texture.is_srgb));
                    }
                }
            }
        }, others => sample_each_packet(textures, level, places, colors));
    }

    #[inline(never)]
    fn sample_rare_alike_place(
        &self,
        textures: &[&Self],
        level: Level,
        (places, scalars): (&PacketPlaces<'_>, &[Packet<f32>]),
        colors: &mut [Answers],
    ) {
        self.sample_rare_alike(textures, level, &places.request(scalars), colors);
    }
}
