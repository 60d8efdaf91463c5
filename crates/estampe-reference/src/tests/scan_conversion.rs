//! The classic scan conversions against the coverage of `raster`.

use super::*;
use crate::raster::{QuadCoverage, triangle};
use crate::scan_conversion::{bounding_box, edge_table, line_sweep, scanline};
use crate::viewport::PixelBounds;

type Repaired = fn([[i32; 2]; 3], &PixelBounds) -> Vec<[u32; 2]>;
type Printed = fn([[i32; 2]; 3]) -> Vec<[i32; 2]>;

const REPAIRED: [(&str, Repaired); 4] = [
    ("line sweep", line_sweep::repaired),
    ("edge table", edge_table::repaired),
    ("bounding box", bounding_box::repaired),
    ("scan line", scanline::repaired),
];

const PRINTED: [(&str, Printed); 4] = [
    ("line sweep", line_sweep::printed),
    ("edge table", edge_table::printed),
    ("bounding box", bounding_box::printed),
    ("scan line", scanline::printed),
];

fn sorted<T: Ord>(mut pixels: Vec<T>) -> Vec<T> {
    pixels.sort_unstable();
    pixels
}

/// Rows: R2.
#[test]
fn repaired_forms_cover_what_the_rasterizer_covers() {
    let mut random = Random::new(71);
    let mut covered = 0;
    for round in 0..6000 {
        let bounds = PixelBounds {
            x: random.below(5)..5 + random.below(40),
            y: random.below(5)..5 + random.below(40),
        };
        // Corners anywhere, on ties (centres and pixel sides), tiny, or far outside.
        let step = [1, 128, 256, 16][round % 4];
        let reach: i32 = [12_000, 300, 3_000_000][round / 4 % 3];
        let origin = [0; 2].map(|_| random.below(10_000).cast_signed());
        let corners = [0; 3].map(|_| {
            origin.map(|origin| {
                let at = origin - reach + random.below(2 * reach.cast_unsigned()).cast_signed();
                at.div_euclid(step) * step
            })
        });
        let wanted: Vec<[u32; 2]> = triangle(corners, &bounds, 1)
            .iter()
            .flat_map(|quad| {
                let lanes = (0..4).filter(|&lane| quad.samples[lane] != 0);
                lanes.map(|lane| QuadCoverage::pixel(quad.origin, lane))
            })
            .collect();
        let wanted = sorted(wanted);
        covered += wanted.len();
        for (name, repaired) in REPAIRED {
            let got = sorted(repaired(corners, &bounds));
            assert_eq!(got, wanted, "{name}: {corners:?} in {bounds:?}");
        }
    }
    assert!(covered > 100_000, "{covered} pixels are hardly a test");
}

/// Rows: R2.
#[test]
fn printed_forms_draw_all_edges() {
    // The square (0, 0) to (4, 4), cut along its diagonal: each half draws its whole border, 15
    // pixels, and so the 5 of the diagonal are drawn twice; the repaired forms draw each of the 4×4
    // pixels between once.
    let halves = [[[0, 0], [4, 0], [0, 4]], [[4, 0], [4, 4], [0, 4]]];
    for (name, printed) in PRINTED {
        let [one, other] = halves.map(|half| sorted(printed(half)));
        assert_eq!([one.len(), other.len()], [15, 15], "{name}");
        let twice: Vec<_> = one.iter().filter(|pixel| other.contains(pixel)).collect();
        assert_eq!(
            twice,
            [&[0, 4], &[1, 3], &[2, 2], &[3, 1], &[4, 0]],
            "{name}"
        );
    }
    let bounds = PixelBounds { x: 0..9, y: 0..9 };
    for (name, repaired) in REPAIRED {
        let of =
            |half: [[i32; 2]; 3]| repaired(half.map(|corner| corner.map(|at| at * 256)), &bounds);
        let both = sorted(halves.map(of).concat());
        let wanted: Vec<_> = (0..4).flat_map(|x| (0..4).map(move |y| [x, y])).collect();
        assert_eq!(both, wanted, "{name}");
    }
}

/// Rows: R2.
#[test]
fn printed_forms_agree_on_the_ladders_triangles() {
    // Rung 4: of these triangles the box and the scan line are the closed triangle; the sweep
    // truncates its sides to whole pixels and the table rounds them, so each end of a row may be a
    // pixel farther out, and never farther in.
    let triangles = [
        [[10, 70], [50, 160], [70, 80]],
        [[180, 50], [150, 1], [70, 180]],
        [[180, 150], [120, 160], [130, 180]],
    ];
    for corners in triangles {
        let closed = sorted(scanline::printed(corners));
        assert_eq!(sorted(bounding_box::printed(corners)), closed);
        for printed in [line_sweep::printed, edge_table::printed] {
            let pixels = sorted(printed(corners));
            let is_drawn = |pixel: &[i32; 2]| pixels.binary_search(pixel).is_ok();
            assert!(closed.iter().all(is_drawn), "{corners:?}");
            let mut rows: Vec<i32> = pixels.iter().map(|pixel| pixel[1]).collect();
            rows.sort_unstable();
            rows.dedup();
            let most = closed.len() + 2 * rows.len();
            assert!((closed.len()..=most).contains(&pixels.len()), "{corners:?}");
        }
    }
}
