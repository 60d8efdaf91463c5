//! Plans the draws of a scene, mesh by mesh.

use super::drawing::{DrawPlan, PlannedDraw};
use super::surfaces::{MeshDraws, PipelineKey};
use crate::geometry::faces::{FaceAttributes, LitAt, unshared_streams};
use crate::geometry::order::{DistantTriangle, back_to_front};
use crate::geometry::tangents::with_tangents;
use crate::geometry::vertex_data::{MeshStreams, StreamData, VertexStream};
use crate::materials::{Materials, TextureKey};
use crate::options::{RenderOptions, Shading};
use crate::render_error::RenderError;
use crate::scene_view::SceneView;
use crate::surface_pipelines::{FrameStyle, StreamPipeline, SurfaceAlpha};
use estampe::{BufferError, BufferSlice, Device, Texture, TextureError};
use estampe_scene::{Mesh, Scene, Workers};
use std::borrow::Cow;
use std::collections::HashMap;

/// Inputs of [`Planner::plan`].
pub(crate) struct Planner<'a> {
    /// The scene, which may lack its meshes.
    pub(crate) scene: &'a Scene,
    /// The meshes of the scene. The memory of owned ones becomes that of buffers where it can.
    pub(crate) meshes: Vec<Cow<'a, Mesh>>,
    pub(crate) options: &'a RenderOptions,
    pub(crate) view: &'a SceneView,
    pub(crate) style: &'a FrameStyle,
    pub(crate) device: &'a Device,
    /// Threads that create buffers.
    pub(crate) workers: Workers,
}

/// The parts of a plan that are complete so far.
#[derive(Default)]
pub(super) struct DrawPlanBuilder {
    pub(super) plan: DrawPlan,
    pub(super) pipeline_of_key: HashMap<PipelineKey, usize>,
    /// The pipeline of edges over surfaces.
    pub(super) edges: Option<usize>,
    /// Lines that are blended, after all opaque surfaces.
    pub(super) smooth_lines: Vec<PlannedDraw>,
    /// The triangles of all meshes before.
    first_number: usize,
    /// The triangles that are sorted.
    pub(super) transparent: Vec<DistantTriangle>,
    /// Pipeline and vertex buffers of each transparent surface.
    pub(super) transparent_surfaces: Vec<(usize, Vec<BufferSlice>)>,
}

