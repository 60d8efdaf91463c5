//! Copies, clears, mip levels and blits, on textures as plain rows of bytes.
//!
//! A [`PlainTexture`] has one form: for each mip level and each slice, rows of the bytes that the
//! host reads. There are no tiles, no words and nothing that is converted later, so each operation
//! is a loop over texels, or over blocks of a compressed format. In · Out: plain textures and bytes
//! · the same. Precision: NUMERICS.md, *Textures* and *Formats*. Spec: WebGPU, *Image Copies* and
//! *Texel Copies*; Vulkan, `vkCmdBlitImage`.
//!
//! | file | has |
//! |---|---|
//! | [`plain`] | the texture |
//! | [`texel`] | the bytes of a texel and of its aspects |
//! | [`region`] | which blocks a copy touches, where their bytes are, and the rules |
//! | [`copy`] | copies and clears |
//! | [`mips`] | mip levels |
//! | [`sampled`] | the texture as the oracle samples it |
//! | [`blit`](mod@blit) | blits |
//! | [`attachment`] | loading into a [`Target`](crate::Target), and storing from it |

pub mod attachment;
pub mod blit;
pub mod copy;
pub mod mips;
pub mod plain;
pub mod region;
pub mod sampled;
pub mod texel;

pub use plain::{PlainImage, PlainTexture};
pub use region::{Layout, Place, Rule};
