//! Every row of the table and every scalar instruction, decoded by an independent disassembler.

use super::element::{Arithmetic, Element};
use super::scalar::Width;
use super::vector_op::{self, ALL, Tuple};
use super::{Address, Assembler, Base, Condition, Gpr, Length, Rm, VectorInstruction, VectorOp};
use iced_x86::{
    Decoder, DecoderOptions, Instruction, MemorySize, Mnemonic, OpKind, Register, RoundingControl,
};

fn decode(bytes: &[u8]) -> Instruction {
    let instruction = Decoder::with_ip(64, bytes, 0x1000, DecoderOptions::NONE).decode();
    assert!(!instruction.is_invalid(), "{bytes:02x?}");
    assert_eq!(instruction.len(), bytes.len(), "{bytes:02x?}");
    instruction
}

fn mnemonic(instruction: &Instruction) -> String {
    format!("{:?}", instruction.mnemonic()).to_lowercase()
}

/// The numbers of the register operands, in order.
fn registers(instruction: &Instruction) -> Vec<usize> {
    let operands = 0..instruction.op_count();
    operands
        .filter(|&at| instruction.op_kind(at) == OpKind::Register)
        .map(|at| instruction.op_register(at).full_register().number())
        .collect()
}

fn has_immediate(op: &VectorOp) -> bool {
    op.map == 3 || op.digit.is_some() || op.name == "vcmpps"
}

/// The number of registers in each place: of vectors, of general-purpose or of mask registers.
fn limits(op: &VectorOp, is_evex: bool) -> [u8; 3] {
    use vector_op as v;
    let vectors = if is_evex { 32 } else { 16 };
    let is_mask = op.name.starts_with('k');
    let compares = is_evex && op.name.contains("cmp");
    let reg = match op {
        _ if *op == v::GPR_FROM_MASK || *op == v::SIGNS => 16,
        _ if is_mask || compares => 8,
        _ => vectors,
    };
    let rm = match op {
        _ if *op == v::MASK_FROM_GPR || *op == v::STORE_LOWEST => 16,
        _ if is_mask => 8,
        _ => vectors,
    };
    [reg, if is_mask { 8 } else { vectors }, rm]
}

fn forms(op: &VectorOp) -> Vec<(bool, Length)> {
    let mut forms = Vec::new();
    if op.rounds_up {
        return vec![(true, Length::L512)];
    }
    if op.vex_w.is_some() {
        forms.extend([(false, Length::L128), (false, Length::L256)]);
    }
    if op.evex_w.is_some() {
        forms.extend([Length::L128, Length::L256, Length::L512].map(|length| (true, length)));
    }
    forms
}

#[test]
fn vector_instructions_between_registers() {
    use vector_op as v;
    let random = &mut fastrand::Rng::with_seed(1);
    let only_memory = [&v::MASK_STORE, &v::GATHER, &v::SCATTER];
    for op in ALL.iter().filter(|op| !only_memory.contains(op)) {
        for (is_evex, length) in forms(op) {
            for _ in 0..200 {
                let [reg, vvvv, rm] = limits(op, is_evex).map(|limit| random.u8(..limit));
                let vvvv = if op.has_vvvv() { vvvv } else { 0 };
                // Destinations alone can be masked, and comparisons.
                let can_mask = is_evex && !matches!(op.tuple, Tuple::Bytes(_));
                let mask = if can_mask { random.u8(..8) } else { 0 };
                let immediate = has_immediate(op).then(|| random.u8(..16) << 4);
                let mut assembler = Assembler::default();
                assembler.vector(&VectorInstruction {
                    op,
                    is_evex,
                    length,
                    reg,
                    vvvv,
                    rm: Rm::Register(rm),
                    mask,
                    immediate,
                });
                let bytes = assembler.finish_code();
                let decoded = decode(&bytes);
                let name = if is_evex { op.evex_name } else { op.name };
                assert_eq!(mnemonic(&decoded), name);
                let mut expected = vec![reg, vvvv, rm];
                if op.digit.is_some() {
                    expected = vec![vvvv, rm];
                } else if !op.has_vvvv() {
                    expected.remove(1);
                }
                let stores = [
                    &v::STORE,
                    &v::STORE_LOWEST,
                    &v::F16_FROM_F32,
                    &v::HALVES_FROM_WORDS,
                ];
                if stores.contains(op) {
                    expected.reverse();
                }
                if **op == v::BLEND_BY_SIGN {
                    expected.push(immediate.unwrap_or(0) >> 4);
                }
                let expected: Vec<usize> = expected.into_iter().map(usize::from).collect();
                assert_eq!(registers(&decoded), expected, "{name} {bytes:02x?}");
                let masked = decoded.op_mask();
                let number = if masked == Register::None {
                    0
                } else {
                    masked.number()
                };
                assert_eq!(number, usize::from(mask), "{name}");
                let rounding = if op.rounds_up {
                    RoundingControl::RoundUp
                } else {
                    RoundingControl::None
                };
                assert_eq!(decoded.rounding_control(), rounding, "{name}");
            }
        }
    }
}

