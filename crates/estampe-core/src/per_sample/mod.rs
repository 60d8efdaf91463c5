//! Per-sample operations (O), in the order of the specifications: depth test, blending, sRGB encoding,
//! write mask.
//!
//! *In* coverage, depths, colours · *Out* values in attachments · *Precision* f32 in the order of
//! `docs/NUMERICS.md`; stores round once.

pub(crate) mod depth;

pub(crate) mod depth_bounds;

pub(crate) mod owners;

pub(crate) mod visibility;

pub(crate) mod color;

pub(crate) mod source_over;

pub(crate) mod codes;

pub(crate) mod texel;

mod small_float;

pub(crate) mod general;
