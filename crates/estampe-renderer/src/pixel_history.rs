//! The history of a pixel of a frame (row U1) and what each stage made of it (row U2), with the
//! spaces that the renderer knows: object, world and eye space.

use crate::alpha::straighten;
use crate::frame::with_passes;
use crate::frame_passes::FramePasses;
use crate::frame_style::encoding;
use crate::light::FrameOutput;
use crate::options::{RenderOptions, Transparency};
use crate::render_error::RenderError;
use crate::scene_view::SceneView;
use estampe::{Device, PassStages, PixelHistory, StoreOp};
use estampe_scene::Scene;
use glam::{DVec3, Vec3};
use std::borrow::Cow;

/// The history of a pixel of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FramePixel {
    /// Everything that touched the pixel. The records of draws are in the order of the frame:
    /// opaque surfaces, lines and points in scene order, then transparent triangles back to front.
    pub history: PixelHistory,
    /// For each record of the history, the position of each vertex in the spaces before clip space.
    pub spaces: Vec<Vec<VertexSpaces>>,
    /// The pixel of the image that [`render`](crate::render) draws: RGBA, straight alpha.
    pub final_rgba8: [u8; 4],
}

/// The position of a vertex in the spaces before clip space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VertexSpaces {
    /// The model's own space.
    pub object: DVec3,
    /// The model as it stands: the up axis turned to Y.
    pub world: DVec3,
    /// The camera's space, in the world's unit: x to the right, y up, z towards the eye.
    pub eye: DVec3,
}

/// The history of a pixel, column and row from the top left, of the frame that
/// [`render`](crate::render) draws of a scene with these options.
///
/// # Errors
/// [`RenderError`] as of [`render`](crate::render), [`RenderError::Inspect`] if the pixel lies
/// outside of the image, and [`RenderError::InspectUnsorted`] if transparent surfaces are drawn in
/// several passes.
pub fn inspect(
    scene: &Scene,
    options: &RenderOptions,
    device: &Device,
    pixel: [u32; 2],
) -> Result<FramePixel, RenderError> {
    let to = (device, FrameOutput::Display);
    with_passes(
        Cow::Borrowed(scene),
        options,
        to,
        &|_| {},
        |passes, view| {
            check_one_pass(options, passes)?;
            let history =
                passes.with_one_pass(StoreOp::Store, |pass| Ok(device.inspect(pass, pixel)?))?;
            let texel = history.texels.first().and_then(Option::as_deref);
            let mut final_rgba8 = texel
                .and_then(|bytes| bytes.try_into().ok())
                .unwrap_or([0; 4]);
            if options.background.is_none() {
                straighten(&mut final_rgba8, encoding(options));
            }
            let records = history.primitives.iter();
            let spaces = records.map(|record| {
                let vertices = record.vertices.iter();
                let attributes = vertices.map(|vertex| vertex.attributes.first());
                let units = attributes.map(|attribute| match attribute.map(Vec::as_slice) {
                    Some(&[x, y, z]) => Vec3::new(x, y, z),
                    _ => Vec3::ZERO,
                });
                units.map(|unit| spaces_of(view, unit)).collect()
            });
            Ok(FramePixel {
                spaces: spaces.collect(),
                history,
                final_rgba8,
            })
        },
    )
}

/// What each stage made of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameStages {
    /// What the stages made of the frame's pass.
    pub stages: PassStages,
    /// For each vertex of the stages, its position in the spaces before clip space.
    pub spaces: Vec<VertexSpaces>,
}

/// What each stage made of the frame that [`render`](crate::render) draws of a scene with these
/// options.
///
/// # Errors
/// [`RenderError`] as of [`render`](crate::render), [`RenderError::Inspect`] if the pixels and
/// primitives need too much memory, and [`RenderError::InspectUnsorted`] if transparent surfaces
/// are drawn in several passes.
pub fn inspect_stages(
    scene: &Scene,
    options: &RenderOptions,
    device: &Device,
) -> Result<FrameStages, RenderError> {
    let to = (device, FrameOutput::Display);
    with_passes(
        Cow::Borrowed(scene),
        options,
        to,
        &|_| {},
        |passes, view| {
            check_one_pass(options, passes)?;
            let stages =
                passes.with_one_pass(StoreOp::Store, |pass| Ok(device.inspect_stages(pass)?))?;
            let vertices = stages.vertices.iter();
            let spaces = vertices.map(|vertex| {
                let [x, y, z, _] = vertex.attribute;
                spaces_of(view, Vec3::new(x, y, z))
            });
            Ok(FrameStages {
                spaces: spaces.collect(),
                stages,
            })
        },
    )
}

/// An error if the frame has several passes: only one can be inspected.
fn check_one_pass(options: &RenderOptions, passes: &FramePasses<'_>) -> Result<(), RenderError> {
    if options.transparency != Transparency::Sorted && passes.has_transparent_surfaces() {
        return Err(RenderError::InspectUnsorted);
    }
    Ok(())
}

/// The spaces of a vertex, from its first attribute: the position in unit space.
fn spaces_of(view: &SceneView, unit: Vec3) -> VertexSpaces {
    let unit = unit.as_dvec3();
    let space = &view.space;
    let world = space.world_from_unit(unit);
    let eye = view.camera.frame.view_from_world().transform_point3(unit);
    VertexSpaces {
        object: space.world_from_object.transpose() * world,
        world,
        eye: eye * space.world_per_unit(),
    }
}
