//! The draws of a mesh's triangles: opaque surfaces, and transparent ones for the method that
//! blends them.

use super::drawing::PlannedDraw;
use super::planner::{DrawPlanBuilder, Planner, buffers_of, element_count};
use crate::geometry::faces::{FaceAttributes, LitAt, unshared_streams};
use crate::geometry::order::DistantTriangle;
use crate::geometry::vertex_data::MeshStreams;
use crate::materials::Materials;
use crate::options::Transparency;
use crate::render_error::RenderError;
use crate::surface_pipelines::{Role, SurfaceAlpha, SurfaceStyle};
use crate::transforms::round_to_f32;
use estampe::{BufferError, BufferSlice};
use estampe_scene::{Mesh, Surface};
use glam::{DVec3, Vec3};
use std::ops::Range;

/// Surfaces with equal keys share a pipeline: same material and role, and the same streams are
/// constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct PipelineKey {
    material: Option<usize>,
    /// `None` finds layers.
    role: Option<Role>,
    is_unshared: bool,
    has_normals: bool,
    has_uvs: bool,
    has_colors: bool,
    has_uvs_1: bool,
    has_tangents: bool,
    /// Back faces are culled.
    is_single_sided: bool,
    /// The bits of the mesh's scale, by which the thickness of bodies is multiplied.
    scale_bits: Option<u32>,
}

/// The triangles of a mesh as draws read them.
pub(super) struct MeshDraws<'a> {
    /// The mesh; without positions, normals and triangles if buffers have taken them.
    pub(super) mesh: &'a Mesh,
    pub(super) triangle_count: usize,
    pub(super) has_normals: bool,
    pub(super) streams: &'a MeshStreams,
    /// Indices of shared vertices.
    pub(super) indices: Option<BufferSlice>,
    /// Unshared vertices, if edges are drawn over the surfaces.
    pub(super) edges: Option<MeshStreams>,
    pub(super) is_unshared: bool,
}

/// A surface with its pipelines' key for an opaque surface.
struct SurfaceDraw<'a> {
    of: &'a MeshDraws<'a>,
    style: &'a SurfaceStyle,
    key: PipelineKey,
    triangles: Range<usize>,
}

