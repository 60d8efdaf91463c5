//! Rung 12: a camera that looks from (1, 1, 2) at the origin, 800×800.
//!
//! Look at the lid, which is dark: the eye has moved, the light has not, and still comes along the
//! z axis.
//!
//! `cargo run --release --example ladder_12_look_at -- --model head.obj`

use estampe::{FragmentIn, FragmentOut, Mat4, Vec3, VertexIn, VertexOut};
use estampe_ladder::{Corner, Course, Faces, LadderError, Picture, Screen};
use estampe_renderer::transforms::view::CameraFrame;
use estampe_renderer::transforms::{projection, to_f32};
use glam::DVec3;

struct Shaded {
    clip_from_world: Mat4,
}

estampe::shader! {
    impl Shader for Shaded {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = R; // intensity

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, R> {
            let intensity = a.normal.dot_uniform(Course::TOWARDS_LIGHT).max(0.0);
            VertexOut::new(self.clip_from_world.transform_point(a.position), intensity)
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, intensity: R) -> FragmentOut<R> {
            FragmentOut::color(Vec3::repeat(intensity).point())
        }
    }
}

/// The camera's frame, and the view that puts the centre at the origin:
///
/// ```text
///   z = normalize(eye − centre)      towards the eye
///   x = normalize(up × z)            to the right
///   y = z × x                        up in the picture
///   p_view = Rᵀ·(p − centre)         R = [x y z]; its inverse is its transpose
/// ```
///
/// The eye is then at (0, 0, d) with d = ‖eye − centre‖ = √6, where the central projection of rung
/// 11 wants it. The light stays where it was, at (0, 0, 1) in world space.
///
/// # Errors
/// If the model does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let [eye, centre, up] =
        [Course::EYE, Course::CENTRE, Course::UP].map(|vector| DVec3::from(vector.map(f64::from)));
    let frame = CameraFrame::look_at(eye, centre, up);
    let view_from_world = frame.centred_view_from_world(centre);
    // The corners of the cube −1..1 are √3 from the origin.
    let (z_near, z_far) = (1.75, -1.75);
    let clip_from_view = projection::central(eye.distance(centre), z_near, z_far);
    let clip_from_world = Screen::REVERSED * clip_from_view * view_from_world;

    let screen = Screen::new(course, Course::SIZE, Course::SIZE)?;
    let faces = Faces::new(&course.device, &course.model)?;
    let clip_from_world = to_f32(&clip_from_world).into();
    screen.show(Shaded { clip_from_world }, &faces)
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(12, draw)
}
