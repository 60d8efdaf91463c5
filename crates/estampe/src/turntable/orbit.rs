//! The circle on which the camera goes: one distance from which the model is whole at every angle.
//!
//! A vertex at height h and distance r from the axis sweeps a circle. In coordinates of a camera of
//! elevation e that looks at the axis, at angle φ of the circle,
//!
//! ```text
//!   x = r·sin φ       y = h·cos e − r·sin e·cos φ       z = h·sin e + r·cos e·cos φ
//! ```
//!
//! The eye (0, t, d) sees it inside the frame if |x| ≤ kₓ(d − z) and |y − t| ≤ k_y(d − z), where kₓ
//! and k_y are the frame's tangents (see `estampe_renderer::camera::fit`). The greatest values over
//! all φ are lengths of vectors, so that
//!
//! ```text
//!   d ≥ h·sin e + r·√(1/kₓ² + cos² e)
//!   k_y·d + t ≥ h·(cos e + k_y·sin e) + r·|k_y·cos e − sin e|
//!   k_y·d − t ≥ h·(k_y·sin e − cos e) + r·|k_y·cos e + sin e|
//! ```
//!
//! One pass over the vertices gives the least d and its t for any number of frames. Rejected: the
//! fit of each frame, whose distance pulses, and the greatest of those, a pass for each frame.

use estampe_renderer::camera::fit::FrameTangents;
use estampe_renderer::transforms::{affine, transform_vector};
use estampe_renderer::{CameraOptions, Eye, ProjectionKind, RenderOptions, Up, ViewDirection};
use estampe_scene::{Scene, UpAxis};
use glam::{DMat4, DVec3, Vec3};

/// The camera's circle around the axis.
#[derive(Debug, Clone)]
pub(crate) struct Orbit {
    start: ViewDirection,
    /// Turns the up direction of views to that of the world.
    upright: DMat4,
    /// The point of the axis from which heights are measured.
    origin_world: DVec3,
    projection: ProjectionKind,
    /// Of the frame; those of a half height of 1 if the projection is parallel.
    tangents: FrameTangents,
    is_target_fixed: bool,
    reach: Reach,
}

/// The greatest right sides of the conditions above, and of z and of the distance from the origin.
#[derive(Debug, Clone, Copy)]
struct Reach {
    across: f64,
    top: f64,
    bottom: f64,
    front: f64,
    radius: f64,
}

/// Views from straight above and below have no up direction around the axis; this near to them the
/// picture is the same, to a hundredth of a pixel.
const MOST_ELEVATION_DEG: f64 = 89.999;

impl Orbit {
    /// The circle of options with a fitted eye, for a model of which nothing is known yet.
    pub(crate) fn new(scene: &Scene, options: &RenderOptions, start: ViewDirection) -> Self {
        let (width, height) = (f64::from(options.width), f64::from(options.height));
        let tangent = match options.camera.projection {
            ProjectionKind::Perspective { fov_y_deg } => libm::tan(fov_y_deg.to_radians() / 2.0),
            ProjectionKind::Orthographic { .. } => 1.0,
            ProjectionKind::Pinhole(_) => unreachable!("a turntable has no camera of a data set"),
        };
        let up = match options.up {
            Up::Direction(up) => up,
            _ => DVec3::Y,
        };
        let mut orbit = Self {
            start: ViewDirection {
                elevation_deg: { start.elevation_deg }
                    .clamp(-MOST_ELEVATION_DEG, MOST_ELEVATION_DEG),
                ..start
            },
            upright: affine::rotation_between(DVec3::Y, up),
            origin_world: options.camera.target_world.unwrap_or(DVec3::ZERO),
            projection: options.camera.projection,
            tangents: FrameTangents::new(width, height, tangent, options.camera.margin),
            is_target_fixed: options.camera.target_world.is_some(),
            reach: Reach {
                across: f64::NEG_INFINITY,
                top: f64::NEG_INFINITY,
                bottom: f64::NEG_INFINITY,
                front: f64::NEG_INFINITY,
                radius: 0.0,
            },
        };
        if !orbit.is_target_fixed {
            orbit.origin_world = orbit.middle(scene, options.up);
        }
        orbit
    }

