//! A camera from the caller's options.

use super::Cloud;
use super::direction::ViewDirection;
use super::fit::{self, FrameTangents};
use super::pinhole::{Intrinsics, Window};
use crate::transforms::projection::{self, DepthConvention, Frustum};
use crate::transforms::view::CameraFrame;
use crate::transforms::{affine, transform_vector};
use glam::{DMat4, DVec3};

/// Options of the camera. Positions are in the model's world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraOptions {
    /// Position of the eye. Default: fitted in the default view direction.
    pub eye: Eye,
    /// The point in the middle of the image. `None` (default): the best fit for a fitted eye, the
    /// middle of the bounds for a given eye.
    pub target_world: Option<DVec3>,
    /// Projection. Default: perspective, 35° high.
    pub projection: ProjectionKind,
    /// Free border on each side, as a fraction of the picture's shorter side; in 0..0.5. Default
    /// 0.05.
    pub margin: f64,
    /// Enlargement of the picture about its middle, above 0; the eye stays, and the opening
    /// narrows. Default 1.
    pub zoom: f64,
}

impl Default for CameraOptions {
    fn default() -> Self {
        Self {
            eye: Eye::Fitted(ViewDirection::default()),
            target_world: None,
            projection: ProjectionKind::default(),
            margin: 0.05,
            zoom: 1.0,
        }
    }
}

/// Position of the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Eye {
    /// In this direction from the model, as near as the fit allows.
    Fitted(ViewDirection),
    /// At this position.
    At(DVec3),
    /// At this position, with these axes; target and up direction have no effect.
    Posed(CameraFrame),
}

/// Projection of a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ProjectionKind {
    /// Perspective: size decreases with distance.
    Perspective {
        /// Vertical opening angle in degrees, in 0..180, both excluded.
        fov_y_deg: f64,
    },
    /// Size does not depend on distance.
    Orthographic {
        /// Half of the visible height, in the same space as positions, above 0. `None` is the best
        /// fit.
        half_height: Option<f64>,
    },
    /// Perspective by intrinsics in pixels, whose middle and sides may differ. An eye that is
    /// fitted takes the principal point for the middle of the picture.
    Pinhole(Intrinsics),
}

impl Default for ProjectionKind {
    fn default() -> Self {
        Self::Perspective { fov_y_deg: 35.0 }
    }
}

/// A camera with position, projection and clip planes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedCamera {
    /// Position and axes.
    pub frame: CameraFrame,
    /// The point in the middle of the picture.
    pub target: DVec3,
    /// The projection's opening.
    pub lens: Lens,
    /// Distance of the near plane along the view direction.
    pub near: f64,
    /// Distance of the far plane.
    pub far: f64,
    /// Distances of the nearest and the furthest point of the model.
    pub depth_range: (f64, f64),
}

/// Opening of a projection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lens {
    /// Vertical opening angle, in radians.
    Perspective(f64),
    /// Half of the visible height.
    Orthographic(f64),
    /// The window at distance 1.
    Pinhole(Window),
}

impl Lens {
    /// The lens of a picture that is enlarged by this factor.
    fn zoomed(self, zoom: f64) -> Self {
        // The angle of a factor of 1 keeps its bits.
        let is_unchanged = zoom == 1.0;
        match self {
            _ if is_unchanged => self,
            Self::Perspective(fov) => {
                Self::Perspective(2.0 * libm::atan(libm::tan(fov / 2.0) / zoom))
            }
            Self::Orthographic(half_height) => Self::Orthographic(half_height / zoom),
            Self::Pinhole(window) => Self::Pinhole(window.zoomed(zoom)),
        }
    }
}

impl PlacedCamera {
    /// Places a camera for `points`, the model's vertices, and a picture of `size_px`.
    ///
    /// The options' positions and the points are in the same space, in which the model is about 1
    /// in radius. `up` is the direction that points up.
    #[must_use]
    pub fn new(
        options: &CameraOptions,
        up: DVec3,
        points: impl Into<Cloud>,
        size_px: (u32, u32),
    ) -> Self {
        let points = points.into();
        let (width, height) = (f64::from(size_px.0), f64::from(size_px.1));
        let lens = match options.projection {
            ProjectionKind::Perspective { fov_y_deg } => Lens::Perspective(fov_y_deg.to_radians()),
            ProjectionKind::Orthographic { half_height } => {
                Lens::Orthographic(half_height.unwrap_or(1.0))
            }
            ProjectionKind::Pinhole(intrinsics) => {
                Lens::Pinhole(Window::new(intrinsics, (width, height)))
            }
        };
        let tangent = match lens {
            Lens::Perspective(fov) => libm::tan(fov / 2.0),
            Lens::Orthographic(_) => 1.0,
            Lens::Pinhole(window) => (window.top - window.bottom) / 2.0,
        };
        let k = FrameTangents::new(width, height, tangent, options.margin);
        let placed = match options.eye {
            Eye::Fitted(direction) => {
                Self::fitted(direction, options.target_world, up, points, lens, k)
            }
            Eye::At(eye) => {
                // The model is centred at the origin of its normalised space.
                let target = options.target_world.unwrap_or(DVec3::ZERO);
                let frame = CameraFrame::look_at(eye, target, up);
                Self::standing(frame, Some(target), points, lens, k)
            }
            Eye::Posed(frame) => Self::standing(frame, None, points, lens, k),
        };
        let placed = match options.projection {
            ProjectionKind::Orthographic {
                half_height: Some(_),
            } => Self { lens, ..placed },
            _ => placed,
        };
        Self {
            lens: placed.lens.zoomed(options.zoom),
            ..placed
        }
    }

