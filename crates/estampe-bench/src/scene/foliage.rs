//! `foliage`: 60,000 cards with grass and leaves over a ground, 4 samples, resolved. The cards of
//! the left half are drawn first and discard where alpha is below ½; the others turn alpha to
//! coverage, sharpened by its derivatives and rounded to quarters of 0.9.
//!
//! One array texture of 16 layers of 128² RGBA8 with mip levels, trilinear, clamped. Depth is
//! *less*, nothing is culled, alpha is not written. A vertex is its position, texture coordinate
//! and layer (6 floats) and a colour (4 bytes): 28 bytes. The uniform is the matrix from world to
//! clip space. Alphas of 0, 0.225, 0.45, 0.675 and 0.9 make 0 to 4 samples in all implementations.

use super::passes::{Binding, Frame, FrameDraw, FramePipeline};
use super::{ASPECT, CLEAR_COLOR, Detail, Scene, vertex_layout};
use crate::frame::FrameSize;
use crate::generate::{
    LittleEndian, Vector, leaf_textures, look_at, perspective, sin_cos_turns, unit_hash,
};
use estampe::state::ColorWrites;
use estampe::{TextureFormat, VertexFormat, ViewDimension};

pub(super) fn scene(detail: Detail, size: FrameSize) -> Scene {
    let text = include_str!("wgsl/foliage.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Rgba8Unorm, text);
    frame.textures = vec![(TextureFormat::Rgba8Unorm, ViewDimension::D2Array)];
    let cards = detail.of(60_000, 600);
    let mut quads = Quads::default();
    quads.append_ground();
    for number in 0..cards {
        quads.append_card(number);
    }
    let mut buffers = vec![quads.vertices.into_bytes()];
    let mut draws = Vec::new();
    let parts = ["ground_fragment", "discarded", "covered"].into_iter();
    for (number, (fragment, indices)) in (1..).zip(parts.zip(quads.indices)) {
        let pipeline = frame.pipeline(FramePipeline {
            fragment,
            vertex_buffers: vec![vertex_layout(
                28,
                &[
                    (VertexFormat::Float32x3, 0),
                    (VertexFormat::Float32x3, 12),
                    (VertexFormat::Unorm8x4, 24),
                ],
            )],
            write_mask: ColorWrites::COLOR,
            alpha_to_coverage: fragment == "covered",
            bindings: vec![
                Binding::Uniform(4),
                Binding::trilinear_clamp(),
                Binding::Texture(0),
            ],
            ..FramePipeline::default()
        });
        let bytes = indices.into_bytes();
        let count = u32::try_from(bytes.len() / 4).expect("six a card");
        draws.push(FrameDraw::indexed(pipeline, 0, number, count));
        buffers.push(bytes);
    }
    let view_from_world = look_at([0.0, 0.55, 4.0], [0.0, 0.1, -0.6], [0.0, 1.0, 0.0]);
    let clip_from_view = perspective(0.125, ASPECT, 0.1, 40.0);
    let mut uniforms = LittleEndian::default();
    uniforms.matrix(&clip_from_view.times(&view_from_world));
    buffers.push(uniforms.into_bytes());
    let clear = CLEAR_COLOR.map(f64::from);
    frame.picture_pass(4, TextureFormat::Depth32Float, clear, draws);
    Scene::of_frame("foliage", buffers, vec![leaf_textures()], frame)
}

/// The vertices of all quads, and the indices of the ground and of each half.
#[derive(Default)]
struct Quads {
    vertices: LittleEndian,
    indices: [LittleEndian; 3],
    count: u32,
}

impl Quads {
    /// The corners are lower left, lower right, upper right, upper left.
    fn append(&mut self, part: usize, corners: [Vector; 4], layer: f64, color: [f64; 4]) {
        let uvs = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
        for (corner, [u, v]) in corners.iter().zip(uvs) {
            self.vertices.reals(corner);
            self.vertices.reals(&[u, v, layer]);
            self.vertices.color(color);
        }
        let first = self.count * 4;
        self.indices[part].words(&[0, 1, 2, 0, 2, 3].map(|corner| first + corner));
        self.count += 1;
    }

    /// Its layer is not sampled.
    fn append_ground(&mut self) {
        let corners = [[-30.0, 4.0], [30.0, 4.0], [30.0, -28.0], [-30.0, -28.0]];
        let corners = corners.map(|[x, z]| [x, 0.0, z]);
        self.append(0, corners, -1.0, [70.0, 60.0, 40.0, 255.0]);
    }

    fn append_card(&mut self, number: u32) {
        let random = |k: u32| unit_hash(13_000 + 8 * number + k);
        let distance = 1.2 + 10.0 * (random(1) + random(1).sqrt());
        let (part, side) = match number % 2 {
            0 => (1, -1.0),
            _ => (2, 1.0),
        };
        let (x, z) = (1.5 * side * random(0) * distance, 4.0 - distance);
        let (sine, cosine) = sin_cos_turns(random(4) * 0.5);
        let (half_width, height) = (0.02 + 0.024 * random(2), 0.06 + 0.06 * random(3));
        let (dx, dz) = (half_width * cosine, half_width * sine);
        let corners = [
            [x - dx, 0.0, z - dz],
            [x + dx, 0.0, z + dz],
            [x + dx, height, z + dz],
            [x - dx, height, z - dz],
        ];
        let color = [
            190.0 + 60.0 * random(6),
            255.0,
            160.0 + 90.0 * random(7),
            255.0,
        ];
        self.append(part, corners, (16.0 * random(5)).floor(), color);
    }
}
