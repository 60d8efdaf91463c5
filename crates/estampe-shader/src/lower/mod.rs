//! An entry point of a module to a tree.
//!
//! Calls are inlined, aggregates are taken apart, and variables become values.
