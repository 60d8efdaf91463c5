//! View directions have the documented axes; fits are tight, inside the frame and centred.

use super::Cloud;
use super::fit::{FrameTangents, orthographic_view, perspective_eye};
use super::*;
use crate::transforms::transform_point;
use glam::DVec3;

#[test]
fn named_views_are_exact() {
    let back = |view: ViewDirection| view.axes()[2];
    assert_eq!(back(ViewDirection::FRONT), DVec3::Z);
    assert_eq!(back(ViewDirection::BACK), -DVec3::Z);
    assert_eq!(back(ViewDirection::RIGHT), DVec3::X);
    assert_eq!(back(ViewDirection::LEFT), -DVec3::X);
    assert_eq!(back(ViewDirection::TOP), DVec3::Y);
    assert_eq!(back(ViewDirection::BOTTOM), -DVec3::Y);
    assert_eq!(
        ViewDirection::TOP.axes()[1],
        -DVec3::Z,
        "the front is at the bottom"
    );
    assert_eq!(ViewDirection::BOTTOM.axes()[1], DVec3::Z);
    let d = back(ViewDirection::default());
    let (a, e) = (30f64.to_radians(), 20f64.to_radians());
    let expected = DVec3::new(
        libm::sin(a) * libm::cos(e),
        libm::sin(e),
        libm::cos(a) * libm::cos(e),
    );
    assert!((d - expected).length() < 1e-15);
    let iso = back(ViewDirection::ISO);
    assert!((iso.x - iso.z).abs() < 1e-15 && (iso.y - iso.x).abs() < 1e-5);
}

#[test]
fn axes_are_orthonormal_and_right_handed_at_every_angle() {
    for azimuth in -50..50 {
        for elevation in -9..=9 {
            let view = ViewDirection::new(f64::from(azimuth) * 14.5, f64::from(elevation) * 10.0);
            let [right, up, back] = view.axes();
            assert!((right.cross(up) - back).length() < 1e-14, "{view:?}");
            assert!((up.length() - 1.0).abs() < 1e-14, "{view:?}");
        }
    }
}

/// A cloud of points with different extents on each axis, in −1..1.
fn cloud(seed: u64, count: usize, extents: DVec3) -> Vec<DVec3> {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut next = || random.f64() * 2.0 - 1.0;
    (0..count)
        .map(|_| DVec3::new(next(), next(), next()) * extents)
        .collect()
}

/// Least and greatest window coordinates, in pixels, of the points under a placed camera.
fn window_extent(camera: &PlacedCamera, points: &[DVec3], size: (u32, u32)) -> [f64; 4] {
    let (width, height) = (f64::from(size.0), f64::from(size.1));
    let clip_from_world = camera.clip_from_view(width / height) * camera.frame.view_from_world();
    let mut extent = [
        f64::INFINITY,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NEG_INFINITY,
    ];
    for &p in points {
        let ndc = transform_point(&clip_from_world, p);
        assert!((0.0..=1.0).contains(&ndc.z), "clipped in depth: {ndc}");
        let (x, y) = ((ndc.x * 0.5 + 0.5) * width, (0.5 - ndc.y * 0.5) * height);
        extent = [
            extent[0].min(x),
            extent[1].min(y),
            extent[2].max(x),
            extent[3].max(y),
        ];
    }
    extent
}

