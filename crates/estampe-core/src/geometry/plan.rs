//! The geometry plan: a draw's state, resolved once into what the geometry stages read.

use super::depth_bias::DepthBias;
use super::facing::Facing;
use super::line_style::LineStyle;
use super::viewport::ViewportTransform;
use crate::bounds::pixel_rect::PixelRect;
use crate::bounds::sample_rect::SampleRect;
use crate::layout::TileGrid;
use crate::pipeline::primitive_kind::{PrimitiveKind, kind_of};
use estampe_types::TextureFormat;
use estampe_types::state::{DepthBiasState, PolygonMode, PrimitiveState, Viewport};

/// The values that a draw's geometry depends on besides its vertices. Each is stored only here.
#[derive(Debug, Clone)]
pub(crate) struct GeometryPlan {
    pub(crate) kind: PrimitiveKind,
    pub(crate) polygon_mode: PolygonMode,
    pub(crate) transform: ViewportTransform,
    /// The pixels of which a sample may change: viewport ∩ scissor ∩ target.
    pub(crate) rect: PixelRect,
    /// The viewport's samples, where an edge of the viewport goes through pixels of the rectangle.
    pub(crate) cut_samples: Option<SampleRect>,
    /// The least and the greatest offset inside a pixel that coverage looks at, in 1/256 pixel: of
    /// its samples, or of its square where coverage is conservative.
    pub(crate) sample_range: [i32; 2],
    pub(crate) facing: Facing,
    /// None where nothing is added to depths.
    pub(crate) depth_bias: Option<DepthBias>,
    pub(crate) line_style: LineStyle,
    /// True if tiles draw triangles one by one, in order.
    pub(crate) draws_one_by_one: bool,
    /// True if tiles interpolate over triangles.
    pub(crate) interpolates: bool,
    /// True if some varying is the provoking vertex's.
    pub(crate) has_flat_varyings: bool,
    /// True if tiles may draw two triangles that make a rectangle as one box.
    pub(crate) joins_rectangles: bool,
    /// The tiles that primitives are binned to.
    pub(crate) grid: TileGrid,
}

/// The properties of a render target that [`GeometryPlan::new`] reads.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TargetGeometry {
    pub(crate) grid: TileGrid,
    pub(crate) depth_stencil: Option<TextureFormat>,
    /// Scissor ∩ target.
    pub(crate) rect: PixelRect,
    /// The least and the greatest offset of a sample's position inside its pixel, in 1/256 pixel.
    pub(crate) position_range: [i32; 2],
    /// See [`GeometryPlan::sample_range`].
    pub(crate) sample_range: [i32; 2],
    /// True if the pipeline's triangles may be drawn by visibility.
    pub(crate) is_opaque: bool,
    /// True if the pipeline writes colours.
    pub(crate) has_colors: bool,
    /// See [`GeometryPlan::has_flat_varyings`].
    pub(crate) has_flat_varyings: bool,
    /// True if small triangles of the pipeline that are drawn in order are listed, and none of its
    /// varyings is flat.
    pub(crate) joins_rectangles: bool,
}

impl GeometryPlan {
    /// The plan of a pipeline's primitive state and depth bias in a viewport.
    pub(crate) fn new(
        state: &PrimitiveState,
        bias: &DepthBiasState,
        viewport: &Viewport,
        target: TargetGeometry,
    ) -> Self {
        let samples = SampleRect::new(viewport);
        let [any, all] = samples.any_and_all(target.position_range);
        let (rect, whole_pixels) = (any.intersection(target.rect), all.intersection(target.rect));
        let cut_samples = (rect != whole_pixels).then_some(samples);
        let draws_one_by_one = !target.is_opaque || cut_samples.is_some();
        Self {
            kind: kind_of(state.topology),
            polygon_mode: state.polygon_mode,
            transform: ViewportTransform::new(viewport, state.unclipped_depth),
            rect,
            cut_samples,
            sample_range: target.sample_range,
            facing: Facing::new(state),
            depth_bias: DepthBias::new(bias, target.depth_stencil),
            line_style: LineStyle::new(&state.line),
            draws_one_by_one,
            interpolates: draws_one_by_one || target.has_colors,
            has_flat_varyings: target.has_flat_varyings,
            // Samples of a pixel may lie on both sides of a rectangle's side.
            joins_rectangles: target.joins_rectangles
                && cut_samples.is_none()
                && target.sample_range == [128; 2],
            grid: target.grid,
        }
    }

    /// Returns true if primitives are filled triangles, not lines or points.
    pub(crate) fn fills_triangles(&self) -> bool {
        self.kind == PrimitiveKind::Triangles && self.polygon_mode == PolygonMode::Fill
    }

    /// Returns true if each pixel has one sample, at its centre.
    pub(crate) fn samples_centers(&self) -> bool {
        self.sample_range == [128; 2]
    }
}
