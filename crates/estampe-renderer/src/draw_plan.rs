//! The draws of a frame in their order: opaque surfaces, lines and points in scene order, then
//! transparent triangles back to front.

use crate::alpha::{Encoding, decode};
use crate::frame::RenderError;
use crate::geometry::faces::{LitAt, unshared_streams};
use crate::geometry::order::{DistantTriangle, back_to_front};
use crate::geometry::vertex_data::{MeshStreams, StreamData, VertexStream};
use crate::materials::Materials;
use crate::options::{RenderOptions, Shading};
use crate::scene_view::SceneView;
use crate::shading::points_and_lines::PointsAndLines;
use crate::surface_pipelines::{FrameStyle, StreamPipeline, Transparency};
use crate::transforms::round_to_f32;
use estampe::state::PrimitiveTopology;
use estampe::{BufferError, BufferSlice, Device, Draw, IndexFormat, TextureFormat};
use estampe_scene::{Mesh, Scene, Surface, Workers};
use glam::{DVec3, Vec3};
use std::collections::HashMap;
use std::ops::Range;

/// The pipelines and buffers of a frame's draws.
#[derive(Debug, Default)]
pub(crate) struct DrawPlan {
    pipelines: Vec<StreamPipeline>,
    draws: Vec<PlannedDraw>,
}

#[derive(Debug)]
struct PlannedDraw {
    pipeline: usize,
    vertex_buffers: Vec<BufferSlice>,
    indices: Option<BufferSlice>,
    elements: Range<u32>,
}

impl DrawPlan {
    /// The draws, in order.
    pub(crate) fn draws(&self) -> Vec<Draw<'_>> {
        let draw = |planned: &'_ PlannedDraw| {
            let pipeline = &self.pipelines[planned.pipeline].pipeline;
            (pipeline, planned.elements.clone())
        };
        let draws = self.draws.iter().map(|planned| {
            let (pipeline, elements) = draw(planned);
            Draw {
                vertex_buffers: &planned.vertex_buffers,
                index_buffer: planned
                    .indices
                    .as_ref()
                    .map(|buffer| (buffer, IndexFormat::Uint32)),
                ..Draw::new(pipeline, elements)
            }
        });
        draws.collect()
    }
}

/// Surfaces with equal keys share a pipeline: same material, and the same streams are constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct PipelineKey {
    material: Option<usize>,
    is_unshared: bool,
    has_normals: bool,
    has_uvs: bool,
    has_colors: bool,
}

/// Inputs of [`Planner::plan`].
pub(crate) struct Planner<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) options: &'a RenderOptions,
    pub(crate) view: &'a SceneView,
    pub(crate) style: &'a FrameStyle,
    pub(crate) device: &'a Device,
    /// Threads that create buffers.
    pub(crate) workers: Workers,
}

/// The parts of a plan that are complete so far.
#[derive(Default)]
struct DrawPlanBuilder {
    plan: DrawPlan,
    pipeline_of_key: HashMap<PipelineKey, usize>,
    transparent: Vec<DistantTriangle>,
    /// Pipeline and vertex buffers of each transparent surface.
    transparent_surfaces: Vec<(usize, Vec<BufferSlice>)>,
}

