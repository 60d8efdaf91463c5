//! Pictures of face numbers, barycentric coordinates and overdraw, and edges over surfaces, against
//! the triangles that the oracle finds in each pixel.

use crate::support::{DEVICES, drawn_alike};
use estampe::{PixelHistory, PrimitiveRecord, TestOutcome};
use estampe_renderer::{
    CameraOptions, Eye, ProjectionKind, RenderOptions, Shading, face_color, inspect,
};
use estampe_scene::{Image, Mesh, Scene};
use fastrand::Rng;
use glam::{DVec3, Vec3};
use std::collections::BTreeSet;

const SIZE: [u32; 2] = [40, 32];
/// The triangles of each mesh.
const TRIANGLES: [u32; 3] = [5, 1, 9];

/// Meshes of triangles that cross.
fn scene(random: &mut Rng) -> Scene {
    let mesh = |count: u32, random: &mut Rng| {
        let mut vector =
            |size: f32| Vec3::from([(); 3].map(|()| (random.f32() * 2.0 - 1.0) * size));
        let triangle = |i: u32| [3 * i, 3 * i + 1, 3 * i + 2];
        Mesh {
            positions: (0..count)
                .flat_map(|_| {
                    let middle = vector(0.7);
                    [(); 3].map(|()| middle + vector(1.2))
                })
                .collect(),
            normals: vec![Vec3::Z; count as usize * 3],
            triangles: (0..count).map(triangle).collect(),
            ..Mesh::default()
        }
    };
    Scene {
        meshes: TRIANGLES.map(|count| mesh(count, random)).to_vec(),
        ..Scene::default()
    }
}

fn options(shading: Shading, samples: u32) -> RenderOptions {
    RenderOptions {
        width: SIZE[0],
        height: SIZE[1],
        samples,
        shading,
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.5, 0.3, 4.5)),
            target_world: Some(DVec3::ZERO),
            projection: ProjectionKind::Perspective { fov_y_deg: 45.0 },
            ..CameraOptions::default()
        },
        background: Some([0x20, 0x40, 0x60]),
        ..RenderOptions::default()
    }
}

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
}

fn texel(image: &Image, [x, y]: [u32; 2]) -> [u8; 3] {
    let [r, g, b, a] = image.texel(x, y);
    assert_eq!(a, 255);
    [r, g, b]
}

/// The history of a pixel of the unlit picture with one sample per pixel.
fn history(scene: &Scene, pixel: [u32; 2]) -> PixelHistory {
    let inspected = inspect(scene, &options(Shading::Unlit, 1), &DEVICES[0], pixel);
    inspected.expect("small").history
}

/// The triangle that a pixel shows: the last that passed the depth test.
fn visible(history: &PixelHistory) -> Option<&PrimitiveRecord> {
    let passed = |record: &&PrimitiveRecord| {
        let mut tests = record
            .fragments
            .iter()
            .flat_map(|fragment| &fragment.samples);
        tests.any(|test| test.outcome == TestOutcome::Passed)
    };
    history.primitives.iter().rfind(passed)
}

/// Each pixel has the colour of the number of its visible triangle, counted through all meshes.
///
/// Rows: I3, U3.
#[test]
fn face_ids_are_the_numbers_of_the_visible_triangles() {
    let mut random = Rng::with_seed(0x13_FACE);
    let mut seen = BTreeSet::new();
    for _ in 0..3 {
        let scene = scene(&mut random);
        let image = drawn_alike(&scene, &options(Shading::FaceId, 1)).image;
        for pixel in pixels() {
            let history = history(&scene, pixel);
            let number = visible(&history).map(|record| {
                let before: u32 = TRIANGLES[..record.draw].iter().sum();
                before as usize + usize::try_from(record.primitive).expect("few")
            });
            let expected = number.map_or([0x20, 0x40, 0x60], face_color);
            assert_eq!(texel(&image, pixel), expected, "{pixel:?} {number:?}");
            seen.insert(number);
        }
    }
    assert!(seen.len() > 12 && seen.contains(&None), "{seen:?}");
}

/// Each pixel has the perspective-correct barycentric coordinates of its visible triangle, within
/// one code.
///
/// Rows: I3, U3.
#[test]
fn barycentric_coordinates_are_those_of_the_oracle() {
    let mut random = Rng::with_seed(0x13_BA27);
    let (mut covered, mut bent) = (0, 0);
    for _ in 0..3 {
        let scene = scene(&mut random);
        let image = drawn_alike(&scene, &options(Shading::Barycentric, 1)).image;
        for pixel in pixels() {
            let history = history(&scene, pixel);
            let drawn = texel(&image, pixel);
            let Some(record) = visible(&history) else {
                assert_eq!(drawn, [0x20, 0x40, 0x60]);
                continue;
            };
            assert!(!record.is_clipped, "the scene lies in the picture's depths");
            let linear = record.barycentrics.expect("a triangle");
            let over_w: [f64; 3] =
                std::array::from_fn(|k| linear[k] * f64::from(record.piece[k].inverse_w));
            let sum: f64 = over_w.iter().sum();
            for k in 0..3 {
                let share = over_w[k] / sum;
                let difference = f64::from(drawn[k]) - share * 255.0;
                assert!(difference.abs() < 1.0, "{pixel:?} {drawn:?} {k}: {share}");
                bent += u32::from((share - linear[k]).abs() > 0.02);
            }
            covered += 1;
        }
    }
    assert!(covered > 1000, "{covered}");
    assert!(bent > 500, "{bent} differ from coordinates on the screen");
}

