//! The style of a frame: what all of its draws have in common.

use crate::alpha::{Encoding, decode};
use crate::behind::{BehindPicture, view_of};
use crate::draw_plan::is_dark;
use crate::ground::{ColumnMaps, GroundFrame};
use crate::light::FrameOutput;
use crate::options::{RenderOptions, Shading};
use crate::render_error::RenderError;
use crate::scene_view::SceneView;
use crate::shading::VertexTransforms;
use crate::shading::backdrop::Backdrop;
use crate::shading::output;
use crate::shading::pbr::tone_map::ToneMap;
use crate::shading::pbr::transmission::Background;
use crate::shading::surface::DEPTH_ORDER;
use crate::shading::wireframe::Wireframe;
use crate::shadows::ShadowMaps;
use crate::surface_pipelines::FrameStyle;
use crate::surface_program::SurfaceValues;
use estampe::Device;
use estampe_scene::Scene;
use estampe_transparency::Finder;
use std::sync::Arc;

/// The style of a frame of a scene.
pub(crate) fn frame_style(
    scene: &Scene,
    view: &SceneView,
    options: &RenderOptions,
    (device, output): (&Device, FrameOutput),
) -> Result<FrameStyle, RenderError> {
    let transforms = view.transforms();
    let lights = view.lights(options);
    let size_px = [options.width, options.height];
    let program = options.program.clone().map(|program| {
        let values = SurfaceValues::new(view, &transforms, &lights, size_px);
        (program, values)
    });
    let pbr = if options.shading == Shading::Pbr {
        let mut lighting = view.pbr_lighting(scene, options, &lights, device)?;
        if output == FrameOutput::Light {
            lighting.tone_map = ToneMap::None;
        }
        let background = match (backdrop(options), options.background) {
            (Some(gradient), _) => Background::Gradient(gradient),
            (None, Some(_)) => {
                let [r, g, b, _] = clear_color(options);
                Background::Color([r, g, b])
            }
            (None, None) => Background::Transparent,
        };
        lighting.behind = view_of(scene, view, options, background);
        Some(Arc::new(lighting))
    } else {
        None
    };
    let maps = match &pbr {
        Some(lighting) => &lighting.shadow_maps,
        None => &lights.shadow_maps,
    };
    let is_seen_through = pbr.as_ref().is_some_and(|pbr| pbr.behind.is_some());
    Ok(FrameStyle {
        behind: if is_seen_through {
            Some(BehindPicture::new(device, options)?)
        } else {
            None
        },
        shadows: ShadowMaps::new(device, maps)?,
        columns: if options.has_ground() {
            Some(ColumnMaps::new(device, GroundFrame::new(view))?)
        } else {
            None
        },
        shading: options.shading,
        pbr,
        program,
        transforms,
        lights: Arc::new(lights),
        levels: options.levels,
        backdrop: backdrop(options),
        fog: options.fog.as_ref().map(|fog| {
            let gradient = options.gradient.filter(|gradient| {
                fog.color.is_none() && options.background.is_some() && gradient.is_opaque()
            });
            let color = fog.color.or(options.background);
            let color = color.unwrap_or(RenderOptions::DEFAULT_BACKGROUND);
            let linear = color.map(|code| decode(code, Encoding::Srgb));
            output::Fog {
                backdrop: gradient.and_then(|_| backdrop(options)),
                ..view.fog(fog, linear, (options.width, options.height))
            }
        }),
        presentation: view.presentation(options),
        wireframe: wireframe(transforms, options),
        overlay: has_overlay(options).then(|| overlay(transforms, options)),
        depth_range: view.depth_range(),
        cull: options.cull,
        samples: options.samples,
        format: output.format(encoding(options)),
        frame_output: output,
        finder: Finder::new(device, DEPTH_ORDER, options.samples)?,
    })
}

/// How the codes of the picture are encoded: as light, or as numbers.
pub(crate) fn encoding(options: &RenderOptions) -> Encoding {
    if options.shading.holds_numbers() {
        Encoding::Linear
    } else {
        Encoding::Srgb
    }
}

/// The background as the target's clear colour.
pub(crate) fn clear_color(options: &RenderOptions) -> [f32; 4] {
    match options.background {
        // Fragments are added to none.
        Some(_) if options.shading == Shading::Overdraw => [0.0, 0.0, 0.0, 1.0],
        Some(codes) => {
            let [r, g, b] = codes.map(|code| decode(code, encoding(options)));
            [r, g, b, 1.0]
        }
        None => [0.0; 4],
    }
}

/// The gradient of the options, if it is drawn.
fn backdrop(options: &RenderOptions) -> Option<Backdrop> {
    // Fragments are added to none.
    let gradient = options.gradient.as_ref();
    let gradient = gradient.filter(|_| options.shading != Shading::Overdraw)?;
    let size_px = [options.width, options.height];
    Some(Backdrop::new(gradient, size_px, encoding(options)))
}

/// Wireframe edges that contrast with the background, with a width in proportion to the image.
fn wireframe(transforms: VertexTransforms, options: &RenderOptions) -> Wireframe {
    let background = options
        .background
        .unwrap_or(RenderOptions::DEFAULT_BACKGROUND);
    let color = if is_dark(background) {
        [0xe4, 0xe8, 0xee]
    } else {
        [0x1e, 0x2a, 0x38]
    };
    let [r, g, b] = color.map(|code| decode(code, Encoding::Srgb));
    Wireframe {
        transforms,
        line: [r, g, b, 1.0],
        face: clear_color(options),
        backdrop: backdrop(options),
        half_width_px: half_width_px(options),
    }
}

/// True if edges are drawn over the surfaces.
fn has_overlay(options: &RenderOptions) -> bool {
    options.wireframe && options.shading != Shading::Wireframe
}

/// Edges over shaded surfaces: dark, and light over the dark colours of overdraw.
fn overlay(transforms: VertexTransforms, options: &RenderOptions) -> Wireframe {
    let color = match options.shading {
        Shading::Overdraw => [0xe4, 0xe8, 0xee],
        _ => [0x10, 0x18, 0x20],
    };
    let [r, g, b] = color.map(|code| decode(code, encoding(options)));
    Wireframe {
        transforms,
        line: [r, g, b, 0.85],
        face: [0.0; 4],
        backdrop: None,
        half_width_px: half_width_px(options),
    }
}

/// Half of the width of edges, in pixels: that of the options, or in proportion to the image.
pub(crate) fn half_width_px(options: &RenderOptions) -> f32 {
    if let Some(width) = options.line_width_px {
        return width / 2.0;
    }
    let shorter_px = options.width.min(options.height);
    let sixteenths = u16::try_from((shorter_px / 64).clamp(8, 64)).unwrap_or(64);
    f32::from(sixteenths) / 16.0
}
