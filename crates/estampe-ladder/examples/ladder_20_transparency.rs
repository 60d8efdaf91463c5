//! Rung 20: transparency, 400×400 each: water before the terrain (wrong), and after it.
//!
//! Look at the ground under the water: on the left there is none.
//!
//! `cargo run --release --example ladder_20_transparency`

use estampe::state::{BlendState, ColorTargetState, CompareFunction, DepthState};
use estampe::{FragmentIn, FragmentOut, Mat4, TextureFormat, Vec3, VertexIn, VertexOut, maths};
use estampe_ladder::{Color, Corner, Course, Faces, LadderError, Model, Picture, Screen};

const SKY: Color = [150, 190, 230];

struct Landscape {
    clip_from_world: Mat4,
    is_water: bool,
}

estampe::varyings! {
    struct Surface<R> { height: R, light: R }
}

estampe::shader! {
    impl Shader for Landscape {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            VertexOut::new(self.clip_from_world.transform_point(a.position), Surface {
                height: (a.position.y * 3.0 + 0.5).saturate(),
                light: a.face_normal.dot_uniform([0.4, 0.8, 0.45]).max(0.1),
            })
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let rgb = |color: [f32; 3]| Vec3::uniform(input.zero, color);
            if self.is_water {
                return FragmentOut::color(rgb([0.1, 0.3, 0.6]).extend(0.6)); // α = 0.6
            }
            let color = rgb([0.75, 0.65, 0.4]).mix(rgb([0.3, 0.6, 0.25]), v.height);
            FragmentOut::color((color * v.light).point())
        }
    }
}

/// Hills, higher at the back, with knolls on them.
fn height(x: f32, z: f32) -> f32 {
    let hills = maths::sin(x * 5.0 + 1.0) * maths::sin(z * 4.0) * 0.22;
    let knolls = maths::sin(x * 11.0) * maths::sin(z * 13.0 + 2.0) * 0.05;
    hills + knolls - z * 0.15
}

/// Blending mixes a fragment with what is already there, C = α·C_new + (1 − α)·C_old, so what lies
/// behind must be drawn first: all that is opaque, then what is transparent, from the farthest on.
/// Transparent surfaces are tested against the depth buffer, and do not write it.
///
/// On the left the water comes first and writes its depth: it is blended with the sky, and the
/// ground beneath it is hidden.
///
/// # Errors
/// If the textures do not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let view_from_world = Mat4::look_at([0.6, 1.3, 2.0], [0.0, -0.1, 0.0], Course::UP);
    let clip_from_world = Mat4::perspective_reversed(0.85, 1.0, 0.1, 10.0) * view_from_world;
    let screen = Screen::new(course, 400, 400)?;
    let landscape = |is_water| {
        screen.pipeline(Landscape {
            clip_from_world,
            is_water,
        })
    };
    let mut water = landscape(true);
    water.targets = vec![Some(ColorTargetState {
        blend: Some(BlendState::ALPHA_BLENDING),
        ..TextureFormat::Rgba8Unorm.into()
    })];
    let device = &course.device;
    let terrain = device.create_render_pipeline(&landscape(false))?;
    let writing_water = device.create_render_pipeline(&water)?;
    let test_alone = DepthState {
        write_enabled: false,
        compare: CompareFunction::Greater,
    };
    water.depth_stencil = Some(test_alone.into());
    let water = device.create_render_pipeline(&water)?;
    let ground = Faces::new(device, &Model::explicit(64, height))?;
    let surface = Faces::new(device, &Model::explicit(1, |_, _| 0.0))?;

    let wrong = [surface.draw(&writing_water), ground.draw(&terrain)];
    let right = [ground.draw(&terrain), surface.draw(&water)];
    Ok(Picture::side_by_side(&[
        screen.draw_over(SKY, &wrong)?,
        screen.draw_over(SKY, &right)?,
    ]))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(20, draw)
}
