//! Ribbons of strokes in a window of 100 pixels whose clip space is unit space.

use super::ribbon::Ribbon;
use super::{Stroke, Window};
use glam::{DMat4, DVec2, DVec3, DVec4};

fn window() -> Window {
    Window {
        clip_from_unit: DMat4::IDENTITY,
        size_px: DVec2::splat(100.0),
    }
}

/// A vertical line through the middle, with faces to both sides.
fn stroke(left: Option<DVec3>, right: Option<DVec3>) -> Stroke {
    Stroke {
        ends: [DVec3::new(0.0, 0.5, 0.5), DVec3::new(0.0, -0.5, 0.5)],
        faces: [left, right],
        alphas: [1.0; 2],
    }
}

/// The depths at 2 pixels to the left, on the line and at 2 pixels to the right.
fn depths(stroke: &Stroke) -> [f64; 3] {
    let ribbon = Ribbon::new(stroke, &window(), 1.0, false).expect("visible");
    let mut points = ribbon.points[..3].to_vec();
    points.sort_by(|a, b| a.at_px.x.total_cmp(&b.at_px.x));
    assert_eq!([0, 1, 2].map(|k| points[k].at_px.x), [48.0, 50.0, 52.0]);
    [0, 1, 2].map(|k| points[k].depth)
}

#[test]
fn ribbons_follow_faces_that_come_nearer_and_no_others() {
    let near = Some(DVec3::new(-0.4, 0.0, 0.3));
    let far = Some(DVec3::new(0.4, 0.2, 0.7));
    // 0.2 nearer over 20 pixels.
    assert!((depths(&stroke(near, far))[0] - 0.48).abs() < 1e-12);
    assert_eq!(depths(&stroke(near, far))[1..], [0.5; 2]);
    assert_eq!(depths(&stroke(None, far)), [0.5; 3]);
    // A face that is narrower than the ribbon is followed up to its corner.
    let narrow = Some(DVec3::new(-0.02, 0.0, 0.4));
    assert!((depths(&stroke(narrow, None))[0] - 0.4).abs() < 1e-12);
    // A face on edge has no side.
    assert_eq!(
        depths(&stroke(Some(DVec3::new(0.0, 0.0, 0.1)), None)),
        [0.5; 3]
    );
}

#[test]
fn the_bias_grows_with_the_slope_and_is_less_than_the_face_is_deep() {
    let of = |depth: f64, aside: f64| {
        let face = Some(DVec3::new(aside, 0.0, depth));
        let ribbon = Ribbon::new(&stroke(face, None), &window(), 1.0, true).expect("visible");
        0.5 - ribbon.points[0].depth
    };
    let flat = of(0.5, 0.4);
    assert!(flat > 0.0 && flat < 1e-6, "{flat}");
    // 0.2 over 20 pixels, for 4/256 pixel.
    assert!((of(0.7, 0.4) - flat - 0.01 * 4.0 / 256.0).abs() < 1e-12);
    assert!(of(0.5 + 1e-5, 1e-9) - flat <= 1e-5 + 1e-12);
}

#[test]
fn lines_are_cut_behind_the_eye_and_far_outside() {
    // w is the distance along −z.
    let clip_from_unit = DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, -0.9, -1.0),
        -DVec4::Z * 0.1,
    );
    let window = Window {
        clip_from_unit,
        ..window()
    };
    let behind = [DVec3::new(0.1, 0.0, 1.0), DVec3::new(0.1, 0.2, 2.0)];
    assert!(window.line(behind).is_none());
    let through = [DVec3::new(0.0, 0.0, -4.0), DVec3::new(1.0, 0.0, 4.0)];
    let [(a, from), (b, to)] = window.line(through).expect("half of it is before the eye");
    assert!(a.at_px.distance(DVec2::splat(50.0)) < 1e-9 && from == 0.0);
    assert!(b.at_px.x <= 228.0 + 1e-6 && to < 0.5, "{b:?} {to}");
    let outside = [DVec3::new(9.0, 0.0, -1.0), DVec3::new(9.0, 1.0, -1.0)];
    assert!(window.line(outside).is_none());
    assert!(window.line([DVec3::NAN, DVec3::ZERO]).is_none());
}
