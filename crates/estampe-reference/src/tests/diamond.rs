//! Pipeline lines against Vulkan's diamond-exit rule, computed literally; wide, rectangular and
//! stippled lines; points.

use super::*;
use crate::line::LinePath;
use crate::rectangle::LineRectangle;
use crate::viewport::PixelBounds;

const EVERYWHERE: PixelBounds = PixelBounds { x: 0..64, y: 0..64 };

/// Subdivisions of 1/256 pixel, fine enough for the rule's perturbation of ε and ε².
const SCALE: i128 = 1 << 24;

/// The fragments of the diamond-exit rule: those whose diamond |x − xf| + |y − yf| < ½ the segment
/// meets, except the one that contains its end. The ends are moved by (−ε, −ε²). Exact.
fn diamonds(from: [i32; 2], to: [i32; 2]) -> Vec<[i64; 2]> {
    let perturbed =
        |[x, y]: [i32; 2]| [i128::from(x) * SCALE - (1 << 12), i128::from(y) * SCALE - 1];
    // In u = x + y and v = x − y diamonds are squares.
    let turned = |[x, y]: [i128; 2]| [x + y, x - y];
    let (a, b) = (turned(perturbed(from)), turned(perturbed(to)));
    let half = 128 * SCALE;
    let mut found = Vec::new();
    let range = |axis: usize| {
        let (p, q) = (from[axis], to[axis]);
        Ord::min(p, q).div_euclid(256) - 1..=Ord::max(p, q).div_euclid(256) + 1
    };
    for y in range(1) {
        for x in range(0) {
            let center = [x, y].map(|at| (i128::from(at) * 256 + 128) * SCALE);
            let center = turned(center);
            let is_inside = |p: [i128; 2]| (0..2).all(|k| (p[k] - center[k]).abs() < half);
            if !is_inside(b) && meets(a, b, center, half) {
                found.push([i64::from(x), i64::from(y)]);
            }
        }
    }
    found
}

/// Returns true if a segment meets an open square.
fn meets(a: [i128; 2], b: [i128; 2], center: [i128; 2], half: i128) -> bool {
    // The open interval of t in which the segment is inside, as fractions with positive
    // denominators.
    let (mut low, mut high) = ((-1, 1), (2, 1));
    let less = |p: (i128, i128), q: (i128, i128)| p.0 * q.1 < q.0 * p.1;
    for k in 0..2 {
        let (c, d) = (a[k] - center[k], b[k] - a[k]);
        if d == 0 {
            if c.abs() >= half {
                return false;
            }
            continue;
        }
        let ends = [(-half - c) * d.signum(), (half - c) * d.signum()];
        let from = (Ord::min(ends[0], ends[1]), d.abs());
        let to = (Ord::max(ends[0], ends[1]), d.abs());
        low = if less(low, from) { from } else { low };
        high = if less(to, high) { to } else { high };
    }
    less(low, high) && less(low, (1, 1)) && less((0, 1), high)
}

fn random_end(random: &mut Random) -> [i32; 2] {
    // Ends on multiples of 1/256 pixel, or on centres and corners only.
    let step = [1, 1, 128][random.below(3) as usize];
    [0, 1].map(|_| (random.below(40 * 256) as i32 + 12 * 256) / step * step)
}

/// Rows: R3.
#[test]
fn lines_between_centres_are_those_of_the_diamond_exit_rule() {
    let mut random = Random::new(71);
    for _ in 0..400 {
        let mut end = || [0, 1].map(|_| random.below(30) as i32 * 256 + 128);
        let (from, to) = (end(), end());
        let mine = LinePath::new(from, to).pixels(&EVERYWHERE);
        let mut mine: Vec<_> = mine.iter().map(|pixel| pixel.map(i64::from)).collect();
        let mut ideal = diamonds(from, to);
        mine.sort_unstable();
        ideal.sort_unstable();
        // If the line passes half-way between two centres, both are as near; otherwise all agree.
        let [dx, dy] = [0, 1].map(|k: usize| i64::from((to[k] - from[k]).abs() / 256));
        let (longer, shorter) = (Ord::max(dx, dy), Ord::min(dx, dy));
        let has_ties = (0..longer).any(|step| (2 * step * shorter) % (2 * longer) == longer);
        if !has_ties {
            assert_eq!(mine, ideal, "{from:?} to {to:?}");
        }
        assert_eq!(mine.len(), ideal.len(), "{from:?} to {to:?}");
    }
}

