//! Tests of the verifier.

use super::verify;
use crate::text::kernel;

/// What is wrong with a kernel whose interface has these entries.
fn error(blocks: &str) -> String {
    let header = "kernel fragment input varying(0) input push_constant(0) input cover output depth
        buffer 0.0 local 2 texture_at 0.1 sampler_at 0.2 ";
    let parsed = kernel(&format!("{header}{blocks}")).unwrap();
    verify(&parsed).map_or_else(|error| error.what, |()| "nothing".to_owned())
}

#[test]
fn kernels_are_accepted() {
    for blocks in [
        "b0: v0 = input 0 return v0",
        // A loop whose header is its only block, and values of an outer block.
        "b0: v0 = input 0 m1 = input_mask 2 jump b1(v0)
         b1(v2): v3 = fadd v2, v0 branch m1 ? b1(v3) : b2
         b2: return v3",
        // A uniform result of an operation with a mask.
        "b0: uv0 = input 1 m1 = input_mask 2 uv2 = derivative x fine uv0, m1 um3 = any m1 return uv2",
        // Blocks that are never reached.
        "b0: v0 = input 0 return v0 b1: return b2: jump b1",
    ] {
        assert_eq!(error(blocks), "nothing", "{blocks}");
    }
}

#[test]
fn each_rule_is_checked() {
    for (blocks, what) in [
        ("", "there is no block"),
        ("b0(v0): return v0", "the first block has parameters"),
        (
            "b0: v0 = input 0 v0 = input 0 return v0",
            "value 0 is defined twice",
        ),
        (
            "b0: m0 = input 0 return m0",
            "value 0 has not the type of the result",
        ),
        ("b0: v0 = input 2 return v0", "the input is of another type"),
        ("b0: m0 = input_mask 2 return m0", "value 0 is no Word"),
        (
            "b0: v0 = fneg v1 v1 = input 0 return v0",
            "value 1 is not defined on all ways to its use",
        ),
        (
            "undefined v1 b0: v0 = fneg v1 return v0",
            "value 1 is not defined on all ways to its use",
        ),
        (
            "b0: m0 = input_mask 2 branch m0 ? b1 : b2
             b1: v1 = input 0 jump b2
             b2: return v1",
            "value 1 is not defined on all ways to its use",
        ),
        ("b0: jump b0", "a jump goes to the first block"),
        ("b0: jump b7", "block 7 does not exist"),
        (
            "b0: v0 = input 0 jump b1 b1(v1): return v1",
            "there are 0 values for 1",
        ),
        ("b0: return", "there are 0 values for 1"),
        (
            "b0: m0 = input_mask 2 jump b1(m0) b1(v1): return v1",
            "value 0 is no Word",
        ),
        (
            "b0: m0 = input_mask 2 v1 = input 0 branch m0 ? b1 : b2
             b1: jump b3
             b2: jump b1
             b3: return v1",
            "a jump goes back to block 1, which is no loop header",
        ),
        (
            "b0: uv0 = input 0 return uv0",
            "the result is called uniform, and is not",
        ),
        (
            "b0: v0 = input 0 uv1 = fneg v0 return uv1",
            "the result is called uniform, and is not",
        ),
        (
            "b0: uv0 = input 1 m1 = input_mask 2 store_local 0 [uv0], uv0, m1
                 uv2 = load_local 0 [uv0] return uv2",
            "the result is called uniform, and is not",
        ),
        (
            "b0: v0 = input 0 jump b1(v0) b1(uv1): return uv1",
            "value 0 is not uniform, but the parameter 1 is",
        ),
        (
            "b0: v0 = input 0 branch v0 ? b1 : b1 b1: return v0",
            "value 0 is no Mask",
        ),
        (
            "b0: v0 = input 3 return v0",
            "it names an entry that the interface lacks",
        ),
        (
            "b0: v0 = input 0 v1 = load_local 1 [v0] return v1",
            "it names an entry that the interface lacks",
        ),
        (
            "b0: v0 = buffer_bytes 1 return v0",
            "it names an entry that the interface lacks",
        ),
        (
            "b0: v0 = input 0 m1 = input_mask 2 store_buffer 0 [v0], v0, m1 return v0",
            "it stores to a buffer that is not marked as written",
        ),
        (
            "b0: m0 = input_mask 2 v1 = texture levels of 1 at () in m0 return v1",
            "it names an entry that the interface lacks",
        ),
        (
            "b0: m0 = input_mask 2 v1 = texture sample_compare of 0 sampler 1 at () in m0 return v1",
            "it names an entry that the interface lacks",
        ),
    ] {
        assert_eq!(error(blocks), what, "{blocks}");
    }
}
