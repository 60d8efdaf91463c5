//! The state of draws, resolved: what a pipeline, viewport, scissor and blend constant come to on a
//! target.
//!
//! Programs change state less often than they draw: neighbouring draws share one [`DrawState`], so
//! that a draw that differs in its bindings or vertices alone costs a comparison.

use super::index_range::is_stippled_strip;
use crate::attachment::RenderTarget;
use crate::bounds::pixel_rect::PixelRect;
use crate::commands::Draw;
use crate::geometry::plan::{GeometryPlan, TargetGeometry};
use crate::pipeline::RenderPipeline;
use crate::raster::conservative::sample_range;
use estampe_types::Interpolation;
use estampe_types::state::{ConservativeMode, ScissorRect, Viewport};

/// State that draws of a batch have in common.
#[derive(Debug, Clone)]
pub(crate) struct DrawState<'a> {
    key: StateKey<'a>,
    pub(crate) geometry: GeometryPlan,
    /// True if the primitives of an instance stay in one chunk: the pattern of each line of a
    /// stippled strip goes on where that of the one before ended.
    pub(super) is_uncut: bool,
}

/// Returns true if small triangles that are drawn in order are listed, and none of their varyings
/// is flat.
fn joins_rectangles(pipeline: &RenderPipeline) -> bool {
    let key = pipeline.key();
    !key.is_opaque
        && key.shares_packets
        && key.sample_mask.is_none()
        && !pipeline.interface().varyings.contains(&Interpolation::Flat)
}

/// The inputs from which a state was resolved.
#[derive(Debug, Clone)]
struct StateKey<'a> {
    pipeline: &'a RenderPipeline,
    viewport: Option<Viewport>,
    scissor: Option<ScissorRect>,
}

impl<'a> DrawState<'a> {
    /// The state of a draw on a target that [it fits](super::pass_check); `None` if no pixel lies
    /// in viewport, scissor and target.
    pub(crate) fn resolve(draw: &Draw<'a>, target: &RenderTarget) -> Option<Self> {
        let (width, height) = (target.width(), target.height());
        let viewport = draw.viewport.unwrap_or(Viewport::of_target(width, height));
        let descriptor = draw.pipeline.descriptor();
        let primitive = &descriptor.primitive;
        let samples = target.samples() as usize;
        let varyings = &draw.pipeline.interface().varyings;
        let on_target = TargetGeometry {
            grid: target.grid(),
            depth_stencil: target.depth_stencil_format(),
            rect: PixelRect::of_target(draw.scissor, width, height),
            position_range: sample_range(samples, ConservativeMode::Disabled),
            sample_range: sample_range(samples, primitive.conservative),
            is_opaque: draw.pipeline.key().is_opaque,
            has_colors: draw.pipeline.key().has_colors,
            has_flat_varyings: varyings.contains(&Interpolation::Flat),
            joins_rectangles: joins_rectangles(draw.pipeline),
        };
        let bias = descriptor.depth_stencil.map(|state| state.bias);
        let bias = bias.unwrap_or_default();
        let geometry = GeometryPlan::new(primitive, &bias, &viewport, on_target);
        if geometry.rect.is_empty() {
            return None;
        }
        Some(Self {
            key: StateKey {
                pipeline: draw.pipeline,
                viewport: draw.viewport,
                scissor: draw.scissor,
            },
            geometry,
            is_uncut: is_stippled_strip(draw),
        })
    }

    /// Returns true if a draw on the same target has this state.
    pub(crate) fn is_of(&self, draw: &Draw<'_>) -> bool {
        let key = &self.key;
        std::ptr::eq(key.pipeline, draw.pipeline)
            && key.scissor == draw.scissor
            && key.viewport.map(bits) == draw.viewport.map(bits)
    }
}

/// A viewport's numbers as bits, because the sign of zero shows in depths.
fn bits(viewport: Viewport) -> [u32; 6] {
    let Viewport {
        x,
        y,
        width,
        height,
        min_depth,
        max_depth,
    } = viewport;
    [x, y, width, height, min_depth, max_depth].map(f32::to_bits)
}
