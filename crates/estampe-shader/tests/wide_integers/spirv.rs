//! SPIR-V with the capability Int64, written word by word.

use super::run::{GROUP, run_all};
use estampe_shader::front::Source;

/// An instruction.
fn add(words: &mut Vec<u32>, opcode: u32, operands: &[u32]) {
    let length = u32::try_from(operands.len() + 1).expect("few operands");
    words.push(length << 16 | opcode);
    words.extend(operands);
}

#[test]
fn shifts_by_64_bits_conversions_and_indices() {
    let [void, function, uint, ulong, long, array, block, pointer] = [1, 2, 3, 4, 5, 6, 7, 8];
    let [to_block, out, main, label, to_vector, id, vector] = [9, 10, 11, 12, 13, 14, 15];
    let [zero, three, forty, seven, minus] = [16, 17, 18, 19, 20];
    let [to_uint, place, index, wide, value, shifted] = [21, 22, 23, 24, 25, 26];
    let [number, quotient, bits, sum, long_sum] = [27, 28, 29, 30, 31];
    let mut words = vec![0x0723_0203, 0x0001_0000, 0, 40, 0];
    let w = &mut words;
    add(w, 17, &[1]); // OpCapability Shader
    add(w, 17, &[11]); // OpCapability Int64
    add(w, 14, &[0, 1]); // OpMemoryModel Logical GLSL450
    add(w, 15, &[5, main, u32::from_le_bytes(*b"main"), 0, id]); // OpEntryPoint GLCompute
    let group = u32::try_from(GROUP).expect("it is small");
    add(w, 16, &[main, 17, group, 1, 1]); // OpExecutionMode LocalSize
    add(w, 71, &[array, 6, 8]); // OpDecorate ArrayStride
    add(w, 71, &[block, 3]); // OpDecorate BufferBlock
    add(w, 72, &[block, 0, 35, 0]); // OpMemberDecorate Offset
    add(w, 71, &[out, 34, 0]); // OpDecorate DescriptorSet
    add(w, 71, &[out, 33, 0]); // OpDecorate Binding
    add(w, 71, &[id, 11, 28]); // OpDecorate BuiltIn GlobalInvocationId
    add(w, 19, &[void]); // OpTypeVoid
    add(w, 33, &[function, void]); // OpTypeFunction
    add(w, 21, &[uint, 32, 0]); // OpTypeInt
    add(w, 21, &[ulong, 64, 0]);
    add(w, 21, &[long, 64, 1]);
    add(w, 29, &[array, ulong]); // OpTypeRuntimeArray
    add(w, 30, &[block, array]); // OpTypeStruct
    add(w, 32, &[to_block, 2, block]); // OpTypePointer Uniform
    add(w, 32, &[pointer, 2, ulong]);
    add(w, 23, &[vector, uint, 3]); // OpTypeVector
    add(w, 32, &[to_vector, 1, vector]); // OpTypePointer Input
    add(w, 32, &[to_uint, 1, uint]);
    add(w, 43, &[uint, zero, 0]); // OpConstant
    add(w, 43, &[ulong, three, 3, 0]);
    add(w, 43, &[ulong, forty, 40, 0]);
    add(w, 43, &[ulong, seven, 0x89AB_CDEF, 0x0123_4567]);
    add(w, 43, &[long, minus, (-1000_i32).cast_unsigned(), u32::MAX]);
    add(w, 59, &[to_block, out, 2]); // OpVariable Uniform
    add(w, 59, &[to_vector, id, 1]); // OpVariable Input
    add(w, 54, &[void, main, 0, function]); // OpFunction
    add(w, 248, &[label]); // OpLabel
    add(w, 65, &[to_uint, place, id, zero]); // OpAccessChain
    add(w, 61, &[uint, index, place]); // OpLoad
    add(w, 113, &[ulong, wide, index]); // OpUConvert
    add(w, 132, &[ulong, value, wide, seven]); // OpIMul
    add(w, 194, &[ulong, shifted, value, three]); // OpShiftRightLogical, by a ulong
    add(w, 124, &[long, number, shifted]); // OpBitcast
    add(w, 135, &[long, quotient, number, minus]); // OpSDiv
    add(w, 196, &[ulong, bits, wide, forty]); // OpShiftLeftLogical, by a ulong
    add(w, 124, &[long, sum, bits]); // OpBitcast
    add(w, 128, &[long, long_sum, sum, quotient]); // OpIAdd
    let [result, to_out] = [32, 33];
    add(w, 124, &[ulong, result, long_sum]); // OpBitcast
    add(w, 65, &[pointer, to_out, out, zero, wide]); // OpAccessChain, by a ulong
    add(w, 62, &[to_out, result]); // OpStore
    add(w, 253, &[]); // OpReturn
    add(w, 56, &[]); // OpFunctionEnd
    let wanted: Vec<_> = (0..128_u64)
        .map(|id| {
            let shifted = id.wrapping_mul(0x0123_4567_89AB_CDEF) >> 3;
            let quotient = shifted.cast_signed() / -1000;
            (id << 40).wrapping_add(quotient.cast_unsigned())
        })
        .collect();
    for (how, out) in run_all(Source::SpirV(&words), &[], wanted.len(), wanted.len()) {
        assert_eq!(out, wanted, "{how}");
    }
}
