//! The options of lines over the model and around it, and the renderer's options from them.

use crate::values::number_between;
use clap::Args;
use estampe_renderer::transforms::round_to_f32;
use estampe_renderer::{BoundingBox, FeatureEdges, RenderOptions};

/// Edges, and guides around the model.
#[derive(Debug, Clone, Args)]
pub(crate) struct OverlayArgs {
    /// Draw sharp edges, borders and silhouettes over the surfaces; sharp from DEG on [default: 30]
    ///
    /// By default they are drawn where the picture would be one colour: where nearly all faces have
    /// one direction, as in the front view of a plate. --edges=none draws none there either.
    ///
    /// An edge is sharp if the normals of its two faces differ by more than DEG degrees, 0 to 180.
    /// Borders, edges between two materials, and silhouettes are drawn with any angle.
    #[arg(long, value_name = "DEG", num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = "30", value_parser = edges, help_heading = "Lines")]
    edges: Option<Edges>,

    /// Width of --edges in pixels, 0.25 to 64 [default: in proportion to the picture]
    #[arg(long, value_name = "PX", value_parser = width, requires = "edges")]
    #[arg(help_heading = "Lines")]
    edge_width: Option<f32>,

    /// Draw a grid on the ground, in steps of 1, 2 or 5 times a power of ten units
    #[arg(long, help_heading = "Lines")]
    grid: bool,

    /// Draw a cross of the axes X, Y and Z of the file in the lower left corner
    #[arg(long, help_heading = "Lines")]
    axes: bool,

    /// Draw the model's box, with its sizes in the unit of the file
    #[arg(long, help_heading = "Lines")]
    bounding_box: bool,
}

impl OverlayArgs {
    /// The renderer's options with these.
    pub(super) fn apply(&self, options: RenderOptions) -> RenderOptions {
        RenderOptions {
            edges: match self.edges {
                Some(Edges::Sharp(angle_deg)) => Some(FeatureEdges {
                    angle_deg,
                    width_px: self.edge_width,
                }),
                Some(Edges::None) | None => None,
            },
            edges_of_flat_views: self.edges.is_none(),
            grid: self.grid,
            axes: self.axes,
            bounding_box: self.bounding_box.then(BoundingBox::default),
            ..options
        }
    }
}

/// The edges that are drawn.
#[derive(Debug, Clone, Copy)]
enum Edges {
    None,
    /// Those whose normals differ by more degrees.
    Sharp(f64),
}

/// `none`, or degrees between the normals of two faces.
fn edges(text: &str) -> Result<Edges, String> {
    if text.trim().eq_ignore_ascii_case("none") {
        return Ok(Edges::None);
    }
    let angle = number_between(text, 0.0, 180.0);
    angle
        .map(Edges::Sharp)
        .map_err(|error| format!("{error}, or none"))
}

/// A width in pixels.
fn width(text: &str) -> Result<f32, String> {
    Ok(round_to_f32(number_between(text, 0.25, 64.0)?))
}
