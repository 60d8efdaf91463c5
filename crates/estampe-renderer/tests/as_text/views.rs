//! Inspection, wireframes, points and lines as text.

use super::drawing::Textures;
use super::scene::transforms;
use super::uniforms::Numbers;
use super::{Glsl, Material, Wgsl};
use estampe::state::{BlendState, ColorTargetState, PrimitiveTopology};
use estampe::{Program, Shader, ShaderProgram, TextureFormat};
use estampe_renderer::shading::VertexStream;
use estampe_renderer::shading::inspection::{
    Barycentrics, DepthGrey, FaceColors, Normals, Overdraw, UvColors,
};
use estampe_renderer::shading::output::{EyeDistance, Fog};
use estampe_renderer::shading::points_and_lines::PointsAndLines;
use estampe_renderer::shading::wireframe::Wireframe;
use std::sync::Arc;

/// A view: no textures, one target of floats, triangles.
fn material(
    name: &'static str,
    shader: impl Shader + Clone,
    streams: &[VertexStream],
    wgsl: Wgsl,
    glsl: Glsl,
) -> Material {
    let shader = Arc::new(ShaderProgram::new(shader)) as Arc<dyn Program>;
    Material {
        name,
        in_rust: Box::new(move |_: &Textures| Arc::clone(&shader)),
        streams: streams.to_vec(),
        wgsl,
        glsl,
        numbers: Numbers::default(),
        targets: vec![Some(TextureFormat::Rgba32Float.into())],
        topology: PrimitiveTopology::TriangleList,
        least_colors: 100,
        differing: [[0; 2]; 2],
    }
}

pub(super) fn inspection() -> Vec<Material> {
    use VertexStream::{Corner, Face, Normal, Position, Uv};
    let transforms = transforms(false);
    let (nearest, furthest) = (1.5, 5.0);
    let wgsl = |vertex, fragment| Wgsl {
        text: include_str!("wgsl/inspection.wgsl").to_owned(),
        vertex,
        fragment,
        constants: Vec::new(),
    };
    let glsl = |define| Glsl {
        vertex: include_str!("glsl/inspection.vert").to_owned(),
        fragment: include_str!("glsl/inspection.frag").to_owned(),
        defines: vec![(define, String::new())],
    };
    let depth = DepthGrey {
        transforms,
        nearest,
        furthest,
    };
    let sum = ColorTargetState {
        blend: Some(BlendState::ADDITIVE),
        ..TextureFormat::Rgba32Float.into()
    };
    let materials = [
        material(
            "Normals",
            Normals { transforms },
            &[Position, Normal],
            wgsl("seen", "normals"),
            glsl("NORMALS"),
        ),
        material(
            "Depth",
            depth,
            &[Position],
            wgsl("far", "depth"),
            glsl("DEPTH"),
        ),
        material(
            "Texture coordinates",
            UvColors { transforms },
            &[Position, Uv],
            wgsl("with_uv", "uv"),
            glsl("UV"),
        ),
        material(
            "Faces",
            FaceColors { transforms },
            &[Position, Face],
            wgsl("with_face", "faces"),
            glsl("FACES"),
        ),
        material(
            "Barycentric coordinates",
            Barycentrics { transforms },
            &[Position, Corner],
            wgsl("with_corner", "barycentric"),
            glsl("BARYCENTRIC"),
        ),
        Material {
            targets: vec![Some(sum)],
            least_colors: 4,
            ..material(
                "Overdraw",
                Overdraw { transforms },
                &[Position],
                wgsl("alone", "overdraw"),
                glsl("OVERDRAW"),
            )
        },
    ];
    let numbers = Numbers::default()
        .transforms(&transforms)
        .number("nearest", nearest)
        .number("furthest", furthest);
    let with_numbers = |material| Material {
        numbers: numbers.clone(),
        ..material
    };
    materials.into_iter().map(with_numbers).collect()
}

