//! The pipelines of surfaces that cast shadows.

use crate::geometry::vertex_data::{MeshStreams, VertexStream};
use crate::ground::ColumnMaps;
use crate::material_programs::MaterialProgram;
use crate::shading::pbr::textures::{MaterialTexture, UvChoice};
use crate::shading::shadow_caster::{Caster, CutOut, CutOutCaster};
use crate::surface_pipelines::{
    FrameStyle, PipelineState, StreamPipeline, SurfaceAlpha, SurfaceStyle,
};
use estampe::state::{DepthState, DepthStencilState, PrimitiveState};
use estampe::{Device, Mat4, PipelineError};

impl SurfaceStyle {
    /// Where the surface has holes, if it has any.
    fn cut_out(&self) -> Option<CutOut> {
        if self.alpha != SurfaceAlpha::Masked {
            return None;
        }
        Some(match &self.pbr {
            Some(parameters) => CutOut {
                factor: parameters.base[3],
                texture: parameters.base_texture.clone(),
                cutoff: parameters.alpha_cutoff,
            },
            None => CutOut {
                factor: self.base[3],
                texture: self.texture.clone().map(|texture| MaterialTexture {
                    texture,
                    coordinates: UvChoice::FIRST,
                }),
                cutoff: 0.5,
            },
        })
    }
}

impl FrameStyle {
    /// The slots that casters are drawn into.
    pub(crate) fn caster_slots(&self) -> impl Iterator<Item = usize> {
        let lights = self
            .shadows
            .as_ref()
            .map_or(0, |shadows| shadows.maps.len());
        let ground = self.columns.as_ref().map_or(0, |_| 2);
        (0..lights).chain(ColumnMaps::FIRST_SLOT..ColumnMaps::FIRST_SLOT + ground)
    }

    /// The clip space of a slot.
    pub(crate) fn clip_of_caster(&self, slot: usize) -> Mat4 {
        match (&self.shadows, &self.columns) {
            (_, Some(columns)) if slot >= ColumnMaps::FIRST_SLOT => columns.clip_from_unit(slot),
            (Some(shadows), _) => shadows.maps[slot].clip_from_unit,
            _ => Mat4::IDENTITY,
        }
    }

    /// The pipeline of a surface in a shadow map.
    pub(crate) fn caster(
        &self,
        device: &Device,
        surface: &SurfaceStyle,
        mesh: &MeshStreams,
        clip_from_unit: Mat4,
    ) -> Result<StreamPipeline, PipelineError> {
        use VertexStream::{Color, Position, Uv, Uv1};
        let material = match surface.cut_out() {
            Some(cut_out) => {
                let shader = CutOutCaster {
                    clip_from_unit,
                    cut_out,
                };
                MaterialProgram::new(shader, &[Position, Uv, Uv1, Color])
            }
            None => MaterialProgram::new(Caster { clip_from_unit }, &[Position]),
        };
        let mut depth_stencil = DepthStencilState::from(DepthState::LESS_WRITE);
        // For the rounding of depths; what the filter needs more is done at the lookup.
        (depth_stencil.bias.constant, depth_stencil.bias.slope_scale) = (8.0, 1.0);
        let state = PipelineState {
            // Both sides: meshes of scans and of clothes are not closed.
            primitive: PrimitiveState::default(),
            depth_stencil,
            targets: Vec::new(),
            samples: 1,
            shadows: None,
            behind: None,
        };
        self.pipeline(device, material, mesh, state)
    }
}
