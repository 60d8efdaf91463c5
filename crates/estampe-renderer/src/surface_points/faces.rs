//! The numbers of visible triangles.

use crate::frame::with_passes;
use crate::geometry::face_colors::{MOST_FACES, face_number};
use crate::light::FrameOutput;
use crate::options::{Ground, RenderOptions, Shading};
use crate::render_error::RenderError;
use crate::scene_view::SceneView;
use crate::section::Section;
use estampe::Device;
use estampe_scene::Scene;
use std::borrow::Cow;

/// The triangles at the pixels' centres, and the view that they are seen in.
pub(super) struct Faces {
    /// Row by row from the top; triangles are counted through all meshes.
    pub(super) numbers: Vec<Option<usize>>,
    pub(super) view: SceneView,
}

impl Faces {
    pub(super) fn draw(
        scene: &Scene,
        options: &RenderOptions,
        device: &Device,
    ) -> Result<Self, RenderError> {
        let count = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        if count > MOST_FACES {
            return Err(RenderError::TooManyFaces { faces: count });
        }
        let options = RenderOptions {
            shading: Shading::FaceId,
            samples: 1,
            // Its alpha tells it from all faces.
            background: None,
            gradient: None,
            // The caller has cut the scene.
            section: Section::default(),
            levels: None,
            fog: None,
            shadows: false,
            ground: Ground::default(),
            program: None,
            ..options.clone().without_overlays()
        };
        let scene = without_points_and_lines(scene);
        let to = (device, FrameOutput::Display);
        with_passes(scene, &options, to, &|_| {}, |passes, view| {
            passes.draw(device)?;
            let rgba = device.read_texture(&passes.attachments.image)?;
            let number = |&[r, g, b, alpha]: &[u8; 4]| (alpha != 0).then(|| face_number([r, g, b]));
            Ok(Self {
                numbers: rgba.as_chunks().0.iter().map(number).collect(),
                view: view.clone(),
            })
        })
    }
}

/// The scene without what has no face number.
fn without_points_and_lines(scene: &Scene) -> Cow<'_, Scene> {
    let has_some = |mesh: &estampe_scene::Mesh| !(mesh.lines.is_empty() && mesh.points.is_empty());
    if !scene.meshes.iter().any(has_some) {
        return Cow::Borrowed(scene);
    }
    let mut scene = scene.clone();
    for mesh in &mut scene.meshes {
        mesh.lines.clear();
        mesh.points.clear();
    }
    Cow::Owned(scene)
}
