//! The `vertex` element: positions and what goes with them.

use super::header::{Element, Kind, Scalar};
use super::values::{Fault, Values};
use crate::AssetError;
use crate::model::normals::unit_or_zero;
use crate::model::srgb::{linear_from_srgb, linear_from_srgb8};
use estampe_scene::Mesh;
use glam::{Vec2, Vec3};

/// The names of each slot of a row.
const SLOT_NAMES: [&[&str]; 12] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["s", "u", "texture_u"],
    &["t", "v", "texture_v"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
];
const NORMAL: usize = 3;
const UV: usize = 6;
const COLOR: usize = 8;
const ALPHA: usize = 11;
/// Where values go that mean nothing.
const NOWHERE: usize = SLOT_NAMES.len();

/// How to read a row: for each property, its kind and the slot that it goes to.
struct Plan {
    steps: Vec<(Kind, usize)>,
    types: [Option<Scalar>; NOWHERE],
}

impl Plan {
    fn new(element: &Element) -> Self {
        let mut types = [None; NOWHERE];
        let steps = element.properties.iter().map(|property| {
            let named = SLOT_NAMES
                .iter()
                .position(|names| names.contains(&property.name.as_str()));
            match (property.kind, named) {
                (Kind::One(scalar), Some(slot)) if types[slot].is_none() => {
                    types[slot] = Some(scalar);
                    (property.kind, slot)
                }
                _ => (property.kind, NOWHERE),
            }
        });
        Self {
            steps: steps.collect(),
            types,
        }
    }

    fn has(&self, slots: std::ops::Range<usize>) -> bool {
        slots.into_iter().all(|slot| self.types[slot].is_some())
    }

    #[inline]
    fn read_row<V: Values>(
        &self,
        values: &mut V,
        row: &mut [f64; NOWHERE + 1],
    ) -> Result<(), Fault> {
        for &(kind, slot) in &self.steps {
            match kind {
                Kind::One(scalar) => row[slot] = values.next(scalar)?,
                Kind::List { .. } => values.skip_property(kind)?,
            }
        }
        values.end_row();
        Ok(())
    }
}

/// Reads all vertices into `mesh`. A file that ends among them is an error.
pub(super) fn read<V: Values>(
    values: &mut V,
    element: &Element,
    mesh: &mut Mesh,
) -> Result<(), AssetError> {
    let plan = Plan::new(element);
    if !plan.has(0..3) {
        return Err(AssetError::malformed(
            "the vertices have no `x`, `y`, `z`",
            "check that the file holds a mesh or a cloud of points",
        ));
    }
    let count = values.plausible_count(element);
    let (has_normals, has_uvs) = (plan.has(NORMAL..UV), plan.has(UV..COLOR));
    let color_types = plan.types[COLOR].filter(|_| plan.has(COLOR..ALPHA));
    mesh.positions.reserve_exact(count);
    mesh.normals
        .reserve_exact(if has_normals { count } else { 0 });
    mesh.uvs.reserve_exact(if has_uvs { count } else { 0 });
    mesh.colors
        .reserve_exact(if color_types.is_some() { count } else { 0 });
    let mut row = [0.0; NOWHERE + 1];
    for _ in 0..element.count {
        plan.read_row(values, &mut row)
            .map_err(|fault| values.error(fault))?;
        mesh.positions.push(vec3(&row, 0));
        if has_normals {
            mesh.normals.push(unit_or_zero(vec3(&row, NORMAL)));
        }
        if has_uvs {
            // PLY's v points up, the scene's down.
            mesh.uvs
                .push(Vec2::new(narrow(row[UV]), 1.0 - narrow(row[UV + 1])));
        }
        if let Some(scalar) = color_types {
            let rgb = [row[COLOR], row[COLOR + 1], row[COLOR + 2]];
            let alpha = plan.types[ALPHA].map_or(1.0, |scalar| unit_value(row[ALPHA], scalar));
            mesh.colors.push(color(rgb, scalar, alpha));
        }
    }
    Ok(())
}

fn vec3(row: &[f64; NOWHERE + 1], first: usize) -> Vec3 {
    Vec3::new(
        narrow(row[first]),
        narrow(row[first + 1]),
        narrow(row[first + 2]),
    )
}

/// The nearest f32.
pub(super) fn narrow(value: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "meshes are kept in f32")]
    {
        value as f32
    }
}

/// A linear colour from three sRGB-encoded values of one type.
pub(super) fn color(rgb: [f64; 3], scalar: Scalar, alpha: f32) -> [f32; 4] {
    let [r, g, b] = rgb.map(|value| match scalar {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "it is an integer below 256"
        )]
        #[expect(clippy::cast_sign_loss, reason = "a negative one becomes 0")]
        Scalar::U8 => linear_from_srgb8(value as u8),
        _ => linear_from_srgb(unit_value(value, scalar)),
    });
    [r, g, b, alpha]
}

/// A value between 0 and 1: floats are already, integers are of 8 bits unless they are of 16.
pub(super) fn unit_value(value: f64, scalar: Scalar) -> f32 {
    let largest = match scalar {
        Scalar::F32 | Scalar::F64 => 1.0,
        Scalar::U16 => 65_535.0,
        _ => 255.0,
    };
    narrow((value / largest).clamp(0.0, 1.0))
}
