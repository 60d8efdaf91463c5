//! Projections from view to clip space.

use glam::{DMat4, DVec4};

/// NDC depths of the near and far planes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DepthConvention {
    /// Near 0, far 1: Vulkan, WebGPU and this pipeline.
    #[default]
    ZeroToOne,
    /// Near −1, far 1: OpenGL.
    MinusOneToOne,
    /// Near 1, far 0: floating-point depth then keeps its precision at a distance.
    Reversed,
}

impl DepthConvention {
    /// NDC depth of the near and of the far plane.
    #[must_use]
    pub fn near_far(self) -> (f64, f64) {
        match self {
            Self::ZeroToOne => (0.0, 1.0),
            Self::MinusOneToOne => (-1.0, 1.0),
            Self::Reversed => (1.0, 0.0),
        }
    }
}

/// The visible volume, a box or a pyramid: the window on the near plane, and the distances of both
/// planes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frustum {
    /// Left edge on the near plane.
    pub left: f64,
    /// Right edge.
    pub right: f64,
    /// Bottom edge.
    pub bottom: f64,
    /// Top edge.
    pub top: f64,
    /// Distance of the near plane; > 0 for perspectives.
    pub near: f64,
    /// Distance of the far plane; may be infinite for perspectives.
    pub far: f64,
}

impl Frustum {
    /// The frustum around the −z axis whose window reaches `right` and `top` on the near plane.
    fn centered(right: f64, top: f64, near: f64, far: f64) -> Self {
        Self {
            left: -right,
            right,
            bottom: -top,
            top,
            near,
            far,
        }
    }
}

/// The off-centre perspective.
///
/// Clip z = A·z + B and w = −z, with A and B such that z = −n and z = −f land on the convention's
/// depths d_n and d_f: A = (d_n·n − d_f·f)/(f − n), B = n·f·(d_n − d_f)/(f − n); with f = ∞ their
/// limits.
#[must_use]
pub fn frustum(f: &Frustum, convention: DepthConvention) -> DMat4 {
    let (near_depth, far_depth) = convention.near_far();
    let (a, b) = if f.far.is_infinite() {
        (-far_depth, f.near * (near_depth - far_depth))
    } else {
        let range = f.far - f.near;
        (
            (near_depth * f.near - far_depth * f.far) / range,
            f.near * f.far * (near_depth - far_depth) / range,
        )
    };
    let (width, height) = (f.right - f.left, f.top - f.bottom);
    DMat4::from_cols(
        DVec4::new(2.0 * f.near / width, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 2.0 * f.near / height, 0.0, 0.0),
        DVec4::new(
            (f.right + f.left) / width,
            (f.top + f.bottom) / height,
            a,
            -1.0,
        ),
        DVec4::new(0.0, 0.0, b, 0.0),
    )
}

/// The centred perspective with a vertical opening angle; `aspect` is width ÷ height, and `far` may
/// be infinite.
#[must_use]
pub fn perspective(
    fov_y_rad: f64,
    aspect: f64,
    near: f64,
    far: f64,
    convention: DepthConvention,
) -> DMat4 {
    let top = near * libm::tan(fov_y_rad / 2.0);
    let right = top * aspect;
    frustum(&Frustum::centered(right, top, near, far), convention)
}

/// The centred perspective with a horizontal opening angle.
#[must_use]
pub fn perspective_horizontal(
    fov_x_rad: f64,
    aspect: f64,
    near: f64,
    far: f64,
    convention: DepthConvention,
) -> DMat4 {
    let right = near * libm::tan(fov_x_rad / 2.0);
    let top = right / aspect;
    frustum(&Frustum::centered(right, top, near, far), convention)
}

/// The orthographic projection; near and far are distances along −z and may be negative.
#[must_use]
pub fn orthographic(f: &Frustum, convention: DepthConvention) -> DMat4 {
    let (near_depth, far_depth) = convention.near_far();
    let (width, height, range) = (f.right - f.left, f.top - f.bottom, f.far - f.near);
    DMat4::from_cols(
        DVec4::new(2.0 / width, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 2.0 / height, 0.0, 0.0),
        DVec4::new(0.0, 0.0, (near_depth - far_depth) / range, 0.0),
        DVec4::new(
            -(f.right + f.left) / width,
            -(f.top + f.bottom) / height,
            (near_depth * f.far - far_depth * f.near) / range,
            1.0,
        ),
    )
}

/// The teaching form of the central projection, for a view whose origin is the centre of the scene
/// and whose eye stands at z = `d`: z is kept, w = 1 − z/d. An infinite `d` is a parallel
/// projection.
#[must_use]
pub fn central_teaching(d: f64) -> DMat4 {
    DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, 1.0, -d.recip()),
        DVec4::W,
    )
}

/// The central projection for the pipeline, with planes at z_far < z_near < d:
/// w = 1 − z/d, clip z = (z_near − z)·(1 − z_far/d)/(z_near − z_far).
#[must_use]
pub fn central(d: f64, z_near: f64, z_far: f64) -> DMat4 {
    let slope = (1.0 - z_far / d) / (z_near - z_far);
    DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, -slope, -d.recip()),
        DVec4::new(0.0, 0.0, z_near * slope, 1.0),
    )
}
