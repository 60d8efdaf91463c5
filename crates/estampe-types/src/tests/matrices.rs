//! Products, inverses, transforms and projections.

use crate::{Mat2, Mat3, Mat4, Quad, Real, Vec3, Vec4, vec2, vec3, vec4};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_3};

const M: Mat4 = Mat4([
    [2.0, 1.0, 0.0, 0.0],
    [-1.0, 3.0, 1.0, 0.0],
    [0.5, 0.0, 4.0, 0.25],
    [1.0, 2.0, 3.0, 1.0],
]);

fn near(a: Mat4, b: Mat4) {
    for (a, b) in a.0.iter().flatten().zip(b.0.iter().flatten()) {
        assert!((a - b).abs() <= 2e-6, "{a} is not {b}");
    }
}

/// NDC of a point in view space.
fn ndc(m: Mat4, p: [f32; 3]) -> [f32; 3] {
    let clip = m.transform_point(Vec3::from(p));
    (clip.xyz() / clip.w).into()
}

fn close(a: [f32; 3], b: [f32; 3]) {
    let distance = (Vec3::from(a) - Vec3::from(b)).length();
    assert!(distance < 2e-6, "{a:?} is not {b:?}");
}

#[test]
fn products_are_sums_of_columns() {
    let v = vec4(1.0, -2.0, 0.5, 3.0);
    let [x, y, z, w] = M.columns();
    assert_eq!(M * v, x * v.x + y * v.y + z * v.z + w * v.w);
    assert_eq!(
        (M * Mat4::rotation_x(0.5)).columns()[2],
        M * Mat4::rotation_x(0.5).columns()[2]
    );
    let m = Mat2([[1.0, 2.0], [3.0, 4.0]]);
    assert_eq!(m * vec2(1.0, 1.0), vec2(4.0, 6.0));
    assert_eq!(m * m, Mat2([[7.0, 10.0], [15.0, 22.0]]));
    assert_eq!(m.transpose(), Mat2([[1.0, 3.0], [2.0, 4.0]]));
    assert_eq!(
        Mat3::IDENTITY * 2.0 * vec3(1.0, 2.0, 3.0),
        vec3(2.0, 4.0, 6.0)
    );
    assert_eq!(
        M.transform_vector(vec3(1.0, 0.0, 0.0)),
        M.to_mat3().columns()[0]
    );
}

#[test]
fn matrices_of_lanes_multiply_constants_and_lanes() {
    fn turned<R: Real>(x: R, m: &Mat4) -> Vec3<R> {
        let frame = Mat3::from_columns(vec3(x, 0.0, 0.0), vec3(0.0, x, 1.0), vec3(1.0, 0.0, x));
        frame * vec3(1.0, 2.0, 3.0) + m.to_mat3() * (frame * vec3(x, 0.0, 1.0))
    }
    let one = turned(0.5, &M);
    let quad = turned(Quad([0.5; 4]), &M);
    assert_eq!(
        [quad.x, quad.y, quad.z],
        [one.x, one.y, one.z].map(|value| Quad([value; 4]))
    );
}

#[test]
fn determinants_and_inverses() {
    assert_eq!(Mat2([[1.0, 2.0], [3.0, 4.0]]).determinant(), -2.0);
    assert_eq!(Mat4::scale([2.0, 3.0, 4.0]).determinant(), 24.0);
    // By expansion along the last row, which is (0, 0, ¼, 1).
    let [x, y, z, w] = M.columns().map(Vec4::xyz);
    let minor = |a, b, c| Mat3::from_columns(a, b, c).determinant();
    assert!((M.determinant() - (minor(x, y, z) - 0.25 * minor(x, y, w))).abs() < 1e-4);
    near(M * M.inverse().unwrap(), Mat4::IDENTITY);
    near(M.inverse().unwrap() * M, Mat4::IDENTITY);
    let m = M.to_mat3();
    let product = m * m.inverse().unwrap();
    assert!((product.determinant() - 1.0).abs() < 1e-6);
    let zero_pivot = Mat2([[0.0, 1.0], [1.0, 0.0]]);
    assert_eq!(zero_pivot.inverse(), Some(zero_pivot));
    assert_eq!(Mat4::scale([1.0, 0.0, 1.0]).inverse(), None);
    assert_eq!(Mat2([[1.0, 2.0], [2.0, 4.0]]).inverse(), None);
    assert_eq!(Mat2([[f32::NAN, 2.0], [2.0, 4.0]]).inverse(), None);
    assert_eq!(Mat2([[f32::INFINITY, 2.0], [2.0, 4.0]]).inverse(), None);
    assert_eq!(
        Mat2([[1e-40, 0.0], [0.0, 1.0]]).inverse(),
        None,
        "an infinite inverse"
    );
}

