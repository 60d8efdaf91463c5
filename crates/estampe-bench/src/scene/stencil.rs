//! `stencil`: shadow volumes by depth fail (Heidmann 1991, Carmack 2000). In one pass: a bumpy
//! ground and 40 tori, lit per pixel; the closed shadow volumes of the tori, which count in the
//! stencil without colour; a full-screen triangle that darkens where the count is not 0.
//!
//! Depth is Depth24PlusStencil8. The scene is *less*, culled. Volumes are *less* without write, not
//! culled: where the depth test fails, front faces decrement and back faces increment, with wrap.
//! The last draw multiplies. Vertices of the scene have position, normal (3 floats each) and colour
//! (4 bytes), those of volumes a position. The uniforms are the matrix from world to clip space,
//! the eye and the light.

use super::passes::{Binding, Frame, FrameDraw, FramePipeline};
use super::{ASPECT, CLEAR_COLOR, Detail, Scene, vertex_layout};
use crate::frame::FrameSize;
use crate::generate::{
    LittleEndian, Matrix, Vector, cross, dot, look_at, normalize, perspective, sin_cos_turns,
    unit_hash,
};
use estampe::state::{
    BlendComponent, BlendFactor, BlendState, ColorWrites, CompareFunction, CullMode,
    DepthStencilState, PrimitiveState, StencilFaceState, StencilOperation, StencilState,
};
use estampe::{TextureFormat, VertexFormat};
use std::collections::BTreeSet;

/// The light's position.
const LIGHT: Vector = [3.0, 10.0, 2.0];
const EYE: Vector = [0.0, 7.0, 10.0];
/// The ground's cells along each side.
const GROUND_CELLS: u32 = 96;
/// A torus's cells around its ring and around its tube.
const TORUS_CELLS: [usize; 2] = [24, 12];

