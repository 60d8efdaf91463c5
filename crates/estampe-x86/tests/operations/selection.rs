//! Operations for which the compiler selects other instructions: inverse square roots, sums of
//! exact products, remainders of multiples, and divisions by one word.

use super::{PACKETS, isas, run, test_operation};
use estampe_ir::Value;
use estampe_ir::interface::{Input, Output, Stage};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::{Binary, Unary};
use estampe_ir::tree::{Builder, Tree};
use estampe_simd::Packet;
use estampe_x86::{Code, Isa, Tier};

/// 1 ÷ √x has instructions of its own. Besides random numbers: at both ends of the significands of
/// x and of √x, of every exponent, that is around all powers of two.
#[test]
fn inverse_square_roots() {
    let build = |builder: &mut Builder, values: &[Value]| {
        let one = builder.float(1.0);
        let root = builder.unary(Unary::FSqrt, values[0]);
        builder.binary(Binary::FDiv, one, root)
    };
    let expected = |x: u32| (1.0 / f32::from_bits(x).sqrt()).to_bits();
    test_operation("inverse square root", 1, true, &build, &|[x, ..]| {
        expected(x)
    });
    let random = &mut fastrand::Rng::with_seed(3);
    let mut words: Vec<u32> = (0..0x200_u32)
        .flat_map(|exponent| {
            (0..16).map(move |near| (exponent << 23).wrapping_add(near).wrapping_sub(8))
        })
        .chain(std::iter::repeat_with(|| random.u32(..)).take(1 << 20))
        .collect();
    words.resize(words.len().next_multiple_of(PACKETS * 16), 0);
    for isa in isas() {
        let mut builder = Builder::new(Stage::Vertex);
        let x = builder.input(Input::Varying(0));
        let result = build(&mut builder, &[x]);
        let tree = builder.finish(vec![(Output::Varying(0), result)]);
        let code = Code::compile(&Kernel::from_tree(&tree), isa, Tier::Optimised).unwrap();
        let decoder =
            iced_x86::Decoder::new(64, code.instructions(), iced_x86::DecoderOptions::NONE);
        let divides = |one: iced_x86::Instruction| one.mnemonic() == iced_x86::Mnemonic::Vdivps;
        assert_eq!(
            decoder.into_iter().any(divides),
            isa == Isa::Avx2,
            "{isa:?}"
        );
        for words in words.chunks_exact(PACKETS * 16) {
            let mut inputs = vec![Packet([0; 16]); PACKETS * 3];
            for (packet, words) in inputs.iter_mut().step_by(3).zip(words.as_chunks().0) {
                packet.0 = *words;
            }
            let found = run(&tree, (isa, Tier::Optimised), &inputs);
            let found = found.iter().flat_map(|packet| packet.0);
            for (found, &x) in found.zip(words) {
                let wanted = expected(x);
                let both_nan =
                    [found, wanted].map(|word| f32::from_bits(word).is_nan()) == [true; 2];
                assert!(
                    both_nan || found == wanted,
                    "{isa:?}: of {x:x} {found:x}, not {wanted:x}"
                );
            }
        }
    }
}

/// The instructions of a mnemonic in code of a tree.
pub(crate) fn count(tree: &Tree, isa: Isa, mnemonic: iced_x86::Mnemonic) -> usize {
    let code = Code::compile(&Kernel::from_tree(tree), isa, Tier::Optimised).unwrap();
    let decoder = iced_x86::Decoder::new(64, code.instructions(), iced_x86::DecoderOptions::NONE);
    let instructions = decoder.into_iter();
    instructions
        .filter(|one| one.mnemonic() == mnemonic)
        .count()
}

