//! ASCII STL.
//!
//! ```text
//! solid [name]
//!   facet normal x y z
//!     outer loop
//!       vertex x y z        (three of them; more make a polygon)
//!     endloop
//!   endfacet
//! endsolid [name]
//! ```
//!
//! Keywords may be in upper case, lines may be joined, `endsolid` may be missing (at the
//! end of the file with a warning); several solids
//! are several meshes.

use super::joined;
use crate::model::load::Context;
use crate::model::polygons::{Polygons, SPENT};
use crate::model::statements::Statements;
use crate::model::textures::text_of_name;
use crate::{AssetError, Limits};
use estampe_scene::Mesh;
use glam::Vec3;

struct Reader<'a, 'c, 'r> {
    statements: Statements<'a>,
    context: &'c mut Context<'r>,
    done: Vec<Mesh>,
    current: Option<Solid>,
    /// Corners of the open facet.
    corners: Vec<Vec3>,
    polygons: Polygons,
    triangle_count: u64,
    /// A `solid` was read, and no `endsolid` after it.
    is_open: bool,
}

/// The open solid.
struct Solid {
    name: String,
    triangles: Vec<[Vec3; 3]>,
}

impl Solid {
    fn new(name: String) -> Self {
        Self {
            name,
            triangles: Vec::new(),
        }
    }
}

/// Reads all solids.
pub(super) fn read(bytes: &[u8], context: &mut Context<'_>) -> Result<Vec<Mesh>, AssetError> {
    let mut reader = Reader {
        statements: Statements::new(bytes),
        context,
        done: Vec::new(),
        current: None,
        corners: Vec::new(),
        polygons: Polygons::default(),
        triangle_count: 0,
        is_open: false,
    };
    while let Some(word) = reader.statements.next_keyword() {
        reader.read_word(word)?;
    }
    if !reader.corners.is_empty() {
        reader.warn("the file ends within a facet; its vertices so far are kept");
        reader.end_facet()?;
    }
    if reader.is_open {
        reader.warn("the file ends before `endsolid`; it may be cut off");
    }
    reader.end_solid();
    Ok(reader.done)
}

impl<'a> Reader<'a, '_, '_> {
    #[inline]
    fn read_word(&mut self, word: &'a [u8]) -> Result<(), AssetError> {
        if word == b"vertex" {
            return self.read_vertex();
        }
        match word.to_ascii_lowercase().as_slice() {
            b"vertex" => self.read_vertex()?,
            b"outer" | b"loop" => {}
            b"facet" => {
                self.end_facet()?;
                if self.statements.remaining_starts_with(b"normal")
                    || self.statements.remaining_starts_with(b"NORMAL")
                    || self.statements.remaining_starts_with(b"Normal")
                {
                    self.statements.word();
                    for _ in 0..3 {
                        self.statements.number();
                    }
                }
            }
            b"endloop" | b"endfacet" => self.end_facet()?,
            b"end" => {
                self.statements.word();
                self.end_facet()?;
            }
            b"solid" => {
                self.end_facet()?;
                self.end_solid();
                let name = text_of_name(self.statements.rest());
                self.current = Some(Solid::new(name));
                self.is_open = true;
            }
            b"endsolid" => {
                self.end_facet()?;
                self.end_solid();
                self.is_open = false;
                self.statements.skip_statement();
            }
            _ => {
                let shown = String::from_utf8_lossy(&word[..word.len().min(32)]).into_owned();
                let location = self.statements.location();
                self.context.warnings.add(self.context.name, location, || {
                    format!("`{shown}` is not an STL keyword; the rest of its line is skipped")
                });
                self.statements.skip_statement();
            }
        }
        Ok(())
    }

    #[inline]
    fn read_vertex(&mut self) -> Result<(), AssetError> {
        let mut position = [f32::NAN; 3];
        for slot in &mut position {
            if let Some(Some(number)) = self.statements.number() {
                *slot = number;
            }
        }
        let position = Vec3::from_array(position);
        if !position.is_finite() {
            self.warn("the vertex does not have three finite coordinates; its facet is omitted");
        }
        let limit = self.context.limits.max_polygon_corners;
        Limits::check("corners of one facet", self.corners.len() as u64 + 1, limit)
            .map_err(|error| error.at(self.statements.location()))?;
        self.corners.push(position);
        Ok(())
    }

    fn end_facet(&mut self) -> Result<(), AssetError> {
        match *self.corners.as_slice() {
            [] => return Ok(()),
            [_] | [_, _] => self.warn("the facet has fewer than three vertices; it is omitted"),
            [a, b, c] => {
                self.triangle_count += 1;
                self.current
                    .get_or_insert_with(|| Solid::new(String::new()))
                    .triangles
                    .push([a, b, c]);
            }
            _ => {
                let (triangles, is_spent) = self.polygons.split(&self.corners);
                self.triangle_count += triangles.len() as u64;
                let solid = self
                    .current
                    .get_or_insert_with(|| Solid::new(String::new()));
                for triangle in triangles {
                    let corners = triangle.map(|corner| self.corners[corner as usize]);
                    solid.triangles.push(corners);
                }
                if is_spent {
                    self.warn(SPENT);
                }
            }
        }
        self.corners.clear();
        Limits::check(
            "triangles",
            self.triangle_count,
            self.context.limits.max_triangles,
        )
        .map_err(|error| error.at(self.statements.location()))
    }

    /// Keeps the open solid. Beyond the limit of meshes its triangles are joined to the last one.
    fn end_solid(&mut self) {
        let Some(solid) = self.current.take() else {
            return;
        };
        let corners = solid.triangles.as_flattened();
        let corner = |index: usize| (corners[index], 0);
        let count = solid.triangles.len();
        let (mut mesh, _) = joined(solid.name, count, corner, self.context.workers);
        if (self.done.len() as u64) < self.context.limits.max_meshes.max(1) {
            self.done.push(mesh);
        } else if let Some(last) = self.done.last_mut() {
            let first = u32::try_from(last.positions.len()).unwrap_or(u32::MAX);
            last.positions.append(&mut mesh.positions);
            let shifted = mesh
                .triangles
                .iter()
                .map(|triangle| triangle.map(|at| first + at));
            last.triangles.extend(shifted);
        }
    }

    #[cold]
    fn warn(&mut self, message: &str) {
        let location = self.statements.location();
        self.context
            .warnings
            .add(self.context.name, location, || message.to_owned());
    }
}
