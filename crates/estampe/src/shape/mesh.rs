//! From a function and its grid to a curve or a surface.

use super::function::Function;
use super::grid::Grid;
use crate::failure::Failure;
use estampe_shapes::ShapeMesh;
use estampe_shapes::curve::{Curve, DEFAULT_SIDES, tube};
use estampe_shapes::expression::{Expression, Jet};
use estampe_shapes::parametric::{self, Seams, SurfaceJet};
use estampe_shapes::{explicit, implicit};
use glam::DVec3;

/// A meshed function.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Meshed {
    pub(super) form: Form,
    /// Places inside the ranges at which an implicit curve or surface is open.
    pub(super) interruptions: u64,
}

/// A curve or a surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Form {
    Curve(Curve),
    Surface(ShapeMesh),
}

/// Meshes a function; an error if there is nothing to mesh.
pub(super) fn mesh(function: &Function, grid: &Grid, seams: Seams) -> Result<Meshed, Failure> {
    let mut interruptions = 0;
    let implicit_error = |error: implicit::ImplicitError| Failure::Input(error.to_string());
    let form = match function {
        Function::ExplicitCurve(y) => {
            let (x, values) = (grid.range(0), grid.values.as_ref());
            Form::Curve(explicit::curve(&x, values, grid.cells[0], |x| y.dual([x])))
        }
        Function::ExplicitSurface(z) => {
            let ranges = [grid.range(0), grid.range(1)];
            let cells = [grid.cells[0], grid.cells[1]];
            let values = grid.values.as_ref();
            Form::Surface(explicit::surface(ranges, values, cells, |x, y| {
                z.dual([x, y])
            }))
        }
        Function::ParametricCurve(coordinates, variable) => {
            Form::Curve(parametric_curve(coordinates, *variable, grid))
        }
        Function::ParametricSurface(coordinates) => {
            let grid = parametric::Grid {
                s: grid.range(0),
                t: grid.range(1),
                cells: [grid.cells[0], grid.cells[1]],
                seams,
            };
            let point = |s, t| surface_jet(coordinates, [s, t]);
            Form::Surface(parametric::sheet("surface", &grid, point))
        }
        Function::ImplicitCurve(value) => {
            let bounds = [grid.range(0), grid.range(1)];
            let cells = [grid.cells[0], grid.cells[1]];
            let meshed = implicit::curve(&bounds, cells, |p| value.value(&p.to_array()));
            let meshed = meshed.map_err(implicit_error)?;
            interruptions = meshed.interruptions;
            Form::Curve(meshed.curve)
        }
        Function::ImplicitSurface(value) => {
            let bounds = [grid.range(0), grid.range(1), grid.range(2)];
            let cells = [grid.cells[0], grid.cells[1], grid.cells[2]];
            let meshed = implicit::surface(
                &bounds,
                cells,
                |p| value.value(&p.to_array()),
                |p| DVec3::from_array(value.dual(p.to_array()).partials),
            );
            let meshed = meshed.map_err(implicit_error)?;
            interruptions = meshed.interruptions;
            Form::Surface(meshed.mesh)
        }
    };
    if form.is_empty() {
        return Err(nothing(function, interruptions));
    }
    Ok(Meshed {
        form,
        interruptions,
    })
}

impl Form {
    fn is_empty(&self) -> bool {
        match self {
            Self::Curve(curve) => curve.strands.is_empty(),
            Self::Surface(mesh) => mesh.triangles.is_empty(),
        }
    }

    /// A curve becomes a tube of this radius; without one, of 0.5 % of its extent.
    pub(super) fn into_tube(self, radius: Option<f64>) -> Self {
        /// In a picture of 1024 pixels a line of about 10 pixels.
        const SHARE: f64 = 0.005;
        /// A tube of more than this share shows the corners of its rings.
        const THICK_SHARE: f64 = 0.02;
        match self {
            Self::Curve(curve) => {
                let extent = curve
                    .bounds()
                    .map_or(0.0, |(low, high)| (high - low).length());
                let radius = radius.unwrap_or(SHARE * extent);
                let is_thick = radius > THICK_SHARE * extent;
                let sides = if is_thick {
                    3 * DEFAULT_SIDES
                } else {
                    DEFAULT_SIDES
                };
                Self::Surface(tube(&curve, radius, sides))
            }
            surface @ Self::Surface(_) => surface,
        }
    }
}

fn parametric_curve(coordinates: &[Expression], variable: usize, grid: &Grid) -> Curve {
    parametric::curve(&grid.range(0), grid.cells[0], |parameter| {
        let mut arguments = [0.0; 2];
        arguments[variable] = parameter;
        let (mut position, mut slope) = (DVec3::ZERO, DVec3::ZERO);
        for (axis, coordinate) in coordinates.iter().enumerate() {
            let dual = coordinate.dual(arguments);
            (position[axis], slope[axis]) = (dual.value, dual.partials[variable]);
        }
        (position, slope)
    })
}

fn surface_jet(coordinates: &[Expression; 3], at: [f64; 2]) -> SurfaceJet {
    let jets = coordinates.each_ref().map(|coordinate| coordinate.jet(at));
    let vector = |of: fn(&Jet) -> f64| DVec3::from_array(jets.each_ref().map(of));
    SurfaceJet {
        position: vector(|jet| jet.value),
        s: vector(|jet| jet.partials[0]),
        t: vector(|jet| jet.partials[1]),
        ss: vector(|jet| jet.seconds[0]),
        st: vector(|jet| jet.seconds[1]),
        tt: vector(|jet| jet.seconds[2]),
    }
}

/// The error of a function without anything to mesh.
fn nothing(function: &Function, interruptions: u64) -> Failure {
    let kind = function.kind();
    Failure::Input(match function {
        Function::ImplicitCurve(_) | Function::ImplicitSurface(_) if interruptions > 0 => format!(
            "the {kind} is empty: the function changes its sign only where it jumps, has a pole or \
             is not defined; choose another --range or function"
        ),
        Function::ImplicitCurve(_) | Function::ImplicitSurface(_) => format!(
            "the {kind} is empty: the function does not change its sign in these ranges; choose \
             another --range or a higher --resolution"
        ),
        Function::ExplicitCurve(_) | Function::ExplicitSurface(_) => format!(
            "the {kind} is empty: the function is not defined in these ranges, all of its values are \
             outside of theirs, or its points coincide as 32-bit floats; choose another --range"
        ),
        Function::ParametricCurve(..) | Function::ParametricSurface(_) => format!(
            "the {kind} is empty: its points coincide, or are not defined in these ranges; choose \
             another --range"
        ),
    })
}
