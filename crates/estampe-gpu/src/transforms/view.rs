//! The camera's frame, and the view that inverts it.
//!
//! ```text
//!          up (y)
//!          │
//!          │   centre
//!          │  ·
//!    eye ──┘─────── right (x)        the camera looks along −back
//!         ╱
//!   back (z)
//! ```

use glam::{DMat4, DVec3, DVec4};

/// Position and orientation of a camera: an orthonormal, right-handed frame in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraFrame {
    /// Direction to the right in the image.
    pub right_world: DVec3,
    /// Direction up in the image.
    pub up_world: DVec3,
    /// Towards the viewer: the opposite of the view direction.
    pub back_world: DVec3,
    /// The eye's position.
    pub eye_world: DVec3,
}

impl CameraFrame {
    /// A camera at `eye` that looks at `centre`: z = normalize(eye − centre), x = normalize(up ×
    /// z), y = z × x.
    ///
    /// If `eye` equals `centre`, the camera looks down −z. If `up` is parallel to the view
    /// direction, the less parallel one of the world axes Y and Z replaces it.
    #[must_use]
    pub fn look_at(eye_world: DVec3, centre_world: DVec3, up_world: DVec3) -> Self {
        let back = (eye_world - centre_world).normalize_or_zero();
        let back = if back == DVec3::ZERO { DVec3::Z } else { back };
        let usable = |up: DVec3| {
            let right = up.normalize_or_zero().cross(back);
            (right.length_squared() > 1e-20).then(|| right.normalize())
        };
        let least = if back.y.abs() < 0.8 {
            DVec3::Y
        } else {
            DVec3::Z
        };
        let right = usable(up_world)
            .or_else(|| usable(least))
            .expect("of Y and Z, the one that is less parallel to `back` makes an angle with it");
        Self {
            right_world: right,
            up_world: back.cross(right),
            back_world: back,
            eye_world,
        }
    }

    /// The camera matrix: columns right, up, back, eye.
    #[must_use]
    pub fn world_from_view(&self) -> DMat4 {
        DMat4::from_cols(
            self.right_world.extend(0.0),
            self.up_world.extend(0.0),
            self.back_world.extend(0.0),
            self.eye_world.extend(1.0),
        )
    }

    /// The view matrix, the camera matrix's inverse: [Rᵀ | −Rᵀ·eye].
    #[must_use]
    pub fn view_from_world(&self) -> DMat4 {
        self.turned_about(self.eye_world)
    }

    /// The view that puts `centre` at the origin instead of the eye, Rᵀ(p − centre); for central
    /// projections, whose eye stands at z = d.
    #[must_use]
    pub fn centred_view_from_world(&self, centre_world: DVec3) -> DMat4 {
        self.turned_about(centre_world)
    }

    fn turned_about(&self, origin: DVec3) -> DMat4 {
        let (r, u, b) = (self.right_world, self.up_world, self.back_world);
        DMat4::from_cols(
            DVec4::new(r.x, u.x, b.x, 0.0),
            DVec4::new(r.y, u.y, b.y, 0.0),
            DVec4::new(r.z, u.z, b.z, 0.0),
            DVec4::new(-r.dot(origin), -u.dot(origin), -b.dot(origin), 1.0),
        )
    }
}
