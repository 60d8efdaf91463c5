//! Viewports, scissors and targets of odd sizes.

use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{Colored, Probe, Sized};
use estampe_tests::{Case, CaseDraw, Random, TestShader, check, check_one};
use estampe_types::state::{PolygonMode, PrimitiveTopology, ScissorRect, Viewport};

fn style(random: &mut Random) -> Style {
    random.pick(&Style::ALL)
}

fn random_viewport(random: &mut Random, size: [u32; 2]) -> Viewport {
    let [width, height] = size.map(|side| side as f32);
    let depths = [[0.0, 1.0], [1.0, 0.0], [0.25, 0.5], [0.9, 0.1], [0.5, 0.5]];
    let [min_depth, max_depth] = random.pick(&depths);
    let (x, y, w, h) = match random.below(4) {
        // Partly outside, anywhere.
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
        // Far off, or much larger than the target.
        2 => (
            random.range(-30_000.0, 100.0),
            random.range(-30_000.0, 100.0),
            random.range(1.0, 32_768.0),
            random.range(1.0, 32_768.0),
        ),
        // Sums that f32 would round: the edge of a pixel's centre, just missed.
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

/// Rows: A4.
#[test]
fn viewports_beyond_their_limits_draw_nothing() {
    // Few enough that all may be empty: a valid number may come out, too.
    for seed in 0..40 {
        let random = &mut Random::new("window/invalid", seed);
        let mut case = Case::new([20, 20], 1);
        let mut draw = draw_somewhere(random, &case);
        let mut numbers = [0.0, 0.0, 20.0, 20.0, 0.0, 1.0];
        let odd = [
            32_767.0,
            32_768.0,
            32_769.0,
            -32_769.0,
            -0.0,
            1.5,
            random.odd_number(),
        ];
        numbers[random.below(6) as usize] = random.pick(&odd);
        let [x, y, width, height, min_depth, max_depth] = numbers;
        draw.viewport = Some(Viewport {
            x,
            y,
            width,
            height,
            min_depth,
            max_depth,
        });
        case.draws.push(draw);
        check_one("window/invalid", &case);
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
