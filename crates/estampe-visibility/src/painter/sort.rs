//! Sorts by one number per polygon.

use crate::eye::Eye;
use crate::polygon::Polygon;

/// The polygons' numbers from the one with the farthest corner on.
#[must_use]
pub fn by_farthest_corner<const N: usize>(polygons: &[Polygon<N>], eye: Eye) -> Vec<u32> {
    sorted(polygons, |polygon| {
        let corners = polygon.corners().iter();
        let distances = corners.map(|corner| eye.distance(corner.position));
        distances.fold(f64::NEG_INFINITY, f64::max)
    })
}

/// The polygons' numbers from the one with the farthest centre of its corners on.
#[must_use]
pub fn by_centre<const N: usize>(polygons: &[Polygon<N>], eye: Eye) -> Vec<u32> {
    sorted(polygons, |polygon| {
        let corners = polygon.corners();
        let mean = |axis: usize| {
            let sum: f64 = corners.iter().map(|corner| corner.position[axis]).sum();
            sum / corners.len() as f64
        };
        eye.distance([mean(0), mean(1), mean(2)])
    })
}

/// The numbers by descending distance; equal distances keep the input's order.
fn sorted<const N: usize>(
    polygons: &[Polygon<N>],
    distance: impl Fn(&Polygon<N>) -> f64,
) -> Vec<u32> {
    let mut keyed: Vec<(f64, u32)> = polygons.iter().map(distance).zip(0..).collect();
    keyed.sort_by(|a, b| b.0.total_cmp(&a.0));
    keyed.into_iter().map(|(_, number)| number).collect()
}