impl Planner<'_> {
    /// Plans the draws of the whole scene.
    pub(crate) fn plan(mut self) -> Result<DrawPlan, RenderError> {
        let mut materials = Materials::new(self.scene, self.options, self.view, self.device);
        let with_tangents = self.make_tangents_and_textures(&mut materials)?;
        let mut builder = DrawPlanBuilder::default();
        let kept = if self.has_strokes_of_meshes() {
            std::mem::take(&mut self.meshes)
        } else {
            Vec::new()
        };
        let meshes = if kept.is_empty() {
            std::mem::take(&mut self.meshes)
        } else {
            let meshes = kept.iter();
            meshes.map(|mesh| Cow::Borrowed(mesh.as_ref())).collect()
        };
        for (mesh, made) in meshes.into_iter().zip(with_tangents) {
            let mesh = made.map_or(mesh, Cow::Owned);
            self.plan_mesh(mesh, &mut materials, &mut builder)?;
        }
        builder.plan.opaque.append(&mut builder.smooth_lines);
        self.plan_overlays(&kept, &mut builder)?;
        for run in back_to_front(std::mem::take(&mut builder.transparent)) {
            let (pipeline, vertex_buffers) =
                builder.transparent_surfaces[run.surface as usize].clone();
            let elements = 0..element_count(run.indices.len())?;
            let indices = Some(self.index_buffer_of(run.indices)?);
            builder.plan.transparent.push(PlannedDraw {
                pipeline,
                vertex_buffers,
                indices,
                elements,
            });
        }
        Ok(builder.plan)
    }

    /// The meshes whose tangents must be made, with them, and the textures of all surfaces: what
    /// takes the most time and can be done by several threads.
    fn make_tangents_and_textures(
        &self,
        materials: &mut Materials<'_>,
    ) -> Result<Vec<Option<Mesh>>, RenderError> {
        enum Job<'a> {
            Tangents(&'a Mesh),
            Texture(TextureKey),
        }
        enum Made {
            Tangents(Option<Mesh>),
            Texture(TextureKey, Result<Texture, TextureError>),
        }
        let meshes = || self.meshes.iter().map(AsRef::<Mesh>::as_ref);
        let tangents = meshes().map(Job::Tangents);
        let textures = materials.missing_textures(meshes(), self.workers);
        let jobs = tangents.chain(textures.into_iter().map(Job::Texture));
        let made = self.workers.map(jobs, |job| match job {
            Job::Tangents(mesh) => {
                let uv_set = self.normal_map_uv_set(mesh);
                Made::Tangents(uv_set.and_then(|uv_set| with_tangents(mesh, uv_set)))
            }
            Job::Texture(key) => Made::Texture(key, materials.create(key)),
        });
        let mut meshes = Vec::with_capacity(self.meshes.len());
        for made in made {
            match made {
                Made::Tangents(mesh) => meshes.push(mesh),
                Made::Texture(key, texture) => materials.keep(key, texture?),
            }
        }
        Ok(meshes)
    }

    /// The texture coordinates of a mesh's first normal map, or of the direction of its roughness,
    /// if it has one and no tangents.
    fn normal_map_uv_set(&self, mesh: &Mesh) -> Option<u8> {
        if self.style.pbr.is_none() || mesh.attribute(Mesh::TANGENT).is_some() {
            return None;
        }
        mesh.surfaces.iter().find_map(|surface| {
            let material = self.scene.materials.get(surface.material?)?;
            material.pbr.as_ref()?.tangent_uv_set()
        })
    }

    fn plan_mesh(
        &self,
        mesh: Cow<'_, Mesh>,
        materials: &mut Materials<'_>,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        let is_unshared = self.style.needs_unshared_vertices() || mesh.normals.is_empty();
        let has_points_or_lines = !mesh.lines.is_empty() || !mesh.points.is_empty();
        let has_triangles_alone = !mesh.triangles.is_empty() && !has_points_or_lines;
        let mesh = match mesh {
            Cow::Owned(mesh)
                if !is_unshared
                    && has_triangles_alone
                    && self.is_read_once(&mesh, materials)? =>
            {
                return self.plan_spent(mesh, materials, builder);
            }
            ref mesh => mesh.as_ref(),
        };
        let shared = (!is_unshared && !mesh.triangles.is_empty() || has_points_or_lines)
            .then(|| MeshStreams::shared(mesh, &self.view.space, self.device, self.workers))
            .transpose()?;
        let shared = shared.map(|streams| self.painted(streams)).transpose()?;
        if !mesh.triangles.is_empty() {
            let unshared;
            let streams = match &shared {
                Some(shared) if !is_unshared => shared,
                _ => {
                    let attributes = FaceAttributes {
                        lit_at: if self.style.needs_face_centers() {
                            LitAt::Centroid
                        } else {
                            LitAt::Vertices
                        },
                        first_number: (self.style.shading == Shading::FaceId)
                            .then_some(builder.first_number),
                    };
                    let made = unshared_streams(mesh, attributes, &self.view.space, self.device)?;
                    unshared = self.painted(made)?;
                    &unshared
                }
            };
            element_count(mesh.triangles.len().saturating_mul(3))?;
            let indices = (!is_unshared)
                .then(|| self.index_buffer(mesh))
                .transpose()?;
            let of = MeshDraws {
                mesh,
                triangle_count: mesh.triangles.len(),
                has_normals: !mesh.normals.is_empty(),
                streams,
                indices,
                edges: self.edge_streams(mesh, streams, is_unshared)?,
                is_unshared,
            };
            self.plan_triangles(&of, materials, builder)?;
        }
        builder.first_number += mesh.triangles.len();
        if let Some(shared) = &shared {
            self.plan_points_and_lines(mesh, shared, builder)?;
        }
        Ok(())
    }

    /// True if the arrays of a mesh with shared vertices are not needed once they are in buffers.
    fn is_read_once(
        &self,
        mesh: &Mesh,
        materials: &mut Materials<'_>,
    ) -> Result<bool, RenderError> {
        let mut is_blended = false;
        for surface in &mesh.surfaces {
            // Transparent triangles are sorted by their positions.
            let style = materials.style(surface.material, mesh)?;
            is_blended |= style.alpha == SurfaceAlpha::Blended;
        }
        if mesh.surfaces.is_empty() {
            is_blended = materials.style(None, mesh)?.alpha == SurfaceAlpha::Blended;
        }
        // Named attributes are those of a mesh whose positions are there to count them.
        let has_attributes = !mesh.attributes.is_empty();
        Ok(!is_blended && !has_attributes && self.style.overlay.is_none())
    }

    /// Plans a mesh of triangles with shared vertices, whose arrays are read once: they become
    /// buffers where they are.
    fn plan_spent(
        &self,
        mut mesh: Mesh,
        materials: &mut Materials<'_>,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        let triangle_count = mesh.triangles.len();
        element_count(triangle_count.saturating_mul(3))?;
        let streams = MeshStreams::spent(&mut mesh, &self.view.space, self.device, self.workers)?;
        let indices = std::mem::take(&mut mesh.triangles).into_flattened();
        let of = MeshDraws {
            mesh: &mesh,
            triangle_count,
            has_normals: true,
            streams: &self.painted(streams)?,
            indices: Some(self.index_buffer_of(indices)?),
            edges: None,
            is_unshared: false,
        };
        builder.first_number += triangle_count;
        self.plan_triangles(&of, materials, builder)
    }

    /// The streams without vertex colours, if one colour replaces them.
    fn painted(&self, streams: MeshStreams) -> Result<MeshStreams, BufferError> {
        if self.options.color.is_none() {
            return Ok(streams);
        }
        Ok(MeshStreams {
            colors: StreamData::constant(self.device, &[1.0; 4])?,
            ..streams
        })
    }

    /// The triangles' vertex indices, unchanged.
    pub(super) fn index_buffer(&self, mesh: &Mesh) -> Result<BufferSlice, BufferError> {
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

    pub(super) fn index_buffer_of(&self, indices: Vec<u32>) -> Result<BufferSlice, BufferError> {
        let buffer = self.device.create_buffer_of_words(indices)?;
        Ok(BufferSlice::from(&buffer))
    }
}

/// The vertex buffers of a pipeline's draws.
pub(super) fn buffers_of(pipeline: &StreamPipeline, streams: &MeshStreams) -> Vec<BufferSlice> {
    pipeline
        .streams
        .iter()
        .map(|&stream: &VertexStream| streams.get(stream).buffer())
        .collect()
}

/// A number of elements as draws count them.
pub(super) fn element_count(elements: usize) -> Result<u32, RenderError> {
    u32::try_from(elements).map_err(|_| RenderError::TooManyElements { elements })
}
