//! What is seen at each pixel, as numbers: position, normal, distance, texture coordinates, and the
//! numbers of mesh and material.
//!
//! ```text
//! faces     the pipeline draws the number of the nearest triangle at each pixel's centre
//! hit       where the ray through the centre meets that triangle, in 64 bits
//! ```
//!
//! The pipeline says what is visible, with its rules for edges, depths, culling and cut-outs; the
//! numbers themselves need no target of floats, and are not rounded by one.

mod faces;
mod hit;

use crate::camera::Pinhole;
use crate::options::RenderOptions;
use crate::render_error::RenderError;
use estampe::Device;
use estampe_scene::{Camera, Scene, Workers};
use faces::Faces;
use glam::{Vec2, Vec3};
use hit::Hits;

/// The surfaces at the pixels of an image.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfacePoints {
    /// Pixels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The camera of the image, in world space.
    pub camera: Camera,
    /// The camera as a pinhole, in world space; `None` if the projection is parallel.
    pub pinhole: Option<Pinhole>,
    /// The surface at the centre of each pixel, row by row from the top; `None` is the background.
    pub points: Vec<Option<SurfacePoint>>,
}

/// The surface at a pixel's centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// In world space.
    pub position_world: Vec3,
    /// The unit normal that shading uses, in world space: interpolated from the vertices, or that
    /// of the triangle if they have none, and on the side that is seen. Bump and normal maps are
    /// not part of it.
    pub normal_world: Vec3,
    /// Distance from the eye along the view direction, in world units.
    pub distance: f32,
    /// The first texture coordinates; 0 if the mesh has none.
    pub uv: Vec2,
    /// The number of the mesh in the scene; that of a cut solid is its mesh's.
    pub mesh: usize,
    /// The number of the material in the scene, if the surface has one; cut solids have none.
    pub material: Option<usize>,
}

/// Finds the surface at the centre of each pixel.
///
/// The camera and culling are those of the options. Surfaces hide each other as in [`render`] with
/// one sample per pixel, except that transparent ones are as solid as opaque ones; cut-outs are
/// where the alpha of their base colour is below ½. Points, lines, the ground, fog and a caller's
/// program are left out.
///
/// [`render`]: crate::render
///
/// # Errors
/// [`RenderError`] as of [`render`], and for scenes of more triangles than can be told apart.
pub fn surface_points(
    scene: &Scene,
    options: &RenderOptions,
    device: &Device,
) -> Result<SurfacePoints, RenderError> {
    let workers = Workers::new(device.threads());
    let own = scene;
    let cut = options.cut(own, workers)?;
    let scene = cut.as_ref().map_or(own, |cut| &cut.scene);
    let faces = Faces::draw(scene, options, device)?;
    let hits = Hits::new(scene, &faces.view, (options.width, options.height));
    let rows = faces.numbers.chunks(options.width as usize).zip(0_u32..);
    let rows = workers.map(rows, |(numbers, y)| {
        let points = numbers.iter().zip(0_u32..);
        let points = points.map(|(number, x)| {
            let mut point = hits.at((*number)?, (x, y))?;
            if let (Some(cut), Some(cap)) = (&cut, point.mesh.checked_sub(own.meshes.len())) {
                point.mesh = cut.cap_of[cap];
                point.material = None;
            }
            Some(point)
        });
        points.collect::<Vec<_>>()
    });
    Ok(SurfacePoints {
        width: options.width,
        height: options.height,
        camera: faces.view.camera_world(),
        pinhole: faces.view.pinhole((options.width, options.height)),
        points: rows.concat(),
    })
}