#[test]
fn the_inverse_of_a_distant_camera_is_exact() {
    let view = Mat4::look_at([1e4, 2e4, -3e4], [1e4, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let eye = view.inverse().unwrap() * vec4(0.0, 0.0, 0.0, 1.0);
    assert!((eye - vec4(1e4, 2e4, -3e4, 1.0)).length() < 0.02, "{eye:?}");
}

#[test]
fn rotations_turn_from_one_axis_to_the_next() {
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let turned = |m: Mat4, v: [f32; 3]| m.transform_vector(Vec3::from(v)).into();
    close(turned(Mat4::rotation_x(FRAC_PI_2), y), z);
    close(turned(Mat4::rotation_y(FRAC_PI_2), z), x);
    close(turned(Mat4::rotation_z(FRAC_PI_2), x), y);
    near(Mat4::rotation(x, 0.7), Mat4::rotation_x(0.7));
    near(Mat4::rotation([0.0, 3.0, 0.0], 0.7), Mat4::rotation_y(0.7));
    near(Mat4::rotation(z, 0.7), Mat4::rotation_z(0.7));
    close(turned(Mat4::rotation([1.0; 3], 2.0 * FRAC_PI_3), x), y);
    assert_eq!(Mat4::rotation([1.0, 2.0, 3.0], 0.0), Mat4::IDENTITY);
    assert_eq!(
        Mat4::translation(x).transform_point(Vec3::from(y)),
        vec4(1.0, 1.0, 0.0, 1.0)
    );
    assert_eq!(
        Mat4::translation(x).transform_vector(Vec3::from(y)),
        Vec3::from(y)
    );
}

#[test]
fn cameras_look_down_negative_z() {
    let view = Mat4::look_at([1.0, 2.0, 3.0], [4.0, 6.0, 3.0], [0.0, 0.0, 1.0]);
    let seen = |p: [f32; 3]| view.transform_point(Vec3::from(p)).xyz().into();
    close(seen([1.0, 2.0, 3.0]), [0.0; 3]);
    close(seen([4.0, 6.0, 3.0]), [0.0, 0.0, -5.0]);
    close(seen([1.0, 2.0, 4.0]), [0.0, 1.0, 0.0]);
    assert!((view.determinant() - 1.0).abs() < 1e-6, "right-handed");
    assert_eq!(
        view,
        Mat4::look_along([1.0, 2.0, 3.0], [3.0, 4.0, 0.0], [0.0, 0.0, 1.0])
    );
}

#[test]
fn perspectives_put_depth_where_they_say() {
    // The top of the view at distance 2: 2·tan 30°.
    let (fov, aspect, top) = (FRAC_PI_3, 2.0, 1.154_700_5);
    let at = |m, z: f32| ndc(m, [0.0, 0.0, -z])[2];
    let all = [
        (Mat4::perspective(fov, aspect, 0.5, 8.0), 0.0, 1.0),
        (Mat4::perspective_reversed(fov, aspect, 0.5, 8.0), 1.0, 0.0),
        (Mat4::perspective_gl(fov, aspect, 0.5, 8.0), -1.0, 1.0),
    ];
    for (m, near, far) in all {
        assert!(
            (at(m, 0.5) - near).abs() < 1e-6 && (at(m, 8.0) - far).abs() < 1e-6,
            "{m:?}"
        );
        close(
            [
                ndc(m, [2.0 * top, top, -2.0])[0],
                ndc(m, [0.0, top, -2.0])[1],
                0.0,
            ],
            [1.0, 1.0, 0.0],
        );
        assert_eq!((m * vec4(0.0, 0.0, -3.0, 1.0)).w, 3.0);
    }
    near(Mat4::ZERO_TO_ONE_FROM_GL * all[2].0, all[0].0);
    let infinite = Mat4::perspective_infinite(fov, aspect, 0.5);
    let reversed = Mat4::perspective_infinite_reversed(fov, aspect, 0.5);
    assert_eq!((at(infinite, 0.5), at(infinite, 1e10)), (0.0, 1.0));
    assert_eq!((at(reversed, 0.5), at(reversed, 5e8)), (1.0, 1e-9));
}

#[test]
fn frusta_and_boxes_have_their_corners() {
    let near_corner = [-1.0, 2.0, -0.5];
    let far_corner = [48.0, -16.0, -8.0];
    let frustum = Mat4::frustum(-1.0, 3.0, -1.0, 2.0, 0.5, 8.0);
    close(ndc(frustum, near_corner), [-1.0, 1.0, 0.0]);
    close(ndc(frustum, far_corner), [1.0, -1.0, 1.0]);
    let gl = Mat4::frustum_gl(-1.0, 3.0, -1.0, 2.0, 0.5, 8.0);
    close(ndc(gl, near_corner), [-1.0, 1.0, -1.0]);
    close(ndc(gl, far_corner), [1.0, -1.0, 1.0]);
    let far_corner = [3.0, -1.0, -8.0];
    for (m, near, far) in [
        (Mat4::orthographic(-1.0, 3.0, -1.0, 2.0, 0.5, 8.0), 0.0, 1.0),
        (
            Mat4::orthographic_reversed(-1.0, 3.0, -1.0, 2.0, 0.5, 8.0),
            1.0,
            0.0,
        ),
        (
            Mat4::orthographic_gl(-1.0, 3.0, -1.0, 2.0, 0.5, 8.0),
            -1.0,
            1.0,
        ),
    ] {
        close(ndc(m, near_corner), [-1.0, 1.0, near]);
        close(ndc(m, far_corner), [1.0, -1.0, far]);
    }
}

#[test]
fn the_layout_is_that_of_glam() {
    let theirs = glam::Mat4::from_cols_array_2d(&M.0);
    assert_eq!(Mat4::from(theirs), M);
    let v = theirs * glam::Vec4::new(1.0, -2.0, 0.5, 3.0);
    assert_eq!(
        <[f32; 4]>::from(M * vec4(1.0, -2.0, 0.5, 3.0)),
        v.to_array()
    );
    near(
        Mat4::rotation([1.0, 2.0, 2.0], 0.9),
        glam::Mat4::from_axis_angle(glam::Vec3::new(1.0, 2.0, 2.0) / 3.0, 0.9).into(),
    );
    let columns: [[f32; 4]; 4] = M.into();
    assert_eq!(Mat4::from(columns), M);
}
