//! The facts of a pipeline that select code: derived once, so that nothing downstream looks at the
//! state again.

use super::RenderPipelineDescriptor;
use super::color_target::ColorTarget;
use super::primitive_kind::{PrimitiveKind, kind_of};
use estampe_types::shader::{DepthOutput, Sampling};
use estampe_types::state::{
    CompareFunction, ConservativeMode, DepthState, LineRasterization, PolygonMode,
    StencilOperation, StencilState,
};
use estampe_types::{Interface, Interpolation};

/// The state that selects code, reduced: nothing in it changes from fragment to fragment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct StageKey {
    /// The depth test; `None` where everything passes and nothing is written.
    pub(crate) depth: Option<DepthState>,
    /// The stencil test; `None` where everything passes and nothing is written.
    pub(crate) stencil: Option<StencilState>,
    /// All tests are made, and their results written, before the shader runs.
    pub(crate) tests_early: bool,
    /// A sample's colour is that of the last filled triangle that passes its tests there.
    pub(crate) is_opaque: bool,
    /// The same of lines, whose fragments may be shaded apart from each other as soon as they pass.
    pub(crate) is_opaque_lines: bool,
    /// Fragments have colours that are stored: a target's write mask is not empty.
    pub(crate) has_colors: bool,
    /// The fragments' colour depends on the primitive alone, so it is shaded once for each.
    pub(crate) uniform_over_primitive: bool,
    /// It depends on the draw alone, and on whether the primitive faces the viewer.
    pub(crate) uniform_over_draw: bool,
    /// Fragments whose varyings are the same, and those of the whole packet, have the same colours;
    /// nothing else comes of them.
    pub(crate) depends_on_varyings_alone: bool,
    /// Fragments are shaded without looking at others of their quad.
    pub(crate) needs_no_quads: bool,
    /// A fragment's one colour depends on its own varyings alone.
    pub(crate) fragments_are_independent: bool,
    /// The fragments' one colour is their first four scalars, so that the program need not be
    /// called.
    pub(crate) color_passthrough: bool,
    /// Blocks that a filled triangle covers whole may be blended from the planes of its colour.
    pub(crate) blends_blocks: bool,
    /// Packets may hold quads of several primitives.
    pub(crate) shares_packets: bool,
    /// Fragments store, and what they store may depend on their order.
    pub(crate) stores_in_order: bool,
    /// Fragments are shaded once for each sample.
    pub(crate) per_sample: bool,
    /// Fragments that are drawn in order may be tested for an alpha that leaves nothing of them.
    pub(crate) may_test_alpha: bool,
    /// The alpha of target 0 selects samples.
    pub(crate) alpha_to_coverage: bool,
    /// Shading depends on the samples that were covered before any test.
    pub(crate) keeps_coverage: bool,
    /// The samples that may change, bit by bit; `None` for all.
    pub(crate) sample_mask: Option<u32>,
}

