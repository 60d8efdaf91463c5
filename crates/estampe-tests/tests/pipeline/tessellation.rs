//! Tessellation through the pipeline, against the oracle.

use estampe_tests::Random;
use estampe_tests::amplification::{Dividing, Emitting, Scene};
use estampe_tests::fast_path::{all_devices, name, some_devices};
use estampe_tests::geometry::{Vertex, clip_at};
use estampe_tests::shared_edges::{Kind, mesh};
use estampe_types::IndexFormat;
use estampe_types::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, CullMode, FrontFace,
    PrimitiveTopology, ProvokingVertex, TessellationDomain as D, TessellationMode,
    TessellationSpacing as S,
};

type NoGeometry = Emitting<2, 2, 3, 1>;

const NO_GEOMETRY: Option<&NoGeometry> = None;

/// Compares the image on some devices with the oracle's; returns it.
fn check(scene: &Scene, geometry: Option<&NoGeometry>, turn: u64) -> Vec<u8> {
    let (wanted, primitives) = scene.draw_by_oracle(geometry);
    for device in some_devices(turn) {
        let (image, statistics) = scene.draw(device, geometry);
        let on = name(device);
        assert_eq!(statistics.primitives_in, primitives, "{on}: {scene:?}");
        assert!(image == wanted, "{on} draws another image: {scene:?}");
    }
    let device = some_devices(turn)[0];
    let _ = scene.inspect_one(device, geometry, &wanted);
    wanted
}

fn random_vertices(random: &mut Random, size: [u32; 2], count: usize) -> Vec<Vertex> {
    let mut vertex = || {
        let at = [
            random.range(0.0, size[0] as f32),
            random.range(0.0, size[1] as f32),
        ];
        let w = random.pick(&[1.0, 1.0, 0.5, 2.5]);
        let [x, y, z, level] = random.four(0.0, 1.0);
        Vertex {
            position: clip_at(size, at, random.range(0.1, 0.9), w),
            values: [x, y, z, level * 3.0],
        }
    };
    (0..count).map(|_| vertex()).collect()
}

/// Every domain, spacing, winding and point mode, with several instances, culling, both provoking
/// vertices, indices with restarts, patches of three and of four vertices, a point size and a clip
/// distance, equals the oracle at every SIMD level.
///
/// Rows: V3
#[test]
fn patches_are_those_of_the_oracle() {
    let mut random = Random::new("tessellation", 1);
    let (mut drawn, mut seed) = (0, 0);
    for domain in [D::Triangles, D::Quads, D::Isolines] {
        for spacing in [S::Equal, S::FractionalOdd, S::FractionalEven] {
            for winding in [FrontFace::Ccw, FrontFace::Cw] {
                for point_mode in [false, true] {
                    seed += 1;
                    let size = [50, 40];
                    let points = random.pick(&[3_u32, 4, 4]);
                    let count = (points * (1 + random.below(20)) + random.below(3)) as usize;
                    let vertices = random_vertices(&mut random, size, count);
                    let mut scene = Scene::new(size, PrimitiveTopology::PatchList, vertices);
                    let shader = Dividing {
                        domain,
                        inner: [random.range(0.0, 6.0), random.range(0.0, 6.0)],
                        bend: random.pick(&[0.0, 0.3]),
                        point_size: random.once_in(2).then_some(3.0),
                    };
                    let mode = TessellationMode {
                        domain,
                        spacing,
                        winding,
                        point_mode,
                    };
                    scene.tessellation = Some((mode, points, shader));
                    scene.instances = 1..1 + 1 + random.below(3);
                    scene.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::Back]);
                    scene.primitive.provoking_vertex =
                        random.pick(&[ProvokingVertex::First, ProvokingVertex::Last]);
                    if random.once_in(2) {
                        let most = u32::try_from(count).unwrap();
                        let mut index = || match random.below(12) {
                            0 => u8::MAX,
                            _ => u8::try_from(random.below(most)).unwrap(),
                        };
                        let bytes: Vec<u8> = (0..count * 2).map(|_| index()).collect();
                        scene.elements = 1..u32::try_from(bytes.len()).unwrap() + 9;
                        scene.indices = Some((IndexFormat::Uint8, bytes));
                        scene.primitive.primitive_restart = random.once_in(2);
                        scene.base_vertex = random.pick(&[0, -2, 1]);
                    }
                    let image = check(&scene, NO_GEOMETRY, seed);
                    drawn += u32::from(image.iter().any(|byte| *byte != 0));
                }
            }
        }
    }
    assert!(drawn > 27, "{drawn} of 36 images show something");
}

