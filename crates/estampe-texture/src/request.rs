//! The boundary through which shaders call the sampler, which is compiled once, in this crate.
//!
//! A shader is generic over its numbers. If the sampler were generic, too, each crate with a shader
//! would compile it for every SIMD level, which took 8 seconds. Instead a shader stores its
//! coordinates as a [`Request`], calls the sampler with its SIMD level, and loads the colours.
//! Requests and answers are packets of up to sixteen lanes, a cache line each, so that a register
//! stores or loads a packet at once.
//!
//! The level entry of a packet holds only the common case ([`Rgba8Texture::inside`]). Other cases
//! are behind a second call, which computes everything again, so that the common case keeps nothing
//! in memory for them.

use crate::Rgba8Texture;
use crate::lod::{implicit_rho2, level_of_detail, rho2};
use crate::rgba8_texture::mixture;
use crate::texel::Number;
use crate::view::{Answers, answer, load, packet};
use estampe_simd::{LANES, Lanes as _, Level, Packet, SimdBase, dispatch, f32x16};
use estampe_types::{Int, Quad, Real, Vec2, Vec4};

/// Coordinates and levels of detail of up to sixteen lanes. Each number is a packet, a cache line,
/// which a register of sixteen lanes stores and loads at once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Request<'a> {
    pub(crate) uv: [&'a Packet<f32>; 2],
    pub(crate) detail: RequestDetail<'a>,
}

