//! 16-bit floats of SPIR-V.

use super::reference::{decoded, encoded};
use super::run::{Contents, lowered_from, packed, run_stage};
use estampe_shader::front::Source;

/// Instructions: the opcode, and the other words.
fn assembled(bound: u32, instructions: &[(u32, &[u32])]) -> Vec<u32> {
    let mut words = vec![0x0723_0203, 0x0001_0300, 0, bound, 0];
    for (opcode, operands) in instructions {
        let length = u32::try_from(operands.len() + 1).expect("a short instruction");
        words.push(length << 16 | opcode);
        words.extend(*operands);
    }
    words
}

/// A compute shader that does `half[0] = half[1] * 0.1 + half[2]` on a storage buffer.
#[rustfmt::skip]
fn shader() -> Vec<u32> {
    // void 1, function 2, half 3, uint 4, array 5, block 6, pointer 7, variable 8, pointer 9,
    // constants 10 to 12 and 21, main 13, places 15 to 17, values 18 to 20 and 22.
    assembled(23, &[
        (17, &[1]), (17, &[9]), (17, &[4433]),           // Capability Shader, Float16, 16-bit
        (14, &[0, 1]),                                   // MemoryModel Logical GLSL450
        (15, &[5, 13, 0x6e69_616d, 0]),                  // EntryPoint GLCompute "main"
        (16, &[13, 17, 1, 1, 1]),                        // ExecutionMode LocalSize
        (71, &[5, 6, 2]), (71, &[6, 2]), (72, &[6, 0, 35, 0]), // ArrayStride, Block, Offset
        (71, &[8, 34, 0]), (71, &[8, 33, 0]),            // DescriptorSet, Binding
        (19, &[1]), (33, &[2, 1]), (22, &[3, 16]), (21, &[4, 32, 0]),
        (29, &[5, 3]), (30, &[6, 5]), (32, &[7, 12, 6]), (59, &[7, 8, 12]), (32, &[9, 12, 3]),
        (43, &[4, 10, 0]), (43, &[4, 11, 1]), (43, &[4, 12, 2]), (43, &[3, 21, 0x2E66]),
        (54, &[1, 13, 0, 2]), (248, &[14]),
        (65, &[9, 15, 8, 10, 10]), (65, &[9, 16, 8, 10, 11]), (65, &[9, 17, 8, 10, 12]),
        (61, &[3, 18, 16]), (61, &[3, 19, 17]),
        (133, &[3, 22, 18, 21]), (129, &[3, 20, 22, 19]), // FMul, FAdd
        (62, &[15, 20]), (253, &[]), (56, &[]),
    ])
}

#[test]
fn spirv_has_the_same_halves() {
    let stage = lowered_from(Source::SpirV(&shader()));
    let [a, b] = [3.0, -0.25];
    let halves = [0x1234, encoded(a), encoded(b), 0x5678];
    let (_, words) = run_stage(&stage, &[Contents::Written(packed(&halves))], 1);
    let product = decoded(encoded(a * decoded(0x2E66)));
    let expected = [encoded(product + b), halves[1], halves[2], halves[3]];
    assert_eq!(words[0], packed(&expected));
}
