//! How a scene is seen: its unit space, the camera in it, and the transforms that follow.

use crate::camera::placement::Lens;
use crate::camera::{CameraOptions, Cloud, Eye, PlacedCamera};
use crate::geometry::unit_space::{UnitSpace, UsedVertices, used_vertices};
use crate::options::{RenderOptions, Up};
use crate::shading::VertexTransforms;
use crate::shading::lighting::{DEFAULT_AMBIENT, LightRig, ViewLight};
use crate::transforms::{to_f32, transform_vector};
use estampe_scene::{Camera, Projection, Scene, UpAxis, Workers};
use glam::{DMat3, DMat4, DVec3};

/// A scene's space and the camera that looks at it.
#[derive(Debug, Clone)]
pub(crate) struct SceneView {
    pub(crate) space: UnitSpace,
    pub(crate) camera: PlacedCamera,
    /// Width ÷ height of the picture.
    aspect: f64,
}

impl SceneView {
    pub(crate) fn new(scene: &Scene, options: &RenderOptions, workers: Workers) -> Self {
        let (world_from_object, up) = orientation(options.up, scene.up);
        let meshes = scene.meshes.iter();
        let is_used: Vec<Vec<bool>> = meshes.map(|mesh| used_vertices(mesh, workers)).collect();
        let used = UsedVertices::of_scene(scene, &is_used);
        let space = UnitSpace::new(&used, world_from_object, workers);
        let unit = |position| space.unit_from_object(position).as_dvec3();
        let points = Cloud::new(
            &used,
            |piece| piece.positions().map(unit).collect(),
            workers,
        );
        let in_unit = |p: DVec3| space.unit_from_world(p);
        let camera = CameraOptions {
            eye: match options.camera.eye {
                Eye::At(eye) => Eye::At(in_unit(eye)),
                fitted @ Eye::Fitted(_) => fitted,
            },
            target_world: options.camera.target_world.map(in_unit),
            ..options.camera
        };
        let size_px = (options.width, options.height);
        Self {
            space,
            camera: PlacedCamera::new(&camera, up, points, size_px),
            aspect: f64::from(options.width) / f64::from(options.height),
        }
    }

    /// The transforms of vertices; each product is rounded to f32 once.
    pub(crate) fn transforms(&self) -> VertexTransforms {
        let view_from_unit = self.camera.frame.view_from_world();
        let clip_from_unit = self.camera.clip_from_view(self.aspect) * view_from_unit;
        let turn = DMat3::from_mat4(view_from_unit) * self.space.world_from_object;
        VertexTransforms {
            clip_from_unit: to_f32(&clip_from_unit).into(),
            view_from_unit: to_f32(&view_from_unit).into(),
            view_from_object_normal: to_f32(&DMat4::from_mat3(turn)).into(),
            is_orthographic: matches!(self.camera.lens, Lens::Orthographic(_)),
        }
    }

    /// The lights that were asked for, in view space, or those that go with the camera.
    pub(crate) fn rig(&self, options: &RenderOptions) -> LightRig {
        let ambient = options.ambient.unwrap_or(DEFAULT_AMBIENT);
        if options.lights.is_empty() {
            return LightRig::studio(ambient);
        }
        let view_from_world = self.camera.frame.view_from_world();
        let lights = options.lights.iter().map(|light| {
            let towards = light.towards_light_world.as_dvec3().normalize_or_zero();
            let towards = transform_vector(&view_from_world, towards)
                .as_vec3()
                .to_array();
            ViewLight {
                towards,
                color: light.color.to_array(),
                highlight: 1.0,
            }
        });
        LightRig::given(lights.collect(), ambient)
    }

    /// Distances of the nearest and the furthest point, in the unit space; apart even for flat models.
    pub(crate) fn depth_range(&self) -> (f32, f32) {
        const LEAST: f32 = 1e-5;
        let (nearest, furthest) = self.camera.depth_range;
        let nearest = DVec3::splat(nearest.max(0.0)).as_vec3().x;
        let furthest = DVec3::splat(furthest).as_vec3().x;
        (nearest, furthest.max(nearest + LEAST))
    }

    /// Distance along the view direction of a point in the unit space.
    pub(crate) fn distance(&self, point_unit: DVec3) -> f64 {
        let frame = &self.camera.frame;
        (frame.eye_world - point_unit).dot(frame.back_world)
    }

    /// The camera in the world, rounded.
    pub(crate) fn camera_world(&self) -> Camera {
        let f32_of = |value: f64| DVec3::splat(value).as_vec3().x;
        let length = |unit: f64| f32_of(unit * self.space.world_per_unit());
        let (near, far) = (length(self.camera.near), length(self.camera.far));
        Camera {
            eye_world: self
                .space
                .world_from_unit(self.camera.frame.eye_world)
                .as_vec3(),
            target_world: self.space.world_from_unit(self.camera.target).as_vec3(),
            up_world: self.camera.frame.up_world.as_vec3(),
            projection: match self.camera.lens {
                Lens::Perspective(fov) => Projection::Perspective {
                    fov_y_rad: f32_of(fov),
                    near,
                    far,
                },
                Lens::Orthographic(half_height) => Projection::Orthographic {
                    half_height: length(half_height),
                    near,
                    far,
                },
            },
        }
    }
}

/// The rotation of the model, and the direction that points up in the world.
fn orientation(up: Up, of_scene: UpAxis) -> (DMat3, DVec3) {
    let axis = match up {
        Up::FromScene => of_scene,
        Up::Axis(axis) => axis,
        Up::Direction(direction) if direction != DVec3::ZERO => {
            return (DMat3::IDENTITY, direction);
        }
        Up::Direction(_) => UpAxis::Y,
    };
    let turned = match axis {
        UpAxis::Y => DMat3::IDENTITY,
        // (x, y, z) → (x, z, −y)
        UpAxis::Z => DMat3::from_cols(DVec3::X, -DVec3::Z, DVec3::Y),
    };
    (turned, DVec3::Y)
}
