//! The repaired classic scan conversions of the oracle against the coverage of the fast path.

use estampe_reference::scan_conversion::{bounding_box, edge_table, line_sweep, scanline};
use estampe_reference::viewport::{PixelBounds, ViewportTransform, snap};
use estampe_tests::fast_path::{self, some_devices};
use estampe_tests::geometry::{Style, triangle};
use estampe_tests::shaders::Colored;
use estampe_tests::{Case, CaseDraw, Random};
use estampe_types::state::Viewport;

/// Rows: R2.
#[test]
fn the_classics_cover_what_the_pipeline_draws() {
    let mut pixels = 0;
    for seed in 0..150 {
        let mut random = Random::new("scan_conversion", seed);
        let mut case = Case::new([64, 35], 1);
        let style = random.pick(&[
            Style::Tiny,
            Style::Small,
            Style::Large,
            Style::Sliver,
            Style::OnGrid,
            Style::Degenerate,
        ]);
        // In front of the eye and inside the guard band, so that nothing is clipped.
        let mut vertices = triangle(&mut random, style, case.size);
        for vertex in &mut vertices {
            vertex.values = [1.0; 4];
            vertex.position[2] = 0.5 * vertex.position[3];
        }
        let [width, height] = case.size;
        let viewport = Viewport {
            x: 0.0,
            y: 0.0,
            width: width as f32,
            height: height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let transform = ViewportTransform::new(&viewport);
        let corners = vertices.map(|vertex| {
            let place = transform.window(vertex.position);
            [snap(place.x), snap(place.y)]
        });
        let bounds = PixelBounds {
            x: 0..width,
            y: 0..height,
        };
        let mut draw = CaseDraw::new(Colored, &vertices);
        draw.depth = None;
        case.draws.push(draw);
        for device in some_devices(seed) {
            let image = fast_path::draw(device, &case).image;
            let drawn: Vec<[u32; 2]> = (0u32..)
                .zip(image.color.chunks(4))
                .filter(|(_, pixel)| pixel[3] != 0)
                .map(|(at, _)| [at % width, at / width])
                .collect();
            pixels += drawn.len();
            for (name, mut covered) in [
                ("line sweep", line_sweep::repaired(corners, &bounds)),
                ("edge table", edge_table::repaired(corners, &bounds)),
                ("bounding box", bounding_box::repaired(corners, &bounds)),
                ("scan line", scanline::repaired(corners, &bounds)),
            ] {
                covered.sort_unstable_by_key(|&[x, y]| [y, x]);
                assert_eq!(covered, drawn, "{name}, seed {seed}: {corners:?}");
            }
        }
    }
    assert!(pixels > 10_000, "{pixels} pixels are hardly a test");
}
