//! Bicubic patches: points, derivatives, normals, subdivision, meshes.

use glam::DVec3;

use super::cubic::{CurveParameter, cubic_derivative, cubic_point, cubic_second_derivative};
use super::curve::split_cubic;
use crate::mesh::ShapeMesh;
use crate::parametric::{Grid, Seams, SurfaceJet, sheet};

/// A bicubic patch: four rows along s, of four control points along t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BicubicPatch {
    /// `control[i][j]` belongs to Bᵢ(s) Bⱼ(t).
    pub control: [[DVec3; 4]; 4],
}

impl BicubicPatch {
    /// The point S(s, t).
    #[must_use]
    pub fn point(&self, s: CurveParameter, t: CurveParameter) -> DVec3 {
        cubic_point(self.control.map(|row| cubic_point(row, t)), s)
    }

    /// The derivative ∂S/∂s.
    #[must_use]
    pub fn derivative_s(&self, s: CurveParameter, t: CurveParameter) -> DVec3 {
        cubic_derivative(self.control.map(|row| cubic_point(row, t)), s)
    }

    /// The derivative ∂S/∂t.
    #[must_use]
    pub fn derivative_t(&self, s: CurveParameter, t: CurveParameter) -> DVec3 {
        cubic_point(self.control.map(|row| cubic_derivative(row, t)), s)
    }

    /// The mixed derivative ∂²S/∂s∂t.
    #[must_use]
    pub fn derivative_st(&self, s: CurveParameter, t: CurveParameter) -> DVec3 {
        cubic_derivative(self.control.map(|row| cubic_derivative(row, t)), s)
    }

    /// The point with its first and second derivatives.
    #[must_use]
    pub fn jet(&self, s: CurveParameter, t: CurveParameter) -> SurfaceJet {
        let points = self.control.map(|row| cubic_point(row, t));
        SurfaceJet {
            position: cubic_point(points, s),
            s: self.derivative_s(s, t),
            t: self.derivative_t(s, t),
            ss: cubic_second_derivative(points, s),
            st: self.derivative_st(s, t),
            tt: cubic_point(self.control.map(|row| cubic_second_derivative(row, t)), s),
        }
    }

    /// The unit normal, on the side of ∂S/∂t × ∂S/∂s; zero where it is not defined.
    ///
    /// If the row s = 0 is a single point, ∂S/∂t vanishes there. Near it ∂S/∂t grows as s ·
    /// ∂²S/∂s∂t, so the limit of the normal's direction is that of ∂²S/∂s∂t × ∂S/∂s. On the other
    /// borders that may be a point, and where derivatives vanish for other reasons, the limit on
    /// the way into the patch is that of [`SurfaceJet::normal`], or of a point nearby.
    ///
    /// ```text
    ///        ∂S/∂t ◀──┬ normal: towards the reader
    ///                 │
    ///                 ▼ ∂S/∂s
    /// ```
    #[must_use]
    pub fn normal(&self, s: CurveParameter, t: CurveParameter) -> DVec3 {
        let along_s = self.derivative_s(s, t);
        let along_t = self.derivative_t(s, t);
        let normal = along_t.cross(along_s);
        // A product of lengths that is this much smaller than the patch is rounding error, not
        // direction.
        let scale = along_s.length_squared() + along_t.length_squared();
        if normal.length() > 1e-9 * scale {
            return normal.normalize();
        }
        let way = |parameter: CurveParameter| if parameter.t() < 0.5 { 1.0 } else { -1.0 };
        let (into_s, into_t) = (way(s), way(t));
        if along_t.length_squared() <= 1e-18 * scale {
            let limit = (self.derivative_st(s, t) * into_s).cross(along_s);
            if limit.length() > 1e-9 * scale {
                return limit.normalize();
            }
        }
        let near = |step: f64| {
            let [s, t] = [(s, into_s), (t, into_t)]
                .map(|(parameter, way)| CurveParameter::new(parameter.t() + step * way));
            self.turned_jet(s, t).normal([into_t, into_s])
        };
        let here = self.turned_jet(s, t).normal([into_t, into_s]);
        here.or_else(|| [1e-6, 1e-4, 1e-3].into_iter().find_map(near))
            .unwrap_or(DVec3::ZERO)
    }

    /// The jet with s and t exchanged, whose normal has this patch's side.
    fn turned_jet(&self, s: CurveParameter, t: CurveParameter) -> SurfaceJet {
        let jet = self.jet(s, t);
        SurfaceJet {
            s: jet.t,
            t: jet.s,
            ss: jet.tt,
            tt: jet.ss,
            ..jet
        }
    }

    /// The patches over s in [0, `at`] and [`at`, 1], by de Casteljau's scheme on each column.
    #[must_use]
    pub fn split_s(&self, at: f64) -> [Self; 2] {
        let mut halves = [Self {
            control: [[DVec3::ZERO; 4]; 4],
        }; 2];
        for column in 0..4 {
            let parts = split_cubic(self.control.map(|row| row[column]), at);
            for (half, part) in halves.iter_mut().zip(parts) {
                for (row, point) in half.control.iter_mut().zip(part) {
                    row[column] = point;
                }
            }
        }
        halves
    }

    /// The patches over t in [0, `at`] and [`at`, 1], by de Casteljau's scheme on each row.
    #[must_use]
    pub fn split_t(&self, at: f64) -> [Self; 2] {
        let rows = self.control.map(|row| split_cubic(row, at));
        [0, 1].map(|half| Self {
            control: rows.map(|parts| parts[half]),
        })
    }

    /// The mesh of the patch, with `cells` along s and t; its outside is that of [`Self::normal`].
    ///
    /// Borders that are a point, and borders that meet, are closed ([`Seams`]). Texture coordinates
    /// have u along t and v = 0 at s = 1.
    #[must_use]
    pub fn mesh(&self, cells: [u32; 2], seams: Seams) -> ShapeMesh {
        let [cells_s, cells_t] = cells;
        let grid = Grid {
            s: 0.0..1.0,
            t: 0.0..1.0,
            cells: [cells_t, cells_s],
            seams,
        };
        sheet("patch", &grid, |t, s| {
            self.turned_jet(CurveParameter::new(s), CurveParameter::new(t))
        })
    }
}
