//! The ground under a model, which shows nothing but the model's soft shadow.
//!
//! ```text
//!   model ── two passes, from below and from above ──► Columns: what is filled, above each place
//!   surroundings ──► Sky: the light of directions                │
//!                       └──────────────┬─────────────────────────┘
//!                                  occlusion: the share of the light that each place loses
//!                                      └──► a texture of alphas, drawn as a black rectangle
//! ```

mod columns;
mod draw;
mod occlusion;
mod sky;

pub(crate) use columns::ColumnMaps;
pub(crate) use draw::GroundShadow;
pub(crate) use sky::Sky;

#[cfg(test)]
mod tests;

use crate::options::{Ground, RenderOptions};
use crate::scene_view::SceneView;
use glam::DVec3;

/// Where the ground is, in unit space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GroundFrame {
    /// Unit directions: along the ground, along the ground, up.
    pub(crate) axes: [DVec3; 3],
    /// The middle of the model's box on the ground.
    pub(crate) middle: DVec3,
    /// Half of the sides of the model's box along the ground: a square.
    pub(crate) half: f64,
    /// The height of the model's box.
    pub(crate) height: f64,
}

impl RenderOptions {
    /// True if a ground is drawn: numbers and wireframes stand on none.
    pub(crate) fn has_ground(&self) -> bool {
        self.ground == Ground::Shadow && self.shading.is_shaded() && self.program.is_none()
    }
}

impl GroundFrame {
    /// The ground under the model.
    pub(crate) fn new(view: &SceneView) -> Self {
        let up = view.up_world;
        let along = if up.y.abs() > 0.9 { DVec3::X } else { DVec3::Y };
        let first = (along - up * along.dot(up)).normalize();
        let axes = [first, up.cross(first), up];
        let corners = view.space.corners();
        let extent = |axis: DVec3| {
            let heights = corners.map(|corner| corner.dot(axis));
            heights
                .into_iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), h| {
                    (a.min(h), b.max(h))
                })
        };
        let [(x0, x1), (y0, y1), (_, highest)] = axes.map(extent);
        let lowest = view.lowest;
        let middle = axes[0] * ((x0 + x1) / 2.0) + axes[1] * ((y0 + y1) / 2.0) + up * lowest;
        Self {
            axes,
            middle,
            half: ((x1 - x0).max(y1 - y0) / 2.0).max(1e-3),
            height: (highest - lowest).max(1e-3),
        }
    }

    /// Half of the side of the square that shows a shadow.
    pub(crate) fn reach(&self) -> f64 {
        /// Border around the model in heights of it: long shadows of low light fade there.
        const BORDER: f64 = 1.1;
        self.half + BORDER * self.height + 0.1 * self.half
    }
}
