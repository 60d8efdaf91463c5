//! Known values and properties of the transforms.

use super::projection::{DepthConvention, Frustum};
use super::view::CameraFrame;
use super::viewport::ViewportRectangle;
use super::*;
use glam::{DVec2, DVec4};
use std::f64::consts::{FRAC_PI_2, PI};

fn close(a: DVec3, b: DVec3) {
    assert!(
        (a - b).length() < 1e-12 * (1.0 + b.length()),
        "{a} is not {b}"
    );
}

#[test]
fn rotations_are_counter_clockwise_and_keep_lengths() {
    let quarter = affine::rotation(DVec3::Z * 7.0, FRAC_PI_2);
    close(transform_vector(&quarter, DVec3::X), DVec3::Y);
    let about = affine::rotation_about(DVec3::new(1.0, 0.0, 0.0), DVec3::Z, PI);
    close(
        transform_point(&about, DVec3::ZERO),
        DVec3::new(2.0, 0.0, 0.0),
    );
    close(transform_vector(&about, DVec3::X), -DVec3::X);
    let axis = DVec3::new(1.0, -2.0, 0.5);
    let odd = affine::rotation(axis, 1.234);
    close(transform_vector(&odd, axis), axis);
    let m = glam::DMat3::from_mat4(odd);
    assert!((m.determinant() - 1.0).abs() < 1e-14);
    assert!((m * m.transpose()).abs_diff_eq(glam::DMat3::IDENTITY, 1e-14));
    assert_eq!(affine::rotation(DVec3::ZERO, 1.0), DMat4::IDENTITY);
}

#[test]
fn the_smallest_rotation_turns_z_up_to_y_up_exactly() {
    let world_from_file = affine::rotation_between(DVec3::Z, DVec3::Y);
    let p = DVec3::new(0.1, 0.2, 0.3);
    assert_eq!(
        transform_vector(&world_from_file, p),
        DVec3::new(0.1, 0.3, -0.2)
    );
    assert_eq!(
        affine::rotation_between(DVec3::Y, DVec3::Y),
        DMat4::IDENTITY
    );
    for (from, to) in [
        (DVec3::Y, -DVec3::Y),
        (DVec3::X, -DVec3::X),
        (DVec3::new(1.0, 2.0, 3.0), DVec3::Y),
        (DVec3::new(1e-9, -1.0, 0.0), DVec3::Y),
    ] {
        let m = affine::rotation_between(from, to);
        close(transform_vector(&m, from.normalize()), to);
        assert!(
            (glam::DMat3::from_mat4(m).determinant() - 1.0).abs() < 1e-9,
            "{from} to {to}"
        );
    }
}

#[test]
fn products_do_not_commute_and_points_are_not_vectors() {
    let t = affine::translation(DVec3::X);
    let s = affine::scale(DVec3::splat(2.0));
    assert_eq!(
        transform_point(&(t * s), DVec3::ONE),
        DVec3::new(3.0, 2.0, 2.0)
    );
    assert_eq!(
        transform_point(&(s * t), DVec3::ONE),
        DVec3::new(4.0, 2.0, 2.0)
    );
    assert_eq!(transform_vector(&t, DVec3::ONE), DVec3::ONE);
    let trs = affine::compose(
        DVec3::X,
        affine::rotation(DVec3::Z, FRAC_PI_2),
        DVec3::splat(3.0),
    );
    close(transform_point(&trs, DVec3::X), DVec3::new(1.0, 3.0, 0.0));
    let sheared = transform_point(&affine::shear(DVec3::X * 2.0, DVec3::Y), DVec3::ONE);
    assert_eq!(sheared, DVec3::new(3.0, 1.0, 1.0));
}

#[test]
fn transforms_in_the_plane_have_the_same_forms() {
    let p = DVec3::new(2.0, 1.0, 1.0);
    assert_eq!(
        affine::scale_2d(DVec2::new(2.0, 3.0)) * p,
        DVec3::new(4.0, 3.0, 1.0)
    );
    assert_eq!(
        affine::translation_2d(DVec2::new(1.0, 1.0)) * p,
        DVec3::new(3.0, 2.0, 1.0)
    );
    assert_eq!(
        affine::shear_2d(DVec2::new(2.0, 0.0)) * p,
        DVec3::new(4.0, 1.0, 1.0)
    );
    let turned = affine::rotation_2d(DVec2::new(1.0, 1.0), FRAC_PI_2) * p;
    close(turned, DVec3::new(1.0, 2.0, 1.0));
}

#[test]
fn normals_stay_perpendicular_under_uneven_scale_and_reflection() {
    let uneven = affine::scale(DVec3::new(1.0, 4.0, 1.0));
    let mirror = affine::scale(DVec3::new(-1.0, 1.0, 1.0));
    let odd = affine::shear(DVec3::new(0.3, 0.0, 1.0), DVec3::Y) * uneven;
    let (tangent, normal) = (
        DVec3::new(1.0, -1.0, 0.0),
        DVec3::new(1.0, 1.0, 0.0).normalize(),
    );
    for m in [uneven, mirror, odd, odd * mirror] {
        let moved = normals::transform_normal(&m, normal);
        assert!((moved.length() - 1.0).abs() < 1e-14);
        assert!(
            moved.dot(transform_vector(&m, tangent)).abs() < 1e-13,
            "{m}"
        );
        // The normal still points to the same side of the tangent plane.
        assert!(moved.dot(transform_vector(&m, normal)) > 0.0, "{m}");
    }
    let flattened = affine::scale(DVec3::new(1.0, 0.0, 1.0));
    close(normals::transform_normal(&flattened, DVec3::Y), DVec3::Y);
}

