//! OFF, the Object File Format of Geomview, as text.
//!
//! ```text
//! [ST][C][N][4]OFF                  what a vertex has: texture coordinates, colour, normal, w
//! vertices faces edges              their numbers; that of the edges is not used
//! x y z [w] [nx ny nz] [r g b a] [s t]
//! n i1 … in [colour]                a face; the colour is the rest of the line
//! ```
//!
//! `#` starts a comment. The first line may be missing, or joined to the second one. Numbers may be
//! on any lines, but for colours: those of vertices may lack alpha, and those of faces may have one
//! to four numbers, so their number is that of the line. Colours with a number above 1 anywhere in
//! the file are of 0 to 255; they are sRGB-encoded. A single number is an index into a map that is
//! in no file, and has no effect.
//!
//! Faces of one and of two vertices are points and lines. A file without faces is a cloud of
//! points. Damage is treated as in PLY: a file that ends among its vertices is an error, one that
//! ends among its faces is a warning.
//!
//! Source: *Geomview Manual*, version 1.9, "OFF Files".

mod faces;
mod header;
mod vertices;

use super::load::{Context, Parsed};
use super::srgb::linear_from_srgb;
use super::statements::Statements;
use crate::{AssetError, Limits};
use estampe_scene::{Mesh, Scene, UpAxis};
use header::Header;

pub(super) use header::is_off;

/// Reads an OFF file.
pub(super) fn parse(bytes: &[u8], context: &mut Context<'_>) -> Result<Parsed, AssetError> {
    let mut statements = Statements::new(bytes);
    let header = Header::read(&mut statements)?;
    let limits = context.limits;
    let at = statements.location();
    let is_within = Limits::check("vertices", header.vertices, limits.max_vertices)
        .and_then(|()| Limits::check("faces", header.faces, limits.max_triangles));
    is_within.map_err(|error| error.at(at))?;
    let mut mesh = Mesh::default();
    // A row has a digit and a blank for each of its numbers.
    let possible = bytes.len() / 6 + 1;
    vertices::read(&mut statements, &header, possible, &mut mesh, context)?;
    faces::read(&mut statements, &header, &mut mesh, context)?;
    if mesh.triangles.is_empty() && mesh.lines.is_empty() && mesh.points.is_empty() {
        // Limits keep the number of vertices below 2^32.
        mesh.points = (0..u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX)).collect();
    }
    Ok(Parsed {
        scene: Scene {
            meshes: vec![mesh],
            up: UpAxis::Y,
            ..Scene::default()
        },
        ..Parsed::default()
    })
}

/// A colour with its numbers as they are in the file, and without alpha if it has none.
type StoredColor = ([f32; 3], Option<f32>);

/// The linear colours of sRGB-encoded numbers, which are of 0 to 255 if one is above 1; white where
/// there is no colour.
fn linear_colors(stored: &[Option<StoredColor>]) -> Vec<[f32; 4]> {
    let all = stored.iter().flatten();
    let numbers = all.flat_map(|(rgb, alpha)| rgb.iter().chain(alpha));
    let is_bytes = { numbers }.any(|&number| number > 1.0);
    let unit = |number: f32| {
        let scaled = if is_bytes { number / 255.0 } else { number };
        // NaN is no number of a colour.
        if scaled > 0.0 { scaled.min(1.0) } else { 0.0 }
    };
    let linear = |&(rgb, alpha): &StoredColor| {
        let [r, g, b] = rgb.map(|number| linear_from_srgb(unit(number)).min(1.0));
        [r, g, b, alpha.map_or(1.0, unit)]
    };
    let linear = |color: &Option<StoredColor>| color.as_ref().map_or([1.0; 4], linear);
    stored.iter().map(linear).collect()
}

/// The colour of the numbers of a line; `None` if they are no colour.
fn stored_color(numbers: &[f32]) -> Option<StoredColor> {
    match *numbers {
        [r, g, b] => Some(([r, g, b], None)),
        [r, g, b, a] => Some(([r, g, b], Some(a))),
        _ => None,
    }
}
