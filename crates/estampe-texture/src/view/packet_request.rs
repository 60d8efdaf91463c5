//! [`PacketRequest`]: what up to sixteen lanes ask of a view, as packets in memory.
//!
//! A shader in Rust stores its lanes as packets; a compiled shader has them in memory and asks with
//! references alone.

use super::coordinates::{Coordinates, Lod, packet};
use crate::request::{Request, RequestDetail};
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
    pub(super) fn common(&self) -> Option<Request<'_>> {
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
    pub(super) fn common(self) -> Request<'a> {
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
    pub(super) fn request(self) -> PacketRequest<'a> {
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
