//! Sections in pictures: the area of caps, and all shadings.

use crate::support::drawn_alike;
use estampe_renderer::{
    CameraOptions, Eye, ProjectionKind, RenderOptions, Section, SectionPlane, Shading,
    Transparency, ViewDirection,
};
use estampe_scene::{Mesh, Scene};
use estampe_shapes::BuiltinShape;
use glam::DVec3;

fn scene(shape: BuiltinShape) -> Scene {
    let shape = shape.build();
    Scene {
        meshes: vec![Mesh {
            positions: shape.positions,
            normals: shape.normals,
            triangles: shape.triangles,
            ..Mesh::default()
        }],
        ..Scene::default()
    }
}

fn cut_by(normals: &[DVec3]) -> Section {
    let plane = |&normal_world| SectionPlane {
        normal_world,
        offset_world: None,
    };
    Section {
        planes: normals.iter().map(plane).collect(),
        cap_color: [0, 200, 0],
    }
}

fn options(section: Section) -> RenderOptions {
    RenderOptions {
        width: 48,
        height: 40,
        samples: 1,
        background: None,
        section,
        ..RenderOptions::default()
    }
}

fn is_cap(pixel: &[u8; 4]) -> bool {
    *pixel == [0, 200, 0, 255]
}

/// Half a cube from the side that is cut away: a square of known size, one pixel more or less at
/// each border.
#[test]
fn the_cap_of_a_cube_has_the_area_of_its_side() {
    for (samples, transparency) in [(1, Transparency::Sorted), (4, Transparency::Exact)] {
        let picture = drawn_alike(
            &scene(BuiltinShape::Cube),
            &RenderOptions {
                samples,
                transparency,
                shading: Shading::Unlit,
                camera: CameraOptions {
                    eye: Eye::Fitted(ViewDirection::FRONT),
                    projection: ProjectionKind::Orthographic { half_height: None },
                    margin: 0.1,
                    ..CameraOptions::default()
                },
                ..options(cut_by(&[DVec3::Z]))
            },
        );
        let pixels = picture.image.rgba.as_chunks::<4>().0;
        let caps = pixels.iter().filter(|pixel| is_cap(pixel)).count();
        // 40 rows less 4 at either side.
        assert!((31 * 31..=33 * 33).contains(&caps), "{caps}");
        let visible = pixels.iter().filter(|pixel| pixel[3] == 255).count();
        assert_eq!(caps, visible, "nothing is seen but the cap");
    }
}

#[test]
fn every_shading_can_be_cut() {
    let torus = scene(BuiltinShape::Torus);
    for shading in [
        Shading::Phong,
        Shading::Pbr,
        Shading::Flat,
        Shading::Gouraud,
        Shading::Toon,
        Shading::Normals,
        Shading::Depth,
        Shading::Wireframe,
        Shading::Overdraw,
    ] {
        let has_shadows = matches!(shading, Shading::Phong | Shading::Pbr);
        let cut = RenderOptions {
            shading,
            shadows: has_shadows,
            wireframe: has_shadows,
            ..options(cut_by(&[DVec3::Z, DVec3::X]))
        };
        let plain = RenderOptions {
            section: Section::default(),
            ..cut.clone()
        };
        let pictures = [&cut, &plain].map(|options| drawn_alike(&torus, options).image);
        assert!(pictures[0] != pictures[1], "{shading:?}");
    }
    let frame = drawn_alike(
        &torus,
        &RenderOptions {
            shading: Shading::Unlit,
            ..options(cut_by(&[DVec3::Z]))
        },
    );
    let caps = frame
        .image
        .rgba
        .as_chunks::<4>()
        .0
        .iter()
        .filter(|pixel| is_cap(pixel));
    assert!(caps.count() > 20);
}
