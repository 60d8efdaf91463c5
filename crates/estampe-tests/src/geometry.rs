//! Random vertices and triangles, from ordinary to hostile.

use crate::Random;
use estampe_types::state::{VertexAttribute, VertexBufferLayout, VertexStepMode};
use estampe_types::{BufferData, VertexFormat};

/// A vertex of the standard layout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Location 0, in clip space.
    pub position: [f32; 4],
    /// Location 1: the shaders' inputs, such as a colour.
    pub values: [f32; 4],
}

/// The standard layout: position and values, four floats each.
#[must_use]
pub fn vertex_layout() -> VertexBufferLayout {
    let attribute = |shader_location, offset| VertexAttribute {
        format: VertexFormat::Float32x4,
        offset,
        shader_location,
    };
    VertexBufferLayout {
        array_stride: 32,
        step_mode: VertexStepMode::Vertex,
        attributes: vec![attribute(0, 0), attribute(1, 16)],
        ..VertexBufferLayout::default()
    }
}

/// A vertex buffer of the standard layout.
#[must_use]
pub fn vertex_buffer(vertices: &[Vertex]) -> BufferData {
    let scalars = |vertex: &Vertex| [vertex.position, vertex.values].concat();
    BufferData::from_f32s(&vertices.iter().flat_map(scalars).collect::<Vec<_>>())
}

/// The clip-space position of a point in pixels with this depth and w, for a viewport over the
/// whole target.
#[must_use]
pub fn clip_at([width, height]: [u32; 2], [x, y]: [f32; 2], z: f32, w: f32) -> [f32; 4] {
    let (width, height) = (width as f32, height as f32);
    [
        (x / width * 2.0 - 1.0) * w,
        (1.0 - y / height * 2.0) * w,
        z * w,
        w,
    ]
}

/// Two triangles that cover a target, at depth ½; `values` gives those of the corner at a position
/// in 0..=1.
#[must_use]
pub fn whole_target(size: [u32; 2], values: impl Fn([f32; 2]) -> [f32; 4]) -> Vec<Vertex> {
    let [width, height] = size.map(|side| side as f32);
    let corner = |[x, y]: [f32; 2]| Vertex {
        position: clip_at(size, [x * width, y * height], 0.5, 1.0),
        values: values([x, y]),
    };
    let upper = [[0.0, 0.0], [1.0, 0.0]].map(corner);
    let lower = [[0.0, 1.0], [1.0, 1.0]].map(corner);
    vec![upper[0], lower[0], lower[1], upper[0], lower[1], upper[1]]
}

/// The size, shape or position of random triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Smaller than two pixels.
    Tiny,
    /// A few pixels.
    Small,
    /// As large as the target.
    Large,
    /// Reaching to the ends of the guard band.
    Huge,
    /// Up to the end of f32's range.
    Gigantic,
    /// Thinner than a pixel.
    Sliver,
    /// Without area, or nearly so.
    Degenerate,
    /// Vertices on multiples of a half or sixteenth of a pixel: every tie of the fill rule.
    OnGrid,
    /// Through the near and the far plane.
    AcrossDepths,
    /// In front of and behind the eye.
    AroundEye,
    /// With NaN, infinite, denormal and huge coordinates.
    Hostile,
}

impl Style {
    /// Every style.
    pub const ALL: [Self; 11] = [
        Self::Tiny,
        Self::Small,
        Self::Large,
        Self::Huge,
        Self::Gigantic,
        Self::Sliver,
        Self::Degenerate,
        Self::OnGrid,
        Self::AcrossDepths,
        Self::AroundEye,
        Self::Hostile,
    ];
}

/// Random values of a vertex, sometimes outside 0..1.
pub fn values(random: &mut Random) -> [f32; 4] {
    if random.once_in(4) {
        random.four(-1.0, 2.0)
    } else {
        random.four(0.0, 1.0)
    }
}

/// The w of three vertices: all 1, all equal, or three different ones.
pub fn three_ws(random: &mut Random) -> [f32; 3] {
    match random.below(4) {
        0 => [1.0; 3],
        1 => [random.range(0.1, 9.0); 3],
        2 => [0; 3].map(|_| random.range(0.5, 2.0)),
        _ => [0; 3].map(|_| random.pick(&[0.01, 0.1, 1.0, 10.0, 300.0]) * random.range(0.5, 2.0)),
    }
}

