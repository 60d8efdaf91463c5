//! Where a shader reads a texture: the lanes' coordinates, and how the level of detail is found.

use estampe_simd::LANES;
use estampe_types::{Int, Real, Vec2, Vec3, Vec4};

/// A texture coordinate: as many components as the view's dimension wants, and a layer of arrays.
#[derive(Debug, Clone, Copy)]
pub struct Coordinates<R: Real> {
    pub(crate) uvw: Vec3<R>,
    pub(crate) layer: R::Int,
}

impl<R: Real> Coordinates<R> {
    /// In a row of texels.
    #[inline(always)]
    pub fn d1(u: R) -> Self {
        Self::d3(Vec3::new(u, u.splat(0.0), u.splat(0.0)))
    }

    /// In an image.
    #[inline(always)]
    pub fn d2(uv: Vec2<R>) -> Self {
        Self::d3(Vec3::new(uv.x, uv.y, uv.x.splat(0.0)))
    }

    /// In an image of an array, confined to those that exist.
    #[inline(always)]
    pub fn d2_array(uv: Vec2<R>, layer: R::Int) -> Self {
        Self {
            layer,
            ..Self::d2(uv)
        }
    }

    /// In a block of texels.
    #[inline(always)]
    pub fn d3(uvw: Vec3<R>) -> Self {
        Self {
            uvw,
            layer: uvw.x.splat_int(0),
        }
    }

    /// In a cube's surface: where the direction, of any length, meets it.
    #[inline(always)]
    pub fn cube(direction: Vec3<R>) -> Self {
        Self::d3(direction)
    }

    /// In the surface of a cube of an array.
    #[inline(always)]
    pub fn cube_array(direction: Vec3<R>, layer: R::Int) -> Self {
        Self {
            uvw: direction,
            layer,
        }
    }
}

/// How the level of detail is found.
#[derive(Debug, Clone, Copy)]
pub enum Lod<R: Real> {
    /// From the coordinates' differences within each 2×2 quad; a lone fragment reads the base level.
    Implicit,
    /// The same, and this is added.
    Bias(R),
    /// This one.
    Level(R),
    /// From the coordinates' derivatives along x and along y.
    Gradients(Vec3<R>, Vec3<R>),
}

/// What sixteen lanes, or fewer, get: channel by channel.
pub(crate) type Answers = [[f32; LANES]; 4];

/// The same as arrays: a request that code which knows no lanes can fulfil. Of a pair of packets it is one.
#[derive(Debug)]
pub(crate) struct Lanes {
    /// How many lanes there are.
    pub(crate) count: usize,
    pub(crate) at: [[f32; LANES]; 3],
    pub(crate) layer: [i32; LANES],
    pub(crate) lod: LodOfLanes,
    /// The bias, or the level.
    pub(crate) value: [f32; LANES],
    /// Along x, then along y.
    pub(crate) gradients: [[f32; LANES]; 6],
    /// What is compared with.
    pub(crate) reference: [f32; LANES],
    /// In texels.
    pub(crate) offset: [i32; 3],
}

/// Which of the numbers of [`Lanes`] count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LodOfLanes {
    Bias,
    Level,
    Gradients,
}

impl Lanes {
    /// The lanes from `first` on.
    #[inline(always)]
    pub(crate) fn new<R: Real>(
        at: &Coordinates<R>,
        lod: &Lod<R>,
        offset: [i32; 3],
        first: usize,
    ) -> Self {
        let mut lanes = Self {
            count: if R::LANES < LANES { R::LANES } else { LANES },
            at: [[0.0; LANES]; 3],
            layer: [0; LANES],
            lod: match lod {
                Lod::Implicit | Lod::Bias(_) => LodOfLanes::Bias,
                Lod::Level(_) => LodOfLanes::Level,
                Lod::Gradients(..) => LodOfLanes::Gradients,
            },
            value: [0.0; LANES],
            gradients: [[0.0; LANES]; 6],
            reference: [0.0; LANES],
            offset,
        };
        put(at.uvw.x, first, &mut lanes.at[0]);
        put(at.uvw.y, first, &mut lanes.at[1]);
        put(at.uvw.z, first, &mut lanes.at[2]);
        put_ints(at.layer, first, &mut lanes.layer);
        match lod {
            Lod::Implicit => {}
            Lod::Bias(value) | Lod::Level(value) => put(*value, first, &mut lanes.value),
            Lod::Gradients(dx, dy) => {
                put(dx.x, first, &mut lanes.gradients[0]);
                put(dx.y, first, &mut lanes.gradients[1]);
                put(dx.z, first, &mut lanes.gradients[2]);
                put(dy.x, first, &mut lanes.gradients[3]);
                put(dy.y, first, &mut lanes.gradients[4]);
                put(dy.z, first, &mut lanes.gradients[5]);
            }
        }
        lanes
    }