/// The source of a request's levels of detail.
#[derive(Debug, Clone, Copy)]
pub(crate) enum RequestDetail<'a> {
    /// The differences within quads.
    Quads,
    /// These levels of detail.
    Level(&'a Packet<f32>),
    /// The derivatives of u and v along x, then along y.
    Gradients([&'a Packet<f32>; 4]),
    /// ρ² of such derivatives, in texels of the base level.
    Rho2(&'a Packet<f32>),
}

/// [`RequestDetail`] as a shader gives it.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Detail<R: Real> {
    Quads,
    Level(R),
    Gradients([Vec2<R>; 2]),
    Rho2(R),
}

/// Lanes of a quad.
const QUAD: usize = 4;

impl Request<'_> {
    /// Calls `ask` with a request for the lanes from `first` on: sixteen, or all if there are
    /// fewer.
    #[inline(always)]
    fn with<R: Real, T>(
        uv: Vec2<R>,
        detail: Detail<R>,
        first: usize,
        ask: impl FnOnce(&Request<'_>) -> T,
    ) -> T {
        let (u, v) = (packet(uv.x, first), packet(uv.y, first));
        let (levels, derivatives);
        let detail = match detail {
            Detail::Quads => RequestDetail::Quads,
            Detail::Level(lod) => {
                levels = packet(lod, first);
                RequestDetail::Level(&levels)
            }
            Detail::Gradients([along_x, along_y]) => {
                derivatives = [
                    packet(along_x.x, first),
                    packet(along_x.y, first),
                    packet(along_y.x, first),
                    packet(along_y.y, first),
                ];
                RequestDetail::Gradients(derivatives.each_ref())
            }
            Detail::Rho2(rho2) => {
                levels = packet(rho2, first);
                RequestDetail::Rho2(&levels)
            }
        };
        let uv = [&u, &v];
        ask(&Request { uv, detail })
    }

    #[inline(always)]
    fn uv<R: Real>(&self, like: R, first: usize) -> Vec2<R> {
        let [u, v] = self.uv;
        Vec2::new(load(like, u, first), load(like, v, first))
    }

    /// A lane's coordinates.
    fn of_lane(&self, lane: usize) -> Vec2<f32> {
        Vec2::new(self.uv[0].0[lane], self.uv[1].0[lane])
    }

    /// The level of detail of a packet's lane.
    fn lod_of_lane(&self, lane: usize, size: [f32; 2]) -> f32 {
        match self.detail {
            RequestDetail::Quads => {
                let [first, right, below] = [0, 1, 2].map(|k| self.of_lane((lane & !3) + k));
                let minus = |a: Vec2<f32>, b: Vec2<f32>| Vec2::new(a.x - b.x, a.y - b.y);
                level_of_detail(rho2(minus(right, first), minus(below, first), size))
            }
            RequestDetail::Level(levels) => levels.0[lane],
            RequestDetail::Gradients(derivatives) => {
                let [ux, vx, uy, vy] = derivatives.map(|of_lanes| of_lanes.0[lane]);
                level_of_detail(rho2(Vec2::new(ux, vx), Vec2::new(uy, vy), size))
            }
            RequestDetail::Rho2(rho2) => level_of_detail(rho2.0[lane]),
        }
    }
}

impl Rgba8Texture {
    /// Samples the lanes from `first` on: sixteen, or all if there are fewer.
    #[inline(always)]
    pub(crate) fn sample_lanes<R: Real>(
        &self,
        uv: Vec2<R>,
        detail: Detail<R>,
        first: usize,
    ) -> Answers {
        Request::with(
            uv,
            detail,
            first,
            #[inline(always)]
            |request| {
                let mut colors = Answers::default();
                match uv.x.level() {
                    Some(level) => self.sample_packet(level, request, &mut colors),
                    None if R::LANES == 1 => colors = self.sample_fragment(request),
                    None => colors = self.sample_quads(request, R::LANES.min(LANES)),
                }
                colors
            },
        )
    }

    /// Samples several textures, as many as there are `colors`, for the lanes from `first` on:
    /// sixteen, or all if there are fewer.
    #[inline(always)]
    pub(crate) fn sample_all_lanes<R: Real>(
        textures: &[&Self],
        (uv, detail): (Vec2<R>, Detail<R>),
        first: usize,
        colors: &mut [Answers],
    ) {
        if let Some(level) = uv.x.level() {
            Request::with(
                uv,
                detail,
                first,
                #[inline(always)]
                |request| Self::sample_all_packets(textures, level, request, colors),
            );
            return;
        }
        for (texture, colors) in textures.iter().zip(colors) {
            *colors = texture.sample_lanes(uv, detail, first);
        }
    }

    /// Samples a packet.
    #[inline(never)]
    pub(crate) fn sample_packet(&self, level: Level, request: &Request<'_>, colors: &mut Answers) {
        dispatch!(@wide_move level, s => {
            let zero: f32x16<_> = SimdBase::splat(s, 0.0);
            let (uv, lod, guess) = self.place(request, zero, 0);
            match self.inside(uv, lod, guess) {
                Some(inside) => *colors = stored(inside.color(&self.texture, self.is_srgb)),
                None => self.sample_rare_packet(s.as_level(), request, colors),
            }
        }, scalar => *colors = self.sample_each(request));
    }

    /// Samples all lanes of two packets.
    #[inline(always)]
    pub(crate) fn sample_two_packets<R: Real>(
        &self,
        level: Level,
        uv: Vec2<R>,
        detail: Detail<R>,
    ) -> [Answers; 2] {
        let mut colors = [Answers::default(); 2];
        Request::with(
            uv,
            detail,
            0,
            #[inline(always)]
            |first| {
                Request::with(
                    uv,
                    detail,
                    LANES,
                    #[inline(always)]
                    |second| self.sample_requests(level, [first, second], &mut colors),
                );
            },
        );
        colors
    }

    /// Samples two packets: their levels of detail are found first, so that neither's texels wait
    /// for the other's level of detail.
    #[inline(never)]
    fn sample_requests(
        &self,
        level: Level,
        requests: [&Request<'_>; 2],
        colors: &mut [Answers; 2],
    ) {
        dispatch!(@specialized level, s => {
            let zero: f32x16<_> = SimdBase::splat(s, 0.0);
            let [a, b] = requests;
            let details = [self.place(a, zero, 0), self.place(b, zero, 0)];
            for ((uv, lod, guess), (request, colors)) in
                details.into_iter().zip(requests.into_iter().zip(colors))
            {
                match self.inside(uv, lod, guess) {
                    Some(inside) => *colors = stored(inside.color(&self.texture, self.is_srgb)),
                    None => self.sample_rare_packet(s.as_level(), request, colors),
                }
            }
        }, others => {
            for (request, colors) in requests.into_iter().zip(colors) {
                self.sample_packet(level, request, colors);
            }
        });
    }

    /// Samples a packet that is not the common case.
    #[inline(never)]
    pub(crate) fn sample_rare_packet(
        &self,
        level: Level,
        request: &Request<'_>,
        colors: &mut Answers,
    ) {
        dispatch!(@wide level, s => {
            let zero: f32x16<_> = SimdBase::splat(s, 0.0);
            let (uv, lod, _) = self.place(request, zero, 0);
            *colors = stored(self.sample_outside(uv, lod));
        }, scalar => *colors = self.sample_each(request));
    }

    #[inline(never)]
    fn sample_quads(&self, request: &Request<'_>, lanes: usize) -> Answers {
        let mut colors = Answers::default();
        for first in (0..lanes).step_by(QUAD) {
            let Vec4 { x, y, z, w } = self.sample_numbers(request, Quad([0.0; QUAD]), first);
            for lane in 0..QUAD {
                answer(&mut colors, first + lane, [x, y, z, w].map(|c| c.0[lane]));
            }
        }
        colors
    }

    #[inline(never)]
    fn sample_fragment(&self, request: &Request<'_>) -> Answers {
        stored(self.sample_numbers(request, 0.0_f32, 0))
    }

    #[inline(always)]
    fn sample_numbers<R: Number>(&self, request: &Request<'_>, like: R, first: usize) -> Vec4<R> {
        let (uv, lod, guess) = self.place(request, like, first);
        self.sample_at(uv, lod, guess)
    }

    /// The coordinates, their level of detail, and a guess of the finer level of the first lane.
    #[inline(always)]
    pub(crate) fn place<R: Real>(
        &self,
        request: &Request<'_>,
        like: R,
        first: usize,
    ) -> (Vec2<R>, R, i32) {
        let uv = request.uv(like, first);
        if let Some((lod, level)) = self.fixed_lod() {
            return (uv, like.splat(lod), level);
        }
        let size = self.levels[0].size;
        let rho2 = match request.detail {
            RequestDetail::Quads => implicit_rho2(uv, size),
            RequestDetail::Level(levels) => {
                let lod = load(like, levels, first);
                let within = lod.clamp(self.lod_range[0], self.lod_range[1]);
                let (level, _) = mixture(within, self.sampler.mipmap_filter);
                return (uv, lod, level.to_int_within_range().lane(0));
            }
            RequestDetail::Gradients([ux, vx, uy, vy]) => {
                let along_x = Vec2::new(load(like, ux, first), load(like, vx, first));
                let along_y = Vec2::new(load(like, uy, first), load(like, vy, first));
                rho2(along_x, along_y, size)
            }
            RequestDetail::Rho2(rho2) => load(like, rho2, first),
        };
        (uv, level_of_detail(rho2), self.guess_of_level(rho2))
    }

    /// Samples a packet from several textures. If they are [alike](Self::is_like), the footprint in
    /// the first one serves all.
    #[inline(never)]
    pub(crate) fn sample_all_packets(
        textures: &[&Self],
        level: Level,
        request: &Request<'_>,
        colors: &mut [Answers],
    ) {
        let Some((first, others)) = textures.split_first() else {
            return;
        };
        if level.is_specialized() && others.iter().all(|other| first.is_like(other)) {
            first.sample_alike(textures, level, request, colors);
            return;
        }
        for (texture, colors) in textures.iter().zip(colors) {
            texture.sample_packet(level, request, colors);
        }
    }

    /// Samples textures that are [alike](Self::is_like): this one's footprint serves all.
    #[inline(never)]
    fn sample_alike(
        &self,
        textures: &[&Self],
        level: Level,
        request: &Request<'_>,
        colors: &mut [Answers],
    ) {
        dispatch!(@specialized level, s => {
            let zero: f32x16<_> = SimdBase::splat(s, 0.0);
            let (uv, lod, guess) = self.place(request, zero, 0);
            let Some(inside) = self.inside(uv, lod, guess) else {
                self.sample_rare_alike(textures, s.as_level(), request, colors);
                return;
            };
            for (texture, colors) in textures.iter().zip(colors) {
                *colors = stored(inside.color(&texture.texture, texture.is_srgb));
            }
        }, others => ());
    }

    #[inline(never)]
    pub(crate) fn sample_rare_alike(
        &self,
        textures: &[&Self],
        level: Level,
        request: &Request<'_>,
        colors: &mut [Answers],
    ) {
        dispatch!(@specialized level, s => {
            let zero: f32x16<_> = SimdBase::splat(s, 0.0);
            let (uv, lod, _) = self.place(request, zero, 0);
            let mixed = self.mixed(uv, lod);
            for (texture, colors) in textures.iter().zip(colors) {
                let color = match &mixed {
                    Some(mixed) => mixed.color(&texture.texture, texture.is_srgb),
                    None => texture.sample_anywhere(uv, lod),
                };
                *colors = stored(color);
            }
        }, others => ());
    }

    /// Samples a packet lane by lane, at the scalar SIMD level.
    #[inline(never)]
    fn sample_each(&self, request: &Request<'_>) -> Answers {
        let mut colors = Answers::default();
        for lane in 0..LANES {
            let lod = request.lod_of_lane(lane, self.levels[0].size);
            let within = Real::clamp(lod, self.lod_range[0], self.lod_range[1]);
            let level = mixture(within, self.sampler.mipmap_filter).0.to_int();
            let Vec4 { x, y, z, w } = self.sample_at(request.of_lane(lane), lod, level);
            answer(&mut colors, lane, [x, y, z, w]);
        }
        colors
    }
}

/// Stores colours as packets.
#[inline(always)]
pub(crate) fn stored<R: Real>(color: Vec4<R>) -> Answers {
    [
        packet(color.x, 0),
        packet(color.y, 0),
        packet(color.z, 0),
        packet(color.w, 0),
    ]
}
