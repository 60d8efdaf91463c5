//! What a shader asks of a view: coordinates, and how the level of detail is determined; and lanes
//! as packets.

use estampe_simd::{LANES, Packet};
use estampe_types::{Int, Real, Vec2, Vec3, Vec4, WithGradient};

/// A texture coordinate: as many components as the view's dimension has, and an array layer.
#[derive(Debug, Clone, Copy)]
pub struct Coordinates<R: Real> {
    pub(crate) uvw: Vec3<R>,
    pub(crate) layer: R::Int,
}

impl<R: Real> Coordinates<R> {
    /// The coordinate u of a 1D view.
    #[inline(always)]
    pub fn d1(u: R) -> Self {
        Self::d3(Vec3::new(u, u.splat(0.0), u.splat(0.0)))
    }

    /// The coordinates (u, v) of a 2D view.
    #[inline(always)]
    pub fn d2(uv: Vec2<R>) -> Self {
        Self::d3(Vec3::new(uv.x, uv.y, uv.x.splat(0.0)))
    }

    /// The coordinates (u, v) in a layer of a 2D array view; the layer is clamped to the existing
    /// ones.
    #[inline(always)]
    pub fn d2_array(uv: Vec2<R>, layer: R::Int) -> Self {
        Self {
            layer,
            ..Self::d2(uv)
        }
    }

    /// The coordinates (u, v, w) of a 3D view.
    #[inline(always)]
    pub fn d3(uvw: Vec3<R>) -> Self {
        Self {
            uvw,
            layer: uvw.x.splat_int(0),
        }
    }

    /// The point of a cube map that a direction of any length meets.
    #[inline(always)]
    pub fn cube(direction: Vec3<R>) -> Self {
        Self::d3(direction)
    }

    /// The point of a cube of a cube array view that a direction of any length meets.
    #[inline(always)]
    pub fn cube_array(direction: Vec3<R>, layer: R::Int) -> Self {
        Self {
            uvw: direction,
            layer,
        }
    }
}

/// What a texture is sampled at: [`Coordinates`], (u, v) of a 2D view as a [`Vec2`], or a [`Vec3`]:
/// (u, v, w) of a 3D view, a direction of a cube. Either may be a varying with its
/// [gradient](WithGradient).
pub trait TextureCoordinates<R: Real>: Copy {
    /// The coordinates, layer 0 if they have none.
    fn coordinates(self) -> Coordinates<R>;
    /// Their derivatives along x and y, from which the level of detail comes. Without, it comes
    /// from the differences within quads.
    #[inline(always)]
    fn gradient(self) -> Option<[Vec3<R>; 2]> {
        None
    }
}

impl<R: Real> TextureCoordinates<R> for WithGradient<Vec2<R>> {
    #[inline(always)]
    fn coordinates(self) -> Coordinates<R> {
        Coordinates::d2(self.value)
    }
    #[inline(always)]
    fn gradient(self) -> Option<[Vec3<R>; 2]> {
        let three = |of: Vec2<R>| Vec3::new(of.x, of.y, of.x.splat(0.0));
        Some([three(self.ddx), three(self.ddy)])
    }
}

impl<R: Real> TextureCoordinates<R> for WithGradient<Vec3<R>> {
    #[inline(always)]
    fn coordinates(self) -> Coordinates<R> {
        Coordinates::d3(self.value)
    }
    #[inline(always)]
    fn gradient(self) -> Option<[Vec3<R>; 2]> {
        Some([self.ddx, self.ddy])
    }
}

impl<R: Real> TextureCoordinates<R> for Coordinates<R> {
    #[inline(always)]
    fn coordinates(self) -> Self {
        self
    }
}

impl<R: Real> TextureCoordinates<R> for Vec2<R> {
    #[inline(always)]
    fn coordinates(self) -> Coordinates<R> {
        Coordinates::d2(self)
    }
}

impl<R: Real> TextureCoordinates<R> for Vec3<R> {
    #[inline(always)]
    fn coordinates(self) -> Coordinates<R> {
        Coordinates::d3(self)
    }
}

/// The source of the level of detail.
#[derive(Debug, Clone, Copy)]
pub enum Lod<R: Real> {
    /// From the coordinates' differences within each 2×2 quad; a single fragment reads the base
    /// level.
    Implicit,
    /// As [`Lod::Implicit`], with this bias added.
    Bias(R),
    /// This level of detail.
    Level(R),
    /// From the coordinates' derivatives along x and along y.
    Gradients(Vec3<R>, Vec3<R>),
}

impl<R: Real> Lod<R> {
    /// Returns true if it comes from the differences within quads.
    #[inline(always)]
    pub(super) fn takes_derivatives(&self) -> bool {
        matches!(self, Self::Implicit | Self::Bias(_))
    }
}

/// Sample results of up to sixteen lanes, one packet per channel. Each packet is a cache line, so
/// that a register of sixteen lanes is stored and loaded at once.
pub(crate) type Answers = [Packet<f32>; 4];

/// Stores the lanes from `first` on as a packet: sixteen, or all if there are fewer.
#[inline(always)]
pub(crate) fn packet<R: Real>(value: R, first: usize) -> Packet<f32> {
    let mut lanes = Packet::default();
    let count = if R::LANES < LANES { R::LANES } else { LANES };
    for (lane, to) in lanes.0.iter_mut().enumerate().take(count) {
        *to = value.lane_to_store(first + lane);
    }
    lanes
}

/// [`packet`] for integers.
#[inline(always)]
pub(crate) fn packet_of_ints<I: Int>(value: I, first: usize) -> Packet<i32> {
    let mut lanes = Packet::default();
    let all = <I::Real as Real>::LANES;
    let count = if all < LANES { all } else { LANES };
    for (lane, to) in lanes.0.iter_mut().enumerate().take(count) {
        *to = value.lane_to_store(first + lane);
    }
    lanes
}

/// Loads the lanes of a packet from `first` on.
#[inline(always)]
pub(crate) fn load<R: Real>(like: R, from: &Packet<f32>, first: usize) -> R {
    like.with_lanes(
        #[inline(always)]
        |lane| from.0[first + lane],
    )
}

/// Calls `ask` with the first of each sixteen lanes, until each lane of a number has its sample
/// result.
#[inline(always)]
pub(crate) fn by_sixteen<R: Real>(like: R, ask: impl Fn(usize) -> Answers) -> Vec4<R> {
    let first = ask(0);
    if R::LANES <= LANES {
        return packed(like, [&first; 4]);
    }
    let second = ask(LANES);
    if R::LANES <= 2 * LANES {
        return packed(like, [&first, &second, &first, &second]);
    }
    packed(like, [&first, &second, &ask(2 * LANES), &ask(3 * LANES)])
}

/// Loads the four channels of each lane as a vector.
#[inline(always)]
pub(crate) fn packed<R: Real>(like: R, answers: [&Answers; 4]) -> Vec4<R> {
    Vec4::new(
        channel(like, answers, 0),
        channel(like, answers, 1),
        channel(like, answers, 2),
        channel(like, answers, 3),
    )
}

#[inline(always)]
fn channel<R: Real>(like: R, answers: [&Answers; 4], channel: usize) -> R {
    like.with_lanes(
        #[inline(always)]
        |lane| answers[lane / LANES][channel].0[lane % LANES],
    )
}

/// Stores the four channels of a lane among the sample results.
#[inline(always)]
pub(crate) fn answer(answers: &mut Answers, lane: usize, channels: [f32; 4]) {
    for (of_channel, channel) in answers.iter_mut().zip(channels) {
        of_channel.0[lane] = channel;
    }
}
