//! Shaded packets: for the tests after shading, then for the attachments.

use super::{CAPACITY, FragmentQueue};
use crate::depth_format::clamp_depth;
use crate::fragment::place::Place;
use crate::raster::MAX_SAMPLES;
use estampe_simd::{Lanes, Packet, SimdBase, f32x16};
use estampe_types::shader::DepthOutput;

impl<const N: usize> FragmentQueue<N> {
    /// The shaded packets, in order, with what tests after shading need.
    #[inline(always)]
    pub(crate) fn late_packets(&mut self) -> impl Iterator<Item = LatePacket<'_, N>> {
        let len = self.len.min(CAPACITY);
        let (targets, each, output) = (self.targets, self.colors_each, self.depth_output);
        let (colors, depths) = (&self.colors, &self.depths);
        let (places, front, depth_out) = (&self.places, &self.front_facing, &self.depth_out);
        let (sample_masks, shaded_of) = (&self.sample_masks, &self.shaded_of);
        let packets = self.masks.iter_mut().enumerate().take(len);
        packets.map(move |(slot, masks)| {
            let shaded = usize::from(shaded_of[slot]) % CAPACITY;
            LatePacket {
                masks,
                place: &places[slot],
                front: front[shaded],
                alpha: (targets > 0).then(|| &colors[shaded * each * 4 + 3]),
                depths: depths.get(slot * N..(slot + 1) * N).unwrap_or_default(),
                depth_out: (output != DepthOutput::None).then_some((output, &depth_out[shaded])),
                sample_mask: sample_masks.get(shaded),
            }
        })
    }

    /// The shaded packets' colours, in order.
    #[inline(always)]
    pub(crate) fn batch(&self) -> ShadedBatch<'_> {
        let len = self.len.min(CAPACITY);
        let (colors, stride) = if self.color_passthrough {
            (&self.varyings, self.scalars)
        } else {
            (&self.colors, self.colors_each * 4)
        };
        ShadedBatch {
            places: &self.places[..len],
            masks: &self.masks.as_flattened()[..len * N],
            mask_stride: N,
            samples: self.samples.count(),
            shaded_of: &self.shaded_of[..len],
            colors: &colors[..self.shaded_len.min(CAPACITY) * stride],
            stride,
            second: (self.colors_each > self.targets).then_some(self.targets * 4),
        }
    }
}

/// A shaded packet before the tests that come after shading.
#[derive(Debug)]
pub(crate) struct LatePacket<'a, const N: usize> {
    /// By sample: the lanes that are covered and not discarded.
    pub(crate) masks: &'a mut [u16; N],
    pub(crate) place: &'a Place,
    /// The lanes whose primitive faces the viewer.
    pub(crate) front: u16,
    /// Alpha of target 0.
    pub(crate) alpha: Option<&'a Packet<f32>>,
    /// Interpolated depth of each sample.
    pub(crate) depths: &'a [Packet<f32>],
    /// The shader's depth, and how it is declared.
    pub(crate) depth_out: Option<(DepthOutput, &'a Packet<f32>)>,
    /// The samples that the shader keeps, bit by bit.
    pub(crate) sample_mask: Option<&'a Packet<u32>>,
}

/// Colours of shaded packets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShadedBatch<'a> {
    places: &'a [Place],
    /// By packet and sample.
    masks: &'a [u16],
    mask_stride: usize,
    /// Samples of a pixel.
    pub(crate) samples: usize,
    /// By packet: its place among the colours.
    shaded_of: &'a [u8],
    /// Four channels of each target, then of the second colour.
    colors: &'a [Packet<f32>],
    stride: usize,
    /// The index of the second colour's first channel in a packet's colours.
    second: Option<usize>,
}

/// One packet of a batch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShadedPacket<'a> {
    pub(crate) place: &'a Place,
    /// By sample: the lanes to write.
    pub(crate) masks: &'a [u16],
    /// The place of its colours: packets with the same one have the same colours.
    pub(crate) shaded: u8,
    colors: &'a [Packet<f32>],
    second: Option<usize>,
}

impl<'a> ShadedBatch<'a> {
    /// The packets, in order.
    #[inline(always)]
    pub(crate) fn packets(self) -> impl Iterator<Item = ShadedPacket<'a>> {
        let places = self.places.iter().enumerate();
        places.map(move |(slot, place)| ShadedPacket {
            place,
            masks: &self.masks[slot * self.mask_stride..][..self.samples.min(MAX_SAMPLES)],
            shaded: self.shaded_of[slot],
            colors: &self.colors[usize::from(self.shaded_of[slot]) * self.stride..][..self.stride],
            second: self.second,
        })
    }
}

impl<'a> ShadedPacket<'a> {
    /// R, G, B, A of a target.
    #[inline(always)]
    pub(crate) fn color(&self, target: usize) -> &'a [Packet<f32>; 4] {
        let color = self.colors[target * 4..].first_chunk();
        color.expect("a pipeline has as many targets as its shader has colours")
    }

    /// The second colour of dual-source blending.
    #[inline(always)]
    pub(crate) fn second(&self) -> Option<&'a [Packet<f32>; 4]> {
        self.second
            .and_then(|from| self.colors.get(from..)?.first_chunk())
    }
}

/// A sample's depths after shading: interpolated, or the shader's as it declares it, clamped to a
/// range; NaN is its lower end.
#[inline(always)]
pub(crate) fn depth_after_shading<S: Lanes>(
    s: S,
    interpolated: f32x16<S>,
    depth_out: Option<(DepthOutput, &Packet<f32>)>,
    range: [f32; 2],
) -> f32x16<S> {
    let Some((output, written)) = depth_out else {
        return interpolated;
    };
    let written = clamp_depth(s, f32x16::load_array_ref(s, &written.0), range);
    match output {
        DepthOutput::Greater => s.max_f32(interpolated, written),
        DepthOutput::Less => s.min_f32(interpolated, written),
        DepthOutput::Any | DepthOutput::None => written,
    }
}