#[test]
fn fits_are_inside_tight_and_centred() {
    let projections = [
        ProjectionKind::default(),
        ProjectionKind::Perspective { fov_y_deg: 5.0 },
        ProjectionKind::Perspective { fov_y_deg: 120.0 },
        ProjectionKind::Orthographic { half_height: None },
    ];
    for seed in 0..40u32 {
        for extents in [
            DVec3::ONE,
            DVec3::new(1.0, 0.05, 0.4),
            DVec3::new(0.1, 1.0, 0.0),
        ] {
            let points = cloud(seed.into(), 3 + seed as usize * 7, extents);
            for size in [(512, 512), (1024, 300), (200, 900)] {
                for projection in projections {
                    let margin = 0.02 + 0.01 * f64::from(seed % 9);
                    let direction =
                        ViewDirection::new(f64::from(seed) * 37.0, f64::from(seed) * 4.0 - 80.0);
                    let eye = Eye::Fitted(direction);
                    let options = CameraOptions {
                        eye,
                        projection,
                        margin,
                        ..CameraOptions::default()
                    };
                    let camera = PlacedCamera::new(&options, DVec3::Y, &points, size);
                    let [left, top, right, bottom] = window_extent(&camera, &points, size);
                    let border = margin * f64::from(size.0.min(size.1));
                    let free = [
                        left - border,
                        top - border,
                        f64::from(size.0) - border - right,
                        f64::from(size.1) - border - bottom,
                    ];
                    let context = format!("{seed} {extents} {size:?} {projection:?}: {free:?}");
                    assert!(free.iter().all(|&f| f > -1e-6), "outside: {context}");
                    let tight = free[0].max(free[2]).min(free[1].max(free[3]));
                    // For a wide view, the eye may instead be limited by the point nearest to it.
                    let is_close = camera.depth_range.0 < 2e-3;
                    assert!(tight < 1e-5 || is_close, "not tight: {context}");
                    assert!(
                        (free[0] - free[2]).abs() < 1e-3,
                        "not centred in x: {context}"
                    );
                    assert!(
                        (free[1] - free[3]).abs() < 1e-3,
                        "not centred in y: {context}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_given_target_stays_in_the_middle() {
    let points = cloud(5, 50, DVec3::ONE);
    let target = DVec3::new(0.5, 0.2, -0.3);
    for projection in [
        ProjectionKind::default(),
        ProjectionKind::Orthographic { half_height: None },
    ] {
        let options = CameraOptions {
            target_world: Some(target),
            projection,
            ..CameraOptions::default()
        };
        let camera = PlacedCamera::new(&options, DVec3::Y, &points, (400, 300));
        let middle = window_extent(&camera, &[target], (400, 300));
        assert!((middle[0] - 200.0).abs() < 1e-9 && (middle[1] - 150.0).abs() < 1e-9);
        let [left, top, right, bottom] = window_extent(&camera, &points, (400, 300));
        let free = left.min(top).min(400.0 - right).min(300.0 - bottom);
        assert!((free - 15.0).abs() < 1e-6, "{free}");
    }
}

#[test]
fn a_given_eye_is_where_the_picture_is_taken() {
    let points = cloud(9, 50, DVec3::splat(0.5));
    let eye = DVec3::new(2.0, 1.0, 3.0);
    let options = CameraOptions {
        eye: Eye::At(eye),
        ..CameraOptions::default()
    };
    let camera = PlacedCamera::new(&options, DVec3::Y, &points, (400, 300));
    assert_eq!(camera.frame.eye_world, eye);
    window_extent(&camera, &points, (400, 300));
    // The camera is valid even if the eye is inside the model, or at the target.
    for eye in [DVec3::splat(0.01), DVec3::ZERO, DVec3::Y * 3.0] {
        let options = CameraOptions {
            eye: Eye::At(eye),
            ..options
        };
        let camera = PlacedCamera::new(&options, DVec3::Y, &points, (400, 300));
        assert!(camera.near > 0.0 && camera.far > camera.near);
        assert!(camera.clip_from_view(1.0).is_finite());
    }
}

#[test]
fn up_may_point_anywhere() {
    let points = cloud(3, 30, DVec3::ONE);
    let options = CameraOptions {
        eye: Eye::Fitted(ViewDirection::FRONT),
        ..CameraOptions::default()
    };
    let camera = PlacedCamera::new(&options, DVec3::Z * 4.0, &points, (100, 100));
    assert_eq!(camera.frame.back_world, -DVec3::Y, "Z up: the front is −y");
    assert_eq!(camera.frame.up_world, DVec3::Z);
    let camera = PlacedCamera::new(&options, -DVec3::Y, &points, (100, 100));
    assert!((camera.frame.up_world + DVec3::Y).length() < 1e-15);
}

#[test]
fn empty_and_degenerate_models_have_cameras() {
    let lines_of_sight = [DVec3::ZERO, DVec3::Z * 0.5];
    for points in [
        &[][..],
        &[DVec3::ZERO],
        &[DVec3::splat(0.3)],
        &lines_of_sight,
    ] {
        for projection in [
            ProjectionKind::default(),
            ProjectionKind::Orthographic { half_height: None },
        ] {
            let eye = Eye::Fitted(ViewDirection::FRONT);
            let options = CameraOptions {
                eye,
                projection,
                ..CameraOptions::default()
            };
            let camera = PlacedCamera::new(&options, DVec3::Y, points, (640, 480));
            assert!(camera.clip_from_view(4.0 / 3.0).is_finite());
            assert!(camera.far > camera.near);
            let extent = window_extent(&camera, points, (640, 480));
            assert!(
                points.is_empty() || (extent[0] - 320.0).abs() < 1e-6,
                "{extent:?}"
            );
        }
    }
    let k = FrameTangents::new(100.0, 100.0, 1.0, 0.0);
    assert!(perspective_eye(&Cloud::default(), k, None).z > 1.0);
    assert_eq!(orthographic_view(&Cloud::default(), k, None).1, 1.0);
}

#[test]
fn zoom_scales_the_window_about_its_middle() {
    let points = cloud(5, 40, DVec3::new(1.0, 0.6, 0.8));
    for projection in [
        ProjectionKind::default(),
        ProjectionKind::Orthographic { half_height: None },
        ProjectionKind::Orthographic {
            half_height: Some(1.5),
        },
        ProjectionKind::Pinhole(Intrinsics {
            focal_px: [50.0, 45.0],
            principal_px: [17.0, 16.0],
        }),
    ] {
        let plain = CameraOptions {
            projection,
            ..CameraOptions::default()
        };
        let place =
            |options: &CameraOptions| PlacedCamera::new(options, DVec3::Y, &points, (40, 30));
        let before = place(&plain);
        for zoom in [0.25, 1.0, 3.0] {
            let after = place(&CameraOptions { zoom, ..plain });
            assert_eq!(after.frame, before.frame, "the eye stays");
            for point in [DVec3::ZERO, DVec3::new(0.3, -0.2, 0.5)] {
                let [a, b] = [before, after].map(|camera| {
                    let view = camera.frame.view_from_world();
                    (camera.clip_from_view(4.0 / 3.0) * view).project_point3(point)
                });
                let difference = (a * zoom - b).truncate().length();
                assert!(difference < 1e-9, "{projection:?} {zoom}: {a} {b}");
            }
        }
        let unchanged = place(&CameraOptions { zoom: 1.0, ..plain });
        assert_eq!(unchanged, before);
    }
}
