//! The bits of every function, so that none changes unnoticed: pictures depend on them.

use super::every_size;
use crate::maths::*;
use crate::{Mat4, Vec4};

/// A checksum (FNV-1a by words) of a function's results; all NaN are equal.
fn checksum(f: impl Fn(f32) -> f32) -> u32 {
    every_size().fold(0x811C_9DC5, |sum: u32, x| {
        let y = f(x);
        let bits = if y.is_nan() { 0x7FC0_0000 } else { y.to_bits() };
        (sum ^ bits).wrapping_mul(0x0100_0193)
    })
}

#[test]
fn functions_keep_their_bits() {
    let sums = [
        ("sin", checksum(sin), 0xFBC8_ABCB),
        ("cos", checksum(cos), 0x9F54_1621),
        ("tan", checksum(tan), 0x74BA_9035),
        ("asin", checksum(asin), 0x60AE_606A),
        ("acos", checksum(acos), 0xE1BC_62B6),
        ("atan", checksum(atan), 0x5EEE_66ED),
        ("atan2", checksum(|x| atan2(x, 0.7)), 0x3546_3CED),
        ("sinh", checksum(sinh), 0x8C6E_CA67),
        ("cosh", checksum(cosh), 0x2AEF_96B6),
        ("tanh", checksum(tanh), 0xCCA1_70A4),
        ("exp", checksum(exp), 0x531C_160B),
        ("exp2", checksum(exp2), 0xE984_80F2),
        ("log", checksum(log), 0x77E5_E8A3),
        ("log2", checksum(log2), 0x22BB_DBB8),
        ("pow", checksum(|x| pow(x, 2.2)), 0x6A1C_E468),
        ("inverse_sqrt", checksum(inverse_sqrt), 0x9DC5_A3DA),
        ("round", checksum(round), 0x463D_14E4),
        ("remainder", checksum(|x| remainder(x, 0.7)), 0x7B2F_8498),
        ("modulo", checksum(|x| modulo(x, 0.7)), 0x8A1C_CE57),
        (
            "smoothstep",
            checksum(|x| smoothstep(-1.0, 3.0, x)),
            0x3258_C985,
        ),
        ("mix", checksum(|x| mix(0.3, 0.7, x)), 0x5336_5752),
    ];
    for (name, sum, expected) in sums {
        assert_eq!(sum, expected, "{name}: {sum:#X}");
    }
}

#[test]
fn transforms_keep_their_bits() {
    let sum = checksum(|x| {
        let view = Mat4::look_at([x, 1.0, 2.0], [0.3, -0.2, 0.1], [0.0, 1.0, 0.0]);
        let clip =
            Mat4::perspective(0.9, 1.5, 0.1, 100.0) * view * Mat4::rotation([1.0, 2.0, 3.0], x);
        let inverse = clip.inverse().unwrap_or(Mat4::IDENTITY);
        (clip * inverse.columns()[2]).dot(Vec4::new(1.0, 2.0, 3.0, 4.0))
    });
    assert_eq!(sum, 0x37E1_F4DF, "{sum:#X}");
}
