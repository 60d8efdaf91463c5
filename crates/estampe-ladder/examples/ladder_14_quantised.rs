//! Rung 14: Gouraud shading quantised to N levels, for N = 2, 3, 4 and 8, 400×400 each.
//!
//! Look at the borders between the levels: they are lines of equal light, and tell how a surface
//! bends.
//!
//! `cargo run --release --example ladder_14_quantised -- --model head.obj`

use estampe::{FragmentIn, FragmentOut, Vec3, VertexIn, VertexOut, vec4};
use estampe_ladder::{Corner, Course, Faces, LadderError, Picture, Screen};

struct Quantised {
    levels: f32,
}

estampe::shader! {
    impl Shader for Quantised {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = R; // intensity

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, R> {
            let intensity = a.normal.dot_uniform(Course::TOWARDS_LIGHT).max(0.0);
            let depth = (a.position.z + 1.0) * 0.5;
            VertexOut::new(vec4(a.position.x, a.position.y, depth, 1.0), intensity)
        }

        /// N levels, equally wide and equally far apart, from black to white:
        ///
        /// ```text
        ///   min(⌊I·N⌋, N − 1) / (N − 1)
        ///
        ///   N = 4:   I  0 ── ¼ ── ½ ── ¾ ── 1
        ///               0    ⅓    ⅔    1
        /// ```
        ///
        /// The minimum is for I = 1, which would be a level of its own.
        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, intensity: R) -> FragmentOut<R> {
            let level = (intensity * self.levels).floor().min(self.levels - 1.0);
            FragmentOut::color(Vec3::repeat(level * (1.0 / (self.levels - 1.0))).point())
        }
    }
}

/// In reading order: 2, 3, 4 and 8 levels.
///
/// # Errors
/// If the model does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let screen = Screen::new(course, 400, 400)?;
    let faces = Faces::new(&course.device, &course.model)?;
    let panel = |levels| screen.show(Quantised { levels }, &faces);
    Ok(Picture::in_columns(
        2,
        &[panel(2.0)?, panel(3.0)?, panel(4.0)?, panel(8.0)?],
    ))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(14, draw)
}
