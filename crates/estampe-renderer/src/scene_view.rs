//! The view of a scene: its unit space, its camera, and the resulting transforms.

use crate::camera::placement::Lens;
use crate::camera::{CameraOptions, Cloud, Eye, Intrinsics, Pinhole, PlacedCamera, ProjectionKind};
use crate::geometry::unit_space::{UnitSpace, UsedVertices, used_vertices};
use crate::options::{self, RenderOptions, Shading, Up};
use crate::shading::VertexTransforms;
use crate::shading::lighting::{DEFAULT_AMBIENT, Directional, Lights, Positional, ViewLight};
use crate::shading::output::{EyeDistance, Fog, Presentation};
use crate::shadows::{MapChoice, ShadowSource};
use crate::transforms::view::CameraFrame;
use crate::transforms::{round_to_f32, to_f32, transform_point, transform_vector};
use estampe::Mat4;
use estampe_scene::{Camera, LightSource, Projection, Scene, UpAxis, Workers};
use glam::{DMat3, DMat4, DVec3};

/// Distance beyond which a light is moved closer, in unit space: its direction stays the same, and
/// squares of distances are in f32's range.
pub(crate) const FURTHEST_LIGHT: f64 = 1e15;

/// A scene's unit space and its camera.
#[derive(Debug, Clone)]
pub(crate) struct SceneView {
    pub(crate) space: UnitSpace,
    pub(crate) camera: PlacedCamera,
    /// The up direction, unit.
    pub(crate) up_world: DVec3,
    /// The height of the model's lowest point, in unit space.
    pub(crate) lowest: f64,
    /// Width ÷ height of the image.
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
                Eye::Posed(frame) => Eye::Posed(CameraFrame {
                    eye_world: in_unit(frame.eye_world),
                    ..frame
                }),
            },
            target_world: options.camera.target_world.map(in_unit),
            projection: match options.camera.projection {
                ProjectionKind::Orthographic { half_height } => ProjectionKind::Orthographic {
                    half_height: half_height.map(|half| half / space.world_per_unit()),
                },
                perspective @ (ProjectionKind::Perspective { .. } | ProjectionKind::Pinhole(_)) => {
                    perspective
                }
            },
            ..options.camera
        };
        let size_px = (options.width, options.height);
        let up_world = up.normalize_or(DVec3::Y);
        let lowest = if options.has_ground() || options.grid {
            let heights = points.iter().map(|point| point.dot(up_world));
            heights.reduce(f64::min).unwrap_or(0.0)
        } else {
            0.0
        };
        // The corners of the model's box are further away than its vertices.
        let fitted = if options.bounding_box.is_some() {
            points.with(&space.corners())
        } else {
            points
        };
        Self {
            space,
            camera: PlacedCamera::new(&camera, up, fitted, size_px),
            up_world,
            lowest,
            aspect: f64::from(options.width) / f64::from(options.height),
        }
    }

    /// The transforms of vertices; each matrix product is rounded to f32 once.
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

    /// From unit space to clip space, in 64 bits.
    pub(crate) fn clip_from_unit(&self) -> DMat4 {
        self.camera.clip_from_view(self.aspect) * self.camera.frame.view_from_world()
    }

    /// The direction from a unit-space point towards the eye; its length has no meaning.
    pub(crate) fn towards_eye(&self, point_unit: DVec3) -> DVec3 {
        match self.camera.lens {
            Lens::Perspective(_) | Lens::Pinhole(_) => self.camera.frame.eye_world - point_unit,
            Lens::Orthographic(_) => self.camera.frame.back_world,
        }
    }

    /// The w of clip coordinates at the near plane; 0, which is less than every w, if size does not
    /// depend on distance.
    pub(crate) fn least_w(&self) -> f64 {
        match self.camera.lens {
            Lens::Perspective(_) | Lens::Pinhole(_) => self.camera.near,
            Lens::Orthographic(_) => 0.0,
        }
    }

    /// From view space to clip space.
    pub(crate) fn clip_from_view(&self) -> Mat4 {
        to_f32(&self.camera.clip_from_view(self.aspect)).into()
    }

    /// The lights of the options in view space, or the default lights.
    pub(crate) fn lights(&self, options: &RenderOptions) -> Lights {
        let mut lights = self.lights_without_shadows(options);
        if options.casts_shadows() {
            let mut shadows = MapChoice::new(self, options);
            // Of the default lights, those that fill cast none.
            let is_default = options.lights.is_empty();
            let casters = if is_default {
                1
            } else {
                lights.directional.len()
            };
            for light in lights.directional.iter_mut().take(casters) {
                light.shadow_map = shadows.add(ShadowSource::Directional(light.source.0));
            }
            for light in &mut lights.positional {
                light.shadow_map = shadows.add(ShadowSource::Positional(light.source.position));
            }
            lights.shadow_maps = shadows.into_maps();
        }
        lights
    }

    fn lights_without_shadows(&self, options: &RenderOptions) -> Lights {
        let ambient = options.ambient.unwrap_or(DEFAULT_AMBIENT);
        if options.lights.is_empty() {
            return Lights::studio(ambient);
        }
        let mut lights = Lights::with_uniform_ambient(ambient);
        let view_from_unit = self.camera.frame.view_from_world();
        for light in &options.lights {
            let color = light.color.to_array().map(|channel| channel.max(0.0));
            match light.source {
                LightSource::Directional {
                    towards_light_world,
                } => {
                    let towards = towards_light_world.as_dvec3().normalize_or_zero();
                    let towards = transform_vector(&view_from_unit, towards).as_vec3();
                    lights.directional.push(ViewLight {
                        source: Directional(towards.to_array()),
                        color,
                        highlight: 1.0,
                        shadow_map: None,
                    });
                }
                LightSource::Positional {
                    position_world,
                    reach,
                } => {
                    let position = self.space.unit_from_world(position_world.as_dvec3());
                    let position = position.clamp_length_max(FURTHEST_LIGHT);
                    let position = transform_point(&view_from_unit, position).as_vec3();
                    let reach = f64::from(reach.unwrap_or(f32::INFINITY));
                    lights.positional.push(ViewLight {
                        source: Positional {
                            position: position.to_array(),
                            inverse_reach: self.per_unit(reach),
                        },
                        color,
                        highlight: 1.0,
                        shadow_map: None,
                    });
                }
            }
        }
        lights
    }

    /// What the default lights add to colours that they light.
    pub(crate) fn presentation(&self, options: &RenderOptions) -> Option<Presentation> {
        let is_lit = matches!(
            options.shading,
            Shading::Phong | Shading::Gouraud | Shading::Flat
        );
        if !is_lit || !options.lights.is_empty() {
            return None;
        }
        let (nearest, furthest) = self.depth_range();
        Some(Presentation {
            nearest,
            per_distance: 1.0 / (furthest - nearest),
            orthographic: match self.eye_distance((options.width, options.height)) {
                EyeDistance::Perspective { .. } => None,
                EyeDistance::Orthographic(of_depth) => Some(of_depth),
            },
        })
    }

    /// The fog of the options, with this linear colour.
    pub(crate) fn fog(&self, fog: &options::Fog, color: [f32; 3], size_px: (u32, u32)) -> Fog {
        let start = fog.start_world / self.space.world_per_unit();
        Fog {
            color,
            backdrop: None,
            start: round_to_f32(start).clamp(0.0, f32::MAX),
            per_distance: self.per_unit(fog.end_world - fog.start_world),
            eye_distance: self.eye_distance(size_px),
        }
    }

    /// 1 ÷ a length in world units, in unit space; finite, and 0 for an infinite length.
    pub(crate) fn per_unit(&self, length_world: f64) -> f32 {
        let per_unit = self.space.world_per_unit() / length_world.max(f64::MIN_POSITIVE);
        round_to_f32(per_unit).clamp(0.0, f32::MAX)
    }

    /// How fragments find their distance from the eye, the inverse of projection and viewport.
    fn eye_distance(&self, (width, height): (u32, u32)) -> EyeDistance {
        let clip_from_view = self.camera.clip_from_view(self.aspect);
        match self.camera.lens {
            Lens::Perspective(_) | Lens::Pinhole(_) => {
                // ndc = (s·x + o·z)/−z, so x/−z = (ndc + o)/s; x runs from −1 to 1, y from 1 to −1.
                let slope = |scale: f64, skew: f64, left: f64, side: u32| {
                    let per_pixel = -left * 2.0 / f64::from(side);
                    [per_pixel / scale, (left + skew) / scale].map(round_to_f32)
                };
                EyeDistance::Perspective {
                    x: slope(
                        clip_from_view.x_axis.x,
                        clip_from_view.z_axis.x,
                        -1.0,
                        width,
                    ),
                    y: slope(
                        clip_from_view.y_axis.y,
                        clip_from_view.z_axis.y,
                        1.0,
                        height,
                    ),
                }
            }
            Lens::Orthographic(_) => {
                // depth = s·z + o, and the distance is −z.
                let (scale, offset) = (clip_from_view.z_axis.z, clip_from_view.w_axis.z);
                EyeDistance::Orthographic([-1.0 / scale, offset / scale].map(round_to_f32))
            }
        }
    }

    /// Distances of the nearest and the furthest point, in unit space; different even for flat
    /// models.
    pub(crate) fn depth_range(&self) -> (f32, f32) {
        const LEAST: f32 = 1e-5;
        let (nearest, furthest) = self.camera.depth_range;
        let nearest = round_to_f32(nearest.max(0.0));
        let furthest = round_to_f32(furthest);
        (nearest, furthest.max(nearest + LEAST))
    }

    /// Distance of a unit-space point along the view direction.
    pub(crate) fn distance(&self, point_unit: DVec3) -> f64 {
        let frame = &self.camera.frame;
        (frame.eye_world - point_unit).dot(frame.back_world)
    }

    /// The camera in world space as a pinhole, for a picture of this size; `None` if the projection
    /// is parallel.
    pub(crate) fn pinhole(&self, (width, height): (u32, u32)) -> Option<Pinhole> {
        let (width, height) = (f64::from(width), f64::from(height));
        let intrinsics = match self.camera.lens {
            Lens::Orthographic(_) => return None,
            Lens::Perspective(fov) => Intrinsics {
                focal_px: [height / 2.0 / libm::tan(fov / 2.0); 2],
                principal_px: [width / 2.0, height / 2.0],
            },
            Lens::Pinhole(window) => window.intrinsics((width, height)),
        };
        let frame = &self.camera.frame;
        let eye = self.space.world_from_unit(frame.eye_world);
        let rotation = [frame.right_world, -frame.up_world, -frame.back_world];
        Some(Pinhole {
            intrinsics,
            rotation,
            translation: -DVec3::from_array(rotation.map(|row| row.dot(eye))),
        })
    }

    /// The camera in world space, rounded to f32.
    pub(crate) fn camera_world(&self) -> Camera {
        let length = |unit: f64| round_to_f32(unit * self.space.world_per_unit());
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
                    fov_y_rad: round_to_f32(fov),
                    near,
                    far,
                },
                Lens::Pinhole(window) => Projection::Perspective {
                    fov_y_rad: round_to_f32(window.fov_y_rad()),
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

/// The rotation of the model, and the up direction in world space.
pub(crate) fn orientation(up: Up, of_scene: UpAxis) -> (DMat3, DVec3) {
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
