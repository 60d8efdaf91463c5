//! Sampling up to sixteen lanes by code that is compiled in this crate alone.
//!
//! A shader is generic over its numbers; if the sampler were, too, each crate with a shader would compile it for every
//! level, which took 8 seconds. So a shader gives its coordinates as arrays, with the level that it runs at, and gets
//! colours as arrays: some loads and stores of a register each.

use crate::Sampled;
use crate::lod::{implicit_rho2, level_of_detail, rho2};
use crate::sampled::mixture;
use crate::texel::finish;
use crate::view::{Answers, answer, put};
use estampe_simd::{LANES, Level, SimdBase, dispatch, f32x16};
use estampe_types::{Int, Quad, Real, Vec2, Vec4};

/// Where lanes are sampled.
#[derive(Debug)]
pub(crate) struct Request {
    uv: [[f32; LANES]; 2],
    /// Levels of detail, where they are given rather than found from the quads.
    lod: Option<[f32; LANES]>,
    lanes: Kind,
}

/// Lanes of a quad.
const QUAD: usize = 4;

/// The lanes of a request.
#[derive(Debug, Clone, Copy)]
enum Kind {
    /// Sixteen, sampled with a level's instructions.
    Packet(Level),
    /// Quads: so many lanes.
    Quads(usize),
    /// One.
    Fragment,
}

impl Request {
    /// The lanes of coordinates, sixteen at most, from one on.
    #[inline(always)]
    pub(crate) fn new<R: Real>(uv: Vec2<R>, lod: Option<R>, first: usize) -> Self {
        let mut lanes = [[0.0; LANES]; 3];
        put(uv.x, first, &mut lanes[0]);
        put(uv.y, first, &mut lanes[1]);
        if let Some(lod) = lod {
            put(lod, first, &mut lanes[2]);
        }
        let [u, v, levels] = lanes;
        Self {
            uv: [u, v],
            lod: lod.map(|_| levels),
            lanes: match uv.x.level() {
                Some(level) => Kind::Packet(level),
                None if R::LANES == 1 => Kind::Fragment,
                None => Kind::Quads(R::LANES.min(LANES)),
            },
        }
    }

    #[inline(always)]
    fn uv<R: Real>(&self, like: R, first: usize) -> Vec2<R> {
        let [u, v] = &self.uv;
        Vec2::new(load(like, u, first), load(like, v, first))
    }

    /// A lane's coordinates.
    fn of_lane(&self, lane: usize) -> Vec2<f32> {
        Vec2::new(self.uv[0][lane], self.uv[1][lane])
    }

    /// The level of detail of a packet's lane: the given one, or that of its quad.
    fn lod_of_lane(&self, lane: usize, size: [f32; 2]) -> f32 {
        if let Some(lod) = &self.lod {
            return lod[lane];
        }
        let [first, right, below] = [0, 1, 2].map(|k| self.of_lane((lane & !3) + k));
        let minus = |a: Vec2<f32>, b: Vec2<f32>| Vec2::new(a.x - b.x, a.y - b.y);
        level_of_detail(rho2(minus(right, first), minus(below, first), size))
    }
}

impl Sampled {
    /// The colours of lanes.
    #[inline(never)]
    pub(crate) fn sample_lanes(&self, request: &Request, colors: &mut Answers) {
        match request.lanes {
            Kind::Packet(level) => dispatch!(@wide level, s => {
                let zero: f32x16<_> = SimdBase::splat(s, 0.0);
                store(self.sample_numbers(request, zero, 0), 0, colors);
            }, scalar => self.sample_each(request, colors)),
            Kind::Quads(lanes) => {
                for first in (0..lanes).step_by(QUAD) {
                    let color = self.sample_numbers(request, Quad([0.0; QUAD]), first);
                    store(color, first, colors);
                }
            }
            Kind::Fragment => store(self.sample_numbers(request, 0.0_f32, 0), 0, colors),
        }
    }