#[test]
fn vector_instructions_with_memory() {
    use vector_op as v;
    let random = &mut fastrand::Rng::with_seed(2);
    let only_registers = [
        // Half of a vector: they are used with registers.
        &v::F64_FROM_S32,
        &v::F64_FROM_U32,
        &v::F32_FROM_F16,
        &v::FMA_F_UP,
        &v::F16_FROM_F32,
        &v::WORDS_FROM_HALVES,
        &v::HALVES_FROM_WORDS,
        &v::MASK_FROM_GPR,
        &v::GPR_FROM_MASK,
        &v::SIGNS,
        &v::MASK_AND,
        &v::MASK_NOT_AND,
        &v::MASK_NOT,
        &v::MASK_OR,
        &v::MASK_SAME,
        &v::MASK_XOR,
        &v::MASK_TEST,
    ];
    let mut broadcasts = 0;
    for op in ALL.iter().filter(|op| !only_registers.contains(op)) {
        for (is_evex, length) in forms(op) {
            if op.digit.is_some() && !is_evex {
                continue;
            }
            for _ in 0..200 {
                let [reg, vvvv, _] = limits(op, is_evex).map(|limit| random.u8(..limit));
                let is_gather = **op == v::GATHER || **op == v::SCATTER;
                let index_limit = if is_evex { 32 } else { 16 };
                let index = is_gather.then(|| random.u8(..index_limit));
                let reads_mask = is_gather && !is_evex;
                let overlaps_mask = !is_evex && (index == Some(vvvv) || reg == vvvv);
                if is_gather && (index == Some(reg) || overlaps_mask) {
                    continue;
                }
                let vvvv = if op.has_vvvv() || reads_mask { vvvv } else { 0 };
                let mask = if is_gather && is_evex {
                    random.u8(1..8)
                } else {
                    0
                };
                let can_broadcast = is_evex
                    && matches!(op.tuple, Tuple::Full(_))
                    && ![&v::LOAD, &v::STORE, &v::MOVE, &v::SHUFFLE_BYTES].contains(op);
                let is_broadcast = can_broadcast && random.bool();
                broadcasts += u32::from(is_broadcast);
                let base = Gpr(random.u8(..16));
                let displacement = match random.u8(..4) {
                    0 => 0,
                    1 => random.i32(-40..40) * 4,
                    2 => random.i32(-200..200) * length.bytes(),
                    _ => random.i32(..),
                };
                let immediate = has_immediate(op).then(|| random.u8(..16) << 4);
                let address = Address {
                    base: Base::Gpr(base),
                    index,
                    displacement,
                    is_broadcast,
                };
                let mut assembler = Assembler::default();
                assembler.vector(&VectorInstruction {
                    op,
                    is_evex,
                    length,
                    reg,
                    vvvv,
                    rm: Rm::Memory(address),
                    mask,
                    immediate,
                });
                let bytes = assembler.finish_code();
                let decoded = decode(&bytes);
                let name = if is_evex { op.evex_name } else { op.name };
                assert_eq!(mnemonic(&decoded), name);
                check_memory(&decoded, address, is_evex);
                assert_eq!(decoded.is_broadcast(), is_broadcast, "{name}");
                let expected = match () {
                    () if op.digit.is_some() => vec![vvvv],
                    () if **op == v::BLEND_BY_SIGN => {
                        vec![reg, vvvv, immediate.unwrap_or(0) >> 4]
                    }
                    () if op.has_vvvv() || reads_mask => vec![reg, vvvv],
                    () => vec![reg],
                };
                let expected: Vec<usize> = expected.into_iter().map(usize::from).collect();
                assert_eq!(registers(&decoded), expected, "{name} {bytes:02x?}");
            }
        }
    }
    assert!(broadcasts > 1000);
}

fn check_memory(decoded: &Instruction, address: Address, is_evex: bool) {
    let Base::Gpr(base) = address.base else {
        panic!("tested with registers");
    };
    assert_eq!(decoded.memory_base().number(), usize::from(base.0));
    let displacement = decoded.memory_displacement64();
    assert_eq!(
        displacement,
        i64::from(address.displacement).cast_unsigned()
    );
    match address.index {
        None => assert_eq!(decoded.memory_index(), Register::None),
        Some(index) => {
            assert_eq!(
                decoded.memory_index().number(),
                usize::from(index),
                "{is_evex}"
            );
            assert_eq!(decoded.memory_index_scale(), 4);
        }
    }
}

