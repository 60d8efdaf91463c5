//! Inputs of fragments: every interpolation, position, facing and derivatives.

use estampe_tests::geometry::{Style, triangles, vertex_buffer};
use estampe_tests::shaders::{Probe, Scalar};
use estampe_tests::{Case, CaseDraw, check};
use estampe_types::state::{FrontFace, PrimitiveTopology};

fn check_scalar(name: &str, scalar: Scalar) {
    check(&format!("varyings/{name}"), 12, |random| {
        let mut case = Case::random_target(random);
        let style = random.pick(&[
            Style::Large,
            Style::Small,
            Style::AcrossDepths,
            Style::AroundEye,
            Style::Huge,
        ]);
        let vertices = triangles(random, style, case.size, 6);
        let mut draw = CaseDraw::new(Probe(scalar), &vertices);
        draw.primitive.front_face = random.pick(&[FrontFace::Ccw, FrontFace::Cw]);
        draw.primitive.topology = random.pick(&[
            PrimitiveTopology::TriangleList,
            PrimitiveTopology::TriangleList,
            PrimitiveTopology::TriangleFan,
            PrimitiveTopology::LineList,
        ]);
        case.draws.push(draw);
        case
    });
}

macro_rules! scalars {
    ($($name:ident: $scalar:ident;)+) => {
        $(#[test]
        fn $name() {
            check_scalar(stringify!($name), Scalar::$scalar);
        })+
    };
}
scalars! {
    smooth: Smooth;
    no_perspective: NoPerspective;
    flat: Flat;
    x: X;
    y: Y;
    z: Z;
    inverse_w: InverseW;
    fine_derivative_in_x: Ddx;
    fine_derivative_in_y: Ddy;
    coarse_derivative_in_x: DdxCoarse;
    coarse_derivative_in_y: DdyCoarse;
    slope_of_depth: DepthSlope;
    front_facing: FrontFacing;
}

/// Rows: R5.
#[test]
fn nan_infinite_and_huge_values() {
    check("varyings/odd", 40, |random| {
        let mut case = Case::random_target(random);
        let mut vertices = triangles(random, Style::Large, case.size, 6);
        for vertex in &mut vertices {
            vertex.values = [0; 4].map(|_| random.odd_number());
        }
        let shown = [
            Scalar::Smooth,
            Scalar::NoPerspective,
            Scalar::Flat,
            Scalar::Ddx,
        ];
        let mut draw = CaseDraw::new(Probe(random.pick(&shown)), &vertices);
        draw.buffers[0].1 = vertex_buffer(&vertices);
        case.draws.push(draw);
        case
    });
}
