//! Viewports, scissor rectangles, and targets of odd sizes.

use estampe_tests::geometry::{Style, Vertex, triangles};
use estampe_tests::shaders::{Colored, Probe, Sized};
use estampe_tests::{Case, CaseDraw, Random, TestShader, check, check_one};
use estampe_types::state::{
    ConservativeMode, CullMode, PolygonMode, PrimitiveTopology, ScissorRect, Viewport,
};

fn style(random: &mut Random) -> Style {
    random.pick(&Style::ALL)
}

fn random_viewport(random: &mut Random, size: [u32; 2]) -> Viewport {
    let [width, height] = size.map(|side| side as f32);
    let depths = [[0.0, 1.0], [1.0, 0.0], [0.25, 0.5], [0.9, 0.1], [0.5, 0.5]];
    let [min_depth, max_depth] = random.pick(&depths);
    let (x, y, w, h) = match random.below(4) {
        // Partly outside the target.
        0 => (
            random.range(-width, width),
            random.range(-height, height),
            random.range(1.0, 2.0 * width + 1.0),
            random.range(1.0, 2.0 * height + 1.0),
        ),
        // Edges on pixel centres and quarters.
        1 => (
            random.below(2 * size[0]) as f32 * 0.25,
            random.below(2 * size[1]) as f32 * 0.5,
            random.below(4 * size[0]) as f32 * 0.25 + 0.25,
            random.below(2 * size[1]) as f32 * 0.5 + 0.5,
        ),
        // Far outside, or much larger than the target.
        2 => (
            random.range(-30_000.0, 100.0),
            random.range(-30_000.0, 100.0),
            random.range(1.0, 32_768.0),
            random.range(1.0, 32_768.0),
        ),
        // Sums that f32 would round: edges just beside a pixel's centre.
        _ => (
            random.pick(&[0.1, 0.3, -1e-6, 1e-9]),
            random.pick(&[0.7, 1.0 / 3.0, -0.25]),
            random.below(size[0]) as f32 + random.pick(&[0.4, 0.2, 0.5, 0.500_000_06]),
            random.below(size[1]) as f32 + random.pick(&[0.8, 1.0 / 6.0, 0.75, 0.2]),
        ),
    };
    Viewport {
        x,
        y,
        width: w,
        height: h,
        min_depth,
        max_depth,
    }
}

fn random_scissor(random: &mut Random, [width, height]: [u32; 2]) -> ScissorRect {
    let sides = [0, 1, 3, 17, width, u32::MAX];
    ScissorRect {
        x: random.below(width + 2),
        y: random.below(height + 2),
        width: random.pick(&sides),
        height: random.pick(&[1, 4, 20, height, u32::MAX]),
    }
}

fn draw_somewhere(random: &mut Random, case: &Case) -> CaseDraw {
    let style = style(random);
    let vertices = triangles(random, style, case.size, 6);
    let shader: TestShader = match random.below(4) {
        0 => Colored.into(),
        1 => Sized(Some(12.0)).into(),
        _ => Probe::random(random).into(),
    };
    let mut draw = CaseDraw::new(shader, &vertices);
    draw.primitive.topology = random.pick(&[
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::LineList,
        PrimitiveTopology::PointList,
    ]);
    draw.primitive.polygon_mode =
        random.pick(&[PolygonMode::Fill, PolygonMode::Fill, PolygonMode::Line]);
    draw
}

/// Rows: A4.
#[test]
fn viewports() {
    check("window/viewports", 90, |random| {
        let mut case = Case::random_target(random);
        let mut draw = draw_somewhere(random, &case);
        draw.viewport = Some(random_viewport(random, case.size));
        case.draws.push(draw);
        case
    });
}

/// Returns true if a viewport is within the limits of `docs/NUMERICS.md`; all others are refused
/// (see the test `misuse` of `estampe`).
fn is_within_limits(viewport: &Viewport) -> bool {
    let corner = -32_768.0..=32_767.0;
    let is_side = |side: f32| side > 0.0 && side <= 32_768.0;
    let depth = 0.0..=1.0;
    corner.contains(&viewport.x)
        && corner.contains(&viewport.y)
        && is_side(viewport.width)
        && is_side(viewport.height)
        && depth.contains(&viewport.min_depth)
        && depth.contains(&viewport.max_depth)
}

