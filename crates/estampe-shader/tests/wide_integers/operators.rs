//! Operators, conversions and built-in functions of one number and of vectors.
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "the formulas convert as WGSL does"
)]

use super::operands::{Operands, pairs};
use super::run::{GROUP, run_all};
use estampe_shader::front::Source;

/// Checks an expression of a, b and n, whose type is `u64`, against a formula.
#[track_caller]
fn check(kind: &str, expression: &str, wanted: impl Fn(Operands) -> u64) {
    let source = format!(
        "@group(0) @binding(0) var<storage, read_write> out: array<u64>;\n\
         @group(0) @binding(1) var<storage, read> operands: array<vec3<u64>>;\n\
         @compute @workgroup_size({GROUP})\n\
         fn main(@builtin(global_invocation_id) id: vec3u) {{\n\
         let row = operands[id.x];\n\
         let a = {kind}(row.x); let b = {kind}(row.y); let n = u32(row.z); let f = bitcast<f32>(n);\n\
         out[id.x] = {expression};\n}}"
    );
    let pairs = pairs();
    let rows = pairs.iter();
    let read: Vec<_> = rows
        .flat_map(|of| [of.a, of.b, u64::from(of.n), 0])
        .collect();
    for (how, out) in run_all(Source::Wgsl(&source), &[&read], pairs.len(), pairs.len()) {
        for (of, got) in pairs.iter().zip(out) {
            let wanted = wanted(*of);
            assert!(
                got == wanted,
                "{how}: {expression} of {kind}, {:#x} {:#x} {:#x}: {got:#x}, not {wanted:#x}",
                of.a,
                of.b,
                of.n
            );
        }
    }
}

#[track_caller]
fn unsigned(expression: &str, wanted: impl Fn(u64, u64, u32) -> u64) {
    check("u64", expression, |of| wanted(of.a, of.b, of.n));
}

#[track_caller]
fn signed(expression: &str, wanted: impl Fn(i64, i64, u32) -> i64) {
    check("i64", &format!("u64({expression})"), |of| {
        wanted(of.a as i64, of.b as i64, of.n) as u64
    });
}

#[test]
fn sums_products_and_bits() {
    unsigned("a + b", |a, b, _| a.wrapping_add(b));
    unsigned("a - b", |a, b, _| a.wrapping_sub(b));
    unsigned("a * b", |a, b, _| a.wrapping_mul(b));
    unsigned("(a & b) ^ ~(a | b)", |a, b, _| (a & b) ^ !(a | b));
    signed("a + b", |a, b, _| a.wrapping_add(b));
    signed("a - b", |a, b, _| a.wrapping_sub(b));
    signed("a * b", |a, b, _| a.wrapping_mul(b));
    signed("-a ^ b", |a, b, _| a.wrapping_neg() ^ b);
    unsigned(
        "a * 0xFEDCBA9876543210lu + 0x123456789ABCDEFlu",
        |a, _, _| {
            a.wrapping_mul(0xFEDC_BA98_7654_3210)
                .wrapping_add(0x0123_4567_89AB_CDEF)
        },
    );
}

#[test]
fn shifts_are_modulo_64() {
    unsigned("a << n", |a, _, n| a.wrapping_shl(n));
    unsigned("a >> n", |a, _, n| a.wrapping_shr(n));
    signed("a << n", |a, _, n| a.wrapping_shl(n));
    signed("a >> n", |a, _, n| a.wrapping_shr(n));
    unsigned(
        "(a << 0u) ^ (a << 1u) ^ (a << 31u) ^ (a << 32u) ^ (a << 33u) ^ (a << 63u)",
        |a, _, _| a ^ (a << 1) ^ (a << 31) ^ (a << 32) ^ (a << 33) ^ (a << 63),
    );
    signed(
        "(a >> 0u) ^ (a >> 1u) ^ (a >> 31u) ^ (a >> 32u) ^ (a >> 33u) ^ (a >> 63u)",
        |a, _, _| a ^ (a >> 1) ^ (a >> 31) ^ (a >> 32) ^ (a >> 33) ^ (a >> 63),
    );
}

