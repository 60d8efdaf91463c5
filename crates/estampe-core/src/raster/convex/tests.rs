//! Polygons are covered as the triangles are of which they are made.

use super::*;
use crate::raster::SampleSet;
use crate::raster::triangle::TilePolygon;
use estampe_simd::{Level, dispatch};

const TILE: TileShape = TileShape {
    x: 192,
    y: 128,
    log2: 6,
};

/// Numbers below a bound, of a linear congruential generator.
struct Random(u32);

impl Random {
    fn below(&mut self, below: i32) -> i32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        i32::try_from(self.0 >> 8).unwrap() % below
    }
}

/// By packet and sample: the covered lanes.
type Masks<const N: usize> = Vec<[u16; N]>;

fn masks_of<const N: usize>(lists: &[CoverageList<N>]) -> Masks<N> {
    let mut masks = vec![[0; N]; 256];
    for item in lists.iter().flat_map(CoverageList::items) {
        for (mask, more) in masks[usize::from(item.packet)].iter_mut().zip(item.masks) {
            assert_eq!(*mask & more, 0, "packet {} is covered twice", item.packet);
            *mask |= more;
        }
    }
    masks
}

fn list<const N: usize>() -> CoverageList<N> {
    let mut list = CoverageList::default();
    list.set_samples(SampleSet::new(N));
    list
}

/// Covers each triangle alone.
fn alone<const N: usize>(level: Level, triangles: &[[[i32; 2]; 3]], rect: &PixelRect) -> Masks<N> {
    let lists = triangles.iter().map(|&corners| {
        let mut list = list();
        let samples = SampleSet::new(N);
        if let Some(polygon) = TilePolygon::<N, 3>::of_corners(corners, TILE, rect, samples) {
            dispatch!(level, s => polygon.cover(s, TILE, 0, 0, &mut list));
            list.clip(rect);
        }
        list
    });
    masks_of(&lists.collect::<Vec<_>>())
}

/// A corner of a regular polygon with so many, nearly, on the unit circle.
fn on_circle(corner: i32, corners: i32) -> [f64; 2] {
    // A rational point of a quarter, turned.
    let (quarter, along) = (4 * corner / corners, 4 * corner % corners);
    let t = f64::from(along) / f64::from(corners);
    let [x, y] = [1.0 - t * t, 2.0 * t].map(|at| at / (1.0 + t * t));
    match quarter {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    }
}

/// The corners of a polygon around a place, clockwise.
fn around(random: &mut Random) -> Vec<[i32; 2]> {
    let center = [180, 116].map(|from| (from + random.below(90)) * 256);
    let size = [128; 2].map(|from| f64::from(from + random.below(60 * 256)));
    let count = 3 + random.below(22);
    let corners = (0..count).map(|corner| {
        let [x, y] = on_circle(corner, count);
        #[expect(clippy::cast_possible_truncation, reason = "to a grid")]
        let place = |center: i32, offset: f64| center + offset as i32;
        [place(center[0], x * size[0]), place(center[1], y * size[1])]
    });
    corners.collect()
}

fn check<const N: usize>() {
    let mut random = Random(7);
    let (mut joined, mut refused, mut pixels) = (0, 0, 0);
    for _ in 0..600 {
        let corners = around(&mut random);
        let apex = usize::try_from(random.below(8)).unwrap();
        let at = |corner: usize| corners[(corner + apex) % corners.len()];
        let mut fan: Vec<_> = (1..corners.len() - 1)
            .map(|corner| [at(0), at(corner), at(corner + 1)])
            .collect();
        if random.below(2) == 0 {
            fan.reverse();
        }
        // One that makes it concave, perhaps.
        if random.below(3) == 0 {
            let [a, b, _] = fan[fan.len() - 1];
            let third = [b[0] + random.below(9000), b[1] - random.below(9000)];
            fan.push([b, a, third]);
        }
        for triangle in &mut fan {
            let first = usize::try_from(random.below(3)).unwrap();
            triangle.rotate_left(first);
        }
        // Grids and slopes leave some triangles without area, or with their corners anticlockwise.
        let turns = |[a, b, c]: [[i32; 2]; 3]| turns_right(a, b, c) && !turns_right(c, b, a);
        fan.retain(|triangle| turns(*triangle));
        let rect = match random.below(3) {
            0 => [5, 9, 40, 61],
            _ => [0, 0, 64, 64],
        };
        let [x0, y0, x1, y1] = rect;
        let rect = PixelRect { x0, y0, x1, y1 };
        for level in Level::all_available() {
            let mut polygon = ConvexPolygon::<N>::default();
            let mut count = 0;
            for &triangle in &fan {
                if polygon.is_empty() {
                    polygon.begin(triangle);
                } else if !polygon.add(triangle) {
                    refused += 1;
                    break;
                }
                count += 1;
            }
            joined += count;
            if polygon.is_empty() {
                continue;
            }
            let mut list = list();
            let is_cut = dispatch!(level, s => polygon.cover(s, TILE, &rect, &mut list));
            if is_cut {
                list.clip(&rect);
            }
            pixels += list.items().iter().map(Covered::count).sum::<u64>();
            let expected = alone::<N>(level, &fan[..count], &rect);
            assert!(masks_of(&[list]) == expected, "{fan:?}, {level:?}");
        }
    }
    assert!(
        joined > 10_000 && refused > 100 && pixels > 1_000_000,
        "{joined}, {refused}, {pixels}"
    );
}

#[test]
fn a_polygon_covers_what_its_triangles_do() {
    check::<1>();
    check::<4>();
}
