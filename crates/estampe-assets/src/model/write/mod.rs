//! Writers of models: OBJ, ASCII STL and ASCII PLY.
//!
//! The same meshes always give the same bytes. Numbers are the shortest that are read back as the
//! same f32. Coordinates are written as they are, whichever axis is up; materials, images and
//! vertex colours are not written.

mod number;
mod obj;
mod ply;
mod stl;

use super::ModelFormat;
use crate::AssetError;
use estampe_scene::{Mesh, Scene};

/// The meshes of a scene as the bytes of a file.
///
/// | | OBJ | STL | PLY |
/// |---|---|---|---|
/// | positions | each once | for each corner | one per vertex |
/// | normals | each once | one per triangle, computed | if all meshes have them |
/// | texture coordinates | each once | | if all meshes have them |
/// | lines, points | polylines, points | an error | edges; points as vertices |
/// | several meshes | objects | solids | one after the other |
///
/// In OBJ, corners at the same position share it, so that a surface whose normals or texture
/// coordinates differ at a seam is closed.
///
/// # Errors
/// [`AssetError::Unsupported`] for formats that are only read, for lines or points in STL, and for
/// positions that are not finite.
pub fn encode_model(scene: &Scene, format: ModelFormat) -> Result<Vec<u8>, AssetError> {
    for mesh in &scene.meshes {
        check_finite(mesh)?;
    }
    let text = match format {
        ModelFormat::Gltf | ModelFormat::Off | ModelFormat::ThreeMf => {
            return Err(AssetError::unsupported(
                format!("{} is read, not written", format.name()),
                "write OBJ, STL or PLY",
            ));
        }
        ModelFormat::Obj => obj::write(&scene.meshes),
        ModelFormat::Stl => stl::write(&scene.meshes)?,
        ModelFormat::Ply => ply::write(&scene.meshes),
    };
    Ok(text.into_bytes())
}

fn check_finite(mesh: &Mesh) -> Result<(), AssetError> {
    let Some(bad) = mesh.positions.iter().position(|p| !p.is_finite()) else {
        return Ok(());
    };
    let what = format!("the position of vertex {bad} is not finite");
    Err(AssetError::unsupported(
        what,
        "no model format holds infinity or NaN; remove the vertex",
    ))
}

/// The name of a mesh as one word, which no format takes for something else.
fn word(name: &str) -> String {
    let clean = |c: char| {
        if c.is_whitespace() || c.is_control() {
            '_'
        } else {
            c
        }
    };
    name.chars().map(clean).collect()
}
