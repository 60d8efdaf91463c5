//! Rung 9: Gouraud shading beside flat shading, 800×800 each.
//!
//! Look at the faces of the body, which Gouraud shading makes invisible, and at the outline, where
//! they stay.
//!
//! `cargo run --release --example ladder_09_gouraud -- --model head.obj`

use estampe::{Draw, FragmentIn, FragmentOut, Vec3, VertexIn, VertexOut, vec4};
use estampe_ladder::{Corner, Course, Faces, LadderError, Picture, Screen};

struct Shaded {
    is_flat: bool,
}

estampe::varyings! {
    struct Light<R> {
        #[flat]
        of_face: R,
        of_vertex: R,
    }
}

estampe::shader! {
    impl Shader for Shaded {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Light<R>;

        /// Lambert's law I = max(n·l, 0), once with the normal of the face, once with that of the
        /// vertex, which is the mean of the surface around it.
        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Light<R>> {
            let depth = (a.position.z + 1.0) * 0.5;
            VertexOut::new(vec4(a.position.x, a.position.y, depth, 1.0), Light {
                of_face: a.face_normal.dot_uniform(Course::TOWARDS_LIGHT).max(0.0),
                of_vertex: a.normal.dot_uniform(Course::TOWARDS_LIGHT).max(0.0),
            })
        }

        /// Gouraud (1971): the intensity is computed at the vertices and interpolated between them,
        /// so neighbouring faces have the same intensity along their edge.
        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, light: Light<R>) -> FragmentOut<R> {
            let intensity = if self.is_flat { light.of_face } else { light.of_vertex };
            FragmentOut::color(Vec3::repeat(intensity).point())
        }
    }
}

/// Flat shading on the left, Gouraud shading on the right. The outline keeps its corners: only the
/// light is smooth.
///
/// # Errors
/// If the model does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let screen = Screen::new(course, Course::SIZE, Course::SIZE)?;
    let faces = Faces::new(&course.device, &course.model)?;
    let panel = |is_flat| {
        let pipeline = screen.pipeline(Shaded { is_flat });
        let pipeline = course.device.create_render_pipeline(&pipeline)?;
        screen.draw(&[Draw {
            viewport: Some(Course::VIEWPORT),
            ..faces.draw(&pipeline)
        }])
    };
    Ok(Picture::side_by_side(&[panel(true)?, panel(false)?]))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(9, draw)
}
