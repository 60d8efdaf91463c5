//! The scalar code of filtering, lane by lane: probes, mip levels, texels.
//!
//! It serves formats without packet code, requests of fewer than sixteen lanes, the scalar SIMD
//! level, and the lanes that packet code leaves out.

use super::axis::{self, Place};
use super::coordinates::{Answers, answer};
use super::footprint::Footprint;
use super::plane::Plane;
use super::{PacketLod, PacketRequest, SampledTexture, cube};
use estampe_format::TexelCodec;
use estampe_types::ViewDimension;
use estampe_types::{AddressMode, BorderColor, FilterMode, Real};

/// A coordinate with its layer; for cubes, within one face.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spot {
    pub(crate) uvw: [f32; 3],
    /// The layer of the texture; for cubes, the layer of the face +X.
    layer: i32,
    /// The face, 0 to 5.
    face: i32,
}

impl Spot {
    /// The layer of the texture; for cubes, the layer of the first face.
    pub(crate) fn layer(&self) -> i32 {
        self.layer
    }
}

/// The value of a texel that is filtered: its channels in units, or its comparison result.
pub(crate) trait Tap {
    fn of(&self, unit: [f32; 4]) -> [f32; 4];
}

/// The channels of a texel.
pub(crate) struct Channels;

impl Tap for Channels {
    #[inline(always)]
    fn of(&self, unit: [f32; 4]) -> [f32; 4] {
        unit
    }
}

impl SampledTexture {
    /// Samples lanes: by packet code if possible, else lane by lane.
    #[inline(never)]
    pub(crate) fn sample_lanes(&self, lanes: &PacketRequest<'_>, colors: &mut Answers) {
        if self.sample_packet(lanes, colors, false).is_none() {
            for lane in 0..lanes.count {
                answer(colors, lane, self.sample_lane(lanes, lane));
            }
        }
    }

    /// Samples one lane.
    pub(crate) fn sample_lane(&self, lanes: &PacketRequest<'_>, lane: usize) -> [f32; 4] {
        let footprint = self.footprint(lanes, lane);
        let unit = self.probes(lanes, lane, &footprint, &Channels);
        self.view.codec.finish(unit)
    }

    /// The footprint of a lane; every bias is added to its λ.
    pub(crate) fn footprint(&self, lanes: &PacketRequest<'_>, lane: usize) -> Footprint {
        let (view, sampler) = (&self.view, &self.sampler);
        let mut footprint = match lanes.lod {
            PacketLod::Level => Footprint::of_level(lanes.value.0[lane]),
            PacketLod::Implicit | PacketLod::Bias => {
                let first = lanes.first_of_quad(lane);
                Footprint::new(view, sampler, lanes.at(first), lanes.differences(first))
            }
            PacketLod::Gradients => {
                Footprint::new(view, sampler, lanes.at(lane), lanes.gradients(lane))
            }
        };
        let bias = match lanes.lod {
            PacketLod::Implicit | PacketLod::Bias => sampler.lod_bias + lanes.value.0[lane],
            PacketLod::Level | PacketLod::Gradients => sampler.lod_bias,
        };
        footprint.lod += Real::clamp(bias, -16.0, 15.99);
        footprint
    }

    /// The mean of the probes along the footprint, in units.
    pub(crate) fn probes(
        &self,
        lanes: &PacketRequest<'_>,
        lane: usize,
        footprint: &Footprint,
        tap: &impl Tap,
    ) -> [f32; 4] {
        let at = lanes.at(lane);
        let count = f32::from(footprint.probes);
        let mut sum = [0.0; 4];
        for probe in 1..=footprint.probes {
            let mut uvw = at;
            if footprint.probes > 1 {
                let t = f32::from(probe) / (count + 1.0) - 0.5;
                for (at, step) in uvw.iter_mut().zip(footprint.step) {
                    *at += step * t;
                }
            }
            let spot = self.spot(uvw, lanes.layer(lane));
            let color = self.levels(&spot, footprint.lod, lanes.offset, tap);
            sum = if probe == 1 {
                color
            } else {
                std::array::from_fn(|k| sum[k] + color[k])
            };
        }
        if footprint.probes > 1 {
            let weight = 1.0 / count;
            sum = sum.map(|channel| channel * weight);
        }
        sum
    }

