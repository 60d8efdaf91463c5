//! The least separation, found by evaluating the depths that the pipeline stores.

use super::DepthMethod;
use super::method::LIMITS;

/// The most distances that one window is sampled at.
const SAMPLES: u32 = 1 << 14;

/// Distances that stand for infinity without a far plane: rounding gives depths next to that of
/// infinity at some distances beyond.
const ENDLESS: f32 = 1e28;

/// The relative error of one operation in f32.
const ROUNDING: f64 = 1.0 / 16_777_216.0;

/// The error of the shaders' log₂, in units of max(|log₂ x|, 1).
const LOGARITHM_ERROR: f64 = 3.6e-7;

impl DepthMethod {
    /// The least separation that is told apart around a distance between the planes: any surface at
    /// or before `distance`, and any at or behind it, are shown in the right order if they are at
    /// least this far apart. `None` if surfaces up to the far plane are not told apart from some
    /// surface at or before `distance`, or if the distance is not between the planes.
    ///
    /// Depths that f32 computes do not grow with every step of the distance: they also fall, by
    /// rounding. The search looks for the widest pair of distances in the wrong order, or of equal
    /// depth, among all floats of a window if they are at most 2¹⁴, else among as many, evenly
    /// spread; the separation is then exact to a thousandth of itself.
    #[must_use]
    pub fn least_separation(&self, distance: f64) -> Option<f64> {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "rounds to the nearest float"
        )]
        let at = distance as f32;
        if !(self.near..=self.far.min(*LIMITS.end())).contains(&at) {
            return None;
        }
        let depth = self.depth(f64::from(at));
        let mut reach = 2.0 * (self.format.step(depth) + 2.0 * self.rounding(f64::from(at)));
        loop {
            let window = self.window(at, depth, reach);
            let [from, to] = self.widest_confused_pair(at, &window);
            let is_endless = self.far.is_infinite() && f32::from_bits(to) > ENDLESS;
            if window.is_last_the_limit && (to == window.last || is_endless) {
                return None;
            }
            let is_inside = from > window.first || window.is_first_the_limit;
            if is_inside && to < window.last {
                // The next sample is the first of those that are told apart.
                let next = f32::from_bits(to + window.stride);
                return Some(f64::from(next) - f64::from(f32::from_bits(from)));
            }
            reach *= 4.0;
        }
    }

    /// A bound of the error of a depth that f32 computes, but for the rounding of the format.
    fn rounding(&self, distance: f64) -> f64 {
        let depth = self.depth(distance);
        if self.mapping.is_logarithmic {
            let [near, far] = [self.near, self.far].map(f64::from);
            let logs = [distance, far].map(|z| libm::log2(z / near));
            LOGARITHM_ERROR * (logs[0].max(1.0) / logs[1]) + ROUNDING * 4.0
        } else {
            ROUNDING * (f64::from(self.clip[0]).abs() + 4.0 * depth)
        }
    }

    /// The distances whose depths differ by at most `reach`, and eight floats or more on each
    /// side.
    fn window(&self, at: f32, depth: f64, reach: f64) -> Window {
        const LEAST: u32 = 8;
        let limits = [self.near, self.far.min(*LIMITS.end())].map(f32::to_bits);
        let towards = if self.mapping.is_reversed {
            -reach
        } else {
            reach
        };
        let ends = [depth - towards, depth + towards].map(|depth| self.distance(depth));
        let bits = at.to_bits();
        #[expect(
            clippy::cast_possible_truncation,
            reason = "rounds to the nearest float"
        )]
        let bits_of = |distance: f64| (distance as f32).to_bits();
        let first = if ends[0] > 0.0 { bits_of(ends[0]) } else { 0 };
        let first = first.min(bits.saturating_sub(LEAST)).max(limits[0]);
        // Beyond the depth of infinity the inverse is negative or infinite.
        let last = if ends[1] > 0.0 {
            bits_of(ends[1])
        } else {
            limits[1]
        };
        let last = last.max(bits.saturating_add(LEAST)).min(limits[1]);
        Window {
            first,
            last,
            stride: ((last - first) / SAMPLES).max(1),
            is_first_the_limit: first == limits[0],
            is_last_the_limit: last == limits[1],
        }
    }

    /// The widest pair of distances, the first at or before `at`, the second at or behind it, that
    /// is not told apart: both as bits.
    fn widest_confused_pair(&self, at: f32, window: &Window) -> [u32; 2] {
        let at = at.to_bits();
        let rank = |bits: u32| self.rank(f32::from_bits(bits));
        let width = |pair: [u32; 2]| {
            let [from, to] = pair.map(|bits| f64::from(f32::from_bits(bits)));
            to - from
        };
        // From the far end on: the farthest distance of each rank that is less than all behind it.
        let mut behind: Vec<(i64, u32)> = Vec::new();
        for bits in window.samples_down_to(at) {
            let rank = rank(bits);
            if behind.last().is_none_or(|(least, _)| rank < *least) {
                behind.push((rank, bits));
            }
        }
        // From the near end on: the nearest distance of each rank that is above all before it, and
        // the farthest distance whose rank is no greater. Both grow together.
        let mut widest = [at, at];
        let mut greatest = i64::MIN;
        for bits in window.samples_up_to(at) {
            let rank = rank(bits);
            if rank <= greatest {
                continue;
            }
            greatest = rank;
            let confused = behind.partition_point(|(least, _)| *least > rank);
            if let Some((_, to)) = behind.get(confused)
                && width([bits, *to]) > width(widest)
            {
                widest = [bits, *to];
            }
        }
        widest
    }
}

/// Distances around one, as the bits of f32.
struct Window {
    first: u32,
    last: u32,
    /// From sample to sample.
    stride: u32,
    /// True if the first distance is that of the near plane.
    is_first_the_limit: bool,
    /// True if the last distance is that of the far plane.
    is_last_the_limit: bool,
}

impl Window {
    /// From the last to `at`, which is included.
    fn samples_down_to(&self, at: u32) -> impl Iterator<Item = u32> {
        let (last, stride) = (self.last, self.stride);
        let count = (last - at) / stride;
        (0..=count).map(move |i| last - i * stride).chain([at])
    }

    /// From the first to `at`, which is included.
    fn samples_up_to(&self, at: u32) -> impl Iterator<Item = u32> {
        let (first, stride) = (self.first, self.stride);
        let count = (at - first) / stride;
        (0..=count).map(move |i| first + i * stride).chain([at])
    }
}
