//! Per-sample operations (O), in the order of the specifications: depth bounds, stencil, depth,
//! blending or a logic operation, sRGB encoding, write mask. They are kernels: none knows which
//! path calls it.
//!
//! *In* coverage, depths, colours · *Out* values in attachments · *Precision* f32 in the order of
//! `docs/NUMERICS.md`; stores round once.

pub(crate) mod compare;

pub(crate) mod stencil;

pub(crate) mod sample_tests;

pub(crate) mod hiz;

pub(crate) mod packet_ranges;

pub(crate) mod blend;

pub(crate) mod logic;

pub(crate) mod color_writer;

pub(crate) mod solid_blend;

pub(crate) mod source_over;
