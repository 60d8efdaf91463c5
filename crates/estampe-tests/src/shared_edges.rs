//! Random meshes that cover each point of a rectangle once: triangles that share edges.
//!
//! Corners are chosen in 1/256 pixel, so that snapping in the window reproduces these integers
//! exactly. Every triangle is checked in integers: it has the common winding or no area. Such
//! triangles, whose outer border runs around the rectangle once, cover each point inside exactly
//! once; a point on an edge or a vertex belongs to the triangle that the fill rule selects.

use crate::Random;

/// A corner in 1/256 pixel.
pub type Corner = [i32; 2];

/// The construction of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Triangles around one vertex.
    Fan,
    /// Triangles between two lines, above and below or left and right of the rectangle.
    Strip,
    /// Jittered squares of a pixel or more, cut along either diagonal.
    Grid,
    /// Jittered squares smaller than a pixel.
    FineGrid,
    /// A square of which triangles are repeatedly split into three at a point: slivers.
    Cuts,
    /// Triangles around one vertex, far outside the guard band: they are clipped.
    Huge,
}

impl Kind {
    /// Every construction.
    pub const ALL: [Self; 6] = [
        Self::Fan,
        Self::Strip,
        Self::Grid,
        Self::FineGrid,
        Self::Cuts,
        Self::Huge,
    ];
}

/// The least distance by which a mesh extends beyond the rectangle: 2 pixels.
const MARGIN: i32 = 512;

/// A mesh's triangles over a rectangle of `size` pixels from (0, 0) on.
///
/// # Panics
/// If a triangle is reversed or the mesh is empty: a fault of this module.
pub fn mesh(random: &mut Random, kind: Kind, size: [u32; 2]) -> Vec<[Corner; 3]> {
    let size = size.map(|pixels| i32::try_from(pixels * 256).expect("a small target"));
    let triangles = match kind {
        Kind::Fan => fan(random, size, false),
        Kind::Huge => fan(random, size, true),
        Kind::Strip => strip(random, size),
        Kind::Grid => {
            let cell = random.pick(&[256, 300, 512, 1024, 2048, 5000]);
            grid(random, size, cell)
        }
        Kind::FineGrid => {
            let cell = random.pick(&[16, 32, 50, 64, 128, 200]);
            // A part of the rectangle suffices: fewer squares of the same size.
            let size = size.map(|along| along.min(cell * 180));
            grid(random, size, cell)
        }
        Kind::Cuts => cuts(random, size),
    };
    let mut area = 0;
    for triangle in &triangles {
        let doubled = doubled_area(*triangle);
        assert!(
            doubled >= 0,
            "{kind:?}: a triangle is turned over: {triangle:?}"
        );
        area += doubled;
    }
    assert!(area > 0, "{kind:?}: nothing is covered");
    triangles
}

/// The size of the rectangle of pixels that a mesh surely covers: all, or for the finest grids a
/// part.
#[must_use]
pub fn covered(kind: Kind, size: [u32; 2], triangles: &[[Corner; 3]]) -> [u32; 2] {
    if kind != Kind::FineGrid {
        return size;
    }
    [0, 1].map(|axis| {
        let far = triangles.iter().flatten().map(|corner| corner[axis]).max();
        // The last column and row of corners are jittered by less than a pixel.
        let whole = far.map_or(0, |far| far.div_euclid(256) - 2);
        u32::try_from(whole).unwrap_or(0).min(size[axis])
    })
}

/// Twice the area, positive where the corners run clockwise on the image.
fn doubled_area([a, b, c]: [Corner; 3]) -> i64 {
    let minus = |p: Corner, q: Corner| [0, 1].map(|k| i64::from(p[k]) - i64::from(q[k]));
    let ([dx1, dy1], [dx2, dy2]) = (minus(b, a), minus(c, a));
    dx1 * dy2 - dx2 * dy1
}

/// A number from `low` to `high`, both included.
fn between(random: &mut Random, low: i32, high: i32) -> i32 {
    let count = u32::try_from(i64::from(high) - i64::from(low) + 1).expect("low is not above high");
    low + i32::try_from(random.below(count)).expect("below a difference of i32")
}

/// Moves a coordinate to a possible tie: whole pixels, centres, sample positions, or leaves it.
fn on_step(random: &mut Random, at: i32) -> i32 {
    let step = random.pick(&[1, 1, 16, 128, 256]);
    at.div_euclid(step) * step
}

/// A vertex inside, and a ring around the rectangle with its corners in the order of their angles,
/// clockwise on the image.
fn fan(random: &mut Random, size: [i32; 2], is_huge: bool) -> Vec<[Corner; 3]> {
    let center = size.map(|along| {
        let at = between(random, 0, along);
        on_step(random, at)
    });
    let reach = size[0] + size[1] + MARGIN;
    let count = if is_huge {
        3 + random.below(9)
    } else {
        3 + random.below(300)
    };
    let mut ring: Vec<Corner> = Vec::new();
    // Around a square, side by side, at ordered positions, so that the angles are in order.
    let sides = count.div_ceil(4).max(1);
    for side in 0..4 {
        let mut along: Vec<i32> = (0..sides)
            .map(|_| between(random, -reach, reach - 1))
            .collect();
        // The square's own corner keeps the rectangle inside the ring.
        along.push(-reach);
        along.sort_unstable();
        along.dedup();
        if is_huge {
            // Clipping moves corners by fractions of a pixel, which might change the order of close
            // ones.
            along.dedup_by(|next, last| *next - *last < reach / 8);
        }
        for at in along {
            let offset = match side {
                0 => [at, -reach],
                1 => [reach, at],
                2 => [-at, reach],
                _ => [-reach, -at],
            };
            // Move the corner farther out in exactly the same direction.
            let most = (if is_huge { 1 << 28 } else { 1 << 20 }) / reach;
            let factor = between(random, 1, most.max(1));
            let factor = if random.once_in(2) { factor } else { 1 };
            ring.push([0, 1].map(|axis| center[axis] + offset[axis] * factor));
        }
    }
    (0..ring.len())
        .map(|k| [center, ring[k], ring[(k + 1) % ring.len()]])
        .collect()
}

