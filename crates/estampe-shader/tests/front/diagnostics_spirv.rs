//! Wrong SPIR-V: the exact messages.

use estampe_shader::front::{Options, Source, load};

/// Header, `OpCapability Shader` and `OpMemoryModel Logical GLSL450`.
const START: [u32; 10] = [
    0x0723_0203,
    0x0001_0000,
    0,
    10,
    0,
    0x0002_0011,
    1,
    0x0003_000e,
    0,
    1,
];

#[track_caller]
fn check(words: &[u32], expected: &str) {
    let errors = load(Source::SpirV(words), &Options::default()).expect_err(expected);
    assert_eq!(errors.to_string(), format!("shader: error: {expected}"));
}

/// What is said of a module that begins as it should.
#[track_caller]
fn check_after(words: &[u32], expected: &str) {
    check(&[&START, words].concat(), expected);
}

#[test]
fn files_and_headers() {
    let errors = load(Source::SpirVBytes(&[3, 2, 0x23, 7, 0]), &Options::default());
    assert_eq!(
        errors.expect_err("it is cut off").to_string(),
        "shader: error: the SPIR-V has 5 bytes, which is no whole number of 4-byte words
  help: the file is cut off, or not SPIR-V"
    );
    check(&[], "this is not SPIR-V: the first word is not 0x07230203");
    check(
        &START[..3],
        "the SPIR-V has 3 words, fewer than the 5 of the header",
    );
    let mut large = START;
    large[3] = 1 << 30;
    check(
        &large,
        "word 3: the bound of ids is 1073741824, more than 4194304",
    );
}

#[test]
fn instructions() {
    check_after(
        &[0x0005_0013, 1],
        "word 10: the instruction with opcode 19 says it has 5 words, but 2 are left",
    );
    check_after(
        &[0x0001_ffff],
        "word 10: the instruction with opcode 65535 is unknown",
    );
    // OpTypePipe.
    check_after(
        &[0x0003_0026, 1, 0],
        "word 10: the instruction OpTypePipe is not supported here",
    );
    // OpTypeVoid of three words.
    check_after(
        &[0x0003_0013, 1, 2],
        "word 10: the instruction OpTypeVoid has wrong operands",
    );
    // OpTypeVector of an undefined component.
    check_after(
        &[0x0004_0017, 1, 9, 4],
        "word 10: the id %9 is not defined, or not of the kind that is needed",
    );
}

#[test]
fn capabilities() {
    let mut words = START;
    words[6] = 6; // Kernel
    check(&words, "word 5: the capability Kernel is not supported");
    words[6] = 0xffff;
    check(&words, "word 5: the capability 65535 is unknown");
}
