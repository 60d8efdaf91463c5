//! Integer lines, pipeline lines, polygon modes and points.

use super::*;
use crate::line::LinePath;
use crate::viewport::PixelBounds;

const EVERYWHERE: PixelBounds = PixelBounds {
    x: 0..1000,
    y: 0..1000,
};

fn integer(from: [i32; 2], to: [i32; 2]) -> Vec<[i32; 2]> {
    bresenham::line(from, to).collect()
}

/// Rows: R3.
#[test]
fn integer_lines_draw_both_ends_in_every_octant() {
    let mut random = Random::new(31);
    for _ in 0..2000 {
        let mut end = || [0, 1].map(|_| random.below(41) as i32 - 20);
        let (from, to) = (end(), end());
        let line = integer(from, to);
        assert_eq!((line.first(), line.last()), (Some(&from), Some(&to)));
        let longest = Ord::max((to[0] - from[0]).abs(), (to[1] - from[1]).abs());
        assert_eq!(line.len(), longest as usize + 1);

        // The reversed line covers the same pixels.
        let mut back = integer(to, from);
        back.reverse();
        assert_eq!(line, back);

        // No pixel is further than half a pixel from the line: |cross product| ≤ half the length.
        for [x, y] in line {
            let cross = (to[0] - from[0]) * (y - from[1]) - (to[1] - from[1]) * (x - from[0]);
            assert!(2 * cross.abs() <= longest, "{from:?} to {to:?} at {x}, {y}");
        }
    }
}

/// Rows: R3.
#[test]
fn integer_lines_plot_then_step_and_ties_stay() {
    // A common mistake, stepping before plotting, would give (0, 1)…(5, 6).
    assert_eq!(integer([0, 0], [2, 2]), [[0, 0], [1, 1], [2, 2]]);
    // At x = 1 the line is at exactly ½: it stays, in both directions.
    assert_eq!(integer([0, 0], [2, 1]), [[0, 0], [1, 0], [2, 1]]);
    assert_eq!(integer([2, 1], [0, 0]), [[2, 1], [1, 0], [0, 0]]);
    assert_eq!(integer([0, 0], [2, -1]), [[0, 0], [1, 0], [2, -1]]);
    assert_eq!(integer([0, 0], [1, 2]), [[0, 0], [0, 1], [1, 2]]);
    assert_eq!(integer([3, 3], [3, 3]), [[3, 3]]);
    // The longest lines do not overflow.
    let mut far = bresenham::line([i32::MIN, i32::MAX], [i32::MAX, i32::MIN]);
    assert_eq!(far.nth(5), Some([i32::MIN + 5, i32::MAX - 5]));
}

/// The pixels of the pipeline line between two points in pixels.
fn pipeline(from: [f32; 2], to: [f32; 2]) -> Vec<[u32; 2]> {
    LinePath::new(from.map(viewport::snap), to.map(viewport::snap)).pixels(&EVERYWHERE)
}

/// Rows: R3.
#[test]
fn pipeline_lines_include_their_start_and_not_their_end() {
    assert_eq!(pipeline([0.5, 0.5], [3.5, 0.5]), [[0, 0], [1, 0], [2, 0]]);
    assert_eq!(pipeline([3.5, 0.5], [0.5, 0.5]), [[3, 0], [2, 0], [1, 0]]);
    assert_eq!(pipeline([0.5, 0.5], [0.5, 2.5]), [[0, 0], [0, 1]]);
    assert_eq!(pipeline([1.5, 2.5], [1.5, 0.5]), [[1, 2], [1, 1]]);
    // Equal extents are x-major; the row is the one that holds y at the column's centre.
    assert_eq!(pipeline([0.5, 0.5], [2.5, 2.5]), [[0, 0], [1, 1]]);
    assert_eq!(pipeline([0.25, 0.25], [2.25, 1.0]), [[0, 0], [1, 0]]);
    // y = 1 exactly at x = 1.5 belongs to row 1.
    assert_eq!(pipeline([0.5, 0.5], [2.5, 1.5]), [[0, 0], [1, 1]]);
    // Too short to reach a centre, and without length.
    assert_eq!(pipeline([0.6, 0.5], [1.4, 0.5]), [[0_u32; 2]; 0]);
    assert_eq!(pipeline([0.5, 0.5], [0.5, 0.5]), [[0_u32; 2]; 0]);
}

/// Rows: R3.
#[test]
fn a_strip_along_one_direction_touches_no_pixel_twice() {
    let mut random = Random::new(32);
    for _ in 0..500 {
        // A chain of points along one x-major direction: every column once, without holes.
        let slope = random.range(-1.0, 1.0);
        let mut x = random.range(1.0, 3.0);
        let mut chain = vec![[x, 100.0 + slope * x]];
        for _ in 0..6 {
            x += random.range(0.05, 9.0);
            chain.push([x, 100.0 + slope * x]);
        }
        if random.below(2) == 0 {
            chain.reverse();
        }
        let mut columns: Vec<u32> = chain
            .windows(2)
            .flat_map(|pair| pipeline(pair[0], pair[1]))
            .map(|[x, _]| x)
            .collect();
        if chain[0][0] > chain[1][0] {
            columns.reverse();
        }
        assert!(
            columns.windows(2).all(|pair| pair[1] == pair[0] + 1),
            "{columns:?}"
        );
        assert!(columns.len() as f32 + 2.0 > x - 3.0);
    }
}