/// Rows: R3.
#[test]
fn lines_between_any_ends_keep_vulkans_rules() {
    let mut random = Random::new(73);
    let mut same = 0;
    for _ in 0..1500 {
        let (from, to) = (random_end(&mut random), random_end(&mut random));
        let mine = LinePath::new(from, to).pixels(&EVERYWHERE);
        let ideal = diamonds(from, to);
        // 1. No fragment is more than one pixel away from one of the diamond-exit rule.
        for pixel in &mine {
            let is_near =
                |other: &[i64; 2]| (0..2).all(|k| (i64::from(pixel[k]) - other[k]).abs() <= 1);
            assert!(
                ideal.is_empty() || ideal.iter().any(is_near),
                "{from:?} to {to:?}"
            );
        }
        // 2. The numbers of fragments differ by at most one; by at most one at each end if an end
        //    lies exactly on the edge of a diamond, where the rule's perturbation decides and the
        //    pipeline does not perturb.
        let is_on_edge = |[x, y]: [i32; 2]| {
            let off = |at: i32| (at.rem_euclid(256) - 128).abs();
            off(x) + off(y) == 128
        };
        let most = if is_on_edge(from) || is_on_edge(to) {
            2
        } else {
            1
        };
        let difference = mine.len().abs_diff(ideal.len());
        assert!(difference <= most, "{from:?} to {to:?}");
        // 3. No two fragments share a column (of a y-major line: a row).
        let major = usize::from((to[1] - from[1]).abs() > (to[0] - from[0]).abs());
        let mut columns: Vec<_> = mine.iter().map(|pixel| pixel[major]).collect();
        columns.sort_unstable();
        assert!(columns.windows(2).all(|pair| pair[0] + 1 == pair[1]));
        same += u32::from(mine.len() == ideal.len());
    }
    assert!(
        same > 700,
        "only {same} lines have as many fragments as the rule says"
    );
}

/// Rows: R3.
#[test]
fn lines_that_go_on_in_one_direction_leave_no_gap_and_touch_no_pixel_twice() {
    let mut random = Random::new(79);
    for _ in 0..1500 {
        let [a, b] = [0; 2].map(|_| random_end(&mut random));
        let c = random_end(&mut random);
        let way = |p: [i32; 2], q: [i32; 2]| [q[0] - p[0], q[1] - p[1]];
        let class = |[x, y]: [i32; 2]| {
            let major = usize::from(y.abs() > x.abs());
            (major, [x, y][major].signum())
        };
        if class(way(a, b)) != class(way(b, c)) {
            continue;
        }
        let major = class(way(a, b)).0;
        let pixels =
            [LinePath::new(a, b), LinePath::new(b, c)].map(|path| path.pixels(&EVERYWHERE));
        let mut columns: Vec<_> = pixels.concat().iter().map(|pixel| pixel[major]).collect();
        columns.sort_unstable();
        assert!(
            columns.windows(2).all(|pair| pair[0] + 1 == pair[1]),
            "{a:?} {b:?} {c:?}"
        );
    }
}

/// Rows: R3.
#[test]
fn wide_lines_are_columns_around_the_thin_one() {
    let (from, to) = (
        [10 * 256 + 128, 20 * 256 + 128],
        [20 * 256 + 128, 20 * 256 + 128],
    );
    for width in 1..6 {
        let path = LinePath::new(from, to).widened(width);
        let mut rows: Vec<_> = path
            .wide_pixels(width, &EVERYWHERE)
            .iter()
            .map(|(_, [_, y])| i64::from(*y))
            .collect();
        rows.sort_unstable();
        rows.dedup();
        // Odd widths lie evenly around the line; even ones have one more row below it.
        let first = 20 - width / 2 + i64::from(width % 2 == 0);
        let first_even = 20 - width / 2;
        let wanted: Vec<_> = (0..width).map(|row| first + row).collect();
        let wanted_even: Vec<_> = (0..width).map(|row| first_even + row).collect();
        assert!(rows == wanted || rows == wanted_even, "{width}: {rows:?}");
        assert_eq!(
            path.wide_pixels(width, &EVERYWHERE).len() as i64,
            10 * width
        );
    }
}

