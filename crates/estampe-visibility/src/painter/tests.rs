//! Sorted polygons, their failures, and orders by pairs.

use super::*;
use crate::bsp::{BspOptions, BspTree};
use crate::eye::Eye;
use crate::picture::{Hiding, View, differing_pixels, draw, draw_with_depths};
use crate::polygon::Polygon;
use crate::random_scene;
use estampe::{Device, DeviceDescriptor, Level, Mat4};
use fastrand::Rng;

/// Three beams in a cycle, each over the next, seen along −z.
fn cycle() -> Vec<Polygon<3>> {
    let turn = |[x, y, z]: [f32; 3]| [-0.5 * x - 0.866 * y, 0.866 * x - 0.5 * y, z];
    let mut beam = [
        [-0.8, -0.4, -0.3],
        [0.6, -0.4, 0.3],
        [0.6, -0.2, 0.3],
        [-0.8, -0.2, -0.3],
    ];
    let mut beams = Vec::new();
    for color in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        beams.extend(Polygon::new(&beam.map(|p| (p, color))));
        beam = beam.map(turn);
    }
    beams
}

/// Two squares that cross.
fn crossing() -> Vec<Polygon<3>> {
    let square = |slope: f32, height: f32, color: [f32; 3]| {
        let corners = [
            (-0.5, -height),
            (0.5, -height),
            (0.5, height),
            (-0.5, height),
        ];
        Polygon::new(&corners.map(|(x, y)| ([x, y, x * slope], color))).expect("a square")
    };
    vec![
        square(0.6, 0.5, [1.0, 0.8, 0.0]),
        square(-0.6, 0.3, [0.6, 0.0, 0.8]),
    ]
}

const FRONT: Eye = Eye::Direction([0.0, 0.0, 1.0]);

fn front(size: u32) -> View {
    View {
        clip_from_world: Mat4::orthographic_reversed(-1.0, 1.0, -1.0, 1.0, -1.0, 1.0),
        size: [size; 2],
        background: [1.0; 3],
    }
}

/// Pixels that a picture in an order has wrong.
fn wrong_pixels(polygons: &[Polygon<3>], order: &[u32], view: &View) -> usize {
    let device = random_scene::device();
    let all = polygons.iter().map(Polygon::corners);
    let right = draw(&device, view, all, Hiding::ByDepth).expect("small");
    let ordered = order
        .iter()
        .map(|number| polygons[*number as usize].corners());
    let painted = draw(&device, view, ordered, Hiding::ByOrder).expect("small");
    differing_pixels(&right, &painted)
}

/// No order of crossing or cyclic polygons is right, by whatever they are sorted; cut by a BSP tree
/// they have one.
/// Rows: D3, D4.
#[test]
fn no_order_is_right_for_cycles_and_crossings() {
    let view = front(128);
    for (polygons, permutations) in [
        (
            cycle(),
            vec![
                [0, 1, 2],
                [0, 2, 1],
                [1, 0, 2],
                [1, 2, 0],
                [2, 0, 1],
                [2, 1, 0],
            ],
        ),
        (crossing(), vec![[0, 1, 1], [1, 0, 0]]),
    ] {
        for order in permutations {
            let wrong = wrong_pixels(&polygons, &order, &view);
            assert!(wrong > 100, "{order:?}: {wrong}");
        }
        for order in [
            by_centre(&polygons, FRONT),
            by_farthest_corner(&polygons, FRONT),
        ] {
            assert!(wrong_pixels(&polygons, &order, &view) > 100);
        }
        let tree = BspTree::new(&polygons, BspOptions::default()).expect("small");
        let mut order = Vec::new();
        tree.back_to_front(FRONT, |piece| order.push(piece.corners.as_slice()));
        let device = random_scene::device();
        let all = polygons.iter().map(Polygon::corners);
        let right = draw(&device, &view, all, Hiding::ByDepth).expect("small");
        let cut = draw(&device, &view, order.into_iter(), Hiding::ByOrder).expect("small");
        assert!(differing_pixels(&right, &cut) < 20);
    }
    let pairs = by_pairs(&cycle(), FRONT).expect("few");
    assert!(pairs.crossing.is_empty() && !pairs.cyclic.is_empty() && pairs.order.len() == 3);
    let pairs = by_pairs(&crossing(), FRONT).expect("few");
    assert_eq!((pairs.crossing, pairs.cyclic), (vec![[0, 1]], vec![]));
}

