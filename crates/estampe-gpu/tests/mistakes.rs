//! What the compiler says about mistakes in shaders: each program of `tests/mistakes` fails with
//! the message beside it, which names what to write instead.
//!
//! `TRYBUILD=overwrite cargo test -p estampe-gpu --test mistakes` writes the messages of another
//! compiler.

#[test]
#[ignore = "compares with the messages of Rust 1.95, which other versions word otherwise: `.ci/release` runs it"]
fn the_compiler_says_what_to_write_instead() {
    trybuild::TestCases::new().compile_fail("tests/mistakes/*.rs");
}
