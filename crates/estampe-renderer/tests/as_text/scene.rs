//! What is drawn: the teapot, a square with a repeated texture, and a cloud of triangles, some of
//! which are large, behind the eye, without a normal, or without an area in the texture.

use estampe::state::{VertexAttribute, VertexBufferLayout};
use estampe::{Mat4, VertexFormat};
use estampe_renderer::shading::VertexStream;
use estampe_renderer::shading::VertexTransforms;
use estampe_shapes::BuiltinShape;

/// A vertex with everything that a material may read; no two triangles share one.
#[derive(Debug, Clone, Copy)]
struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
    uv: [f32; 2],
    color: [f32; 4],
}

/// The floats of a vertex.
const FLOATS: u32 = 27;

/// The format of a stream, and its first float in a vertex.
fn place(stream: VertexStream) -> (VertexFormat, u32) {
    match stream {
        VertexStream::Position => (VertexFormat::Float32x3, 0),
        VertexStream::Normal => (VertexFormat::Float32x3, 3),
        VertexStream::LitAt => (VertexFormat::Float32x3, 6),
        VertexStream::Corner => (VertexFormat::Float32x3, 9),
        VertexStream::Face => (VertexFormat::Float32x3, 12),
        VertexStream::Uv => (VertexFormat::Float32x2, 15),
        VertexStream::Color => (VertexFormat::Float32x4, 17),
        VertexStream::Tangent => (VertexFormat::Float32x4, 21),
        VertexStream::Uv1 => (VertexFormat::Float32x2, 25),
    }
}

/// The layout of vertices for a shader that reads these streams.
pub(super) fn layout(streams: &[VertexStream]) -> VertexBufferLayout {
    let attributes = streams.iter().zip(0..).map(|(&stream, shader_location)| {
        let (format, first) = place(stream);
        VertexAttribute {
            format,
            offset: 4 * first,
            shader_location,
        }
    });
    VertexBufferLayout {
        array_stride: 4 * FLOATS,
        attributes: attributes.collect(),
        ..VertexBufferLayout::default()
    }
}

/// The vertices of all triangles, one after the other.
pub(super) fn vertices() -> Vec<f32> {
    let mut random = fastrand::Rng::with_seed(8);
    let mut triangles = teapot();
    triangles.extend(square());
    triangles.extend((0..150).map(|_| of_cloud(&mut random)));
    let mut floats = Vec::new();
    for (index, triangle) in triangles.iter().enumerate() {
        let middle = [0, 1, 2].map(|axis| {
            let sum: f32 = triangle.iter().map(|vertex| vertex.position[axis]).sum();
            sum / 3.0
        });
        let face = [7, 11, 13].map(|factor| {
            let byte = u8::try_from(index * factor % 256).expect("below 256");
            f32::from(byte) / 255.0
        });
        for (corner, vertex) in triangle.iter().enumerate() {
            let mut corners = [0.0; 3];
            corners[corner] = 1.0;
            floats.extend(vertex.position);
            floats.extend(vertex.normal);
            floats.extend(middle);
            floats.extend(corners);
            floats.extend(face);
            floats.extend(vertex.uv);
            floats.extend(vertex.color);
            floats.extend(tangent(vertex, index));
            let [u, v] = vertex.uv;
            floats.extend([v * 0.7, u]);
        }
    }
    floats
}

/// A direction across the normal, with the sign of the bitangent; every fifth triangle has none.
fn tangent(vertex: &Vertex, triangle: usize) -> [f32; 4] {
    let [x, y, z] = vertex.normal;
    match triangle % 5 {
        0 => [0.0, 0.0, 0.0, 1.0],
        number if number % 2 == 1 => [y, -x, 0.1 * z, 1.0],
        _ => [z, 0.2, -x, -1.0],
    }
}

/// The number of vertices of the same.
pub(super) fn count(vertices: &[f32]) -> u32 {
    u32::try_from(vertices.len()).expect("few vertices") / FLOATS
}

fn teapot() -> Vec<[Vertex; 3]> {
    let shape = BuiltinShape::Teapot.build();
    let vertex = |index: u32| {
        let index = index as usize;
        let (at, normal) = (shape.positions[index], shape.normals[index]);
        let [x, y, z] = [at.x, at.y, at.z];
        Vertex {
            position: [x * 0.3, y * 0.3 - 0.45, z * 0.3],
            normal: [normal.x, normal.y, normal.z],
            uv: [x * 0.5, y * 0.5],
            color: [0.5 + 0.15 * x, 0.9 - 0.2 * y, 0.5 + 0.2 * z, 0.7],
        }
    };
    // Every seventh triangle: holes show the inside.
    let kept = shape
        .triangles
        .iter()
        .enumerate()
        .filter(|(at, _)| at % 7 != 0);
    kept.map(|(_, corners)| corners.map(vertex)).collect()
}

fn square() -> [[Vertex; 3]; 2] {
    let [a, b, c, d] =
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]: [f32; 2]| Vertex {
            position: [1.4 * x, 0.9 * y, -0.8],
            normal: [0.0, 0.0, 2.0],
            uv: [2.5 * x, 2.5 * y],
            color: [0.5 * x + 0.5, 0.5 * y + 0.5, 0.4, 0.9],
        });
    [[a, b, c], [a, c, d]]
}

fn of_cloud(random: &mut fastrand::Rng) -> [Vertex; 3] {
    let mut number = |size: f32| (random.f32() * 2.0 - 1.0) * size;
    let center = [0; 3].map(|_| number(2.0));
    let size = 0.05 + number(0.3).abs();
    let has_normals = number(1.0) > -0.7;
    let has_uv = number(1.0) > -0.7;
    let mut vertex = || Vertex {
        position: center.map(|at| at + number(size)),
        normal: [0; 3].map(|_| if has_normals { number(1.0) } else { 0.0 }),
        uv: [0; 2].map(|_| if has_uv { number(3.0) } else { 0.0 }),
        color: [0; 4].map(|_| number(1.0).abs()),
    };
    [vertex(), vertex(), vertex()]
}

/// The camera of pictures.
pub(super) fn transforms(is_orthographic: bool) -> VertexTransforms {
    let normal = Mat4::rotation_x(0.4) * Mat4::rotation_y(-0.6);
    let view = Mat4::translation([0.05, 0.1, -3.0]) * normal * Mat4::scale([1.1; 3]);
    let aspect = drawing_aspect();
    let projection = if is_orthographic {
        Mat4::orthographic(-1.3 * aspect, 1.3 * aspect, -1.3, 1.3, 0.5, 8.0)
    } else {
        Mat4::perspective(0.8, aspect, 0.5, 8.0)
    };
    VertexTransforms {
        clip_from_unit: projection * view,
        view_from_unit: view,
        view_from_object_normal: normal,
        is_orthographic,
    }
}

#[expect(clippy::cast_precision_loss, reason = "small numbers")]
fn drawing_aspect() -> f32 {
    super::drawing::WIDTH as f32 / super::drawing::HEIGHT as f32
}
