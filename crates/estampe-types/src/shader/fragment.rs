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
        }
    }

    /// A colour for target 0: linear RGBA.
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
#[derive(Debug)]
pub struct FragmentBatch<'a> {
    /// The varyings' scalars, interpolated.
    pub varyings: &'a [Packet<f32>],
    /// Window x, y, z and 1/w; empty unless the interface says that it is read.
    pub positions: &'a [Packet<f32>],
    /// By packet: bit `i` says whether lane `i` is of a front-facing primitive.
    pub front_facing: &'a [u16],
    /// By packet, in and out: the lanes to shade; discarding clears a lane's bit.
    pub coverage: &'a mut [u16],
    /// Out: R, G, B, A of each target.
    pub colors: &'a mut [Packet<f32>],
    /// Out: depth by packet; empty unless the interface says that it is written.
    pub depths: &'a mut [Packet<f32>],
}
