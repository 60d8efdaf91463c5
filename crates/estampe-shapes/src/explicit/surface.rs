//! Surfaces z = f(x, y).

use std::ops::Range;

use glam::DVec3;

use super::limits;
use crate::expression::Dual;
use crate::mesh::ShapeMesh;
use crate::parametric::{Draft, Grid, Seams, SurfaceJet};

/// The surface z = f(x, y) over a grid, which faces +Z if both ranges run forwards.
///
/// Only the parts with z in `values` are kept, if there is such a range; both limits belong to it.
/// Triangles over jumps are left out: they reach up to one cell around it. Texture coordinates have
/// u along x, and v = 0 at the end of y.
#[must_use]
pub fn surface(
    [x, y]: [Range<f64>; 2],
    values: Option<&Range<f64>>,
    cells: [u32; 2],
    function: impl Fn(f64, f64) -> Dual<2>,
) -> ShapeMesh {
    let grid = Grid {
        s: x,
        t: y,
        cells,
        seams: Seams::Split,
    };
    let mut draft = Draft::new(&grid, |x, y| {
        let Dual {
            value,
            partials: [by_x, by_y],
        } = function(x, y);
        SurfaceJet {
            position: DVec3::new(x, y, value),
            s: DVec3::new(1.0, 0.0, by_x),
            t: DVec3::new(0.0, 1.0, by_y),
            // The normal (−∂f/∂x, −∂f/∂y, 1) needs no second derivatives.
            ss: DVec3::ZERO,
            st: DVec3::ZERO,
            tt: DVec3::ZERO,
        }
    });
    draft.cut_to_domain(values.is_some());
    if let Some(values) = values {
        let (low, high) = limits(values);
        draft.cut(
            |position| position.z <= high,
            |position| position.with_z(high),
        );
        draft.cut(
            |position| position.z >= low,
            |position| position.with_z(low),
        );
    }
    draft.into_mesh("surface")
}
