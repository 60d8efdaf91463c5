//! The table of vector and mask-register instructions.

/// A vector or mask-register instruction without its operands.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct VectorOp {
    /// The mnemonic with a VEX prefix, or the only one.
    pub(crate) name: &'static str,
    /// The mnemonic with an EVEX prefix, where it is another one.
    pub(crate) evex_name: &'static str,
    /// The mandatory prefix: 0 for none, 1 for 66, 2 for F3, 3 for F2.
    pub(crate) prefix: u8,
    /// The opcode map: 1 for 0F, 2 for 0F38, 3 for 0F3A.
    pub(crate) map: u8,
    /// The opcode.
    pub(crate) opcode: u8,
    /// The W bit with a VEX prefix, if there is such a form.
    pub(crate) vex_w: Option<bool>,
    /// The W bit with an EVEX prefix, if there is such a form.
    pub(crate) evex_w: Option<bool>,
    /// The bytes of the memory operand, by which an EVEX displacement of eight bits is scaled.
    pub(crate) tuple: Tuple,
    /// The extension of the opcode that stands in ModRM.reg.
    pub(crate) digit: Option<u8>,
    /// The L bit, of instructions on mask registers and of those with one length only.
    pub(crate) fixed_length: Option<bool>,
    /// True if the result is rounded up, whatever the processor's mode: of vectors of 512 bits in
    /// registers.
    pub(crate) rounds_up: bool,
}

/// The size of a memory operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tuple {
    /// The whole vector, or with a broadcast so many bytes.
    Full(i32),
    /// So many bytes at any length.
    Bytes(i32),
}

/// Mandatory prefixes.
const NONE: u8 = 0;
const P66: u8 = 1;
const F3: u8 = 2;
const F2: u8 = 3;

impl VectorOp {
    /// VEX.W0 and EVEX.W0 with the same mnemonic, four-byte elements.
    const fn both(name: &'static str, prefix: u8, map: u8, opcode: u8) -> Self {
        Self {
            name,
            evex_name: name,
            prefix,
            map,
            opcode,
            vex_w: Some(false),
            evex_w: Some(false),
            tuple: Tuple::Full(4),
            digit: None,
            fixed_length: None,
            rounds_up: false,
        }
    }

    const fn evex_name(mut self, name: &'static str) -> Self {
        self.evex_name = name;
        self
    }

    const fn vex_only(mut self) -> Self {
        self.evex_w = None;
        self
    }

    const fn evex_only(mut self) -> Self {
        self.vex_w = None;
        self
    }

    /// EVEX.W1, eight-byte elements.
    const fn wide(mut self) -> Self {
        self.evex_w = Some(true);
        self.tuple = Tuple::Full(8);
        self
    }

    const fn tuple(mut self, tuple: Tuple) -> Self {
        self.tuple = tuple;
        self
    }

    /// VEX.W1 alone, and vectors of 256 bits alone.
    const fn wide_256(mut self) -> Self {
        self.vex_w = Some(true);
        self.fixed_length = Some(true);
        self.vex_only()
    }

    const fn rounding_up(mut self) -> Self {
        self.rounds_up = true;
        self.evex_only()
    }

    const fn digit(mut self, digit: u8) -> Self {
        self.digit = Some(digit);
        self
    }

    /// An instruction of AVX-512 on mask registers, with a VEX prefix.
    const fn mask(name: &'static str, prefix: u8, opcode: u8, l: bool) -> Self {
        let mut op = Self::both(name, prefix, 1, opcode).vex_only();
        op.fixed_length = Some(l);
        op.tuple = Tuple::Bytes(2);
        op
    }

    /// A move between a vector's lowest element and memory or a general-purpose register.
    const fn lowest(mut self) -> Self {
        self.tuple = Tuple::Bytes(4);
        self.fixed_length = Some(false);
        self
    }
}

macro_rules! table {
    ($($name:ident = $op:expr;)+) => {
        $(pub(crate) static $name: VectorOp = $op;)+

        /// All of the table.
        #[cfg(test)]
        pub(crate) static ALL: &[&VectorOp] = &[$(&$name),+];
    };
}

