//! Runs a kernel: vector bytecode, many lanes an operation, in safe Rust.