    #[inline(always)]
    pub(crate) fn set_reference<R: Real>(&mut self, reference: R, first: usize) {
        put(reference, first, &mut self.reference);
    }

    /// A lane's coordinates.
    pub(crate) fn at(&self, lane: usize) -> [f32; 3] {
        [self.at[0][lane], self.at[1][lane], self.at[2][lane]]
    }

    /// A lane's derivatives, along x and along y.
    pub(crate) fn gradients(&self, lane: usize) -> [[f32; 3]; 2] {
        let [a, b, c, d, e, f] = self.gradients.map(|of_lanes| of_lanes[lane]);
        [[a, b, c], [d, e, f]]
    }

    /// The first lane of a lane's quad; a lone fragment's own.
    pub(crate) fn first_of_quad(&self, lane: usize) -> usize {
        if self.count >= 4 { lane & !3 } else { lane }
    }

    /// The differences within a quad that begins at a lane, along x and along y; of a lone fragment 0.
    pub(crate) fn differences(&self, first: usize) -> [[f32; 3]; 2] {
        if self.count < 4 {
            return [[0.0; 3]; 2];
        }
        [1, 2].map(|other| std::array::from_fn(|k| self.at[k][first + other] - self.at[k][first]))
    }
}

/// How many requests of sixteen lanes a number takes.
#[inline(always)]
pub(crate) const fn requests<R: Real>() -> usize {
    R::LANES.div_ceil(LANES)
}

/// Sixteen lanes from one on, or all there are.
#[inline(always)]
pub(crate) fn put<R: Real>(value: R, first: usize, to: &mut [f32; LANES]) {
    let count = if R::LANES < LANES { R::LANES } else { LANES };
    for (lane, to) in to.iter_mut().enumerate().take(count) {
        *to = value.lane(first + lane);
    }
}

/// The same of integers.
#[inline(always)]
pub(crate) fn put_ints<I: Int>(value: I, first: usize, to: &mut [i32; LANES]) {
    let lanes = <I::Real as Real>::LANES;
    let count = if lanes < LANES { lanes } else { LANES };
    for (lane, to) in to.iter_mut().enumerate().take(count) {
        *to = value.lane(first + lane);
    }
}

/// Lanes' four numbers as a vector.
#[inline(always)]
pub(crate) fn packed<R: Real>(like: R, answers: &[Answers; 2]) -> Vec4<R> {
    Vec4::new(
        like.with_lanes(
            #[inline(always)]
            |lane| answers[lane / LANES][0][lane % LANES],
        ),
        like.with_lanes(
            #[inline(always)]
            |lane| answers[lane / LANES][1][lane % LANES],
        ),
        like.with_lanes(
            #[inline(always)]
            |lane| answers[lane / LANES][2][lane % LANES],
        ),
        like.with_lanes(
            #[inline(always)]
            |lane| answers[lane / LANES][3][lane % LANES],
        ),
    )
}

/// Puts a lane's four numbers among the answers.
#[inline(always)]
pub(crate) fn answer(answers: &mut Answers, lane: usize, channels: [f32; 4]) {
    for (of_channel, channel) in answers.iter_mut().zip(channels) {
        of_channel[lane] = channel;
    }
}