pub(super) fn scene(detail: Detail, size: FrameSize) -> Scene {
    let mut solids = Solids::default();
    append_ground(&mut solids);
    let mut volumes = Volumes::default();
    for number in 0..detail.of(40, 10) {
        let torus = Torus::new(number);
        solids.append_torus(&torus, number);
        volumes.append(&torus);
    }
    let view_from_world = look_at(EYE, [0.0, 0.8, 0.0], [0.0, 1.0, 0.0]);
    let clip_from_view = perspective(0.125, ASPECT, 0.5, 60.0);
    let mut uniforms = LittleEndian::default();
    uniforms.matrix(&clip_from_view.times(&view_from_world));
    for place in [EYE, LIGHT] {
        uniforms.reals(&place);
        uniforms.reals(&[1.0]);
    }
    let text = include_str!("wgsl/stencil.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Rgba8Unorm, text);
    let [solid, volume, shade] = pipelines().map(|pipeline| frame.pipeline(pipeline));
    let draws = vec![
        FrameDraw::indexed(solid, 0, 1, solids.index_count),
        FrameDraw {
            vertices: vec![2],
            ..FrameDraw::without_buffers(volume, volumes.vertex_count)
        },
        FrameDraw::without_buffers(shade, 3),
    ];
    let clear = CLEAR_COLOR.map(f64::from);
    frame.picture_pass(1, TextureFormat::Depth24PlusStencil8, clear, draws);
    let buffers = vec![
        solids.vertices.into_bytes(),
        solids.indices.into_bytes(),
        volumes.vertices.into_bytes(),
        uniforms.into_bytes(),
    ];
    Scene::of_frame("stencil", buffers, Vec::new(), frame)
}

/// Those of solids, of volumes and of the last draw.
fn pipelines() -> [FramePipeline; 3] {
    let solids = FramePipeline {
        vertex_buffers: vec![vertex_layout(
            28,
            &[
                (VertexFormat::Float32x3, 0),
                (VertexFormat::Float32x3, 12),
                (VertexFormat::Unorm8x4, 24),
            ],
        )],
        primitive: PrimitiveState {
            cull_mode: CullMode::Back,
            ..PrimitiveState::default()
        },
        bindings: vec![Binding::Uniform(3)],
        ..FramePipeline::default()
    };
    let counting = |depth_fail_op| StencilFaceState {
        depth_fail_op,
        ..StencilFaceState::default()
    };
    let volumes = FramePipeline {
        vertex: "volume_vertex",
        fragment: "volume_fragment",
        vertex_buffers: vec![vertex_layout(12, &[(VertexFormat::Float32x3, 0)])],
        depth_stencil: DepthStencilState {
            stencil: Some(StencilState {
                front: counting(StencilOperation::DecrementWrap),
                back: counting(StencilOperation::IncrementWrap),
            }),
            ..DepthStencilState::LESS_READ
        },
        write_mask: ColorWrites::NONE,
        bindings: vec![Binding::Uniform(3)],
        ..FramePipeline::default()
    };
    let multiplied = BlendComponent {
        src_factor: BlendFactor::Dst,
        dst_factor: BlendFactor::Zero,
        ..BlendComponent::default()
    };
    let shade = FramePipeline {
        vertex: "screen_vertex",
        fragment: "shade",
        // Where the count is not the draw's reference, 0.
        depth_stencil: DepthStencilState::from(StencilState::from(StencilFaceState {
            compare: CompareFunction::NotEqual,
            ..StencilFaceState::default()
        })),
        blend: Some(BlendState {
            color: multiplied,
            alpha: multiplied,
        }),
        ..FramePipeline::default()
    };
    [solids, volumes, shade]
}

/// Ground and tori.
#[derive(Default)]
struct Solids {
    vertices: LittleEndian,
    vertex_count: u32,
    indices: LittleEndian,
    index_count: u32,
}

impl Solids {
    fn vertex(&mut self, position: Vector, normal: Vector, color: [f64; 4]) {
        self.vertices.reals(&position);
        self.vertices.reals(&normal);
        self.vertices.color(color);
        self.vertex_count += 1;
    }

    fn triangle(&mut self, corners: [u32; 3]) {
        self.indices.words(&corners);
        self.index_count += 3;
    }

    fn append_torus(&mut self, torus: &Torus, number: u32) {
        let first = self.vertex_count;
        let tint = |k: u32| 80.0 + 175.0 * unit_hash(9000 + 8 * number + k);
        for (&position, &normal) in torus.positions.iter().zip(&torus.normals) {
            self.vertex(position, normal, [tint(6), tint(7), 120.0, 255.0]);
        }
        for triangle in &torus.triangles {
            let index = |corner: usize| u32::try_from(corner).expect("288 vertices");
            self.triangle(triangle.map(|corner| first + index(corner)));
        }
    }
}

/// Waves over −8..8 in x and z, with a checker of 6 × 6 cells.
fn append_ground(solids: &mut Solids) {
    const TURN: f64 = std::f64::consts::TAU;
    let place = |step: u32| f64::from(step) / 6.0 - 8.0;
    for row in 0..=GROUND_CELLS {
        for column in 0..=GROUND_CELLS {
            let (x, z) = (place(column), place(row));
            let (sin_x, cos_x) = sin_cos_turns(x / 5.0);
            let (sin_z, cos_z) = sin_cos_turns(z / 4.0);
            let slope_x = -0.3 * TURN / 5.0 * cos_x * cos_z;
            let slope_z = 0.3 * TURN / 4.0 * sin_x * sin_z;
            let is_light = (column / 6 + row / 6).is_multiple_of(2);
            let gray = if is_light { 210.0 } else { 170.0 };
            solids.vertex(
                [x, 0.3 * sin_x * cos_z, z],
                normalize([slope_x, 1.0, slope_z]),
                [gray, gray, gray - 20.0, 255.0],
            );
        }
    }
    let width = GROUND_CELLS + 1;
    for row in 0..GROUND_CELLS {
        for column in 0..GROUND_CELLS {
            let here = row * width + column;
            solids.triangle([here, here + width, here + width + 1]);
            solids.triangle([here, here + width + 1, here + 1]);
        }
    }
}

/// A closed torus in world space: its ring's radius is 1, its tube's 0.35, before scaling.
struct Torus {
    positions: Vec<Vector>,
    normals: Vec<Vector>,
    triangles: Vec<[usize; 3]>,
}

impl Torus {
    fn new(number: u32) -> Self {
        let random = |k: u32| unit_hash(9000 + 8 * number + k);
        let (x, z) = (9.0 * random(0) - 4.5, 9.0 * random(2) - 4.5);
        let place = Matrix::translation([x, 1.2 + 2.8 * random(1), z]);
        let turn = Matrix::rotation_y(random(3)).times(&Matrix::rotation_x(random(4)));
        let scaled = turn.times(&Matrix::scaling(0.45 + 0.3 * random(5)));
        let world_from_object = place.times(&scaled);
        let [ring_cells, tube_cells] = TORUS_CELLS;
        let mut torus = Self {
            positions: Vec::new(),
            normals: Vec::new(),
            triangles: Vec::new(),
        };
        for ring in 0..ring_cells {
            let (sin_ring, cos_ring) = sin_cos_turns(ring as f64 / ring_cells as f64);
            for tube in 0..tube_cells {
                let (sin_tube, cos_tube) = sin_cos_turns(tube as f64 / tube_cells as f64);
                let distance = 1.0 + 0.35 * cos_tube;
                let position = [cos_ring * distance, 0.35 * sin_tube, sin_ring * distance];
                let normal = [cos_ring * cos_tube, sin_tube, sin_ring * cos_tube];
                torus.positions.push(world_from_object.point(position));
                torus.normals.push(turn.point(normal));
                let (next_tube, next_ring) = ((tube + 1) % tube_cells, (ring + 1) % ring_cells);
                let vertex = |ring: usize, tube: usize| ring * tube_cells + tube;
                let (here, opposite) = (vertex(ring, tube), vertex(next_ring, next_tube));
                torus
                    .triangles
                    .push([here, vertex(ring, next_tube), opposite]);
                torus
                    .triangles
                    .push([here, opposite, vertex(next_ring, tube)]);
            }
        }
        torus
    }

    /// True if the light is in front of a triangle's plane.
    fn is_lit(&self, triangle: [usize; 3]) -> bool {
        let [a, b, c] = triangle.map(|corner| self.positions[corner]);
        dot(
            cross(difference(b, a), difference(c, a)),
            difference(LIGHT, a),
        ) > 0.0
    }
}

fn difference(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

/// Shadow volumes as a triangle list without indices.
#[derive(Default)]
struct Volumes {
    vertices: LittleEndian,
    vertex_count: u32,
}

impl Volumes {
    fn vertex(&mut self, position: Vector) {
        self.vertices.reals(&position);
        self.vertex_count += 1;
    }

    /// The lit triangles a little behind themselves, so that no cap lies on its surface; the others
    /// far away; quads between both along the silhouette, in the order of its sorted edges.
    fn append(&mut self, torus: &Torus) {
        let away = |vertex: usize, factor: f64| {
            let from_light = difference(torus.positions[vertex], LIGHT);
            [0, 1, 2].map(|axis| LIGHT[axis] + from_light[axis] * factor)
        };
        let near = |vertex: usize| away(vertex, 1.004);
        let far = |vertex: usize| away(vertex, 2.4);
        let mut lit_edges = BTreeSet::new();
        for &triangle in &torus.triangles {
            let is_lit = torus.is_lit(triangle);
            for corner in triangle {
                self.vertex(if is_lit { near(corner) } else { far(corner) });
            }
            if is_lit {
                let [a, b, c] = triangle;
                lit_edges.extend([(a, b), (b, c), (c, a)]);
            }
        }
        for &(a, b) in &lit_edges {
            if !lit_edges.contains(&(b, a)) {
                let [near_a, near_b, far_a, far_b] = [near(a), near(b), far(a), far(b)];
                for corner in [near_b, near_a, far_a, near_b, far_a, far_b] {
                    self.vertex(corner);
                }
            }
        }
    }
}
