//! Rung 13: four shaders in one picture of 800×800, which share everything but the last step.
//!
//! Look along a row: without and with the texture; and down a column: flat and smooth light.
//!
//! `cargo run --release --example ladder_13_four_shaders -- --model head.obj`

use estampe::state::Viewport;
use estampe::{
    Draw, FragmentIn, FragmentOut, Mat4, SampledTexture, Vec2, Vec3, VertexIn, VertexOut,
};
use estampe_ladder::{Corner, Course, Faces, LadderError, Picture, Screen};

/// The colour of a fragment.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Style {
    Flat,
    FlatTexture,
    Gouraud,
    GouraudTexture,
}

const STYLES: [Style; 4] = [
    Style::Flat,
    Style::FlatTexture,
    Style::Gouraud,
    Style::GouraudTexture,
];

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
    let screen = Screen::new(course, Course::SIZE, Course::SIZE)?;
    let faces = Faces::new(&course.device, &course.model)?;
    let texture = course.texture()?;
    let mut pipelines = Vec::new();
    for style in STYLES {
        let pipeline = screen.pipeline(Shaded {
            style,
            clip_from_world: Course::camera(),
            texture: texture.clone(),
        });
        pipelines.push(course.device.create_render_pipeline(&pipeline)?);
    }
    let (half, side) = (Course::SIZE as f32 / 2.0, Course::SIZE as f32 * 0.4);
    let border = (half - side) / 2.0;
    let quarters = [[0.0, 0.0], [half, 0.0], [0.0, half], [half, half]];
    let draws = pipelines
        .iter()
        .zip(quarters)
        .map(|(pipeline, [x, y])| Draw {
            viewport: Some(Viewport {
                x: x + border,
                y: y + border,
                width: side,
                height: side,
                ..Viewport::of_target(Course::SIZE, Course::SIZE)
            }),
            ..faces.draw(pipeline)
        });
    screen.draw(&draws.collect::<Vec<_>>())
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(13, draw)
}
