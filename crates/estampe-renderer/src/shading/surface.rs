//! The shader of surfaces, composed of parts: a base colour, the place where the light is computed
//! with the terms of the light, and an output.
//!
//! ```text
//!   base colour        plain · vertex colour · texture (with a bump map)      base_color
//!   × interpolation    flat · Gouraud · Phong                                 interpolation
//!   × terms            ambient + diffuse + specular · toon · unlit            terms, lighting
//!   × output           plain · quantised · fogged                             output
//!   × written          colour · terms of weighted transparency, clamped by the target or not
//! ```
//!
//! A part that needs other varyings is a type, and each combination of these is a shader of its
//! own, which takes the compiler seconds at each SIMD level: there are two base colours and two
//! interpolations. All other choices are values of fields. A branch on a field costs a fragment
//! nothing that can be measured, and the pipeline finds what a shader reads with the fields that it
//! has: without fog no position, without a texture no derivatives.

use super::base_color::{Alpha, BaseColor};
use super::cut_out;
use super::interpolation::Interpolation;
use super::output::Output;
use estampe::{FragmentIn, FragmentOut, Real, Vec3, Vec4, VertexIn, VertexOut};
use estampe_transparency::{DepthOrder, weighted_fragment};

/// The order of depths of all cameras: 0 at the near plane.
pub const DEPTH_ORDER: DepthOrder = DepthOrder::NearIsZero;

/// A surface.
#[derive(Debug, Clone)]
pub struct Surface<B, I> {
    pub base_color: B,
    pub interpolation: I,
    pub output: Output,
    pub written: Written,
}

/// The greatest number of binary16.
pub const MOST_LIGHT: f32 = 65_504.0;

/// The brightest fragment of a frame of light: sums of samples and of layers stay finite.
pub const MOST_UNCLAMPED: f32 = 1e30;

/// What a fragment writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Written {
    /// Colour and alpha.
    #[default]
    Color,
    /// The terms of weighted transparency, in two targets.
    WeightedTerms,
    /// Light before the tone map, within the range of binary16, and a coverage of 1.
    Light,
    /// Colour and alpha in a frame of light, which the target does not clamp.
    Unclamped,
    /// The terms of weighted transparency in a frame of light.
    UnclampedTerms,
}

impl Written {
    /// What is written of a colour.
    #[inline(always)]
    pub fn fragment<R: Real>(self, input: &FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
        match self {
            Self::Color => FragmentOut::color(color),
            Self::Light => {
                let Vec4 { x, y, z, .. } = color;
                let channel = |value: R| value.clamp(0.0, MOST_LIGHT);
                let one = input.real(1.0);
                FragmentOut::color(Vec4::new(channel(x), channel(y), channel(z), one))
            }
            Self::Unclamped => FragmentOut::color(unclamped(color)),
            Self::UnclampedTerms => {
                weighted_fragment(DEPTH_ORDER, unclamped(color), input.position.z)
            }
            Self::WeightedTerms => {
                // The sums are floats, and the picture would clamp the fragment.
                let Vec4 { x, y, z, w } = color;
                let color = Vec4::new(x.saturate(), y.saturate(), z.saturate(), w.saturate());
                weighted_fragment(DEPTH_ORDER, color, input.position.z)
            }
        }
    }
}

/// A colour without negative channels and NaN, and its alpha.
#[inline(always)]
fn unclamped<R: Real>(color: Vec4<R>) -> Vec4<R> {
    let channel = |value: R| value.clamp(0.0, MOST_UNCLAMPED);
    Vec4::new(
        channel(color.x),
        channel(color.y),
        channel(color.z),
        color.w.saturate(),
    )
}

estampe::shader! {
    impl<B: BaseColor, I: Interpolation> Shader for Surface<B, I> {
        // Position, then those of the parts.
        type Attributes<R: Real> = (Vec3<R>, I::Attributes<R>, B::Values<R>);
        type Varyings<R: Real> = (I::Varyings<R>, B::Values<R>);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, lit, painted): (Vec3<R>, I::Attributes<R>, B::Values<R>),
        ) -> VertexOut<R, (I::Varyings<R>, B::Values<R>)> {
            let varyings = (self.interpolation.vertex(position, lit), painted);
            VertexOut::new(self.interpolation.transforms().clip(position), varyings)
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (lit, painted): (I::Varyings<R>, B::Values<R>),
        ) -> FragmentOut<R> {
            let base = self.base_color.color(&input, painted);
            let bump = self.base_color.bump(painted);
            let color = self.interpolation.fragment(base.xyz(), bump, lit, &input);
            let color = self.output.color(&input, color);
            /// The cutoff of materials without one.
            const CUTOFF: f32 = 0.5;
            let one = input.real(1.0);
            let written = |alpha| self.written.fragment(&input, color.extend(alpha));
            match self.base_color.alpha() {
                Alpha::CutsOut => cut_out::hard(written(one), base.w, CUTOFF),
                Alpha::Covers(samples) => cut_out::smooth(written(one), base.w, CUTOFF, samples),
                Alpha::Ignored | Alpha::Kept => written(base.w),
            }
        }
    }
}