table! {
    // Floats.
    ADD_F = VectorOp::both("vaddps", NONE, 1, 0x58);
    MUL_F = VectorOp::both("vmulps", NONE, 1, 0x59);
    SUB_F = VectorOp::both("vsubps", NONE, 1, 0x5C);
    MIN_F = VectorOp::both("vminps", NONE, 1, 0x5D);
    DIV_F = VectorOp::both("vdivps", NONE, 1, 0x5E);
    MAX_F = VectorOp::both("vmaxps", NONE, 1, 0x5F);
    SQRT_F = VectorOp::both("vsqrtps", NONE, 1, 0x51);
    ROUND_F = VectorOp::both("vroundps", P66, 3, 0x08).evex_name("vrndscaleps");
    FMA_F = VectorOp::both("vfmadd213ps", P66, 2, 0xA8);
    FMA_F_UP = VectorOp::both("vfmadd213ps", P66, 2, 0xA8).rounding_up();
    MINUS_FMA_F = VectorOp::both("vfnmadd213ps", P66, 2, 0xAC);
    RECIPROCAL_ESTIMATE = VectorOp::both("vrcp14ps", P66, 2, 0x4C).evex_only();
    FIX_UP_F = VectorOp::both("vfixupimmps", P66, 3, 0x54).evex_only();
    COMPARE_F = VectorOp::both("vcmpps", NONE, 1, 0xC2);
    // Integers and bits.
    ADD = VectorOp::both("vpaddd", P66, 1, 0xFE);
    ADD_64 = VectorOp::both("vpaddq", P66, 1, 0xD4).wide();
    SUB = VectorOp::both("vpsubd", P66, 1, 0xFA);
    MUL = VectorOp::both("vpmulld", P66, 2, 0x40);
    MUL_U64 = VectorOp::both("vpmuludq", P66, 1, 0xF4).wide();
    MUL_S64 = VectorOp::both("vpmuldq", P66, 2, 0x28).wide();
    MIN_S = VectorOp::both("vpminsd", P66, 2, 0x39);
    MAX_S = VectorOp::both("vpmaxsd", P66, 2, 0x3D);
    MIN_U = VectorOp::both("vpminud", P66, 2, 0x3B);
    MAX_U = VectorOp::both("vpmaxud", P66, 2, 0x3F);
    AND = VectorOp::both("vpand", P66, 1, 0xDB).evex_name("vpandd");
    OR = VectorOp::both("vpor", P66, 1, 0xEB).evex_name("vpord");
    XOR = VectorOp::both("vpxor", P66, 1, 0xEF).evex_name("vpxord");
    // The same with VEX prefixes, beside operations of floats.
    AND_F = VectorOp::both("vandps", NONE, 1, 0x54).vex_only();
    AND_NOT_F = VectorOp::both("vandnps", NONE, 1, 0x55).vex_only();
    OR_F = VectorOp::both("vorps", NONE, 1, 0x56).vex_only();
    XOR_F = VectorOp::both("vxorps", NONE, 1, 0x57).vex_only();
    AND_NOT = VectorOp::both("vpandn", P66, 1, 0xDF).evex_name("vpandnd");
    SHL = VectorOp::both("vpsllvd", P66, 2, 0x47);
    SHR_U = VectorOp::both("vpsrlvd", P66, 2, 0x45);
    SHR_S = VectorOp::both("vpsravd", P66, 2, 0x46);
    SHL_BY = VectorOp::both("vpslld", P66, 1, 0x72).digit(6);
    SHR_U_BY = VectorOp::both("vpsrld", P66, 1, 0x72).digit(2);
    SHR_S_BY = VectorOp::both("vpsrad", P66, 1, 0x72).digit(4);
    SHR_64_BY = VectorOp::both("vpsrlq", P66, 1, 0x73).wide().digit(2);
    SHL_64_BY = VectorOp::both("vpsllq", P66, 1, 0x73).wide().digit(6);
    COMPARE_S = VectorOp::both("vpcmpd", P66, 3, 0x1F).evex_only();
    COMPARE_U = VectorOp::both("vpcmpud", P66, 3, 0x1E).evex_only();
    EQUAL = VectorOp::both("vpcmpeqd", P66, 1, 0x76).vex_only();
    GREATER_S = VectorOp::both("vpcmpgtd", P66, 1, 0x66).vex_only();
    COUNT_ONES = VectorOp::both("vpopcntd", P66, 2, 0x55).evex_only();
    LEADING_ZEROS = VectorOp::both("vplzcntd", P66, 2, 0x44).evex_only();
    // Conversions.
    F32_FROM_S32 = VectorOp::both("vcvtdq2ps", NONE, 1, 0x5B);
    F32_FROM_U32 = VectorOp::both("vcvtudq2ps", F2, 1, 0x7A).evex_only();
    S32_FROM_F32 = VectorOp::both("vcvttps2dq", F3, 1, 0x5B);
    U32_FROM_F32 = VectorOp::both("vcvttps2udq", NONE, 1, 0x78).evex_only();
    // Eight lanes of 64 bits, from or to the lower eight of 32.
    F64_FROM_S32 = VectorOp::both("vcvtdq2pd", F3, 1, 0xE6).evex_only();
    F64_FROM_U32 = VectorOp::both("vcvtudq2pd", F3, 1, 0x7A).evex_only();
    S32_FROM_F64 = VectorOp::both("vcvttpd2dq", P66, 1, 0xE6).evex_only().wide();
    U32_FROM_F64 = VectorOp::both("vcvttpd2udq", NONE, 1, 0x78).evex_only().wide();
    ADD_F64 = VectorOp::both("vaddpd", P66, 1, 0x58).wide();
    SUB_F64 = VectorOp::both("vsubpd", P66, 1, 0x5C).wide();
    MUL_F64 = VectorOp::both("vmulpd", P66, 1, 0x59).wide();
    DIV_F64 = VectorOp::both("vdivpd", P66, 1, 0x5E).wide();
    ROUND_F64 = VectorOp::both("vroundpd", P66, 3, 0x09).evex_name("vrndscalepd").wide();
    // Lanes of 16 bits, side by side in the lower half of a register.
    F32_FROM_F16 = VectorOp::both("vcvtph2ps", P66, 2, 0x13);
    F16_FROM_F32 = VectorOp::both("vcvtps2ph", P66, 3, 0x1D);
    WORDS_FROM_HALVES = VectorOp::both("vpmovzxwd", P66, 2, 0x33);
    HALVES_FROM_WORDS = VectorOp::both("vpmovdw", F3, 2, 0x33).evex_only();
    PACK_WORDS = VectorOp::both("vpackusdw", P66, 2, 0x2B).vex_only();
    PERMUTE_64 = VectorOp::both("vpermq", P66, 3, 0x00).wide_256();
    // Choice and order of lanes.
    BLEND = VectorOp::both("vblendmps", P66, 2, 0x65).evex_only();
    BLEND_WORDS = VectorOp::both("vpblendd", P66, 3, 0x02).vex_only();
    BLEND_BY_SIGN = VectorOp::both("vblendvps", P66, 3, 0x4A).vex_only();
    SHUFFLE_BYTES = VectorOp::both("vpshufb", P66, 2, 0x00);
    PERMUTE = VectorOp::both("vpermilps", P66, 3, 0x04);
    PERMUTE_TWO = VectorOp::both("vpermt2d", P66, 2, 0x7E).evex_only();
    BROADCAST = VectorOp::both("vbroadcastss", P66, 2, 0x18).tuple(Tuple::Bytes(4));
    BROADCAST_BYTE = VectorOp::both("vpbroadcastb", P66, 2, 0x78).tuple(Tuple::Bytes(1));
    SIGNS = VectorOp::both("vmovmskps", NONE, 1, 0x50).vex_only();
    // Moves.
    LOAD = VectorOp::both("vmovups", NONE, 1, 0x10);
    STORE = VectorOp::both("vmovups", NONE, 1, 0x11);
    MOVE = VectorOp::both("vmovaps", NONE, 1, 0x28);
    STORE_LOWEST = VectorOp::both("vmovd", P66, 1, 0x7E).lowest();
    GATHER = VectorOp::both("vpgatherdd", P66, 2, 0x90).tuple(Tuple::Bytes(4));
    SCATTER = VectorOp::both("vpscatterdd", P66, 2, 0xA0).evex_only().tuple(Tuple::Bytes(4));
    // Mask registers.
    MASK_LOAD = VectorOp::mask("kmovw", NONE, 0x90, false);
    MASK_STORE = VectorOp::mask("kmovw", NONE, 0x91, false);
    MASK_FROM_GPR = VectorOp::mask("kmovw", NONE, 0x92, false);
    GPR_FROM_MASK = VectorOp::mask("kmovw", NONE, 0x93, false);
    MASK_AND = VectorOp::mask("kandw", NONE, 0x41, true);
    MASK_NOT_AND = VectorOp::mask("kandnw", NONE, 0x42, true);
    MASK_NOT = VectorOp::mask("knotw", NONE, 0x44, false);
    MASK_OR = VectorOp::mask("korw", NONE, 0x45, true);
    MASK_SAME = VectorOp::mask("kxnorw", NONE, 0x46, true);
    MASK_XOR = VectorOp::mask("kxorw", NONE, 0x47, true);
    MASK_TEST = VectorOp::mask("kortestw", NONE, 0x98, false);
}

