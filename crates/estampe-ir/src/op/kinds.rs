//! The kinds of operations on words and masks.
//!
//! Results are defined for all operands, as `docs/NUMERICS.md` says: nothing traps.

macro_rules! kinds {
    ($(#[$doc:meta])* $name:ident { $($(#[$one_doc:meta])* $variant:ident $text:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $name { $($(#[$one_doc])* $variant,)+ }

        impl $name {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The name in the text form.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $text,)+ }
            }
        }
    };
}

kinds! {
    /// Operations on one word.
    Unary {
        /// A float with the opposite sign, NaN too.
        FNeg "fneg",
        /// A float without its sign, NaN too.
        FAbs "fabs",
        /// The square root, correctly rounded.
        FSqrt "fsqrt",
        /// The greatest whole float that is not above.
        FFloor "ffloor",
        /// The least whole float that is not below.
        FCeil "fceil",
        /// The whole float towards zero.
        FTrunc "ftrunc",
        /// The nearest whole float, ties to even.
        FRound "fround",
        /// A float; NaN becomes the bits 0x7FC0_0000.
        Canonical "canonical",
        /// The nearest binary16, ties to even, as a float.
        RoundF16 "round_f16",
        /// The float to binary16 (nearest, ties to even), in the low half of the word.
        F16FromF32 "f16_from_f32",
        /// The binary16 in the low half of the word as a float.
        F32FromF16 "f32_from_f16",
        /// A float to a signed integer: truncated, saturated; NaN gives 0.
        S32FromF32 "s32_from_f32",
        /// A float to an unsigned integer: truncated, saturated; NaN gives 0.
        U32FromF32 "u32_from_f32",
        /// A signed integer to the nearest float, ties to even.
        F32FromS32 "f32_from_s32",
        /// An unsigned integer to the nearest float, ties to even.
        F32FromU32 "f32_from_u32",
        /// Each bit's opposite.
        Not "not",
        /// The number of ones.
        CountOnes "count_ones",
        /// The bits in reverse order.
        ReverseBits "reverse_bits",
        /// The number of zeros above the highest one; 32 for 0.
        LeadingZeros "leading_zeros",
        /// The number of zeros below the lowest one; 32 for 0.
        TrailingZeros "trailing_zeros",
    }
}

kinds! {
    /// Operations on two words a and b.
    Binary {
        /// Float sum.
        FAdd "fadd",
        /// Float difference.
        FSub "fsub",
        /// Float product.
        FMul "fmul",
        /// Float quotient.
        FDiv "fdiv",
        /// `a < b ? a : b`: b where either is NaN, and of zeros.
        FMin "fmin",
        /// `a > b ? a : b`: b where either is NaN, and of zeros.
        FMax "fmax",
        /// Integer sum, modulo 2³².
        Add "add",
        /// Integer difference, modulo 2³².
        Sub "sub",
        /// Integer product, modulo 2³².
        Mul "mul",
        /// The high word of the product of unsigned integers.
        UMulHigh "umul_high",
        /// The high word of the product of signed integers.
        SMulHigh "smul_high",
        /// Signed quotient, towards zero. Where b is 0, and for −2³¹ ÷ −1, it is a.
        SDiv "sdiv",
        /// Signed remainder with the sign of a. Where b is 0, and for −2³¹ ÷ −1, it is 0.
        SRem "srem",
        /// Unsigned quotient; a where b is 0.
        UDiv "udiv",
        /// Unsigned remainder; 0 where b is 0.
        URem "urem",
        /// Bits that both have.
        And "and",
        /// Bits that either has.
        Or "or",
        /// Bits that one has.
        Xor "xor",
        /// a to the left by b modulo 32.
        Shl "shl",
        /// a to the right by b modulo 32, zeros from the left.
        UShr "ushr",
        /// a to the right by b modulo 32, copies of the sign from the left.
        SShr "sshr",
        /// The lesser signed integer.
        SMin "smin",
        /// The greater signed integer.
        SMax "smax",
        /// The lesser unsigned integer.
        UMin "umin",
        /// The greater unsigned integer.
        UMax "umax",
    }
}

kinds! {
    /// Comparisons of two words. Comparisons of floats with NaN are false, but for `FNe`.
    Compare {
        /// Floats are equal; −0 equals 0.
        FEq "feq",
        /// Floats are not equal.
        FNe "fne",
        /// Float a < b.
        FLt "flt",
        /// Float a ≤ b.
        FLe "fle",
        /// Words are equal.
        Eq "eq",
        /// Words are not equal.
        Ne "ne",
        /// Signed a < b.
        SLt "slt",
        /// Signed a ≤ b.
        SLe "sle",
        /// Unsigned a < b.
        ULt "ult",
        /// Unsigned a ≤ b.
        ULe "ule",
    }
}

kinds! {
    /// Operations on two masks.
    MaskBinary {
        /// Lanes of both.
        And "mand",
        /// Lanes of either.
        Or "mor",
        /// Lanes of one.
        Xor "mxor",
        /// Lanes of the first that are not in the second.
        AndNot "mandnot",
    }
}

kinds! {
    /// Functions of a float, with the bits of `estampe_types::maths`.
    Math {
        /// Sine.
        Sin "sin",
        /// Cosine.
        Cos "cos",
        /// Tangent.
        Tan "tan",
        /// Arc sine.
        Asin "asin",
        /// Arc cosine.
        Acos "acos",
        /// Arc tangent.
        Atan "atan",
        /// Hyperbolic sine.
        Sinh "sinh",
        /// Hyperbolic cosine.
        Cosh "cosh",
        /// Hyperbolic tangent.
        Tanh "tanh",
        /// eˣ.
        Exp "exp",
        /// 2ˣ.
        Exp2 "exp2",
        /// Natural logarithm.
        Log "log",
        /// Logarithm to base 2.
        Log2 "log2",
    }
}

kinds! {
    /// Functions of two floats, with the bits of `estampe_types::maths`.
    Math2 {
        /// xʸ.
        Pow "pow",
        /// The angle of (x, y), given as y and x.
        Atan2 "atan2",
    }
}

kinds! {
    /// Directions of derivatives.
    Axis {
        /// Along a row, to the right.
        X "x",
        /// Along a column, downwards.
        Y "y",
    }
}

kinds! {
    /// How derivatives are taken.
    Precision {
        /// Each row or column of the quad has its own.
        Fine "fine",
        /// The quad has that of its upper left fragment.
        Coarse "coarse",
    }
}

kinds! {
    /// What an atomic operation stores, from the stored word a and the operand b.
    Atomic {
        /// a + b.
        Add "add",
        /// a − b.
        Sub "sub",
        /// Bits of both.
        And "and",
        /// Bits of either.
        Or "or",
        /// Bits of one.
        Xor "xor",
        /// The lesser signed integer.
        SMin "smin",
        /// The greater signed integer.
        SMax "smax",
        /// The lesser unsigned integer.
        UMin "umin",
        /// The greater unsigned integer.
        UMax "umax",
        /// b.
        Exchange "exchange",
        /// Nothing: the word is only read.
        Load "load",
        /// b; the result is not used.
        Store "store",
        /// The low 16 bits of b in the place of a's high ones if b's highest bit is set, else of
        /// a's low ones.
        StoreHalf "store_half",
    }
}
