//! Interpolation of keyframes.
//!
//! ```text
//! step    v₀
//! linear  v₀ + t (v₁ − v₀), rotations along the shorter arc of a great circle
//! cubic   (2t³ − 3t² + 1) v₀ + d (t³ − 2t² + t) b₀ + (−2t³ + 3t²) v₁ + d (t³ − t²) a₁
//! ```
//!
//! t is the time between the two keyframes as 0..1, d the time from one to the other, a and b the
//! tangents before and after a keyframe. All is computed in f64, with libm's functions.

/// How values between keyframes are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Interpolation {
    Step,
    Linear,
    CubicSpline,
}

impl Interpolation {
    /// Elements stored for each keyframe.
    pub(super) fn parts(self) -> usize {
        match self {
            Self::Step | Self::Linear => 1,
            Self::CubicSpline => 3,
        }
    }
}

/// The keyframes around a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Keys {
    /// Number of all keyframes.
    pub(super) count: usize,
    pub(super) before: usize,
    pub(super) after: usize,
    /// Where the time is between the two, 0..1.
    fraction: f64,
    /// Time between the two.
    distance_s: f64,
}

impl Keys {
    /// The keyframes around a time; the first or the last one outside of them. `times` increase,
    /// and there is at least one.
    pub(super) fn find(times: &[[f32; 1]], time_s: f32) -> Self {
        let after = times.partition_point(|&[time]| time <= time_s);
        let last = times.len() - 1;
        let alone = |keyframe: usize| Self {
            count: times.len(),
            before: keyframe,
            after: keyframe,
            fraction: 0.0,
            distance_s: 0.0,
        };
        if after == 0 || after > last {
            return alone(after.min(last));
        }
        let [start] = times[after - 1].map(f64::from);
        let [end] = times[after].map(f64::from);
        Self {
            count: times.len(),
            before: after - 1,
            after,
            fraction: (f64::from(time_s) - start) / (end - start),
            distance_s: end - start,
        }
    }
}

/// The value at the time. `value` returns the parts of the two keyframes, one after the other.
pub(super) fn vector<const N: usize>(
    interpolation: Interpolation,
    keys: &Keys,
    value: impl Fn(usize) -> [f64; N],
) -> [f64; N] {
    let t = keys.fraction;
    match interpolation {
        Interpolation::Step => value(0),
        Interpolation::Linear => {
            let [start, end] = [value(0), value(1)];
            std::array::from_fn(|i| start[i] * (1.0 - t) + end[i] * t)
        }
        Interpolation::CubicSpline => {
            let [start, leaving] = [value(1), value(2)];
            let [arriving, end] = [value(3), value(4)];
            let (t2, t3) = (t * t, t * t * t);
            let d = keys.distance_s;
            std::array::from_fn(|i| {
                (2.0 * t3 - 3.0 * t2 + 1.0) * start[i]
                    + d * (t3 - 2.0 * t2 + t) * leaving[i]
                    + (3.0 * t2 - 2.0 * t3) * end[i]
                    + d * (t3 - t2) * arriving[i]
            })
        }
    }
}

/// The rotation at the time, a quaternion that need not have unit length.
pub(super) fn rotation(
    interpolation: Interpolation,
    keys: &Keys,
    value: impl Fn(usize) -> [f64; 4],
) -> [f64; 4] {
    match interpolation {
        Interpolation::Linear => slerp(value(0), value(1), keys.fraction),
        Interpolation::Step | Interpolation::CubicSpline => vector(interpolation, keys, value),
    }
}

/// Spherical linear interpolation along the shorter arc.
fn slerp(start: [f64; 4], end: [f64; 4], t: f64) -> [f64; 4] {
    /// Above it the arc is as good as straight, and its sine too small to divide by.
    const STRAIGHT: f64 = 0.999_999;
    let dot: f64 = start.iter().zip(end).map(|(a, b)| a * b).sum();
    // A quaternion and its negative are the same rotation.
    let sign = if dot < 0.0 { -1.0 } else { 1.0 };
    let cosine = dot.abs();
    let [a, b] = if cosine > STRAIGHT {
        [1.0 - t, t]
    } else {
        let angle = libm::acos(cosine);
        let sine = libm::sin(angle);
        [
            libm::sin((1.0 - t) * angle) / sine,
            libm::sin(t * angle) / sine,
        ]
    };
    std::array::from_fn(|i| a * start[i] + sign * b * end[i])
}
