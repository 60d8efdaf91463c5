//! Rung 8: a diffuse texture, 800×800. From here on the pipeline rasterizes and interpolates; the
//! shader is ours.
//!
//! Look at one face: its light is the same everywhere, while its texels change.
//!
//! `cargo run --release --example ladder_08_diffuse_texture -- --model head.obj`

use estampe::{Draw, FragmentIn, FragmentOut, SampledTexture, Vec2, VertexIn, VertexOut, vec4};
use estampe_ladder::{Corner, Course, Faces, LadderError, Picture, Screen};

struct Textured {
    texture: SampledTexture,
}

estampe::varyings! {
    struct Surface<R> {
        uv: Vec2<R>,
        #[flat]
        intensity: R,
    }
}

estampe::shader! {
    impl Shader for Textured {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        /// x and y are kept; z of −1..1, which grows towards the eye, becomes a depth of 0..1. The
        /// depth test draws what is greater, and the buffer begins with the least depth.
        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            let depth = (a.position.z + 1.0) * 0.5;
            VertexOut::new(vec4(a.position.x, a.position.y, depth, 1.0), Surface {
                uv: a.uv,
                intensity: a.face_normal.dot_uniform(Course::TOWARDS_LIGHT).max(0.0),
            })
        }

        /// C = I · texel(⌊u·W⌋, ⌊v·H⌋), with u and v interpolated at every pixel.
        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let texel = self.texture.sample(v.uv).rgb();
            FragmentOut::color((texel * v.intensity).point())
        }
    }
}

/// The texture, and the model with it by flat shading.
///
/// # Errors
/// If the model does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let screen = Screen::new(course, Course::SIZE, Course::SIZE)?;
    let faces = Faces::new(&course.device, &course.model)?;
    let pipeline = screen.pipeline(Textured {
        texture: course.texture()?,
    });
    let pipeline = course.device.create_render_pipeline(&pipeline)?;
    let picture = screen.draw(&[Draw {
        viewport: Some(Course::VIEWPORT),
        ..faces.draw(&pipeline)
    }])?;
    let texture = Picture::from(course.model.texture.clone());
    Ok(Picture::side_by_side(&[
        texture.fitted(Course::SIZE),
        picture,
    ]))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(8, draw)
}
