//! The `vertex` element: positions and their attributes.

use super::header::{Element, Kind, Scalar};
use super::values::{Fault, Values};
use crate::AssetError;
use crate::model::normals::unit_or_zero;
use crate::model::srgb::{linear_from_srgb, linear_from_srgb8};
use crate::zeros::zeros;
use estampe_scene::{Mesh, Workers};
use glam::{Vec2, Vec3};

/// The property names of each slot of a row.
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
/// The slot of values without a meaning.
const NOWHERE: usize = SLOT_NAMES.len();

/// Plan for reading a row: for each property, its kind and its slot.
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

    fn has_normals(&self) -> bool {
        self.has(NORMAL..UV)
    }

    fn has_uvs(&self) -> bool {
        self.has(UV..COLOR)
    }

    fn has_colors(&self) -> bool {
        self.has(COLOR..ALPHA)
    }

    /// The colour of a row; the row must have one.
    fn color(&self, row: &[f64; NOWHERE + 1]) -> [f32; 4] {
        let rgb = [row[COLOR], row[COLOR + 1], row[COLOR + 2]];
        let alpha = self.types[ALPHA].map_or(1.0, |scalar| unit_value(row[ALPHA], scalar));
        color(rgb, self.types[COLOR].unwrap_or(Scalar::U8), alpha)
    }

    /// The length of a row in binary; `None` if it has lists, or nothing.
    fn row_bytes(&self) -> Option<usize> {
        let bytes = self.steps.iter().map(|&(kind, _)| match kind {
            Kind::One(scalar) => Some(scalar.len_bytes()),
            Kind::List { .. } => None,
        });
        bytes.sum::<Option<usize>>().filter(|&bytes| bytes > 0)
    }

    /// True if rows are a position of three floats and nothing else, as in most scans.
    fn is_floats_of_position(&self) -> bool {
        let steps = [0, 1, 2].map(|slot| (Kind::One(Scalar::F32), slot));
        self.steps == steps
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
    workers: Workers,
) -> Result<(), AssetError> {
    let plan = Plan::new(element);
    if !plan.has(0..3) {
        return Err(AssetError::malformed(
            "the vertices have no `x`, `y`, `z`",
            "check that the file has a mesh or a point cloud",
        ));
    }
    let rows = plan
        .row_bytes()
        .and_then(|bytes| values.take_rows(element.count, bytes, PIECE));
    if let Some(readers) = rows {
        read_at_once(&plan, readers, mesh, workers);
        return Ok(());
    }
    let count = values.plausible_count(element);
    let room = |is_there: bool| if is_there { count } else { 0 };
    mesh.positions.reserve_exact(count);
    mesh.normals.reserve_exact(room(plan.has_normals()));
    mesh.uvs.reserve_exact(room(plan.has_uvs()));
    mesh.colors.reserve_exact(room(plan.has_colors()));
    let mut row = [0.0; NOWHERE + 1];
    for _ in 0..element.count {
        plan.read_row(values, &mut row)
            .map_err(|fault| values.error(fault))?;
        mesh.positions.push(vec3(&row, 0));
        if plan.has_normals() {
            mesh.normals.push(normal(&row));
        }
        if plan.has_uvs() {
            mesh.uvs.push(uv(&row));
        }
        if plan.has_colors() {
            mesh.colors.push(plan.color(&row));
        }
    }
    Ok(())
}

/// Rows of a piece: some hundred microseconds of work.
const PIECE: usize = 1 << 14;

/// Reads rows of one length by several threads; each reader has [`PIECE`] rows except the last.
fn read_at_once<V: Values>(plan: &Plan, readers: Vec<V>, mesh: &mut Mesh, workers: Workers) {
    let Some(row_bytes) = plan.row_bytes() else {
        return;
    };
    let count = readers
        .iter()
        .map(|reader| reader.len_bytes() / row_bytes)
        .sum();
    let room = |is_there: bool| if is_there { count } else { 0 };
    // Plain numbers: vectors of them start as zeroed memory.
    let mut positions: Vec<[f32; 3]> = zeros(count);
    let mut normals: Vec<[f32; 3]> = zeros(room(plan.has_normals()));
    let mut uvs: Vec<[f32; 2]> = zeros(room(plan.has_uvs()));
    let mut colors: Vec<[f32; 4]> = zeros(room(plan.has_colors()));
    let parts = readers.into_iter().zip(
        positions
            .chunks_mut(PIECE)
            .zip(chunks_or_empty(&mut normals, PIECE))
            .zip(chunks_or_empty(&mut uvs, PIECE))
            .zip(chunks_or_empty(&mut colors, PIECE)),
    );
    workers.map(
        parts,
        |(mut reader, (((positions, normals), uvs), colors))| {
            if plan.is_floats_of_position() {
                for slot in positions.as_flattened_mut() {
                    let Ok(value) = reader.next(Scalar::F32) else {
                        unreachable!("all rows are there and have the length of their values");
                    };
                    *slot = narrow(value);
                }
                return;
            }
            let mut row = [0.0; NOWHERE + 1];
            for (index, position) in positions.iter_mut().enumerate() {
                if plan.read_row(&mut reader, &mut row).is_err() {
                    unreachable!("all rows are there and have the length of their values");
                }
                *position = vec3(&row, 0).to_array();
                if let Some(slot) = normals.get_mut(index) {
                    *slot = normal(&row).to_array();
                }
                if let Some(slot) = uvs.get_mut(index) {
                    *slot = uv(&row).to_array();
                }
                if let Some(slot) = colors.get_mut(index) {
                    *slot = plan.color(&row);
                }
            }
        },
    );
    // The memory is reused: the elements have the same size and alignment.
    mesh.positions = positions.into_iter().map(Vec3::from_array).collect();
    mesh.normals = normals.into_iter().map(Vec3::from_array).collect();
    mesh.uvs = uvs.into_iter().map(Vec2::from_array).collect();
    mesh.colors = colors;
}

/// Chunks, and empty ones after them.
fn chunks_or_empty<T>(values: &mut [T], size: usize) -> impl Iterator<Item = &mut [T]> {
    values
        .chunks_mut(size)
        .chain(std::iter::repeat_with(Default::default))
}

fn normal(row: &[f64; NOWHERE + 1]) -> Vec3 {
    unit_or_zero(vec3(row, NORMAL))
}

/// PLY's v points up, the scene's down.
fn uv(row: &[f64; NOWHERE + 1]) -> Vec2 {
    Vec2::new(narrow(row[UV]), 1.0 - narrow(row[UV + 1]))
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

/// A value between 0 and 1: floats unchanged, u16 divided by 65535, other integers by 255.
pub(super) fn unit_value(value: f64, scalar: Scalar) -> f32 {
    let largest = match scalar {
        Scalar::F32 | Scalar::F64 => 1.0,
        Scalar::U16 => 65_535.0,
        _ => 255.0,
    };
    narrow((value / largest).clamp(0.0, 1.0))
}