/// Sums of exact products are one operation, with the bits of two; others are not.
#[test]
fn sums_of_exact_products() {
    type Two = (Binary, f32, f32);
    let sums: [Two; 10] = [
        (Binary::FAdd, 0.5, 0.5),
        (Binary::FSub, 2.0, 1.0),
        (Binary::FSub, -0.25, 3.0e7),
        (Binary::FAdd, 2.0_f32.powi(90), 2.0_f32.powi(99)),
        (Binary::FAdd, 2.0_f32.powi(-90), 2.0_f32.powi(-90)),
        (Binary::FSub, 2.0_f32.powi(-90), -2.0_f32.powi(-90)),
        // A factor that is none, and summands that are too small, too large, or nothing.
        (Binary::FAdd, 3.0, 0.5),
        (Binary::FAdd, 0.5, 2.0_f32.powi(-91)),
        (Binary::FAdd, 2.0, 2.0_f32.powi(101)),
        (Binary::FAdd, 0.5, 0.0),
    ];
    for (at, (kind, scale, summand)) in sums.into_iter().enumerate() {
        for is_swapped in [false, true] {
            let order = |pair: [Value; 2]| if is_swapped { [pair[1], pair[0]] } else { pair };
            let build = |builder: &mut Builder, values: &[Value]| {
                let [scale, summand] = [scale, summand].map(|word| builder.float(word));
                let product = builder.binary(Binary::FMul, values[0], scale);
                let [a, b] = order([product, summand]);
                builder.binary(kind, a, b)
            };
            let expected = |x: u32| {
                let product = Binary::FMul.evaluate([x, scale.to_bits()]);
                let [a, b] = if is_swapped {
                    [summand.to_bits(), product]
                } else {
                    [product, summand.to_bits()]
                };
                kind.evaluate([a, b])
            };
            test_operation("sum of a product", 1, true, &build, &|[x, ..]| expected(x));
            let mut builder = Builder::new(Stage::Vertex);
            let x = builder.input(Input::Varying(0));
            let result = build(&mut builder, &[x]);
            let tree = builder.finish(vec![(Output::Varying(0), result)]);
            for isa in isas() {
                let products = count(&tree, isa, iced_x86::Mnemonic::Vmulps);
                assert_eq!(products == 0, at < 6, "{isa:?} {scale} {summand}");
            }
        }
    }
}

/// What is left of a number after the multiples of a power of two around it.
#[test]
fn remainders_of_multiples() {
    for (halves, doubles, is_fused) in [
        (0.5, 2.0, true),
        (0.125, 4.0, true),
        (0.5, 4.0, false),
        (1.0, 0.5, true),
        (0.7, 2.0, false),
    ] {
        let build = |builder: &mut Builder, values: &[Value]| {
            let [halves, doubles, half] = [halves, doubles, 0.5].map(|word| builder.float(word));
            let quotient = builder.binary(Binary::FMul, values[0], halves);
            let quotient = builder.binary(Binary::FAdd, quotient, half);
            let whole = builder.unary(Unary::FFloor, quotient);
            let multiple = builder.binary(Binary::FMul, whole, doubles);
            builder.binary(Binary::FSub, values[1], multiple)
        };
        let expected = |[x, y]: [u32; 2]| {
            let [x, y] = [x, y].map(f32::from_bits);
            (y - (x * halves + 0.5).floor() * doubles).to_bits()
        };
        test_operation("remainder", 2, true, &build, &|[x, y, _]| expected([x, y]));
        let mut builder = Builder::new(Stage::Vertex);
        let values = [0, 1].map(|at| builder.input(Input::Varying(at)));
        let result = build(&mut builder, &values);
        let tree = builder.finish(vec![(Output::Varying(0), result)]);
        for isa in isas() {
            let differences = count(&tree, isa, iced_x86::Mnemonic::Vsubps);
            assert_eq!(differences == 0, is_fused, "{isa:?} {halves} {doubles}");
        }
    }
}

