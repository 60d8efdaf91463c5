//! Exact transparency against sorted fragments and BSP trees; what the others miss.

use super::*;
use crate::bsp::{BspOptions, BspTree};
use crate::eye::Eye;
use crate::picture::{View, differing_pixels};
use crate::polygon::{Corner, Polygon};
use crate::random_scene;
use estampe::{Device, DeviceDescriptor, Level};
use estampe_scene::Image;
use fastrand::Rng;

/// Transparent polygons from opaque ones.
fn tinted(random: &mut Rng, polygons: &[Polygon<3>]) -> Vec<Polygon<4>> {
    let tint = |polygon: &Polygon<3>| {
        let alpha = 0.1 + random.f32() * 0.8;
        #[expect(clippy::cast_possible_truncation, reason = "they were f32")]
        let corner = |corner: &Corner<3>| {
            let [r, g, b] = corner.attributes;
            (corner.position.map(|x| x as f32), [r, g, b, alpha])
        };
        let corners: Vec<_> = polygon.corners().iter().map(corner).collect();
        Polygon::new(&corners).expect("it was one")
    };
    polygons.iter().map(tint).collect()
}

/// The greatest difference of a channel, and the mean of all.
fn difference(a: &Image, b: &Image) -> (u8, f64) {
    let differences: Vec<u8> = a
        .rgba
        .iter()
        .zip(&b.rgba)
        .map(|(a, b)| a.abs_diff(*b))
        .collect();
    let sum: f64 = differences
        .iter()
        .map(|difference| f64::from(*difference))
        .sum();
    let greatest = differences.iter().max().copied().unwrap_or(0);
    (greatest, sum / differences.len() as f64)
}

/// Peeled layers are the BSP tree's order, though no order of the uncut polygons is right; the
/// given order changes nothing; sorting is wrong.
///
/// Rows: D6.
#[test]
fn exact_transparency_is_that_of_the_exact_order() {
    let device = random_scene::device();
    let mut random = Rng::with_seed(20);
    let (mut exact_error, mut sorted_error, mut weighted_error) = (0.0, 0.0, 0.0);
    for _ in 0..4 {
        let (view, eye) = random_scene::view(&mut random, [96, 96]);
        let opaque = random_scene::polygons(&mut random, 5, 0.6);
        let polygons = random_scene::polygons(&mut random, 20, 0.9);
        let mut transparent = tinted(&mut random, &polygons);
        let picture = |transparent: &[Polygon<4>], method| {
            draw(&device, (&view, eye), &opaque, transparent, method).expect("small")
        };
        let exact = picture(&transparent, Transparency::Exact);
        let tree = BspTree::new(&transparent, BspOptions::default()).expect("small");
        let mut order: Vec<&[Corner<4>]> = Vec::new();
        tree.back_to_front(eye, |piece| order.push(&piece.corners));
        let expected = draw_in_order(&device, &view, &opaque, order.into_iter()).expect("small");
        let (_, mean) = difference(&exact, &expected);
        let unlike = differing_pixels(&exact, &expected);
        // Edges of pieces alone.
        assert!(unlike * 20 < 96 * 96, "{unlike}");
        exact_error += mean;
        sorted_error += difference(&picture(&transparent, Transparency::Sorted), &exact).1;
        let weighted = picture(&transparent, Transparency::Weighted);
        weighted_error += difference(&weighted, &exact).1;

        random.shuffle(&mut transparent);
        assert_eq!(picture(&transparent, Transparency::Exact), exact);
        let again = picture(&transparent, Transparency::Weighted);
        assert!(
            difference(&again, &weighted).0 <= 1,
            "sums round by their order"
        );
    }
    assert!(
        sorted_error > exact_error * 4.0,
        "{sorted_error} {exact_error}"
    );
    assert!((1.0..80.0).contains(&weighted_error), "{weighted_error}");
}

