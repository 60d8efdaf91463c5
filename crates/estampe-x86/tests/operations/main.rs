//! Every operation on special and random words, at each instruction set and tier, against the
//! definition of its results.
#![cfg(target_arch = "x86_64")]

mod selection;

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
            let calls = selection::count(&tree, isa, iced_x86::Mnemonic::Call);
            assert_eq!(calls, 0, "{name} {isa:?} {given:?}");
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