impl VectorOp {
    /// True if the instruction has an operand in the prefix that is not the destination.
    pub(crate) fn has_vvvv(&self) -> bool {
        let two: &[&Self] = &[
            &SQRT_F,
            &RECIPROCAL_ESTIMATE,
            &ROUND_F,
            &ROUND_F64,
            &COUNT_ONES,
            &LEADING_ZEROS,
            &F32_FROM_S32,
            &F32_FROM_U32,
            &S32_FROM_F32,
            &U32_FROM_F32,
            &F64_FROM_S32,
            &F64_FROM_U32,
            &F32_FROM_F16,
            &F16_FROM_F32,
            &WORDS_FROM_HALVES,
            &HALVES_FROM_WORDS,
            &PERMUTE_64,
            &S32_FROM_F64,
            &U32_FROM_F64,
            &PERMUTE,
            &BROADCAST,
            &BROADCAST_BYTE,
            &SIGNS,
            &LOAD,
            &STORE,
            &MOVE,
            &STORE_LOWEST,
            &GATHER,
            &SCATTER,
            &MASK_LOAD,
            &MASK_STORE,
            &MASK_FROM_GPR,
            &GPR_FROM_MASK,
            &MASK_NOT,
            &MASK_TEST,
        ];
        !two.contains(&self)
    }
}
