//! Feature edges against the projections of known edges.

use crate::support::drawn_alike;
use estampe_renderer::{
    CameraOptions, Eye, FeatureEdges, ProjectionKind, RenderOptions, Shading, ViewDirection,
};
use estampe_scene::{Camera, Image, Mesh, Projection, Scene};
use estampe_shapes::BuiltinShape;
use glam::{DVec2, DVec3};

const SIDE: u32 = 64;

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

fn options(view: ViewDirection, samples: u32) -> RenderOptions {
    RenderOptions {
        width: SIDE,
        height: SIDE,
        samples,
        shading: Shading::Unlit,
        camera: CameraOptions {
            eye: Eye::Fitted(view),
            projection: ProjectionKind::Orthographic { half_height: None },
            margin: 0.1,
            ..CameraOptions::default()
        },
        ..RenderOptions::default()
    }
}

fn with_edges(options: &RenderOptions, edges: FeatureEdges) -> RenderOptions {
    RenderOptions {
        edges: Some(edges),
        ..options.clone()
    }
}

/// The place of a point in the picture, in pixels, and the direction to the eye.
fn projected(camera: &Camera, point: DVec3) -> (DVec2, DVec3) {
    let Projection::Orthographic { half_height, .. } = camera.projection else {
        panic!("an orthographic camera");
    };
    let back = (camera.eye_world - camera.target_world)
        .as_dvec3()
        .normalize();
    let right = camera.up_world.as_dvec3().cross(back).normalize();
    let up = back.cross(right);
    let way = point - camera.eye_world.as_dvec3();
    let scale = f64::from(SIDE) / 2.0 / f64::from(half_height);
    let at = DVec2::new(way.dot(right), -way.dot(up)) * scale;
    (at + f64::from(SIDE) / 2.0, back)
}

/// How much darker the edges make each pixel, and the camera.
fn darkening(scene: &Scene, options: &RenderOptions, edges: FeatureEdges) -> (Vec<i32>, Camera) {
    let plain = drawn_alike(scene, options);
    let lined = drawn_alike(scene, &with_edges(options, edges));
    let luma = |rgba: &[u8]| rgba[..3].iter().map(|&code| i32::from(code)).sum::<i32>();
    let pairs = plain.image.rgba.chunks(4).zip(lined.image.rgba.chunks(4));
    let darker = pairs.map(|(plain, lined)| luma(plain) - luma(lined));
    (darker.collect(), lined.camera)
}

fn at(values: &[i32], place: DVec2) -> i32 {
    let side = f64::from(SIDE);
    let [x, y] =
        [place.x, place.y].map(|at| (0..SIDE).find(|&k| f64::from(k + 1) > at.min(side - 0.5)));
    let (x, y) = (x.expect("inside"), y.expect("inside"));
    values[(y * SIDE + x) as usize]
}

/// The distance of a place from a segment.
fn distance(place: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let way = b - a;
    let share = ((place - a).dot(way) / way.length_squared().max(1e-9)).clamp(0.0, 1.0);
    place.distance(a + way * share)
}

/// The edges of the cube from −1 to 1, with the normals of their two faces.
fn cube_edges() -> Vec<([DVec3; 2], [DVec3; 2])> {
    let mut edges = Vec::new();
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map(|k| DVec3::AXES[k]);
        for (a, b) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            let middle = u * a + v * b;
            let along = DVec3::AXES[axis];
            edges.push(([middle - along, middle + along], [u * a, v * b]));
        }
    }
    edges
}

