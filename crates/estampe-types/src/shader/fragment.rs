//! Inputs and outputs of fragment shaders.

use crate::{Bindings, Real, ShaderError, Vec4};
use estampe_simd::Packet;

/// The maximum number of colour targets of a shader.
pub(crate) const MAX_COLORS: usize = 8;

/// The built-in inputs of a fragment shader.
#[derive(Debug, Clone, Copy)]
pub struct FragmentIn<'a, R: Real> {
    /// Window-space x, y (pixel centres at ½), z and 1/w. Zero if the dry run did not find that the
    /// shader reads it, and [`READS_POSITION`](crate::Shader::READS_POSITION) is not set.
    pub position: Vec4<R>,
    /// True if the triangle is front-facing; in polygon modes this holds for its edges and vertices
    /// too. Always true for line and point topologies.
    pub front_facing: R::SelectMask,
    /// Helper invocations: lanes that the primitive does not cover, shaded for their neighbours'
    /// derivatives alone. A helper's colours are dropped, and it must not store anything.
    pub is_helper: R::SelectMask,
    /// Index of the shaded sample. A shader that reads it runs once
    /// [per sample](crate::Shader::PER_SAMPLE).
    pub sample_index: R::Int,
    /// Mask of the samples of the pixel that the primitive covers: bit i is sample i. A shader that
    /// runs per sample sees its own sample only. Zero if the dry run did not find that the shader
    /// reads it, and [`READS_COVERAGE`](crate::Shader::READS_COVERAGE) is not set.
    pub coverage: R::Int,
    /// The resources that the draw binds.
    pub bindings: &'a Bindings,
    /// A number of the shader's kind, to make constants from; see [`FragmentIn::real`].
    pub zero: R,
}

impl<R: Real> FragmentIn<'_, R> {
    /// `value` in every lane.
    #[inline(always)]
    pub fn real(&self, value: f32) -> R {
        self.zero.splat(value)
    }
}

/// Outputs of a fragment shader.
#[derive(Debug, Clone, Copy)]
pub struct FragmentOut<R: Real> {
    pub(crate) colors: [Option<Vec4<R>>; MAX_COLORS],
    pub(crate) depth: Option<R>,
    pub(crate) keep: Option<R::SelectMask>,
    pub(crate) second: Option<Vec4<R>>,
    pub(crate) sample_mask: Option<R::Int>,
}

impl<R: Real> FragmentOut<R> {
    /// No colour, for shaders that write depth alone or nothing.
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

    /// A colour for target 0: linear RGBA. For integer targets, the [bits](Real::to_bits) of the
    /// integers.
    #[inline(always)]
    pub fn color(rgba: Vec4<R>) -> Self {
        Self::none().with_color(0, rgba)
    }

    /// Sets the colour of target `index`, 0 to 7. A shader that sets another one has no effect
    /// there, and no pipeline is made of it.
    #[inline(always)]
    #[must_use]
    pub fn with_color(mut self, index: usize, rgba: Vec4<R>) -> Self {
        match self.colors.get_mut(index) {
            Some(place) => *place = Some(rgba),
            None => rgba.x.report(ShaderError::ColorIndex { index }),
        }
        self
    }

    /// Sets the second colour of dual-source blending. The shader then has one target.
    #[inline(always)]
    #[must_use]
    pub fn with_second_color(self, rgba: Vec4<R>) -> Self {
        Self {
            second: Some(rgba),
            ..self
        }
    }

    /// Keeps only the samples whose bits are set.
    #[inline(always)]
    #[must_use]
    pub fn with_sample_mask(self, samples: R::Int) -> Self {
        Self {
            sample_mask: Some(samples),
            ..self
        }
    }

    /// Replaces the interpolated depth; see [`DEPTH_OUTPUT`](crate::Shader::DEPTH_OUTPUT).
    #[inline(always)]
    #[must_use]
    pub fn with_depth(self, depth: R) -> Self {
        Self {
            depth: Some(depth),
            ..self
        }
    }

    /// Discards the lanes in which the mask is false.
    #[inline(always)]
    #[must_use]
    pub fn discard_unless(self, mask: R::SelectMask) -> Self {
        let keep = match self.keep {
            Some(before) => before & mask,
            None => mask,
        };
        Self {
            keep: Some(keep),
            ..self
        }
    }

    /// The colour of a target, if the shader set it.
    #[inline(always)]
    pub fn color_of(&self, index: usize) -> Option<Vec4<R>> {
        self.colors.get(index).copied().flatten()
    }

    /// The second colour, if the shader set it.
    #[inline(always)]
    pub fn second_color(&self) -> Option<Vec4<R>> {
        self.second
    }

    /// The sample mask, if the shader set it.
    #[inline(always)]
    pub fn sample_mask(&self) -> Option<R::Int> {
        self.sample_mask
    }

    /// The depth, if the shader set it.
    #[inline(always)]
    pub fn depth(&self) -> Option<R> {
        self.depth
    }

    /// The mask of lanes that are not discarded, or `None` if the shader never discards.
    #[inline(always)]
    pub fn kept(&self) -> Option<R::SelectMask> {
        self.keep
    }
}

/// Packets of fragments, structure of arrays: scalar `k` of packet `p` is element `p * scalars +
/// k`.
#[derive(Debug, Default)]
pub struct FragmentBatch<'a> {
    /// The varyings' scalars, interpolated; then, of the scalars that the interface lists in
    /// `gradients`, the derivatives along x, and those along y. Together they are
    /// [`Interface::fragment_scalars`](crate::Interface::fragment_scalars).
    pub varyings: &'a [Packet<f32>],
    /// Window x, y, z and 1/w; empty unless `reads_position` is set in the interface.
    pub positions: &'a [Packet<f32>],
    /// By packet: bit `i` is set if lane `i` belongs to a front-facing primitive.
    pub front_facing: &'a [u16],
    /// Sample index of each packet; empty unless `per_sample` is set in the interface.
    pub sample_index: &'a [u32],
    /// Covered samples by packet and lane; empty unless `reads_coverage` is set in the interface.
    pub samples_covered: &'a [Packet<u32>],
    /// In and out: by packet, the mask of lanes to shade. Discarding clears a lane's bit.
    pub coverage: &'a mut [u16],
    /// Out: R, G, B, A of each target, then R, G, B, A of the second colour if `dual_source` is
    /// set.
    pub colors: &'a mut [Packet<f32>],
    /// Out: depth by packet; empty unless `depth_output` is set in the interface.
    pub depths: &'a mut [Packet<f32>],
    /// Out: mask of kept samples by packet and lane; empty unless `writes_sample_mask` is set in
    /// the interface.
    pub sample_masks: &'a mut [Packet<u32>],
}
