//! The pipelines and buffers of a frame's draws.

use crate::shading::shadow::MAX_SHADOW_MAPS;
use crate::surface_pipelines::StreamPipeline;
use estampe::{BufferSlice, Draw, IndexFormat};
use std::ops::Range;

/// The draws of a frame, with their pipelines.
#[derive(Debug, Default)]
pub(crate) struct DrawPlan {
    pub(super) pipelines: Vec<StreamPipeline>,
    pub(super) opaque: Vec<PlannedDraw>,
    /// What is seen through surfaces that transmit light.
    pub(super) behind: Vec<PlannedDraw>,
    /// Transparent triangles back to front, or, of weighted transparency, surfaces.
    pub(super) transparent: Vec<PlannedDraw>,
    pub(super) layers: PlannedLayers,
    /// Lines around the model.
    pub(super) guides: Vec<PlannedDraw>,
    pub(super) edges: Vec<PlannedDraw>,
    /// What casts shadows, for each map: those of lights, then the two of the ground.
    pub(super) casters: [Vec<PlannedDraw>; MAX_SHADOW_MAPS + 2],
}

/// The draws of exact transparency: surfaces in the order of the scene.
#[derive(Debug, Default)]
pub(super) struct PlannedLayers {
    pub(super) finding: Vec<PlannedDraw>,
    pub(super) blending: Vec<PlannedDraw>,
}

/// A draw that owns its buffers.
#[derive(Debug)]
pub(super) struct PlannedDraw {
    /// The index of the pipeline.
    pub(super) pipeline: usize,
    pub(super) vertex_buffers: Vec<BufferSlice>,
    pub(super) indices: Option<BufferSlice>,
    pub(super) elements: Range<u32>,
}

impl DrawPlan {
    /// Opaque surfaces, lines and points in scene order.
    pub(crate) fn opaque(&self) -> Vec<Draw<'_>> {
        self.draws(&self.opaque)
    }

    /// Opaque surfaces, lines and points in the picture of what is behind others.
    pub(crate) fn behind(&self) -> Vec<Draw<'_>> {
        self.draws(&self.behind)
    }

    /// Transparent triangles back to front, or surfaces whose weighted terms are summed.
    pub(crate) fn transparent(&self) -> Vec<Draw<'_>> {
        self.draws(&self.transparent)
    }

    /// The draws that find layers of transparent surfaces.
    pub(crate) fn finding(&self) -> Vec<Draw<'_>> {
        self.draws(&self.layers.finding)
    }

    /// The draws that blend a layer: those of [`Self::finding`] in the same order.
    pub(crate) fn layer(&self) -> Vec<Draw<'_>> {
        self.draws(&self.layers.blending)
    }

    /// The lines around the model, behind transparent surfaces.
    pub(crate) fn guides(&self) -> Vec<Draw<'_>> {
        self.draws(&self.guides)
    }

    /// The edges over all surfaces.
    pub(crate) fn edges(&self) -> Vec<Draw<'_>> {
        self.draws(&self.edges)
    }

    /// What casts shadows in a map.
    pub(crate) fn casters(&self, map: usize) -> Vec<Draw<'_>> {
        self.draws(&self.casters[map])
    }

    /// Adds a pipeline, and returns its index.
    pub(super) fn add_pipeline(&mut self, pipeline: StreamPipeline) -> usize {
        self.pipelines.push(pipeline);
        self.pipelines.len() - 1
    }

    fn draws<'a>(&'a self, planned: &'a [PlannedDraw]) -> Vec<Draw<'a>> {
        let draw = |planned: &'a PlannedDraw| Draw {
            vertex_buffers: &planned.vertex_buffers,
            bind_groups: &self.pipelines[planned.pipeline].bind_groups,
            index_buffer: planned
                .indices
                .as_ref()
                .map(|buffer| (buffer, IndexFormat::Uint32)),
            ..Draw::new(
                &self.pipelines[planned.pipeline].pipeline,
                planned.elements.clone(),
            )
        };
        planned.iter().map(draw).collect()
    }
}
