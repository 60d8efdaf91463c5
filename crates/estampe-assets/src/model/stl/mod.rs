//! STL, binary and ASCII.
//!
//! A file is a soup of triangles: three positions each, nothing shared. Positions equal to the bit are
//! joined, so that normals can be smooth. The file's own normals are not used: they say nothing that
//! the corners do not, and in many files they are zero or wrong.
//!
//! Binary: 80 bytes of any text, the number of triangles (u32, little-endian), then 50 bytes each:
//!
//! ```text
//! 0        12       24       36       48    50
//! | normal | corner | corner | corner | u16 |      f32 little-endian
//! ```
//!
//! The last two bytes are "attributes". Two programs put colours there, in opposite order:
//!
//! | bits         | 15                   | 14–10 | 9–5   | 4–0  |
//! |--------------|----------------------|-------|-------|------|
//! | VisCAM       | 1: has a colour      | red   | green | blue |
//! | Magics       | 0: has a colour      | blue  | green | red  |
//!
//! Magics announces itself by `COLOR=` and the default colour (RGBA bytes) in the first 80 bytes.
//!
//! Many binary files start with `solid`, as ASCII ones do. A file is binary if its length fits its
//! number of triangles, else ASCII if it starts with `solid` or `facet`, else a damaged binary.
//!
//! Source: M. Burns, "Automated Fabrication", 1993, §6.5; Wikipedia, "STL (file format)", for colours.

mod ascii;
mod binary;

use super::detect::binary_stl_length;
use super::load::{Context, Parsed};
use super::weld::Welder;
use crate::AssetError;
use estampe_scene::{Mesh, Scene, UpAxis};
use glam::Vec3;

/// Reads an STL file.
pub(super) fn parse(bytes: &[u8], context: &mut Context<'_>) -> Result<Parsed, AssetError> {
    let is_whole_binary = binary_stl_length(bytes) == Some(bytes.len() as u64);
    let meshes = if !is_whole_binary && starts_as_ascii(bytes) {
        ascii::read(bytes, context)?
    } else {
        vec![binary::read(bytes, context)?]
    };
    let scene = Scene {
        meshes,
        up: UpAxis::Z,
        ..Scene::default()
    };
    Ok(Parsed {
        scene,
        ..Parsed::default()
    })
}

/// Whether the first word is that of an ASCII file, and no byte 0 follows soon: text has none.
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

/// Joins equal corners of a soup of triangles; corners with different tags stay apart.
struct Joined {
    welder: Welder,
    mesh: Mesh,
    /// The tag of each vertex.
    tags: Vec<u16>,
}

impl Joined {
    fn new(name: String) -> Self {
        let mesh = Mesh {
            name,
            ..Mesh::default()
        };
        Self {
            welder: Welder::default(),
            mesh,
            tags: Vec::new(),
        }
    }

    #[inline]
    fn push(&mut self, corners: [Vec3; 3], tag: u16) {
        let mut triangle = [0; 3];
        for (vertex, corner) in triangle.iter_mut().zip(corners) {
            *vertex = self.welder.number(corner, u32::from(tag));
            if *vertex as usize == self.mesh.positions.len() {
                self.mesh.positions.push(corner);
                self.tags.push(tag);
            }
        }
        self.mesh.triangles.push(triangle);
    }
}
