//! Bins of random triangles, and of what covers the target.

use super::*;
use crate::bounds::pixel_rect::PixelRect;
use crate::geometry::plan::TargetGeometry;
use estampe_simd::{Level, dispatch};
use estampe_types::state::{DepthBiasState, PrimitiveState, Viewport};

const SIZE: [u32; 2] = [200, 150];

fn plan(grid: TileGrid) -> GeometryPlan {
    let target = TargetGeometry {
        grid,
        depth_stencil: None,
        rect: PixelRect::of_target(None, SIZE[0], SIZE[1]),
        position_range: [128; 2],
        sample_range: [128; 2],
        is_opaque: true,
        has_colors: true,
        has_flat_varyings: false,
        joins_rectangles: false,
    };
    let viewport = Viewport::of_target(SIZE[0], SIZE[1]);
    let (state, bias) = (PrimitiveState::default(), DepthBiasState::default());
    GeometryPlan::new(&state, &bias, &viewport, target)
}

/// Returns true if the centre of some pixel of a tile is strictly inside a triangle whose
/// vertices are in clockwise order.
fn holds_samples(corners: [[i64; 2]; 3], grid: TileGrid, tile: u32) -> bool {
    let (left, top) = grid.tile_origin(tile);
    let is_inside = |x: u32, y: u32| {
        let [px, py] = [x, y].map(|at| i64::from(at) * 256 + 128);
        (0..3).all(|edge| {
            let ([ax, ay], [bx, by]) = (corners[edge], corners[(edge + 1) % 3]);
            (bx - ax) * (py - ay) - (by - ay) * (px - ax) > 0
        })
    };
    let side = 1 << grid.tile_log2();
    let (right, bottom) = ((left + side).min(SIZE[0]), (top + side).min(SIZE[1]));
    (top..bottom).any(|y| (left..right).any(|x| is_inside(x, y)))
}

#[test]
fn what_covers_the_target_has_the_most_spans() {
    for samples in [1, 2] {
        let plan = plan(TileGrid::new(SIZE[0], SIZE[1], samples));
        // The target with its padding.
        let [x1, y1] = [4, 3].map(|blocks| blocks << (6 - plan.grid.tile_log2()));
        let (x0, y0) = (0, 0);
        let mut bins = Bins::default();
        let all = TileRange { x0, y0, x1, y1 };
        bin_range(&plan, all, BinEntry::Point(0), None, &mut bins);
        assert_eq!(bins.spans() as u64, plan.grid.most_spans());
        bins.sort(u64::MAX);
        let tiles = 0..u32::try_from(plan.grid.tiles()).unwrap();
        assert!(tiles.into_iter().all(|tile| bins.of_tile(tile).len() == 1));
    }
}

#[test]
fn every_tile_with_a_covered_sample_has_an_entry_and_lanes_are_in_order() {
    // Tiles of 64×64 pixels and of 32×32.
    let plans = [1, 2].map(|samples| plan(TileGrid::new(SIZE[0], SIZE[1], samples)));
    let mut state = 7u32;
    let mut random = |below: i32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        i32::try_from(state >> 8).unwrap() % below
    };
    for turn in 0..24 {
        let plan = &plans[turn / 4 % 2];
        // Small ones, which share tiles; and some that span many.
        let size = [6, 6, 40, 300][turn % 4] * 256;
        let mut corners = [[[0_i32; 2]; 3]; LANES];
        let mut chunk = Chunk::default();
        chunk.begin_run(0);
        let packet = chunk.triangles.push_stale();
        (packet.len, packet.clockwise) = (16, 0);
        for (lane, corners) in Lane::ALL.into_iter().zip(&mut corners) {
            let place = [random(230 * 256), random(180 * 256)];
            *corners = [0; 3].map(|_| place.map(|at| at - 15 * 256 + random(size)));
            corners.sort_by_key(|[x, y]| (*y, *x));
            let [[ax, ay], [bx, by], [cx, cy]] = corners.map(|corner| corner.map(i64::from));
            if (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0 {
                packet.clockwise |= lane.bit();
            }
            for (corner, [x, y]) in corners.iter().enumerate() {
                *lane.of_mut(&mut packet.x[corner]) = *x;
                *lane.of_mut(&mut packet.y[corner]) = *y;
            }
        }
        let (x, y, clockwise) = (packet.x, packet.y, packet.clockwise);
        dispatch!(Level::best(), s => {
            let load = |lanes: [i32; LANES]| i32x16::load_array(s, lanes);
            let positions = [[load(x[0]), load(x[1]), load(x[2])], [load(y[0]), load(y[1]), load(y[2])]];
            bin_packet(s, plan, positions, 0, &mut chunk);
        });
        chunk.bins.sort(u64::MAX);
        for tile in 0..u32::try_from(plan.grid.tiles()).unwrap() {
            let mut found = 0;
            for entry in chunk.bins.of_tile(tile) {
                let BinEntry::Triangles { packet: 0, lanes } = *entry else {
                    panic!("{entry:?} is not of the one packet");
                };
                assert!(found < lanes & lanes.wrapping_neg(), "out of order");
                found |= lanes;
            }
            for (lane, corners) in Lane::ALL.into_iter().zip(&corners) {
                let [a, b, c] = corners.map(|corner| corner.map(i64::from));
                let wound = if lane.is_in(clockwise) {
                    [a, b, c]
                } else {
                    [a, c, b]
                };
                let is_needed = holds_samples(wound, plan.grid, tile);
                assert!(lane.is_in(found) || !is_needed, "tile {tile}: {corners:?}");
            }
        }
    }
}
