//! The picture of what is behind surfaces through which light passes: all opaque surfaces, lines
//! and points, and the ground, in linear light with mip levels, drawn before the frame's passes.
//!
//! ```text
//!   opaque draws ──► Rgba16Float, light × coverage ──► mip levels ──► surfaces' shaders look it up
//!                    (samples resolved)                               (shading::pbr::transmission)
//! ```
//!
//! Other surfaces through which light passes, and blended ones, are not in it. The picture has the
//! size and the samples of the frame. The background is no part of it: its colour is as it is
//! shown, not light, and it may be transparent. Where the picture is not covered, shaders add the
//! background after the tone map.

use crate::draw_plan::DrawPlan;
use crate::ground::GroundShadow;
use crate::options::{RenderOptions, Shading};
use crate::render_error::RenderError;
use crate::scene_view::SceneView;
use crate::shading::pbr::transmission::{Background, BehindView};
use estampe::{
    AddressMode, BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry,
    BindingResource, BindingType, ColorAttachment, DepthStencilAttachment, Device, RenderPass,
    SamplerDescriptor, Statistics, Texture, TextureDescriptor, TextureFormat,
    TextureViewDescriptor,
};
use estampe_scene::{AlphaMode, Material, PbrMaterial, Scene};

/// The format of the picture.
pub(crate) const LIGHT: TextureFormat = TextureFormat::Rgba16Float;

/// True if light passes through a material.
pub(crate) fn is_transmissive(pbr: &PbrMaterial) -> bool {
    let share = pbr.transmission.map_or(0.0, |layer| layer.factor);
    share > 0.0 && pbr.metallic < 1.0 && !pbr.is_unlit
}

/// Use of a material's alpha, and its opacity, where transmission is drawn as such.
pub(crate) fn alpha_of(material: &Material) -> (AlphaMode, f32) {
    match &material.pbr {
        Some(pbr) if is_transmissive(pbr) => match pbr.alpha_mode {
            Some(mode) => (mode, pbr.base_color.w),
            None => (material.alpha_mode, material.opacity),
        },
        _ => (material.alpha_mode, material.opacity),
    }
}

/// The picture as the shaders of a frame look it up; `None` if no surface needs it.
pub(crate) fn view_of(
    scene: &Scene,
    view: &SceneView,
    options: &RenderOptions,
    background: Background,
) -> Option<BehindView> {
    let is_drawn = options.shading == Shading::Pbr && options.program.is_none();
    if !is_drawn || options.texture.is_some() || options.color.is_some() {
        return None;
    }
    let mut surfaces = scene.meshes.iter().flat_map(|mesh| &mesh.surfaces);
    let has_any = surfaces.any(|surface| {
        let material = surface.material.and_then(|at| scene.materials.get(at));
        let pbr = material.and_then(|material| material.pbr.as_ref());
        pbr.is_some_and(|pbr| is_transmissive(pbr))
    });
    let longer = options.width.max(options.height).min(1 << 16);
    let longer = u16::try_from(longer).unwrap_or(u16::MAX);
    has_any.then(|| BehindView {
        clip_from_view: view.clip_from_view(),
        last_level: libm::log2f(f32::from(longer)),
        background,
    })
}

/// The picture, and the bind group by which shaders read it.
#[derive(Debug, Clone)]
pub(crate) struct BehindPicture {
    /// The samples, if there are several per pixel.
    samples: Option<Texture>,
    image: Texture,
    depth: Texture,
    /// Of the group without shadow maps, which comes before.
    pub(crate) empty: (BindGroupLayout, BindGroup),
    pub(crate) layout: BindGroupLayout,
    pub(crate) group: BindGroup,
}

impl BehindPicture {
    pub(crate) fn new(device: &Device, options: &RenderOptions) -> Result<Self, RenderError> {
        let bindings = |error: &dyn std::fmt::Display| RenderError::Bindings(error.to_string());
        let once = TextureDescriptor::new_2d(options.width, options.height, LIGHT);
        let samples = TextureDescriptor {
            sample_count: options.samples,
            ..once.clone()
        };
        let depth = TextureDescriptor {
            format: TextureFormat::Depth32Float,
            ..samples.clone()
        };
        let image = device.create_texture(&once.with_all_levels())?;
        let sampler = device.create_sampler(&SamplerDescriptor {
            address_mode_u: AddressMode::ClampToEdge,
            address_mode_v: AddressMode::ClampToEdge,
            ..SamplerDescriptor::trilinear_repeat()
        })?;
        let make = |entries: &[BindGroupLayoutEntry], bound: &[(u32, BindingResource)]| {
            let layout = device.create_bind_group_layout(entries);
            let layout = layout.map_err(|error| bindings(&error))?;
            let group = device.create_bind_group(&BindGroupDescriptor {
                label: None,
                layout: &layout,
                entries: bound,
            });
            let group = group.map_err(|error| bindings(&error))?;
            Ok::<_, RenderError>((layout, group))
        };
        let picture = BindingResource::SampledTexture(image.view(), sampler);
        let entry = BindGroupLayoutEntry {
            binding: 0,
            ty: BindingType::sampled_2d(),
        };
        let (layout, group) = make(&[entry], &[(0, picture)])?;
        Ok(Self {
            samples: if options.samples > 1 {
                Some(device.create_texture(&samples)?)
            } else {
                None
            },
            image,
            depth: device.create_texture(&depth)?,
            empty: make(&[], &[])?,
            layout,
            group,
        })
    }

    /// Draws the picture and its mip levels.
    pub(crate) fn draw(
        &self,
        device: &Device,
        plan: &DrawPlan,
        ground: Option<&GroundShadow>,
    ) -> Result<Statistics, RenderError> {
        let base = self.image.create_view(&TextureViewDescriptor {
            mip_level_count: Some(1),
            ..TextureViewDescriptor::default()
        })?;
        let color = match &self.samples {
            Some(samples) => ColorAttachment {
                resolve_target: Some(base),
                ..ColorAttachment::clear(&samples.view(), [0.0; 4])
            },
            None => ColorAttachment::clear(&base, [0.0; 4]),
        };
        let mut draws = plan.behind();
        draws.extend(ground.and_then(GroundShadow::draw_behind));
        let statistics = device.render(&RenderPass {
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(DepthStencilAttachment::clear(&self.depth.view(), 1.0)),
            draws: &draws,
            ..RenderPass::default()
        })?;
        device.generate_mips(&self.image)?;
        Ok(statistics)
    }
}
