//! Every operation on special and random words, at each instruction set and tier, against the
//! definition of its results.
#![cfg(target_arch = "x86_64")]

use estampe_ir::interface::{Input, Output, Stage};
use estampe_ir::interpreter::{InputData, OutputData, Run, cells};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::{Binary, Compare, MaskBinary, Math, Math2, NAN, Unary, fma};
use estampe_ir::tree::{Builder, Tree};
use estampe_ir::{Op, Value};
use estampe_simd::{Level, Packet};
use estampe_x86::{Code, Isa, Scratch, Tier};

/// The packets of a test.
const PACKETS: usize = 120;

/// Numbers at which something changes.
const SPECIAL: &[u32] = &[
    0,
    1,
    2,
    31,
    32,
    33,
    0xFFFF,
    0x1_0000,
    0x7FFF_FFFF,
    0x8000_0000,
    0x8000_0001,
    0xFFFF_FFFE,
    0xFFFF_FFFF,
    0x3F80_0000, // 1
    0xBF80_0000, // −1
    0x3F00_0000, // ½
    0x3FC0_0000, // 1.5
    0x4020_0000, // 2.5
    0xBF00_0000, // −½
    0x0040_0000, // subnormal
    0x007F_FFFF,
    0x0080_0000, // least normal
    0x7F7F_FFFF, // greatest
    0x7F80_0000, // ∞
    0xFF80_0000,
    0x7FC0_0000, // NaN
    0xFFC0_0001,
    0x7F80_0001, // signalling NaN
    0x4EFF_FFFF, // below 2³¹
    0x4F00_0000, // 2³¹
    0xCF00_0000, // −2³¹
    0xCF00_0001,
    0x4F7F_FFFF, // below 2³²
    0x4F80_0000, // 2³²
    0x4B00_0001, // 2²³ + 1
    0x477F_F000, // 65520, which binary16 does not have
    0x3380_0000, // 2⁻²⁴
];

fn isas() -> Vec<Isa> {
    let isas: Vec<Isa> = Isa::ALL
        .into_iter()
        .filter(|isa| isa.is_available())
        .collect();
    // A processor without AVX2 has nothing to test here: code is never made for it.
    isas
}

fn word(random: &mut fastrand::Rng) -> u32 {
    match random.u8(..4) {
        0 | 1 => SPECIAL[random.usize(..SPECIAL.len())],
        2 => random.f32().mul_add(200.0, -100.0).to_bits(),
        _ => random.u32(..),
    }
}

/// The operands of a test: three packets after another for each packet.
fn operands(seed: u64) -> Vec<Packet<u32>> {
    let random = &mut fastrand::Rng::with_seed(seed);
    let mut packets = vec![Packet([0; 16]); PACKETS * 3];
    for packet in &mut packets {
        packet.0.fill_with(|| word(random));
    }
    // Every pair of special words once.
    let pairs = SPECIAL
        .iter()
        .flat_map(|&a| SPECIAL.iter().map(move |&b| [a, b]));
    for (at, [a, b]) in pairs.enumerate() {
        let (packet, lane) = (at / 16, at % 16);
        packets[packet * 3].0[lane] = a;
        packets[packet * 3 + 1].0[lane] = b;
    }
    packets
}

/// Runs a tree with one output on the operands.
fn run(tree: &Tree, (isa, tier): (Isa, Tier), inputs: &[Packet<u32>]) -> Vec<Packet<u32>> {
    let kernel = Kernel::from_tree(tree);
    let code = Code::compile(&kernel, isa, tier).unwrap();
    check_instructions(code.instructions());
    let given: Vec<InputData<'_>> = kernel
        .interface
        .inputs
        .iter()
        .map(|input| match input {
            Input::Varying(at) => InputData::words(inputs, *at as usize, 3),
            Input::PushConstant(at) => InputData::Uniform(inputs[*at as usize].0[0]),
            other => panic!("{other:?}"),
        })
        .collect();
    let mut outputs = vec![Packet([0; 16]); PACKETS];
    let run = Run {
        inputs: &given,
        outputs: &[OutputData::words(cells(&mut outputs), 0, 1)],
        ..Run::new(PACKETS)
    };
    code.run(Level::best(), &run, &mut Scratch::default())
        .unwrap();
    outputs
}

/// All bytes are instructions.
fn check_instructions(bytes: &[u8]) {
    let mut decoder = iced_x86::Decoder::new(64, bytes, iced_x86::DecoderOptions::NONE);
    while decoder.can_decode() {
        let instruction = decoder.decode();
        assert!(!instruction.is_invalid(), "at {:x}", instruction.ip());
    }
}

/// How the operands of an operation reach it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Given {
    Varying,
    /// The second one is a constant.
    Constant(u32),
    /// All are the same in all lanes.
    Uniform,
    /// The first one is the same in all lanes.
    UniformFirst,
}

