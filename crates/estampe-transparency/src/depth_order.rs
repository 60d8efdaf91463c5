//! Which depths are nearer: the convention of a projection.

use estampe::Real;
use estampe::state::{CompareFunction, DepthState};

/// The order of depths, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DepthOrder {
    /// 0 at the near plane, 1 at the far plane.
    NearIsZero,
    /// 1 at the near plane, 0 at the far plane: reversed depth.
    NearIsOne,
}

impl DepthOrder {
    /// The depth test of transparent draws: fragments nearer than the stored depth pass, and store
    /// nothing.
    #[must_use]
    pub const fn nearer(self) -> DepthState {
        DepthState {
            write_enabled: false,
            compare: match self {
                Self::NearIsZero => CompareFunction::Less,
                Self::NearIsOne => CompareFunction::Greater,
            },
        }
    }

    /// The depth test that keeps the farthest fragment.
    pub(crate) const fn farthest(self) -> DepthState {
        DepthState {
            write_enabled: true,
            compare: match self {
                Self::NearIsZero => CompareFunction::GreaterEqual,
                Self::NearIsOne => CompareFunction::LessEqual,
            },
        }
    }

    /// The depth of the near plane.
    pub(crate) const fn nearest(self) -> f32 {
        match self {
            Self::NearIsZero => 0.0,
            Self::NearIsOne => 1.0,
        }
    }

    /// 1 at the near plane, 0 at the far plane.
    #[inline(always)]
    pub(crate) fn nearness<R: Real>(self, depth: R) -> R {
        match self {
            Self::NearIsZero => -depth + 1.0,
            Self::NearIsOne => depth,
        }
    }

    /// True where a depth is nearer than another one.
    #[inline(always)]
    pub(crate) fn is_nearer<R: Real>(self, depth: R, than: R) -> R::SelectMask {
        match self {
            Self::NearIsZero => depth.lt(than),
            Self::NearIsOne => depth.gt(than),
        }
    }
}