/// Draws white lines through points in pixels and returns the white pixels of the target.
fn drawn(size: [u32; 2], primitive: PrimitiveState, places: &[[f32; 2]]) -> Vec<[u32; 2]> {
    let mut target = unorm(size[0], size[1], 1);
    let state = State {
        primitive,
        ..State::new(size[0], size[1])
    };
    let vertices: Vec<_> = places
        .iter()
        .map(|&[x, y]| (at(&target, x, y, 0.5), [1.0; 3]))
        .collect();
    draw_plain(&mut target, &state, &vertices);
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
    pixels
        .zip(&target.color)
        .filter(|(_, codes)| codes[3] != 0)
        .map(|(pixel, _)| pixel)
        .collect()
}

/// Rows: R3.
#[test]
fn widths_are_rounded_half_up() {
    for (width, rows) in [
        (0.01, 1),
        (0.5, 1),
        (1.0, 1),
        (1.499, 1),
        (1.5, 2),
        (2.499, 2),
        (2.5, 3),
        (3.499, 3),
        (3.5, 4),
        (4.5, 5),
        (63.5, 64),
        (64.0, 64),
    ] {
        let primitive = PrimitiveState {
            topology: PrimitiveTopology::LineList,
            line: LineState {
                width,
                ..LineState::default()
            },
            ..PrimitiveState::default()
        };
        let pixels = drawn([8, 80], primitive, &[[1.5, 40.5], [6.5, 40.5]]);
        assert_eq!(pixels.len(), 5 * rows, "{width} pixels wide");
    }
}

/// Rows: R3.
#[test]
fn stippled_rectangles_of_a_strip_carry_the_rest_of_a_pixel() {
    let shown = |topology, factor, pattern, places: &[f32]| {
        let primitive = PrimitiveState {
            topology,
            line: LineState {
                width: 1.0,
                rasterization: LineRasterization::Rectangular,
                stipple: Some(LineStipple { factor, pattern }),
            },
            ..PrimitiveState::default()
        };
        let places: Vec<_> = places.iter().map(|&x| [x, 2.5]).collect();
        let pixels = drawn([32, 5], primitive, &places);
        assert!(pixels.iter().all(|&[_, y]| y == 2));
        pixels.iter().map(|&[x, _]| x).collect::<Vec<_>>()
    };
    // The pattern continues over the strip as over one line, whatever the lengths of its parts: 2.4
    // pixels leave 0.6 of the third pixel for the next line, and so on. Lengths rounded to pixels
    // would draw pixel 5 in place of 6.
    let strip = [0.0, 2.4, 4.8, 7.2, 7.3, 7.4, 20.0];
    let strip_of = PrimitiveTopology::LineStrip;
    let every_other: Vec<u32> = (0..20).step_by(2).collect();
    assert_eq!(shown(strip_of, 1, 0x5555, &strip), every_other);
    assert_eq!(shown(strip_of, 1, 0x5555, &[0.0, 20.0]), every_other);
    // Each bit lasts three pixels: 0 to 2, and from 6 on every other three.
    let threes: Vec<u32> = (0..20).filter(|x| x / 3 % 2 == 0).collect();
    assert_eq!(shown(strip_of, 3, 0x5555, &strip), threes);
    // Each line of a list restarts the pattern: the second at 2.5, so its pixels 2 and 3 are ½ and
    // 1½ from there.
    let list = [0.0, 2.5, 2.5, 6.0];
    let pixels = shown(PrimitiveTopology::LineList, 1, 0x5555, &list);
    assert_eq!(pixels, [0, 2, 4]);
}

