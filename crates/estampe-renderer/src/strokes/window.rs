//! Points and lines in the window.

use glam::{DMat4, DVec2, DVec3, DVec4};

/// The projection to a window.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    pub(crate) clip_from_unit: DMat4,
    /// Width and height, in pixels.
    pub(crate) size_px: DVec2,
}

/// A point in the window: pixels to the right and downwards, and depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct WindowPoint {
    pub(crate) at_px: DVec2,
    pub(crate) depth: f64,
}

/// The least w of a point before the eye: nearer points are cut off.
const LEAST_W: f64 = 1e-4;
/// How far lines go on outside of the window, in pixels.
const BORDER_PX: f64 = 128.0;

impl Window {
    fn clip(&self, unit: DVec3) -> DVec4 {
        self.clip_from_unit * unit.extend(1.0)
    }

    /// The point in the window, if it is before the eye.
    pub(crate) fn point(&self, unit: DVec3) -> Option<WindowPoint> {
        self.of_clip(self.clip(unit))
    }

    fn of_clip(&self, clip: DVec4) -> Option<WindowPoint> {
        // NaN is not before the eye.
        let is_before_the_eye = clip.w >= LEAST_W;
        if !is_before_the_eye {
            return None;
        }
        let ndc = clip.truncate() / clip.w;
        let at = DVec2::new(ndc.x + 1.0, 1.0 - ndc.y) / 2.0;
        Some(WindowPoint {
            at_px: at * self.size_px,
            depth: ndc.z,
        })
    }

    /// Normalized device coordinates of a point in the window.
    pub(crate) fn ndc(&self, point: WindowPoint) -> DVec3 {
        let at = point.at_px / self.size_px * 2.0;
        DVec3::new(at.x - 1.0, 1.0 - at.y, point.depth)
    }

    /// The ends of the visible part of a line, each with its share of the way from the first to the
    /// second end in the window; `None` if nothing is visible.
    pub(crate) fn line(&self, ends: [DVec3; 2]) -> Option<[(WindowPoint, f64); 2]> {
        let [a, b] = ends.map(|end| self.clip(end));
        let (mut first, mut last) = (0.0, 1.0);
        // w is linear between the ends.
        let crossing = (LEAST_W * 2.0 - a.w) / (b.w - a.w);
        match (a.w >= LEAST_W, b.w >= LEAST_W) {
            (true, true) => {}
            (true, false) => last = crossing,
            (false, true) => first = crossing,
            (false, false) => return None,
        }
        let from = self.of_clip(a.lerp(b, first))?;
        let to = self.of_clip(a.lerp(b, last))?;
        let (enter, leave) = self.visible(from.at_px, to.at_px)?;
        let at = |share: f64| {
            let point = WindowPoint {
                at_px: from.at_px.lerp(to.at_px, share),
                depth: from.depth + (to.depth - from.depth) * share,
            };
            (point, first + (last - first) * share)
        };
        Some([at(enter), at(leave)])
    }

    /// The shares between which a line is in the window or its border (Liang and Barsky 1984).
    fn visible(&self, from: DVec2, to: DVec2) -> Option<(f64, f64)> {
        let way = to - from;
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let (low, high) = (-BORDER_PX, self.size_px[axis] + BORDER_PX);
            if way[axis] == 0.0 {
                if !(low..=high).contains(&from[axis]) {
                    return None;
                }
                continue;
            }
            let shares = [low, high].map(|border| (border - from[axis]) / way[axis]);
            enter = enter.max(shares[0].min(shares[1]));
            leave = leave.min(shares[0].max(shares[1]));
        }
        // NaN is nowhere.
        (enter < leave || enter == leave && way == DVec2::ZERO).then_some((enter, leave))
    }
}