/// The three edges of a cube that it hides are not drawn, and the nine others are, over their whole
/// length, from all sides: depths neither fight nor let hidden edges through.
#[test]
fn visible_edges_are_drawn_and_hidden_ones_are_not() {
    let scene = scene(BuiltinShape::Cube);
    for (number, (azimuth_deg, elevation_deg)) in [
        (30.0, 20.0),
        (44.0, 3.0),
        (-100.0, -40.0),
        (5.0, 84.0),
        (170.0, 12.0),
    ]
    .into_iter()
    .enumerate()
    {
        let view = ViewDirection {
            azimuth_deg,
            elevation_deg,
        };
        let samples = if number % 2 == 0 { 4 } else { 1 };
        let edges = FeatureEdges {
            width_px: Some(1.5),
            ..FeatureEdges::default()
        };
        let (darker, camera) = darkening(&scene, &options(view, samples), edges);
        let mut drawn = Vec::new();
        for (ends, normals) in cube_edges() {
            let ends = ends.map(|end| projected(&camera, end));
            let is_visible = normals.iter().any(|normal| normal.dot(ends[0].1) > 0.0);
            if is_visible {
                drawn.push(ends.map(|(place, _)| place));
            }
        }
        assert!((7..=9).contains(&drawn.len()));
        for &[a, b] in &drawn {
            for step in 0..=20 {
                let place = a.lerp(b, f64::from(step) / 20.0);
                // A line of 1.5 pixels darkens the pixel of its middle by more than half.
                assert!(at(&darker, place) > 120, "{view:?} {a} {b} {step}");
            }
        }
        for (index, &darker) in (0_u32..).zip(&darker) {
            let center = DVec2::new((index % SIDE).into(), (index / SIDE).into()) + 0.5;
            let nearest = drawn.iter().map(|&ends| distance(center, ends));
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            if nearest > 1.3 {
                assert_eq!(darker, 0, "{view:?} {center}");
            }
        }
    }
}

/// A sphere has no sharp edge: what is drawn is its outline.
#[test]
fn silhouettes_lie_on_the_outline() {
    let scene = scene(BuiltinShape::Sphere);
    let (darker, camera) = darkening(
        &scene,
        &options(ViewDirection::ISO, 4),
        FeatureEdges::default(),
    );
    let (center, _) = projected(&camera, DVec3::ZERO);
    let radius = f64::from(SIDE) * 0.4;
    for (index, &darker) in (0_u32..).zip(&darker) {
        let place = DVec2::new((index % SIDE).into(), (index / SIDE).into()) + 0.5;
        let off = (place.distance(center) - radius).abs();
        if off > 2.0 {
            assert_eq!(darker, 0, "{place}");
        }
    }
    let around = (0..72_u8).filter(|&step| {
        let (sin, cos) = libm::sincos((f64::from(step) * 5.0).to_radians());
        let near = [-1.0, -0.5, 0.0, 0.5];
        let places = near.map(|off| center + DVec2::new(cos, sin) * (radius + off));
        places.iter().any(|&place| at(&darker, place) > 60)
    });
    assert_eq!(around.count(), 72);
}

#[test]
fn pictures_of_one_flat_face_have_edges_by_themselves() {
    let front = ViewDirection {
        azimuth_deg: 0.0,
        elevation_deg: 0.0,
    };
    let textured = |scene: &Scene| Scene {
        images: vec![Image {
            width: 1,
            height: 1,
            rgba: vec![255; 4],
        }],
        ..scene.clone()
    };
    for (shape, view, is_flat, is_perspective) in [
        (BuiltinShape::Cube, front, true),
        (BuiltinShape::Plane, ViewDirection::ISO, true),
        (BuiltinShape::Cube, ViewDirection::ISO, false),
        (BuiltinShape::Sphere, front, false),
        (BuiltinShape::Torus, front, false),
    ]
    .into_iter()
    .flat_map(|case| [(case, false), (case, true)])
    .map(|((shape, view, is_flat), is_perspective)| (shape, view, is_flat, is_perspective))
    {
        let scene = scene(shape);
        let mut plain = RenderOptions {
            shading: Shading::Phong,
            ..options(view, 4)
        };
        if is_perspective {
            plain.camera.projection = ProjectionKind::default();
        }
        let by_themselves = RenderOptions {
            edges_of_flat_views: true,
            ..plain.clone()
        };
        let without = drawn_alike(&scene, &plain).image;
        let expected = if is_flat {
            drawn_alike(&scene, &with_edges(&plain, FeatureEdges::default())).image
        } else {
            without.clone()
        };
        assert_eq!(expected != without, is_flat, "{shape:?}");
        let drawn = drawn_alike(&scene, &by_themselves).image;
        assert!(drawn == expected, "{shape:?}");
        let drawn = drawn_alike(&textured(&scene), &by_themselves).image;
        assert!(drawn == without, "{shape:?}, with a texture");
        let lit = RenderOptions {
            shading: Shading::Unlit,
            ..by_themselves
        };
        let unlit = RenderOptions {
            shading: Shading::Unlit,
            ..plain
        };
        let (lit, unlit) = (drawn_alike(&scene, &lit), drawn_alike(&scene, &unlit));
        assert!(lit.image == unlit.image, "{shape:?}, unlit");
    }
}

