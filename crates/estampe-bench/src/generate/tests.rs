//! Tests of each generator; the scenes' fingerprints are compared in `tests::fingerprints`.

use super::*;
use std::f64::consts::TAU;

#[test]
fn sine_and_cosine_agree_with_a_library() {
    for step in -4000..4000 {
        let turns = f64::from(step) / 1024.0;
        let (sine, cosine) = sin_cos_turns(turns);
        assert!((sine - libm_sin(turns)).abs() < 1e-12, "sine of {turns}");
        assert!(
            (cosine - libm_sin(turns + 0.25)).abs() < 1e-12,
            "cosine of {turns}"
        );
    }
    assert_eq!(sin_cos_turns(0.25), (1.0, 0.0));
}

fn libm_sin(turns: f64) -> f64 {
    libm::sin(turns * TAU)
}

#[test]
fn the_fingerprint_is_fnv_1a() {
    // Test vectors of the algorithm's authors.
    let of = |bytes: &[u8]| {
        let mut fingerprint = Fingerprint::default();
        fingerprint.update(bytes);
        fingerprint.value()
    };
    assert_eq!(of(b""), 0xCBF2_9CE4_8422_2325);
    assert_eq!(of(b"a"), 0xAF63_DC4C_8601_EC8C);
    assert_eq!(of(b"foobar"), 0x8594_4171_F739_67E8);
}

#[test]
fn a_sphere_is_closed_and_faces_outwards() {
    let mesh = uv_sphere(12, 7, |_, _| 1.0);
    let triangles = triangles(&mesh.indices);
    assert_eq!(triangles.len(), 2 * 12 * 6);
    for corners in triangles {
        let [a, b, c] = corners.map(|vertex| position(&mesh.vertices, vertex, 28));
        assert!(determinant(a, b, c) > 0.0, "{corners:?} faces inwards");
    }
}

#[test]
fn a_torus_faces_outwards_and_its_normals_stand_on_it() {
    let mesh = torus(24, 12);
    for corners in triangles(&mesh.indices) {
        let [a, b, c] = corners.map(|vertex| position(&mesh.vertices, vertex, 48));
        let normal = position(&mesh.vertices[12..], corners[0], 48);
        let [ab, ac] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
        assert!(
            determinant(normal, ab, ac) > 0.0,
            "{corners:?} faces inwards"
        );
        assert!((dot(normal, normal) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_look_at_matrix_puts_the_target_in_front() {
    let view = look_at([1.0, 2.0, 3.0], [4.0, 2.0, 3.0], [0.0, 1.0, 0.0]);
    let target = view.times(&Matrix::translation([4.0, 2.0, 3.0])).columns[3];
    let expected = [0.0, 0.0, -3.0, 1.0];
    for (got, expected) in target.iter().zip(expected) {
        assert!((got - expected).abs() < 1e-12, "{target:?}");
    }
}

#[test]
fn perspective_maps_near_to_zero_and_far_to_one() {
    let clip = perspective(0.25, 2.0, 0.5, 8.0);
    for (distance, depth) in [(0.5, 0.0), (8.0, 1.0)] {
        let [_, _, z, w] = clip
            .times(&Matrix::translation([0.0, 0.0, -distance]))
            .columns[3];
        assert!((z / w - depth).abs() < 1e-12);
    }
}

#[test]
fn textures_have_all_levels_and_tile() {
    let texture = diffuse_texture(256, 5);
    let sides: Vec<_> = texture.levels.iter().map(|level| level.len()).collect();
    let expected: Vec<_> = (0..=8).rev().map(|bits| 4 << (2 * bits)).collect();
    assert_eq!(sides, expected);
    // Level 1's first texel is the mean of the first two texels of the first two rows.
    let first = &texture.levels[0];
    let sum = [0, 4, 1024, 1028]
        .map(|at| u32::from(first[at]))
        .iter()
        .sum::<u32>();
    assert_eq!(u32::from(texture.levels[1][0]), (sum + 2) >> 2);
}

#[test]
fn normals_point_outwards_and_have_length_one() {
    for texel in normal_texture(256, 5).levels[0].chunks_exact(4) {
        let normal = [0, 1, 2].map(|k| (f64::from(texel[k]) - 127.5) / 127.5);
        assert!(normal[2] > 0.0);
        assert!((dot(normal, normal).sqrt() - 1.0).abs() < 0.02, "{texel:?}");
    }
}

fn triangles(indices: &[u8]) -> Vec<[u32; 3]> {
    let word = |at: usize| u32::from_le_bytes([0, 1, 2, 3].map(|k| indices[at + k]));
    (0..indices.len())
        .step_by(12)
        .map(|at| [word(at), word(at + 4), word(at + 8)])
        .collect()
}

fn position(vertices: &[u8], vertex: u32, stride: usize) -> [f64; 3] {
    [0, 4, 8].map(|at| {
        let start = vertex as usize * stride + at;
        f64::from(f32::from_le_bytes(
            [0, 1, 2, 3].map(|k| vertices[start + k]),
        ))
    })
}

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}
