//! Triangle meshes on grids: a sphere, a torus, quads.

use super::{LittleEndian, hash32, sin_cos_turns};

/// A triangle list with 32-bit indices, counter-clockwise seen from outside.
#[derive(Debug, Clone)]
pub struct IndexedMesh {
    /// The vertices.
    pub vertices: Vec<u8>,
    /// The indices, 32 bits each, three per triangle.
    pub indices: Vec<u8>,
}

/// The corners of a quad over x, y in −1..=1, counter-clockwise from the lower left.
pub const QUAD_CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// The indices of `quads` quads of four vertices each.
#[must_use]
pub fn quad_indices(quads: u32) -> Vec<u8> {
    let mut indices = LittleEndian::default();
    for first in (0..quads).map(|quad| quad * 4) {
        indices.words(&[0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
    indices.into_bytes()
}

/// The corners of a cell in a grid whose rows are `width` vertices long.
///
/// ```text
///   upper_left ── upper_right      row
///        │    ╲        │
///   lower_left ── lower_right      row + 1
/// ```
struct Cell {
    upper_left: u32,
    upper_right: u32,
    lower_left: u32,
    lower_right: u32,
}

impl Cell {
    fn at(row: u32, column: u32, width: u32) -> Self {
        let corner = row * width + column;
        Self {
            upper_left: corner,
            upper_right: corner + 1,
            lower_left: corner + width,
            lower_right: corner + width + 1,
        }
    }

    fn upper_triangle(&self) -> [u32; 3] {
        [self.upper_left, self.upper_right, self.lower_right]
    }

    fn lower_triangle(&self) -> [u32; 3] {
        [self.upper_left, self.lower_right, self.lower_left]
    }
}

/// A sphere of meridians and parallels with a bumpy surface, from the +y pole down.
///
/// `radius(theta, phi)` takes angles in turns: theta from 0 at the upper pole to ½, phi around the
/// y axis. A vertex has its position and the unit sphere's normal (3 floats each) and a colour (4
/// bytes): 28 bytes. Cells at a pole are one triangle, so there are `2·segments·(rings − 1)`
/// triangles.
#[must_use]
pub fn uv_sphere(segments: u32, rings: u32, radius: impl Fn(f64, f64) -> f64) -> IndexedMesh {
    let width = segments + 1;
    let mut vertices = LittleEndian::with_capacity(width as usize * (rings as usize + 1) * 28);
    for ring in 0..=rings {
        let theta = 0.5 * f64::from(ring) / f64::from(rings);
        let (sin_theta, cos_theta) = sin_cos_turns(theta);
        for segment in 0..=segments {
            let phi = f64::from(segment) / f64::from(segments);
            let (sin_phi, cos_phi) = sin_cos_turns(phi);
            let normal = [sin_theta * cos_phi, cos_theta, sin_theta * sin_phi];
            let radius = radius(theta, phi);
            vertices.reals(&normal.map(|component| component * radius));
            vertices.reals(&normal);
            // The two columns of vertices at the seam have the same colours.
            let noise = hash32(segment % segments * 7919 + ring).to_le_bytes();
            let [red, green, blue] = [0, 1, 2].map(|k| tinted(normal[k], noise_bits(noise, k)));
            vertices.raw(&[red, green, blue, 255]);
        }
    }
    let mut indices = LittleEndian::with_capacity(width as usize * rings as usize * 24);
    for ring in 0..rings {
        for segment in 0..segments {
            let cell = Cell::at(ring, segment, width);
            if ring > 0 {
                indices.words(&cell.upper_triangle());
            }
            if ring + 1 < rings {
                indices.words(&cell.lower_triangle());
            }
        }
    }
    IndexedMesh {
        vertices: vertices.into_bytes(),
        indices: indices.into_bytes(),
    }
}

/// Five bits of each of the hash's bytes.
fn noise_bits(noise: [u8; 4], channel: usize) -> f64 {
    f64::from(noise[channel] & 31)
}

/// A colour byte, 32..=254, from a component of the normal and 0..=31 of noise.
fn tinted(component: f64, noise: f64) -> u8 {
    let base = (component * 0.5 + 0.5) * 191.0 + 32.0;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number in 32..=254"
    )]
    let byte = (base + noise).floor() as u8;
    byte
}

/// A torus about the y axis: the ring's radius is 1, the tube's 0.45.
///
/// A vertex has position, normal (3 floats each), tangent (4; w is the handedness of bitangent =
/// normal × tangent · w) and uv (2): 48 bytes. u runs to 8 around the ring, v to 4 around the tube.
#[must_use]
pub fn torus(ring_cells: u32, tube_cells: u32) -> IndexedMesh {
    const TUBE_RADIUS: f64 = 0.45;
    let width = tube_cells + 1;
    let mut vertices = LittleEndian::with_capacity(width as usize * (ring_cells as usize + 1) * 48);
    for step in 0..=ring_cells {
        let around_ring = f64::from(step) / f64::from(ring_cells);
        let (sin_ring, cos_ring) = sin_cos_turns(around_ring);
        for cell in 0..=tube_cells {
            let around_tube = f64::from(cell) / f64::from(tube_cells);
            let (sin_tube, cos_tube) = sin_cos_turns(around_tube);
            let distance = 1.0 + TUBE_RADIUS * cos_tube;
            let height = TUBE_RADIUS * sin_tube;
            vertices.reals(&[cos_ring * distance, height, sin_ring * distance]);
            vertices.reals(&[cos_ring * cos_tube, sin_tube, sin_ring * cos_tube]);
            vertices.reals(&[-sin_ring, 0.0, cos_ring, -1.0]);
            vertices.reals(&[around_ring * 8.0, around_tube * 4.0]);
        }
    }
    let mut indices = LittleEndian::with_capacity(width as usize * ring_cells as usize * 24);
    for step in 0..ring_cells {
        for cell in 0..tube_cells {
            let cell = Cell::at(step, cell, width);
            indices.words(&cell.upper_triangle());
            indices.words(&cell.lower_triangle());
        }
    }
    IndexedMesh {
        vertices: vertices.into_bytes(),
        indices: indices.into_bytes(),
    }
}
