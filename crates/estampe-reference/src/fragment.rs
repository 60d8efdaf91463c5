//! Fragments: interpolation over a primitive, and the fragment shader on a 2×2 quad.
//!
//! In · Out: a primitive's interpolants and a quad · four colours and depths. Precision: f32 in the
//! order of NUMERICS.md. The shader runs on a whole quad, so that its derivatives are differences
//! between lanes; helper invocations run as well. The point of the pixel at which each lane is
//! evaluated: NUMERICS.md, *Multisampling*.

use crate::arithmetic::{max, min};
use crate::program::{QuadInput, ShadedFragment, Shaders};
use crate::raster::{QuadCoverage, all_samples, sample_positions};
use crate::setup::{Plane, SortedTriangle};
use estampe_types::Bindings;
use estampe_types::shader::{DepthOutput, Interpolation, Sampling};

/// The interpolants of a primitive: depth, 1/w and varyings at any pixel of the window.
pub trait Surface {
    /// Depth at a sample position (in 1/16 pixel) of a pixel, before it is clamped to the
    /// viewport's range.
    fn depth(&self, pixel: [u32; 2], sample: [u8; 2]) -> f32;
    /// 1/w at the pixel's centre.
    fn inverse_w(&self, pixel: [u32; 2]) -> f32;
    /// The varyings' scalars at the pixel's centre.
    fn varyings(&self, pixel: [u32; 2]) -> Vec<f32>;
    /// 1/w at a position in the pixel, in 1/16 pixel. Lines and points have one value for the whole
    /// pixel.
    fn inverse_w_at(&self, pixel: [u32; 2], _place: [u8; 2]) -> f32 {
        self.inverse_w(pixel)
    }
    /// The varyings' scalars at a position in the pixel, in 1/16 pixel. Lines and points have one
    /// set for the whole pixel.
    fn varyings_at(&self, pixel: [u32; 2], _place: [u8; 2]) -> Vec<f32> {
        self.varyings(pixel)
    }
    /// The derivatives of the varyings' scalars along x and y, at a position in the pixel, in 1/16
    /// pixel. NUMERICS.md, *Derivatives of varyings*.
    fn derivatives_at(&self, pixel: [u32; 2], place: [u8; 2]) -> Vec<[f32; 2]>;
    /// A factor for the alpha of every colour, if the primitive has one: the coverage of smooth
    /// lines.
    fn alpha(&self, _pixel: [u32; 2]) -> Option<f32> {
        None
    }
}

/// A pixel's centre, in 1/16 pixel from its corner.
pub const CENTER: [u8; 2] = [8, 8];

/// A sample's position in the window, in pixels: f32(i) + X/16, exact.
#[must_use]
pub fn sample_window(pixel: [u32; 2], sample: [u8; 2]) -> [f32; 2] {
    [0, 1].map(|axis| pixel[axis] as f32 + f32::from(sample[axis]) / 16.0)
}

/// The interpolants of a triangle.
#[derive(Debug, Clone)]
pub struct TriangleSurface {
    /// The plane of depth, before it is clamped to the viewport's range.
    pub depth: Plane,
    inverse_w: Plane,
    varyings: Vec<Varying>,
}

/// The interpolation of one scalar.
#[derive(Debug, Clone, Copy)]
enum Varying {
    /// The plane of A·(1/w); its value is multiplied by w.
    OverW(Plane),
    /// The plane of A itself.
    Affine(Plane),
    /// The provoking vertex's value.
    Constant(f32),
}

impl TriangleSurface {
    /// Computes the planes of a triangle; `flat` holds the provoking vertex's varyings.
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
        self.inverse_w_at(pixel, CENTER)
    }

    fn varyings(&self, pixel: [u32; 2]) -> Vec<f32> {
        self.varyings_at(pixel, CENTER)
    }

    fn inverse_w_at(&self, pixel: [u32; 2], place: [u8; 2]) -> f32 {
        self.inverse_w.at(sample_window(pixel, place))
    }

    fn varyings_at(&self, pixel: [u32; 2], place: [u8; 2]) -> Vec<f32> {
        let at = sample_window(pixel, place);
        let w = 1.0 / self.inverse_w.at(at);
        let value = |varying: &Varying| match varying {
            Varying::OverW(plane) => plane.at(at) * w,
            Varying::Affine(plane) => plane.at(at),
            Varying::Constant(value) => *value,
        };
        self.varyings.iter().map(value).collect()
    }

    fn derivatives_at(&self, pixel: [u32; 2], place: [u8; 2]) -> Vec<[f32; 2]> {
        let at = sample_window(pixel, place);
        let w = 1.0 / self.inverse_w.at(at);
        let of_w = [self.inverse_w.per_x, self.inverse_w.per_y];
        let derivatives = |varying: &Varying| match varying {
            Varying::OverW(plane) => {
                let value = plane.at(at) * w;
                let slopes = [plane.per_x, plane.per_y];
                [0, 1].map(|axis: usize| (slopes[axis] - value * of_w[axis]) * w)
            }
            Varying::Affine(plane) => [plane.per_x + 0.0, plane.per_y + 0.0],
            Varying::Constant(_) => [0.0; 2],
        };
        self.varyings.iter().map(derivatives).collect()
    }
}

