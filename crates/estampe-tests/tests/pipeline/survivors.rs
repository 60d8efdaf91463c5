//! Fragments that are left of shaded packets, moved together before they are tested and written.

use estampe::TilePath;
use estampe_tests::geometry::{Style, triangles};
use estampe_tests::mixed_draws::Mixture;
use estampe_tests::shaders::{Colored, Cutout, CutoutDepth, GivenDepth, Masking};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check_paths};
use estampe_types::TextureFormat;
use estampe_types::state::{BlendState, ColorWrites, CompareFunction, DepthState};

/// A shader that leaves few fragments, and the range of the values with which it does.
fn sparse(random: &mut Random, samples: u32) -> (TestShader, [f32; 2]) {
    match random.below(if samples > 1 { 4 } else { 2 }) {
        0 => (Cutout.into(), [0.0, 0.06]),
        1 => {
            let given = random.pick(&[GivenDepth::Value, GivenDepth::Moved]);
            (CutoutDepth(given).into(), [0.1, 0.2])
        }
        // Alpha to coverage.
        2 => (Colored.into(), [-0.4, 0.3]),
        _ => (Masking { always: 0 }.into(), [0.0, 0.0001]),
    }
}

fn draw(random: &mut Random, size: [u32; 2], samples: u32) -> CaseDraw {
    let (shader, [least, most]) = sparse(random, samples);
    let style = random.pick(&[Style::Small, Style::Large]);
    let count = if style == Style::Small { 60 } else { 6 };
    let mut vertices = triangles(random, style, size, count);
    // Each triangle twice, so that pixels come again, now and then at the same depths.
    let mut again = vertices.clone();
    if random.once_in(2) {
        for vertex in &mut again {
            vertex.position[2] *= 0.9;
        }
    }
    vertices.extend(again);
    for vertex in &mut vertices {
        for value in &mut vertex.values {
            *value = random.range(least, most);
        }
    }
    let mut draw = CaseDraw::new(shader, &vertices);
    draw.alpha_to_coverage = samples > 1 && least < 0.0;
    draw.depth = (!random.once_in(5)).then(|| DepthState {
        compare: random.pick(&[CompareFunction::Less, CompareFunction::LessEqual]),
        write_enabled: !random.once_in(4),
    });
    let blends = [
        None,
        Some(BlendState::ADDITIVE),
        Some(BlendState::ALPHA_BLENDING),
    ];
    draw.blend = random.pick(&blends);
    draw.write_mask = random.pick(&[ColorWrites::ALL, ColorWrites::COLOR]);
    draw.is_counted = random.once_in(4);
    draw
}

/// Rows: R1, R6, O3, O4, O5, O7, O9, O10.
#[test]
fn survivors_of_shading_are_moved_together() {
    for samples in [1, 4] {
        let topic = format!("survivors/sparse_{samples}");
        let paths = ExpectedPaths(&[TilePath::InOrderQuads]);
        let statistics = check_paths(&topic, 30, paths, |random| {
            let mut case = Case::new([150, 100], samples);
            for _ in 0..3 {
                case.draws.push(draw(random, case.size, samples));
            }
            case
        });
        let [before, after] = statistics.packets_of_survivors;
        assert!(
            before > 100 && after * 2 < before,
            "{samples} samples: {before} packets were moved to {after}"
        );
    }
}

/// Stencils, formats of several words, several targets.
///
/// Rows: R1, R6, O1, O3, O4, O5, O7, O8, O9, O10.
#[test]
fn survivors_pass_through_every_state() {
    use TextureFormat as F;
    for samples in [1, 4] {
        let topic = format!("survivors/states_{samples}");
        let statistics = check_paths(&topic, 30, ExpectedPaths::default(), |random| {
            let formats = [F::Rgba8Unorm, F::Bgra8UnormSrgb, F::Rgba16Float, F::R8Unorm];
            let targets = [random.pick(&formats), random.pick(&formats)];
            let depth = random.pick(&[F::Depth32Float, F::Depth24PlusStencil8, F::Stencil8]);
            let mixture = Mixture {
                styles: vec![Style::Small, Style::Large],
                triangles: 60,
                draws: 3,
                ..Mixture::new(
                    &targets[..1 + random.below(2) as usize],
                    Some(depth),
                    samples,
                )
            };
            let mut case = mixture.case(random);
            for draw in &mut case.draws {
                draw.alpha_to_coverage &= samples > 1;
            }
            case
        });
        let [before, after] = statistics.packets_of_survivors;
        assert!(
            after < before,
            "{samples} samples: {before} packets were moved to {after}"
        );
    }
}
