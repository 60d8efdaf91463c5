//! Per-sample shading, centroids, coverage and sample masks in shaders, with every number of
//! samples.

use estampe::TilePath;
use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{
    AtCentroid, AtSample, BySample, Colored, Cutout, Masking, Probe, Shown,
};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check, check_paths};
use estampe_types::TextureFormat;
use estampe_types::state::{
    BlendState, ConservativeMode, CullMode, DepthState, LineRasterization, PolygonMode,
    PrimitiveTopology,
};

/// Some draws of a shader into a small target with many samples.
fn case(random: &mut Random, shader: impl Fn(&mut Random) -> TestShader) -> Case {
    let mut case = Case::random_target(random);
    case.samples = random.pick(&[1, 2, 4, 8, 16, 4, 8]);
    for _ in 0..=random.below(2) {
        let style = random.pick(&[
            Style::Tiny,
            Style::Small,
            Style::Large,
            Style::OnGrid,
            Style::Sliver,
            Style::AroundEye,
        ]);
        let vertices = triangles(random, style, case.size, 6);
        let mut draw = CaseDraw::new(shader(random), &vertices);
        draw.primitive.topology = random.pick(&[
            PrimitiveTopology::TriangleList,
            PrimitiveTopology::TriangleList,
            PrimitiveTopology::TriangleStrip,
            PrimitiveTopology::LineStrip,
            PrimitiveTopology::PointList,
        ]);
        draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::None, CullMode::Front]);
        draw.primitive.polygon_mode =
            random.pick(&[PolygonMode::Fill, PolygonMode::Fill, PolygonMode::Line]);
        draw.primitive.line.width = random.pick(&[1.0, 1.0, 3.5]);
        draw.primitive.line.rasterization = random.pick(&[
            LineRasterization::Bresenham,
            LineRasterization::Rectangular,
            LineRasterization::RectangularSmooth,
        ]);
        draw.primitive.round_points = random.once_in(2);
        draw.depth = random.pick(&[None, Some(DepthState::LESS_WRITE)]);
        if random.once_in(3) {
            draw.sample_mask = random.bits();
        }
        if random.once_in(4) {
            draw.blend = Some(BlendState::ADDITIVE);
        }
        draw.is_counted = random.once_in(2);
        case.draws.push(draw);
    }
    if random.once_in(4) {
        case.second_pass = 1;
    }
    case
}

/// Rows: R6, R7, F1.
#[test]
fn varyings_at_centroids() {
    check_paths(
        "samples/centroid",
        50,
        ExpectedPaths(&[TilePath::InOrderPackets]),
        |random| case(random, |random| AtCentroid(Shown::random(random)).into()),
    );
}

/// Rows: R6, R7, F1.
#[test]
fn varyings_at_samples() {
    check("samples/sample", 50, |random| {
        case(random, |random| AtSample(Shown::random(random)).into())
    });
}

/// Rows: R6, R7, F1.
#[test]
fn shaders_that_read_the_number_of_their_sample() {
    check("samples/number", 50, |random| {
        case(random, |random| BySample(Shown::random(random)).into())
    });
}

/// Rows: R6.
#[test]
fn pipelines_that_shade_by_sample() {
    check("samples/pipeline", 40, |random| {
        let mut case = case(random, |random| match random.below(4) {
            0 => AtCentroid(Shown::random(random)).into(),
            1 => Probe::random(random).into(),
            2 => Cutout.into(),
            _ => Colored.into(),
        });
        for draw in &mut case.draws {
            draw.sample_shading = true;
            draw.alpha_to_coverage = random.once_in(4);
        }
        case
    });
}

/// Rows: R6, O9, O10.
#[test]
fn shaders_that_keep_some_samples() {
    check("samples/mask", 50, |random| {
        let mut case = case(random, |random| {
            let always = random.pick(&[0, 0, 1, 0xFFFF]);
            Masking { always }.into()
        });
        for draw in &mut case.draws {
            draw.sample_shading = random.once_in(4);
            draw.alpha_to_coverage = random.once_in(4);
            draw.is_counted = true;
        }
        case
    });
}

/// Rows: R6, R8.
#[test]
fn conservative_pixels_have_all_their_samples() {
    check("samples/conservative", 30, |random| {
        let mut case = case(random, |random| AtCentroid(Shown::random(random)).into());
        for draw in &mut case.draws {
            draw.primitive.conservative = random.pick(&[
                ConservativeMode::Overestimate,
                ConservativeMode::Underestimate,
            ]);
        }
        case
    });
}

/// Rows: R6, O8.
#[test]
fn every_format_is_resolved() {
    let renderable = |format: &&TextureFormat| format.is_renderable();
    let formats: Vec<_> = TextureFormat::ALL
        .iter()
        .filter(renderable)
        .copied()
        .collect();
    check("samples/resolve", 60, |random| {
        let mut case = case(random, |_| Colored.into());
        case.samples = random.pick(&[2, 4, 8, 16]);
        case.format = Some(random.pick(&formats));
        for draw in &mut case.draws {
            draw.blend = None;
        }
        case
    });
}
