//! The list of component-wise functions, from which methods and free functions are made.

/// Calls one of the macros of this folder with the functions of one number, and those of two.
///
/// `methods_of_real` leaves out the functions under `own`, which [`Real`](crate::Real) declares
/// itself.
macro_rules! with_functions {
    ($callback:ident) => {
        $crate::maths::list::$callback! {
            own {
                /// Absolute value.
                abs
                /// The greatest integer that is not above `x`.
                floor
                /// Square root, correctly rounded. Negative numbers give NaN.
                sqrt
                /// `x − floor(x)`.
                fract
                /// `x` clamped to 0..=1; NaN gives 0.
                saturate
            }
            one {
                /// 1 for positive numbers, −1 for negative ones; zeros and NaN are returned
                /// unchanged.
                sign
                /// The least integer that is not below `x`.
                ceil
                /// `x` without its fraction: the nearest integer towards zero.
                trunc
                /// The nearest integer, ties to even.
                round
                /// 1 ÷ √x, within 1.5 ulp. Zeros give infinity of the same sign, negative numbers
                /// NaN.
                inverse_sqrt
                /// Sine of an angle in radians, within 1.5·10⁻⁷ for |x| ≤ 2048. Beyond, the error
                /// grows with the distance between neighbouring f32. Finite x give at most ±(1 +
                /// 2⁻²³), infinity and NaN give NaN.
                sin
                /// Cosine of an angle in radians, within 1.5·10⁻⁷ for |x| ≤ 2048. Beyond, the error
                /// grows with the distance between neighbouring f32. Finite x give numbers in
                /// −1..=1, infinity and NaN give NaN.
                cos
                /// Tangent of an angle in radians: sin x ÷ cos x, within 9 ulp for |x| ≤ π.
                tan
                /// Arc sine in radians, −π/2..=π/2, within 2.5 ulp. NaN beyond −1..=1.
                asin
                /// Arc cosine in radians, 0..=π, within 1.5 ulp. NaN beyond −1..=1.
                acos
                /// Arc tangent in radians, −π/2..=π/2, within 2 ulp.
                atan
                /// Hyperbolic sine, within 2 ulp. Infinite beyond ±89.4.
                sinh
                /// Hyperbolic cosine, within 2 ulp. Infinite beyond ±89.4.
                cosh
                /// Hyperbolic tangent, within 1.5 ulp, in −1..=1.
                tanh
                /// eˣ, with a relative error of at most 1.5·10⁻⁷ where it is a normal number. Gives
                /// 0 below 2⁻¹⁵⁰, infinity beyond f32's range, and NaN for NaN.
                exp
                /// 2ˣ, within 2 ulp for x in −126..128. Gives 0 below 2⁻¹²⁶, infinity above 2¹²⁸,
                /// and NaN for NaN.
                exp2
                /// Natural logarithm, within 2 ulp for positive normal numbers. Zeros and positive
                /// subnormals give −∞, negative numbers and NaN give NaN, infinity gives infinity.
                log
                /// Logarithm to base 2, within 3 ulp for positive normal numbers. Zeros and
                /// positive subnormals give −∞, negative numbers and NaN give NaN, infinity gives
                /// infinity.
                log2
                /// Degrees to radians: x times π/180.
                radians
                /// Radians to degrees: x times 180/π.
                degrees
            }
            two {
                /// x^y = 2^(y·log₂ x) for x ≥ 0, with the relative error of log₂ times y; 0^y = 0
                /// for y > 0 and x^0 = 1. Negative x gives NaN.
                pow(x, y)
                /// The angle of the point (x, y) in radians, −π..=π, within 2 ulp. Signed zeros and
                /// infinities are as in IEEE 754.
                atan2(y, x)
                /// WGSL's `x % y`: x − y·trunc(x ÷ y), which has the sign of x.
                remainder(x, y)
                /// GLSL's `mod(x, y)`: x − y·floor(x ÷ y), which has the sign of y.
                modulo(x, y)
            }
        }
    };
}
pub(crate) use with_functions;

