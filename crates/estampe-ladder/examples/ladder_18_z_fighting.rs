//! Rung 18: z-fighting of two planes 2 cm apart, far = 100 m, and its cures, 240×240 each.
//!
//! Look for red, the lower plane: where it shows through the blue one, both depths were rounded to
//! the same value, or to the wrong order.
//!
//! `cargo run --release --example ladder_18_z_fighting`

use estampe::TextureFormat::{self, Depth16Unorm, Depth24Plus, Depth32Float};
use estampe::{FragmentIn, FragmentOut, Mat4, Vec3, VertexIn, VertexOut};
use estampe_ladder::{Corner, Course, Faces, LadderError, Model, Picture, Screen};

const FAR: f32 = 100.0;

/// A horizontal square of 56 m at a height, with stripes.
struct Plane {
    clip_from_world: Mat4,
    height: f32,
    color: [f32; 3],
}

estampe::shader! {
    impl Shader for Plane {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = R; // z

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, R> {
            let z = a.position.z * 28.0 - 32.0;
            let at = Vec3::new(a.position.x * 28.0, z * 0.0 + self.height, z);
            VertexOut::new(self.clip_from_world.transform_point(at), z)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, z: R) -> FragmentOut<R> {
            let is_bright = (z * 0.1).fract().lt(0.5);
            let light = R::select(is_bright, input.real(1.0), input.real(0.8));
            FragmentOut::color((Vec3::from(self.color) * light).point())
        }
    }
}

/// The distances of the planes and of the near plane, the depth format, and the farthest depth: 1,
/// or 0 where z is reversed.
type Scene = (f32, f32, TextureFormat, f32);

/// Depth is d = far·(z − near) / (z·(far − near)) at the distance z. Steps of 2⁻ᵇ in d are steps of
///
/// ```text
///   Δz ≈ z² / (near · 2ᵇ)       24 bits, z = 50: near = 0.01 → 1.5 cm, 10⁻⁴ → 1.5 m, 10⁻⁵ → 15 m
/// ```
///
/// so nearly all precision lies next to the near plane, and moving that plane away is the cheapest
/// cure. A float has its finest steps at 0; with z reversed they are where 1/z is coarse.
const SCENES: [Scene; 8] = [
    (0.02, 1e-2, Depth24Plus, 1.0),
    (0.02, 1e-4, Depth24Plus, 1.0),
    (0.02, 1e-5, Depth24Plus, 1.0),
    (0.02, 1e-2, Depth16Unorm, 1.0),
    (1.0, 1e-4, Depth24Plus, 1.0),
    (0.02, 1.0, Depth24Plus, 1.0),
    (0.02, 1e-4, Depth32Float, 1.0),
    (0.02, 1e-4, Depth32Float, 0.0),
];

fn panel(course: &Course, (gap, near, format, farthest): Scene) -> Result<Picture, LadderError> {
    let device = &course.device;
    let clip_from_view = if farthest > 0.0 {
        Mat4::perspective(0.8, 1.0, near, FAR)
    } else {
        Mat4::perspective_reversed(0.8, 1.0, near, FAR)
    };
    let view_from_world = Mat4::look_at([4.0, 8.0, 0.0], [-2.0, 0.0, -22.0], Course::UP);
    let clip_from_world = clip_from_view * view_from_world;
    let plane = |height, color| Plane {
        clip_from_world,
        height,
        color,
    };
    // The lower plane, in red, is drawn first: it stays where both depths are equal. The planes are
    // grids of different cells: with the same vertices they would round alike.
    let screen = Screen::with_depth(course, [240, 240], format, farthest)?;
    let [red, blue] = [plane(0.0, [0.9, 0.15, 0.1]), plane(gap, [0.2, 0.45, 0.9])];
    let lower = device.create_render_pipeline(&screen.pipeline(red))?;
    let upper = device.create_render_pipeline(&screen.pipeline(blue))?;
    let coarse = Faces::new(device, &Model::explicit(9, |_, _| 0.0))?;
    let fine = Faces::new(device, &Model::explicit(14, |_, _| 0.0))?;
    screen.draw(&[coarse.draw(&lower), fine.draw(&upper)])
}

/// Above: near = 10⁻², 10⁻⁴ and 10⁻⁵ with 24 bits, and 10⁻² with 16 bits. Below, the cures of the
/// second: planes 1 m apart; near = 1; a 32-bit float, which alone gains little; the float with
/// reversed z.
///
/// # Errors
/// If the textures do not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let panels = SCENES.map(|scene| panel(course, scene));
    let panels: Result<Vec<_>, _> = panels.into_iter().collect();
    Ok(Picture::in_columns(4, &panels?))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(18, draw)
}