#[test]
fn constants_follow_the_code() {
    let mut assembler = Assembler::default();
    let pool = assembler.pool_splat(7, 1);
    let second = assembler.pool_splat(9, 1);
    assert_eq!(pool, assembler.pool_splat(7, 1));
    let address = Address {
        base: Base::Pool,
        index: None,
        displacement: second.cast_signed(),
        is_broadcast: true,
    };
    assembler.vector(&VectorInstruction {
        op: &vector_op::ROUND_F,
        is_evex: true,
        length: Length::L512,
        reg: 3,
        vvvv: 0,
        rm: Rm::Memory(address),
        mask: 0,
        immediate: Some(1),
    });
    let finished = assembler.finish();
    let decoded = decode(&finished.bytes[..finished.code_bytes]);
    assert_eq!(decoded.memory_size(), MemorySize::Broadcast512_Float32);
    let at = usize::try_from(decoded.memory_displacement64() - 0x1000).unwrap();
    assert_eq!(finished.bytes[at..at + 4], [9, 0, 0, 0]);
}

#[test]
fn scalar_instructions() {
    let random = &mut fastrand::Rng::with_seed(3);
    for _ in 0..400 {
        let [a, b, c] = [0; 3].map(|_| Gpr(random.u8(..16)));
        let displacement = random.i32(-300..300);
        let address = Address::at(b, displacement);
        let immediate = random.u32(..);
        let wide = random.bool();
        let width = if wide { Width::Qword } else { Width::Dword };
        let check = |emit: &dyn Fn(&mut Assembler), name: Mnemonic, expected: &[Gpr]| {
            let mut assembler = Assembler::default();
            emit(&mut assembler);
            let decoded = decode(&assembler.finish_code());
            assert_eq!(decoded.mnemonic(), name);
            let expected: Vec<usize> = expected.iter().map(|gpr| usize::from(gpr.0)).collect();
            let mut found = registers(&decoded);
            if decoded.memory_base() != Register::None {
                found.push(decoded.memory_base().number());
                let displaced = decoded.memory_displacement64().cast_signed();
                if name != Mnemonic::Lea {
                    assert_eq!(displaced, i64::from(displacement));
                }
            }
            assert_eq!(found, expected, "{name:?}");
            decoded
        };
        check(&|x| x.push(a), Mnemonic::Push, &[a]);
        check(&|x| x.pop(a), Mnemonic::Pop, &[a]);
        let moved = check(&|x| x.mov(width, a, b), Mnemonic::Mov, &[a, b]);
        assert_eq!(moved.op0_register().is_gpr64(), wide);
        let moved = check(&|x| x.mov_immediate(a, immediate), Mnemonic::Mov, &[a]);
        assert_eq!(moved.immediate32(), immediate);
        let loaded = check(&|x| x.load(width, a, address), Mnemonic::Mov, &[a, b]);
        assert_eq!(loaded.op0_register().is_gpr64(), wide);
        check(&|x| x.store(width, address, a), Mnemonic::Mov, &[a, b]);
        let stored = check(&|x| x.store_byte(address, a), Mnemonic::Mov, &[a, b]);
        assert!(
            stored.op1_register().is_gpr8()
                && !format!("{:?}", stored.op1_register()).ends_with('H')
        );
        check(&|x| x.lea(a, address), Mnemonic::Lea, &[a, b]);
        if c.0 != 4 {
            let element = check(&|x| x.lea_element(a, b, c), Mnemonic::Lea, &[a, b]);
            assert_eq!(element.memory_index().number(), usize::from(c.0));
            assert_eq!(element.memory_index_scale(), 4);
            assert_eq!(element.memory_displacement64(), 0);
        }
        for (kind, name) in ARITHMETIC {
            check(&|x| x.arithmetic(kind, a, b), name, &[a, b]);
        }
        check(&|x| x.cmp(a, b), Mnemonic::Cmp, &[a, b]);
        let moved = check(
            &|x| x.cmov_word(Condition::Greater, a, b),
            Mnemonic::Cmovg,
            &[a, b],
        );
        assert!(moved.op0_register().is_gpr32());
        check(&|x| x.lowest_bit(a, b), Mnemonic::Bsf, &[a, b]);
        check(&|x| x.sbb(a, b), Mnemonic::Sbb, &[a, b]);
        check(&|x| x.neg(a), Mnemonic::Neg, &[a]);
        let masked = check(&|x| x.and_immediate(a, immediate), Mnemonic::And, &[a]);
        assert_eq!(masked.immediate32(), immediate);
        let shifted = check(&|x| x.shr(a, 5), Mnemonic::Shr, &[a]);
        assert_eq!(shifted.immediate8(), 5);
        check(&|x| x.imul(a, b, 15), Mnemonic::Imul, &[a, b]);
        check(&|x| x.cmp_memory(a, address), Mnemonic::Cmp, &[a, b]);
        check(&|x| x.test(a), Mnemonic::Test, &[a, a]);
        check(
            &|x| x.cmov(Condition::NotBelow, a, b),
            Mnemonic::Cmovae,
            &[a, b],
        );
        let decremented = check(&|x| x.sub_memory(address, 1), Mnemonic::Sub, &[b]);
        assert_eq!(decremented.memory_size(), MemorySize::UInt64);
        check(&|x| x.call(address), Mnemonic::Call, &[b]);
        check(&|x| x.jump_to(address), Mnemonic::Jmp, &[b]);
        check(&Assembler::ret, Mnemonic::Ret, &[]);
        check(&Assembler::vzeroupper, Mnemonic::Vzeroupper, &[]);
    }
}

