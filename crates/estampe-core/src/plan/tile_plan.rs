//! The plan of a sub-draw on the tile side: its state, resolved once.
//!
//! Neighbouring draws share a [`TileState`], as they do on the geometry side, so that a draw's own
//! plan is a few words.

use crate::bounds::pixel_rect::PixelRect;
use crate::bounds::sample_rect::SampleRect;
use crate::commands::Draw;
use crate::depth_format::{DepthFormat, StoredDepth};
use crate::geometry::line_style::LineStyle;
use crate::geometry::plan::GeometryPlan;
use crate::per_sample::sample_tests::SampleTests;
use crate::per_sample::stencil::StencilTest;
use crate::pipeline::RenderPipeline;
use crate::tile_path::{PathFacts, TilePath};
use estampe_simd::Level;
use estampe_types::shader::{AlphaTest, AlphaTestRequest, DepthOutput, Interface, Sampling};
use estampe_types::state::CompareFunction;
use estampe_types::{Bindings, Interpolation};
use std::ops::Deref;

/// When samples are tested (O9).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TestTiming {
    /// Before shading, results written: nothing that the shader does can change them.
    Early,
    /// After shading; samples that fail the depth test before are dropped, because they would fail
    /// after, too.
    RejectEarly,
    /// After shading.
    Late,
}

/// A sub-draw as its tiles need it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TilePlan<'a> {
    pub(crate) state: &'a TileState<'a>,
    pub(crate) bindings: &'a Bindings,
    /// The varyings of its vertices.
    pub(crate) varyings: &'a [f32],
}

/// State that the tiles read of sub-draws in a row.
#[derive(Debug, Clone)]
pub(crate) struct TileState<'a> {
    pub(crate) pipeline: &'a RenderPipeline,
    /// The pixels that may change.
    pub(crate) rect: PixelRect,
    /// The viewport's samples, where its edges go through pixels.
    pub(crate) cut_samples: Option<SampleRect>,
    pub(crate) path: TilePath,
    pub(crate) tests: SampleTests,
    pub(crate) timing: TestTiming,
    pub(crate) blend_constant: [f32; 4],
    pub(crate) line_style: &'a LineStyle,
    /// The occlusion query that counts its samples.
    pub(crate) query: Option<u32>,
    /// True if every varying is smooth.
    pub(crate) all_smooth: bool,
    /// The test of a texture's alpha that leaves nothing of most fragments.
    pub(crate) alpha_test: Option<AlphaTest>,
}

/// The inputs of a state that come from the target and the pass.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TargetFacts {
    pub(crate) level: Level,
    pub(crate) samples: usize,
    pub(crate) depth_format: DepthFormat,
    pub(crate) has_depth: bool,
    pub(crate) has_queries: bool,
}

impl<'a> Deref for TilePlan<'a> {
    type Target = TileState<'a>;

    #[inline(always)]
    fn deref(&self) -> &TileState<'a> {
        self.state
    }
}

impl TilePlan<'_> {
    /// Returns true if fragments of both plans may share a call of the program.
    pub(crate) fn shades_like(&self, other: &Self) -> bool {
        std::ptr::eq(self.bindings, other.bindings)
            && self.pipeline.is_same(other.pipeline)
            && self.tests.stored.range == other.tests.stored.range
    }

    /// Returns true if fragments of both plans that are drawn in order may wait in one queue.
    pub(crate) fn queues_like(&self, other: &Self) -> bool {
        self.shades_like(other)
            && self.path == other.path
            && self.timing == other.timing
            && self.tests == other.tests
            && self.blend_constant == other.blend_constant
            && self.query.is_none()
            && other.query.is_none()
    }
}

impl<'a> TileState<'a> {
    /// The state of a draw.
    pub(crate) fn new(
        (draw, bindings): (&'a Draw<'a>, &Bindings),
        geometry: &'a GeometryPlan,
        target: &TargetFacts,
    ) -> Self {
        let pipeline = draw.pipeline;
        let key = pipeline.key();
        let tests = SampleTests {
            bounds: draw.depth_bounds.filter(|_| target.has_depth),
            stencil: key.stencil.map(|state| StencilTest {
                state,
                reference: draw.stencil_reference,
            }),
            depth: key.depth,
            stored: StoredDepth {
                range: geometry.transform.depth_range,
                format: target.depth_format,
            },
        };
        let query = draw.occlusion_query.filter(|_| target.has_queries);
        let tests_depth_alone = tests.is_depth_alone() && query.is_none();
        let modes = &pipeline.interface().varyings;
        Self {
            pipeline,
            rect: geometry.rect,
            cut_samples: geometry.cut_samples,
            path: TilePath::choose(
                pipeline,
                &PathFacts {
                    samples: target.samples,
                    level: target.level,
                    tests_depth_alone,
                    cuts_samples: geometry.cut_samples.is_some(),
                },
            ),
            timing: timing(pipeline, &tests),
            tests,
            blend_constant: draw.blend_constant,
            line_style: &geometry.line_style,
            query,
            all_smooth: modes.iter().all(|mode| *mode == Interpolation::Smooth),
            alpha_test: alpha_test((draw, bindings), target),
        }
    }

    /// Returns true if depth is the only test and no query counts samples. The order of submission
    /// then matters only between equal depths: nothing else is written or counted before shading.
    pub(crate) fn tests_depth_alone(&self) -> bool {
        self.tests.is_depth_alone() && self.query.is_none()
    }
}

/// The alpha test of a draw, if its coordinates and layer are interpolated in the common way.
fn alpha_test((draw, bindings): (&Draw<'_>, &Bindings), target: &TargetFacts) -> Option<AlphaTest> {
    let key = draw.pipeline.key();
    if !key.may_test_alpha || target.level.is_scalar() {
        return None;
    }
    let elements = draw.elements.len().saturating_mul(draw.instances.len());
    let request = AlphaTestRequest {
        to_coverage: key.alpha_to_coverage,
        primitives: elements / 3,
    };
    let test = draw.pipeline.program().alpha_test(bindings, request)?;
    let Interface {
        varyings, sampling, ..
    } = draw.pipeline.interface();
    let is = |scalar: usize, mode: Interpolation| {
        let at_center = sampling
            .get(scalar)
            .is_none_or(|at| *at == Sampling::Center);
        varyings.get(scalar) == Some(&mode) && (at_center || mode == Interpolation::Flat)
    };
    let are_smooth = test
        .at
        .iter()
        .all(|scalar| is(*scalar, Interpolation::Smooth));
    let is_flat = test
        .layer
        .is_none_or(|scalar| is(scalar, Interpolation::Flat));
    (are_smooth && is_flat).then_some(test)
}

fn timing(pipeline: &RenderPipeline, tests: &SampleTests) -> TestTiming {
    let interface = pipeline.interface();
    if pipeline.key().tests_early {
        return TestTiming::Early;
    }
    let compare = tests.depth.map(|state| state.compare);
    // A declared direction of the shader's depth is away from where more pass.
    let is_final = match interface.depth_output {
        DepthOutput::None => true,
        DepthOutput::Greater => matches!(
            compare,
            Some(CompareFunction::Less | CompareFunction::LessEqual)
        ),
        DepthOutput::Less => matches!(
            compare,
            Some(CompareFunction::Greater | CompareFunction::GreaterEqual)
        ),
        DepthOutput::Any => false,
    };
    if is_final && !interface.stores && tests.early_failure_is_final() {
        TestTiming::RejectEarly
    } else {
        TestTiming::Late
    }
}