/// A patch at level 64 in each domain, and one beyond it.
///
/// Rows: V3
#[test]
fn level_64_is_drawn() {
    let size = [96, 96];
    let corner = |at, level| Vertex {
        position: clip_at(size, at, 0.5, 1.0),
        values: [at[0] / 96.0, at[1] / 96.0, 0.5, level],
    };
    for (seed, domain) in (0..).zip([D::Triangles, D::Quads, D::Isolines]) {
        for level in [32.0, 1e30] {
            let corners = [[3.0, 3.0], [4.0, 90.0], [93.0, 91.0], [90.0, 5.0]];
            let corners = corners.map(|at| corner(at, level));
            let mut scene = Scene::new(size, PrimitiveTopology::PatchList, corners.to_vec());
            let mode = TessellationMode {
                domain,
                ..TessellationMode::default()
            };
            let shader = Dividing {
                domain,
                inner: [64.0; 2],
                bend: 0.1,
                point_size: None,
            };
            scene.tessellation = Some((mode, 4, shader));
            let _ = check(&scene, NO_GEOMETRY, seed);
        }
    }
}

/// Random meshes of patches, whose edges have random levels and are divided from either end: the
/// front faces over each pixel, less the back faces, are one, at every SIMD level and number of
/// threads. A crack, or points of an edge that differ in a bit, would give another number.
///
/// Rows: V3
#[test]
fn shared_edges_have_no_cracks() {
    let count = BlendState {
        color: BlendComponent {
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::One,
            operation: BlendOperation::Add,
        },
        alpha: BlendComponent::REPLACE,
    };
    let size = [64, 48];
    let mut random = Random::new("tessellation_cracks", 1);
    for spacing in [S::Equal, S::FractionalOdd, S::FractionalEven] {
        for kind in [Kind::Grid, Kind::Fan, Kind::Cuts] {
            let triangles = mesh(&mut random, kind, size);
            let seed = random.bits().cast_signed();
            let mut vertices = Vec::new();
            for mut triangle in triangles {
                // The edges of neighbours have other numbers and directions.
                triangle.rotate_left(random.index(3));
                for [x, y] in triangle {
                    // The level of a corner belongs to its place.
                    let hash = x.wrapping_mul(7919) ^ y.wrapping_mul(104_729) ^ seed;
                    let level = (hash.wrapping_mul(40_503) >> 8 & 1023) as f32 / 256.0;
                    let at = [x as f32 / 256.0, y as f32 / 256.0];
                    vertices.push(Vertex {
                        position: clip_at(size, at, 0.5, 1.0),
                        values: [0.0, 0.0, 1.0 / 255.0, level + 0.1],
                    });
                }
            }
            let mut scene = Scene::new(size, PrimitiveTopology::PatchList, vertices);
            let mode = TessellationMode {
                spacing,
                ..TessellationMode::default()
            };
            let shader = Dividing {
                domain: D::Triangles,
                inner: [random.range(0.0, 9.0), 1.0],
                bend: 0.0,
                point_size: None,
            };
            scene.tessellation = Some((mode, 3, shader));
            scene.blend = Some(count);
            // Clockwise on the image.
            scene.primitive.front_face = FrontFace::Cw;
            let mut images = Vec::new();
            for device in all_devices() {
                let faces = [CullMode::Back, CullMode::Front].map(|culled| {
                    scene.primitive.cull_mode = culled;
                    scene.draw(device, NO_GEOMETRY).0
                });
                let [front, back] = &faces;
                let pixels = front.chunks(4).zip(back.chunks(4));
                for (at, (front, back)) in pixels.enumerate() {
                    let covered = i32::from(front[2]) - i32::from(back[2]);
                    assert_eq!(
                        covered,
                        1,
                        "{kind:?} {spacing:?}: pixel {at}, {}",
                        name(device)
                    );
                }
                images.push(faces);
            }
            assert!(images.windows(2).all(|two| two[0] == two[1]));
        }
    }
}

/// Tessellation followed by a geometry shader.
///
/// Rows: V3, V4
#[test]
fn tessellated_triangles_reach_a_geometry_shader() {
    let mut random = Random::new("tessellation_geometry", 1);
    for seed in 0..4 {
        let size = [60, 50];
        let vertices = random_vertices(&mut random, size, 40);
        let mut scene = Scene::new(size, PrimitiveTopology::PatchList, vertices);
        let domain = random.pick(&[D::Triangles, D::Quads]);
        let mode = TessellationMode {
            domain,
            ..TessellationMode::default()
        };
        let shader = Dividing {
            domain,
            inner: [3.0; 2],
            bend: 0.0,
            point_size: None,
        };
        scene.tessellation = Some((mode, 4, shader));
        scene.instances = 0..2;
        let _ = check(&scene, Some(&Emitting), seed);
    }
}
