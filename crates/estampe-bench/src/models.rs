//! Models for measuring the whole process, `estampe render` from file to file: one torus in two
//! sizes, as binary STL, as indexed binary PLY and as OBJ.
//!
//! The bytes are the same on every machine: sines come from `libm`, are computed in f64 and rounded
//! once.

use std::f64::consts::TAU;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// A torus around the y axis whose tube has half the radius of its ring.
///
/// Vertices lie in `ring` rows of `tube` vertices around the ring; each cell between them is two
/// triangles.
#[derive(Debug, Clone, Copy)]
struct Torus {
    ring: u32,
    tube: u32,
}

/// 69,696 triangles.
const SMALL: Torus = Torus {
    ring: 264,
    tube: 132,
};

/// 999,696 triangles.
const LARGE: Torus = Torus {
    ring: 708,
    tube: 706,
};

/// Writes `torus-70k.stl`, `torus-1m.ply` and `torus-1m.obj` into a folder, which is created if it
/// is missing.
///
/// # Errors
/// The folder or a file cannot be written.
pub(crate) fn write_models(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let write = |name: &str, body: fn(&mut BufWriter<File>) -> io::Result<()>| {
        let mut file = BufWriter::new(File::create(folder.join(name))?);
        body(&mut file)?;
        file.flush()
    };
    write("torus-70k.stl", |file| write_stl(SMALL, file))?;
    write("torus-1m.ply", |file| write_ply(LARGE, file))?;
    write("torus-1m.obj", |file| write_obj(LARGE, file))
}

impl Torus {
    fn vertex_count(self) -> u32 {
        self.ring * self.tube
    }

    fn triangle_count(self) -> u32 {
        2 * self.ring * self.tube
    }

    /// Row and column of every cell, and of every vertex.
    fn cells(self) -> impl Iterator<Item = (u32, u32)> {
        (0..self.ring).flat_map(move |row| (0..self.tube).map(move |column| (row, column)))
    }

    /// Position and unit normal.
    fn vertex(self, row: u32, column: u32) -> ([f32; 3], [f32; 3]) {
        let around = TAU * f64::from(row % self.ring) / f64::from(self.ring);
        let across = TAU * f64::from(column % self.tube) / f64::from(self.tube);
        let (sin_around, cos_around) = libm::sincos(around);
        let (sin_across, cos_across) = libm::sincos(across);
        let radius = 1.0 + 0.5 * cos_across;
        let position = [radius * cos_around, 0.5 * sin_across, radius * sin_around];
        let normal = [cos_across * cos_around, sin_across, cos_across * sin_around];
        #[expect(clippy::cast_possible_truncation, reason = "files hold f32")]
        let rounded = |vector: [f64; 3]| vector.map(|value| value as f32);
        (rounded(position), rounded(normal))
    }

    /// The two triangles of a cell, counter-clockwise from outside, as rows and columns of their
    /// corners. A row or column beyond the last stands for the first.
    fn triangles(row: u32, column: u32) -> [[(u32, u32); 3]; 2] {
        let [a, b] = [(row, column), (row + 1, column)];
        let [c, d] = [(row, column + 1), (row + 1, column + 1)];
        [[a, c, b], [b, c, d]]
    }

    /// The index of a vertex; a row or column beyond the last stands for the first.
    fn index(self, (row, column): (u32, u32)) -> u32 {
        row % self.ring * self.tube + column % self.tube
    }
}

/// Header, count, and for each triangle a zero normal (readers compute normals), three corners, no
/// attribute.
fn write_stl(torus: Torus, out: &mut impl Write) -> io::Result<()> {
    let mut header = [b' '; 80];
    header[..13].copy_from_slice(b"estampe torus");
    out.write_all(&header)?;
    out.write_all(&torus.triangle_count().to_le_bytes())?;
    for (row, column) in torus.cells() {
        for triangle in Torus::triangles(row, column) {
            out.write_all(&[0; 12])?;
            for (row, column) in triangle {
                write_floats(torus.vertex(row, column).0, out)?;
            }
            out.write_all(&[0; 2])?;
        }
    }
    Ok(())
}

/// Positions and triangles without normals, which the reader has to compute.
fn write_ply(torus: Torus, out: &mut impl Write) -> io::Result<()> {
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n\
         property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        torus.vertex_count(),
        torus.triangle_count()
    )?;
    for (row, column) in torus.cells() {
        write_floats(torus.vertex(row, column).0, out)?;
    }
    for (row, column) in torus.cells() {
        for triangle in Torus::triangles(row, column) {
            out.write_all(&[3])?;
            for corner in triangle {
                out.write_all(&torus.index(corner).to_le_bytes())?;
            }
        }
    }
    Ok(())
}

