//! Quads: 2×2 pixels, the unit of derivatives.
//!
//! Small triangles cover parts of packets. Their quads, whatever triangle and place they come from,
//! fill packets together, so that the shader's lanes are busy. Four quads of one triangle are
//! interpolated at once.

use estampe_simd::LANES;

/// Lanes of a quad.
pub(crate) const QUAD: usize = 4;

/// Quads of a packet.
pub(crate) const QUADS: usize = LANES / QUAD;
