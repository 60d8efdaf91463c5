//! Cube maps: face selection by Vulkan's table, neighbouring texels across edges by search.
//!
//! In · Out: directions · a face, (s, t) on it, and texels. Spec: NUMERICS.md, *Textures*; Vulkan
//! 1.3, *Cube Map Face Selection*.

/// The face that a direction selects: 0 to 5 for +x, −x, +y, −y, +z, −z.
#[must_use]
pub fn face(direction: [f32; 3]) -> usize {
    let [x, y, z] = direction;
    let longest = |a: f32, b: f32, c: f32| a.abs() >= b.abs() && a.abs() >= c.abs();
    if longest(z, x, y) {
        if z < 0.0 { 5 } else { 4 }
    } else if y.abs() >= x.abs() {
        if y < 0.0 { 3 } else { 2 }
    } else if x < 0.0 {
        1
    } else {
        0
    }
}

/// (sc, tc, |rc|) of a direction on a face: the columns of Vulkan's table.
#[must_use]
pub fn on_face(face: usize, [x, y, z]: [f32; 3]) -> [f32; 3] {
    match face {
        0 => [-z, -y, x],
        1 => [z, -y, -x],
        2 => [x, z, y],
        3 => [x, -z, -y],
        4 => [x, -y, z],
        _ => [-x, -y, -z],
    }
}

/// (s, t) of a direction on a face, 0 to 1 across the face.
#[must_use]
pub fn coordinates(face: usize, direction: [f32; 3]) -> [f32; 2] {
    let [sc, tc, rc] = on_face(face, direction);
    [sc, tc].map(|c| c / rc.abs() * 0.5 + 0.5)
}

/// The derivatives of (s, t) on a face if the direction's derivative is `change`.
#[must_use]
pub fn derivatives(face: usize, direction: [f32; 3], change: [f32; 3]) -> [f32; 2] {
    let [sc, tc, rc] = on_face(face, direction);
    let [d_sc, d_tc, d_rc] = on_face(face, change);
    let m = rc.abs();
    [(sc, d_sc), (tc, d_tc)].map(|(c, d)| (m * d - c * d_rc) / (m * m) * 0.5)
}

/// The centre of texel (x, y), which may lie outside the face, on a cube from −n to n.
fn centre(face: usize, x: i64, y: i64, n: i64) -> [i64; 3] {
    let (s, t) = (2 * x + 1 - n, 2 * y + 1 - n);
    match face {
        0 => [n, -t, -s],
        1 => [-n, -t, s],
        2 => [s, n, t],
        3 => [s, -n, -t],
        4 => [s, -t, n],
        _ => [-s, -t, -n],
    }
}

/// The face and texel nearest to texel (x, y) of face `of_face`. (x, y) is inside the face or one
/// texel beyond one of its edges; `None` if it is beyond two edges. All texels of the other faces'
/// outermost rows and columns are searched.
#[must_use]
pub fn neighbor(of_face: usize, x: i64, y: i64, n: i64) -> Option<(usize, i64, i64)> {
    let is_beyond = |at: i64| at < 0 || at >= n;
    match (is_beyond(x), is_beyond(y)) {
        (false, false) => return Some((of_face, x, y)),
        (true, true) => return None,
        _ => {}
    }
    let wanted = centre(of_face, x, y, n);
    let others = (0..6).filter(|&face| face != of_face);
    let texels = others.flat_map(|face| {
        let rim = (0..n).flat_map(move |k| [(k, 0), (k, n - 1), (0, k), (n - 1, k)]);
        rim.map(move |(x, y)| (face, x, y))
    });
    texels.min_by_key(|&(face, x, y)| {
        let found = centre(face, x, y, n);
        let squares = (0..3).map(|k| (found[k] - wanted[k]) * (found[k] - wanted[k]));
        squares.sum::<i64>()
    })
}
