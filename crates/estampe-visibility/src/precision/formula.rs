//! Closed formulas of depth precision: real numbers, rounded by the format alone.

use super::{DepthFormat, DepthMethod};

impl DepthFormat {
    /// The least distance of the near plane with which a fixed-point format tells surfaces at
    /// `distance` and `separation` behind it apart, with the far plane at `far` and hyperbolic
    /// depth; `None` of floats.
    ///
    /// With δ the format's step, n·f/(f − n) ≥ K = δ·z·(z + s)/s, so n ≥ K·f/(f + K).
    #[must_use]
    pub fn least_near(self, distance: f64, separation: f64, far: f64) -> Option<f64> {
        if self == Self::Float32 {
            return None;
        }
        let k = self.step(1.0) * distance * (distance + separation) / separation;
        Some(if far.is_infinite() {
            k
        } else {
            k * (far / (far + k))
        })
    }
}

impl DepthMethod {
    /// The depth at a distance, in real numbers.
    #[must_use]
    pub fn depth(&self, distance: f64) -> f64 {
        let [near, far] = [self.near, self.far].map(f64::from);
        let z = distance;
        let depth = if self.mapping.is_logarithmic {
            libm::log(z / near) / libm::log(far / near)
        } else if far.is_infinite() {
            1.0 - near / z
        } else {
            far * (z - near) / (z * (far - near))
        };
        match (self.mapping.is_reversed, self.mapping.is_logarithmic) {
            (false, _) => depth,
            (true, true) => 1.0 - depth,
            // 1 − d, without its cancellation.
            (true, false) if far.is_infinite() => near / z,
            (true, false) => near * (far - z) / (z * (far - near)),
        }
    }

    /// The distance of a depth: the inverse of [`depth`](Self::depth).
    #[must_use]
    pub fn distance(&self, depth: f64) -> f64 {
        let [near, far] = [self.near, self.far].map(f64::from);
        if self.mapping.is_logarithmic {
            let share = if self.mapping.is_reversed {
                1.0 - depth
            } else {
                depth
            };
            return near * libm::pow(far / near, share);
        }
        match (self.mapping.is_reversed, far.is_infinite()) {
            (false, false) => near * far / (far - depth * (far - near)),
            (true, false) => near * far / (near + depth * (far - near)),
            (false, true) => near / (1.0 - depth),
            (true, true) => near / depth,
        }
    }

    /// The separation s of two surfaces that the format's steps tell apart, the first at
    /// `distance`: see the [module](super). `None` if no surface before the far plane is told apart from the
    /// first.
    #[must_use]
    pub fn formula(&self, distance: f64) -> Option<f64> {
        let [near, far] = [self.near, self.far].map(f64::from);
        let step = self.format.step(self.depth(distance));
        let separation = if self.mapping.is_logarithmic {
            distance * libm::expm1(step * libm::log(far / near))
        } else {
            let scale = if far.is_infinite() {
                near
            } else {
                near * (far / (far - near))
            };
            let remaining = scale - step * distance;
            if remaining <= 0.0 {
                return None;
            }
            step * distance * (distance / remaining)
        };
        (distance + separation <= far).then_some(separation)
    }
}
