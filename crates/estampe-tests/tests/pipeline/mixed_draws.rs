//! Many draws with different pipelines over the same pixels in one pass: opaque, blended,
//! discarding, with every depth comparison and stencil operation, in every format of colour and
//! depth.

use estampe::TilePath;
use estampe_tests::geometry::Style;
use estampe_tests::mixed_draws::Mixture;
use estampe_tests::shaders::{AtCentroid, Shown};
use estampe_tests::{ExpectedPaths, check, check_paths};
use estampe_types::TextureFormat as F;
use estampe_types::state::{ColorWrites, DepthState};

/// The most common colour formats.
const COMMON: [F; 5] = [
    F::Bgra8Unorm,
    F::Bgra8UnormSrgb,
    F::Rgba16Float,
    F::Rgba8Unorm,
    F::Rgba8UnormSrgb,
];

const DEPTHS: [F; 5] = [
    F::Depth16Unorm,
    F::Depth24Plus,
    F::Depth24PlusStencil8,
    F::Depth32Float,
    F::Depth32FloatStencil8,
];

const WITH_STENCIL: [F; 3] = [F::Depth24PlusStencil8, F::Depth32FloatStencil8, F::Stencil8];

fn renderable() -> Vec<F> {
    let all = F::ALL.iter().copied();
    all.filter(|format| format.is_renderable()).collect()
}

/// Rows: O3, O4, O5, O9, O10, D1.
#[test]
fn common_targets_of_one_sample() {
    check("mixed/common, one sample", 120, |random| {
        let depth = random.pick(&DEPTHS);
        Mixture::new(&[random.pick(&COMMON)], Some(depth), 1).case(random)
    });
}

/// Rows: R6, O3, O4, O5, O9, O10, D1.
#[test]
fn common_targets_of_four_samples() {
    check("mixed/common, four samples", 70, |random| {
        let depth = random.pick(&DEPTHS);
        Mixture::new(&[random.pick(&COMMON)], Some(depth), 4).case(random)
    });
}

/// Rows: O3, O4, O9.
#[test]
fn stencils_with_and_without_depth() {
    check("mixed/stencil", 80, |random| {
        let (format, samples) = (random.pick(&COMMON), random.pick(&[1, 1, 1, 4]));
        Mixture::new(&[format], Some(random.pick(&WITH_STENCIL)), samples).case(random)
    });
}

/// Rows: F1, O5, O7, O8.
#[test]
fn every_colour_format() {
    for format in renderable() {
        let topic = format!("mixed/{}", format.name());
        check(&topic, 4, |random| {
            let (depth, samples) = (random.pick(&DEPTHS), random.pick(&[1, 1, 4]));
            Mixture::new(&[format], Some(depth), samples).case(random)
        });
    }
}

/// Rows: O3, O4, D1.
#[test]
fn every_depth_format_at_every_sample_count() {
    for format in DEPTHS.into_iter().chain([F::Stencil8]) {
        for samples in [1, 2, 4, 8, 16] {
            let topic = format!("mixed/{}, {samples} samples", format.name());
            check(&topic, 4, |random| {
                let color = random.pick(&COMMON);
                Mixture::new(&[color], Some(format), samples).case(random)
            });
        }
    }
}

/// Rows: F1, R6, O5, O7, O8.
#[test]
fn one_to_four_targets() {
    let all = renderable();
    check("mixed/targets", 80, |random| {
        let count = 1 + random.index(4);
        let formats: Vec<_> = (0..count)
            .map(|_| match random.below(3) {
                0 => random.pick(&all),
                _ => random.pick(&COMMON),
            })
            .collect();
        let (depth, samples) = (random.pick(&DEPTHS), random.pick(&[1, 1, 2, 4, 8]));
        Mixture::new(&formats, Some(depth), samples).case(random)
    });
}

/// Rows: O4, O10, D1.
#[test]
fn depth_alone() {
    check_paths(
        "mixed/no colour",
        60,
        ExpectedPaths(&[TilePath::VisibilityDepthOnly, TilePath::InOrderQuads]),
        |random| {
            let (depth, samples) = (random.pick(&DEPTHS), random.pick(&[1, 1, 4]));
            Mixture::new(&[], Some(depth), samples).case(random)
        },
    );
}

/// Rows: O3, O4, O7.
#[test]
fn depth_and_stencil_of_draws_whose_colours_are_masked() {
    let paths = ExpectedPaths(&[TilePath::VisibilityDepthOnly, TilePath::VisibilityQuads]);
    check_paths("mixed/masked colours", 120, paths, |random| {
        let formats = [random.pick(&COMMON), F::Rgba8Unorm];
        let depth = random.pick(&[F::Depth24PlusStencil8, F::Depth32Float]);
        let targets = 1 + random.index(2);
        let mut case = Mixture {
            styles: vec![Style::Large, Style::Large, Style::OnGrid],
            ..Mixture::new(&formats[..targets], Some(depth), random.pick(&[1, 1, 4]))
        }
        .case(random);
        for draw in &mut case.draws {
            if random.once_in(2) {
                draw.depth = random.pick(&[draw.depth, Some(DepthState::LESS_WRITE)]);
            }
            if random.once_in(2) {
                draw.write_mask = ColorWrites::NONE;
                draw.more_targets = vec![(None, ColorWrites::NONE)];
            }
        }
        case
    });
}

/// Rows: O5, O7.
#[test]
fn no_depth_at_all() {
    check("mixed/no depth", 40, |random| {
        let (format, samples) = (random.pick(&COMMON), random.pick(&[1, 1, 4]));
        Mixture::new(&[format], None, samples).case(random)
    });
}

/// Rows: R1, O3, O4, D1.
#[test]
fn many_small_triangles() {
    check("mixed/small", 40, |random| {
        let (format, depth) = (random.pick(&COMMON), random.pick(&DEPTHS));
        let samples = random.pick(&[1, 1, 4]);
        Mixture {
            styles: vec![Style::Tiny, Style::Small, Style::OnGrid, Style::Sliver],
            triangles: 70,
            draws: 5,
            ..Mixture::new(&[format], Some(depth), samples)
        }
        .case(random)
    });
}

/// Rows: A3, O3, O4, D1.
#[test]
fn triangles_that_are_clipped() {
    check("mixed/clipped", 40, |random| {
        let (format, depth) = (random.pick(&COMMON), random.pick(&DEPTHS));
        Mixture {
            styles: vec![Style::AcrossDepths, Style::AroundEye, Style::Huge],
            ..Mixture::new(&[format], Some(depth), random.pick(&[1, 4]))
        }
        .case(random)
    });
}

/// Rows: O4, O5, U3.
#[test]
fn every_path_with_colours_in_one_pass() {
    let paths = ExpectedPaths(&[
        TilePath::VisibilityPerPrimitive,
        TilePath::VisibilityCrossTriangle,
        TilePath::VisibilityQuads,
        TilePath::InOrderBlocks,
        TilePath::InOrderQuads,
        TilePath::InOrderPackets,
    ]);
    check_paths("mixed/every path", 60, paths, |random| {
        let samples = random.pick(&[1, 1, 4]);
        let mixture = Mixture {
            draws: 9,
            ..Mixture::new(&[F::Rgba8Unorm], Some(F::Depth32Float), samples)
        };
        let mut case = mixture.case(random);
        // Fragments whose varyings are at centroids share no packets.
        for draw in &mut case.draws {
            if random.once_in(6) {
                draw.shader = AtCentroid(Shown::random(random)).into();
            }
        }
        case
    });
}
