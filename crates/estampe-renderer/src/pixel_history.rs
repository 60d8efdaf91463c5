//! The history of a pixel of a frame (row U1), with the spaces that the renderer knows: object,
//! world and eye space.

use crate::alpha::straighten;
use crate::frame::{RenderError, encoding, with_pass};
use crate::options::RenderOptions;
use crate::scene_view::SceneView;
use estampe::{Device, InspectedVertex, PixelHistory};
use estampe_scene::Scene;
use glam::{DVec3, Vec3};

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
/// [`RenderError`] as of [`render`](crate::render), and [`RenderError::Inspect`] if the pixel lies
/// outside of the image.
pub fn inspect(
    scene: &Scene,
    options: &RenderOptions,
    device: &Device,
    pixel: [u32; 2],
) -> Result<FramePixel, RenderError> {
    with_pass(scene, options, device, |pass, view, _| {
        let history = device.inspect(pass, pixel)?;
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
            vertices.map(|vertex| spaces_of(view, vertex)).collect()
        });
        Ok(FramePixel {
            spaces: spaces.collect(),
            history,
            final_rgba8,
        })
    })
}

/// The spaces of a vertex, from its first attribute: the position in unit space.
fn spaces_of(view: &SceneView, vertex: &InspectedVertex) -> VertexSpaces {
    let unit = match vertex.attributes.first().map(Vec::as_slice) {
        Some(&[x, y, z]) => Vec3::new(x, y, z).as_dvec3(),
        _ => DVec3::ZERO,
    };
    let space = &view.space;
    let world = space.world_from_unit(unit);
    let eye = view.camera.frame.view_from_world().transform_point3(unit);
    VertexSpaces {
        object: space.world_from_object.transpose() * world,
        world,
        eye: eye * space.world_per_unit(),
    }
}
