//! Depth methods: from a distance to the number that a depth buffer stores, as the pipeline rounds.

use estampe::{Mat4, Real, TextureFormat, maths};
use estampe_format::depth::FixedDepth;

/// A format of depth buffers, with or without stencil.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DepthFormat {
    /// 16 bits, fixed point: steps of 1/65535.
    Unorm16,
    /// 24 bits, fixed point: steps of 1/16777215.
    Unorm24,
    /// Floats of 32 bits: 24 significant bits.
    Float32,
}

impl DepthFormat {
    /// All formats, from the coarsest on.
    pub const ALL: [Self; 3] = [Self::Unorm16, Self::Unorm24, Self::Float32];

    /// The format of a texture.
    #[must_use]
    pub const fn texture_format(self) -> TextureFormat {
        match self {
            Self::Unorm16 => TextureFormat::Depth16Unorm,
            Self::Unorm24 => TextureFormat::Depth24Plus,
            Self::Float32 => TextureFormat::Depth32Float,
        }
    }

    /// The short name: `d16`, `d24` or `d32f`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unorm16 => "d16",
            Self::Unorm24 => "d24",
            Self::Float32 => "d32f",
        }
    }

    /// The distance between neighbouring numbers of the format at a depth in 0..=1.
    #[must_use]
    pub fn step(self, depth: f64) -> f64 {
        match self {
            Self::Unorm16 => 1.0 / 65_535.0,
            Self::Unorm24 => 1.0 / 16_777_215.0,
            Self::Float32 => {
                // 2^(e − 23) for a depth in 2^e..2^(e+1); f32 has no exponent below −126.
                let exponent = libm::ilogb(depth.max(f64::from(f32::MIN_POSITIVE)));
                libm::scalbn(1.0, exponent - 23)
            }
        }
    }
}

/// The mapping from distances to depths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct DepthMapping {
    /// If set, the near plane has the depth 1 and the far plane 0.
    pub is_reversed: bool,
    /// If set, depth is the logarithm of the distance, which a fragment shader writes; otherwise it
    /// is the hyperbola of the perspective division.
    pub is_logarithmic: bool,
}

impl DepthMapping {
    /// All mappings: hyperbolic, reversed, logarithmic, reversed logarithmic.
    pub const ALL: [Self; 4] = [
        Self::new(false, false),
        Self::new(true, false),
        Self::new(false, true),
        Self::new(true, true),
    ];

    const fn new(is_reversed: bool, is_logarithmic: bool) -> Self {
        Self {
            is_reversed,
            is_logarithmic,
        }
    }
}

/// The reason why there is no such depth method.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PrecisionError {
    /// The near plane is not between 10⁻³⁰ and 10³⁰.
    #[error("the near plane is at {0}: it must be a distance from 1e-30 to 1e30")]
    Near(f32),
    /// The far plane is not beyond the near plane, or too far.
    #[error(
        "the far plane is at {far}: it must be beyond the near plane, {near}, and up to 1e30 or \
         infinite"
    )]
    Far {
        /// The given distance of the near plane.
        near: f32,
        /// The given distance of the far plane.
        far: f32,
    },
    /// Logarithmic depth has no infinite far plane.
    #[error("logarithmic depth needs a finite far plane; give its distance")]
    InfiniteLogarithm,
}

/// A way from distances to stored depths: the planes, the mapping, the format.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthMethod {
    pub(super) near: f32,
    pub(super) far: f32,
    pub(super) format: DepthFormat,
    pub(super) mapping: DepthMapping,
    /// Clip z = a·z + b of the view space's z, as [a, b].
    pub(super) clip: [f32; 2],
    /// 1 ÷ near and 1 ÷ log₂(far ÷ near), in f32, of logarithmic depth.
    pub(super) logarithm: [f32; 2],
}

/// The limits of distances: beyond them products overflow or vanish in f32.
pub(super) const LIMITS: std::ops::RangeInclusive<f32> = 1e-30..=1e30;

