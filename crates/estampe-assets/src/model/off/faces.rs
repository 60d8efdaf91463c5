//! Faces, and the lines and points among them.

use super::header::{Header, natural};
use super::vertices::{rest_of_line, words_left};
use super::{StoredColor, linear_colors, stored_color};
use crate::model::corner_split;
use crate::model::load::Context;
use crate::model::polygons::{Polygons, SPENT};
use crate::model::statements::Statements;
use crate::{AssetError, Limits};
use estampe_scene::Mesh;
use glam::Vec3;

/// The most numbers of a colour.
const MOST_COLOR_NUMBERS: usize = 4;

/// The faces that were read.
#[derive(Debug, Default)]
struct Faces {
    /// Vertices of the current face.
    vertices: Vec<u32>,
    corners: Vec<Vec3>,
    polygons: Polygons,
    /// Colour of each triangle, or empty.
    colors: Vec<Option<StoredColor>>,
}

/// The reason why a face is not kept.
enum FaceFault {
    /// The file ends, or has a word that is no number.
    Ended,
    /// The face is wrong; the next one may be right.
    Wrong(&'static str),
}

/// Reads the faces into `mesh`. Those after a word that is no number are left out with a warning.
pub(super) fn read(
    statements: &mut Statements<'_>,
    header: &Header,
    mesh: &mut Mesh,
    context: &mut Context<'_>,
) -> Result<(), AssetError> {
    let mut faces = Faces::default();
    let mut line = Vec::new();
    for at in 0..header.faces {
        let first = mesh.triangles.len();
        let line_before = statements.line();
        statements.find_word();
        let starts_line = statements.line() > line_before;
        let read = faces.read_one(statements, mesh.positions.len(), context.limits);
        if matches!(read, Err(FaceFault::Ended)) {
            context
                .warnings
                .add(context.name, statements.location(), || {
                    format!(
                        "the file ends, or has a word that is no number, at face {at} of {}; \
                         the faces before are kept",
                        header.faces
                    )
                });
            break;
        }
        // A colour is the rest of the line, if the face is at the start of it.
        line.clear();
        let left = words_left(statements);
        if starts_line && left <= MOST_COLOR_NUMBERS {
            rest_of_line(statements, left, &mut line);
        }
        match read {
            Ok(()) => faces.keep(mesh, statements, context),
            Err(FaceFault::Ended) => break,
            Err(FaceFault::Wrong(what)) => {
                context
                    .warnings
                    .add(context.name, statements.location(), || {
                        format!("face {at} {what}; it is omitted")
                    });
            }
        }
        let count = (mesh.triangles.len() + mesh.lines.len() + mesh.points.len()) as u64;
        Limits::check("triangles", count, context.limits.max_triangles)?;
        let color = stored_color(&line);
        if color.is_some() || !faces.colors.is_empty() {
            faces.colors.resize(first, None);
            faces.colors.resize(mesh.triangles.len(), color);
        }
    }
    // Colours of vertices are finer than those of faces.
    if mesh.colors.is_empty() && !faces.colors.is_empty() {
        faces.colors.resize(mesh.triangles.len(), None);
        let corners = corner_split::Corners {
            uvs: Vec::new(),
            colors: linear_colors(&faces.colors),
        };
        corner_split::split(mesh, corners, &[], 0);
    }
    Ok(())
}

impl Faces {
    /// Reads the vertices of a face.
    fn read_one(
        &mut self,
        statements: &mut Statements<'_>,
        vertex_count: usize,
        limits: &Limits,
    ) -> Result<(), FaceFault> {
        self.vertices.clear();
        let mut next = || {
            let word = statements.next_keyword();
            word.and_then(natural).ok_or(FaceFault::Ended)
        };
        let count = next()?;
        let mut read = match count {
            0 => Err(FaceFault::Wrong("has no vertices")),
            count if count > limits.max_polygon_corners => {
                Err(FaceFault::Wrong("has more corners than the limit"))
            }
            _ => Ok(()),
        };
        for _ in 0..count {
            let vertex = u32::try_from(next()?).ok();
            match vertex.filter(|&vertex| (vertex as usize) < vertex_count) {
                Some(vertex) if read.is_ok() => self.vertices.push(vertex),
                Some(_) => {}
                None => read = Err(FaceFault::Wrong("refers to a vertex that does not exist")),
            }
        }
        read
    }

    /// Splits the current face into triangles.
    fn keep(&mut self, mesh: &mut Mesh, statements: &Statements<'_>, context: &mut Context<'_>) {
        match *self.vertices.as_slice() {
            [point] => mesh.points.push(point),
            [start, end] => mesh.lines.push([start, end]),
            [a, b, c] => mesh.triangles.push([a, b, c]),
            ref vertices => {
                let position = |&vertex: &u32| mesh.positions[vertex as usize];
                self.corners.clear();
                self.corners.extend(vertices.iter().map(position));
                let (triangles, is_spent) = self.polygons.split(&self.corners);
                if is_spent {
                    context
                        .warnings
                        .add(context.name, statements.location(), || SPENT.to_owned());
                }
                let vertex = |corner: u32| vertices[corner as usize];
                mesh.triangles
                    .extend(triangles.iter().map(|triangle| triangle.map(vertex)));
            }
        }
    }
}
