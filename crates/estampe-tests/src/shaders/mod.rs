//! The shaders of the tests: each writes a value that both sides must compute equally.

mod attachments;
mod bound;
mod colored;
mod depths;
mod distances;
mod gradients;
mod probe;
mod samples;
mod textured;
mod vertex_input;

pub use attachments::{
    Crowded, CutLayers, CutLayers1, CutLayers2, CutLayers4, GreaterDepth, HeldDepth, Layers,
    Layers1, Layers2, Layers3, Layers4, Layers8, LessDepth, LogarithmicDepth, TwoColors,
};
pub use bound::{BoundDepth, BoundTexture, StoresPlaces, value_at};
pub use colored::{Colored, FlatColored, Halved, Sized, Uniform};
pub use depths::{Cutout, CutoutDepth, DepthGiven, DepthOnly, GivenDepth};
pub use distances::{Distant, ManyDistances};
pub use gradients::{CentroidGradients, Gradients, Slope};
pub use probe::{Probe, Scalar};
pub use samples::{AtCentroid, AtSample, BySample, Masking, Shown};
pub use textured::{TexelSource, Textured, TexturedShader};
pub use vertex_input::{Formats, Indexed};

use estampe_reference::{Counts, Draw, State, Target};
use estampe_types::{Int, Program, Real, ShaderProgram, Vec4};
use std::sync::Arc;

/// The 32 bits of a number as the four bytes of a colour, so that a unorm target shows the last
/// bit. A NaN, whose payload depends on the processor, becomes 0.
#[inline(always)]
pub fn bytes_of<R: Real>(value: R) -> Vec4<R> {
    bytes_of_int::<R>(R::select(value.eq(value), value, value.splat(0.0)).to_bits())
}

/// The 32 bits of an integer as the four bytes of a colour.
#[inline(always)]
pub fn bytes_of_int<R: Real>(bits: R::Int) -> Vec4<R> {
    let byte = |shift: u32| ((bits >> shift) & bits.splat(0xFF)).to_real() * (1.0 / 255.0);
    Vec4::new(byte(0), byte(8), byte(16), byte(24))
}

macro_rules! test_shaders {
    ($($name:ident),+) => {
        /// Any of the test shaders.
        #[derive(Debug, Clone)]
        pub enum TestShader {
            $(#[doc = concat!("[`", stringify!($name), "`].")] $name($name),)+
            /// [`Textured`].
            Textured(TexturedShader),
        }

        $(impl From<$name> for TestShader {
            fn from(shader: $name) -> Self {
                Self::$name(shader)
            }
        })+

        impl TestShader {
            /// The shader as a program of the fast path.
            #[must_use]
            pub fn program(&self) -> Arc<dyn Program> {
                match self {
                    $(Self::$name(shader) => Arc::new(ShaderProgram::new(*shader)),)+
                    Self::Textured(shader) => shader.program(),
                }
            }

            /// Draws with the oracle.
            pub fn draw_oracle(&self, target: &mut Target, state: &State, draw: &Draw<'_>) -> Counts {
                match self {
                    $(Self::$name(shader) => estampe_reference::draw(target, shader, state, draw),)+
                    Self::Textured(shader) => shader.draw_oracle(target, state, draw),
                }
            }
        }
    };
}
test_shaders!(
    Colored,
    FlatColored,
    Halved,
    Uniform,
    Sized,
    Probe,
    Gradients,
    CentroidGradients,
    Cutout,
    DepthGiven,
    CutoutDepth,
    DepthOnly,
    Layers1,
    Layers2,
    Layers3,
    Layers4,
    Layers8,
    CutLayers1,
    CutLayers2,
    CutLayers4,
    TwoColors,
    GreaterDepth,
    LessDepth,
    LogarithmicDepth,
    Crowded,
    AtCentroid,
    AtSample,
    BySample,
    Masking,
    Indexed,
    Formats,
    Distant,
    ManyDistances
);

impl From<TexturedShader> for TestShader {
    fn from(shader: TexturedShader) -> Self {
        Self::Textured(shader)
    }
}
