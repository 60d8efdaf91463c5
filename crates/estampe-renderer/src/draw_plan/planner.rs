//! Plans the draws of a scene, mesh by mesh.

use super::drawing::{DrawPlan, PlannedDraw};
use super::surfaces::PipelineKey;
use crate::frame::RenderError;
use crate::geometry::faces::{FaceAttributes, LitAt, unshared_streams};
use crate::geometry::order::{DistantTriangle, back_to_front};
use crate::geometry::tangents::with_tangents;
use crate::geometry::vertex_data::{MeshStreams, StreamData, VertexStream};
use crate::materials::{Materials, TextureKey};
use crate::options::{RenderOptions, Shading};
use crate::scene_view::SceneView;
use crate::surface_pipelines::{FrameStyle, StreamPipeline};
use estampe::{BufferError, BufferSlice, Device, Texture, TextureError};
use estampe_scene::{Mesh, Scene, Workers};
use std::collections::HashMap;

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
    pub(crate) fn plan(&self) -> Result<DrawPlan, RenderError> {
        let mut materials = Materials::new(self.scene, self.options, self.view, self.device);
        let with_tangents = self.make_tangents_and_textures(&mut materials)?;
        let mut builder = DrawPlanBuilder::default();
        for (mesh, made) in self.scene.meshes.iter().zip(&with_tangents) {
            self.plan_mesh(made.as_ref().unwrap_or(mesh), &mut materials, &mut builder)?;
        }
        builder.plan.opaque.append(&mut builder.smooth_lines);
        self.plan_overlays(&mut builder)?;
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
        let tangents = self.scene.meshes.iter().map(Job::Tangents);
        let textures = materials.missing_textures(self.workers);
        let jobs = tangents.chain(textures.into_iter().map(Job::Texture));
        let made = self.workers.map(jobs, |job| match job {
            Job::Tangents(mesh) => {
                let uv_set = self.normal_map_uv_set(mesh);
                Made::Tangents(uv_set.and_then(|uv_set| with_tangents(mesh, uv_set)))
            }
            Job::Texture(key) => Made::Texture(key, materials.create(key)),
        });
        let mut meshes = Vec::with_capacity(self.scene.meshes.len());
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
        mesh: &Mesh,
        materials: &mut Materials<'_>,
        builder: &mut DrawPlanBuilder,
    ) -> Result<(), RenderError> {
        let is_unshared = self.style.needs_unshared_vertices() || mesh.normals.is_empty();
        let has_points_or_lines = !mesh.lines.is_empty() || !mesh.points.is_empty();
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
            self.plan_triangles(mesh, streams, is_unshared, materials, builder)?;
        }
        builder.first_number += mesh.triangles.len();
        if let Some(shared) = &shared {
            self.plan_points_and_lines(mesh, shared, builder)?;
        }
        Ok(())
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
