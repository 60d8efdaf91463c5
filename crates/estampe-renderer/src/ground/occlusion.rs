//! The share of the light from above that the model takes from each place of the ground.
//!
//! From a place, rays go out in some directions along the ground; the columns that they cross hide
//! the elevations between their lowest and their highest surface. Bins of elevations are equal in
//! what they give a level surface (the square of the sine), so a place's light is the mean over
//! directions and bins of the light from there. Neighbouring places take other directions, whose
//! mean is taken afterwards, as of four times the directions.

use super::GroundFrame;
use super::columns::{Columns, columns_f32};
use super::sky::Sky;
use crate::transforms::round_to_f32;
use estampe_scene::Workers;

/// The side of the shadow's texture.
pub(super) const SIDE: usize = 128;

const DIRECTIONS: usize = 12;
/// The places whose directions differ: a square of 2×2.
const PATTERNS: usize = 4;
const BINS: usize = 8;

/// A direction along the ground with the light of its elevations.
#[derive(Debug, Clone, Copy)]
struct Direction {
    x: f32,
    y: f32,
    light: [f32; BINS],
}

/// The shares of light that are hidden, 0 to 1: rows from the far end of the second axis.
pub(super) fn hidden_light(
    frame: &GroundFrame,
    columns: &Columns,
    sky: &Sky,
    workers: Workers,
) -> Vec<f32> {
    let patterns: [_; PATTERNS] = std::array::from_fn(|pattern| directions(frame, sky, pattern));
    let reach = round_to_f32(frame.reach());
    let texel = 2.0 * reach / columns_f32(SIDE);
    let rows = workers.map(0..SIDE, |row| {
        let place = |column: usize| {
            let x = (columns_f32(column) + 0.5) * texel - reach;
            let y = reach - (columns_f32(row) + 0.5) * texel;
            let pattern = &patterns[(row & 1) * 2 + (column & 1)];
            hidden_at([x, y], columns, pattern, texel)
        };
        (0..SIDE).map(place).collect::<Vec<f32>>()
    });
    smooth(&rows.concat())
}

/// The directions of a pattern.
fn directions(frame: &GroundFrame, sky: &Sky, pattern: usize) -> Vec<Direction> {
    let count = u32::try_from(DIRECTIONS * PATTERNS).unwrap_or(u32::MAX);
    let numbers = (0..DIRECTIONS).map(|k| u32::try_from(k * PATTERNS + pattern).unwrap_or(0));
    let direction = |number: u32| {
        let turn = std::f64::consts::TAU * (f64::from(number) + 0.5) / f64::from(count);
        let (sin, cos) = libm::sincos(turn);
        let along = frame.axes[0] * cos + frame.axes[1] * sin;
        let light = std::array::from_fn(|bin| {
            let squared_sine = (f64::from(columns_f32(bin)) + 0.5) / f64::from(columns_f32(BINS));
            let level = along * (1.0 - squared_sine).sqrt();
            sky.luminance(level + frame.axes[2] * squared_sine.sqrt())
        });
        Direction {
            x: round_to_f32(cos),
            y: round_to_f32(sin),
            light,
        }
    };
    numbers.map(direction).collect()
}

/// The share that is hidden of a place.
fn hidden_at([x, y]: [f32; 2], columns: &Columns, directions: &[Direction], texel: f32) -> f32 {
    let (mut hidden, mut whole) = (0.0, 0.0);
    for direction in directions {
        let covered = covered_elevations([x, y], columns, direction, texel);
        for (covered, light) in covered.iter().zip(&direction.light) {
            hidden += covered * light;
            whole += light;
        }
    }
    if whole > 0.0 { hidden / whole } else { 0.0 }
}

/// For each bin, the share of it that columns in a direction cover: between the lowest and the
/// highest elevation in the bin that one of them covers.
fn covered_elevations(
    [x, y]: [f32; 2],
    columns: &Columns,
    direction: &Direction,
    texel: f32,
) -> [f32; BINS] {
    let bins: [f32; BINS] = std::array::from_fn(columns_f32);
    let (mut least, mut most) = (bins.map(|bin| bin + 1.0), bins);
    let Some((near, far)) = crossing([x, y], columns.half, direction) else {
        return [0.0; BINS];
    };
    // Steps grow with the distance, as what a step covers becomes smaller.
    let shortest = texel * 0.25;
    let mut distance = near;
    while distance < far {
        let step = (distance * 0.12).max(shortest);
        let middle = distance + step * 0.5;
        if let Some([low, high]) = columns.at(x + direction.x * middle, y + direction.y * middle) {
            // What is level covers what lies between its elevations at both ends of the step.
            let low = elevation(low, distance + step);
            let high = elevation(high, distance);
            for ((least, most), bin) in least.iter_mut().zip(&mut most).zip(&bins) {
                if low < bin + 1.0 && high > *bin {
                    *least = least.min(low.max(*bin));
                    *most = most.max(high.min(bin + 1.0));
                }
            }
        }
        distance += step;
    }
    std::array::from_fn(|bin| (most[bin] - least[bin]).max(0.0))
}

/// The elevation of a height in a distance, in bins: the square of its sine times their number.
#[inline]
fn elevation(height: f32, distance: f32) -> f32 {
    let (height, distance) = (height * height, distance * distance);
    columns_f32(BINS) * height / (height + distance).max(f32::MIN_POSITIVE)
}

/// The distances at which a ray enters and leaves the square of the columns.
fn crossing([x, y]: [f32; 2], half: f32, direction: &Direction) -> Option<(f32, f32)> {
    let (mut near, mut far) = (0.0_f32, f32::INFINITY);
    for (start, slope) in [(x, direction.x), (y, direction.y)] {
        if slope.abs() < 1e-6 {
            if start.abs() > half {
                return None;
            }
            continue;
        }
        let (a, b) = ((-half - start) / slope, (half - start) / slope);
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    (near < far).then_some((near, far))
}

/// The mean of each place with its neighbours: weights 1, 2, 1 in both directions, in which each
/// pattern has the same weight.
fn smooth(places: &[f32]) -> Vec<f32> {
    let last = SIDE - 1;
    let line = |at: &dyn Fn(usize) -> f32, k: usize| {
        (at(k.saturating_sub(1)) + 2.0 * at(k) + at((k + 1).min(last))) * 0.25
    };
    let across = |row: usize, column: usize| line(&|k| places[row * SIDE + k], column);
    let mut smoothed = Vec::with_capacity(places.len());
    for row in 0..SIDE {
        for column in 0..SIDE {
            smoothed.push(line(&|k| across(k, column), row));
        }
    }
    smoothed
}

/// The alphas of the shadow: what is little becomes less, so that the shadow ends near the model,
/// and nothing remains at the border.
pub(super) fn alphas(hidden: &[f32]) -> Vec<f32> {
    /// The share of the light that is halved.
    const KNEE: f32 = 0.1;
    let alpha = |(place, hidden): (usize, &f32)| {
        let curved = hidden * hidden * (1.0 + KNEE) / (hidden + KNEE);
        curved * at_border(place / SIDE) * at_border(place % SIDE)
    };
    hidden.iter().enumerate().map(alpha).collect()
}

/// 1 in the middle, and 0 at the ends.
fn at_border(k: usize) -> f32 {
    const WIDTH: f32 = 24.0;
    let from_end = columns_f32(k.min(SIDE - 1 - k));
    let t = (from_end / WIDTH).min(1.0);
    t * t * (3.0 - 2.0 * t)
}
