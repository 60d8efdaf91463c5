//! Vectors and matrices, by hand. Numbers that are powers of two apart reveal the order of sums.

use super::super::*;

/// 2²⁴: adding 1 to it is lost.
const LARGE: f32 = 16_777_216.0;

/// Rows: F1.
#[test]
fn products_of_vectors_are_summed_from_the_first_component_on() {
    let (a, b) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-4.0, 5.0, 7.0));
    assert_eq!(a.dot(b), 27.0);
    assert_eq!(a.dot_uniform([-4.0, 5.0, 7.0]), 27.0);
    assert_eq!(a.cross(b), Vec3::new(-1.0, -19.0, 13.0));
    assert_eq!(a + b, Vec3::new(-3.0, 7.0, 10.0));
    assert_eq!(a - b, Vec3::new(5.0, -3.0, -4.0));
    assert_eq!(a * b, Vec3::new(-4.0, 10.0, 21.0));
    assert_eq!(b / a, Vec3::new(-4.0, 2.5, 7.0 / 3.0));
    assert_eq!(a * 2.0, Vec3::new(2.0, 4.0, 6.0));
    assert_eq!(-a, Vec3::new(-1.0, -2.0, -3.0));
    assert_eq!(a.min(b), Vec3::new(-4.0, 2.0, 3.0));
    assert_eq!(a.max(b), Vec3::new(1.0, 5.0, 7.0));
    assert_eq!(a.mix(b, 0.5), Vec3::new(-1.5, 3.5, 5.0));
    assert_eq!(a.point(), Vec4::new(1.0, 2.0, 3.0, 1.0));
    assert_eq!(a.extend(9.0).xyz(), a);
    // (2²⁴ + 1) − 2²⁴ is 0, (1 − 2²⁴) + 2²⁴ is 1.
    let one = Vec3::new(1.0, 1.0, 1.0);
    assert_eq!(Vec3::new(LARGE, 1.0, -LARGE).dot(one), 0.0);
    assert_eq!(Vec3::new(1.0, -LARGE, LARGE).dot(one), 1.0);
    let four = Vec4::new(1.0, -LARGE, LARGE, 2.0);
    assert_eq!(four.dot(Vec4::repeat(1.0)), 3.0);
}

/// Rows: F1.
#[test]
fn lengths_directions_and_mirror_images_by_hand() {
    let v = Vec2::new(3.0, 4.0);
    assert_eq!(v.length(), 5.0);
    // One reciprocal, then products.
    let fifth = 1.0 / 5.0_f32;
    assert_eq!(v.normalize(), Vec2::new(3.0 * fifth, 4.0 * fifth));
    let up = Vec3::new(0.0, 1.0, 0.0);
    let falling = Vec3::new(1.0, -1.0, 0.5);
    assert_eq!(falling.reflect(up), Vec3::new(1.0, 1.0, 0.5));
    assert_eq!(Vec2::select(true, v, -v), v);
    assert_eq!(Vec2::uniform(0.0, [8.0, 9.0]), Vec2::new(8.0, 9.0));
}

/// Rows: V1.
#[test]
fn matrices_are_columns() {
    let matrix = Mat4([
        [1.0, 2.0, 3.0, 4.0],
        [10.0, 20.0, 30.0, 40.0],
        [100.0, 200.0, 300.0, 400.0],
        [1000.0, 2000.0, 3000.0, 4000.0],
    ]);
    let v = Vec3::new(1.0, 2.0, 3.0);
    assert_eq!(
        matrix * v.extend(4.0),
        Vec4::new(4321.0, 8642.0, 12_963.0, 17_284.0)
    );
    assert_eq!(
        matrix.transform_point(v),
        Vec4::new(1321.0, 2642.0, 3963.0, 5284.0)
    );
    assert_eq!(matrix.transform_vector(v), Vec3::new(321.0, 642.0, 963.0));
    assert_eq!(Mat4::IDENTITY * v.point(), v.point());
    // Sums begin at the first column: (1 − 2²⁴) + 2²⁴ = 1, and 2 is added to that.
    let order = Mat4([[1.0; 4], [-LARGE; 4], [LARGE; 4], [2.0; 4]]);
    assert_eq!((order * Vec4::repeat(1.0)).x, 3.0);
    assert_eq!(order.transform_point(Vec3::repeat(1.0)).y, 3.0);
}
