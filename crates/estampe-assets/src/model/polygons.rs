//! Splitting of polygons, with a bound on the work for all of a file's polygons together.

use estampe_shapes::polygon::Triangulator;
use glam::Vec3;

/// Splits one polygon after the other.
#[derive(Debug, Default)]
pub(super) struct Polygons {
    triangulator: Triangulator,
    triangles: Vec<[u32; 3]>,
    /// Corners squared, summed over large polygons.
    work: u64,
}

impl Polygons {
    /// Beyond this much work polygons become fans: ear clipping is quadratic for hostile ones, and
    /// a file can have many of them.
    const MAX_WORK: u64 = 1 << 32;
    /// Polygons with at most this many corners are not counted.
    const SMALL_CORNERS: usize = 64;

    /// The triangles of a polygon, as indices into `corners`. Also returns true if it is only a fan
    /// because the work is used up.
    pub(super) fn split(&mut self, corners: &[Vec3]) -> (&[[u32; 3]], bool) {
        self.triangles.clear();
        if corners.len() > Self::SMALL_CORNERS {
            self.work = self
                .work
                .saturating_add((corners.len() as u64).saturating_pow(2));
        }
        let is_spent = self.work > Self::MAX_WORK && corners.len() > Self::SMALL_CORNERS;
        if is_spent {
            let count = u32::try_from(corners.len()).unwrap_or(0);
            self.triangles.extend((2..count).map(|i| [0, i - 1, i]));
        } else {
            self.triangulator
                .triangulate_3d(corners, &mut self.triangles);
        }
        (&self.triangles, is_spent)
    }
}

/// Warning for a polygon that is only a fan.
pub(super) const SPENT: &str =
    "too many large polygons; this one becomes a fan, which is correct only if it is convex";