/// Two lines of vertices, on opposite sides of the rectangle, connected by a zigzag.
fn strip(random: &mut Random, size: [i32; 2]) -> Vec<[Corner; 3]> {
    let is_turned = random.once_in(2);
    let [width, height] = if is_turned { [size[1], size[0]] } else { size };
    let slant = between(random, 0, 4 * width);
    let [top, bottom] = [-between(random, 1, 2000), height + between(random, 1, 2000)];
    let mut line = |y: i32, shift: i32| {
        let (low, high) = (-MARGIN - slant - 4 * MARGIN, width + slant + 4 * MARGIN);
        let count = 1 + random.below(200);
        let mut places: Vec<i32> = (0..count)
            .map(|_| {
                let at = between(random, low, high);
                on_step(random, at)
            })
            .collect();
        places.extend([low - 256, high]);
        places.sort_unstable();
        places
            .into_iter()
            .map(|x| [x + shift, y])
            .collect::<Vec<Corner>>()
    };
    let upper = line(top, 0);
    let lower = line(bottom, 0);
    let (mut a, mut b) = (0, 0);
    let mut triangles = Vec::new();
    while a + 1 < upper.len() || b + 1 < lower.len() {
        let takes_upper = b + 1 == lower.len() || a + 1 < upper.len() && random.once_in(2);
        let triangle = if takes_upper {
            a += 1;
            [upper[a - 1], upper[a], lower[b]]
        } else {
            b += 1;
            [upper[a], lower[b], lower[b - 1]]
        };
        triangles.push(triangle);
    }
    if is_turned {
        // Mirroring at the diagonal reverses the winding, so the corners are reversed too.
        let mirrored = |[x, y]: Corner| [y, x];
        for triangle in &mut triangles {
            let [p, q, r] = triangle.map(mirrored);
            *triangle = [p, r, q];
        }
    }
    triangles
}

/// Squares, each corner jittered by at most a quarter of a side, which reverses no triangle.
fn grid(random: &mut Random, size: [i32; 2], cell: i32) -> Vec<[Corner; 3]> {
    let [columns, rows] = size.map(|along| (along + 2 * MARGIN) / cell + 3);
    let step = random.pick(&[1, 1, 16, 128]);
    let shake = random.pick(&[0, cell / 16, cell / 4]);
    let mut corner = |column: i32, row: i32| {
        [column, row].map(|place| {
            let offset = between(random, -shake, shake) / step * step;
            place * cell - MARGIN - cell + offset
        })
    };
    let mut corners = Vec::new();
    for row in 0..=rows {
        for column in 0..=columns {
            corners.push(corner(column, row));
        }
    }
    let stride = usize::try_from(columns + 1).expect("positive");
    let mut triangles = Vec::new();
    for row in 0..usize::try_from(rows).expect("positive") {
        for column in 0..stride - 1 {
            let at = row * stride + column;
            let [a, b, c, d] = [at, at + 1, at + stride + 1, at + stride].map(|k| corners[k]);
            if random.once_in(2) {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    triangles
}

/// Two triangles over the whole rectangle; then triangles are repeatedly split into three at a
/// point inside or on the border.
fn cuts(random: &mut Random, size: [i32; 2]) -> Vec<[Corner; 3]> {
    let [left, top] = [0; 2].map(|_: i32| -between(random, 1, 3000));
    let [right, bottom] = size.map(|along| along + between(random, 1, 3000));
    let [a, b, c, d] = [[left, top], [right, top], [right, bottom], [left, bottom]];
    let mut triangles = vec![[a, b, c], [a, c, d]];
    for _ in 0..random.below(250) {
        let at = random.index(triangles.len());
        let [p, q, r] = triangles[at];
        let inside = |axis: usize, s: f32, t: f32| {
            let [p, q, r] = [p, q, r].map(|corner| corner[axis] as f32);
            rounded(p + (q - p) * s + (r - p) * t)
        };
        let (s, t) = (random.unit(), random.unit());
        let (s, t) = if s + t > 1.0 {
            (1.0 - s, 1.0 - t)
        } else {
            (s, t)
        };
        let [x, y] = [0, 1].map(|axis| inside(axis, s, t));
        let point = [on_step(random, x), on_step(random, y)];
        let parts = [[p, q, point], [q, r, point], [r, p, point]];
        // Rounding may have moved the point outside the triangle. For a point on the border one
        // part has no area; the neighbour beyond keeps its whole edge and meets two edges on the
        // same line.
        if parts.iter().all(|part| doubled_area(*part) >= 0) {
            triangles.swap_remove(at);
            triangles.extend(parts);
        }
    }
    triangles
}

#[expect(clippy::cast_possible_truncation, reason = "a place near a target")]
fn rounded(value: f32) -> i32 {
    value.round() as i32
}
