//! Random polygons with integer corners.

use fastrand::Rng;
use glam::Vec2;

use crate::polygon::arrangement::Corner;

/// The kinds of random polygons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Kind {
    /// Any corners: edges cross, touch and coincide.
    Any,
    /// Corners of a tiny grid, so that nearly everything touches.
    Tiny,
    /// Corners on a circle, in order.
    Convex,
    /// Corners around a point at any distance.
    Star,
    /// A star with smaller rings inside, of either winding.
    Holes,
    /// Long and thin, with all corners near a line.
    Needle,
    /// Edges parallel to the axes.
    Steps,
}

impl Kind {
    pub(super) const ALL: [Self; 7] = [
        Self::Any,
        Self::Tiny,
        Self::Convex,
        Self::Star,
        Self::Holes,
        Self::Needle,
        Self::Steps,
    ];

    /// A random polygon with coordinates from 0 to `size`.
    pub(super) fn rings(self, size: i64, random: &mut Rng) -> Vec<Vec<Corner>> {
        let count = random.usize(3..10);
        let mut any = |low: i64, high: i64| random.i64(low..=high);
        match self {
            Self::Any => vec![(0..count).map(|_| [any(0, size), any(0, size)]).collect()],
            Self::Tiny => vec![(0..count).map(|_| [any(0, 3), any(0, 3)]).collect()],
            Self::Convex => vec![star(count, size, random, 1.0)],
            Self::Star => vec![star(count, size, random, 0.2)],
            Self::Holes => {
                let mut rings = vec![star(count, size, random, 0.6)];
                for _ in 0..random.usize(1..4) {
                    let part = star(random.usize(3..6), size / 4, random, 0.5);
                    let mut any = || random.i64(0..=size * 3 / 4);
                    let (x, y) = (any(), any());
                    let mut ring: Vec<Corner> = part.iter().map(|c| [c[0] + x, c[1] + y]).collect();
                    if random.bool() {
                        ring.reverse();
                    }
                    rings.push(ring);
                }
                rings
            }
            Self::Needle => {
                let slope = any(-2, 2);
                let near =
                    |x: i64, random: &mut Rng| [x, size / 2 + x * slope / 4 + random.i64(-1..=1)];
                vec![
                    (0..count)
                        .map(|_| near(random.i64(0..=size), random))
                        .collect(),
                ]
            }
            Self::Steps => {
                let mut ring: Vec<Corner> = vec![[any(0, size), any(0, size)]];
                for i in 0..2 * (count / 2) {
                    let mut next = ring[ring.len() - 1];
                    next[i % 2] = any(0, size);
                    ring.push(next);
                }
                vec![ring]
            }
        }
    }
}

/// Corners around the middle, in order, at distances from `least` to 1 of the half size.
fn star(count: usize, size: i64, random: &mut Rng, least: f64) -> Vec<Corner> {
    let half = size as f64 / 2.0;
    let mut turns: Vec<f64> = (0..count).map(|_| random.f64()).collect();
    turns.sort_by(f64::total_cmp);
    let corner = |turns: f64| {
        let (cos, sin) = crate::parametric::cos_sin_turns(turns);
        let radius = half * (least + (1.0 - least) * random.f64());
        [cos, sin].map(|x| nearest(half + x * radius))
    };
    turns.into_iter().map(corner).collect()
}

#[expect(clippy::cast_possible_truncation, reason = "coordinates are small")]
fn nearest(x: f64) -> i64 {
    libm::rint(x) as i64
}

/// The rings in f32, multiplied by `scale`.
pub(super) fn in_f32(rings: &[Vec<Corner>], scale: f32) -> Vec<Vec<Vec2>> {
    let corner = |&[x, y]: &Corner| Vec2::new(x as f32, y as f32) * scale;
    rings
        .iter()
        .map(|ring| ring.iter().map(corner).collect())
        .collect()
}

/// The rings as slices.
pub(super) fn slices(rings: &[Vec<Vec2>]) -> Vec<&[Vec2]> {
    rings.iter().map(Vec::as_slice).collect()
}
