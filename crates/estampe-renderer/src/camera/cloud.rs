//! The points that a camera is fitted to.

use super::fit::FrameTangents;
use estampe_scene::{Workers, pieces};
use glam::DVec3;

/// Points, in pieces that threads share. Only minima and maxima are computed of them, so results
/// depend neither on the pieces nor on the number of threads.
#[derive(Debug, Clone, Default)]
pub struct Cloud {
    pieces: Vec<Vec<DVec3>>,
    workers: Workers,
}

impl Cloud {
    /// A cloud with the points that `of_item` returns for each item.
    pub(crate) fn new<T: Send>(
        items: impl IntoIterator<Item = T>,
        of_item: impl Fn(T) -> Vec<DVec3> + Sync,
        workers: Workers,
    ) -> Self {
        Self {
            pieces: workers.map(items, of_item),
            workers,
        }
    }

    /// The cloud with more points.
    pub(crate) fn with(mut self, points: &[DVec3]) -> Self {
        self.pieces.push(points.to_vec());
        self
    }

    /// All points, in order.
    pub fn iter(&self) -> impl Iterator<Item = &DVec3> {
        self.pieces.iter().flatten()
    }

    /// Calls a function for each piece, on several threads; the results are in order.
    pub(super) fn map_pieces<R: Send>(&self, of_piece: impl Fn(&[DVec3]) -> R + Sync) -> Vec<R> {
        self.workers.map(&self.pieces, |piece| of_piece(piece))
    }

    /// Replaces each point.
    pub(super) fn transform(&mut self, to: impl Fn(DVec3) -> DVec3 + Sync) {
        self.workers.map(&mut self.pieces, |piece| {
            for point in piece {
                *point = to(*point);
            }
        });
    }

    /// The extent of the points for the fit; `None` if there are none.
    pub(super) fn reach(&self, k: FrameTangents) -> Option<Reach> {
        let of_pieces = self.workers.map(&self.pieces, |piece| {
            piece.iter().fold(Reach::NONE, |reach, p| reach.with(p, k))
        });
        self.iter().next()?;
        of_pieces.into_iter().reduce(Reach::union)
    }
}

impl From<&[DVec3]> for Cloud {
    fn from(points: &[DVec3]) -> Self {
        /// Points of a piece: some hundred microseconds of work.
        const PIECE: usize = 1 << 15;
        Self {
            pieces: pieces(points.len(), PIECE)
                .map(|range| points[range].to_vec())
                .collect(),
            workers: Workers::default(),
        }
    }
}

impl From<&Vec<DVec3>> for Cloud {
    fn from(points: &Vec<DVec3>) -> Self {
        points.as_slice().into()
    }
}

/// Maxima over points p in view-aligned coordinates, for tangents k; see the module `fit`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    /// Maximum of each coordinate of p.
    pub(super) most: DVec3,
    /// Minimum of each coordinate of p.
    pub(super) least: DVec3,
    /// Maximum of pₓ + kₓ·p_z.
    pub(super) right: f64,
    /// Maximum of −pₓ + kₓ·p_z.
    pub(super) left: f64,
    /// Maximum of p_y + k_y·p_z.
    pub(super) top: f64,
    /// Maximum of −p_y + k_y·p_z.
    pub(super) bottom: f64,
}

impl Reach {
    const NONE: Self = Self {
        most: DVec3::NEG_INFINITY,
        least: DVec3::INFINITY,
        right: f64::NEG_INFINITY,
        left: f64::NEG_INFINITY,
        top: f64::NEG_INFINITY,
        bottom: f64::NEG_INFINITY,
    };

    #[inline]
    fn with(self, p: &DVec3, k: FrameTangents) -> Self {
        let (x, y) = (k.x * p.z, k.y * p.z);
        self.union(Self {
            most: *p,
            least: *p,
            right: p.x + x,
            left: x - p.x,
            top: p.y + y,
            bottom: y - p.y,
        })
    }

    #[inline]
    fn union(self, other: Self) -> Self {
        Self {
            most: self.most.max(other.most),
            least: self.least.min(other.least),
            right: self.right.max(other.right),
            left: self.left.max(other.left),
            top: self.top.max(other.top),
            bottom: self.bottom.max(other.bottom),
        }
    }
}
