//! OBJ: `v`, `vt`, `vn`, `f`, `l`, `p`, an object `o` for each mesh with a name.

use super::number::append_all;
use super::word;
use estampe_scene::Mesh;
use glam::{Vec2, Vec3};
use std::collections::HashMap;
use std::fmt::Write as _;

/// Vertices of a line statement; a longer polyline continues in the next one. Readers may limit the
/// length of lines.
const LINE_VERTICES: usize = 1000;

/// The numbers of values, each of which is written once.
struct Values<const N: usize> {
    number_of: HashMap<[u32; N], usize>,
    keyword: &'static str,
}

impl<const N: usize> Values<N> {
    fn new(keyword: &'static str) -> Self {
        Self {
            number_of: HashMap::new(),
            keyword,
        }
    }

    /// The number of a value, from 1; writes it if it is new.
    fn number(&mut self, value: [f32; N], text: &mut String) -> usize {
        // Adding zero turns −0 into 0.
        let value = value.map(|x| x + 0.0);
        let next = self.number_of.len() + 1;
        *self
            .number_of
            .entry(value.map(f32::to_bits))
            .or_insert_with(|| {
                text.push_str(self.keyword);
                append_all(text, value);
                text.push('\n');
                next
            })
    }
}

/// The numbers of one vertex's values.
#[derive(Clone, Copy)]
struct Corner {
    position: usize,
    uv: Option<usize>,
    /// `None` if the mesh has no normals or the vertex has none.
    normal: Option<usize>,
}

/// Writes all meshes.
pub(super) fn write(meshes: &[Mesh]) -> String {
    let mut text = "# estampe\n".to_owned();
    let mut positions = Values::new("v");
    let mut uvs = Values::new("vt");
    let mut normals = Values::new("vn");
    for mesh in meshes {
        if !mesh.name.is_empty() {
            let _ = writeln!(text, "o {}", word(&mesh.name));
        }
        // All values of one kind follow each other.
        let of_position: Vec<usize> = mesh
            .positions
            .iter()
            .map(|position| positions.number(position.to_array(), &mut text))
            .collect();
        // v = 0 is the top row here, and the bottom row in OBJ.
        let turned = |uv: &Vec2| [uv.x, 1.0 - uv.y];
        let of_uv: Vec<usize> = mesh
            .uvs
            .iter()
            .map(|uv| uvs.number(turned(uv), &mut text))
            .collect();
        let of_normal: Vec<Option<usize>> = mesh
            .normals
            .iter()
            .map(|&normal| {
                (normal != Vec3::ZERO).then(|| normals.number(normal.to_array(), &mut text))
            })
            .collect();
        let corner = |vertex: u32| {
            let vertex = vertex as usize;
            Corner {
                position: of_position[vertex],
                uv: of_uv.get(vertex).copied(),
                normal: of_normal.get(vertex).copied().flatten(),
            }
        };
        for triangle in &mesh.triangles {
            write_face(&mut text, triangle.map(corner));
        }
        write_lines(&mut text, mesh, &of_position);
        for &point in &mesh.points {
            let _ = writeln!(text, "p {}", of_position[point as usize]);
        }
    }
    text
}

fn write_face(text: &mut String, corners: [Corner; 3]) {
    text.push('f');
    // All corners of a face have the same form.
    let has_normals = corners.iter().all(|corner| corner.normal.is_some());
    for corner in corners {
        let _ = write!(text, " {}", corner.position);
        let normal = corner.normal.filter(|_| has_normals);
        let _ = match (corner.uv, normal) {
            (Some(uv), Some(normal)) => write!(text, "/{uv}/{normal}"),
            (Some(uv), None) => write!(text, "/{uv}"),
            (None, Some(normal)) => write!(text, "//{normal}"),
            (None, None) => Ok(()),
        };
    }
    text.push('\n');
}

/// Writes segments that continue each other as polylines.
fn write_lines(text: &mut String, mesh: &Mesh, of_position: &[usize]) {
    let mut open: Option<(u32, usize)> = None;
    for &[from, to] in &mesh.lines {
        let continues = open.filter(|&(end, count)| end == from && count < LINE_VERTICES);
        let count = match continues {
            Some((_, count)) => count,
            None => {
                if open.is_some() {
                    text.push('\n');
                }
                let _ = write!(text, "l {}", of_position[from as usize]);
                1
            }
        };
        let _ = write!(text, " {}", of_position[to as usize]);
        open = Some((to, count + 1));
    }
    if open.is_some() {
        text.push('\n');
    }
}