#[test]
fn quotients_and_remainders() {
    unsigned("a / b", |a, b, _| a.checked_div(b).unwrap_or(a));
    unsigned("a % b", |a, b, _| a.checked_rem(b).unwrap_or(0));
    unsigned("a / b * b + a % b", |a, b, _| if b == 0 { 0 } else { a });
    signed("a / b", |a, b, _| a.checked_div(b).unwrap_or(a));
    signed("a % b", |a, b, _| a.checked_rem(b).unwrap_or(0));
    unsigned("b / (a & 0xFFFFlu)", |a, b, _| {
        b.checked_div(a & 0xFFFF).unwrap_or(b)
    });
    unsigned(
        "(a / 10lu) ^ (a / 4294967296lu) ^ (b % 1000000007lu)",
        |a, b, _| (a / 10) ^ (a >> 32) ^ (b % 1_000_000_007),
    );
    signed(
        "(a / -7li) ^ (b % 12345678901li) ^ (9223372036854775807li / b)",
        |a, b, _| (a / -7) ^ (b % 12_345_678_901) ^ i64::MAX.checked_div(b).unwrap_or(i64::MAX),
    );
}

#[test]
fn comparisons_and_choices() {
    let bits = |conditions: [bool; 6]| {
        let place = conditions.into_iter().rev();
        place.fold(0, |bits, one| bits * 2 + u64::from(one))
    };
    let expression = "u64(a == b) | u64(a != b) << 1u | u64(a < b) << 2u | u64(a <= b) << 3u \
                      | u64(a > b) << 4u | u64(a >= b) << 5u";
    unsigned(expression, |a, b, _| {
        bits([a == b, a != b, a < b, a <= b, a > b, a >= b])
    });
    check("i64", expression, |of| {
        let [a, b] = [of.a as i64, of.b as i64];
        bits([a == b, a != b, a < b, a <= b, a > b, a >= b])
    });
    unsigned("select(a, b, (n & 1u) == 1u)", |a, b, n| {
        if n & 1 == 1 { b } else { a }
    });
    unsigned("min(a, b) ^ (max(a, b) * 3lu)", |a, b, _| {
        a.min(b) ^ a.max(b).wrapping_mul(3)
    });
    signed("min(a, b) ^ (max(a, b) * 3li)", |a, b, _| {
        a.min(b) ^ a.max(b).wrapping_mul(3)
    });
    unsigned("clamp(a, b, 1lu << 40u)", |a, b, _| a.max(b).min(1 << 40));
    signed("clamp(a, b, -1li << 33u)", |a, b, _| a.max(b).min(-1 << 33));
    signed("abs(a) ^ (sign(b) * 5li)", |a, b, _| {
        a.wrapping_abs() ^ (b.signum() * 5)
    });
    unsigned("abs(a) ^ sign(b)", |a, b, _| a ^ u64::from(b != 0));
}

#[test]
fn conversions() {
    unsigned("u64(u32(a)) ^ (u64(i32(b)) << 7u)", |a, b, _| {
        u64::from(a as u32) ^ (b as i32 as u64) << 7
    });
    signed("i64(i32(a)) ^ (i64(u32(b)) << 7u)", |a, b, _| {
        i64::from(a as i32) ^ i64::from(b as u32) << 7
    });
    unsigned(
        "u64(bool(a)) ^ u64(n) ^ bitcast<u64>(i64(i32(n)))",
        |a, _, n| u64::from(a != 0) ^ u64::from(n) ^ n as i32 as u64,
    );
    unsigned("u64(bitcast<u32>(f32(a)))", |a, _, _| {
        u64::from((a as f32).to_bits())
    });
    signed("i64(bitcast<i32>(f32(a)))", |a, _, _| {
        i64::from((a as f32).to_bits() as i32)
    });
    // The greatest floats of the types, as WGSL has it for 32 bits.
    unsigned("u64(f)", |_, _, n| {
        (f32::from_bits(n) as u64).min(u64::MAX << 40)
    });
    signed("i64(f)", |_, _, n| {
        (f32::from_bits(n) as i64).min(i64::MAX >> 39 << 39)
    });
}