const ARITHMETIC: [(Arithmetic, Mnemonic); 5] = [
    (Arithmetic::Add, Mnemonic::Add),
    (Arithmetic::Or, Mnemonic::Or),
    (Arithmetic::And, Mnemonic::And),
    (Arithmetic::Sub, Mnemonic::Sub),
    (Arithmetic::Xor, Mnemonic::Xor),
];

#[test]
fn instructions_on_elements() {
    let random = &mut fastrand::Rng::with_seed(4);
    for _ in 0..400 {
        let [base, index, register] = [0; 3].map(|_| Gpr(random.u8(..16)));
        let index = Gpr(if index.0 == 4 { 5 } else { index.0 });
        let element = Element {
            base,
            index,
            displacement: random.i32(..),
        };
        let check_sized = |emit: &dyn Fn(&mut Assembler), name, (is_locked, size)| {
            let mut assembler = Assembler::default();
            emit(&mut assembler);
            let decoded = decode(&assembler.finish_code());
            assert_eq!(decoded.mnemonic(), name);
            assert_eq!(decoded.has_lock_prefix(), is_locked);
            assert_eq!(registers(&decoded), [usize::from(register.0)]);
            assert_eq!(decoded.memory_base().number(), usize::from(base.0));
            assert_eq!(decoded.memory_index().number(), usize::from(index.0));
            assert_eq!(decoded.memory_index_scale(), size);
            assert_eq!(decoded.memory_size().size(), size as usize);
            let displacement = i64::from(element.displacement).cast_unsigned();
            assert_eq!(decoded.memory_displacement64(), displacement);
            decoded.op0_kind()
        };
        let check = |emit: &dyn Fn(&mut Assembler), name: Mnemonic, is_locked: bool| {
            check_sized(emit, name, (is_locked, 4))
        };
        let half = |x: &mut Assembler| x.store_half_element(element, register);
        assert_eq!(
            check_sized(&half, Mnemonic::Mov, (false, 2)),
            OpKind::Memory
        );
        let kind = check(&|x| x.load_element(register, element), Mnemonic::Mov, false);
        assert_eq!(kind, OpKind::Register);
        let kind = check(
            &|x| x.store_element(element, register),
            Mnemonic::Mov,
            false,
        );
        assert_eq!(kind, OpKind::Memory);
        check(
            &|x| x.exchange_element(element, register),
            Mnemonic::Xchg,
            false,
        );
        for is_locked in [false, true] {
            let operands = (element, register);
            for (kind, name) in ARITHMETIC {
                check(
                    &|x| x.update_element(kind, is_locked, operands),
                    name,
                    is_locked,
                );
            }
            let add = |x: &mut Assembler| x.exchange_and_add(is_locked, element, register);
            check(&add, Mnemonic::Xadd, is_locked);
        }
    }
}

#[test]
fn jumps_go_to_labels_before_and_after() {
    let mut assembler = Assembler::default();
    let [before, after] = [0; 2].map(|_| assembler.new_label());
    assembler.bind(before);
    assembler.jump(after);
    assembler.jump_if(Condition::Zero, before);
    assembler.jump_if(Condition::Below, after);
    assembler.lea_label(Gpr(9), after);
    assembler.bind(after);
    let end = assembler.len();
    let bytes = assembler.finish_code();
    let mut decoder = Decoder::with_ip(64, &bytes, 0, DecoderOptions::NONE);
    let end = u64::try_from(end).unwrap();
    for (mnemonic, target) in [(Mnemonic::Jmp, end), (Mnemonic::Je, 0), (Mnemonic::Jb, end)] {
        let jump = decoder.decode();
        assert_eq!(jump.mnemonic(), mnemonic);
        assert_eq!(jump.near_branch_target(), target);
    }
    let address = decoder.decode();
    assert_eq!(address.mnemonic(), Mnemonic::Lea);
    assert_eq!(address.op0_register(), Register::R9);
    assert_eq!(address.ip_rel_memory_address(), end);
}

impl Assembler {
    /// The instructions alone.
    fn finish_code(self) -> Vec<u8> {
        let finished = self.finish();
        finished.bytes[..finished.code_bytes].to_vec()
    }
}
