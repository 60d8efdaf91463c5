//! Known values and properties of the transforms in f64, and the pipeline's own viewport transform
//! against the matrix that documents it.

use crate::support::{devices, texture};
use estampe::state::Viewport;
use estampe::transforms::projection::{DepthConvention, Frustum};
use estampe::transforms::view::CameraFrame;
use estampe::transforms::viewport::ViewportRectangle;
use estampe::transforms::{
    DMat3, DMat4, DVec2, DVec3, DVec4, affine, normals, projection, round_to_f32, to_f32,
    transform_point, transform_vector, viewport,
};
use estampe::{
    ColorAttachment, Draw, FragmentIn, FragmentOut, Mat4, RenderPass, RenderPipelineDescriptor,
    TextureFormat, Vec4, VertexFormat, VertexIn, VertexOut, state::VertexBufferLayout,
};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

fn close(a: DVec3, b: DVec3) {
    assert!(
        (a - b).length() < 1e-12 * (1.0 + b.length()),
        "{a} is not {b}"
    );
}

/// Rows: X1.
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
    let m = DMat3::from_mat4(odd);
    assert!((m.determinant() - 1.0).abs() < 1e-14);
    assert!((m * m.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-14));
    assert_eq!(affine::rotation(DVec3::ZERO, 1.0), DMat4::IDENTITY);
}

/// Rodrigues' formula in the form for one vector, v·c + (d·v)·d·(1 − c) + (d × v)·s, about axes
/// that do not pass through the origin.
///
/// Rows: X1.
#[test]
fn rotations_about_any_axis_are_those_of_rodrigues() {
    let p = DVec3::new(-0.7, 2.0, 0.3);
    for (through, direction, angle) in [
        (DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 1.0, 0.0), 0.3),
        (DVec3::new(-4.0, 0.5, 9.0), DVec3::new(0.2, -3.0, 1.5), 2.5),
        (DVec3::new(0.0, -8.0, 0.0), DVec3::new(-1.0, 0.1, 0.1), -1.0),
    ] {
        let (s, c) = libm::sincos(angle);
        let d = direction.normalize();
        let turned = |v: DVec3| v * c + d * (d.dot(v) * (1.0 - c)) + d.cross(v) * s;
        let m = affine::rotation_about(through, direction, angle);
        close(transform_point(&m, p), through + turned(p - through));
        close(transform_vector(&m, p), turned(p));
        // The axis stays where it is.
        let on_axis = through + direction * 1.7;
        close(transform_point(&m, on_axis), on_axis);
        // The matrices of f32 have the same directions.
        let [x, y, z] = direction.to_array().map(round_to_f32);
        let single = Mat4::rotation([x, y, z], round_to_f32(angle));
        let double = Mat4::from(to_f32(&affine::rotation(direction, angle)));
        let elements = single.0.iter().flatten().zip(double.0.iter().flatten());
        for (a, b) in elements {
            assert!((a - b).abs() < 1e-6, "{single:?} is not {double:?}");
        }
    }
}

/// Rows: X1.
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
            (DMat3::from_mat4(m).determinant() - 1.0).abs() < 1e-9,
            "{from} to {to}"
        );
    }
}

/// Rows: X1.
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

/// Rows: X1.
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
    let quarter = affine::rotation_2d(DVec2::new(1.0, 1.0), FRAC_PI_2);
    close(quarter * p, DVec3::new(1.0, 2.0, 1.0));
    // Vectors have w = 0: they are turned, and not moved.
    close(quarter * DVec3::X, DVec3::Y);
    assert_eq!(
        affine::translation_2d(DVec2::new(5.0, 7.0)) * DVec3::X,
        DVec3::X
    );
    // Scaled first, then moved; and the other way round.
    let (t, s) = (
        affine::translation_2d(DVec2::X),
        affine::scale_2d(DVec2::splat(2.0)),
    );
    assert_eq!(t * s * p, DVec3::new(5.0, 2.0, 1.0));
    assert_eq!(s * t * p, DVec3::new(6.0, 2.0, 1.0));
}

