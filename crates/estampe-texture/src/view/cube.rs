//! Cube maps: the face that a direction meets, the coordinates there, and the texels beyond a
//! face's edge.
//!
//! # Edges
//!
//! Texel (x, y) of a face of n texels has its centre at (2x + 1 − n, 2y + 1 − n) in a square from
//! −n to n, and the square stands at n on its major axis: the cube from −n to n. One texel beyond
//! an edge, a coordinate is ±(n + 1). The neighbour is found by folding the cube along that edge:
//! the coordinate becomes ±n, the major one of the neighbour, and the old major coordinate becomes
//! n − 1, the neighbour's first row of centres. All of this is integer arithmetic, without a table
//! of 24 edges.

/// Faces in layer order: the axis that is major, its sign, then the axes and signs of s and t.
/// (Vulkan 1.3, *Cube Map Face Selection*.)
const FACES: [Face; 6] = [
    Face::new((0, 1), (2, -1), (1, -1)),
    Face::new((0, -1), (2, 1), (1, -1)),
    Face::new((1, 1), (0, 1), (2, 1)),
    Face::new((1, -1), (0, 1), (2, -1)),
    Face::new((2, 1), (0, 1), (1, -1)),
    Face::new((2, -1), (0, -1), (1, -1)),
];

struct Face {
    major: (usize, i32),
    s: (usize, i32),
    t: (usize, i32),
}

impl Face {
    const fn new(major: (usize, i32), s: (usize, i32), t: (usize, i32)) -> Self {
        Self { major, s, t }
    }
}

/// A component of a vector with a sign.
#[inline]
fn along(v: [f32; 3], (axis, sign): (usize, i32)) -> f32 {
    if sign < 0 { -v[axis] } else { v[axis] }
}

/// The face that a direction meets: z before y before x where they are equally long.
#[inline]
pub(crate) fn face_of([x, y, z]: [f32; 3]) -> usize {
    let [ax, ay, az] = [x.abs(), y.abs(), z.abs()];
    let (axis, value) = if az >= ay && az >= ax {
        (2, z)
    } else if ay >= ax {
        (1, y)
    } else {
        (0, x)
    };
    2 * axis + usize::from(value < 0.0)
}

/// Projects a direction onto a face: (s, t) in 0..1.
#[inline]
pub(crate) fn project(direction: [f32; 3], face: usize) -> [f32; 2] {
    let Face { major, s, t } = &FACES[face];
    let length = direction[major.0].abs();
    [*s, *t].map(|axis| along(direction, axis) / length * 0.5 + 0.5)
}

/// The derivative of [`project`] as the direction changes.
#[inline]
pub(crate) fn project_derivative(direction: [f32; 3], change: [f32; 3], face: usize) -> [f32; 2] {
    let Face { major, s, t } = &FACES[face];
    let length = direction[major.0].abs();
    let longer = along(change, *major);
    [*s, *t].map(|axis| {
        (length * along(change, axis) - along(direction, axis) * longer) / (length * length) * 0.5
    })
}

/// The face and texel of (x, y) beside a face of `n` texels, at most one texel beyond one edge;
/// `None` beyond two: three faces meet there, and there is no fourth texel.
#[inline]
pub(crate) fn across(face: i32, x: i32, y: i32, n: i32) -> Option<(i32, i32, i32)> {
    let is_inside = |at: i32| (0..n).contains(&at);
    match (is_inside(x), is_inside(y)) {
        (true, true) => return Some((face, x, y)),
        (false, false) => return None,
        _ => {}
    }
    let from = FACES.get(usize::try_from(face).ok()?)?;
    let mut point = [0; 3];
    point[from.major.0] = from.major.1 * n;
    for ((axis, sign), at) in [(from.s, x), (from.t, y)] {
        point[axis] = sign * (2 * at + 1 - n);
    }
    // The axis that is beyond becomes the major one.
    let (axis, beyond) = (0..).zip(point).find(|(_, at)| at.abs() > n)?;
    let neighbor = 2 * axis + i32::from(beyond < 0);
    point[from.major.0] = from.major.1 * (n - 1);
    let to = FACES.get(usize::try_from(neighbor).ok()?)?;
    let texel = |(axis, sign): (usize, i32)| (sign * point[axis] + n - 1) / 2;
    Some((neighbor, texel(to.s), texel(to.t)))
}
