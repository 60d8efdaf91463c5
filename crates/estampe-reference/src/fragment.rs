//! Fragments: interpolation over a primitive, and the shader's fragment function on a 2×2 quad.
//!
//! In · Out: a primitive's surface and a quad · four colours and depths. Precision: f32 in the order
//! of NUMERICS.md. The shader runs with `R = Quad`, so that it has true derivatives; lanes that the
//! primitive does not cover are evaluated all the same.

use crate::raster::QuadCoverage;
use crate::setup::{Plane, SortedTriangle};
use estampe_types::shader::{DepthOutput, FragmentIn, Interpolation, Shader, Source, Varyings};
use estampe_types::{Bindings, Quad, Real, Vec4};

/// What varies over a primitive, at any place of the window.
pub trait Surface {
    /// Depth at a sample of a pixel (in 1/16 pixel), before it is confined to the viewport's range.
    fn depth(&self, pixel: [u32; 2], sample: [u8; 2]) -> f32;
    /// 1/w at the pixel's centre.
    fn inverse_w(&self, pixel: [u32; 2]) -> f32;
    /// The varyings' scalars at the pixel's centre.
    fn varyings(&self, pixel: [u32; 2]) -> Vec<f32>;
}

/// A pixel's centre, in 1/16 pixel from its corner.
pub const CENTER: [u8; 2] = [8, 8];

/// A sample's place in the window, in pixels: f32(i) + X/16, exact.
#[must_use]
pub fn sample_window(pixel: [u32; 2], sample: [u8; 2]) -> [f32; 2] {
    [0, 1].map(|axis| pixel[axis] as f32 + f32::from(sample[axis]) / 16.0)
}

/// The surface of a triangle.
#[derive(Debug, Clone)]
pub struct TriangleSurface {
    depth: Plane,
    inverse_w: Plane,
    varyings: Vec<Varying>,
}

/// How one scalar is found at a pixel.
#[derive(Debug, Clone, Copy)]
enum Varying {
    /// The plane of A·(1/w), to be multiplied by w.
    OverW(Plane),
    /// The plane of A itself.
    Affine(Plane),
    /// The provoking vertex's value.
    Constant(f32),
}

impl TriangleSurface {
    /// Sets up the planes of a triangle; `flat` are the provoking vertex's varyings.
    #[must_use]
    pub fn new(triangle: &SortedTriangle, modes: &[Interpolation], flat: &[f32]) -> Self {
        let [a, b, c] = &triangle.vertices;
        let inverse_ws = [a.inverse_w, b.inverse_w, c.inverse_w];
        let w_is_constant = inverse_ws
            .iter()
            .all(|w| w.to_bits() == a.inverse_w.to_bits());

        let varying = |(k, mode): (usize, &Interpolation)| {
            let values = [a.varyings[k], b.varyings[k], c.varyings[k]];
            match mode {
                Interpolation::Flat => Varying::Constant(flat[k]),
                Interpolation::Smooth if !w_is_constant => {
                    let over_w = [0, 1, 2].map(|v: usize| values[v] * inverse_ws[v]);
                    Varying::OverW(triangle.plane(over_w))
                }
                Interpolation::Smooth | Interpolation::NoPerspective => {
                    Varying::Affine(triangle.plane(values))
                }
            }
        };
        Self {
            depth: triangle.plane([a.z, b.z, c.z]),
            inverse_w: triangle.plane(inverse_ws),
            varyings: modes.iter().enumerate().map(varying).collect(),
        }
    }
}

impl Surface for TriangleSurface {
    fn depth(&self, pixel: [u32; 2], sample: [u8; 2]) -> f32 {
        self.depth.at(sample_window(pixel, sample))
    }

    fn inverse_w(&self, pixel: [u32; 2]) -> f32 {
        self.inverse_w.at(sample_window(pixel, CENTER))
    }

    fn varyings(&self, pixel: [u32; 2]) -> Vec<f32> {
        let center = sample_window(pixel, CENTER);
        let w = 1.0 / self.inverse_w.at(center);
        let value = |varying: &Varying| match varying {
            Varying::OverW(plane) => plane.at(center) * w,
            Varying::Affine(plane) => plane.at(center),
            Varying::Constant(value) => *value,
        };
        self.varyings.iter().map(value).collect()
    }
}

/// A pixel's fragment after its shader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fragment {
    /// The colour of target 0, if the shader has targets.
    pub color: Option<[f32; 4]>,
    /// The depth in place of the interpolated one, if the shader writes depth.
    pub depth: Option<f32>,
    /// Whether it was discarded.
    pub is_discarded: bool,
}

/// Shades the four fragments of a quad. `clamp_depth` confines a depth to the viewport's range.
pub fn shade_quad<S: Shader>(
    shader: &S,
    bindings: &Bindings,
    surface: &impl Surface,
    origin: [u32; 2],
    front_facing: bool,
    clamp_depth: impl Fn(f32) -> f32,
) -> [Fragment; 4] {
    let pixels = [0, 1, 2, 3].map(|lane| QuadCoverage::pixel(origin, lane));

    // The window position, for shaders that say that they read it.
    let position = pixels.map(|pixel| {
        let [x, y] = sample_window(pixel, CENTER);
        let z = clamp_depth(surface.depth(pixel, CENTER));
        [x, y, z, surface.inverse_w(pixel)]
    });
    let read = |component: usize| {
        let lane = |p: [f32; 4]| if S::READS_POSITION { p[component] } else { 0.0 };
        Quad(position.map(lane))
    };
    let input = FragmentIn {
        position: Vec4::new(read(0), read(1), read(2), read(3)),
        front_facing: Quad([front_facing; 4]),
        sample_index: Quad([0; 4]),
        coverage: Quad([0; 4]),
        bindings,
        zero: Quad([0.0; 4]),
    };

    // Interpolate.
    let mut varyings = QuadScalars {
        lanes: pixels.map(|pixel| surface.varyings(pixel).into_iter()),
    };
    let output = shader.fragment(input, S::Varyings::load(&mut varyings));

    // Take the answer apart by lanes.
    [0, 1, 2, 3].map(|lane: usize| Fragment {
        color: (S::COLOR_TARGETS > 0).then(|| match output.color_of(0) {
            Some(c) => [c.x, c.y, c.z, c.w].map(|channel| channel.lane(lane)),
            None => [0.0; 4],
        }),
        depth: match S::DEPTH_OUTPUT {
            DepthOutput::None => None,
            // `Greater` and `Less` are confined by whoever stores the depth.
            _ => {
                let depth = output.depth().unwrap_or(input.position.z);
                Some(clamp_depth(depth.lane(lane)))
            }
        },
        is_discarded: S::DISCARDS && output.kept().is_some_and(|kept| !kept.0[lane]),
    })
}

/// Scalars of four lanes, handed to a shader together.
struct QuadScalars {
    lanes: [std::vec::IntoIter<f32>; 4],
}

impl Source<Quad> for QuadScalars {
    fn take(&mut self) -> Quad {
        Quad(
            self.lanes
                .each_mut()
                .map(|lane| lane.next().unwrap_or_default()),
        )
    }
}
