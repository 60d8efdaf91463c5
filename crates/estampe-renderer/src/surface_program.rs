//! A program of the caller's that draws all surfaces, in place of a [`Shading`](crate::Shading).

use crate::scene_view::SceneView;
use crate::shading::VertexTransforms;
use crate::shading::lighting::Lights;
use estampe::{BindGroup, Device, Mat4, Program};
use std::fmt::Debug;
use std::sync::Arc;

/// A program that draws all surfaces.
///
/// Its vertex shader reads these attributes, by location:
///
/// | location | attribute | missing |
/// |--:|---|---|
/// | 0 | position, three floats, in model space | |
/// | 1 | normal, three floats, in the file's space | of the face, if the mesh has none |
/// | 2 | texture coordinates, two floats | zeros |
/// | 3 | colour of the vertex, four floats, linear | white |
///
/// Model space has the model's box between −1 and 1, and Y up. Fragments write linear colours to
/// target 0, which are encoded as sRGB. All surfaces are opaque.
#[derive(Debug, Clone)]
pub struct SurfaceProgram {
    /// The program.
    pub program: Arc<dyn Program>,
    /// Makes the bind groups of each surface.
    pub bindings: Arc<dyn SurfaceBindings>,
}

/// Programs are equal if they are the same objects.
impl PartialEq for SurfaceProgram {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.program, &other.program) && Arc::ptr_eq(&self.bindings, &other.bindings)
    }
}

/// Makes the bind groups of a [`SurfaceProgram`].
pub trait SurfaceBindings: Debug + Send + Sync {
    /// The bind groups of a surface, by group number.
    ///
    /// # Errors
    /// A sentence that says why there are none.
    fn bind_groups(
        &self,
        device: &Device,
        values: &SurfaceValues,
    ) -> Result<Vec<BindGroup>, String>;
}

/// What a surface's program may want to know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceValues {
    /// From model space to clip space.
    pub clip_from_model: Mat4,
    /// From model space to view space, whose camera is at 0 and looks down −z.
    pub view_from_model: Mat4,
    /// From view space to clip space.
    pub clip_from_view: Mat4,
    /// From the normals of vertices to view space; a rotation.
    pub view_from_normal: Mat4,
    /// The unit direction towards the first light with a direction, in view space.
    pub light_view: [f32; 3],
    /// The position of the camera, in model space.
    pub eye_model: [f32; 3],
    /// The material's colour, linear RGBA.
    pub base_color: [f32; 4],
    /// Width and height of the picture in pixels.
    pub size_px: [u32; 2],
}

impl SurfaceValues {
    /// The values of a frame, for a white surface.
    pub(crate) fn new(
        view: &SceneView,
        transforms: &VertexTransforms,
        lights: &Lights,
        size_px: [u32; 2],
    ) -> Self {
        /// The direction if no light has one: that of the camera.
        const TOWARDS_EYE: [f32; 3] = [0.0, 0.0, 1.0];
        let light = lights.directional.first();
        Self {
            clip_from_model: transforms.clip_from_unit,
            view_from_model: transforms.view_from_unit,
            clip_from_view: view.clip_from_view(),
            view_from_normal: transforms.view_from_object_normal,
            light_view: light.map_or(TOWARDS_EYE, |light| light.source.0),
            eye_model: view.camera.frame.eye_world.as_vec3().to_array(),
            base_color: [1.0; 4],
            size_px,
        }
    }
}
