//! The error bounds of `exact`: f32 results lie within them on random triangles.

use super::*;
use crate::exact::{self, Triangle};
use crate::fragment::{CENTER, Surface, TriangleSurface, sample_window};
use crate::raster::QuadCoverage;
use crate::setup::SortedTriangle;
use crate::viewport::{PixelBounds, ViewportTransform, snap};

fn random_viewport(random: &mut Random) -> Viewport {
    Viewport {
        x: random.range(-3.0, 9.0),
        y: random.range(-3.0, 9.0),
        width: random.range(10.0, 60.0),
        height: random.range(10.0, 60.0),
        min_depth: random.unit(),
        max_depth: random.unit(),
    }
}

fn random_vertex(random: &mut Random, w: f32) -> ClipVertex {
    let place = [random.range(-1.5, 1.5), random.range(-1.5, 1.5)];
    let values = [random.range(-5.0, 5.0), random.range(0.0, 1.0)];
    clip_vertex([place[0] * w, place[1] * w, random.unit() * w, w], &values)
}

/// Rows: A4.
#[test]
fn window_positions_lie_within_their_bounds() {
    let mut random = Random::new(21);
    for _ in 0..20_000 {
        let viewport = random_viewport(&mut random);
        let w = random.range(0.01, 100.0);
        let vertex = random_vertex(&mut random, w);
        let transform = ViewportTransform::new(&viewport);
        let window = transform.window(vertex.position);
        let exact = exact::window(&viewport, vertex.position);
        let computed = [window.x, window.y, window.z, window.inverse_w];
        for (bounded, value) in exact.into_iter().zip(computed) {
            assert!(bounded.holds(value), "{value} against {bounded:?}");
        }
        // The bound is not vacuous: a hundredth of the snapping grid; snapping adds half of the
        // grid.
        assert!(exact[0].error < 1.0 / 25_600.0);
        let snapped = f64::from(snap(window.x)) / 256.0;
        assert!((snapped - exact[0].value).abs() <= 1.0 / 512.0 + exact[0].error);
    }
}

/// Rows: R5.
#[test]
fn depth_and_varyings_lie_within_their_bounds() {
    let mut random = Random::new(22);
    let modes = [Interpolation::Smooth, Interpolation::NoPerspective];
    let target_bounds = PixelBounds { x: 0..64, y: 0..64 };
    let (mut fragments, mut tight) = (0_u32, 0_u32);
    for round in 0..400 {
        let viewport = random_viewport(&mut random);
        let constant_w = random.range(0.5, 4.0);
        let vertices: [ClipVertex; 3] = std::array::from_fn(|_| {
            let w = if round % 4 == 0 {
                constant_w
            } else {
                random.range(0.5, 4.0)
            };
            random_vertex(&mut random, w)
        });
        let transform = ViewportTransform::new(&viewport);
        let placed = vertices.each_ref().map(|vertex| transform.place(vertex));
        let (Some(sorted), Some(exact)) = (
            SortedTriangle::new(placed),
            Triangle::new(&viewport, &vertices),
        ) else {
            continue;
        };
        let surface = TriangleSurface::new(&sorted, &modes, &[]);
        for quad in raster::triangle(sorted.corners(), &target_bounds, 1) {
            // All lanes, helper invocations included.
            for lane in 0..4 {
                let pixel = QuadCoverage::pixel(quad.origin, lane);
                let at = sample_window(pixel, CENTER).map(f64::from);
                let varyings = surface.varyings(pixel);
                let pairs = [
                    (exact.depth(at), surface.depth(pixel, CENTER)),
                    (exact.inverse_w(at), surface.inverse_w(pixel)),
                    (exact.smooth(0, at), varyings[0]),
                    (exact.no_perspective(1, at), varyings[1]),
                ];
                for (which, (bounded, value)) in pairs.into_iter().enumerate() {
                    assert!(bounded.holds(value), "{which}: {value} against {bounded:?}");
                }
                fragments += 1;
                tight += u32::from(pairs.iter().all(|(bounded, _)| bounded.error < 1e-3));
            }
        }
    }
    // The bounds are not vacuous: except for slivers they are small.
    assert!(fragments > 20_000, "{fragments}");
    assert!(
        f64::from(tight) > 0.97 * f64::from(fragments),
        "{tight} of {fragments}"
    );
}

#[test]
fn a_constant_stays_constant_to_the_bit() {
    let mut random = Random::new(23);
    for _ in 0..500 {
        let value = random.range(-2.0, 2.0);
        let vertices: [ClipVertex; 3] = std::array::from_fn(|_| random_vertex(&mut random, 1.5));
        let transform = ViewportTransform::new(&State::new(64, 64).viewport);
        let placed = vertices.map(|mut vertex| {
            vertex.varyings = vec![value];
            transform.place(&vertex)
        });
        let Some(sorted) = SortedTriangle::new(placed) else {
            continue;
        };
        let surface = TriangleSurface::new(&sorted, &[Interpolation::Smooth], &[]);
        for pixel in [[0, 0], [13, 40], [63, 63]] {
            assert_eq!(surface.varyings(pixel), [value]);
        }
    }
}
