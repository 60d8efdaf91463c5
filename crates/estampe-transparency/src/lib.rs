#![forbid(unsafe_code)]
//! Order-independent transparency (row D6): transparent draws in front of a picture of opaque ones,
//! in any order, with pipelines and shaders of the caller's.
//!
//! Blending mixes a fragment with what lies behind it, C = α·C_new + (1 − α)·C_old, so fragments
//! must come from the farthest on. There are two methods that need no order of the draws:
//!
//! | function | method | fails |
//! |---|---|---|
//! | [`peel`] | exact: the fragments of each sample from the farthest on, layer by layer | never; two passes for each layer |
//! | [`blend_weighted`] | one weighted sum of all fragments | colours are means, weighted by depth |
//!
//! *Depth peeling* (Everitt, "Interactive Order-Independent Transparency", 2001), here from the
//! farthest layer on: a pass finds, in each sample, the depth of the farthest fragment that is
//! nearer than the layer before; a second one blends the fragments of that depth. Fragments of one
//! depth are blended in the order of submission, as sorted lists of each sample would be. The
//! colours may have any format, and are rounded as blending in the right order rounds them.
//!
//! *Weighted blending* (McGuire and Bavoil, "Weighted Blended Order-Independent Transparency",
//! Journal of Computer Graphics Techniques 2(2), 2013) has two targets,
//!
//! ```text
//!   A = Σ (α·C, α)·w      B = Π (1 − α)      C = A_rgb/A_α · (1 − B) + C_opaque·B
//!   w = α·max(10⁻², 3·10³·(1 − d)³)          their equation 10; d is 0 near and 1 far
//! ```
//!
//! Multisampled targets have their layers, sums and compositions sample by sample; the caller's
//! fragments are shaded per pixel as ever.

mod composite;
mod depth_order;
mod error;
mod finding;
mod peeling;
mod target;
mod weighted;

/// The README's snippet, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use depth_order::DepthOrder;
pub use error::TransparencyError;
pub use finding::Finder;
pub use peeling::{PeelDraws, Peeled, layer_state, peel};
pub use target::Target;
pub use weighted::{blend_weighted, weighted_fragment, weighted_targets};
