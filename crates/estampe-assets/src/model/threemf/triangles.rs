//! The mesh of an object: vertices, triangles, and the properties of their corners.

use super::document::Property;
use super::part::Reading;
use super::xml::{Tag, Xml};
use crate::model::load::Context;
use crate::{AssetError, Limits};
use glam::Vec3;

pub(super) use super::document::Triangles;

/// Reads the open `mesh`. Triangles without a property have that of the object: the identifier of a
/// group and an index in it.
pub(super) fn read(
    triangles: &mut Triangles,
    of_object: Option<(u32, u32)>,
    xml: &mut Xml<'_>,
    reading: &Reading<'_>,
    context: &mut Context<'_>,
) -> Result<(), AssetError> {
    let limits = context.limits;
    while let Some(tag) = xml.child()? {
        match tag.local_name().into_inner() {
            "vertices" => {
                while let Some(tag) = xml.child()? {
                    if tag.local_name().into_inner() == "vertex" {
                        let position = vertex(&tag, xml, reading.unit_mm)?;
                        triangles.positions.push(position);
                        let count = triangles.positions.len() as u64;
                        Limits::check("vertices", count, limits.max_vertices)
                            .map_err(|error| xml.located(error))?;
                    }
                    xml.skip()?;
                }
            }
            "triangles" => {
                while let Some(tag) = xml.child()? {
                    if tag.local_name().into_inner() == "triangle" {
                        triangle(&tag, triangles, of_object, xml, reading, context)?;
                        let count = triangles.triangles.len() as u64;
                        Limits::check("triangles", count, limits.max_triangles)
                            .map_err(|error| xml.located(error))?;
                    }
                    xml.skip()?;
                }
            }
            _ => xml.skip()?,
        }
    }
    Ok(())
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "positions are f32, and products too large for them infinite"
)]
fn vertex(tag: &Tag<'_>, xml: &Xml<'_>, unit_mm: f64) -> Result<Vec3, AssetError> {
    let mut position = [None; 3];
    for attribute in xml.attributes(tag) {
        let (name, value) = attribute?;
        let axis = match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            _ => continue,
        };
        position[axis] = Some(xml.number(name, &value)?);
    }
    let [Some(x), Some(y), Some(z)] = position else {
        return Err(xml.malformed("the vertex lacks one of `x`, `y` and `z`"));
    };
    let scaled = |value: f32| (f64::from(value) * unit_mm) as f32;
    Ok(Vec3::from_array([x, y, z].map(scaled)))
}

fn triangle(
    tag: &Tag<'_>,
    triangles: &mut Triangles,
    of_object: Option<(u32, u32)>,
    xml: &Xml<'_>,
    reading: &Reading<'_>,
    context: &mut Context<'_>,
) -> Result<(), AssetError> {
    let mut vertices = [None; 3];
    let mut corners = [None; 3];
    let mut group = None;
    for attribute in xml.attributes(tag) {
        let (name, value) = attribute?;
        let target = match name {
            "v1" => &mut vertices[0],
            "v2" => &mut vertices[1],
            "v3" => &mut vertices[2],
            "p1" => &mut corners[0],
            "p2" => &mut corners[1],
            "p3" => &mut corners[2],
            "pid" => &mut group,
            _ => continue,
        };
        *target = Some(xml.index(name, &value)?);
    }
    let [Some(a), Some(b), Some(c)] = vertices else {
        return Err(xml.malformed("the triangle lacks one of `v1`, `v2` and `v3`"));
    };
    let count = triangles.positions.len();
    if [a, b, c].iter().any(|&vertex| vertex as usize >= count) {
        xml.warn(context, || {
            "the triangle refers to a vertex that does not exist; it is omitted".to_owned()
        });
        return Ok(());
    }
    let first = corners[0].or(of_object.map(|(_, index)| index));
    let property = match (group.or(of_object.map(|(group, _)| group)), first) {
        (Some(group), Some(first)) => {
            let corners = [
                first,
                corners[1].unwrap_or(first),
                corners[2].unwrap_or(first),
            ];
            found(group, corners, xml, reading, context)
        }
        _ => None,
    };
    if property.is_some() || !triangles.properties.is_empty() {
        // Those before, without one.
        let before = triangles.triangles.len();
        triangles.properties.resize(before, None);
        triangles.properties.push(property);
    }
    triangles.triangles.push([a, b, c]);
    Ok(())
}

/// The property, if the group has all its entries.
fn found(
    id: u32,
    corners: [u32; 3],
    xml: &Xml<'_>,
    reading: &Reading<'_>,
    context: &mut Context<'_>,
) -> Option<Property> {
    let Some(&group) = reading.groups.get(&id) else {
        xml.warn(context, || {
            format!("the properties {id} do not exist; the triangle has none")
        });
        return None;
    };
    let entries = &reading.document.groups[group];
    if matches!(entries, super::document::Group::Other) {
        return None;
    }
    let count = entries.len();
    if corners.iter().any(|&corner| corner as usize >= count) {
        xml.warn(context, || {
            format!("the properties {id} have {count} entries only; the triangle has none")
        });
        return None;
    }
    Some(Property {
        group: u32::try_from(group).ok()?,
        corners,
    })
}