/// By a word that is the same in all lanes: numbers beside its multiples.
#[test]
fn divisions_by_one_word() {
    let random = &mut fastrand::Rng::with_seed(8);
    let some = [
        1,
        2,
        3,
        720,
        1280,
        0x7FFF_FFFF,
        0x8000_0000,
        0x8000_0001,
        u32::MAX,
    ];
    let others: Vec<u32> = (0..40)
        .map(|_| random.u32(..) >> random.u32(..32))
        .collect();
    for divisor in some.into_iter().chain(others) {
        let mut inputs = vec![Packet([0; 16]); PACKETS * 3];
        for word in inputs
            .iter_mut()
            .step_by(3)
            .flat_map(|packet| &mut packet.0)
        {
            let near = random.u32(..3).wrapping_sub(1);
            let multiple = match random.u8(..3) {
                0 => random.u32(..).checked_div(divisor).unwrap_or(0),
                1 => u32::MAX.checked_div(divisor).unwrap_or(0),
                _ => random.u32(..),
            };
            *word = multiple.wrapping_mul(divisor).wrapping_add(near);
        }
        for kind in [Binary::UDiv, Binary::URem, Binary::SDiv, Binary::SRem] {
            let mut builder = Builder::new(Stage::Vertex);
            let [x, by] = [Input::Varying(0), Input::PushConstant(1)].map(|of| builder.input(of));
            let result = builder.binary(kind, x, by);
            let tree = builder.finish(vec![(Output::Varying(0), result)]);
            inputs[1].0[0] = divisor;
            for isa in isas() {
                let found = run(&tree, (isa, Tier::Optimised), &inputs);
                let words = inputs.iter().step_by(3).flat_map(|packet| packet.0);
                for (x, found) in words.zip(found.iter().flat_map(|packet| packet.0)) {
                    let wanted = kind.evaluate([x, divisor]);
                    assert_eq!(found, wanted, "{isa:?}: {kind:?} of {x:x} and {divisor:x}");
                }
                let products = count(&tree, isa, iced_x86::Mnemonic::Vmulpd);
                assert!(products > 0, "{isa:?}: {kind:?}");
            }
        }
    }
}

/// By constants: products in place of quotients, but for divisors 0 and 1, and −1 and −2³¹.
#[test]
fn divisions_by_known_words() {
    let random = &mut fastrand::Rng::with_seed(9);
    let powers = (0..32).map(|bits| 1_u32 << bits);
    let near = powers.flat_map(|power| [power.wrapping_neg(), power - 1, power, power + 1]);
    let others: Vec<u32> = (0..60)
        .map(|_| random.u32(..) >> random.u32(..31))
        .collect();
    let (mut products, mut quotients) = (0, 0);
    for divisor in near.chain(2..60).chain(others) {
        let mut inputs = vec![Packet([0; 16]); PACKETS * 3];
        for word in inputs
            .iter_mut()
            .step_by(3)
            .flat_map(|packet| &mut packet.0)
        {
            let multiple = random.u32(..).checked_div(divisor).unwrap_or(0);
            let most = u32::MAX.checked_div(divisor).unwrap_or(0);
            let multiple = random.choice([multiple, most, most / 2]).unwrap_or(0);
            let near = random.u32(..3).wrapping_sub(1);
            let sum = multiple.wrapping_mul(divisor).wrapping_add(near);
            *word = random
                .choice([sum, sum.wrapping_neg(), 1 << 31])
                .unwrap_or(0);
        }
        for kind in [Binary::UDiv, Binary::URem, Binary::SDiv, Binary::SRem] {
            let mut builder = Builder::new(Stage::Vertex);
            let [x, by] = [builder.input(Input::Varying(0)), builder.word(divisor)];
            let result = builder.binary(kind, x, by);
            let tree = builder.finish(vec![(Output::Varying(0), result)]);
            for isa in isas() {
                let found = run(&tree, (isa, Tier::Optimised), &inputs);
                let words = inputs.iter().step_by(3).flat_map(|packet| packet.0);
                for (x, found) in words.zip(found.iter().flat_map(|packet| packet.0)) {
                    let wanted = kind.evaluate([x, divisor]);
                    assert_eq!(found, wanted, "{isa:?}: {kind:?} of {x:x} and {divisor:x}");
                }
                let is_signed = matches!(kind, Binary::SDiv | Binary::SRem);
                let divides = count(&tree, isa, iced_x86::Mnemonic::Vmulpd) > 0;
                let is_left = is_signed && matches!(divisor, u32::MAX | 0x8000_0000);
                assert!(
                    divides == is_left || divisor < 2,
                    "{isa:?}: {kind:?} by {divisor:x}"
                );
                products += u32::from(!divides);
                quotients += u32::from(divides);
            }
        }
    }
    assert!(isas().is_empty() || products > 1000 && quotients > 2);
}
