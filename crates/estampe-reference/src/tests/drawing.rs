//! Whole draws into small targets: coverage, interpolation, depth, scissor, multisampling, depth
//! bias.

use super::*;

fn pixels(target: &Target) -> Vec<String> {
    target
        .color
        .chunks(target.width as usize * target.samples as usize)
        .map(|row| {
            row.iter()
                .map(|code| if code[3] == 0 { '.' } else { '#' })
                .collect()
        })
        .collect()
}

/// Rows: R1.
#[test]
fn a_right_triangle_covers_what_the_top_left_rule_says() {
    // The hypotenuse from (4, 0) to (0, 4) passes through pixel centres (3.5, 0.5), …; it is a
    // right edge, so they are not covered.
    let mut target = unorm(4, 4, 1);
    let corner = |x, y| (at(&target, x, y, 0.0), [1.0, 0.5, 0.25]);
    let vertices = [corner(0.0, 0.0), corner(0.0, 4.0), corner(4.0, 0.0)];
    let state = State::new(4, 4);
    let counts = draw_plain(&mut target, &state, &vertices);
    assert_eq!(pixels(&target), ["###.", "##..", "#...", "...."]);
    assert_eq!(target.color[0], [255, 128, 64, 255]);
    assert_eq!(counts.fragments, 6);

    // The other half covers exactly the remaining pixels: the hypotenuse is its left edge.
    let mut other = unorm(4, 4, 1);
    let vertices =
        [(4.0, 4.0), (4.0, 0.0), (0.0, 4.0)].map(|(x, y)| (at(&other, x, y, 0.0), [1.0, 1.0, 1.0]));
    draw_plain(&mut other, &state, &vertices);
    assert_eq!(pixels(&other), ["...#", "..##", ".###", "####"]);
}

/// Rows: V1, R5.
#[test]
fn a_perspective_triangle_interpolates_smooth_affine_and_flat() {
    // Two vertices at w = 1 on the left, one at w = 3 on the right edge of a 4-pixel target.
    let mut target = unorm(4, 4, 1);
    let vertices = [
        ([-1.0, 1.0, 0.0, 1.0], [0.0, 0.0, 0.2]),
        ([-1.0, -1.0, 0.0, 1.0], [0.0, 0.0, 0.4]),
        ([3.0, 3.0, 0.0, 3.0], [1.0, 1.0, 0.6]),
    ];
    draw_plain(&mut target, &State::new(4, 4), &vertices);
    // At the centre of pixel (2, 0), x = 2.5: affine weight of the third vertex 2.5/4; smooth
    // weight (2.5/4·⅓) ÷ (2.5/4·⅓ + 1.5/4) = 5/14.
    let [smooth, affine, flat, _] = target.color[2];
    assert_eq!(affine, 159); // ⌊0.625·255 + ½⌋
    assert_eq!(smooth, 91); // ⌊0.35714·255 + ½⌋
    assert_eq!(flat, 51); // the first vertex's 0.2
}

/// Rows: O4.
#[test]
fn the_nearer_triangle_wins_in_any_order_and_the_depth_is_stored() {
    let state = State {
        depth: Some(DepthState::LESS_WRITE),
        ..State::new(2, 2)
    };
    let full = |z: f32, value: f32| {
        [[-1.0, 1.0], [-1.0, -3.0], [3.0, 1.0]].map(|[x, y]| ([x, y, z, 1.0], [value; 3]))
    };
    for order in [[0.25, 0.75], [0.75, 0.25]] {
        let mut target = unorm(2, 2, 1);
        for z in order {
            draw_plain(&mut target, &state, &full(z, z));
        }
        assert_eq!(target.depth, [0.25; 4]);
        assert!(target.color.iter().all(|&code| code == [64, 64, 64, 255]));
    }
}

/// Discards where the window x is below 2, writes x/8 as depth, and outputs derivatives.
struct Probe;