impl DepthMethod {
    /// The method of two planes, whose distances are rounded to f32 by the caller as the pipeline's
    /// matrices have them; `far` may be infinite.
    ///
    /// # Errors
    /// [`PrecisionError`] if the planes are out of order or out of range.
    pub fn new(
        [near, far]: [f32; 2],
        format: DepthFormat,
        mapping: DepthMapping,
    ) -> Result<Self, PrecisionError> {
        if !LIMITS.contains(&near) {
            return Err(PrecisionError::Near(near));
        }
        let is_far = far > near && (LIMITS.contains(&far) || far.is_infinite());
        if !is_far {
            return Err(PrecisionError::Far { near, far });
        }
        if mapping.is_logarithmic && far.is_infinite() {
            return Err(PrecisionError::InfiniteLogarithm);
        }
        let mut method = Self {
            near,
            far,
            format,
            mapping,
            clip: [0.0; 2],
            logarithm: [1.0 / near, 1.0 / maths::log2(far / near)],
        };
        let Mat4(columns) = method.clip_from_view(1.0, 1.0);
        method.clip = [columns[2][2], columns[3][2]];
        Ok(method)
    }

    /// The distances of the near and of the far plane.
    #[must_use]
    pub fn planes(&self) -> [f32; 2] {
        [self.near, self.far]
    }

    /// The format of the depth buffer.
    #[must_use]
    pub fn format(&self) -> DepthFormat {
        self.format
    }

    /// The mapping from distances to depths.
    #[must_use]
    pub fn mapping(&self) -> DepthMapping {
        self.mapping
    }

    /// The perspective with a vertical field of view, and `aspect` = width ÷ height.
    #[must_use]
    pub fn clip_from_view(&self, fov_y_rad: f32, aspect: f32) -> Mat4 {
        let [near, far] = [self.near, self.far];
        let perspective = match (self.mapping.is_reversed, far.is_infinite()) {
            (false, false) => Mat4::perspective,
            (true, false) => Mat4::perspective_reversed,
            (false, true) => return Mat4::perspective_infinite(fov_y_rad, aspect, near),
            (true, true) => return Mat4::perspective_infinite_reversed(fov_y_rad, aspect, near),
        };
        perspective(fov_y_rad, aspect, near, far)
    }

    /// The depth that a fragment shader writes for logarithmic depth: log₂(w/n) ÷ log₂(f/n), or 1
    /// less it. `w` is the distance.
    pub fn logarithmic_depth<R: Real>(&self, w: R) -> R {
        let [scale, factor] = self.logarithm;
        let depth = maths::log2(w * scale) * factor;
        if self.mapping.is_reversed {
            w.splat(1.0) - depth
        } else {
            depth
        }
    }

    /// The depth that the buffer clears to: that of the far plane.
    #[must_use]
    pub fn farthest_depth(&self) -> f32 {
        if self.mapping.is_reversed { 0.0 } else { 1.0 }
    }

    /// The number that is stored for a surface at a distance between the planes, bit for bit as the
    /// pipeline stores it for a surface that is parallel to the picture. Rounding may move surfaces
    /// next to a plane out of the view volume, where the pipeline draws nothing; their depth is
    /// clamped here.
    #[must_use]
    pub fn stored(&self, distance: f32) -> f32 {
        let depth = if self.mapping.is_logarithmic {
            self.logarithmic_depth(distance)
        } else {
            // The operations of `Mat4::transform_point` and of the viewport transform.
            let [a, b] = self.clip;
            let clip_z = -distance * a + b;
            clip_z * (1.0 / distance)
        };
        let depth = if depth > 0.0 { depth.min(1.0) } else { 0.0 };
        FixedDepth::new(self.format.texture_format()).map_or(depth, |fixed| fixed.stored(depth))
    }

    /// Returns true if the depth test shows a surface at `nearer` in front of one at `farther`
    /// whichever is drawn first: the stored depths differ, in the right order.
    #[must_use]
    pub fn tells_apart(&self, nearer: f32, farther: f32) -> bool {
        self.rank(nearer) < self.rank(farther)
    }

    /// The stored depth as an integer that grows with the distance.
    pub(super) fn rank(&self, distance: f32) -> i64 {
        // The bits of numbers from 0 to 1 are in the numbers' order.
        let bits = i64::from(self.stored(distance).to_bits());
        if self.mapping.is_reversed {
            -bits
        } else {
            bits
        }
    }
}