/// Rows: A4.
#[test]
fn viewports_at_their_limits() {
    let mut drawn = 0;
    for seed in 0..80 {
        let random = &mut Random::new("window/limits", seed);
        let mut case = Case::new([20, 20], 1);
        let mut draw = draw_somewhere(random, &case);
        let mut numbers = [0.0, 0.0, 20.0, 20.0, 0.0, 1.0];
        let odd = [
            32_767.0,
            32_768.0,
            -32_768.0,
            -0.0,
            1.0,
            1.5,
            random.odd_number(),
        ];
        numbers[random.below(6) as usize] = random.pick(&odd);
        let [x, y, width, height, min_depth, max_depth] = numbers;
        let viewport = Viewport {
            x,
            y,
            width,
            height,
            min_depth,
            max_depth,
        };
        if is_within_limits(&viewport) {
            draw.viewport = Some(viewport);
            case.draws.push(draw);
            check_one("window/limits", &case);
            drawn += 1;
        }
    }
    assert!(drawn > 20, "{drawn} viewports were within the limits");
}

/// Rows: A4, R6.
#[test]
fn viewports_cut_pixels_by_their_samples() {
    check("window/viewport samples", 60, |random| {
        let size = random.pick(&[[33, 20], [63, 65], [70, 5]]);
        let mut case = Case::new(size, random.pick(&[2, 4, 4, 8, 16]));
        for _ in 0..2 {
            let mut draw = draw_somewhere(random, &case);
            draw.viewport = Some(random_viewport(random, case.size));
            draw.sample_shading = random.once_in(8);
            draw.primitive.conservative = random.pick(&[
                ConservativeMode::Disabled,
                ConservativeMode::Disabled,
                ConservativeMode::Overestimate,
            ]);
            case.draws.push(draw);
        }
        case
    });
}

/// A viewport that begins at x = 10.6 and ends at y = 7.3. The four samples of a pixel are at x =
/// 0.375, 0.875, 0.125 and 0.625 and y = 0.125, 0.375, 0.625 and 0.875: column 10 keeps the second
/// and the fourth, row 7 the first.
///
/// Rows: A4, R6.
#[test]
fn a_pixel_at_a_viewports_edge_keeps_the_samples_inside() {
    let mut case = Case::new([20, 12], 4);
    let everything = [[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]].map(|[x, y]| Vertex {
        position: [x, y, 0.5, 1.0],
        values: [1.0; 4],
    });
    let mut draw = CaseDraw::new(Colored, &everything);
    draw.primitive.cull_mode = CullMode::None;
    draw.viewport = Some(Viewport {
        x: 10.6,
        y: 2.0,
        width: 6.4,
        height: 5.3,
        min_depth: 0.0,
        max_depth: 1.0,
    });
    case.draws.push(draw);
    let image = check_one("window/a pixel at the edge", &case);
    for (sample, depths) in image.stored.depths.iter().enumerate() {
        for (at, &depth) in depths.iter().enumerate() {
            let (x, y) = (at % 20, at / 20);
            let column = (11..17).contains(&x) || x == 10 && sample % 2 == 1;
            let row = (2..7).contains(&y) || y == 7 && sample == 0;
            let expected: f32 = if column && row { 0.5 } else { 1.0 };
            assert_eq!(depth, expected.to_bits(), "sample {sample} of ({x}, {y})");
        }
    }
}

/// Rows: A4, O1, O2.
#[test]
fn scissors_and_viewports() {
    check("window/scissors", 60, |random| {
        let mut case = Case::random_target(random);
        for _ in 0..2 {
            let mut draw = draw_somewhere(random, &case);
            draw.scissor = Some(random_scissor(random, case.size));
            if random.once_in(2) {
                draw.viewport = Some(random_viewport(random, case.size));
            }
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: O1.
#[test]
fn targets_of_odd_sizes() {
    check("window/sizes", 12, |random| {
        let sizes = [
            [1, 1],
            [4096, 3],
            [3, 4096],
            [63, 65],
            [65, 63],
            [129, 2],
            [2, 1],
            [200, 130],
        ];
        let mut case = Case::new(random.pick(&sizes), random.pick(&[1, 4]));
        let mut draw = draw_somewhere(random, &case);
        draw.elements.end = draw.elements.end.min(12);
        case.draws.push(draw);
        case
    });
}