/// Methods of [`Real`](crate::Real).
macro_rules! methods_of_real {
    (
        own { $($(#[$own_doc:meta])* $own:ident)+ }
        one { $($(#[$doc:meta])* $name:ident)+ }
        two { $($(#[$two_doc:meta])* $two:ident($x:ident, $y:ident))+ }
    ) => {
        $(
            $(#[$doc])*
            #[inline(always)]
            #[must_use]
            fn $name(self) -> Self {
                $crate::maths::scalar::$name(self)
            }
        )+
        $(
            $(#[$two_doc])*
            #[doc = ""]
            #[doc = concat!("`self` is ", stringify!($x), ".")]
            #[inline(always)]
            #[must_use]
            fn $two(self, $y: impl Operand<Self>) -> Self {
                $crate::maths::scalar::$two(self, $y.operand(self))
            }
        )+
    };
}
pub(crate) use methods_of_real;

/// Methods of the number of dry runs, which are compiled once and not in each shader.
macro_rules! methods_of_recorded {
    (
        own { $($(#[$own_doc:meta])* $own:ident)+ }
        one { $($(#[$doc:meta])* $name:ident)+ }
        two { $($(#[$two_doc:meta])* $two:ident($x:ident, $y:ident))+ }
    ) => {
        $(
            #[inline(never)]
            fn $name(self) -> Self {
                self.made($crate::maths::scalar::$name(self.used()))
            }
        )+
        $(
            fn $two(self, other: impl Operand<Self>) -> Self {
                #[inline(never)]
                fn of_two<'a>(a: Recorded<'a>, b: Recorded<'a>) -> Recorded<'a> {
                    a.made($crate::maths::scalar::$two(a.used(), b.used()))
                }
                of_two(self, other.operand(self))
            }
        )+
    };
}
pub(crate) use methods_of_recorded;

/// Methods of a vector.
macro_rules! methods_of_vectors {
    (
        own { $($(#[$own_doc:meta])* $own:ident)+ }
        one { $($(#[$doc:meta])* $name:ident)+ }
        two { $($(#[$two_doc:meta])* $two:ident($x:ident, $y:ident))+ }
    ) => {
        $crate::maths::list::methods_of_vectors! { @one $($own)+ $($name)+ }
        $(
            #[doc = concat!("Each component by [`Real::", stringify!($two), "`].")]
            #[inline(always)]
            #[must_use]
            pub fn $two(self, $y: impl Operand<Self>) -> Self {
                Componentwise::$two(self, $y.operand(self))
            }
        )+
    };
    (@one $($name:ident)+) => {$(
        #[doc = concat!("Each component by [`Real::", stringify!($name), "`].")]
        #[inline(always)]
        #[must_use]
        pub fn $name(self) -> Self {
            Componentwise::$name(self)
        }
    )+};
}
pub(crate) use methods_of_vectors;

/// The trait [`Componentwise`](super::Componentwise) and its implementations.
macro_rules! trait_componentwise {
    (
        own { $($(#[$own_doc:meta])* $own:ident)+ }
        one { $($(#[$doc:meta])* $name:ident)+ }
        two { $($(#[$two_doc:meta])* $two:ident($x:ident, $y:ident))+ }
    ) => {
        componentwise! {
            $($(#[$own_doc])* $own)+ $($(#[$doc])* $name)+;
            /// The sum.
            plus
            /// The difference.
            minus
            /// The product.
            times
            /// The quotient.
            over
            /// `self < other ? self : other`.
            min
            /// `self > other ? self : other`.
            max
            /// 1 where `other ≥ self`, else 0.
            step
            $($(#[$two_doc])* $two)+
        }
    };
}
pub(crate) use trait_componentwise;

/// The free functions of one operand, and those of two that are in the list.
macro_rules! free_functions {
    (
        own { $($(#[$own_doc:meta])* $own:ident)+ }
        one { $($(#[$doc:meta])* $name:ident)+ }
        two { $($(#[$two_doc:meta])* $two:ident($x:ident, $y:ident))+ }
    ) => {
        one_operand! { $($(#[$own_doc])* $own)+ $($(#[$doc])* $name)+ }
        two_operands! { $($(#[$two_doc])* $two($x, $y))+ }
    };
}
pub(crate) use free_functions;
