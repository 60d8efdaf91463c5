//! Mistakes of matrices: the view, the projection, and normals.

use crate::{Corner, Course, Faces, LadderError, Model, Picture, Screen};
use estampe::{FragmentIn, FragmentOut, Mat4, Vec3, VertexIn, VertexOut};
use estampe_renderer::transforms::projection::{DepthConvention, perspective_horizontal};
use estampe_renderer::transforms::view::CameraFrame;
use estampe_renderer::transforms::{affine, normals, projection, to_f32};
use estampe_shapes::parametric::sphere;
use glam::{DMat3, DMat4, DVec3};

const SIZE: u32 = 300;

/// Positions and normals each by a matrix of their own, and Lambert's law with some ambient light.
struct Shaded {
    clip_from_world: Mat4,
    world_from_normal: Mat4,
    towards_light: [f32; 3],
}

estampe::shader! {
    impl Shader for Shaded {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Vec3<R>; // normal

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Vec3<R>> {
            let normal = self.world_from_normal.transform_vector(a.normal);
            VertexOut::new(self.clip_from_world.transform_point(a.position), normal)
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, normal: Vec3<R>) -> FragmentOut<R> {
            let light = normal.normalize().dot_uniform(self.towards_light).max(0.0);
            FragmentOut::color(Vec3::repeat(light * 0.8 + 0.2).point())
        }
    }
}

impl Shaded {
    /// Normals as they are, the light of the course.
    fn new(clip_from_world: DMat4) -> Self {
        Self {
            clip_from_world: to_f32(&clip_from_world).into(),
            world_from_normal: Mat4::IDENTITY,
            towards_light: Course::TOWARDS_LIGHT,
        }
    }
}

/// A camera that looks at the spout, not at the origin: with −centre as the translation; with an x
/// axis that is not normalized; right. The red lines cross where the spout belongs.
pub(super) fn look_at(course: &Course) -> Result<Picture, LadderError> {
    let eye = DVec3::new(2.6, 1.8, -0.6);
    let centre = DVec3::new(0.6, 0.1, 0.3);
    let up = DVec3::Y;
    let frame = CameraFrame::look_at(eye, centre, up);
    let right = frame.centred_view_from_world(centre);

    // Rᵀ·p − centre in place of Rᵀ·(p − centre).
    let mut unrotated = right;
    unrotated.w_axis = (-centre).extend(1.0);
    // ‖up × z‖ is the cosine of the camera's angle above the horizon.
    let length = up.cross((eye - centre).normalize()).length();
    let unnormalized = affine::scale(DVec3::new(length, 1.0, 1.0)) * right;

    let clip_from_view = Screen::REVERSED * projection::central(eye.distance(centre), 1.5, -3.0);
    let screen = Screen::new(course, SIZE, SIZE)?;
    let faces = Faces::new(&course.device, &course.model)?;
    let panel = |view_from_world| {
        let shader = Shaded {
            towards_light: [0.6, 0.64, -0.48],
            ..Shaded::new(clip_from_view * view_from_world)
        };
        let mut picture = screen.show(shader, &faces)?;
        let (middle, end) = (SIZE.cast_signed() / 2, SIZE.cast_signed());
        picture.line([middle, 0], [middle, end], Picture::RED);
        picture.line([0, middle], [end, middle], Picture::RED);
        Ok::<_, LadderError>(picture)
    };
    let panels = [panel(unrotated)?, panel(unnormalized)?, panel(right)?];
    Ok(Picture::side_by_side(&panels))
}

/// A sphere by a horizontal angle of 90° in a window twice as wide as high: with r/tan(θ/2)·y,
/// r = h/w, it becomes an ellipsoid; with y/(r·tan(θ/2)) it is round.
pub(super) fn horizontal_angle(course: &Course) -> Result<Picture, LadderError> {
    let angle_rad = std::f64::consts::FRAC_PI_2;
    let right = perspective_horizontal(angle_rad, 2.0, 0.5, 9.0, DepthConvention::Reversed);
    // Here tan(θ/2) = 1: the scale of y is r = ½ in place of 1/r = 2.
    let wrong = affine::scale(DVec3::new(1.0, 0.25, 1.0)) * right;
    let view_from_world = affine::translation(DVec3::new(0.0, 0.0, -2.6));
    let screen = Screen::new(course, 2 * SIZE / 2, SIZE / 2)?;
    let faces = Faces::new(&course.device, &Model::of_shape(sphere(1.0, 48, 24)))?;
    let panel =
        |clip_from_view: DMat4| screen.show(Shaded::new(clip_from_view * view_from_world), &faces);
    Ok(Picture::side_by_side(&[panel(wrong)?, panel(right)?]))
}

/// A sphere, flattened and then turned, with the light above: normals by M⁻¹; by the rotation
/// alone; by the inverse transpose. Only the last lights the disc as the flat thing that it is.
pub(super) fn normals(course: &Course) -> Result<Picture, LadderError> {
    let turn = affine::rotation(DVec3::Z, 0.6);
    let world_from_object = turn * affine::scale(DVec3::new(0.9, 0.25, 0.9));
    let inverse = DMat3::from_mat4(world_from_object.inverse());
    let inverse_transpose = normals::normal_matrix(&world_from_object);
    let screen = Screen::new(course, SIZE, SIZE)?;
    let faces = Faces::new(&course.device, &Model::of_shape(sphere(1.0, 64, 32)))?;
    let panel = |world_from_normal: DMat3| {
        let clip_from_world = Screen::REVERSED * projection::central(f64::INFINITY, 1.0, -1.0);
        let shader = Shaded {
            world_from_normal: to_f32(&DMat4::from_mat3(world_from_normal)).into(),
            towards_light: [0.0, 0.8, 0.6],
            ..Shaded::new(clip_from_world * world_from_object)
        };
        screen.show(shader, &faces)
    };
    let panels = [
        panel(inverse)?,
        panel(DMat3::from_mat4(turn))?,
        panel(inverse_transpose)?,
    ];
    Ok(Picture::side_by_side(&panels))
}