/// Edges over faces of the background's colour, and over shaded surfaces.
pub(super) fn wireframes() -> Vec<Material> {
    let transforms = transforms(false);
    let wires = |name, face: [f32; 4], line: [f32; 4], half_width_px, blend| {
        let shader = Wireframe {
            transforms,
            line,
            face,
            backdrop: None,
            half_width_px,
        };
        let target = ColorTargetState {
            blend,
            ..TextureFormat::Rgba32Float.into()
        };
        let wgsl = Wgsl {
            text: include_str!("wgsl/wireframe.wgsl").to_owned(),
            vertex: "vertex",
            fragment: "wireframe",
            constants: Vec::new(),
        };
        let glsl = Glsl {
            vertex: include_str!("glsl/wireframe.vert").to_owned(),
            fragment: include_str!("glsl/wireframe.frag").to_owned(),
            defines: Vec::new(),
        };
        let streams = [VertexStream::Position, VertexStream::Corner];
        Material {
            targets: vec![Some(target)],
            numbers: Numbers::default()
                .transforms(&transforms)
                .four("line", line)
                .four("face", face)
                .number("half_width_px", half_width_px),
            ..material(name, shader, &streams, wgsl, glsl)
        }
    };
    let over = Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING);
    vec![
        wires(
            "Wireframe",
            [0.9, 0.9, 0.8, 1.0],
            [0.1, 0.1, 0.3, 1.0],
            0.6,
            None,
        ),
        wires(
            "Edges over surfaces",
            [0.0; 4],
            [0.0, 0.0, 0.0, 0.6],
            0.35,
            over,
        ),
    ]
}

/// Clouds, lines, and lines in fog.
pub(super) fn points_and_lines() -> Vec<Material> {
    let transforms = transforms(false);
    let fog = Fog {
        color: [0.5, 0.55, 0.6],
        backdrop: None,
        start: 2.0,
        per_distance: 0.3,
        eye_distance: EyeDistance::Perspective {
            x: [0.009, -0.6],
            y: [-0.0088, 0.42],
        },
    };
    let cued = |name, topology, fog: Option<Fog>, point_size_px| {
        let shader = PointsAndLines {
            transforms,
            color: [0.9, 0.8, 0.4],
            distant_color: [0.2, 0.3, 0.5],
            share_at_furthest: 0.7,
            depth_range: (1.5, 5.0),
            fog,
            point_size_px,
        };
        let wgsl = Wgsl {
            text: include_str!("wgsl/points_and_lines.wgsl").to_owned(),
            vertex: "vertex",
            fragment: "points_and_lines",
            constants: fog.iter().map(|_| ("FOG", 1.0)).collect(),
        };
        let glsl = Glsl {
            vertex: include_str!("glsl/points_and_lines.vert").to_owned(),
            fragment: include_str!("glsl/points_and_lines.frag").to_owned(),
            defines: fog.iter().map(|_| ("FOG", String::new())).collect(),
        };
        let numbers = Numbers::default()
            .transforms(&transforms)
            .three("color", shader.color)
            .three("distant_color", shader.distant_color)
            .number("share_at_furthest", shader.share_at_furthest)
            .number("nearest", shader.depth_range.0)
            .number("furthest", shader.depth_range.1)
            .number("point_size_px", point_size_px)
            .fog(fog.as_ref());
        let streams = [VertexStream::Position, VertexStream::Color];
        Material {
            topology,
            numbers,
            ..material(name, shader, &streams, wgsl, glsl)
        }
    };
    vec![
        cued("Points", PrimitiveTopology::PointList, None, 1.0),
        // WGSL has no width of points: they are a pixel wide.
        Material {
            differing: [[3328, 3328], [0, 0]],
            ..cued(
                "Points of three pixels",
                PrimitiveTopology::PointList,
                None,
                3.0,
            )
        },
        cued("Lines", PrimitiveTopology::LineList, None, 1.0),
        cued("Lines in fog", PrimitiveTopology::LineList, Some(fog), 1.0),
    ]
}
