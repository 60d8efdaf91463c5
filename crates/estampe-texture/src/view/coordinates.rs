//! Where a shader reads a texture: the lanes' coordinates, and how the level of detail is found.

use estampe_types::{Int, Real, Vec2, Vec3, Vec4};

/// The most lanes of a [`Real`]: a pair of packets.
pub(crate) const MAX_LANES: usize = 32;

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

/// The same as arrays: a request that code which knows no lanes can fulfil.
#[derive(Debug)]
pub(crate) struct Lanes {
    /// How many lanes there are.
    pub(crate) count: usize,
    pub(crate) at: [[f32; 3]; MAX_LANES],
    pub(crate) layer: [i32; MAX_LANES],
    pub(crate) lod: LodOfLanes,
    /// The bias, or the level.
    pub(crate) value: [f32; MAX_LANES],
    /// Along x and along y.
    pub(crate) gradients: [[[f32; 3]; 2]; MAX_LANES],
    /// What is compared with.
    pub(crate) reference: [f32; MAX_LANES],
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
    #[inline(always)]
    pub(crate) fn new<R: Real>(at: &Coordinates<R>, lod: &Lod<R>, offset: [i32; 3]) -> Self {
        let mut lanes = Self {
            count: R::LANES,
            at: [[0.0; 3]; MAX_LANES],
            layer: [0; MAX_LANES],
            lod: match lod {
                Lod::Implicit | Lod::Bias(_) => LodOfLanes::Bias,
                Lod::Level(_) => LodOfLanes::Level,
                Lod::Gradients(..) => LodOfLanes::Gradients,
            },
            value: [0.0; MAX_LANES],
            gradients: [[[0.0; 3]; 2]; MAX_LANES],
            reference: [0.0; MAX_LANES],
            offset,
        };
        for lane in 0..R::LANES {
            lanes.at[lane] = of_lane(&at.uvw, lane);
            lanes.layer[lane] = at.layer.lane(lane);
        }
        match lod {
            Lod::Implicit => {}
            Lod::Bias(value) | Lod::Level(value) => {
                for lane in 0..R::LANES {
                    lanes.value[lane] = value.lane(lane);
                }
            }
            Lod::Gradients(dx, dy) => {
                for lane in 0..R::LANES {
                    lanes.gradients[lane] = [of_lane(dx, lane), of_lane(dy, lane)];
                }
            }
        }
        lanes
    }

    #[inline(always)]
    pub(crate) fn set_reference<R: Real>(&mut self, reference: R) {
        for lane in 0..R::LANES {
            self.reference[lane] = reference.lane(lane);
        }
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
        [1, 2].map(|other| std::array::from_fn(|k| self.at[first + other][k] - self.at[first][k]))
    }
}

/// Lanes' four numbers as a vector.
#[inline(always)]
pub(crate) fn packed<R: Real>(like: R, lanes: &[[f32; 4]; MAX_LANES]) -> Vec4<R> {
    Vec4::new(
        like.with_lanes(
            #[inline(always)]
            |lane| lanes[lane][0],
        ),
        like.with_lanes(
            #[inline(always)]
            |lane| lanes[lane][1],
        ),
        like.with_lanes(
            #[inline(always)]
            |lane| lanes[lane][2],
        ),
        like.with_lanes(
            #[inline(always)]
            |lane| lanes[lane][3],
        ),
    )
}

#[inline(always)]
fn of_lane<R: Real>(v: &Vec3<R>, lane: usize) -> [f32; 3] {
    [v.x.lane(lane), v.y.lane(lane), v.z.lane(lane)]
}