/// Where no polygons cross, pairs give the depth buffer's picture, and sorts often do not.
/// Rows: D3, D5.
#[test]
fn orders_by_pairs_are_right_where_there_is_one() {
    let mut random = Rng::with_seed(6);
    let (mut ordered, mut sort_errors) = (0, 0);
    for _ in 0..12 {
        // Without those that cross an earlier one.
        let (view, eye) = random_scene::view(&mut random, [128, 128]);
        let mut polygons = random_scene::polygons(&mut random, 120, 0.7);
        while let Some([_, crossing]) = by_pairs(&polygons, eye).expect("few").crossing.first() {
            polygons.remove(*crossing as usize);
        }
        let pairs = by_pairs(&polygons, eye).expect("few");
        sort_errors += wrong_pixels(&polygons, &by_farthest_corner(&polygons, eye), &view);
        let wrong = wrong_pixels(&polygons, &pairs.order, &view);
        if pairs.cyclic.is_empty() {
            ordered += 1;
            assert!(wrong < 30, "{wrong}");
        }
    }
    assert!(ordered > 6 && sort_errors > 300, "{ordered} {sort_errors}");
    let many = vec![crossing()[0].clone(); MAX_POLYGONS + 1];
    let error = by_pairs(&many, FRONT).expect_err("too many");
    assert!(error.to_string().contains("BSP"));
}

/// The picture by order depends on the order, that of the depth buffer does not; neither depends on
/// threads and SIMD level.
/// Rows: D3, D5.
#[test]
fn the_depth_buffer_needs_no_order() {
    let device = random_scene::device();
    let mut random = Rng::with_seed(12);
    let mut polygons = random_scene::polygons(&mut random, 80, 0.6);
    let (view, _) = random_scene::view(&mut random, [128, 128]);
    let picture = |polygons: &[Polygon<3>], hiding| {
        draw(
            &device,
            &view,
            polygons.iter().map(Polygon::corners),
            hiding,
        )
        .expect("small")
    };
    let [by_order, by_depth] = [Hiding::ByOrder, Hiding::ByDepth].map(|h| picture(&polygons, h));
    for level in Level::all_available() {
        for threads in [1, 3] {
            let device = Device::new(&DeviceDescriptor {
                level,
                threads,
                ..DeviceDescriptor::default()
            });
            let device = device.expect("the system starts threads");
            for (hiding, expected) in [(Hiding::ByOrder, &by_order), (Hiding::ByDepth, &by_depth)] {
                let all = polygons.iter().map(Polygon::corners);
                let drawn = draw(&device, &view, all, hiding).expect("small");
                assert_eq!(drawn, *expected, "{level:?}, {threads} threads");
            }
        }
    }
    let mut differing = 0;
    for _ in 0..5 {
        random.shuffle(&mut polygons);
        assert_eq!(picture(&polygons, Hiding::ByDepth), by_depth);
        differing += differing_pixels(&picture(&polygons, Hiding::ByOrder), &by_order);
    }
    assert!(differing > 5000, "{differing}");
}

/// The depth buffer from above has one point for each covered pixel's column and distance.
/// Rows: D5.
#[test]
fn the_depth_buffer_from_above_has_the_nearest_surfaces_alone() {
    let device = random_scene::device();
    let polygons = crossing();
    let all = polygons.iter().map(Polygon::corners);
    let picture = draw_with_depths(&device, &front(128), all).expect("small");
    let above = picture.from_above(128, [255; 3], |depth| 1.0 - depth);
    let (mut covered, mut points) = (0, 0);
    for x in 0..128 {
        let column = (0..128).filter(|y| above.texel(x, *y) != [255; 4]);
        let column: Vec<u32> = column.collect();
        let is_covered = (0..128).any(|y| picture.image.texel(x, y) != [255; 4]);
        assert_eq!(column.is_empty(), !is_covered, "column {x}");
        // Both squares, where the smaller does not hide the larger's rows.
        assert!(column.len() <= 2, "{column:?}");
        covered += usize::from(is_covered);
        points += column.len();
        // Nearer is lower: z is |0.6 x| or less.
        let world = (f64::from(x) + 0.5) / 64.0 - 1.0;
        for y in column {
            let z = 1.0 - (f64::from(127 - y) + 0.5) / 64.0;
            assert!((z.abs() - 0.6 * world.abs()).abs() < 0.03, "{x} {y}: {z}");
        }
    }
    assert!(
        covered == 64 && points > 80 && points < 128,
        "{covered} {points}"
    );
}