    /// The middle of the model's bounds along the axes of the world that is upright.
    fn middle(&self, scene: &Scene, up: Up) -> DVec3 {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| transform_vector(&self.upright, axis));
        let mut least = DVec3::INFINITY;
        let mut most = DVec3::NEG_INFINITY;
        each_vertex(scene, up, |at| {
            let along = DVec3::from_array(axes.map(|axis| at.dot(axis)));
            (least, most) = (least.min(along), most.max(along));
        });
        if !least.cmple(most).all() {
            return DVec3::ZERO;
        }
        let middle = (least + most) / 2.0;
        axes[0] * middle.x + axes[1] * middle.y + axes[2] * middle.z
    }

    /// Makes the circle so wide that it holds this model too.
    pub(crate) fn include(&mut self, scene: &Scene, up: Up) {
        let back = ViewDirection::new(0.0, self.start.elevation_deg).axes()[2];
        let (sin, cos) = (back.y, back.z);
        let (kx, ky) = (self.tangents.x, self.tangents.y);
        let across = (1.0 / (kx * kx) + cos * cos).sqrt();
        let (above, below) = ((ky * cos - sin).abs(), (ky * cos + sin).abs());
        let axis = transform_vector(&self.upright, DVec3::Y);
        let (is_parallel, origin) = (self.is_parallel(), self.origin_world);
        let reach = &mut self.reach;
        each_vertex(scene, up, |at| {
            let from = at - origin;
            let h = from.dot(axis);
            let r = (from - axis * h).length();
            reach.front = reach.front.max(h * sin + r * cos);
            reach.radius = reach.radius.max(r).max(h.abs());
            if is_parallel {
                // The frame does not widen with z.
                reach.across = reach.across.max(r);
                reach.top = reach.top.max(h * cos + r * sin.abs());
                reach.bottom = reach.bottom.max(r * sin.abs() - h * cos);
            } else {
                reach.across = reach.across.max(h * sin + r * across);
                reach.top = reach.top.max(h * (cos + ky * sin) + r * above);
                reach.bottom = reach.bottom.max(h * (ky * sin - cos) + r * below);
            }
        });
    }

    fn is_parallel(&self) -> bool {
        matches!(self.projection, ProjectionKind::Orthographic { .. })
    }

    /// The camera of a frame of `count`.
    pub(crate) fn camera(&self, frame: u32, count: u32, of: CameraOptions) -> CameraOptions {
        let turned = 360.0 * f64::from(frame) / f64::from(count.max(1));
        let direction = ViewDirection {
            azimuth_deg: self.start.azimuth_deg + turned,
            ..self.start
        };
        let [_, up, back] = { direction.axes() }.map(|axis| transform_vector(&self.upright, axis));
        let Reach {
            across,
            top,
            bottom,
            front,
            radius,
        } = self.reach;
        // A model without extent is seen from somewhere.
        let least = if radius > 0.0 { radius * 1e-3 } else { 1.0 };
        let shift = if self.is_target_fixed || !radius.is_finite() || radius == 0.0 {
            0.0
        } else {
            (top - bottom) / 2.0
        };
        let target = self.origin_world + up * shift;
        let tall = (top - shift).max(bottom + shift) / self.tangents.y;
        let (distance, projection) = if self.is_parallel() {
            let half_height = tall.max(across / self.tangents.x).max(least);
            let projection = ProjectionKind::Orthographic {
                half_height: Some(half_height),
            };
            (front.max(0.0) + half_height, projection)
        } else {
            (tall.max(across).max(front + least), self.projection)
        };
        let distance = if distance.is_finite() { distance } else { 2.0 };
        CameraOptions {
            eye: Eye::At(target + back * distance),
            target_world: Some(target),
            projection,
            ..of
        }
    }
}

/// The options of all pictures of a turn.
pub(crate) fn turned(orbit: &Orbit, count: u32, options: &RenderOptions) -> Vec<RenderOptions> {
    let frames = (0..count).map(|frame| RenderOptions {
        camera: orbit.camera(frame, count, options.camera),
        ..options.clone()
    });
    frames.collect()
}

/// Calls `use_vertex` with the positions in the world of all vertices that primitives use, some of
/// them several times.
fn each_vertex(scene: &Scene, up: Up, mut use_vertex: impl FnMut(DVec3)) {
    let is_turned = match up {
        Up::FromScene => scene.up == UpAxis::Z,
        Up::Axis(axis) => axis == UpAxis::Z,
        Up::Direction(_) => false,
    };
    // As the renderer turns models whose Z is up.
    let world = |p: Vec3| {
        let p = p.as_dvec3();
        if is_turned {
            DVec3::new(p.x, p.z, -p.y)
        } else {
            p
        }
    };
    for mesh in &scene.meshes {
        let corners = mesh.triangles.as_flattened().iter();
        let indices = corners.chain(mesh.lines.as_flattened()).chain(&mesh.points);
        for &index in indices {
            let position = mesh.positions.get(index as usize);
            if let Some(position) = position.filter(|position| position.is_finite()) {
                use_vertex(world(*position));
            }
        }
    }
}