#[test]
fn bits_are_counted_and_moved() {
    for kind in ["u64", "i64"] {
        let counts = "u64(countOneBits(a)) | u64(countLeadingZeros(a)) << 8u \
                      | u64(countTrailingZeros(a)) << 16u | u64(firstTrailingBit(a)) << 24u";
        check(kind, counts, |Operands { a, .. }| {
            let trailing = u64::from(a.trailing_zeros());
            let first = if a == 0 { u64::MAX } else { trailing };
            u64::from(a.count_ones())
                | u64::from(a.leading_zeros()) << 8
                | trailing << 16
                | first << 24
        });
        check(kind, "u64(reverseBits(a))", |of| of.a.reverse_bits());
        check(kind, "u64(insertBits(a, b, n, n >> 4u))", |of| {
            let offset = of.n.min(64);
            let count = (of.n >> 4).min(64 - offset);
            if count == 0 {
                return of.a;
            }
            let mask = u64::MAX >> (64 - count) << offset;
            (of.a & !mask) | (of.b << offset & mask)
        });
    }
    let last = |a: u64| (63 - u64::from(a.leading_zeros())) as i64;
    unsigned("firstLeadingBit(a)", |a, _, _| {
        if a == 0 { u64::MAX } else { last(a) as u64 }
    });
    signed("firstLeadingBit(a)", |a, _, _| {
        let bits = if a < 0 { !a } else { a } as u64;
        if bits == 0 { -1 } else { last(bits) }
    });
    let range = |n: u32| {
        let offset = n.min(64);
        (offset, (n >> 3).min(64 - offset))
    };
    unsigned("extractBits(a, n, n >> 3u)", |a, _, n| {
        let (offset, count) = range(n);
        if count == 0 {
            return 0;
        }
        a << (64 - offset - count) >> (64 - count)
    });
    signed("extractBits(a, n, n >> 3u)", |a, _, n| {
        let (offset, count) = range(n);
        if count == 0 {
            return 0;
        }
        a << (64 - offset - count) >> (64 - count)
    });
}

#[test]
fn vectors_are_of_components() {
    unsigned("dot(vec3(a, b, 3lu), vec3(b, 5lu, a).zxy)", |a, b, _| {
        let [x, y, z] = [(a, a), (b, b), (3, 5)].map(|(x, y): (u64, u64)| x.wrapping_mul(y));
        x.wrapping_add(y).wrapping_add(z)
    });
    signed("dot(vec2(a, b), vec2(b, -2li))", |a, b, _| {
        a.wrapping_mul(b).wrapping_sub(b.wrapping_mul(2))
    });
    unsigned(
        "(vec4<u64>(a) / vec4(b, 3lu, 7lu, a))[n & 3u]",
        |a, b, n| match n & 3 {
            0 => a.checked_div(b).unwrap_or(a),
            1 => a / 3,
            2 => a / 7,
            _ => a.checked_div(a).unwrap_or(0),
        },
    );
    unsigned(
        "select(vec2(a, b), vec2(b, 1lu), vec2(a < b, (n > 9u))).y ^ select(vec2(a), vec2(b), a < b).x",
        |a, b, n| (if n > 9 { 1 } else { b }) ^ a.max(b),
    );
    unsigned(
        "u64(all(vec2(a, b) < vec2(b, a + b))) | u64(any(vec2(a, b) == vec2(b, 1lu))) << 1u",
        |a, b, _| u64::from(a < b && b < a.wrapping_add(b)) | u64::from(a == b || b == 1) << 1,
    );
    unsigned(
        "(vec2(a, b) << vec2(n, n + 1u)).y ^ (a * vec2(b, 3lu)).x ^ (vec2(a, b) * b).y",
        |a, b, n| b.wrapping_shl(n.wrapping_add(1)) ^ a.wrapping_mul(b) ^ b.wrapping_mul(b),
    );
    unsigned(
        "u64(vec3<u32>(vec3(a, b, 9lu)).y) ^ u64(vec2<i64>(vec2(f, f)).x)",
        |_, b, n| {
            let whole = (f32::from_bits(n) as i64).min(i64::MAX >> 39 << 39);
            u64::from(b as u32) ^ whole as u64
        },
    );
    signed(
        "(-vec3(a, b, 1li)).zyx.y ^ (~vec2(a, b)).x ^ reverseBits(vec2(a, b)).y",
        |a, b, _| b.wrapping_neg() ^ !a ^ b.reverse_bits(),
    );
}