/// A fragment after the fragment shader; its depth is clamped to the viewport's range.
pub type Fragment = ShadedFragment;

/// A quad for one run of the fragment shader.
#[derive(Debug, Clone, Copy)]
pub struct Invocation {
    /// The upper left pixel.
    pub origin: [u32; 2],
    /// For each lane, the samples of its pixel that the primitive covers and that the sample mask
    /// keeps.
    pub coverage: [u16; 4],
    /// Samples per pixel.
    pub samples: u32,
    /// The sample that is shaded; `None` if shading is per pixel.
    pub sample: Option<u32>,
    /// True if the primitive is front facing.
    pub front_facing: bool,
}

impl Invocation {
    /// The samples of a lane that receive this invocation's output.
    #[must_use]
    pub fn samples_of(&self, lane: usize) -> u16 {
        match self.sample {
            Some(sample) => self.coverage[lane] & 1 << sample,
            None => self.coverage[lane],
        }
    }

    /// The position in a lane's pixel at which varyings of a sampling are evaluated, in 1/16 pixel.
    fn place(&self, lane: usize, sampling: Sampling) -> [u8; 2] {
        let positions = sample_positions(self.samples);
        if let Some(sample) = self.sample {
            return positions[sample as usize];
        }
        let coverage = self.coverage[lane];
        let is_whole = coverage == all_samples(self.samples);
        match sampling {
            Sampling::Centroid if coverage != 0 && !is_whole => {
                positions[coverage.trailing_zeros() as usize]
            }
            _ => CENTER,
        }
    }
}

/// Shades the four fragments of a quad. `clamp_depth` clamps a depth to the viewport's range.
pub fn shade_quad(
    shaders: &dyn Shaders,
    bindings: &Bindings,
    surface: &dyn Surface,
    invocation: &Invocation,
    clamp_depth: impl Fn(f32) -> f32,
) -> [Fragment; 4] {
    let input = quad_input(shaders, bindings, surface, invocation, &clamp_depth);
    let shaded = shaders.quad(&input);
    shaded.map(|fragment| Fragment {
        depth: fragment.depth.map(&clamp_depth),
        ..fragment
    })
}

/// The inputs of a quad's fragments: window positions, and each scalar of the varyings at the
/// position of its sampling.
pub fn quad_input<'a>(
    shaders: &dyn Shaders,
    bindings: &'a Bindings,
    surface: &dyn Surface,
    invocation: &Invocation,
    clamp_depth: impl Fn(f32) -> f32,
) -> QuadInput<'a> {
    let lanes = [0, 1, 2, 3];
    let interface = shaders.interface();
    let pixels = lanes.map(|lane| QuadCoverage::pixel(invocation.origin, lane));
    let positions = lanes.map(|lane| {
        let (pixel, place) = (pixels[lane], invocation.place(lane, Sampling::Center));
        let [x, y] = sample_window(pixel, place);
        let z = clamp_depth(surface.depth(pixel, place));
        [x, y, z, surface.inverse_w_at(pixel, place)]
    });
    // What no scalar asks for is not computed.
    let has_centroids = interface.sampling.contains(&Sampling::Centroid);
    let has_gradients = !interface.gradients.is_empty();
    let varyings = lanes.map(|lane| {
        let pixel = pixels[lane];
        let places = [Sampling::Center, Sampling::Centroid].map(|of| invocation.place(lane, of));
        // The place among these at which a scalar is evaluated.
        let place_of = |k: usize| match interface.sampling.get(k) {
            Some(Sampling::Centroid) => 1,
            // A `Sample` varying makes shading run per sample; all positions are then that
            // sample's.
            Some(Sampling::Center | Sampling::Sample) | None => 0,
        };
        let (mut values, mut derivatives) = ([const { Vec::new() }; 2], [const { Vec::new() }; 2]);
        for (at, &place) in places[..=usize::from(has_centroids)].iter().enumerate() {
            values[at] = surface.varyings_at(pixel, place);
            if has_gradients {
                derivatives[at] = surface.derivatives_at(pixel, place);
            }
        }
        let scalars = (0..interface.varyings.len()).map(|k| values[place_of(k)][k]);
        let derivative = |axis: usize| {
            let (of, scalars) = (&derivatives, interface.gradients.iter());
            scalars.map(move |&k| of[place_of(k)][k][axis])
        };
        scalars.chain(derivative(0)).chain(derivative(1)).collect()
    });
    QuadInput {
        positions,
        front_facing: invocation.front_facing,
        is_helper: lanes.map(|lane| invocation.samples_of(lane) == 0),
        sample_index: match invocation.sample {
            Some(sample) if interface.per_sample => sample,
            _ => 0,
        },
        coverage: lanes.map(|lane| invocation.samples_of(lane)),
        varyings,
        bindings,
    }
}

/// A fragment's depth at a sample: the interpolated depth, or the shader's, limited as its depth
/// output declares.
#[must_use]
pub fn sample_depth(output: DepthOutput, written: Option<f32>, interpolated: f32) -> f32 {
    match (output, written) {
        (DepthOutput::None, _) | (_, None) => interpolated,
        (DepthOutput::Any, Some(depth)) => depth,
        (DepthOutput::Greater, Some(depth)) => max(depth, interpolated),
        (DepthOutput::Less, Some(depth)) => min(depth, interpolated),
    }
}
