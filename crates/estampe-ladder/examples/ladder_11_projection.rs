//! Rung 11: the central projection, with the eye at d = ∞ and d = 2, and texture coordinates in it.
//!
//! Look at the diagonal of the ramp: below left the tiles bend there, below right they are
//! straight. Above, the parts of the model that are nearer to the eye grow with d = 2.
//!
//! `cargo run --release --example ladder_11_projection -- --model head.obj`

use estampe::{FragmentIn, FragmentOut, Mat4, SampledTexture, Vec2, VertexIn, VertexOut};
use estampe_ladder::{Corner, Course, Faces, LadderError, Model, Picture, Screen};
use estampe_renderer::transforms::{projection, to_f32};

struct Textured {
    clip_from_world: Mat4,
    texture: SampledTexture,
    is_affine: bool,
}

estampe::varyings! {
    struct Surface<R> {
        intensity: R,
        uv: Vec2<R>,
        #[no_perspective]
        uv_affine: Vec2<R>,
    }
}

estampe::shader! {
    impl Shader for Textured {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            let intensity = a.normal.dot_uniform(Course::TOWARDS_LIGHT).max(0.0);
            VertexOut::new(self.clip_from_world.transform_point(a.position), Surface {
                intensity,
                uv: a.uv,
                uv_affine: a.uv,
            })
        }

        /// A value A that is affine on a triangle in space is not affine in the window; A/w and 1/w
        /// are. The pipeline interpolates those two and divides: A = (A/w) ÷ (1/w).
        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let uv = if self.is_affine { v.uv_affine } else { v.uv };
            FragmentOut::color((self.texture.sample(uv).rgb() * v.intensity).point())
        }
    }
}

/// A ramp of two triangles, from z = ½ up to z = −4.
fn ramp() -> Model {
    Model {
        positions: vec![
            [-2.0, -0.7, 0.5],
            [2.0, -0.7, 0.5],
            [2.0, 1.4, -4.0],
            [-2.0, 1.4, -4.0],
        ],
        normals: vec![Course::TOWARDS_LIGHT; 4],
        uvs: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        faces: vec![[0, 1, 2], [0, 2, 3]],
        ..Model::empty()
    }
}

/// Above: the model with d = ∞ (parallel) and d = 2. Below, with d = 2: a ramp of two triangles,
/// its texture coordinates interpolated in the window (wrong) and with the division (right).
///
/// The eye stands at (0, 0, d) and looks at the origin. By similar triangles a point is drawn at
///
/// ```text
///   x' = x / (1 − z/d),   y' = y / (1 − z/d),   so w = 1 − z/d;   w = 1 where d = ∞
/// ```
///
/// # Errors
/// If the model does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let screen = Screen::new(course, Course::SIZE, Course::SIZE)?;
    let panel = |model: &Model, d: f64, is_affine: bool| {
        let (z_near, z_far) = (1.0, -4.0);
        let clip_from_world = Screen::REVERSED * projection::central(d, z_near, z_far);
        let faces = Faces::new(&course.device, model)?;
        let shader = Textured {
            clip_from_world: to_f32(&clip_from_world).into(),
            texture: course.texture()?,
            is_affine,
        };
        screen.show(shader, &faces)
    };
    let panels = [
        panel(&course.model, f64::INFINITY, false)?,
        panel(&course.model, 2.0, false)?,
        panel(&ramp(), 2.0, true)?,
        panel(&ramp(), 2.0, false)?,
    ];
    Ok(Picture::in_columns(2, &panels))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(11, draw)
}
