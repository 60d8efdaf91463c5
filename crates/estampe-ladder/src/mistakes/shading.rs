//! Mistakes of shading.

use crate::{Corner, Course, Faces, LadderError, Picture, Screen};
use estampe::{FragmentIn, FragmentOut, Mat4, Vec3, VertexIn, VertexOut};

const SIZE: u32 = 300;

/// The formula of an intensity, or of what is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Formula {
    /// N·int(C/N), N = 4.
    ToonPrinted,
    /// min(⌊C·N⌋, N − 1)/(N − 1), N = 4.
    Toon,
    /// n·l with the face normal the wrong way around.
    NormalTurned,
    /// n·l.
    Normal,
}

struct Shaded {
    formula: Formula,
    clip_from_world: Mat4,
}

/// The unit direction from the origin to [`Course::EYE`], and towards the light.
const TOWARDS_EYE: [f32; 3] = [0.408_248_3, 0.408_248_3, 0.816_496_6];

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

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Light<R>> {
            VertexOut::new(self.clip_from_world.transform_point(a.position), Light {
                of_face: a.face_normal.dot_uniform(TOWARDS_EYE),
                of_vertex: a.normal.dot_uniform(TOWARDS_EYE).max(0.0),
            })
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, light: Light<R>) -> FragmentOut<R> {
            let (c, face) = (light.of_vertex, light.of_face);
            let intensity = match self.formula {
                Formula::ToonPrinted => (c * 0.25).floor() * 4.0,
                Formula::Toon => (c * 4.0).floor().min(3.0) * (1.0 / 3.0),
                Formula::NormalTurned => 0.0 - face,
                Formula::Normal => face,
            };
            let shown = FragmentOut::color(Vec3::repeat(intensity).point());
            match self.formula {
                Formula::NormalTurned | Formula::Normal => shown.discard_unless(intensity.gt(0.0)),
                Formula::ToonPrinted | Formula::Toon => shown,
            }
        }
    }
}

fn panels(course: &Course, formulas: [Formula; 2]) -> Result<Picture, LadderError> {
    let screen = Screen::new(course, SIZE, SIZE)?;
    let faces = Faces::new(&course.device, &course.model)?;
    let panel = |formula| {
        let shader = Shaded {
            formula,
            clip_from_world: Course::camera(),
        };
        screen.show(shader, &faces)
    };
    let [wrong, right] = formulas.map(panel);
    Ok(Picture::side_by_side(&[wrong?, right?]))
}

/// With intensities of 0 to 1 the printed formula is 0 everywhere.
pub(super) fn toon(course: &Course) -> Result<Picture, LadderError> {
    panels(course, [Formula::ToonPrinted, Formula::Toon])
}

/// With the other order of the edges the normal points inside: the faces that turn away are drawn,
/// from within.
pub(super) fn face_normal(course: &Course) -> Result<Picture, LadderError> {
    panels(course, [Formula::NormalTurned, Formula::Normal])
}
