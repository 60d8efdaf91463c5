//! Rung 15: Phong shading, several lights, attenuation, fog and toon shading, 400×400 each.
//!
//! Look at the highlight on the body: Gouraud shading, above left, spreads it over whole faces,
//! Phong shading beside it gives it its shape.
//!
//! `cargo run --release --example ladder_15_phong -- --model head.obj`

use estampe::{FragmentIn, FragmentOut, Mat4, Vec3, VertexIn, VertexOut};
use estampe_ladder::{Color, Corner, Course, Faces, LadderError, Picture, Screen};

/// A point light: its position, its colour, and the distance at which it ends.
#[derive(Debug, Clone, Copy)]
struct Light(Vec3<f32>, [f32; 3], f32);

#[derive(Debug, Clone)]
struct Lit {
    clip_from_world: Mat4,
    lights: Vec<Light>,
    is_lit_by_vertex: bool,
    is_toon: bool,
    fog_distance: f32,
}

const OBJECT: [f32; 3] = [0.9, 0.85, 0.75];
const FOG: Color = [150, 165, 180];
const AMBIENT: f32 = 0.1;
const DIFFUSE: f32 = 0.7;
const SPECULAR: f32 = 0.5;

estampe::varyings! {
    struct Surface<R> { position: Vec3<R>, normal: Vec3<R>, color: Vec3<R> }
}

estampe::shader! {
    impl Shader for Lit {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            VertexOut::new(self.clip_from_world.transform_point(a.position), Surface {
                position: a.position,
                normal: a.normal,
                color: self.light(a.position, a.normal),
            })
        }

        /// Phong (1975): the normal is interpolated, and the light computed at every pixel. Gouraud
        /// interpolates the light, and loses a highlight between the vertices.
        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let lit = self.light(v.position, v.normal.normalize());
            let color = if self.is_lit_by_vertex { v.color } else { lit };
            // Fog: C = (1 − γ)·C + γ·C_fog, γ = min(‖p − eye‖ / d_fog, 1).
            let gamma = (v.position.distance(Vec3::from(Course::EYE)) / self.fog_distance).min(1.0);
            let fog = FOG.map(|code| f32::from(code) / 255.0);
            FragmentOut::color(color.mix(Vec3::from(fog), gamma).point())
        }

        /// C = αa·Co + Σ a·(αd·max(n·l, 0)·Cl·Co + αs·max(r·v, 0)⁶⁴·Cl), the last where n·l > 0;
        /// r = 2(l·n)n − l, attenuation a = 1 − min(‖p − p_l‖ / d_att, 1).
        fn light<R: Real>(&self, position: Vec3<R>, normal: Vec3<R>) -> Vec3<R> {
            let to_eye = (Vec3::from(Course::EYE) - position).normalize();
            let object = Vec3::from(OBJECT);
            let mut sum = Vec3::repeat(normal.x.splat(AMBIENT)) * object;
            for &Light(at, color, reach) in &self.lights {
                let color = Vec3::from(color);
                let distance = position.distance(at);
                let l = (at - position) / distance;
                let attenuation = 1.0 - (distance / reach).min(1.0);
                let n_l = normal.dot(l).max(0.0);
                // Toon: the same in four levels, and no highlight.
                let n_l = if self.is_toon { (n_l * 4.0).floor().min(3.0) / 3.0 } else { n_l };
                let r = normal * (2.0 * n_l) - l;
                let shine = R::select(n_l.gt(0.0), r.dot(to_eye).max(0.0), n_l).pow(n_l.splat(64.0));
                let shine = if self.is_toon { n_l.splat(0.0) } else { shine };
                sum += (color * object * (n_l * DIFFUSE) + color * (shine * SPECULAR)) * attenuation;
            }
            sum
        }
    }
}

/// Above: Gouraud, Phong, three lights. Below: attenuation, fog, toon.
///
/// # Errors
/// If the model does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let white = Light(Vec3::new(-1.0, 2.0, 4.0), [1.0; 3], f32::INFINITY);
    let phong = Lit {
        clip_from_world: Course::camera(),
        lights: vec![white],
        is_lit_by_vertex: false,
        is_toon: false,
        fog_distance: f32::INFINITY,
    };
    let light = |x, y, z, color| Light(Vec3::new(x, y, z), color, f32::INFINITY);
    let three = vec![
        light(-4.0, 2.0, 2.0, [1.0, 0.2, 0.1]),
        light(1.0, 4.0, 2.0, [0.1, 0.9, 0.2]),
        light(5.0, 0.0, 2.0, [0.2, 0.3, 1.0]),
    ];
    let near = vec![Light(Vec3::new(0.9, 0.6, 1.3), [1.5; 3], 2.4)];
    let screen = Screen::new(course, 400, 400)?;
    let faces = Faces::new(&course.device, &course.model)?;
    let mut gouraud = phong.clone();
    gouraud.is_lit_by_vertex = true;
    let [mut several, mut attenuated, mut foggy, mut toon] = [(); 4].map(|()| phong.clone());
    several.lights = three;
    attenuated.lights = near;
    foggy.fog_distance = 3.2;
    toon.is_toon = true;
    let panel = |lit: Lit| {
        let background = if lit.fog_distance.is_finite() {
            FOG
        } else {
            Picture::BLACK
        };
        let pipeline = course
            .device
            .create_render_pipeline(&screen.pipeline(lit))?;
        screen.draw_over(background, &[faces.draw(&pipeline)])
    };
    let panels = [gouraud, phong, several, attenuated, foggy, toon].map(panel);
    let panels: Result<Vec<_>, LadderError> = panels.into_iter().collect();
    Ok(Picture::in_columns(3, &panels?))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(15, draw)
}