    /// Finds the layer and the face of coordinates.
    pub(crate) fn spot(&self, at: [f32; 3], layer: i32) -> Spot {
        let view = &self.view;
        let layer = Ord::clamp(layer, 0, view.layers - 1);
        let base = view.base_layer.cast_signed();
        if view.is_cube() {
            let face = cube::face_of(at);
            let [s, t] = cube::project(at, face);
            return Spot {
                uvw: [s, t, 0.0],
                layer: base + 6 * layer,
                // Below 6.
                face: i32::try_from(face).unwrap_or_default(),
            };
        }
        Spot {
            uvw: at,
            layer: base + layer,
            face: 0,
        }
    }

    /// Samples one mip level, or mixes two.
    fn levels(&self, spot: &Spot, lod: f32, offset: [i32; 3], tap: &impl Tap) -> [f32; 4] {
        let sampler = &self.sampler;
        let lod = Real::clamp(lod, sampler.lod_min_clamp, sampler.lod_max_clamp);
        let filter = if lod > 0.0 {
            sampler.min_filter
        } else {
            sampler.mag_filter
        };
        let lod = Real::clamp(lod, 0.0, (self.view.planes.len() - 1) as f32);
        let of_level = |level: f32| {
            let plane = &self.view.planes[Real::to_int(level) as usize];
            self.texels(plane, spot, filter, offset, tap)
        };
        match sampler.mipmap_filter {
            FilterMode::Nearest => of_level((lod + 0.5).floor()),
            FilterMode::Linear => {
                let level = lod.floor();
                let fraction = lod - level;
                let fine = of_level(level);
                if fraction == 0.0 {
                    return fine;
                }
                mix(fine, of_level(level + 1.0), fraction)
            }
        }
    }

    /// Samples one mip level, nearest or linear.
    fn texels(
        &self,
        plane: &Plane,
        spot: &Spot,
        filter: FilterMode,
        offset: [i32; 3],
        tap: &impl Tap,
    ) -> [f32; 4] {
        if self.view.is_cube() {
            return self.texels_of_cube(plane, spot, filter, tap);
        }
        let is_linear = filter == FilterMode::Linear;
        let tap = |x, y, slice| tap.of(self.unit(plane, [x, y, slice]));
        let x = self.place(plane, spot, 0, filter, offset);
        let row = |y: i32, slice: i32| {
            let left = tap(x.texels[0], y, slice);
            if !is_linear {
                return left;
            }
            mix(left, tap(x.texels[1], y, slice), x.fraction)
        };
        if self.view.dimension == ViewDimension::D1 {
            return row(0, spot.layer);
        }
        let y = self.place(plane, spot, 1, filter, offset);
        let image = |slice: i32| {
            let upper = row(y.texels[0], slice);
            if !is_linear {
                return upper;
            }
            mix(upper, row(y.texels[1], slice), y.fraction)
        };
        if self.view.dimension != ViewDimension::D3 {
            return image(spot.layer);
        }
        let z = self.place(plane, spot, 2, filter, offset);
        let near = image(z.texels[0]);
        if !is_linear {
            return near;
        }
        mix(near, image(z.texels[1]), z.fraction)
    }

    /// The texels along one axis.
    pub(crate) fn place(
        &self,
        plane: &Plane,
        spot: &Spot,
        axis: usize,
        filter: FilterMode,
        offset: [i32; 3],
    ) -> Place {
        let side = (plane.sides[axis], plane.size[axis]);
        let mode = self.address_modes()[axis];
        axis::place(spot.uvw[axis], side, mode, filter, offset[axis])
    }

    /// The address modes of the three axes.
    pub(crate) fn address_modes(&self) -> [AddressMode; 3] {
        let sampler = &self.sampler;
        [
            sampler.address_mode_u,
            sampler.address_mode_v,
            sampler.address_mode_w,
        ]
    }

