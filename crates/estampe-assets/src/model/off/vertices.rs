//! Vertices: positions and their attributes.

use super::header::Header;
use super::{linear_colors, stored_color};
use crate::AssetError;
use crate::model::load::Context;
use crate::model::normals::unit_or_zero;
use crate::model::statements::Statements;
use estampe_scene::Mesh;
use glam::{Vec2, Vec3};

/// Reads all vertices into `mesh`, for at most `possible` of which the file has room. A file that
/// ends among them is an error.
pub(super) fn read(
    statements: &mut Statements<'_>,
    header: &Header,
    possible: usize,
    mesh: &mut Mesh,
    context: &mut Context<'_>,
) -> Result<(), AssetError> {
    let count = usize::try_from(header.vertices).unwrap_or(usize::MAX);
    let room = |is_there: bool| if is_there { count.min(possible) } else { 0 };
    mesh.positions.reserve_exact(room(true));
    mesh.normals.reserve_exact(room(header.has_normals));
    mesh.uvs.reserve_exact(room(header.has_uvs));
    let mut colors = Vec::new();
    let mut has_colors = header.has_colors;
    let mut line = Vec::new();
    for at in 0..count {
        let position = numbers(statements, at, header)?;
        let w = if header.has_w {
            numbers::<1>(statements, at, header)?[0]
        } else {
            1.0
        };
        mesh.positions.push(Vec3::from_array(position) / w);
        if header.has_normals {
            let normal = numbers(statements, at, header)?;
            mesh.normals.push(unit_or_zero(Vec3::from_array(normal)));
        }
        if at == 0 && !header.has_colors && !header.has_uvs {
            // Some programs write colours without the letter for them.
            has_colors = matches!(words_left(statements), 3 | 4);
        }
        let uv_len = if header.has_uvs { 2 } else { 0 };
        if has_colors {
            // Four numbers, unless the line has fewer.
            let left = words_left(statements).saturating_sub(uv_len).min(4);
            rest_of_line(statements, left, &mut line);
            let color = stored_color(&line);
            if color.is_none() {
                context
                    .warnings
                    .add(context.name, statements.location(), || {
                        "the vertex has no colour of three or four numbers; it is white".to_owned()
                    });
            }
            colors.push(color);
        }
        if header.has_uvs {
            let [s, t] = numbers(statements, at, header)?;
            // OFF's t points up, the scene's v down.
            mesh.uvs.push(Vec2::new(s, 1.0 - t));
        }
    }
    mesh.colors = linear_colors(&colors);
    Ok(())
}

/// The next numbers, on any lines.
fn numbers<const N: usize>(
    statements: &mut Statements<'_>,
    at: usize,
    header: &Header,
) -> Result<[f32; N], AssetError> {
    let mut numbers = [0.0; N];
    for number in &mut numbers {
        let found = statements.find_word().then(|| statements.number());
        let Some(Some(Some(found))) = found else {
            let what = match found {
                None => format!("the file ends at vertex {at} of {}", header.vertices),
                Some(_) => format!("a word of vertex {at} is no number"),
            };
            let advice = "the file is damaged or not OFF; export it again";
            return Err(AssetError::malformed(what, advice).at(statements.location()));
        };
        *number = found;
    }
    Ok(numbers)
}

/// The words that are left in the line, of which more than 16 are not counted.
pub(super) fn words_left(statements: &Statements<'_>) -> usize {
    let mut ahead = statements.clone();
    (0..16).take_while(|_| ahead.word().is_some()).count()
}

/// The next `count` words of the line as numbers; those that are none are NaN.
pub(super) fn rest_of_line(statements: &mut Statements<'_>, count: usize, line: &mut Vec<f32>) {
    line.clear();
    for _ in 0..count {
        if let Some(number) = statements.number() {
            line.push(number.unwrap_or(f32::NAN));
        }
    }
}
