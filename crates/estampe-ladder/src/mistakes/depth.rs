//! Mistakes about depth.

use crate::{Color, Corner, Course, Faces, LadderError, Model, Picture, Screen};
use estampe::{FragmentIn, FragmentOut, Mat4, Vec3, VertexIn, VertexOut};

const SIZE: u32 = 300;

/// A plane of one colour, whose window z is interpolated by the pipeline, or as a varying is.
struct Plane {
    clip_from_world: Mat4,
    color: [f32; 3],
    interpolates_like_varyings: bool,
}

estampe::shader! {
    impl Shader for Plane {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = R; // window z

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, R> {
            let clip = self.clip_from_world.transform_point(a.position);
            VertexOut::new(clip, clip.z / clip.w)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, z: R) -> FragmentOut<R> {
            let color = FragmentOut::color(Vec3::uniform(input.zero, self.color).point());
            if self.interpolates_like_varyings { color.with_depth(z) } else { color }
        }
    }
}

/// Two planes that cross in a straight line. If window z is interpolated with perspective
/// correction, as varyings are, each triangle has another z in its middle: they cross elsewhere,
/// and the line bends where triangles meet.
pub(super) fn window_z(course: &Course) -> Result<Picture, LadderError> {
    let clip_from_world = Mat4::perspective_reversed(0.9, 1.0, 0.2, 20.0)
        * Mat4::look_at([0.0, 0.7, 1.6], [0.0, 0.0, -0.6], Course::UP);
    let screen = Screen::new(course, SIZE, SIZE)?;
    let floor = Faces::new(&course.device, &Model::explicit(2, |_, _| 0.0))?;
    let ramp = Faces::new(
        &course.device,
        &Model::explicit(1, |x, z| 0.25 * x + 0.3 * z),
    )?;
    let panel = |interpolates_like_varyings| {
        let plane = |color| Plane {
            clip_from_world,
            color,
            interpolates_like_varyings,
        };
        let planes = [plane([0.3, 0.5, 0.9]), plane([0.95, 0.75, 0.3])];
        let mut pipelines = Vec::new();
        for plane in planes {
            let pipeline = screen.pipeline(plane);
            pipelines.push(course.device.create_render_pipeline(&pipeline)?);
        }
        screen.draw(&[floor.draw(&pipelines[0]), ramp.draw(&pipelines[1])])
    };
    Ok(Picture::side_by_side(&[panel(true)?, panel(false)?]))
}

/// The distances that a depth buffer of 6 bits can tell apart, near = 1 at the left and far = 10 at
/// the right: a line for each of its 64 values. Above, d as it is: fine near the eye, coarse far
/// from it. Below, steps of equal length, for comparison.
///
/// ```text
///   d = far·(z − near) / (z·(far − near))   →   z = near·far / (far − d·(far − near))
/// ```
pub(super) fn precision(_: &Course) -> Result<Picture, LadderError> {
    const WIDTH: u32 = 640;
    const COLOR: Color = [120, 200, 255];
    const VALUES: u32 = 64;
    let (near, far) = (1.0, 10.0);
    let rows = |z: &dyn Fn(f64) -> f64| {
        let mut picture = Picture::new(WIDTH, 60);
        for value in 0..VALUES {
            let d = f64::from(value) / f64::from(VALUES - 1);
            let place = (z(d) - near) / (far - near) * f64::from(WIDTH - 1);
            #[expect(clippy::cast_possible_truncation, reason = "columns of the picture")]
            let x = (place + 0.5) as i32;
            picture.line([x, 0], [x, 59], COLOR);
        }
        picture
    };
    let by_reciprocal = rows(&|d| near * far / (far - d * (far - near)));
    let by_distance = rows(&|d| near + d * (far - near));
    Ok(Picture::in_columns(1, &[by_reciprocal, by_distance]))
}