    /// A texel in units; the border colour if one of its coordinates is −1.
    pub(crate) fn unit(&self, plane: &Plane, at: [i32; 3]) -> [f32; 4] {
        let codec = &self.view.codec;
        if at[0].min(at[1]).min(at[2]) < 0 {
            let color = self.sampler.border_color;
            let is_white = color == BorderColor::OpaqueWhite;
            let is_opaque = color != BorderColor::TransparentBlack;
            let ones = [is_white, is_white, is_white, is_opaque];
            return std::array::from_fn(|k| border_unit(codec, k, ones[k]));
        }
        codec.units(self.view.texel(plane, at, 0))
    }

    /// Samples one mip level of a cube; linear filtering continues across edges.
    fn texels_of_cube(
        &self,
        plane: &Plane,
        spot: &Spot,
        filter: FilterMode,
        tap: &impl Tap,
    ) -> [f32; 4] {
        let (n, length) = (plane.sides[0], plane.size[0]);
        if filter == FilterMode::Nearest {
            let [x, y] = [spot.uvw[0], spot.uvw[1]]
                .map(|s| Real::to_int(Real::clamp((s * length).floor(), 0.0, length - 1.0)));
            return tap.of(self.unit(plane, [x, y, spot.layer + spot.face]));
        }
        let (four, [fx, fy]) = self.four_of_cube(plane, spot, n, tap);
        mix(mix(four[0], four[1], fx), mix(four[2], four[3], fx), fy)
    }

    /// The four texels around a point of a cube (left and right of the upper row, then of the
    /// lower), and the position between their centres. Where three faces meet, the missing texel is
    /// the mean of the others.
    pub(crate) fn four_of_cube(
        &self,
        plane: &Plane,
        spot: &Spot,
        n: i32,
        tap: &impl Tap,
    ) -> ([[f32; 4]; 4], [f32; 2]) {
        let length = plane.size[0];
        let [x, y] = [spot.uvw[0], spot.uvw[1]].map(|s| {
            let at = Real::clamp(s * length - 0.5, -0.5, length - 0.5);
            let whole = at.floor();
            (Real::to_int(whole), at - whole)
        });
        let mut missing = None;
        let mut four = [[0.0; 4]; 4];
        for (index, texel) in four.iter_mut().enumerate() {
            let at = (x.0 + [0, 1, 0, 1][index], y.0 + [0, 0, 1, 1][index]);
            if let Some((face, x, y)) = cube::across(spot.face, at.0, at.1, n) {
                *texel = tap.of(self.unit(plane, [x, y, spot.layer + face]));
            } else if self.view.codec.is_integer() {
                // Integers have no mean: take the corner texel of this face.
                let [x, y] = [at.0, at.1].map(|at| Ord::clamp(at, 0, n - 1));
                *texel = tap.of(self.unit(plane, [x, y, spot.layer + spot.face]));
            } else {
                missing = Some(index);
            }
        }
        if let Some(missing) = missing {
            let mut sum = [0.0; 4];
            let mut is_first = true;
            for (index, texel) in four.iter().enumerate() {
                if index != missing {
                    sum = if is_first {
                        *texel
                    } else {
                        std::array::from_fn(|k| sum[k] + texel[k])
                    };
                    is_first = false;
                }
            }
            four[missing] = sum.map(|channel| channel * (1.0 / 3.0));
        }
        (four, [x.1, y.1])
    }
}

/// 0 or 1 of a channel in units, for border colours. Channels that the format does not store read
/// as they do elsewhere.
pub(crate) fn border_unit(codec: &TexelCodec, channel: usize, is_one: bool) -> f32 {
    if channel >= codec.components() {
        return codec.missing()[channel];
    }
    match (is_one, codec.is_integer()) {
        (false, _) => 0.0,
        (true, true) => f32::from_bits(1),
        (true, false) => (1.0 / codec.scale()[channel]).round(),
    }
}

/// `a + (b − a)·t` of each channel.
#[inline(always)]
pub(crate) fn mix(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    [
        a[0] + (b[0] - a[0]) * t,
        a[1] + (b[1] - a[1]) * t,
        a[2] + (b[2] - a[2]) * t,
        a[3] + (b[3] - a[3]) * t,
    ]
}
