//! Rung 23: shapes from formulas, 260×260 each: explicit, parametric and implicit surfaces and
//! curves, and polygons in triangles.
//!
//! Look at the white edges: they divide the polygons into triangles. The pentagram's middle and
//! the hole of the square are inside by one rule and outside by the other.
//!
//! `cargo run --release --example ladder_23_shapes`

use estampe::Mat4;
use estampe_ladder::{Course, Faces, LadderError, Lit, Model, Picture, Screen};
use estampe_shapes::expression::Expression;
use estampe_shapes::polygon::{FillRule, triangulate_rings};
use estampe_shapes::{ShapeMesh, explicit, implicit, parametric};
use glam::{DVec2, DVec3, Vec2};
use std::f64::consts::TAU;

const SIZE: u32 = 260;

/// z = f(x, y) over a grid, turned so that z is up. The normal is (−∂f/∂x, −∂f/∂y, 1).
fn explicit_surface() -> Result<ShapeMesh, LadderError> {
    let f = Expression::parse("cos(4*(x^2 + y^2)) / (1 + x^2 + y^2) / 2", &["x", "y"])?;
    let square = [-1.5..1.5, -1.5..1.5];
    let mut mesh = explicit::surface(square, None, [64, 64], |x, y| f.dual([x, y]));
    for vector in mesh.positions.iter_mut().chain(&mut mesh.normals) {
        *vector = glam::vec3(vector.x, vector.z, -vector.y);
    }
    Ok(mesh)
}

/// S(s, t): a circle of parameter t that grows with s, while it goes three times around the y axis
/// and down. The normal ∂S/∂t × ∂S/∂s is found by differences.
fn parametric_surface() -> ShapeMesh {
    let shell = |s: f64, t: f64| {
        let [(cos_a, sin_a), (cos_b, sin_b)] = [3.0 * s, t].map(parametric::cos_sin_turns);
        let radius = s * (1.0 + cos_b);
        DVec3::new(radius * cos_a, s * sin_b + 2.2 * (1.0 - s), radius * sin_a)
    };
    parametric::surface("shell", 0.02..1.0, 0.0..1.0, [160, 32], |s, t| {
        let jet = parametric::numeric_jet(shell, [s, t], [1e-5; 2]);
        parametric::SurfacePoint {
            position: jet.position,
            normal: jet.t.cross(jet.s).normalize_or_zero(),
        }
    })
}

/// F(x, y, z) = 0 by marching tetrahedra. The normal is the gradient of F.
fn implicit_surface() -> Result<ShapeMesh, LadderError> {
    let f = Expression::parse("x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 0.4", &["x", "y", "z"])?;
    let cube = [-1.2..1.2, -1.2..1.2, -1.2..1.2];
    let gradient = |p: DVec3| DVec3::from(f.dual(p.to_array()).partials);
    let surface = implicit::surface(&cube, [24; 3], |p| f.value(&p.to_array()), gradient)?;
    Ok(surface.mesh)
}

/// In red y = f(x), in green (x(t), y(t)), in white F(x, y) = 0.
fn curves() -> Result<Picture, LadderError> {
    let sine = Expression::parse("sin(9*x) / 2", &["x"])?;
    let figure = Expression::parse_list("0.9*sin(3*t), 0.9*sin(2*t)", &["t"])?;
    let lemniscate = Expression::parse_equation("(x^2 + y^2)^2 = x^2 - y^2", &["x", "y"])?;

    let explicit = explicit::curve(&(-1.0..1.0), None, 200, |x| sine.dual([x]));
    let parametric = parametric::curve(&(0.0..TAU), 300, |t| {
        let [x, y] = [0, 1].map(|k: usize| figure[k].dual([t]));
        let slope = DVec3::new(x.partials[0], y.partials[0], 0.0);
        (DVec3::new(x.value, y.value, 0.0), slope)
    });
    let square = [-1.1..1.1, -1.1..1.1];
    let value = |p: DVec2| lemniscate.value(&p.to_array());
    let implicit = implicit::curve(&square, [64, 64], value)?.curve;

    let mut picture = Picture::new(SIZE, SIZE);
    picture.curve(&explicit, Picture::RED);
    picture.curve(&parametric, Picture::GREEN);
    picture.curve(&implicit, Picture::WHITE);
    Ok(picture.flipped())
}

/// A pentagram, which crosses itself, and a square with a hole, by a rule for what is inside; with
/// the edges of their triangles.
fn polygons(rule: FillRule) -> Result<Picture, LadderError> {
    let star: Vec<Vec2> = (0..5)
        .map(|k| {
            let (c, s) = parametric::cos_sin_turns(f64::from(k) * 0.4 + 0.25);
            DVec2::new(c * 0.5 - 0.4, s * 0.5 + 0.4).as_vec2()
        })
        .collect();
    let ring = |a: f32| {
        [[-a, -a], [a, -a], [a, a], [-a, a]].map(|p| Vec2::from(p) + Vec2::new(0.45, -0.45))
    };
    let (outer, inner) = (ring(0.45), ring(0.2));
    let filled = triangulate_rings(&[&star, &outer, &inner], rule)?;
    let corner = |&at: &u32| filled.vertices[at as usize];
    let mut picture = Picture::new(SIZE, SIZE);
    for triangle in &filled.triangles {
        picture.fill(triangle.each_ref().map(corner), [70, 110, 170]);
    }
    for triangle in &filled.triangles {
        picture.outline(&triangle.each_ref().map(corner), Picture::WHITE);
    }
    Ok(picture.flipped())
}

/// Above: explicit, parametric and implicit surface. Below: three such curves; polygons by the
/// even-odd rule, and by the non-zero rule, for which the hole, wound like its square, is none.
///
/// # Errors
/// If a shape does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let screen = Screen::new(course, SIZE, SIZE)?;
    let panel = |shape: ShapeMesh| {
        let faces = Faces::new(&course.device, &Model::of_shape(shape))?;
        let clip_from_world = Course::camera() * Mat4::scale([0.7; 3]);
        screen.show(Lit { clip_from_world }, &faces)
    };
    let panels = [
        panel(explicit_surface()?)?,
        panel(parametric_surface())?,
        panel(implicit_surface()?)?,
        curves()?,
        polygons(FillRule::EvenOdd)?,
        polygons(FillRule::NonZero)?,
    ];
    Ok(Picture::in_columns(3, &panels))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(23, draw)
}