/// Builds a tree of an operation of `count` words and runs it everywhere.
fn test_operation(
    name: &str,
    count: u32,
    is_float: bool,
    build: &dyn Fn(&mut Builder, &[Value]) -> Value,
    expected: &dyn Fn([u32; 3]) -> u32,
) {
    let inputs = operands(u64::from(count));
    let ways = [
        Given::Varying,
        Given::Constant(0x4020_0000),
        Given::Constant(37),
        Given::Constant(64),
        Given::Constant(1 << 31),
        Given::Constant(0),
        Given::Uniform,
        Given::UniformFirst,
    ];
    for isa in isas() {
        for (tier, given) in [Tier::Fast, Tier::Optimised]
            .into_iter()
            .flat_map(|tier| ways.map(|given| (tier, given)))
        {
            if matches!(given, Given::Constant(_) | Given::UniformFirst) && count < 2 {
                continue;
            }
            let mut builder = Builder::new(Stage::Vertex);
            let values: Vec<Value> = (0..count)
                .map(|at| match (given, at) {
                    (Given::Constant(word), 1) => builder.word(word),
                    (Given::Uniform, _) | (Given::UniformFirst, 0) => {
                        builder.input(Input::PushConstant(at))
                    }
                    _ => builder.input(Input::Varying(at)),
                })
                .collect();
            let result = build(&mut builder, &values);
            let tree = builder.finish(vec![(Output::Varying(0), result)]);
            let found = run(&tree, (isa, tier), &inputs);
            for (packet, lane) in
                (0..PACKETS).flat_map(|packet| (0..16).map(move |lane| (packet, lane)))
            {
                let mut operands = [0, 1, 2].map(|at| match (given, at) {
                    (Given::Constant(word), 1) => word,
                    (Given::Uniform, _) | (Given::UniformFirst, 0) => inputs[at].0[0],
                    _ => inputs[packet * 3 + at].0[lane],
                });
                for unused in &mut operands[count as usize..] {
                    *unused = 0;
                }
                let canonical = |word: u32| {
                    if is_float && f32::from_bits(word).is_nan() {
                        NAN
                    } else {
                        word
                    }
                };
                let (found, wanted) = (found[packet].0[lane], expected(operands));
                assert!(
                    canonical(found) == canonical(wanted),
                    "{name} {isa:?} {tier:?} {given:?}: of {operands:x?} {found:x}, not {wanted:x}"
                );
            }
        }
    }
}

#[test]
fn unary_operations() {
    for &kind in Unary::ALL {
        let is_float = !matches!(
            kind,
            Unary::FNeg
                | Unary::FAbs
                | Unary::Canonical
                | Unary::F16FromF32
                | Unary::S32FromF32
                | Unary::U32FromF32
                | Unary::Not
                | Unary::CountOnes
                | Unary::ReverseBits
                | Unary::LeadingZeros
                | Unary::TrailingZeros
        );
        test_operation(
            kind.name(),
            1,
            is_float,
            &|builder, values| builder.unary(kind, values[0]),
            &|[a, ..]| kind.evaluate(a),
        );
    }
}

#[test]
fn binary_operations() {
    for &kind in Binary::ALL {
        let is_float = kind.name().starts_with('f');
        test_operation(
            kind.name(),
            2,
            is_float,
            &|builder, values| builder.binary(kind, values[0], values[1]),
            &|[a, b, _]| kind.evaluate([a, b]),
        );
    }
}

#[test]
fn comparisons_and_masks() {
    for &kind in Compare::ALL {
        test_operation(
            kind.name(),
            2,
            false,
            &|builder, values| {
                let mask = builder.compare(kind, values[0], values[1]);
                let [yes, no] = [builder.word(7), builder.word(9)];
                builder.select(mask, yes, no)
            },
            &|[a, b, _]| if kind.evaluate([a, b]) { 7 } else { 9 },
        );
    }
    for &kind in MaskBinary::ALL {
        test_operation(
            kind.name(),
            3,
            false,
            &|builder, values| {
                let first = builder.compare(Compare::SLt, values[0], values[1]);
                let second = builder.compare(Compare::ULt, values[2], values[0]);
                let mask = builder.mask_binary(kind, first, second);
                let mask = builder.mask_not(mask);
                builder.select(mask, values[1], values[2])
            },
            &|[a, b, c]| {
                let first = Compare::SLt.evaluate([a, b]);
                let second = Compare::ULt.evaluate([c, a]);
                if kind.evaluate([first, second]) { c } else { b }
            },
        );
    }
}

#[test]
fn fused_products() {
    test_operation(
        "fma",
        3,
        true,
        &|builder, values| builder.op1(Op::Fma([values[0], values[1], values[2]])),
        &fma,
    );
    test_operation(
        "fma of itself",
        1,
        true,
        &|builder, values| builder.op1(Op::Fma([values[0]; 3])),
        &|[a, ..]| fma([a; 3]),
    );
}

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
fn count(tree: &Tree, isa: Isa, mnemonic: iced_x86::Mnemonic) -> usize {
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
                assert_eq!(products > 0, isa == Isa::Avx512);
            }
        }
    }
}

#[test]
fn functions() {
    for &function in Math::ALL {
        test_operation(
            function.name(),
            1,
            true,
            &|builder, values| builder.math(function, values[0]),
            &|[x, ..]| function.evaluate(f32::from_bits(x)).to_bits(),
        );
    }
    for &function in Math2::ALL {
        test_operation(
            function.name(),
            2,
            true,
            &|builder, values| builder.op1(Op::Math2(function, [values[0], values[1]])),
            &|[x, y, _]| function.evaluate([x, y].map(f32::from_bits)).to_bits(),
        );
    }
}
