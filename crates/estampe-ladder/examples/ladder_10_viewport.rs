//! Rung 10: the viewport matrix, 800×800 each.
//!
//! Look at the grey of the third panel: zoom changes x and y, and leaves z' as it is.
//!
//! `cargo run --release --example ladder_10_viewport -- --model head.obj`

use estampe::{FragmentIn, FragmentOut, Mat4, Vec3, VertexIn, VertexOut};
use estampe_ladder::{Corner, Course, Faces, LadderError, Picture, Screen};
use estampe_renderer::transforms::{affine, to_f32, viewport};
use glam::{DMat4, DVec3};

const SIZE: f64 = Course::SIZE as f64;

struct Shaded {
    window_from_ndc: Mat4,
    clip_from_window: Mat4,
    shows_depth: bool,
}

estampe::varyings! {
    struct Surface<R> { intensity: R, z_window: R }
}

estampe::shader! {
    impl Shader for Shaded {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            let window = self.window_from_ndc.transform_point(a.position);
            VertexOut::new(self.clip_from_window * window, Surface {
                intensity: a.normal.dot_uniform(Course::TOWARDS_LIGHT).max(0.0),
                z_window: window.z,
            })
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let gray = if self.shows_depth { v.z_window * (1.0 / 255.0) } else { v.intensity };
            FragmentOut::color(Vec3::repeat(gray).point())
        }
    }
}

/// The course's viewport matrix maps the cube −1..1 to pixels whose centres have whole coordinates,
/// y up, and z to a grey value of 100 ± 100:
///
/// ```text
///   x' = zoom·W/2·x + (W − 1)/2      zoom = 1: x = −1 → −½, the left edge of pixel 0
///   y' = zoom·H/2·y + (H − 1)/2                x = 1 → W − ½, the right edge of pixel W − 1
///   z' = 100·z + 100
/// ```
///
/// The pipeline has a viewport of its own, whose pixel centres are at ½. So this matrix is followed
/// by the one that undoes it: add ½, divide by W/2, subtract 1.
fn clip_from_window() -> DMat4 {
    let centres_at_half = affine::translation(DVec3::new(0.5, 0.5, 0.0));
    let to_clip = affine::scale(DVec3::new(2.0 / SIZE, 2.0 / SIZE, 1.0 / 200.0));
    affine::translation(DVec3::new(-1.0, -1.0, 0.0)) * to_clip * centres_at_half
}

/// The whole window; zoom ½; and z' of the latter as a grey value.
///
/// # Errors
/// If the model does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let screen = Screen::new(course, Course::SIZE, Course::SIZE)?;
    let faces = Faces::new(&course.device, &course.model)?;
    let panel = |zoom: f64, shows_depth: bool| {
        let window_from_ndc = viewport::window_from_ndc_zoomed(SIZE, SIZE, zoom);
        let shader = Shaded {
            window_from_ndc: to_f32(&window_from_ndc).into(),
            clip_from_window: to_f32(&clip_from_window()).into(),
            shows_depth,
        };
        screen.show(shader, &faces)
    };
    let panels = [panel(1.0, false)?, panel(0.5, false)?, panel(0.5, true)?];
    Ok(Picture::side_by_side(&panels))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(10, draw)
}
