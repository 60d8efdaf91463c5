//! What makes trees smaller and faster without changing their results.

pub(crate) mod fold;