/// One layer is blended alike by all methods; three layers as their formula says.
///
/// Rows: D6.
#[test]
fn layers_are_blended_by_their_formulas() {
    let device = random_scene::device();
    let view = View {
        clip_from_world: estampe::Mat4::orthographic_reversed(-1.0, 1.0, -1.0, 1.0, -1.0, 1.0),
        size: [4, 4],
        background: [0.2, 0.4, 0.6],
    };
    let eye = Eye::Direction([0.0, 0.0, 1.0]);
    let square = |z: f32, tint: [f32; 4]| {
        let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)];
        Polygon::new(&corners.map(|(x, y)| ([x, y, z], tint))).expect("a square")
    };
    let layers = [
        square(0.5, [1.0, 0.0, 0.0, 0.5]),
        square(-0.5, [0.0, 1.0, 0.0, 0.25]),
        square(0.0, [0.0, 0.0, 1.0, 0.75]),
    ];
    let pixel = |layers: &[Polygon<4>], method| {
        let image = draw(&device, (&view, eye), &[], layers, method).expect("small");
        image.texel(1, 2)
    };
    for method in [
        Transparency::Sorted,
        Transparency::Exact,
        Transparency::Weighted,
    ] {
        // 0.5·red + 0.5·background.
        assert_eq!(
            pixel(&layers[..1], method),
            [153, 51, 76, 255],
            "{method:?}"
        );
        assert_eq!(pixel(&[], method), [51, 102, 153, 255], "{method:?}");
    }
    // From behind: green over the background (0.15, 0.55, 0.45), blue (0.0375, 0.1375, 0.8625),
    // red.
    for method in [Transparency::Sorted, Transparency::Exact] {
        assert_eq!(pixel(&layers, method), [132, 18, 110, 255], "{method:?}");
    }
    // Weights α²·3000·z³ with z = ¾, ¼, ½; B = ½·¾·¼.
    let weights = [0.25 * 0.421_875, 0.0625 * 0.015_625, 0.5625 * 0.125_f64];
    let (sum, b) = (weights.iter().sum::<f64>(), 0.093_75);
    let expected = [(0, 0.2), (1, 0.4), (2, 0.6)]
        .map(|(k, behind): (usize, f64)| (weights[k] / sum * (1.0 - b) + behind * b) * 255.0);
    let found = pixel(&layers, Transparency::Weighted);
    for (k, expected) in expected.iter().enumerate() {
        assert!(
            (f64::from(found[k]) - expected).abs() < 1.0,
            "{found:?} {expected}"
        );
    }
    // An opaque square hides what is behind it.
    let wall = {
        let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)];
        Polygon::new(&corners.map(|(x, y)| ([x, y, 0.25], [0.0; 3]))).expect("a square")
    };
    for method in [
        Transparency::Sorted,
        Transparency::Exact,
        Transparency::Weighted,
    ] {
        let image = draw(
            &device,
            (&view, eye),
            std::slice::from_ref(&wall),
            &layers,
            method,
        )
        .expect("small");
        assert_eq!(image.texel(2, 1), [128, 0, 0, 255], "{method:?}");
    }
}

/// Rows: D6, U3.
#[test]
fn pictures_are_the_same_everywhere() {
    let mut random = Rng::with_seed(21);
    let (view, eye) = random_scene::view(&mut random, [96, 96]);
    let opaque = random_scene::polygons(&mut random, 5, 0.6);
    let polygons = random_scene::polygons(&mut random, 20, 0.9);
    let transparent = tinted(&mut random, &polygons);
    for method in [
        Transparency::Sorted,
        Transparency::Exact,
        Transparency::Weighted,
    ] {
        let mut images = Vec::new();
        for level in Level::all_available() {
            for threads in [1, 3] {
                let descriptor = DeviceDescriptor {
                    level,
                    threads,
                    ..DeviceDescriptor::default()
                };
                let device = Device::new(&descriptor).expect("the system starts threads");
                let image = draw(&device, (&view, eye), &opaque, &transparent, method);
                images.push(image.expect("small"));
            }
        }
        assert!(images.iter().all(|image| *image == images[0]), "{method:?}");
    }
}
