//! Triangles over which nothing varies: one packet is shaded for all of them that follow each other
//! and have the same varyings.

use estampe_simd::Level;
use estampe_tests::geometry::{Style, Vertex, triangles};
use estampe_tests::shaders::{Colored, FlatColored, Halved, Probe};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check_paths};
use estampe_types::TextureFormat;
use estampe_types::state::{BlendState, CompareFunction, DepthState, ScissorRect};

fn shader(random: &mut Random) -> TestShader {
    match random.below(4) {
        0 => FlatColored.into(),
        1 => Colored.into(),
        2 => Probe::random(random).into(),
        _ => Halved.into(),
    }
}

/// Triangles as of a user interface, blended in order; most have the same values at all vertices,
/// among them −0 and NaN, and some only nearly.
fn case(random: &mut Random) -> Case {
    let mut case = Case::new([100, 70], random.pick(&[1, 1, 1, 4, 2, 8]));
    for _ in 0..3 {
        let style = random.pick(&[Style::Large, Style::Large, Style::Small]);
        let mut vertices = triangles(random, style, case.size, 5);
        for triangle in vertices.chunks_exact_mut(3) {
            let special = random.pick(&[0.5, 0.25, -0.0, 0.0, f32::NAN, 1.0]);
            let channel = random.below(4) as usize;
            let is_constant = !random.once_in(4);
            let has_equal_w = !random.once_in(4);
            let values = triangle[0].values;
            for vertex in triangle {
                if is_constant {
                    vertex.values = values;
                    vertex.values[channel] = special;
                }
                if has_equal_w {
                    vertex.position[3] = 1.0;
                }
            }
        }
        let mut draw = CaseDraw::new(shader(random), &vertices);
        draw.blend = Some(BlendState::ALPHA_BLENDING);
        draw.depth = random.once_in(2).then_some(DepthState {
            compare: CompareFunction::LessEqual,
            write_enabled: true,
        });
        draw.is_counted = random.once_in(3);
        case.draws.push(draw);
    }
    case
}

/// The fan of a polygon around a place, almost always convex, from any of its corners on and
/// towards either side; sometimes a triangle is left out.
fn polygon(random: &mut Random) -> Vec<Vertex> {
    let [x, y, width, height] = random.four(-1.0, 1.0);
    let corners = 3 + random.below(14);
    let values = random.four(0.0, 1.0);
    let corner = |corner: u32| {
        // A rational point of a quarter of a circle, turned.
        let (quarter, along) = (4 * corner / corners % 4, 4 * corner % corners);
        let t = along as f32 / corners as f32;
        let [across, down] = [1.0 - t * t, 2.0 * t].map(|at| at / (1.0 + t * t));
        let [across, down] = match quarter {
            0 => [across, down],
            1 => [-down, across],
            2 => [-across, -down],
            _ => [down, -across],
        };
        Vertex {
            position: [x + across * width, y + down * height, 0.5, 1.0],
            values,
        }
    };
    let first = random.below(corners);
    let mut fan: Vec<_> = (first + 1..first + corners - 1)
        .map(|at| [first, at, at + 1].map(corner))
        .collect();
    if random.once_in(3) {
        fan.reverse();
    }
    if random.once_in(4) {
        let out = random.below(corners - 2);
        fan.remove(out as usize);
    }
    fan.into_iter().flatten().collect()
}

/// Fans and lists of triangles of one colour, between others that lie over and under them.
fn panels(random: &mut Random) -> Case {
    let mut case = Case::new([100, 70], random.pick(&[1, 1, 1, 4, 2]));
    case.format = random.pick(&[
        Some(TextureFormat::Rgba8Unorm),
        Some(TextureFormat::Bgra8Unorm),
        Some(TextureFormat::Rgba8UnormSrgb),
    ]);
    let mut draw_shader = shader(random);
    for _ in 0..3 {
        let mut vertices = Vec::new();
        for _ in 0..8 {
            let style = random.pick(&[Style::Large, Style::Small, Style::Sliver]);
            let mut run = triangles(random, style, case.size, 4);
            // Triangles of a fan, which do not overlap, or any.
            let (hub, is_fan) = (run[0], random.once_in(2));
            let (is_constant, values) = (!random.once_in(3), run[0].values);
            for triangle in 0..run.len() / 3 {
                if is_fan && triangle > 0 {
                    run[triangle * 3] = hub;
                    run[triangle * 3 + 1] = run[triangle * 3 - 1];
                }
            }
            for vertex in &mut run {
                vertex.position[3] = 1.0;
                if is_constant {
                    vertex.values = values;
                }
            }
            vertices.extend(run);
            for _ in 0..random.below(4) {
                vertices.extend(polygon(random));
            }
        }
        if random.once_in(3) {
            draw_shader = shader(random);
        }
        let mut draw = CaseDraw::new(draw_shader.clone(), &vertices);
        draw.blend = random.pick(&[
            Some(BlendState::ALPHA_BLENDING),
            Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            Some(BlendState::ADDITIVE),
        ]);
        draw.depth = random.once_in(3).then_some(DepthState {
            compare: CompareFunction::LessEqual,
            write_enabled: random.once_in(2),
        });
        draw.scissor = random.once_in(3).then_some(ScissorRect {
            x: 9,
            y: 14,
            width: 80,
            height: 50,
        });
        draw.is_counted = random.once_in(8);
        case.draws.push(draw);
    }
    case
}

/// Rows: O5, V4.
#[test]
fn triangles_of_one_colour_are_gathered() {
    let statistics = check_paths("gathered_primitives", 48, ExpectedPaths::default(), panels);
    assert!(
        statistics.triangles_gathered > 0,
        "no triangle's pixels were written with another's"
    );
    let (fans, lines) = (
        statistics.triangles_in_fans,
        statistics.fragments_blended_by_lines,
    );
    let has_wide = Level::all_available()
        .iter()
        .any(|level| !level.is_scalar());
    assert!(
        !has_wide || fans > 1000 && lines > 100_000,
        "{fans} triangles were covered in fans, {lines} fragments blended by lines"
    );
    let kept = statistics.colors_kept;
    assert!(kept > 100, "{kept} colours were kept");
}

/// Rows: O5, V4.
#[test]
fn whole_packets_share_their_colours() {
    let statistics = check_paths("constant_primitives", 32, ExpectedPaths::default(), case);
    assert!(
        statistics.fragments_of_shared_colors > 0,
        "no packet took another's colours"
    );
}
