//! Rung 22 against a shader in Rust with the same formulas, and the message about a mistake in it.

use estampe::{
    Device, DeviceDescriptor, FragmentIn, FragmentOut, Mat4, ShaderModuleDescriptor, ShaderSource,
    Vec3, VertexIn, VertexOut,
};
use estampe_ladder::{Corner, Course, Faces, Screen, rung};

const VERTEX: &str = include_str!("../examples/ladder_22_glsl.vert");
const FRAGMENT: &str = include_str!("../examples/ladder_22_glsl.frag");

/// C = 0.25·Co + 0.7·max(n·l, 0)·Co + 0.5·max(r·v, 0)⁶⁴, Co = (p + 1)/2, seen by rung 12's camera.
#[derive(Debug)]
struct Lit {
    clip_from_world: Mat4,
}

estampe::varyings! {
    struct Surface<R> { position: Vec3<R>, normal: Vec3<R> }
}

estampe::shader! {
    impl Shader for Lit {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            let clip = self.clip_from_world.transform_point(a.position);
            VertexOut::new(clip, Surface { position: a.position, normal: a.normal })
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let n = v.normal.normalize();
            let l = (Vec3::new(-1.0, 2.0, 4.0) - v.position).normalize();
            let to_eye = (Vec3::from(Course::EYE) - v.position).normalize();
            let n_l = n.dot(l).max(0.0);
            let r = n * (2.0 * n_l) - l;
            let shine = R::select(n_l.gt(0.0), r.dot(to_eye).max(0.0), n_l).pow(n_l.splat(64.0));
            let object = v.position * 0.5 + Vec3::repeat(n_l.splat(0.5));
            let color = object * (n_l * 0.7 + 0.25) + Vec3::repeat(shine * 0.5);
            FragmentOut::color(color.point())
        }
    }
}

/// The transforms differ by rounding, and so do pixels at edges.
///
/// Rows: G1, L1.
#[test]
fn the_shaders_draw_what_the_same_formulas_in_rust_do() {
    let course = Course::new().expect("the system starts threads");
    let whole = (rung(22).expect("the rung exists").draw)(&course).expect("it draws");
    let glsl = whole.cropped([0, 408], [400, 400]);
    let screen = Screen::new(&course, 400, 400).expect("a small picture");
    let faces = Faces::new(&course.device, &course.model).expect("a small model");
    let clip_from_world = Course::camera();
    let rust = screen.show(Lit { clip_from_world }, &faces);
    let rust = rust.expect("a valid shader");
    let (mut lit, mut other) = (0, 0);
    for y in 0..400 {
        for x in 0..400 {
            let (a, b) = (glsl.pixel([x, y]), rust.pixel([x, y]));
            lit += u32::from(b != [0; 3]);
            other += u32::from((0..3).any(|k| a[k].abs_diff(b[k]) > 1));
        }
    }
    assert!(lit > 40_000, "{lit} pixels are lit");
    assert!(other * 1000 < lit, "{other} of {lit} pixels differ");
}

/// The course prints the fragment shader without the declaration of its factors.
///
/// Rows: G1.
#[test]
fn a_name_that_is_not_declared_is_shown_with_its_line() {
    let declaration = "uniform float a_ambient, a_diffuse, a_specular;\n";
    let printed = FRAGMENT.replace(declaration, "");
    assert!(printed.len() < FRAGMENT.len());
    let is_use = |line: &str| line.contains("a_ambient *");
    let line = 1 + printed.lines().position(is_use).expect("it is used");
    let device = Device::new(&DeviceDescriptor::default()).expect("the system starts threads");
    let module = device.create_shader_module(&ShaderModuleDescriptor {
        label: Some("ladder_22_glsl"),
        ..ShaderModuleDescriptor::new(ShaderSource::Glsl {
            vertex: VERTEX,
            fragment: &printed,
        })
    });
    let message = module.expect_err("a name is not declared").to_string();
    for part in [
        format!("ladder_22_glsl (fragment):{line}:14"),
        "a_ambient".to_owned(),
        "    vec3 c = a_ambient * fragment.color * light_color;".to_owned(),
    ] {
        assert!(message.contains(&part), "{message}");
    }
}
