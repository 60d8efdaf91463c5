//! Passes whose bins are full, on devices with hardly any memory for them: batches end between and
//! within draws, and tiles are drawn in bands.

use estampe::Statistics;
use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{Colored, Cutout};
use estampe_tests::{Case, CaseDraw, Random, check_with_small_bins};
use estampe_types::state::{BlendState, DepthState, PolygonMode, PrimitiveTopology};

/// A case of three by two tiles of 64×64 pixels, or more of 32×32.
fn case(random: &mut Random, samples: u32) -> Case {
    let mut case = Case::new(random.pick(&[[190, 100], [129, 128]]), samples);
    for _ in 0..=random.below(2) {
        let style = random.pick(&[Style::Large, Style::AcrossDepths, Style::Small]);
        let count = random.pick(&[3, 20, 90]);
        let (style, count) = match random.once_in(6) {
            // Several chunks.
            true => (Style::Small, 1200),
            false => (style, count),
        };
        let vertices = triangles(random, style, case.size, count);
        let mut draw = CaseDraw::new(Colored, &vertices);
        if random.once_in(3) {
            draw.shader = Cutout.into();
        }
        draw.depth = random.pick(&[None, Some(DepthState::LESS_WRITE)]);
        draw.blend = random.pick(&[None, None, Some(BlendState::ADDITIVE)]);
        case.draws.push(draw);
    }
    case
}

/// Rows: R2.
#[test]
fn triangles_fill_bins() {
    let mut statistics = Statistics::default();
    for samples in [1, 4, 8] {
        let topic = format!("full bins/triangles_{samples}");
        statistics += check_with_small_bins(&topic, 24, |random| case(random, samples));
    }
    let Statistics {
        bands_of_tiles,
        batches,
        groups_of_geometry,
        ..
    } = statistics;
    assert!(bands_of_tiles > 2 * batches, "{bands_of_tiles} bands");
    let within_draws = batches.saturating_sub(groups_of_geometry);
    assert!(within_draws > 50, "{within_draws} batches end in a draw");
}

/// Lines and points have entries of their own kinds.
///
/// Rows: R2, R3, R4.
#[test]
fn lines_and_points_fill_bins() {
    let statistics = check_with_small_bins("full bins/lines and points", 40, |random| {
        let mut case = case(random, 1);
        for draw in &mut case.draws {
            draw.primitive.topology = random.pick(&[
                PrimitiveTopology::LineList,
                PrimitiveTopology::LineStrip,
                PrimitiveTopology::PointList,
                PrimitiveTopology::TriangleList,
            ]);
            draw.primitive.polygon_mode = PolygonMode::Line;
            draw.primitive.line.width = random.pick(&[1.0, 4.5]);
        }
        case
    });
    let (bands, batches) = (statistics.bands_of_tiles, statistics.batches);
    assert!(bands > batches, "{bands} bands in {batches} batches");
}