/// Rows: R3.
#[test]
fn rectangles_around_lines_have_the_lines_length_and_width() {
    // Exact along an axis; and two adjacent rectangles cover no sample twice.
    let rectangle = LineRectangle::new([0, 1024], [2560, 1024], 4.0);
    let pixels: u32 = rectangle
        .cover(&EVERYWHERE, 1)
        .iter()
        .map(|quad| {
            quad.samples
                .iter()
                .map(|mask| u32::from(mask & 1))
                .sum::<u32>()
        })
        .sum();
    assert_eq!(pixels, 40);
    assert_eq!(rectangle.sixteenths([3, 2]), 16);
    assert_eq!(rectangle.sixteenths([3, 1]), 0);
    let thin = LineRectangle::new([0, 1024], [2560, 1024], 0.5);
    assert_eq!(thin.sixteenths([3, 3]) + thin.sixteenths([3, 4]), 8);
    // Pixel 7's centre is 7½ pixels from the start, in 1/65536 pixel.
    assert_eq!(thin.distance_65536([7, 4]), 491_520);
    assert_eq!(thin.length_65536(), 655_360);
    // A line without length covers nothing.
    assert!(
        LineRectangle::new([700; 2], [700; 2], 9.0)
            .cover(&EVERYWHERE, 1)
            .is_empty()
    );

    let mut random = Random::new(83);
    for _ in 0..300 {
        let (from, to) = (random_end(&mut random), random_end(&mut random));
        let width = random.range(0.5, 12.0);
        let rectangle = LineRectangle::new(from, to, width);
        let covered: u32 = rectangle
            .cover(&EVERYWHERE, 4)
            .iter()
            .map(|quad| {
                quad.samples
                    .iter()
                    .map(|mask| mask.count_ones())
                    .sum::<u32>()
            })
            .sum();
        let [dx, dy] = [0, 1].map(|k: usize| f64::from(to[k] - from[k]) / 256.0);
        let length = (dx * dx + dy * dy).sqrt();
        let area = length * f64::from(width);
        // The number of samples differs from four times the area by at most the samples near its
        // outline.
        let slack = 4.0 * 1.5 * 2.0 * (length + f64::from(width)) + 8.0;
        assert!((f64::from(covered) - 4.0 * area).abs() <= slack);
    }
}

/// Rows: R4.
#[test]
fn a_strip_of_four_vertices_fills_a_rectangle_exactly() {
    // Rectangles (row R4): each sample of the half-open rectangle is covered once, and no other
    // sample.
    let mut random = Random::new(89);
    for round in 0..400 {
        let samples = [1, 4][round % 2];
        let [(x0, x1), (y0, y1)] = [0; 2].map(|_| {
            let (a, b) = (random.below(2560) as i32, random.below(2560) as i32);
            (Ord::min(a, b), Ord::max(a, b))
        });
        let strip = [[x0, y0], [x0, y1], [x1, y0], [x1, y1]];
        let bounds = PixelBounds { x: 0..10, y: 0..10 };
        let mut hits = std::collections::HashMap::new();
        for corners in [[0, 1, 2], [1, 3, 2]] {
            let corners = corners.map(|k: usize| strip[k]);
            for quad in raster::triangle(corners, &bounds, samples) {
                for lane in 0..4 {
                    for s in 0..samples {
                        let pixel = raster::QuadCoverage::pixel(quad.origin, lane);
                        let covered = quad.samples[lane] >> s & 1;
                        *hits.entry((pixel, s)).or_insert(0) += u32::from(covered);
                    }
                }
            }
        }
        for y in 0..10 {
            for x in 0..10 {
                for (s, &sample) in (0..).zip(raster::sample_positions(samples)) {
                    let [sx, sy] = raster::sample_subpixel([x, y].map(i64::from), sample);
                    let inside = (i64::from(x0)..i64::from(x1)).contains(&sx)
                        && (i64::from(y0)..i64::from(y1)).contains(&sy);
                    let found = hits.get(&([x, y], s)).copied().unwrap_or(0);
                    assert_eq!(found, u32::from(inside), "sample {s} of ({x}, {y})");
                }
            }
        }
    }
}

/// Rows: R4.
#[test]
fn round_points_are_discs() {
    let center = [32 * 256, 32 * 256];
    let pixels = |size| {
        let quads = point::cover_round(center, size, &EVERYWHERE, 1);
        quads
            .iter()
            .map(|q| q.samples.iter().map(|m| u32::from(m & 1)).sum::<u32>())
            .sum::<u32>()
    };
    // Of two by two pixels around a corner all centres are within 1 pixel; of four by four all
    // except the corners.
    assert_eq!([2.0, 4.0].map(pixels), [4, 12]);
    for size in [9.0, 30.0, 60.0] {
        let area = std::f32::consts::PI * size * size / 4.0;
        assert!((pixels(size) as f32 - area).abs() < 2.0 * size);
    }
}

/// Rows: A5, D1.
#[test]
fn the_unit_of_float_depths_is_their_last_bit() {
    for depth in [1.0_f32, 0.75, 0.5, 0.3, 1e-3, 1e-30, 1e-37, 1e-44, 0.0] {
        let next = f32::from_bits(depth.to_bits() + 1);
        assert_eq!(depth_bias::float_unit(depth), next - depth, "{depth:e}");
    }
}
