//! A grid on the ground at the model's lowest point.
//!
//! Its lines have distances of 1, 2 or 5 times a power of ten, in the units of the file, and go
//! through the multiples of it; every fifth (of steps of 5: every second) is stronger. The lines
//! through the origin have the colours of their axes. Lines fade with the distance from the model.

use super::axis_of;
use crate::ground::GroundFrame;
use crate::scene_view::SceneView;
use crate::strokes::Stroke;
use crate::transforms::round_to_f32;
use glam::DVec3;

/// The strokes of a grid.
#[derive(Debug, Default)]
pub(crate) struct GridStrokes {
    /// All lines but the axes.
    pub(crate) lines: Vec<Stroke>,
    /// Lines along the file's x, y and z axis through the origin.
    pub(crate) axes: [Vec<Stroke>; 3],
}

/// The least number of steps across the model.
const LEAST_STEPS: f64 = 5.0;
/// How far below the model the grid is, in unit space, so that a flat bottom hides it.
const BELOW: f64 = 2e-4;
const MINOR_ALPHA: f64 = 0.28;
const MAJOR_ALPHA: f64 = 0.6;
const AXIS_ALPHA: f64 = 0.9;

/// Steps of a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Steps {
    /// The distance of lines, in world units.
    pub(super) step: f64,
    /// Every so many lines one is stronger.
    pub(super) major: f64,
}

impl Steps {
    /// The greatest steps of which a length has at least [`LEAST_STEPS`].
    pub(super) fn of(length_world: f64) -> Self {
        // NaN, of no model, becomes the least.
        let most = (length_world / LEAST_STEPS).max(1e-300);
        let decade = libm::floor(libm::log10(most)).clamp(-300.0, 300.0);
        let power = libm::exp10(decade);
        let (factor, major) = if most >= power * 5.0 {
            (5.0, 2.0)
        } else if most >= power * 2.0 {
            (2.0, 5.0)
        } else {
            (1.0, 5.0)
        };
        Self {
            step: power * factor,
            major,
        }
    }
}

/// The grid of a view.
pub(crate) fn grid_strokes(view: &SceneView) -> GridStrokes {
    let frame = GroundFrame::new(view);
    let per_unit = view.space.world_per_unit();
    let extent = frame.half.max(frame.height / 2.0);
    let Steps { step, major } = Steps::of(2.0 * extent * per_unit);
    let step = step / per_unit;
    let reach = extent * 1.5 + step * 2.0;
    let middle = frame.middle - frame.axes[2] * BELOW;
    let origin = view.space.unit_from_world(DVec3::ZERO);
    let mut strokes = GridStrokes::default();
    for (along, across) in [(0, 1), (1, 0)] {
        let (along, across) = (frame.axes[along], frame.axes[across]);
        let axis = axis_of(view, along);
        // Numbers of lines, counted from the one through the origin.
        let of_middle = (middle - origin).dot(across) / step;
        let lines = libm::ceil(reach / step).min(64.0);
        let first = libm::floor(of_middle) - lines;
        for k in 0..=round_up(2.0 * lines + 1.0) {
            let number = first + f64::from(k);
            let aside = (number - of_middle) * step;
            let half = libm::sqrt((reach * reach - aside * aside).max(0.0));
            if half <= 0.0 {
                continue;
            }
            let is_axis = number == 0.0;
            let is_major = number - major * libm::floor(number / major) == 0.0;
            let strongest = match (is_axis && axis.is_some(), is_major) {
                (true, _) => AXIS_ALPHA,
                (false, true) => MAJOR_ALPHA,
                (false, false) => MINOR_ALPHA,
            };
            let alpha = |way: f64| {
                let far = (way * way + aside * aside) / (reach * reach);
                let fading = (1.0 - far).max(0.0);
                round_to_f32(strongest * fading)
            };
            let pieces = 16;
            let target = match axis {
                Some(axis) if is_axis => &mut strokes.axes[axis],
                _ => &mut strokes.lines,
            };
            for piece in 0..pieces {
                let way = |piece: i32| half * (f64::from(piece * 2) / f64::from(pieces) - 1.0);
                let ways = [way(piece), way(piece + 1)];
                let ends = ways.map(|way| middle + across * aside + along * way);
                target.push(Stroke {
                    ends,
                    faces: [Some(ends[0] + across * step), Some(ends[0] - across * step)],
                    alphas: ways.map(alpha),
                });
            }
        }
    }
    strokes
}

/// A small number of lines.
fn round_up(count: f64) -> u32 {
    (0..1024).find(|&n| f64::from(n) >= count).unwrap_or(1024)
}