/// Positions, texture coordinates and normals; only the texture coordinates have a seam.
fn write_obj(torus: Torus, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "# estampe torus\no torus")?;
    for (row, column) in torus.cells() {
        let [x, y, z] = torus.vertex(row, column).0;
        writeln!(out, "v {x:.6} {y:.6} {z:.6}")?;
    }
    let fraction = |at: u32, of: u32| f64::from(at) / f64::from(of);
    for row in 0..=torus.ring {
        for column in 0..=torus.tube {
            let (u, v) = (fraction(row, torus.ring), fraction(column, torus.tube));
            writeln!(out, "vt {u:.6} {v:.6}")?;
        }
    }
    for (row, column) in torus.cells() {
        let [x, y, z] = torus.vertex(row, column).1;
        writeln!(out, "vn {x:.6} {y:.6} {z:.6}")?;
    }
    for (row, column) in torus.cells() {
        for triangle in Torus::triangles(row, column) {
            write!(out, "f")?;
            for corner in triangle {
                let uv = corner.0 * (torus.tube + 1) + corner.1 + 1;
                let vertex = torus.index(corner) + 1;
                write!(out, " {vertex}/{uv}/{vertex}")?;
            }
            writeln!(out)?;
        }
    }
    Ok(())
}

fn write_floats(values: [f32; 3], out: &mut impl Write) -> io::Result<()> {
    values
        .iter()
        .try_for_each(|value| out.write_all(&value.to_le_bytes()))
}

#[cfg(test)]
mod tests {
    use super::{LARGE, SMALL, Torus, write_obj, write_ply, write_stl};

    /// A torus small enough to be checked by hand.
    const TINY: Torus = Torus { ring: 3, tube: 4 };

    #[test]
    fn sizes_are_those_of_the_formats() {
        assert_eq!(SMALL.triangle_count(), 69_696);
        assert!((998_000..=1_002_000).contains(&LARGE.triangle_count()));
        let mut stl = Vec::new();
        write_stl(TINY, &mut stl).unwrap();
        assert_eq!(stl.len(), 84 + 24 * 50);
        let mut ply = Vec::new();
        write_ply(TINY, &mut ply).unwrap();
        let body = ply
            .windows(11)
            .position(|text| text == b"end_header\n")
            .unwrap()
            + 11;
        assert_eq!(ply.len() - body, 12 * 12 + 24 * 13);
    }

    #[test]
    fn triangles_face_outwards_and_obj_indices_exist() {
        for (row, column) in TINY.cells() {
            for triangle in Torus::triangles(row, column) {
                let corners = triangle.map(|(row, column)| TINY.vertex(row, column));
                let [a, b, c] = corners.map(|(position, _)| position);
                let edge = |to: [f32; 3]| [to[0] - a[0], to[1] - a[1], to[2] - a[2]];
                let (u, v) = (edge(b), edge(c));
                let cross = [
                    u[1] * v[2] - u[2] * v[1],
                    u[2] * v[0] - u[0] * v[2],
                    u[0] * v[1] - u[1] * v[0],
                ];
                let mean = |axis: usize| -> f32 { corners.iter().map(|(_, n)| n[axis]).sum() };
                let dot: f32 = (0..3).map(|axis| cross[axis] * mean(axis)).sum();
                assert!(dot > 0.0, "row {row}, column {column}");
            }
        }
        let mut obj = Vec::new();
        write_obj(TINY, &mut obj).unwrap();
        let obj = String::from_utf8(obj).unwrap();
        let count = |start: &str| obj.lines().filter(|line| line.starts_with(start)).count();
        let (positions, uvs, faces) = (count("v "), count("vt "), count("f "));
        assert_eq!((positions, uvs, faces), (12, 20, 24));
        assert_eq!(count("vn "), positions);
        let mut largest = [0; 3];
        for line in obj.lines().filter(|line| line.starts_with("f ")) {
            for corner in line[2..].split(' ') {
                for (most, index) in largest.iter_mut().zip(corner.split('/')) {
                    *most = index.parse::<usize>().unwrap().max(*most);
                }
            }
        }
        assert_eq!(largest, [positions, uvs, positions]);
    }
}
