//! STL, binary and ASCII.
//!
//! A file is a triangle soup: three positions per triangle, nothing shared. Positions equal to the
//! bit are joined, so that normals can be smooth. The file's own normals are not used: they follow
//! from the corners, and in many files they are zero or wrong.
//!
//! Binary: 80 bytes of any text, the number of triangles (u32, little-endian), then 50 bytes each:
//!
//! ```text
//! 0        12       24       36       48    50
//! | normal | corner | corner | corner | u16 |      f32 little-endian
//! ```
//!
//! The last two bytes are "attributes". Two programs store colours there, in opposite order:
//!
//! | bits         | 15                   | 14–10 | 9–5   | 4–0  |
//! |--------------|----------------------|-------|-------|------|
//! | VisCAM       | 1: has a colour      | red   | green | blue |
//! | Magics       | 0: has a colour      | blue  | green | red  |
//!
//! Magics marks its files by `COLOR=` and the default colour (RGBA bytes) in the first 80 bytes.
//!
//! Many binary files start with `solid`, as ASCII ones do. A file is binary if its length fits its
//! number of triangles, else ASCII if it starts with `solid` or `facet`, else a damaged binary.
//!
//! Source: M. Burns, "Automated Fabrication", 1993, §6.5; Wikipedia, "STL (file format)", for
//! colours.

mod ascii;
mod binary;

use super::detect::binary_stl_length;
use super::load::{Context, Parsed};
use super::weld;
use crate::AssetError;
use estampe_scene::{Mesh, Scene, UpAxis, Workers};
use glam::Vec3;

/// Reads an STL file.
pub(super) fn parse(bytes: &[u8], context: &mut Context<'_>) -> Result<Parsed, AssetError> {
    let is_whole_binary = binary_stl_length(bytes) == Some(bytes.len() as u64);
    let meshes = if !is_whole_binary && starts_as_ascii(bytes) {
        ascii::read(bytes, context)?
    } else {
        vec![binary::read(bytes, context)?]
    };
    // The corners of a mesh were joined by position and, if it has colours, by those.
    let has_distinct_positions = matches!(&meshes[..], [mesh] if mesh.colors.is_empty());
    let scene = Scene {
        meshes,
        up: UpAxis::Z,
        ..Scene::default()
    };
    Ok(Parsed {
        scene,
        has_distinct_positions,
        ..Parsed::default()
    })
}

/// True if the first word is that of an ASCII file, and no byte 0 follows soon: text has none.
fn starts_as_ascii(bytes: &[u8]) -> bool {
    let text = bytes
        .strip_prefix(b"\xef\xbb\xbf")
        .unwrap_or(bytes)
        .trim_ascii_start();
    let starts_with = |word: &[u8]| {
        text.get(..word.len())
            .is_some_and(|head| head.eq_ignore_ascii_case(word))
    };
    let head = &bytes[..bytes.len().min(512)];
    (starts_with(b"solid") || starts_with(b"facet")) && !head.contains(&0)
}

/// Joins equal corners of a triangle soup; corners with different tags stay separate.
///
/// `corner` returns the position and the tag of one of `3 * triangle_count` corners. Vertices are
/// in the order of their first appearance; the second result is the tag of each.
fn joined(
    name: String,
    triangle_count: usize,
    corner: impl Fn(usize) -> (Vec3, u16) + Sync,
    workers: Workers,
) -> (Mesh, Vec<u16>) {
    let corner_count = triangle_count * 3;
    let key = |index: usize| {
        let (position, tag) = corner(index);
        weld::key(position, u32::from(tag))
    };
    // In a closed mesh six triangles meet at a vertex.
    let mut vertices = weld::first_equals(corner_count, corner_count / 6, key, workers);
    let mut mesh = Mesh {
        name,
        ..Mesh::default()
    };
    let is_first = |&(index, &first): &(usize, &u32)| first as usize == index;
    let vertex_count = vertices.iter().enumerate().filter(is_first).count();
    mesh.positions.reserve_exact(vertex_count);
    let mut tags = Vec::with_capacity(vertex_count);
    for index in 0..corner_count {
        let first = vertices[index] as usize;
        vertices[index] = if first == index {
            let (position, tag) = corner(index);
            mesh.positions.push(position);
            tags.push(tag);
            u32::try_from(tags.len() - 1).expect("limits keep corners below 2^32")
        } else {
            // An earlier corner already has the vertex's number.
            vertices[first]
        };
    }
    mesh.triangles = vertices.as_chunks::<3>().0.to_vec();
    (mesh, tags)
}