/// The base of a pyramid is one face that fills the view from above, and is hidden there: only what
/// is seen counts, whichever way all faces are wound.
#[test]
fn hidden_faces_do_not_make_a_view_flat() {
    let at = |x: f32, y: f32, z: f32| glam::Vec3::new(x, y, z);
    let pyramid = |is_flipped: bool| {
        let faces = [
            [0, 1, 2],
            [0, 2, 3],
            [1, 0, 4],
            [2, 1, 4],
            [3, 2, 4],
            [0, 3, 4],
        ];
        Scene {
            meshes: vec![Mesh {
                positions: vec![
                    at(-1.0, 0.0, -1.0),
                    at(1.0, 0.0, -1.0),
                    at(1.0, 0.0, 1.0),
                    at(-1.0, 0.0, 1.0),
                    at(0.0, 1.5, 0.0),
                ],
                triangles: faces
                    .map(|[a, b, c]| if is_flipped { [a, c, b] } else { [a, b, c] })
                    .to_vec(),
                ..Mesh::default()
            }],
            ..Scene::default()
        }
    };
    let from = |elevation_deg: f64, is_on: bool| RenderOptions {
        shading: Shading::Flat,
        edges_of_flat_views: is_on,
        ..options(
            ViewDirection {
                azimuth_deg: 0.0,
                elevation_deg,
            },
            4,
        )
    };
    for is_flipped in [false, true] {
        let scene = pyramid(is_flipped);
        for (elevation_deg, is_flat) in [(90.0, false), (-90.0, true)] {
            let [plain, drawn] =
                [false, true].map(|is_on| drawn_alike(&scene, &from(elevation_deg, is_on)).image);
            assert_eq!(drawn != plain, is_flat, "{elevation_deg}, {is_flipped}");
        }
    }
}

#[test]
fn edges_lie_over_every_shading_and_on_nothing() {
    let scene = scene(BuiltinShape::Torus);
    for shading in [
        Shading::Phong,
        Shading::Pbr,
        Shading::Normals,
        Shading::Wireframe,
        Shading::Overdraw,
    ] {
        let plain = RenderOptions {
            shading,
            background: None,
            ..options(ViewDirection::default(), 1)
        };
        let lined = with_edges(
            &plain,
            FeatureEdges {
                angle_deg: 1.0,
                width_px: None,
            },
        );
        let pictures = [&plain, &lined].map(|options| drawn_alike(&scene, options).image);
        assert!(pictures[0] != pictures[1], "{shading:?}");
        let corner = &pictures[1].rgba[..4];
        assert!(
            corner == [0; 4] || shading == Shading::Overdraw,
            "{shading:?}"
        );
    }
}

/// A line of a model is as smooth without several samples: its pixels are no two colours alone.
#[test]
fn lines_of_models_are_smooth_with_one_sample() {
    let scene = Scene {
        meshes: vec![Mesh {
            positions: vec![
                glam::Vec3::new(-1.0, -0.3, 0.0),
                glam::Vec3::new(1.0, 0.3, 0.0),
            ],
            lines: vec![[0, 1]],
            ..Mesh::default()
        }],
        ..Scene::default()
    };
    let picture = drawn_alike(&scene, &options(ViewDirection::FRONT, 1)).image;
    let mut codes: Vec<u8> = picture.rgba.chunks(4).map(|pixel| pixel[0]).collect();
    codes.sort_unstable();
    codes.dedup();
    assert!(codes.len() > 5, "{codes:?}");
}

/// With one sample per pixel the outline of a wireframe is smooth: it has pixels that are neither
/// the line nor the background, on the outside of the model too.
#[test]
fn outlines_of_wireframes_are_smooth_with_one_sample() {
    let scene = scene(BuiltinShape::Cube);
    let view = ViewDirection {
        azimuth_deg: 20.0,
        elevation_deg: 12.0,
    };
    let faces = RenderOptions {
        background: None,
        ..options(view, 1)
    };
    let edges = RenderOptions {
        shading: Shading::Wireframe,
        ..faces.clone()
    };
    let [faces, edges] = [&faces, &edges].map(|options| drawn_alike(&scene, options).image);
    let pairs = faces.rgba.chunks(4).zip(edges.rgba.chunks(4));
    let outside = pairs.filter(|(face, edge)| face[3] == 0 && edge[3] > 0);
    assert!(outside.count() > 40);
}