impl Planner<'_> {
    /// Plans the surfaces of a mesh.
    pub(super) fn plan_triangles(
        &self,
        of: &MeshDraws<'_>,
        materials: &mut Materials<'_>,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        let mesh = of.mesh;
        element_count(of.triangle_count.saturating_mul(3))?;
        let whole = [Surface {
            material: None,
            triangles: 0..of.triangle_count,
        }];
        let surfaces = if mesh.surfaces.is_empty() {
            &whole[..]
        } else {
            &mesh.surfaces
        };
        for surface in surfaces {
            let end = surface.triangles.end.min(of.triangle_count);
            let triangles = surface.triangles.start.min(end)..end;
            let style = materials.style(surface.material, mesh)?;
            let is_blended = style.alpha == SurfaceAlpha::Blended;
            if triangles.is_empty() || is_blended && style.base[3] <= 0.0 {
                continue;
            }
            let surface = SurfaceDraw {
                of,
                style: &style,
                key: PipelineKey {
                    material: surface.material,
                    role: Some(Role::Opaque),
                    is_unshared: of.is_unshared,
                    has_normals: of.has_normals,
                    has_uvs: !mesh.uvs.is_empty(),
                    has_colors: !mesh.colors.is_empty(),
                    has_uvs_1: mesh.attribute(Mesh::UV1).is_some(),
                    has_tangents: mesh.attribute(Mesh::TANGENT).is_some(),
                    is_single_sided: style.is_single_sided,
                    scale_bits: mesh.scale.map(f32::to_bits),
                },
                triangles,
            };
            self.plan_edges(&surface, builder)?;
            if is_blended && self.style.shows_transparency() {
                self.plan_transparent(&surface, builder)?;
            } else {
                let draw = self.surface_draw(&surface, Some(Role::Opaque), builder)?;
                builder.plan.opaque.push(draw);
                if style.transmits() {
                    continue;
                }
                if self.style.behind.is_some() {
                    let draw = self.surface_draw(&surface, Some(Role::Behind), builder)?;
                    builder.plan.behind.push(draw);
                }
                self.plan_casters(&surface, builder)?;
            }
        }
        Ok(())
    }

    /// The streams of edges over a mesh's surfaces, if they are drawn.
    pub(super) fn edge_streams(
        &self,
        mesh: &Mesh,
        streams: &MeshStreams,
        is_unshared: bool,
    ) -> Result<Option<MeshStreams>, BufferError> {
        if self.style.overlay.is_none() {
            Ok(None)
        } else if is_unshared {
            Ok(Some(streams.clone()))
        } else {
            let attributes = FaceAttributes {
                lit_at: LitAt::Vertices,
                first_number: None,
            };
            unshared_streams(mesh, attributes, &self.view.space, self.device).map(Some)
        }
    }

    /// Plans the edges over a surface, if they are drawn.
    fn plan_edges(
        &self,
        surface: &SurfaceDraw<'_>,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        let (Some(edges), Some(streams)) = (&self.style.overlay, &surface.of.edges) else {
            return Ok(());
        };
        let pipeline = match builder.edges {
            Some(pipeline) => pipeline,
            None => {
                let made = self.style.edges(self.device, edges, streams)?;
                *builder.edges.insert(builder.plan.add_pipeline(made))
            }
        };
        let Range { start, end } = surface.triangles;
        builder.plan.edges.push(PlannedDraw {
            pipeline,
            vertex_buffers: buffers_of(&builder.plan.pipelines[pipeline], streams),
            indices: None,
            elements: element_count(start * 3)?..element_count(end * 3)?,
        });
        Ok(())
    }

    /// Plans the draws of an opaque surface in the maps of lights and ground.
    fn plan_casters(
        &self,
        surface: &SurfaceDraw<'_>,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        for slot in self.style.caster_slots() {
            let draw = self.surface_draw(surface, Some(Role::Caster(slot)), builder)?;
            builder.plan.casters[slot].push(draw);
        }
        Ok(())
    }

    /// Plans the draws of a transparent surface; its triangles are sorted later, with those of the
    /// other surfaces.
    fn plan_transparent(
        &self,
        surface: &SurfaceDraw<'_>,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        match self.options.transparency {
            Transparency::Sorted => {}
            Transparency::Exact => {
                let finding = self.surface_draw(surface, None, builder)?;
                let blending = self.surface_draw(surface, Some(Role::Layer), builder)?;
                builder.plan.layers.finding.push(finding);
                builder.plan.layers.blending.push(blending);
            }
            Transparency::Weighted => {
                let draw = self.surface_draw(surface, Some(Role::Weighted), builder)?;
                builder.plan.transparent.push(draw);
                return Ok(());
            }
        }
        let draw = self.surface_draw(surface, Some(Role::Blended), builder)?;
        self.collect_transparent(surface, builder);
        builder
            .transparent_surfaces
            .push((draw.pipeline, draw.vertex_buffers));
        Ok(())
    }

    /// All triangles of a surface in their order; without a role, to find layers.
    fn surface_draw(
        &self,
        surface: &SurfaceDraw<'_>,
        role: Option<Role>,
        builder: &mut DrawPlanBuilder,
    ) -> Result<PlannedDraw, RenderError> {
        let MeshDraws {
            streams, indices, ..
        } = surface.of;
        let key = PipelineKey {
            role,
            ..surface.key
        };
        let pipeline = match builder.pipeline_of_key.get(&key) {
            Some(&pipeline) => pipeline,
            None => {
                let made = match role {
                    Some(role) => self
                        .style
                        .surface(self.device, surface.style, streams, role)?,
                    None => self.style.finding(self.device, streams)?,
                };
                let pipeline = builder.plan.add_pipeline(made);
                builder.pipeline_of_key.insert(key, pipeline);
                pipeline
            }
        };
        let Range { start, end } = surface.triangles;
        Ok(PlannedDraw {
            pipeline,
            vertex_buffers: buffers_of(&builder.plan.pipelines[pipeline], streams),
            indices: indices.clone(),
            elements: element_count(start * 3)?..element_count(end * 3)?,
        })
    }

    /// Adds the triangles of the next transparent surface, which the caller pushes afterwards.
    fn collect_transparent(&self, drawn: &SurfaceDraw<'_>, builder: &mut DrawPlanBuilder) {
        let mesh = drawn.of.mesh;
        let surface = u32::try_from(builder.transparent_surfaces.len()).unwrap_or(u32::MAX);
        let position = |index: u32| {
            let position = mesh
                .positions
                .get(index as usize)
                .copied()
                .unwrap_or(Vec3::NAN);
            self.view.space.unit_from_object(position).as_dvec3()
        };
        for number in drawn.triangles.clone() {
            let triangle = mesh.triangles[number];
            let middle = triangle.map(position).into_iter().sum::<DVec3>() / 3.0;
            let distance = round_to_f32(self.view.distance(middle));
            // `plan_triangles` has checked that all corners fit u32.
            let first = u32::try_from(number * 3).unwrap_or(u32::MAX);
            let corners = if drawn.key.is_unshared {
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
}