/// Rows: X2.
#[test]
fn normals_stay_perpendicular_under_uneven_scale_and_reflection() {
    let uneven = affine::scale(DVec3::new(1.0, 4.0, 1.0));
    let mirror = affine::scale(DVec3::new(-1.0, 1.0, 1.0));
    let odd = affine::shear(DVec3::new(0.3, 0.0, 1.0), DVec3::Y) * uneven;
    let (tangent, normal) = (
        DVec3::new(1.0, -1.0, 0.0),
        DVec3::new(1.0, 1.0, 0.0).normalize(),
    );
    // The model matrix itself bends the normal: the mistake that this row is about.
    let wrong = transform_vector(&uneven, normal);
    assert!(wrong.dot(transform_vector(&uneven, tangent)).abs() > 1.0);
    for m in [uneven, mirror, odd, odd * mirror] {
        let by_inverse = DMat3::from_mat4(m).inverse().transpose() * normal;
        close(
            normals::transform_normal(&m, normal),
            by_inverse.normalize(),
        );
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

/// Rows: X3.
#[test]
fn the_view_inverts_the_camera() {
    let eye = DVec3::new(3.0, 2.0, 5.0);
    let centre = DVec3::new(0.5, -0.5, 1.0);
    let frame = CameraFrame::look_at(eye, centre, DVec3::Y);
    // The frame by its formulas.
    let back = (eye - centre).normalize();
    close(frame.back_world, back);
    close(frame.right_world, DVec3::Y.cross(back).normalize());
    close(frame.up_world, back.cross(frame.right_world));
    assert_eq!(frame.eye_world, eye);
    assert!(
        frame
            .view_from_world()
            .abs_diff_eq(frame.world_from_view().inverse(), 1e-14)
    );
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

/// Rows: X4.
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
    // The two angles of one frustum: tan(x/2) = aspect · tan(y/2).
    let fov_x = 2.0 * libm::atan(1.5 * libm::tan(FRAC_PI_3 / 2.0));
    for convention in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
        for far in [10.0, f64::INFINITY] {
            let by_y = projection::perspective(FRAC_PI_3, 1.5, 0.1, far, convention);
            let by_x = projection::perspective_horizontal(fov_x, 1.5, 0.1, far, convention);
            assert!(by_y.abs_diff_eq(by_x, 1e-14), "{by_y} is not {by_x}");
        }
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

/// Rows: X4.
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

/// Rows: X5.
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

/// A triangle whose fragments write their position in the window.
struct Positions;

estampe::shader! {
    impl Shader for Positions {
        type Attributes<R: Real> = Vec4<R>; // position in clip space
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, position: Vec4<R>) -> VertexOut<R, ()> {
            VertexOut::new(position, ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _: ()) -> FragmentOut<R> {
            FragmentOut::color(input.position)
        }
    }
}

/// The pipeline puts NDC where the matrix of `viewport` puts them, depth included.
///
/// Rows: X5.
#[test]
fn the_pipeline_has_the_viewport_of_the_matrix() {
    // NDC z is a plane over the triangle, so the depth of a pixel follows from its x and y.
    let depth = |x: f64, y: f64| 0.5 + 0.25 * x - 0.125 * y;
    let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)].map(|(x, y)| {
        let z = depth(x, y);
        [x, y, z, 1.0].map(round_to_f32)
    });
    for v in [
        ViewportRectangle {
            x: 8.0,
            y: 4.0,
            width: 32.0,
            height: 16.0,
            depth_min: 0.25,
            depth_max: 0.75,
        },
        ViewportRectangle {
            x: -10.5,
            y: 3.25,
            width: 80.0,
            height: 20.5,
            depth_min: 1.0,
            depth_max: 0.0,
        },
    ] {
        let ndc_from_window = viewport::window_from_ndc(&v).inverse();
        for (name, device) in devices() {
            let image = texture(&device, [48, 24], TextureFormat::Rgba32Float);
            let vertices = device
                .create_buffer_with_contents(estampe::bytes_of(&corners))
                .unwrap();
            let pipeline = device
                .create_render_pipeline(&RenderPipelineDescriptor {
                    vertex_buffers: vec![VertexBufferLayout::packed(&[VertexFormat::Float32x4])],
                    depth_stencil: None,
                    targets: vec![Some(image.format().into())],
                    ..RenderPipelineDescriptor::new(Positions)
                })
                .unwrap();
            let [x, y, width, height, min_depth, max_depth] =
                [v.x, v.y, v.width, v.height, v.depth_min, v.depth_max].map(round_to_f32);
            device
                .render(&RenderPass {
                    color_attachments: &[Some(ColorAttachment::clear(&image.view(), [-1.0; 4]))],
                    draws: &[Draw {
                        vertex_buffers: &[vertices.slice(..)],
                        viewport: Some(Viewport {
                            x,
                            y,
                            width,
                            height,
                            min_depth,
                            max_depth,
                        }),
                        ..Draw::new(&pipeline, 0..3)
                    }],
                    ..RenderPass::default()
                })
                .unwrap();
            let bytes = device.read_texture(&image).unwrap();
            let mut covered = 0;
            for (at, texel) in bytes.chunks_exact(16).enumerate() {
                let texel = [0, 4, 8, 12].map(|byte| {
                    let word = texel[byte..byte + 4].try_into().expect("four bytes");
                    f64::from(f32::from_le_bytes(word))
                });
                let (column, row) = ((at % 48) as f64, (at / 48) as f64);
                let centre = DVec3::new(column + 0.5, row + 0.5, 0.0);
                let ndc = transform_point(&ndc_from_window, centre);
                // Distances to the triangle's edges, with a margin for the grid of 1/256 pixel.
                let inside = (ndc.x + 1.0).min(ndc.y + 1.0).min(-ndc.x - ndc.y);
                if inside.abs() < 0.01 {
                    continue;
                }
                assert_eq!(texel[3] == 1.0, inside > 0.0, "({column}, {row}), {name}");
                if inside > 0.0 {
                    let expected = v.depth_min + (v.depth_max - v.depth_min) * depth(ndc.x, ndc.y);
                    assert_eq!(texel[..2], [centre.x, centre.y], "{name}");
                    assert!(
                        (texel[2] - expected).abs() < 1e-3,
                        "depth {} at ({column}, {row}), not {expected}, {name}",
                        texel[2]
                    );
                    covered += 1;
                }
            }
            assert!(covered > 200, "{covered} pixels, {name}");
        }
    }
}
