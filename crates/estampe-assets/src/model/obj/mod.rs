//! Wavefront OBJ.
//!
//! ```text
//! text  -> windows   (parts of it, one after the other; plain lines are read ahead)
//!       -> reader    (statements; vertices, texture coordinates, normals in file order)
//!       -> elements  (faces, lines, points: indices resolved, polygons split into triangles)
//!       -> parts     (object, group and material of each run of triangles)
//!       -> assemble  (one mesh per object; vertices split by texture coordinate and normal)
//! ```
//!
//! A mesh is an object (`o`); in files without objects, a group (`g`). Inside a mesh, the triangles
//! are sorted by material, so that each material is one surface even if `usemtl` alternates.
//!
//! In large files, several threads read plain lines ahead, see `plain`. The text may be a stream,
//! of which few windows are in memory at a time.
//!
//! Tolerance: a face that refers to a missing vertex is omitted, and a missing texture coordinate
//! or normal is ignored, each with a warning that names the line. Indices may refer to later
//! vertices, though the format's description does not allow it.
//!
//! Source: "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual, Wavefront 1995.

mod assemble;
mod elements;
mod parts;
mod plain;
mod reader;
mod windows;

#[cfg(test)]
mod tests;

use super::load::{Context, Parsed};
use crate::AssetError;
pub(super) use windows::Text;

/// Reads an OBJ file and its material libraries.
pub(super) fn parse(text: Text<'_>, context: &mut Context<'_>) -> Result<Parsed, AssetError> {
    let contents = reader::read(text, context)?;
    Ok(assemble::assemble(contents, context))
}