/// Rows: R3, R5.
#[test]
fn lines_interpolate_depth_and_varyings() {
    let mut target = unorm(8, 1, 4);
    let state = State {
        primitive: PrimitiveState {
            topology: PrimitiveTopology::LineList,
            ..PrimitiveState::default()
        },
        depth: Some(DepthState::LESS_WRITE),
        ..State::new(8, 1)
    };
    // From w = 1 at x = 0 to w = 3 at x = 8, along the middle row.
    let vertices = [
        ([-1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.2]),
        ([3.0, 0.0, 1.5, 3.0], [1.0, 1.0, 0.4]),
    ];
    let counts = draw_plain(&mut target, &state, &vertices);
    assert_eq!((counts.fragments, counts.samples_passed), (8, 32));
    // Pixel 2: t = 2.5/8; depth 0.5·t; smooth t/3 ÷ (t/3 + 1 − t).
    let t = 2.5_f32 / 8.0;
    for sample in 0..4 {
        assert_eq!(target.depth[2 * 4 + sample], 0.5 * t);
        let code = target.color[2 * 4 + sample];
        assert_eq!(code[0], 34); // 0.131579·255 = 33.55
        assert_eq!(code[1], 80); // 0.3125·255 = 79.69
        assert_eq!(code[2], 51);
    }
}

/// Rows: A5.
#[test]
fn polygon_modes_draw_edges_and_vertices_of_unculled_triangles() {
    let image = |polygon_mode, cull_mode| {
        let mut target = unorm(8, 8, 1);
        let state = State {
            primitive: PrimitiveState {
                polygon_mode,
                cull_mode,
                ..PrimitiveState::default()
            },
            ..State::new(8, 8)
        };
        // Counter-clockwise as seen: down the left side first.
        let vertices =
            [(1.5, 1.5), (1.5, 6.5), (6.5, 1.5)].map(|(x, y)| (at(&target, x, y, 0.0), [1.0; 3]));
        draw_plain(&mut target, &state, &vertices);
        let set = (0_u32..).zip(target.color).filter(|(_, code)| code[3] != 0);
        set.map(|(index, _)| [index % 8, index / 8])
            .collect::<Vec<_>>()
    };
    assert_eq!(image(PolygonMode::Line, CullMode::Front), [[0; 2]; 0]);
    let points = image(PolygonMode::Point, CullMode::Back);
    assert_eq!(points, [[1, 1], [6, 1], [1, 6]]);
    let outline = image(PolygonMode::Line, CullMode::Back);
    assert_eq!(outline.len(), 15, "three edges of five pixels: {outline:?}");
    assert!(outline.contains(&[1, 4]) && outline.contains(&[4, 1]) && outline.contains(&[3, 4]));
    assert!(!outline.contains(&[2, 2]), "no inside");
}

#[test]
fn a_clipped_outline_shows_no_diagonals() {
    // A triangle that pierces the near plane: its outline stays two edges, cut.
    let mut target = unorm(16, 16, 1);
    let state = State {
        primitive: PrimitiveState {
            polygon_mode: PolygonMode::Line,
            ..PrimitiveState::default()
        },
        ..State::new(16, 16)
    };
    let vertices = [
        ([-0.5, -0.75, -1.0, 1.0], [1.0; 3]),
        ([0.5, -0.75, -1.0, 1.0], [1.0; 3]),
        ([0.0, 0.75, 1.0, 1.0], [1.0; 3]),
    ];
    let counts = draw_plain(&mut target, &state, &vertices);
    assert_eq!(
        counts.rasterized, 2,
        "the edge in front of the near plane is gone"
    );
    let rows = target
        .color
        .chunks(16)
        .map(|row| row.iter().filter(|code| code[3] != 0).count());
    assert!(rows.into_iter().all(|count| count <= 2));
}

/// Rows: R4.
#[test]
fn points_are_half_open_squares() {
    let cover = |x: f32, y: f32, size: f32, samples| {
        let center = [x, y].map(viewport::snap);
        point::cover(center, size, &EVERYWHERE, samples)
    };
    // One pixel around a centre; around a corner the lower right of the four.
    let one = cover(2.5, 3.5, 1.0, 1);
    assert_eq!(
        (one.len(), one[0].origin, one[0].samples),
        (1, [2, 2], [0, 0, 1, 0])
    );
    let corner = cover(1.0, 1.0, 1.0, 1);
    assert_eq!((corner.len(), corner[0].samples), (1, [1, 0, 0, 0]));
    let four = cover(2.0, 2.0, 4.0, 1);
    assert_eq!(
        four.iter()
            .map(|quad| quad.samples.iter().sum::<u16>())
            .sum::<u16>(),
        16
    );
    // Shifted by half a pixel it covers samples of several pixels.
    let shifted = cover(1.0, 0.5, 1.0, 4);
    assert_eq!(shifted[0].samples, [0b1010, 0b0101, 0, 0]);
    // Sizes are clamped; NaN is one pixel.
    assert_eq!(point::half_width_subpixel(f32::NAN), 128);
    assert_eq!(point::half_width_subpixel(0.0), 128);
    assert_eq!(point::half_width_subpixel(1e9), 1024 * 128);
}
