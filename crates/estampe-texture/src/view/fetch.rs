//! Texel fetches: reads by integer coordinates, without a sampler.

use super::TexelView;
use super::coordinates::{Answers, answer, by_sixteen, packet_of_ints};
use estampe_simd::{LANES, Packet};
use estampe_types::{Int, Real, Vec4, ViewDimension};

impl TexelView {
    /// The texel (x, y, z) of a level; z is the depth in a 3D view, or the layer of an array (six
    /// per cube). Coordinates along axes that the view does not have are ignored. `sample` selects
    /// a sample of a multisampled texture.
    ///
    /// Numbers are as sampling gives them; integer formats give the [bits](Real::to_bits). A texel,
    /// layer, level or sample that does not exist reads as zeros, alpha too (WebGPU's and Vulkan's
    /// robust access).
    #[inline(always)]
    pub fn fetch<I: Int>(&self, [x, y, z]: [I; 3], level: I, sample: I) -> Vec4<I::Real> {
        let like = x.to_real();
        like.out_of_line(
            #[inline(always)]
            || {
                by_sixteen(
                    like,
                    #[inline(always)]
                    |first| {
                        let places = [
                            packet_of_ints(x, first),
                            packet_of_ints(y, first),
                            packet_of_ints(z, first),
                            packet_of_ints(level, first),
                            packet_of_ints(sample, first),
                        ];
                        self.fetch_lanes(&places, <I::Real as Real>::LANES.min(LANES))
                    },
                )
            },
        )
    }

    #[inline(never)]
    fn fetch_lanes(&self, places: &[Packet<i32>; 5], count: usize) -> Answers {
        let mut texels = Answers::default();
        if count == LANES && self.fetch_packet(self.level, places.each_ref(), &mut texels) {
            return texels;
        }
        for lane in 0..count {
            let place = places.each_ref().map(|of_lanes| of_lanes.0[lane]);
            answer(&mut texels, lane, self.fetch_one(place).unwrap_or_default());
        }
        texels
    }

    pub(crate) fn fetch_one(&self, [x, y, z, level, sample]: [i32; 5]) -> Option<[f32; 4]> {
        use ViewDimension as V;
        let plane = self.planes.get(usize::try_from(level).ok()?)?;
        let sample = u32::try_from(sample).ok()?;
        let samples = self.texture.shape.samples;
        let faces = if self.is_cube() { 6 } else { 1 };
        let (y, z) = match self.dimension {
            V::D1 => (0, 0),
            V::D2 => (y, 0),
            V::D2Array | V::Cube | V::CubeArray | V::D3 => (y, z),
        };
        let slices = match self.dimension {
            V::D3 => plane.sides[2],
            _ => self.layers * faces,
        };
        let is_there = (0..plane.sides[0]).contains(&x)
            && (0..plane.sides[1]).contains(&y)
            && (0..slices).contains(&z)
            // A texture that is not multisampled has one sample.
            && sample < samples;
        if !is_there {
            return None;
        }
        let slice = self.base_layer.cast_signed() + z;
        let words = self.texel(plane, [x, y, slice], sample);
        Some(self.codec.decode(words))
    }
}
