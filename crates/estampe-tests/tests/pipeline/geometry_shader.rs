//! Geometry shaders through the pipeline, against the oracle.

use estampe_tests::Random;
use estampe_tests::amplification::{Emitting, Scene};
use estampe_tests::fast_path::{all_devices, name};
use estampe_tests::geometry::{Vertex, clip_at};
use estampe_types::IndexFormat;
use estampe_types::shader::GeometryShader;
use estampe_types::state::{PrimitiveTopology as T, ProvokingVertex};

fn random_vertices(random: &mut Random, size: [u32; 2], count: usize) -> Vec<Vertex> {
    let mut vertex = || {
        let at = [
            random.range(0.0, size[0] as f32),
            random.range(0.0, size[1] as f32),
        ];
        Vertex {
            position: clip_at(size, at, random.range(0.1, 0.9), random.range(0.5, 2.0)),
            values: random.four(0.0, 1.0),
        }
    };
    (0..count).map(|_| vertex()).collect()
}

/// Draws random primitives of some topologies on every device, and compares the images with the
/// oracle's.
fn check<G: GeometryShader + Clone>(topic: &str, shader: &G, topologies: &[T]) {
    let mut random = Random::new(topic, 1);
    let mut restarted = 0;
    for &topology in topologies {
        for round in 0..3 {
            let size = [40, 30];
            let count = 7 + random.index(60);
            let mut scene = Scene::new(size, topology, random_vertices(&mut random, size, count));
            scene.instances = 0..1 + random.below(3);
            scene.primitive.provoking_vertex =
                random.pick(&[ProvokingVertex::First, ProvokingVertex::Last]);
            if round > 0 {
                let most = u32::try_from(count).unwrap();
                let mut index = || match random.below(14) {
                    0 => u16::MAX,
                    _ => u16::try_from(random.below(most)).unwrap(),
                };
                let indices: Vec<u16> = (0..count * 2).map(|_| index()).collect();
                let bytes: Vec<u8> = indices.iter().flat_map(|at| at.to_le_bytes()).collect();
                scene.elements = 2..u32::try_from(indices.len()).unwrap() + 5;
                scene.indices = Some((IndexFormat::Uint16, bytes));
                scene.primitive.primitive_restart = round == 2;
                restarted += u32::from(round == 2);
                scene.base_vertex = random.pick(&[0, 1, -3]);
            }
            let (wanted, primitives) = scene.draw_by_oracle(Some(shader));
            assert!(primitives > 0, "{topic}: {topology:?} makes primitives");
            let history = scene.inspect_one(all_devices()[round], Some(shader), &wanted);
            assert!(!history.primitives.is_empty(), "{topic}: {topology:?}");
            for device in all_devices() {
                let (image, statistics) = scene.draw(device, Some(shader));
                let on = name(device);
                assert_eq!(statistics.geometry_primitives, primitives, "{topic}, {on}");
                assert_eq!(statistics.primitives_in, primitives, "{topic}, {on}");
                assert!(
                    image == wanted,
                    "{topic}, {on} draws another image: {scene:?}"
                );
            }
        }
    }
    assert_eq!(restarted as usize, topologies.len());
}

/// Points become triangle strips of up to 256 vertices; strips are ended where lanes differ.
///
/// Rows: V4
#[test]
fn points_become_256_vertices() {
    check("points", &Emitting::<0, 2, 256, 1>, &[T::PointList]);
}

/// Lines become line strips, in three invocations.
///
/// Rows: V4
#[test]
fn lines_become_lines_in_several_invocations() {
    let topologies = [T::LineList, T::LineStrip, T::LineLoop];
    check("lines", &Emitting::<1, 1, 7, 3>, &topologies);
}

/// Triangles of lists, strips and fans, with restarts, become triangle strips, in two invocations.
///
/// Rows: V4
#[test]
fn triangles_become_triangles() {
    let topologies = [T::TriangleList, T::TriangleStrip, T::TriangleFan];
    check("triangles", &Emitting::<2, 2, 9, 2>, &topologies);
}

/// Lines with adjacency become points.
///
/// Rows: V4
#[test]
fn lines_with_adjacency_become_points() {
    let topologies = [T::LineListAdjacency, T::LineStripAdjacency];
    check("line_adjacency", &Emitting::<3, 0, 6, 1>, &topologies);
}

/// Triangles with adjacency become line strips.
///
/// Rows: V4
#[test]
fn triangles_with_adjacency_become_lines() {
    let topologies = [T::TriangleListAdjacency, T::TriangleStripAdjacency];
    check("triangle_adjacency", &Emitting::<4, 1, 12, 1>, &topologies);
}
