//! A sequence through the public interface.

mod operations;
mod passes;
mod readback;

pub use operations::Objects;