estampe_types::shader! {
    impl Shader for Probe {
        type Attributes<R: Real> = (Vec4<R>, Vec3<R>);
        type Varyings<R: Real> = [R; 1];

        fn vertex<R: Real>(
            &self,
            _input: shader::VertexIn<'_, R>,
            (position, value): (Vec4<R>, Vec3<R>),
        ) -> shader::VertexOut<R, [R; 1]> {
            shader::VertexOut::new(position, [value.x])
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, [value]: [R; 1]) -> FragmentOut<R> {
            let p = input.position;
            let front = R::select(input.front_facing, p.x.splat(1.0), p.x.splat(0.0));
            let color = Vec4::new(value.ddx(), value.ddy(), front, p.w);
            FragmentOut::color(color)
                .discard_unless(p.x.gt(p.x.splat(2.0)))
                .with_depth(p.x * 0.25 - 1.0)
        }
    }
}

/// Rows: F1, R7.
#[test]
fn shaders_discard_write_depth_and_see_derivatives_and_position() {
    let state = State {
        depth: Some(DepthState::LESS_WRITE),
        primitive: PrimitiveState {
            front_face: FrontFace::Cw,
            ..PrimitiveState::default()
        },
        ..State::new(8, 8)
    };
    let mut target = unorm(8, 8, 1);
    // The value is x/10 + y/5 in pixels; w is 2 everywhere.
    let vertices = [(0.0, 0.0), (0.0, 8.0), (8.0, 0.0)].map(|(x, y)| {
        let position = at(&target, x, y, 0.5).map(|component| component * 2.0);
        (position, [x / 10.0 + y / 5.0, 0.0, 0.0])
    });
    let counts = draw_with(&mut target, &Probe, &state, &vertices);
    assert_eq!(counts.fragments, 28);
    // Columns 0 and 1, of seven and six pixels, are discarded; no depth clamps to the cleared 1.
    assert_eq!(counts.samples_passed, 28 - 7 - 6);
    let kept = target.index([2, 1], 0);
    // ∂/∂x = 0.1 → 26 (25.5 + ½), ∂/∂y = 0.2 → 51, back-facing, 1/w = ½ → 128.
    let [dx, dy, front, w] = target.color[kept];
    assert!((25..=26).contains(&dx));
    assert_eq!([dy, front, w], [51, 0, 128]);
    assert_eq!(
        target.depth[kept], 0.0,
        "2.5·¼ − 1 < 0 is clamped to the range"
    );
    assert_eq!(target.depth[target.index([5, 0], 0)], 5.5 * 0.25 - 1.0);
    assert_eq!(target.color[target.index([1, 1], 0)], [0; 4]);
    assert_eq!(target.depth[target.index([1, 1], 0)], 1.0);
}

/// Rows: A4, O2.
#[test]
fn the_scissor_and_the_viewport_limit_drawing() {
    let mut target = unorm(8, 8, 1);
    let state = State {
        viewport: Viewport {
            x: 2.0,
            y: 1.0,
            width: 4.0,
            height: 4.0,
            min_depth: 0.25,
            max_depth: 0.75,
        },
        scissor: ScissorRect {
            x: 0,
            y: 2,
            width: 5,
            height: 100,
        },
        depth: Some(DepthState {
            write_enabled: true,
            compare: CompareFunction::Always,
        }),
        ..State::new(8, 8)
    };
    // Four times the viewport's size, z = 1: it is not clipped, because the guard band contains it;
    // the bounds cut it.
    let vertices =
        [[-4.0, 4.0], [-4.0, -12.0], [12.0, 4.0]].map(|[x, y]| ([x, y, 1.0, 1.0], [1.0; 3]));
    draw_plain(&mut target, &state, &vertices);
    let rows = ["........", "........", "..###...", "..###...", "..###..."];
    assert_eq!(pixels(&target)[..5], rows);
    assert!(pixels(&target)[5..].iter().all(|row| row == "........"));
    assert_eq!(target.depth[target.index([2, 2], 0)], 0.75);
}