impl StageKey {
    pub(super) fn new(
        descriptor: &RenderPipelineDescriptor,
        interface: &Interface,
        targets: &[ColorTarget],
    ) -> Self {
        let multisample = &descriptor.multisample;
        let samples = multisample.count;
        let all_samples = u32::MAX >> (32 - samples.clamp(1, 32));
        let sample_mask = Some(multisample.mask).filter(|mask| mask & all_samples != all_samples);
        let is_integer = |target: &ColorTarget| target.codec.is_integer();
        let first = targets.iter().find(|target| target.output == 0);
        let alpha_to_coverage =
            multisample.alpha_to_coverage_enabled && first.is_some_and(|first| !is_integer(first));
        let per_sample =
            samples > 1 && (multisample.sample_shading_enabled || interface.per_sample);
        let has_centroids =
            samples > 1 && interface.sampling.iter().any(|at| *at != Sampling::Center);
        let tests_early = !interface.discards
            && !interface.stores
            && interface.depth_output == DepthOutput::None
            && !alpha_to_coverage
            && !interface.writes_sample_mask;
        let primitive = &descriptor.primitive;
        let kind = kind_of(primitive.topology);
        let fills_triangles =
            kind == PrimitiveKind::Triangles && primitive.polygon_mode == PolygonMode::Fill;
        let draws_lines = kind == PrimitiveKind::Lines
            || kind == PrimitiveKind::Triangles && primitive.polygon_mode == PolygonMode::Line;
        let keeps_coverage = interface.reads_coverage || has_centroids;
        let is_shaded_by_pixel = !per_sample && !interface.per_sample && !keeps_coverage;
        // Packets that several triangles share would be shaded in an order that depends on the SIMD
        // level.
        let stores_in_order = interface.stores && !interface.stores_in_any_order;
        // The alpha of smooth lines is scaled by packets, after shading.
        let smooth_lines = primitive.line.rasterization == LineRasterization::RectangularSmooth;
        let shares_packets =
            (fills_triangles || !smooth_lines) && is_shaded_by_pixel && !stores_in_order;
        // A program of a caller's own may claim more than it has, and smooth lines scale alpha
        // after shading.
        let color_passthrough = interface.color_passthrough
            && !smooth_lines
            && tests_early
            && is_shaded_by_pixel
            && interface.color_targets == 1
            && !interface.dual_source
            && interface.varyings.len() >= 4;
        let flat = interface
            .varyings
            .iter()
            .all(|mode| *mode == Interpolation::Flat);
        let replaces_samples = shares_packets
            && tests_early
            && sample_mask.is_none()
            && !interface.dual_source
            && primitive.conservative == ConservativeMode::Disabled;
        let is_plain = fills_triangles && replaces_samples;
        let replaces_colors = targets.iter().all(ColorTarget::replaces);
        let fragments_are_independent =
            interface.no_derivatives && !interface.reads_position && interface.color_targets == 1;
        let depth_stencil = descriptor.depth_stencil;
        let has_colors = targets.iter().any(ColorTarget::is_written);
        Self {
            depth: depth_stencil
                .map(|state| state.depth())
                .filter(|depth| depth.write_enabled || depth.compare != CompareFunction::Always),
            stencil: depth_stencil
                .and_then(|state| state.stencil)
                .filter(|state| !does_nothing(state)),
            tests_early,
            is_opaque: is_plain && (!has_colors || replaces_colors),
            is_opaque_lines: draws_lines
                && replaces_samples
                && primitive.line.stipple.is_none()
                && fragments_are_independent
                && targets.len() == 1
                && replaces_colors,
            has_colors,
            uniform_over_primitive: flat && !interface.reads_position,
            uniform_over_draw: interface.varyings.is_empty() && !interface.reads_position,
            depends_on_varyings_alone: tests_early
                && is_shaded_by_pixel
                && !interface.reads_position,
            needs_no_quads: interface.no_derivatives,
            fragments_are_independent,
            color_passthrough,
            blends_blocks: is_plain
                && color_passthrough
                && interface.varyings[..4] == [Interpolation::Smooth; 4]
                && first.is_some_and(ColorTarget::is_source_over),
            shares_packets,
            stores_in_order,
            per_sample,
            may_test_alpha: (interface.discards || alpha_to_coverage)
                && shares_packets
                && !interface.stores
                && fills_triangles
                && samples <= 4,
            alpha_to_coverage,
            keeps_coverage,
            sample_mask,
        }
    }
}

/// Returns true if a stencil state tests nothing and writes nothing, which counts as no stencil
/// test.
fn does_nothing(state: &StencilState) -> bool {
    [state.front, state.back].iter().all(|face| {
        // Where everything passes, the operation of failing does not happen.
        let keeps =
            face.depth_fail_op == StencilOperation::Keep && face.pass_op == StencilOperation::Keep;
        face.compare == CompareFunction::Always && (keeps || face.write_mask == 0)
    })
}
