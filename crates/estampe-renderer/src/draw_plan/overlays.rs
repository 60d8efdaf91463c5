//! The draws of strokes: feature edges over the surfaces, and guides around the model.

use super::drawing::PlannedDraw;
use super::planner::{DrawPlanBuilder, Planner};
use super::points_and_lines::is_dark;
use crate::alpha::{Encoding, decode};
use crate::feature_edges::{self, FeatureEdges};
use crate::frame_style::{encoding, half_width_px};
use crate::guides::{AXIS_COLORS, box_strokes, grid_strokes};
use crate::options::{RenderOptions, Shading};
use crate::render_error::RenderError;
use crate::strokes::{Stroke, StrokeDraws, StrokeStyle, Window};
use crate::transforms::round_to_f32;
use estampe_scene::Mesh;
use glam::DVec2;
use std::borrow::Cow;

impl Planner<'_> {
    /// Plans all strokes of the options.
    ///
    /// `meshes` are those of the scene, if [`Self::has_strokes_of_meshes`].
    pub(super) fn plan_overlays(
        &self,
        meshes: &[Cow<'_, Mesh>],
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        let meshes = || meshes.iter().map(AsRef::<Mesh>::as_ref);
        let options = self.options;
        let window = Window {
            clip_from_unit: self.view.clip_from_unit(),
            size_px: DVec2::new(options.width.into(), options.height.into()),
        };
        let width_px = 2.0 * half_width_px(options);
        let is_dark = is_dark(
            options
                .background
                .unwrap_or(RenderOptions::DEFAULT_BACKGROUND),
        );
        if let Some(edges) = &options.edges {
            let unit = |position| self.view.space.unit_from_object(position).as_dvec3();
            let of_mesh =
                |mesh: &Mesh| feature_edges::strokes(mesh, edges, unit, &window, self.workers);
            let strokes: Vec<Stroke> = meshes().flat_map(of_mesh).collect();
            let is_light = options.shading == Shading::Overdraw
                || options.shading == Shading::Wireframe && is_dark;
            let style = StrokeStyle {
                color: self.stroke_color(if is_light { LIGHT } else { DARK }),
                width_px: edges.width_px.unwrap_or(width_px),
                is_on_surfaces: true,
            };
            let draws = self.strokes(&strokes, style, &window, builder)?;
            builder.plan.edges.extend(draws);
        }
        if self.has_outlines() {
            let strokes = self.outlines(meshes(), &window);
            let [r, g, b, alpha] = self.style.wireframe.line;
            let style = StrokeStyle {
                color: [r, g, b],
                width_px,
                is_on_surfaces: true,
            };
            let faded = strokes.into_iter().map(|stroke| Stroke {
                alphas: stroke.alphas.map(|own| own * alpha),
                ..stroke
            });
            let draws = self.strokes(&faded.collect::<Vec<_>>(), style, &window, builder)?;
            builder.plan.edges.extend(draws);
        }
        let grey = if is_dark { LIGHT_GREY } else { DARK_GREY };
        let mut guides: Vec<(Vec<Stroke>, [u8; 3], bool)> = Vec::new();
        if options.grid {
            let grid = grid_strokes(self.view);
            guides.push((grid.lines, grey, false));
            let axes = grid.axes.into_iter().zip(AXIS_COLORS);
            guides.extend(axes.map(|(strokes, color)| (strokes, color, false)));
        }
        if options.bounding_box.is_some() {
            guides.push((box_strokes(self.view), grey, true));
        }
        for (strokes, color, is_on_surfaces) in guides {
            let style = StrokeStyle {
                color: self.stroke_color(color),
                width_px,
                is_on_surfaces,
            };
            let draws = self.strokes(&strokes, style, &window, builder)?;
            builder.plan.guides.extend(draws);
        }
        Ok(())
    }

    /// True if strokes are drawn along edges of the meshes.
    pub(super) fn has_strokes_of_meshes(&self) -> bool {
        self.options.edges.is_some() || self.has_outlines()
    }

    fn has_outlines(&self) -> bool {
        self.options.samples == 1 && self.options.shading == Shading::Wireframe
    }

    /// The outlines of the model: with one sample per pixel the triangles of a wireframe end at
    /// jagged borders, which these strokes cover. They fade with the size of triangles as the
    /// wireframe does.
    fn outlines<'m>(&self, meshes: impl Iterator<Item = &'m Mesh>, window: &Window) -> Vec<Stroke> {
        let of_outlines = FeatureEdges {
            angle_deg: 180.0,
            width_px: None,
        };
        let unit = |position| self.view.space.unit_from_object(position).as_dvec3();
        let of_mesh =
            |mesh: &Mesh| feature_edges::strokes(mesh, &of_outlines, unit, window, self.workers);
        let faded = |stroke: Stroke| {
            let length_px = match stroke.ends.map(|end| window.point(end)) {
                [Some(a), Some(b)] => (b.at_px - a.at_px).length(),
                _ => f64::INFINITY,
            };
            Stroke {
                alphas: [round_to_f32(length_px / 11.0 + 0.18).min(1.0); 2],
                ..stroke
            }
        };
        meshes.flat_map(of_mesh).map(faded).collect()
    }

    /// The linear colour of these codes in the picture.
    fn stroke_color(&self, codes: [u8; 3]) -> [f32; 3] {
        let encoding: Encoding = encoding(self.options);
        codes.map(|code| decode(code, encoding))
    }

    /// The draw of strokes, if one of them is visible.
    fn strokes(
        &self,
        strokes: &[Stroke],
        style: StrokeStyle,
        window: &Window,
        builder: &mut DrawPlanBuilder,
    ) -> Result<Option<PlannedDraw>, RenderError> {
        let of = (strokes, style);
        let made = StrokeDraws::new(self.device, self.style, of, window, self.workers)?;
        Ok(made.map(|made| PlannedDraw {
            pipeline: builder.plan.add_pipeline(made.pipeline),
            vertex_buffers: vec![made.vertices],
            indices: Some(made.indices),
            elements: 0..made.index_count,
        }))
    }
}

/// Colours of edges, sRGB.
const DARK: [u8; 3] = [0x10, 0x18, 0x20];
const LIGHT: [u8; 3] = [0xe4, 0xe8, 0xee];
/// Colours of guides, sRGB: on light and on dark backgrounds.
const DARK_GREY: [u8; 3] = [0x6a, 0x70, 0x78];
const LIGHT_GREY: [u8; 3] = [0xa8, 0xae, 0xb8];