/// Rows: R6.
#[test]
fn multisampling_covers_samples_and_shades_pixels_once() {
    let mut target = unorm(2, 1, 4);
    // The left three eighths of pixel 0: only the sample at x = 2/16 (the one at 6/16 lies on the
    // right edge).
    let strip = [(0.0, 0.0), (0.0, 1.0), (0.375, 0.0), (0.375, 1.0)]
        .map(|(x, y)| (at(&target, x, y, 0.0), [1.0; 3]));
    let state = State {
        primitive: PrimitiveState {
            topology: PrimitiveTopology::TriangleStrip,
            ..PrimitiveState::default()
        },
        ..State::new(2, 1)
    };
    let counts = draw_plain(&mut target, &state, &strip);
    let covered: Vec<_> = target.color.iter().map(|code| code[3] == 255).collect();
    assert_eq!(
        covered,
        [false, false, true, false, false, false, false, false]
    );
    assert_eq!(counts.samples_covered, 1);
    assert_eq!(target.resolve(0)[0], [64; 4]); // 63.75
}

/// It has no assertions: it tests that nothing panics in a build with overflow checks. The images
/// of such input are compared with the core's in `estampe-tests`.
#[test]
fn nothing_hostile_panics() {
    let mut random = Random::new(51);
    let odd = [
        f32::NAN,
        f32::INFINITY,
        -1e38,
        1e38,
        0.0,
        -0.0,
        1e-45,
        1.0,
        -1.0,
        3e-39,
    ];
    for round in 0..3000 {
        let topology = [
            PrimitiveTopology::TriangleList,
            PrimitiveTopology::LineLoop,
            PrimitiveTopology::PointList,
        ][round % 3];
        let mut number = || odd[random.below(10) as usize];
        let vertices: Vec<Vertex> = (0..6)
            .map(|_| {
                (
                    std::array::from_fn(|_| number()),
                    std::array::from_fn(|_| number()),
                )
            })
            .collect();
        let mut state = State::new(4, 4);
        state.primitive.topology = topology;
        if round % 5 == 0 {
            state.viewport.x = number();
            state.viewport.width = number();
            state.viewport.min_depth = number();
        }
        draw_plain(&mut unorm(4, 4, 4), &state, &vertices);
    }
}

#[test]
fn depth_bias_is_vulkans_sum_of_slope_and_constant() {
    // Depth rises by 1/64 a pixel in x, and by half of that in y, from 1/4 at the corner; the
    // greatest depth of the triangle, 5/8, lies in 0.5..1, where a float's last bit is 2⁻²⁴.
    let bias = |constant, slope_scale, clamp, unit| {
        let mut target = unorm(8, 8, 1);
        let corner = |x: f32, y: f32| (at(&target, x, y, 0.25 + x / 64.0 + y / 128.0), [0.0; 3]);
        let vertices = [corner(0.0, 0.0), corner(0.0, 16.0), corner(24.0, 0.0)];
        let state = State {
            depth: Some(DepthState {
                write_enabled: true,
                compare: CompareFunction::Always,
            }),
            depth_bias: DepthBiasState {
                constant,
                slope_scale,
                clamp,
            },
            depth_bias_unit: unit,
            ..State::new(8, 8)
        };
        draw_plain(&mut target, &state, &vertices);
        // Pixel (3, 2): at its centre depth is exactly 0.25 + 3.5/64 + 2.5/128.
        target.depth[2 * 8 + 3] - (0.25 + 3.5 / 64.0 + 2.5 / 128.0)
    };
    assert_eq!(bias(0.0, 0.0, 0.0, None), 0.0);
    assert_eq!(bias(0.0, 2.0, 0.0, None), 2.0 / 64.0);
    assert_eq!(bias(8.0, 0.0, 0.0, None), 8.0 / 16_777_216.0);
    assert_eq!(
        bias(-16.0, -1.0, 0.0, None),
        -1.0 / 64.0 - 16.0 / 16_777_216.0
    );
    assert_eq!(bias(64.0, 0.0, 0.0, Some(1.0 / 65_536.0)), 64.0 / 65_536.0);
    assert_eq!(
        bias(0.0, 2.0, 0.01, None),
        0.25 + 3.5 / 64.0 + 2.5 / 128.0 + 0.01 - (0.25 + 3.5 / 64.0 + 2.5 / 128.0)
    );
    assert_eq!(bias(0.0, -2.0, 0.01, None), -2.0 / 64.0);
    // Depths outside the viewport's range are clamped.
    assert_eq!(
        bias(0.0, 1000.0, 0.0, None) + (0.25 + 3.5 / 64.0 + 2.5 / 128.0),
        1.0
    );
}