#[test]
fn the_view_inverts_the_camera() {
    let eye = DVec3::new(3.0, 2.0, 5.0);
    let centre = DVec3::new(0.5, -0.5, 1.0);
    let frame = CameraFrame::look_at(eye, centre, DVec3::Y);
    let product = frame.view_from_world() * frame.world_from_view();
    assert!(product.abs_diff_eq(DMat4::IDENTITY, 1e-14));
    let seen = transform_point(&frame.view_from_world(), centre);
    close(seen, DVec3::new(0.0, 0.0, -(eye - centre).length()));
    let centred = frame.centred_view_from_world(centre);
    close(transform_point(&centred, centre), DVec3::ZERO);
    close(
        transform_point(&centred, eye),
        DVec3::new(0.0, 0.0, (eye - centre).length()),
    );
    // Degenerate inputs still give a right-handed orthonormal frame.
    for (eye, up) in [
        (DVec3::Y, DVec3::Y),
        (DVec3::ZERO, DVec3::ZERO),
        (DVec3::Z, -DVec3::Z),
    ] {
        let f = CameraFrame::look_at(eye, DVec3::ZERO, up);
        close(f.right_world.cross(f.up_world), f.back_world);
        assert!((f.right_world.length() - 1.0).abs() < 1e-14);
    }
}

#[test]
fn projections_put_the_planes_where_the_convention_says() {
    let off_centre = Frustum {
        left: -1.0,
        right: 3.0,
        bottom: -2.0,
        top: 1.0,
        near: 2.0,
        far: 9.0,
    };
    for convention in [
        DepthConvention::ZeroToOne,
        DepthConvention::MinusOneToOne,
        DepthConvention::Reversed,
    ] {
        let (near_depth, far_depth) = convention.near_far();
        for m in [
            projection::frustum(&off_centre, convention),
            projection::orthographic(&off_centre, convention),
        ] {
            close(
                transform_point(&m, DVec3::new(3.0, 1.0, -2.0)),
                DVec3::new(1.0, 1.0, near_depth),
            );
            close(
                transform_point(&m, DVec3::new(-1.0, -2.0, -2.0)),
                DVec3::new(-1.0, -1.0, near_depth),
            );
            assert!((transform_point(&m, DVec3::new(0.0, 0.0, -9.0)).z - far_depth).abs() < 1e-14);
        }
        let endless = Frustum {
            far: f64::INFINITY,
            ..off_centre
        };
        let m = projection::frustum(&endless, convention);
        assert!((transform_point(&m, DVec3::new(0.0, 0.0, -2.0)).z - near_depth).abs() < 1e-14);
        assert!((transform_point(&m, DVec3::new(0.0, 0.0, -1e15)).z - far_depth).abs() < 1e-12);
    }
    let m = projection::perspective(FRAC_PI_2, 2.0, 1.0, 10.0, DepthConvention::ZeroToOne);
    close(
        transform_point(&m, DVec3::new(6.0, 3.0, -3.0)).with_z(0.0),
        DVec3::new(1.0, 1.0, 0.0),
    );
    let m =
        projection::perspective_horizontal(FRAC_PI_2, 2.0, 1.0, 10.0, DepthConvention::ZeroToOne);
    close(
        transform_point(&m, DVec3::new(3.0, 1.5, -3.0)).with_z(0.0),
        DVec3::new(1.0, 1.0, 0.0),
    );
}

#[test]
fn central_projections_agree_with_their_formulas() {
    let p = DVec3::new(1.0, 2.0, -3.0);
    let h = projection::central_teaching(4.0) * p.extend(1.0);
    assert_eq!(h, DVec4::new(1.0, 2.0, -3.0, 1.75));
    let m = projection::central(4.0, 1.0, -3.0);
    assert!(transform_point(&m, DVec3::new(0.0, 0.0, 1.0)).z.abs() < 1e-15);
    assert!((transform_point(&m, DVec3::new(0.0, 0.0, -3.0)).z - 1.0).abs() < 1e-15);
    assert_eq!((m * p.extend(1.0)).w, 1.75);
    let parallel = projection::central(f64::INFINITY, 1.0, -3.0);
    close(transform_point(&parallel, p), DVec3::new(1.0, 2.0, 1.0));
}

#[test]
fn viewports_map_the_corners() {
    let v = ViewportRectangle {
        x: 10.0,
        y: 20.0,
        width: 100.0,
        height: 50.0,
        depth_min: 0.25,
        depth_max: 0.75,
    };
    let m = viewport::window_from_ndc(&v);
    close(
        transform_point(&m, DVec3::new(-1.0, 1.0, 0.0)),
        DVec3::new(10.0, 20.0, 0.25),
    );
    close(
        transform_point(&m, DVec3::new(1.0, -1.0, 1.0)),
        DVec3::new(110.0, 70.0, 0.75),
    );
    let m = viewport::window_from_ndc_teaching(640.0, 480.0);
    close(
        transform_point(&m, DVec3::new(-1.0, -1.0, 0.3)),
        DVec3::new(-0.5, -0.5, 0.3),
    );
    close(
        transform_point(&m, DVec3::new(1.0, 1.0, 0.3)),
        DVec3::new(639.5, 479.5, 0.3),
    );
    let m = viewport::window_from_ndc_zoomed(640.0, 480.0, 2.0);
    close(
        transform_point(&m, DVec3::new(0.5, -0.5, -1.0)),
        DVec3::new(639.5, -0.5, 0.0),
    );
}
