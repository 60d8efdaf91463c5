//! Tests of every rule, by hand-computed cases and by properties, and the shader and functions that
//! they share.

mod bounds;
mod clipping;
mod colors;
mod conservative;
mod coverage;
mod diamond;
mod drawing;
mod formats;
mod illumination;
mod lines;
mod multisampling;
mod per_sample;
mod scan_conversion;
mod shared;
mod textures;
mod transfer;
mod vertices;

use crate::*;
use estampe_types::state::*;
use estampe_types::*;

/// Random numbers from a seed, so that failures are reproducible.
struct Random(fastrand::Rng);

impl Random {
    fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    fn next(&mut self) -> u32 {
        self.0.u32(..)
    }

    /// In 0..1.
    fn unit(&mut self) -> f32 {
        self.0.f32()
    }

    fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    fn below(&mut self, n: u32) -> u32 {
        self.0.u32(..n)
    }
}

/// A shader with a smooth, a no-perspective and a flat varying; its colour is (smooth,
/// no-perspective, flat, 1).
struct Plain;

estampe_types::shader! {
    impl Shader for Plain {
        type Attributes<R: Real> = (Vec4<R>, Vec3<R>);
        type Varyings<R: Real> = ([R; 1], NoPerspective<[R; 1]>, Flat<[R; 1]>);

        fn vertex<R: Real>(
            &self,
            _input: shader::VertexIn<'_, R>,
            (position, value): (Vec4<R>, Vec3<R>),
        ) -> shader::VertexOut<R, Self::Varyings<R>> {
            let varyings = ([value.x], NoPerspective([value.y]), Flat([value.z]));
            shader::VertexOut::new(position, varyings)
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            ([smooth], NoPerspective([affine]), Flat([flat])): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            FragmentOut::color(Vec4::new(smooth, affine, flat, input.real(1.0)))
        }
    }
}

/// The clip position of a vertex of [`Plain`], and its three values.
type Vertex = ([f32; 4], [f32; 3]);

fn plain_layout() -> VertexBufferLayout {
    let attribute = |format, offset, shader_location| VertexAttribute {
        format,
        offset,
        shader_location,
    };
    VertexBufferLayout {
        array_stride: 28,
        step_mode: VertexStepMode::Vertex,
        attributes: vec![
            attribute(VertexFormat::Float32x4, 0, 0),
            attribute(VertexFormat::Float32x3, 16, 1),
        ],
        ..VertexBufferLayout::default()
    }
}

fn draw_with<S: Shader>(
    target: &mut Target,
    shader: &S,
    state: &State,
    vertices: &[Vertex],
) -> Counts {
    let scalars: Vec<f32> = vertices
        .iter()
        .flat_map(|(position, values)| position.iter().chain(values).copied())
        .collect();
    let buffers = [(plain_layout(), BufferData::from_f32s(&scalars))];
    let bindings = Bindings::default();
    let command = Draw {
        buffers: &buffers,
        indices: None,
        vertices: 0..u32::try_from(vertices.len()).expect("few vertices"),
        instances: 0..1,
        base_vertex: 0,
        bindings: &bindings,
    };
    draw(target, shader, state, &command)
}

fn draw_plain(target: &mut Target, state: &State, vertices: &[Vertex]) -> Counts {
    draw_with(target, &Plain, state, vertices)
}

/// The clip position (w = 1) of a point in pixels, with a viewport over the whole target.
fn at(target: &Target, x: f32, y: f32, z: f32) -> [f32; 4] {
    let (width, height) = (target.width as f32, target.height as f32);
    [x / width * 2.0 - 1.0, 1.0 - y / height * 2.0, z, 1.0]
}

fn unorm(width: u32, height: u32, samples: u32) -> Target {
    Target::new(width, height, samples, TextureFormat::Rgba8Unorm)
}

fn clip_vertex(position: [f32; 4], varyings: &[f32]) -> ClipVertex {
    ClipVertex {
        position,
        varyings: varyings.to_vec(),
        point_size: 1.0,
        clip_distances: Vec::new(),
        cull_distances: Vec::new(),
    }
}