    /// The colours of several textures, whose number is that of `colors`, at one place.
    #[inline(never)]
    pub(crate) fn sample_all_lanes(textures: &[&Self], request: &Request, colors: &mut [Answers]) {
        let is_alike = match textures.split_first() {
            Some((first, others)) => others.iter().all(|other| first.is_like(other)),
            None => return,
        };
        match request.lanes {
            Kind::Packet(level) if is_alike => dispatch!(@wide level, s => {
                let zero: f32x16<_> = SimdBase::splat(s, 0.0);
                Self::sample_alike(textures, request, zero, colors);
            }, scalar => Self::sample_one_by_one(textures, request, colors)),
            _ => Self::sample_one_by_one(textures, request, colors),
        }
    }

    fn sample_one_by_one(textures: &[&Self], request: &Request, colors: &mut [Answers]) {
        for (texture, colors) in textures.iter().zip(colors) {
            texture.sample_lanes(request, colors);
        }
    }

    #[inline(always)]
    fn sample_numbers<R: Real>(&self, request: &Request, like: R, first: usize) -> Vec4<R> {
        let uv = request.uv(like, first);
        if let Some(lod) = &request.lod {
            let lod = load(like, lod, first);
            let within = lod.clamp(self.lod_range[0], self.lod_range[1]);
            let (level, _) = mixture(within, self.sampler.mipmap_filter);
            return self.sample_at(uv, lod, level.to_int_within_range().lane(0));
        }
        let rho2 = implicit_rho2(uv, self.levels[0].size);
        self.sample_at(uv, level_of_detail(rho2), self.guess_of_level(rho2))
    }

    /// Samples textures that are [alike](Self::is_like): the first one's places serve all.
    #[inline(always)]
    fn sample_alike<R: Real>(
        textures: &[&Self],
        request: &Request,
        like: R,
        colors: &mut [Answers],
    ) {
        let (first, uv) = (textures[0], request.uv(like, 0));
        let rho2 = implicit_rho2(uv, first.levels[0].size);
        let lod = level_of_detail(rho2);
        if let Some(inside) = first.inside(uv, lod, first.guess_of_level(rho2)) {
            for (texture, colors) in textures.iter().zip(colors) {
                store(finish(inside.color(&texture.texture), false), 0, colors);
            }
            return;
        }
        like.out_of_line(
            #[inline(always)]
            || {
                let mixed = first.mixed(uv, lod);
                for (texture, colors) in textures.iter().zip(colors) {
                    let color = match &mixed {
                        Some(mixed) => finish(mixed.color(&texture.texture), false),
                        None => texture.sample_anywhere(uv, lod),
                    };
                    store(color, 0, colors);
                }
            },
        );
    }

    /// Samples a packet's lanes one after the other: at the scalar level.
    fn sample_each(&self, request: &Request, colors: &mut Answers) {
        for lane in 0..LANES {
            let lod = request.lod_of_lane(lane, self.levels[0].size);
            let within = Real::clamp(lod, self.lod_range[0], self.lod_range[1]);
            let level = mixture(within, self.sampler.mipmap_filter).0.to_int();
            let Vec4 { x, y, z, w } = self.sample_at(request.of_lane(lane), lod, level);
            answer(colors, lane, [x, y, z, w]);
        }
    }
}

/// The lanes of an array from one on.
#[inline(always)]
fn load<R: Real>(like: R, from: &[f32; LANES], first: usize) -> R {
    like.with_lanes(
        #[inline(always)]
        |lane| from[first + lane],
    )
}

/// Puts colours into arrays, from a lane on.
#[inline(always)]
fn store<R: Real>(color: Vec4<R>, first: usize, colors: &mut Answers) {
    for (channel, to) in [color.x, color.y, color.z, color.w].iter().zip(colors) {
        for lane in 0..R::LANES {
            to[first + lane] = channel.lane(lane);
        }
    }
}
