//! The points that tessellation and geometry shaders read, by hand.

use estampe_types::shader::{Points, ShadedPoint};
use estampe_types::{Quad, Vec2};

/// Three records of seven words: x, y, z, w, two varyings, and a word that is not read.
fn records() -> Vec<u32> {
    (0..21_u8)
        .map(|word| f32::from(word) * 0.5)
        .map(f32::to_bits)
        .collect()
}

#[test]
fn points_are_records_in_order() {
    let records = records();
    let points: Points<'_, f32, ShadedPoint<f32, Vec2<f32>>> =
        Points::of_patch(0.0, &records, 7, 3);
    assert_eq!(points.count(), 3);
    for (index, first) in [(0, 0.0), (1, 3.5), (2, 7.0), (3, 7.0), (usize::MAX, 7.0)] {
        let point = points.get(index);
        let at = point.position;
        let position = [at.x, at.y, at.z, at.w];
        assert_eq!(position, [first, first + 0.5, first + 1.0, first + 1.5]);
        let varyings = point.varyings;
        assert_eq!([varyings.x, varyings.y], [first + 2.0, first + 2.5]);
    }
}

#[test]
fn lanes_choose_points_of_their_own() {
    let records = records();
    let zero = Quad([0.0; 4]);
    let points: Points<'_, Quad, Vec2<Quad>> = Points::of_patch(zero, &records, 7, 3);
    // Below 0 is the first point, beyond the last one the last.
    let point = points.get_at(Quad([1, -5, 2, 9]));
    assert_eq!(point.x, Quad([3.5, 0.0, 7.0, 7.0]));
    assert_eq!(point.y, Quad([4.0, 0.5, 7.5, 7.5]));
    assert_eq!(points.get(1).y, Quad([4.0; 4]));
}