    /// The camera in a view direction, as near as the model allows.
    fn fitted(
        direction: ViewDirection,
        target: Option<DVec3>,
        up: DVec3,
        points: Cloud,
        lens: Lens,
        k: FrameTangents,
    ) -> Self {
        let upright = affine::rotation_between(DVec3::Y, up);
        let [right, up, back] = direction
            .axes()
            .map(|axis| transform_vector(&upright, axis));
        let origin = CameraFrame {
            right_world: right,
            up_world: up,
            back_world: back,
            eye_world: DVec3::ZERO,
        };
        let mut aligned = points;
        aligned.transform(|point| align_one(point, &origin));
        let through = target.map(|t| align_one(t, &origin));
        let (eye, lens) = match lens {
            Lens::Perspective(_) | Lens::Pinhole(_) => {
                (fit::perspective_eye(&aligned, k, through), lens)
            }
            Lens::Orthographic(_) => {
                let (middle, half_height) = fit::orthographic_view(&aligned, k, through);
                (
                    middle + DVec3::Z * half_height.max(1.0),
                    Lens::Orthographic(half_height),
                )
            }
        };
        let eye_world = right * eye.x + up * eye.y + back * eye.z;
        let (nearest, furthest) = depths(&aligned, k, eye.z);
        let target = target.unwrap_or(eye_world - back * ((nearest + furthest) / 2.0));
        let frame = CameraFrame {
            eye_world,
            ..origin
        };
        Self::with_planes(frame, target, lens, (nearest, furthest))
    }

    /// The camera with a given frame. Without a target, the point in the middle of the picture is
    /// at the middle of the model's depths.
    fn standing(
        frame: CameraFrame,
        target: Option<DVec3>,
        points: Cloud,
        lens: Lens,
        k: FrameTangents,
    ) -> Self {
        let origin = CameraFrame {
            eye_world: DVec3::ZERO,
            ..frame
        };
        let mut aligned = points;
        aligned.transform(|point| align_one(point, &origin));
        let eye_aligned = align_one(frame.eye_world, &origin);
        let lens = match lens {
            Lens::Perspective(_) | Lens::Pinhole(_) => lens,
            Lens::Orthographic(_) => {
                let (_, half_height) = fit::orthographic_view(&aligned, k, Some(eye_aligned));
                Lens::Orthographic(half_height)
            }
        };
        let (nearest, furthest) = depths(&aligned, k, eye_aligned.z);
        let ahead = || frame.eye_world - frame.back_world * ((nearest + furthest) / 2.0).max(1e-3);
        let target = target.unwrap_or_else(ahead);
        Self::with_planes(frame, target, lens, (nearest, furthest))
    }

    /// Adds near and far planes a little outside the model's range of depths.
    fn with_planes(frame: CameraFrame, target: DVec3, lens: Lens, depth_range: (f64, f64)) -> Self {
        /// Free space in front of and behind the model, as a fraction of its depth.
        const SLACK: f64 = 0.01;
        /// The least near distance, as a fraction of the far distance, for which f32 depth is
        /// precise enough.
        const LEAST_NEAR: f64 = 1e-4;
        let (nearest, furthest) = depth_range;
        let slack = (furthest - nearest).max(1e-3) * SLACK;
        let (near, far) = match lens {
            Lens::Perspective(_) | Lens::Pinhole(_) => {
                let far = (furthest + slack).max(1e-3);
                ((nearest - slack).max(far * LEAST_NEAR), far)
            }
            Lens::Orthographic(_) => (nearest - slack, furthest + slack),
        };
        Self {
            frame,
            target,
            lens,
            near,
            far,
            depth_range,
        }
    }

    /// The projection for a picture of `aspect` = width ÷ height.
    #[must_use]
    pub fn clip_from_view(&self, aspect: f64) -> DMat4 {
        let convention = DepthConvention::ZeroToOne;
        match self.lens {
            Lens::Perspective(fov) => {
                projection::perspective(fov, aspect, self.near, self.far, convention)
            }
            Lens::Pinhole(window) => {
                let f = Frustum {
                    left: self.near * window.left,
                    right: self.near * window.right,
                    bottom: self.near * window.bottom,
                    top: self.near * window.top,
                    near: self.near,
                    far: self.far,
                };
                projection::frustum(&f, convention)
            }
            Lens::Orthographic(half_height) => {
                let half_width = half_height * aspect;
                let f = Frustum {
                    left: -half_width,
                    right: half_width,
                    bottom: -half_height,
                    top: half_height,
                    near: self.near,
                    far: self.far,
                };
                projection::orthographic(&f, convention)
            }
        }
    }
}

fn align_one(p: DVec3, frame: &CameraFrame) -> DVec3 {
    DVec3::new(
        p.dot(frame.right_world),
        p.dot(frame.up_world),
        p.dot(frame.back_world),
    )
}

/// Distances of the nearest and the furthest point along the view direction. Without points, the
/// distance of the unit box's middle.
fn depths(aligned: &Cloud, k: FrameTangents, eye_z: f64) -> (f64, f64) {
    // Rounding is monotonic, so the extreme points have the extreme distances.
    aligned
        .reach(k)
        .map_or((eye_z - 1.0, eye_z + 1.0), |reach| {
            (eye_z - reach.most.z, eye_z - reach.least.z)
        })
}