impl Planner<'_> {
    /// Plans the draws of the whole scene.
    pub(crate) fn plan(&self) -> Result<DrawPlan, RenderError> {
        let mut materials = Materials::new(self.scene, self.options, self.device);
        let mut builder = DrawPlanBuilder::default();
        for mesh in &self.scene.meshes {
            self.plan_mesh(mesh, &mut materials, &mut builder)?;
        }
        for run in back_to_front(std::mem::take(&mut builder.transparent)) {
            let (pipeline, vertex_buffers) =
                builder.transparent_surfaces[run.surface as usize].clone();
            let elements = 0..element_count(run.indices.len())?;
            let indices = Some(self.index_buffer_of(run.indices)?);
            builder.plan.draws.push(PlannedDraw {
                pipeline,
                vertex_buffers,
                indices,
                elements,
            });
        }
        Ok(builder.plan)
    }

    fn plan_mesh(
        &self,
        mesh: &Mesh,
        materials: &mut Materials<'_>,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        let is_unshared = self.style.needs_unshared_vertices() || mesh.normals.is_empty();
        let has_points_or_lines = !mesh.lines.is_empty() || !mesh.points.is_empty();
        let shared = (!is_unshared && !mesh.triangles.is_empty() || has_points_or_lines)
            .then(|| MeshStreams::shared(mesh, &self.view.space, self.device, self.workers))
            .transpose()?;
        if !mesh.triangles.is_empty() {
            let unshared;
            let streams = match &shared {
                Some(shared) if !is_unshared => shared,
                _ => {
                    let lit_at = if self.style.needs_face_centers() {
                        LitAt::Centroid
                    } else {
                        LitAt::Vertices
                    };
                    unshared = unshared_streams(mesh, lit_at, &self.view.space, self.device)?;
                    &unshared
                }
            };
            self.plan_triangles(mesh, streams, is_unshared, materials, builder)?;
        }
        if let Some(shared) = &shared {
            self.plan_points_and_lines(mesh, shared, builder)?;
        }
        Ok(())
    }

    fn plan_triangles(
        &self,
        mesh: &Mesh,
        streams: &MeshStreams,
        is_unshared: bool,
        materials: &mut Materials<'_>,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        element_count(mesh.triangles.len().saturating_mul(3))?;
        let indices = (!is_unshared)
            .then(|| self.index_buffer(mesh))
            .transpose()?;
        let whole = [Surface {
            material: None,
            triangles: 0..mesh.triangles.len(),
        }];
        let surfaces = if mesh.surfaces.is_empty() {
            &whole[..]
        } else {
            &mesh.surfaces
        };
        for surface in surfaces {
            let end = surface.triangles.end.min(mesh.triangles.len());
            let triangles = surface.triangles.start.min(end)..end;
            let style = materials.style(surface.material, mesh)?;
            if triangles.is_empty()
                || style.transparency == Transparency::Blended && style.base[3] <= 0.0
            {
                continue;
            }
            let key = PipelineKey {
                material: surface.material,
                is_unshared,
                has_normals: !mesh.normals.is_empty(),
                has_uvs: !mesh.uvs.is_empty(),
                has_colors: !mesh.colors.is_empty(),
            };
            let pipeline = match builder.pipeline_of_key.get(&key) {
                Some(&pipeline) => pipeline,
                None => {
                    let pipeline = self.style.surface(self.device, &style, streams)?;
                    builder.plan.pipelines.push(pipeline);
                    let last = builder.plan.pipelines.len() - 1;
                    builder.pipeline_of_key.insert(key, last);
                    last
                }
            };
            let vertex_buffers = buffers_of(&builder.plan.pipelines[pipeline], streams);
            if style.transparency == Transparency::Blended && self.style.shows_transparency() {
                self.collect_transparent(mesh, triangles, is_unshared, builder);
                builder
                    .transparent_surfaces
                    .push((pipeline, vertex_buffers));
                continue;
            }
            let elements = element_count(triangles.start * 3)?..element_count(triangles.end * 3)?;
            let indices = indices.clone();
            builder.plan.draws.push(PlannedDraw {
                pipeline,
                vertex_buffers,
                indices,
                elements,
            });
        }
        Ok(())
    }

    /// The triangles' vertex indices, unchanged.
    fn index_buffer(&self, mesh: &Mesh) -> Result<BufferSlice, BufferError> {
        /// Indices of a piece: some hundred microseconds of work, because touching new memory costs
        /// more than copying.
        const PIECE: usize = 1 << 16;
        let corners = mesh.triangles.as_flattened();
        let mut words = vec![0; corners.len()];
        let parts = words.chunks_mut(PIECE).zip(corners.chunks(PIECE));
        self.workers
            .map(parts, |(to, from)| to.copy_from_slice(from));
        self.index_buffer_of(words)
    }

    fn index_buffer_of(&self, indices: Vec<u32>) -> Result<BufferSlice, BufferError> {
        let buffer = self.device.create_buffer_of_words(indices)?;
        Ok(BufferSlice::from(&buffer))
    }

    /// Adds the triangles of the next transparent surface, which the caller pushes afterwards.
    fn collect_transparent(
        &self,
        mesh: &Mesh,
        triangles: Range<usize>,
        is_unshared: bool,
        builder: &mut DrawPlanBuilder,
    ) {
        let surface = u32::try_from(builder.transparent_surfaces.len()).unwrap_or(u32::MAX);
        let position = |index: u32| {
            let position = mesh
                .positions
                .get(index as usize)
                .copied()
                .unwrap_or(Vec3::NAN);
            self.view.space.unit_from_object(position).as_dvec3()
        };
        for number in triangles {
            let triangle = mesh.triangles[number];
            let middle = triangle.map(position).into_iter().sum::<DVec3>() / 3.0;
            let distance = round_to_f32(self.view.distance(middle));
            // `plan_triangles` has checked that all corners fit u32.
            let first = u32::try_from(number * 3).unwrap_or(u32::MAX);
            let corners = if is_unshared {
                [first, first.saturating_add(1), first.saturating_add(2)]
            } else {
                triangle
            };
            builder.transparent.push(DistantTriangle {
                distance,
                surface,
                corners,
            });
        }
    }

    fn plan_points_and_lines(
        &self,
        mesh: &Mesh,
        shared: &MeshStreams,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        let lines = (mesh.lines.as_flattened(), PrimitiveTopology::LineList);
        let points = (&mesh.points[..], PrimitiveTopology::PointList);
        for (indices, topology) in [lines, points] {
            if indices.is_empty() {
                continue;
            }
            let elements = 0..element_count(indices.len())?;
            let shows_colors = !mesh.colors.is_empty() && !self.style.shading.holds_numbers();
            let mut streams = shared.clone();
            if !shows_colors {
                streams.colors = StreamData::constant(self.device, &[1.0; 4])?;
            }
            let shader = self.points_and_lines(shows_colors, mesh.points.len());
            let pipeline = self
                .style
                .points_and_lines(self.device, shader, topology, &streams)?;
            let vertex_buffers = buffers_of(&pipeline, &streams);
            builder.plan.pipelines.push(pipeline);
            let pipeline = builder.plan.pipelines.len() - 1;
            let indices = Some(self.index_buffer_of(indices.to_vec())?);
            builder.plan.draws.push(PlannedDraw {
                pipeline,
                vertex_buffers,
                indices,
                elements,
            });
        }
        Ok(())
    }

    /// The shader of points and lines: vertex colours, or one colour that contrasts with the
    /// background.
    fn points_and_lines(&self, shows_colors: bool, point_count: usize) -> PointsAndLines {
        let encoding = match self.style.format {
            TextureFormat::Rgba8UnormSrgb => Encoding::Srgb,
            _ => Encoding::Linear,
        };
        let background = self
            .options
            .background
            .unwrap_or(RenderOptions::DEFAULT_BACKGROUND);
        let contrasting = if is_dark(background) {
            [0xd8, 0xdc, 0xe2]
        } else {
            [0x2c, 0x3a, 0x4a]
        };
        let is_depth = self.style.shading == Shading::Depth;
        let (color, distant_color, share_at_furthest) = if is_depth {
            ([1.0; 3], [0.0; 3], 1.0)
        } else {
            let own = if shows_colors {
                [1.0; 3]
            } else {
                contrasting.map(|code| decode(code, encoding))
            };
            let share = if self.style.shading.holds_numbers() || shows_colors {
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

/// True if light points and lines contrast better with a background than dark ones.
pub(crate) fn is_dark([r, g, b]: [u8; 3]) -> bool {
    let luma = u32::from(r) * 2126 + u32::from(g) * 7152 + u32::from(b) * 722;
    luma < 110 * 10_000
}

/// Width of points, chosen so that a cloud looks like a surface: the points share about half of the
/// image's area, within limits that keep them visible and apart.
fn point_size_px(options: &RenderOptions, count: usize) -> f32 {
    let (width, height) = (f64::from(options.width), f64::from(options.height));
    let shorter = width.min(height);
    let count = f64::from(u32::try_from(count).unwrap_or(u32::MAX).max(1));
    let share = libm::sqrt(width * height / count) * 0.6;
    round_to_f32(share.clamp((shorter / 400.0).max(1.0), (shorter / 50.0).max(1.0)))
}

fn buffers_of(pipeline: &StreamPipeline, streams: &MeshStreams) -> Vec<BufferSlice> {
    pipeline
        .streams
        .iter()
        .map(|&stream: &VertexStream| streams.get(stream).buffer())
        .collect()
}

fn element_count(elements: usize) -> Result<u32, RenderError> {
    u32::try_from(elements).map_err(|_| RenderError::TooManyElements { elements })
}
