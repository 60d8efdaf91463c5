//! Curves: polylines in space, as lines or as tubes.

mod strands;
mod tube;

pub(crate) use strands::{curve_of, runs, sampled};
pub use tube::{DEFAULT_SIDES, tube};

use glam::{DVec3, Vec3};

/// A curve: one polyline, or several where it is interrupted or has several branches.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// The polylines.
    pub strands: Vec<Strand>,
}

/// A polyline.
#[derive(Clone, Debug, PartialEq)]
pub struct Strand {
    /// The points in order, at least two. Curves in the plane have z = 0.
    pub points: Vec<DVec3>,
    /// True if the last point is connected to the first.
    pub is_closed: bool,
}

impl Curve {
    /// The corners of the box around all points; `None` if there is no point.
    #[must_use]
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let points = || {
            self.strands
                .iter()
                .flat_map(|strand| &strand.points)
                .copied()
        };
        Some((points().reduce(DVec3::min)?, points().reduce(DVec3::max)?))
    }

    /// The length of all polylines.
    #[must_use]
    pub fn length(&self) -> f64 {
        let strands = self.strands.iter();
        strands
            .flat_map(Strand::segments)
            .map(|(from, to)| from.distance(to))
            .sum()
    }

    /// The points as an array of vertices, and the segments between them as pairs of indices.
    #[must_use]
    pub fn lines(&self) -> (Vec<Vec3>, Vec<[u32; 2]>) {
        let (mut positions, mut lines) = (Vec::new(), Vec::new());
        for strand in &self.strands {
            let first = index(positions.len());
            // Adding zero turns −0 into 0.
            positions.extend(
                strand
                    .points
                    .iter()
                    .map(|point| point.as_vec3() + Vec3::ZERO),
            );
            let last = index(positions.len() - 1);
            lines.extend((first..last).map(|at| [at, at + 1]));
            if strand.is_closed {
                lines.push([last, first]);
            }
        }
        (positions, lines)
    }
}

impl Strand {
    /// The ends of each segment.
    fn segments(&self) -> impl Iterator<Item = (DVec3, DVec3)> {
        let closing = self.points.first().filter(|_| self.is_closed);
        let nexts = self.points.iter().skip(1).chain(closing);
        self.points.iter().copied().zip(nexts.copied())
    }
}

fn index(number: usize) -> u32 {
    u32::try_from(number).expect("curves have at most 2²⁴ points")
}

#[cfg(test)]
mod tests;
