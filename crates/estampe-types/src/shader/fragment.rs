//! What a fragment shader is given and gives.

use crate::{Bindings, Real, Vec4};
use estampe_simd::Packet;

/// The most colour targets that a shader can write.
pub(crate) const MAX_COLORS: usize = 8;

/// The built-in inputs of a fragment shader.
#[derive(Debug, Clone, Copy)]
pub struct FragmentIn<'a, R: Real> {
    /// Window-space x, y (pixel centres at ½), z and 1/w, if the shader says that it reads it.
    pub position: Vec4<R>,
    /// Whether the triangle faces the viewer, also where only its edges or vertices are drawn; true for
    /// primitives that were lines or points from the start.
    pub front_facing: R::Mask,
    /// Whether the lane is a fragment; where not it is a helper, there for its neighbours' derivatives, and must not
    /// store anything.
    pub is_live: R::Mask,
    /// The number of the sample that is shaded, if the shader is run [per sample](crate::Shader::PER_SAMPLE); 0
    /// where not.
    pub sample_index: R::Int,
    /// Which samples of the pixel the primitive covers, bit by bit (of a shader that is run per sample: its own
    /// alone), if the shader says that it [reads](crate::Shader::READS_COVERAGE) it; where not, 0.
    pub coverage: R::Int,
    /// What the draw binds.
    pub bindings: &'a Bindings,
    /// Any number, to make constants from.
    pub zero: R,
}

impl<R: Real> FragmentIn<'_, R> {
    /// A constant.
    #[inline(always)]
    pub fn real(&self, value: f32) -> R {
        self.zero.splat(value)
    }
}

/// What a fragment shader gives.
#[derive(Debug, Clone, Copy)]
pub struct FragmentOut<R: Real> {
    pub(crate) colors: [Option<Vec4<R>>; MAX_COLORS],
    pub(crate) depth: Option<R>,
    pub(crate) keep: Option<R::Mask>,
    pub(crate) second: Option<Vec4<R>>,
    pub(crate) sample_mask: Option<R::Int>,
}

impl<R: Real> FragmentOut<R> {
    /// No colour: for depth alone.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        Self {
            colors: [None; MAX_COLORS],
            depth: None,
            keep: None,
            second: None,
            sample_mask: None,
        }
    }

    /// A colour for target 0: linear RGBA; for targets of integers, their [bits](Real::to_bits).
    #[inline(always)]
    pub fn color(rgba: Vec4<R>) -> Self {
        Self::none().with_color(0, rgba)
    }

    /// A colour for target `index`, below `COLOR_TARGETS`.
    #[inline(always)]
    #[must_use]
    pub fn with_color(mut self, index: usize, rgba: Vec4<R>) -> Self {
        self.colors[index] = Some(rgba);
        self
    }

    /// The second colour of dual-source blending; the shader must say `DUAL_SOURCE`.
    #[inline(always)]
    #[must_use]
    pub fn with_second_color(self, rgba: Vec4<R>) -> Self {
        Self {
            second: Some(rgba),
            ..self
        }
    }

    /// Only these samples of each pixel are kept, bit by bit; the shader must say `WRITES_SAMPLE_MASK`.
    #[inline(always)]
    #[must_use]
    pub fn with_sample_mask(self, samples: R::Int) -> Self {
        Self {
            sample_mask: Some(samples),
            ..self
        }
    }

    /// A depth in place of the interpolated one; the shader must declare `DEPTH_OUTPUT`.
    #[inline(always)]
    #[must_use]
    pub fn with_depth(self, depth: R) -> Self {
        Self {
            depth: Some(depth),
            ..self
        }
    }

    /// Only the lanes of the mask are kept; the shader must say `DISCARDS`.
    #[inline(always)]
    #[must_use]
    pub fn keep_where(self, mask: R::Mask) -> Self {
        let keep = match self.keep {
            Some(before) => before & mask,
            None => mask,
        };
        Self {
            keep: Some(keep),
            ..self
        }
    }

    /// The colour of a target, if one was given.
    #[inline(always)]
    pub fn color_of(&self, index: usize) -> Option<Vec4<R>> {
        self.colors[index]
    }

    /// The second colour, if one was given.
    #[inline(always)]
    pub fn second_color(&self) -> Option<Vec4<R>> {
        self.second
    }

    /// The samples to keep, if they were given.
    #[inline(always)]
    pub fn sample_mask(&self) -> Option<R::Int> {
        self.sample_mask
    }

    /// The depth, if one was given.
    #[inline(always)]
    pub fn depth(&self) -> Option<R> {
        self.depth
    }

    /// The lanes that are kept, if some may have been discarded.
    #[inline(always)]
    pub fn kept(&self) -> Option<R::Mask> {
        self.keep
    }
}

/// Packets of fragments, structure of arrays: scalar `k` of packet `p` is element `p * scalars + k`.
#[derive(Debug, Default)]
pub struct FragmentBatch<'a> {
    /// The varyings' scalars, interpolated.
    pub varyings: &'a [Packet<f32>],
    /// Window x, y, z and 1/w; empty unless the interface says that it is read.
    pub positions: &'a [Packet<f32>],
    /// By packet: bit `i` says whether lane `i` is of a front-facing primitive.
    pub front_facing: &'a [u16],
    /// The sample that each packet is of; empty unless the interface says that fragments are shaded by sample.
    pub sample_index: &'a [u32],
    /// By packet and lane the samples that are covered; empty unless the interface says that they are read.
    pub samples_covered: &'a [Packet<u32>],
    /// By packet, in and out: the lanes to shade; discarding clears a lane's bit.
    pub coverage: &'a mut [u16],
    /// Out: R, G, B, A of each target, then those of the second colour if there is one.
    pub colors: &'a mut [Packet<f32>],
    /// Out: depth by packet; empty unless the interface says that it is written.
    pub depths: &'a mut [Packet<f32>],
    /// Out: samples to keep, by packet and lane; empty unless the interface says that they are written.
    pub sample_masks: &'a mut [Packet<u32>],
}
