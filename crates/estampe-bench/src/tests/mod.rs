//! Tests of all scenes.

mod fingerprints;
mod levels_and_threads;
