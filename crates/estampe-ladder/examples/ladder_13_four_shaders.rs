//! Rung 13: four shaders in one picture of 800×800, which share everything but the last step.
//!
//! `cargo run --release --example ladder_13_four_shaders -- --model head.obj`

use estampe::state::Viewport;
use estampe::{
    Draw, FragmentIn, FragmentOut, Mat4, SampledTexture, Vec2, Vec3, VertexIn, VertexOut,
};
use estampe_ladder::{Corner, Course, Faces, LadderError, Picture, Screen};
use estampe_renderer::transforms::view::CameraFrame;
use estampe_renderer::transforms::{projection, to_f32};
use glam::DVec3;

/// The colour of a fragment.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Style {
    Flat,
    FlatTexture,
    Gouraud,
    GouraudTexture,
}

struct Shaded {
    style: Style,
    clip_from_world: Mat4,
    texture: SampledTexture,
}

estampe::varyings! {
    struct Surface<R> {
        #[flat]
        flat: R,
        gouraud: R,
        uv: Vec2<R>,
    }
}

estampe::shader! {
    impl Shader for Shaded {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            VertexOut::new(self.clip_from_world.transform_point(a.position), Surface {
                flat: a.face_normal.dot_uniform(Course::TOWARDS_LIGHT).max(0.0),
                gouraud: a.normal.dot_uniform(Course::TOWARDS_LIGHT).max(0.0),
                uv: a.uv,
            })
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let color = match self.style {
                Style::Flat => Vec3::repeat(v.flat),
                Style::FlatTexture => self.texture.sample(v.uv).rgb() * v.flat,
                Style::Gouraud => Vec3::repeat(v.gouraud),
                Style::GouraudTexture => self.texture.sample(v.uv).rgb() * v.gouraud,
            };
            FragmentOut::color(color.point())
        }
    }
}

/// Flat and flat with texture above Gouraud and Gouraud with texture, each in a quarter at zoom
/// 0.4: the viewport matrix of rung 10 with half the width times 0.4, moved to the quarter's
/// middle.
///
/// One vertex buffer, one vertex shader, one texture, one camera, one depth buffer and one pass
/// serve all four draws. A pipeline has its own fragment shader, a draw its own viewport.
///
/// # Errors
/// If the model does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let [eye, centre, up] =
        [Course::EYE, Course::CENTRE, Course::UP].map(|vector| DVec3::from(vector.map(f64::from)));
    let view_from_world = CameraFrame::look_at(eye, centre, up).centred_view_from_world(centre);
    let clip_from_view = projection::central(eye.distance(centre), 1.75, -1.75);
    let clip_from_world = to_f32(&(Screen::REVERSED * clip_from_view * view_from_world)).into();

    let screen = Screen::new(course, Course::SIZE, Course::SIZE)?;
    let faces = Faces::new(&course.device, &course.model)?;
    let texture = course.texture()?;
    let mut pipelines = Vec::new();
    for style in [
        Style::Flat,
        Style::FlatTexture,
        Style::Gouraud,
        Style::GouraudTexture,
    ] {
        let descriptor = Screen::pipeline(Shaded {
            style,
            clip_from_world,
            texture: texture.clone(),
        });
        pipelines.push(course.device.create_render_pipeline(&descriptor)?);
    }
    let quarter = |column: f32, row: f32| {
        let size = Course::SIZE as f32;
        let (half, side) = (size / 2.0, 0.4 * size);
        let border = (half - side) / 2.0;
        Viewport {
            x: column * half + border,
            y: row * half + border,
            width: side,
            height: side,
            ..Viewport::of_target(Course::SIZE, Course::SIZE)
        }
    };
    let places = [
        quarter(0.0, 0.0),
        quarter(1.0, 0.0),
        quarter(0.0, 1.0),
        quarter(1.0, 1.0),
    ];
    let draws: Vec<_> = pipelines
        .iter()
        .zip(places)
        .map(|(pipeline, viewport)| Draw {
            viewport: Some(viewport),
            ..faces.draw(pipeline)
        })
        .collect();
    screen.draw(&draws)
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(13, draw)
}
