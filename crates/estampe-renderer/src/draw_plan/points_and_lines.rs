//! The draws of points and lines.

use super::drawing::PlannedDraw;
use super::planner::{DrawPlanBuilder, Planner, buffers_of, element_count};
use crate::alpha::decode;
use crate::frame_style::encoding;
use crate::geometry::vertex_data::{MeshStreams, StreamData};
use crate::options::{RenderOptions, Shading};
use crate::render_error::RenderError;
use crate::shading::inspection::Overdraw;
use crate::shading::points_and_lines::PointsAndLines;
use crate::surface_pipelines::{Role, is_smooth};
use crate::transforms::round_to_f32;
use estampe::state::{LineRasterization, LineState, PrimitiveState, PrimitiveTopology};
use estampe_scene::Mesh;

impl Planner<'_> {
    /// Plans the points and lines of a mesh.
    pub(super) fn plan_points_and_lines(
        &self,
        mesh: &Mesh,
        shared: &MeshStreams,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        let ends = mesh.lines.as_flattened();
        let joins: &[u32] = if self.options.rounds_joins() {
            ends
        } else {
            &[]
        };
        for (indices, kind) in [
            (ends, Kind::Lines),
            (joins, Kind::Joins),
            (&mesh.points[..], Kind::Points),
        ] {
            if indices.is_empty() {
                continue;
            }
            let elements = 0..element_count(indices.len())?;
            let shows_colors = !mesh.colors.is_empty()
                && self.options.color.is_none()
                && !self.style.shading.holds_numbers();
            let mut streams = shared.clone();
            if !shows_colors {
                streams.colors = StreamData::constant(self.device, &[1.0; 4])?;
            }
            let mut shader = self.points_and_lines(shows_colors, mesh.points.len());
            if let (Kind::Joins, Some(width)) = (kind, self.options.line_width_px) {
                shader.point_size_px = width;
            }
            let state = self.options.points_and_lines(kind);
            let indices = Some(self.index_buffer_of(indices.to_vec())?);
            let mut draw = |role| -> Result<PlannedDraw, RenderError> {
                let style = self.style;
                let shader = shader.clone();
                let made = style.points_and_lines(self.device, shader, (state, role), &streams)?;
                Ok(PlannedDraw {
                    vertex_buffers: buffers_of(&made, &streams),
                    pipeline: builder.plan.add_pipeline(made),
                    indices: indices.clone(),
                    elements: elements.clone(),
                })
            };
            let opaque = draw(Role::Opaque)?;
            if self.style.behind.is_some() {
                let behind = draw(Role::Behind)?;
                builder.plan.behind.push(behind);
            }
            let draws = if is_smooth(&state) {
                &mut builder.smooth_lines
            } else {
                &mut builder.plan.opaque
            };
            draws.push(opaque);
        }
        Ok(())
    }

    /// The shader of points and lines: vertex colours, or one colour that contrasts with the
    /// background.
    fn points_and_lines(&self, shows_colors: bool, point_count: usize) -> PointsAndLines {
        let encoding = encoding(self.options);
        let background = self
            .options
            .background
            .unwrap_or(RenderOptions::DEFAULT_BACKGROUND);
        let contrasting = if is_dark(background) {
            [0xd8, 0xdc, 0xe2]
        } else {
            [0x2c, 0x3a, 0x4a]
        };
        let (color, distant_color, share_at_furthest) = if self.style.shading == Shading::Depth {
            ([1.0; 3], [0.0; 3], 1.0)
        } else if self.style.shading == Shading::Overdraw {
            (Overdraw::ONE, [0.0; 3], 0.0)
        } else {
            let chosen = self.options.color.map(|[r, g, b, _]| [r, g, b]);
            let chosen = chosen.filter(|_| !self.style.shading.holds_numbers());
            let own = if shows_colors {
                [1.0; 3]
            } else {
                chosen
                    .unwrap_or(contrasting)
                    .map(|code| decode(code, encoding))
            };
            let share = if self.style.shading.holds_numbers() || shows_colors || chosen.is_some() {
                0.0
            } else {
                0.4
            };
            (own, background.map(|code| decode(code, encoding)), share)
        };
        PointsAndLines {
            transforms: self.style.transforms,
            color,
            distant_color,
            share_at_furthest,
            depth_range: self.style.depth_range,
            fog: self
                .style
                .fog
                .filter(|_| !self.style.shading.holds_numbers()),
            point_size_px: point_size_px(self.options, point_count),
        }
    }
}

/// A draw of points or lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Lines,
    /// Discs at the ends of wide lines, so that lines that meet have no notch.
    Joins,
    Points,
}

impl RenderOptions {
    /// True if the ends of lines are round. Discs are smooth if there are several samples.
    fn rounds_joins(&self) -> bool {
        self.samples > 1 && self.line_width_px.is_some_and(|width| width > 1.5)
    }

    /// The assembly and shape of points and lines. Lines are smooth by their samples, or by their
    /// coverage if there is one and the picture shows light; those of a chosen width are
    /// rectangles.
    fn points_and_lines(&self, kind: Kind) -> PrimitiveState {
        let mut line = LineState::default();
        if self.samples == 1 && !self.shading.holds_numbers() {
            line.rasterization = LineRasterization::RectangularSmooth;
        } else if self.line_width_px.is_some() {
            line.rasterization = LineRasterization::Rectangular;
        }
        if let Some(width) = self.line_width_px {
            line.width = width.clamp(f32::MIN_POSITIVE, 64.0);
        }
        PrimitiveState {
            topology: match kind {
                Kind::Lines => PrimitiveTopology::LineList,
                Kind::Joins | Kind::Points => PrimitiveTopology::PointList,
            },
            round_points: kind == Kind::Joins,
            line,
            ..PrimitiveState::default()
        }
    }
}

/// True if light points and lines contrast better with a background than dark ones.
pub(crate) fn is_dark([r, g, b]: [u8; 3]) -> bool {
    let luma = u32::from(r) * 2126 + u32::from(g) * 7152 + u32::from(b) * 722;
    luma < 110 * 10_000
}

/// Width of points: that of the options, or chosen so that a cloud looks like a surface: the points
/// share about half of the image's area, within limits that keep them visible and apart.
fn point_size_px(options: &RenderOptions, count: usize) -> f32 {
    if let Some(size) = options.point_size_px {
        return size;
    }
    let (width, height) = (f64::from(options.width), f64::from(options.height));
    let shorter = width.min(height);
    let count = f64::from(u32::try_from(count).unwrap_or(u32::MAX).max(1));
    let share = libm::sqrt(width * height / count) * 0.6;
    round_to_f32(share.clamp((shorter / 400.0).max(1.0), (shorter / 50.0).max(1.0)))
}