/// Three vertices of a style, for a target of this size.
pub fn triangle(random: &mut Random, style: Style, size: [u32; 2]) -> [Vertex; 3] {
    let mut positions = match style {
        Style::Hostile => hostile(random, size),
        Style::AroundEye => [0; 3].map(|_| {
            let w = random.range(-1.5, 2.5);
            [
                random.range(-2.0, 2.0),
                random.range(-2.0, 2.0),
                (w - 0.2) * random.range(0.3, 0.9),
                w,
            ]
        }),
        _ => {
            let (places, ws) = (places(random, style, size), three_ws(random));
            let depths = if style == Style::AcrossDepths {
                [-0.7, 1.7]
            } else {
                [0.0, 1.0]
            };
            let depth = random.range(0.0, 1.0);
            let is_parallel = random.once_in(4);
            [0, 1, 2].map(|corner: usize| {
                let z = if is_parallel {
                    depth
                } else {
                    random.range(depths[0], depths[1])
                };
                clip_at(size, places[corner], z, ws[corner])
            })
        }
    };
    // As neighbours in a mesh share vertices, two of one triangle may be equal here.
    if style == Style::Degenerate && random.once_in(2) {
        positions[random.below(3) as usize] = positions[random.below(3) as usize];
    }
    positions.map(|position| Vertex {
        position,
        values: values(random),
    })
}

/// Three points in pixels.
fn places(random: &mut Random, style: Style, [width, height]: [u32; 2]) -> [[f32; 2]; 3] {
    let (width, height) = (width as f32, height as f32);
    let center = [
        random.range(-2.0, width + 2.0),
        random.range(-2.0, height + 2.0),
    ];
    let mut around = |reach: f32| {
        let offset = [random.range(-reach, reach), random.range(-reach, reach)];
        [center[0] + offset[0], center[1] + offset[1]]
    };
    match style {
        Style::Tiny => [0; 3].map(|_| around(1.2)),
        Style::Small => [0; 3].map(|_| around(9.0)),
        Style::Huge => [0; 3].map(|_| around(random_reach(center))),
        Style::Gigantic => {
            let reaches = [10.0, 1e5, 1e8, 1e15, 1e30];
            [0; 3].map(|_| {
                let reach = random.pick(&reaches);
                [random.range(-reach, reach), random.range(-reach, reach)]
            })
        }
        Style::Sliver => {
            let first = around(width);
            let far = around(3.0 * width);
            let t = random.range(-0.5, 1.5);
            let between = |axis: usize| first[axis] + (far[axis] - first[axis]) * t;
            let shift = [random.range(-0.6, 0.6), random.range(-0.6, 0.6)];
            [first, [between(0) + shift[0], between(1) + shift[1]], far]
        }
        Style::Degenerate => {
            let start = around(9.0).map(f32::floor);
            let step = [random.below(9) as f32 - 4.0, random.below(9) as f32 - 4.0];
            let along = |t: f32| [start[0] + step[0] * t, start[1] + step[1] * t];
            let off = random.pick(&[0.0, 0.0, 1.0 / 256.0]);
            let [x, y] = along(2.0);
            [start, along(1.0), [x + off, y]]
        }
        Style::OnGrid => {
            let grid = random.pick(&[1.0, 2.0, 4.0, 16.0]);
            [0; 3].map(|_| {
                let [x, y] = [random.range(0.0, width), random.range(0.0, height)];
                [(x * grid).round() / grid, (y * grid).round() / grid]
            })
        }
        _ => {
            let reach = width.max(height);
            [0; 3].map(|_| around(reach))
        }
    }
}

/// A distance that ends somewhere around the guard band.
fn random_reach(center: [f32; 2]) -> f32 {
    if center[0] < center[1] {
        9000.0
    } else {
        40_000.0
    }
}

fn hostile(random: &mut Random, size: [u32; 2]) -> [[f32; 4]; 3] {
    let tame = triangle(random, Style::Large, size);
    let mut positions = tame.map(|vertex| vertex.position);
    for _ in 0..=random.below(3) {
        let (corner, axis) = (random.below(3) as usize, random.below(4) as usize);
        positions[corner][axis] = random.odd_number();
    }
    positions
}

/// A list of `count` triangles of a style.
pub fn triangles(random: &mut Random, style: Style, size: [u32; 2], count: u32) -> Vec<Vertex> {
    (0..count)
        .flat_map(|_| triangle(random, style, size))
        .collect()
}