/// Each pixel counts the fragments that cover it, hidden ones too, and transparent ones.
///
/// Rows: I3, U3.
#[test]
fn overdraw_counts_all_fragments() {
    let mut random = Rng::with_seed(0x13_0DA2);
    let mut counts = BTreeSet::new();
    let mut hidden = 0;
    for _ in 0..3 {
        let scene = scene(&mut random);
        let image = drawn_alike(&scene, &options(Shading::Overdraw, 1)).image;
        for pixel in pixels() {
            let history = history(&scene, pixel);
            let fragments = || {
                history
                    .primitives
                    .iter()
                    .flat_map(|record| &record.fragments)
            };
            let count = fragments().filter(|fragment| fragment.covered != 0).count();
            let expected = [32, 8, 1].map(|step| u8::try_from(step * count).unwrap_or(u8::MAX));
            assert_eq!(texel(&image, pixel), expected, "{pixel:?}");
            counts.insert(count);
            let tests = fragments().flat_map(|fragment| &fragment.samples);
            let failed = tests.filter(|test| test.outcome != TestOutcome::Passed);
            hidden += u32::from(failed.count() > 0);
        }
    }
    assert!(
        counts.contains(&0) && counts.last() > Some(&5),
        "{counts:?}"
    );
    assert!(hidden > 200, "{hidden}");
}

/// Distance of a pixel's centre from the nearest edge of a triangle, in pixels.
fn distance_from_edges(record: &PrimitiveRecord) -> f64 {
    let edges = record.edges.expect("a triangle");
    let corner = |k: usize| {
        DVec3::from([0, 1, 2].map(|axis| match axis {
            2 => 0.0,
            axis => f64::from(record.piece[k].position[axis]),
        }))
    };
    let distances = [0, 1, 2].map(|k| {
        let length = (corner((k + 1) % 3) - corner((k + 2) % 3)).length();
        edges[k] / length
    });
    distances.into_iter().fold(f64::INFINITY, f64::min)
}

/// The wireframe over a picture changes the pixels along the edges of visible triangles, and no
/// others; edges behind surfaces are hidden.
///
/// Rows: I3, U3.
#[test]
fn the_wireframe_lies_on_the_edges_of_visible_triangles() {
    let mut random = Rng::with_seed(0x13_ED6E);
    let (mut on_edges, mut off_edges) = (0, 0);
    for shading in [
        Shading::Unlit,
        Shading::Phong,
        Shading::Normals,
        Shading::Flat,
    ] {
        let scene = scene(&mut random);
        let plain = options(shading, 1);
        let framed = RenderOptions {
            wireframe: true,
            ..plain.clone()
        };
        let [plain, framed] = [plain, framed].map(|options| drawn_alike(&scene, &options).image);
        for pixel in pixels() {
            let history = history(&scene, pixel);
            let (before, after) = (texel(&plain, pixel), texel(&framed, pixel));
            let Some(record) = visible(&history) else {
                assert_eq!(before, after, "{pixel:?} shows the background");
                continue;
            };
            // Half of the edge's width is half a pixel, and as much is smoothed; derivatives bend.
            let distance = distance_from_edges(record);
            if distance > 1.3 {
                assert_eq!(before, after, "{pixel:?}, {distance} px from the edge");
                off_edges += 1;
            } else if distance < 0.3 {
                let line = [0x10, 0x18, 0x20];
                let nears =
                    (0..3).all(|k| after[k].abs_diff(line[k]) <= before[k].abs_diff(line[k]));
                assert!(nears && before != after, "{pixel:?} {before:?} {after:?}");
                on_edges += 1;
            }
        }
    }
    assert!(on_edges > 100, "{on_edges}");
    assert!(off_edges > 300, "{off_edges}");
}

/// The wireframe changes nothing in a picture of edges alone, and lies over every other shading,
/// with one sample and with four.
///
/// Rows: I3, U3.
#[test]
fn every_shading_can_have_a_wireframe() {
    let scene = scene(&mut Rng::with_seed(0x13_A11));
    for shading in [
        Shading::Flat,
        Shading::Gouraud,
        Shading::Phong,
        Shading::Toon,
        Shading::Unlit,
        Shading::Normals,
        Shading::Depth,
        Shading::Uv,
        Shading::FaceId,
        Shading::Barycentric,
        Shading::Overdraw,
        Shading::Wireframe,
    ] {
        for samples in [1, 4] {
            let plain = options(shading, samples);
            let framed = RenderOptions {
                wireframe: true,
                ..plain.clone()
            };
            let [plain, framed] =
                [plain, framed].map(|options| drawn_alike(&scene, &options).image);
            let is_alike = plain == framed;
            assert_eq!(is_alike, shading == Shading::Wireframe, "{shading:?}");
        }
    }
}
