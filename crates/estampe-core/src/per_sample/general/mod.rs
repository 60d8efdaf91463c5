//! The per-sample operations complete (O1–O10), in their order, for any formats and states.
//!
//! *In* depths and colours of a packet of one sample · *Out* the attachments · *Precision* f32 in the order of
//! `docs/NUMERICS.md` · *Spec* Vulkan §Fragment Operations, §Blending, §Logical Operations.
//!
//! Everything here is loops over arrays of sixteen, which are compiled for the level at hand because they are
//! inlined into its entry. The common states (RGBA8, a float depth test) have code of their own beside this
//! module, and what selects one or the other is a draw's pipeline and target, not a fragment.

pub(crate) mod blend;

pub(crate) mod logic;

pub(crate) mod stencil;

mod sample_tests;
mod target;

pub(crate) use sample_tests::{DepthFormat, SampleTests, StencilTest};
pub(crate) use target::GeneralTarget;
