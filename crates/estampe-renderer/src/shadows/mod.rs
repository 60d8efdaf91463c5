//! Shadow maps of a frame: which lights have one, what they show, and the passes that draw them.
//!
//! ```text
//!   lights ── fit ──► ShadowMapView ──► surfaces' shaders look it up   (shading::shadow)
//!                          │
//!                          └──► ShadowMaps: a texture for each ◄── depths of the opaque surfaces
//! ```

mod caster;
mod fit;

pub(crate) use fit::ShadowSource;

use crate::draw_plan::DrawPlan;
use crate::options::{RenderOptions, Shading};
use crate::render_error::RenderError;
use crate::scene_view::SceneView;
use crate::shading::shadow::{MAX_SHADOW_MAPS, ShadowMapView};
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry, BindingResource,
    BindingType, DepthStencilAttachment, Device, RenderPass, Statistics, TextureDescriptor,
    TextureFormat, TextureView,
};
use glam::{DMat4, DVec3};

/// The side of a map in texels.
const SIDE: u32 = 1024;
/// That of pictures with a side of more than [`SIDE`] pixels.
const LARGE_SIDE: u32 = 2048;

impl RenderOptions {
    /// True if lights cast shadows: surfaces must be lit at their fragments.
    pub(crate) fn casts_shadows(&self) -> bool {
        let is_lit = matches!(self.shading, Shading::Pbr | Shading::Phong | Shading::Toon);
        self.shadows && is_lit && self.program.is_none()
    }
}

/// Chooses the lights that have maps.
pub(crate) struct MapChoice {
    /// The corners of the model's box, in view space.
    corners: [DVec3; 8],
    view_from_unit: DMat4,
    side: u32,
    maps: Vec<ShadowMapView>,
}

impl MapChoice {
    pub(crate) fn new(view: &SceneView, options: &RenderOptions) -> Self {
        let view_from_unit = view.camera.frame.view_from_world();
        let corners = view.space.corners();
        Self {
            corners: corners.map(|corner| view_from_unit.transform_point3(corner)),
            view_from_unit,
            side: if options.width.max(options.height) > SIDE {
                LARGE_SIDE
            } else {
                SIDE
            },
            maps: Vec::new(),
        }
    }

    /// Gives a light a map, and returns the map's number; `None` if all are taken, or the light is
    /// in the middle of the model.
    pub(crate) fn add(&mut self, source: ShadowSource) -> Option<usize> {
        let number = self.maps.len();
        if number == MAX_SHADOW_MAPS {
            return None;
        }
        let map = fit::fitted(
            source,
            &self.corners,
            &self.view_from_unit,
            (number, self.side),
        )?;
        self.maps.push(map);
        Some(number)
    }

    /// The maps by number.
    pub(crate) fn into_maps(self) -> Vec<ShadowMapView> {
        self.maps
    }
}

/// The maps of a frame, and the bind group by which shaders read them.
#[derive(Debug, Clone)]
pub(crate) struct ShadowMaps {
    pub(crate) maps: Vec<ShadowMapView>,
    depths: Vec<TextureView>,
    pub(crate) layout: BindGroupLayout,
    pub(crate) group: BindGroup,
}

impl ShadowMaps {
    /// Textures for these maps; `None` if there are none.
    pub(crate) fn new(
        device: &Device,
        maps: &[ShadowMapView],
    ) -> Result<Option<Self>, RenderError> {
        if maps.is_empty() {
            return Ok(None);
        }
        let depths = maps.iter().map(|map| {
            let descriptor =
                TextureDescriptor::new_2d(map.side, map.side, TextureFormat::Depth32Float);
            Ok(device.create_texture(&descriptor)?.view())
        });
        let depths = depths.collect::<Result<Vec<TextureView>, RenderError>>()?;
        let entries = maps.iter().map(|map| BindGroupLayoutEntry {
            binding: map.binding,
            ty: BindingType::ShadowMap,
        });
        let entries: Vec<_> = entries.collect();
        let bindings = |error: &dyn std::fmt::Display| RenderError::Bindings(error.to_string());
        let layout = device
            .create_bind_group_layout(&entries)
            .map_err(|error| bindings(&error))?;
        let bound = maps.iter().zip(&depths);
        let bound = bound.map(|(map, view)| (map.binding, BindingResource::Texture(view.clone())));
        let group = device
            .create_bind_group(&BindGroupDescriptor {
                label: None,
                layout: &layout,
                entries: &bound.collect::<Vec<_>>(),
            })
            .map_err(|error| bindings(&error))?;
        Ok(Some(Self {
            maps: maps.to_vec(),
            depths,
            layout,
            group,
        }))
    }

    /// Draws the depths that the lights see.
    pub(crate) fn draw(&self, device: &Device, plan: &DrawPlan) -> Result<Statistics, RenderError> {
        let mut statistics = Statistics::default();
        for (number, depths) in self.depths.iter().enumerate() {
            statistics += device.render(&RenderPass {
                depth_stencil_attachment: Some(DepthStencilAttachment::clear(depths, 1.0)),
                draws: &plan.casters(number),
                ..RenderPass::default()
            })?;
        }
        Ok(statistics)
    }
}
