//! The macro [`shader!`](macro@crate::shader).

/// Implements [`Shader`](trait@crate::Shader), or declares functions that shaders call, so that
/// they are fast.
///
/// The sixteen-lane form of a function is compiled with SIMD instructions only if the function is
/// inlined into the code that selects the SIMD level. The macro marks every function in it
/// `#[inline(always)]`. A function outside must carry that attribute itself: without it, shaders
/// run 5 to 14 times slower.
///
/// It implements [`TessellationShader`](trait@crate::shader::TessellationShader) and
/// [`GeometryShader`](trait@crate::shader::GeometryShader) in the same way.
///
/// # An implementation
///
/// `shader! { impl Shader for Type { … } }` takes generics, bounds and a `where` clause. Beside the
/// items of the trait it accepts functions and constants of your own, which become associated
/// functions and constants of the type. All items may have documentation and attributes. The traits
/// [`Real`](crate::Real), [`Int`](crate::Int), [`Operand`](crate::Operand) and
/// [`Sample2d`](crate::shader::Sample2d) are in scope.
///
/// ```
/// use estampe_types::{Vec3, Vec4, shader::*};
///
/// struct Rings<T> { centre: T }
///
/// estampe_types::shader! {
///     /// Concentric rings.
///     impl<T> Shader for Rings<T>
///     where
///         T: Into<[f32; 2]> + Copy + Send + Sync + 'static,
///     {
///         type Attributes<R: Real> = Vec4<R>;
///         type Varyings<R: Real> = Vec4<R>;
///         /// Number of rings in a unit.
///         const RINGS: f32 = 8.0;
///
///         fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec4<R>) -> VertexOut<R, Vec4<R>> {
///             VertexOut::new(at, at)
///         }
///
///         fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, at: Vec4<R>) -> FragmentOut<R> {
///             let light = Self::ring(self.distance(at), 0.5);
///             FragmentOut::color(Vec3::repeat(light).point())
///         }
///
///         /// Distance from the centre.
///         fn distance<R: Real>(&self, at: Vec4<R>) -> R {
///             let [x, y] = self.centre.into();
///             (at.xy() - estampe_types::vec2(x, y)).length()
///         }
///
///         fn ring<R: Real>(distance: R, width: impl Operand<R>) -> R {
///             let phase = (distance * Self::RINGS).fract();
///             R::select(phase.lt(width), phase, 1.0 - phase)
///         }
///     }
/// }
/// ```
///
/// # Functions outside
///
/// `shader! { fn … }` declares one or more functions that any shader may call.
///
/// ```
/// use estampe_types::{Operand, Real};
///
/// estampe_types::shader! {
///     /// 1 where `x` is inside `low..=high`, else 0.
///     pub fn inside<R: Real>(x: R, low: impl Operand<R>, high: impl Operand<R>) -> R {
///         R::select(x.ge(low) & x.le(high), x.splat(1.0), x.splat(0.0))
///     }
/// }
/// assert_eq!(inside(0.5, 0.0, 1.0), 1.0);
/// ```
///
/// # What is refused
///
/// Other items are refused with a sentence that says where they go.
///
/// ```compile_fail
/// estampe_types::shader! { struct Rings { centre: [f32; 2] } } // declare types outside of shader!
/// ```
///
/// A name that is almost that of an item of the trait becomes an item of the type, and the compiler
/// reports the trait's item as missing, or the item of the type as never used.
///
/// ```compile_fail
/// # use estampe_types::{Vec4, shader::*};
/// struct White;
/// estampe_types::shader! {
///     impl Shader for White { // "not all trait items implemented, missing: `fragment`"
///         type Attributes<R: Real> = Vec4<R>;
///         type Varyings<R: Real> = ();
///         fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec4<R>) -> VertexOut<R, ()> {
///             VertexOut::new(at, ())
///         }
///         fn fragmnet<R: Real>(&self, input: FragmentIn<'_, R>, _: ()) -> FragmentOut<R> {
///             FragmentOut::color(Vec4::repeat(input.real(1.0)))
///         }
///     }
/// }
/// ```
///
/// `if` takes one `bool`, and lanes have a mask: [`Real::select`](crate::Real::select) chooses in
/// each lane. See [`Real`](crate::Real#conditions).
///
/// ```compile_fail
/// # use estampe_types::{Vec4, shader::*};
/// struct Halves;
/// estampe_types::shader! {
///     impl Shader for Halves {
///         type Attributes<R: Real> = Vec4<R>;
///         type Varyings<R: Real> = Vec4<R>;
///         fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec4<R>) -> VertexOut<R, Vec4<R>> {
///             VertexOut::new(at, at)
///         }
///         fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, at: Vec4<R>) -> FragmentOut<R> {
///             // "expected `bool`, found associated type": write
///             // R::select(at.x.lt(0.0), input.real(0.0), input.real(1.0))
///             let light = if at.x.lt(0.0) { input.real(0.0) } else { input.real(1.0) };
///             FragmentOut::color(Vec4::repeat(light))
///         }
///     }
/// }
/// ```
#[macro_export]
macro_rules! shader {
    ($(#[$meta:meta])* impl Shader for $shader:ty { $($items:tt)* }) => {
        $crate::__shader_items! { [Shader [$(#[$meta])*] [] [$shader] []] [] [] $($items)* }
    };
    ($(#[$meta:meta])* impl Shader for $shader:ty where $($rest:tt)*) => {
        $crate::__shader_header! { @where [Shader [$(#[$meta])*] [] [$shader]] [where] $($rest)* }
    };
    ($(#[$meta:meta])* impl TessellationShader for $shader:ty { $($items:tt)* }) => {
        $crate::__shader_items! { [TessellationShader [$(#[$meta])*] [] [$shader] []] [] [] $($items)* }
    };
    ($(#[$meta:meta])* impl TessellationShader for $shader:ty where $($rest:tt)*) => {
        $crate::__shader_header! { @where [TessellationShader [$(#[$meta])*] [] [$shader]] [where] $($rest)* }
    };
    ($(#[$meta:meta])* impl GeometryShader for $shader:ty { $($items:tt)* }) => {
        $crate::__shader_items! { [GeometryShader [$(#[$meta])*] [] [$shader] []] [] [] $($items)* }
    };
    ($(#[$meta:meta])* impl GeometryShader for $shader:ty where $($rest:tt)*) => {
        $crate::__shader_header! { @where [GeometryShader [$(#[$meta])*] [] [$shader]] [where] $($rest)* }
    };
    ($(#[$meta:meta])* impl < $($rest:tt)*) => {
        $crate::__shader_header! { @generics [$(#[$meta])*] [] $($rest)* }
    };
    ($(#[$meta:meta])* $visibility:vis fn $($rest:tt)*) => {
        $crate::__shader_functions! { $(#[$meta])* $visibility fn $($rest)* }
    };
    ($($other:tt)*) => {
        ::core::compile_error! {
            "shader! takes `impl Shader for Type { … }` (or `TessellationShader`, `GeometryShader`), or functions `fn name<R: Real>(…) { … }`; \
             declare types, traits and other implementations outside of shader!"
        }
    };
}

/// Reads generics up to `> Shader for`, and a `where` clause up to the last braces.
#[doc(hidden)]
#[macro_export]
macro_rules! __shader_header {
    (@generics [$($meta:tt)*] [$($generics:tt)*] > Shader for $shader:ty { $($items:tt)* }) => {
        $crate::__shader_items! {
            [Shader [$($meta)*] [<$($generics)*>] [$shader] []] [] [] $($items)*
        }
    };
    (@generics [$($meta:tt)*] [$($generics:tt)*] > Shader for $shader:ty where $($rest:tt)*) => {
        $crate::__shader_header! {
            @where [Shader [$($meta)*] [<$($generics)*>] [$shader]] [where] $($rest)*
        }
    };
    // A generic argument at the end of the generics: `<T: Into<f32>>`.
    (@generics $meta:tt [$($generics:tt)*] >> Shader for $($rest:tt)*) => {
        $crate::__shader_header! { @generics $meta [$($generics)* >] > Shader for $($rest)* }
    };
    (@generics [$($meta:tt)*] [$($generics:tt)*] > TessellationShader for $shader:ty { $($items:tt)* }) => {
        $crate::__shader_items! {
            [TessellationShader [$($meta)*] [<$($generics)*>] [$shader] []] [] [] $($items)*
        }
    };
    (@generics [$($meta:tt)*] [$($generics:tt)*] > TessellationShader for $shader:ty where $($rest:tt)*) => {
        $crate::__shader_header! {
            @where [TessellationShader [$($meta)*] [<$($generics)*>] [$shader]] [where] $($rest)*
        }
    };
    (@generics $meta:tt [$($generics:tt)*] >> TessellationShader for $($rest:tt)*) => {
        $crate::__shader_header! { @generics $meta [$($generics)* >] > TessellationShader for $($rest)* }
    };
    (@generics [$($meta:tt)*] [$($generics:tt)*] > GeometryShader for $shader:ty { $($items:tt)* }) => {
        $crate::__shader_items! {
            [GeometryShader [$($meta)*] [<$($generics)*>] [$shader] []] [] [] $($items)*
        }
    };
    (@generics [$($meta:tt)*] [$($generics:tt)*] > GeometryShader for $shader:ty where $($rest:tt)*) => {
        $crate::__shader_header! {
            @where [GeometryShader [$($meta)*] [<$($generics)*>] [$shader]] [where] $($rest)*
        }
    };
    (@generics $meta:tt [$($generics:tt)*] >> GeometryShader for $($rest:tt)*) => {
        $crate::__shader_header! { @generics $meta [$($generics)* >] > GeometryShader for $($rest)* }
    };
    (@generics $meta:tt [$($generics:tt)*] $next:tt $($rest:tt)*) => {
        $crate::__shader_header! { @generics $meta [$($generics)* $next] $($rest)* }
    };
    (@where [$($header:tt)*] [$($clause:tt)*] { $($items:tt)* }) => {
        $crate::__shader_items! { [$($header)* [$($clause)*]] [] [] $($items)* }
    };
    (@where $header:tt [$($clause:tt)*] $next:tt $($rest:tt)*) => {
        $crate::__shader_header! { @where $header [$($clause)* $next] $($rest)* }
    };
    ($($other:tt)*) => {
        ::core::compile_error! {
            "shader! takes `impl<…> Shader for Type where … { … }`: this implementation is of \
             another trait, or has no braces"
        }
    };
}

/// Declares functions with `#[inline(always)]`.
#[doc(hidden)]
#[macro_export]
macro_rules! __shader_functions {
    () => {};
    ($(#[$meta:meta])* $visibility:vis fn $($rest:tt)*) => {
        $crate::__shader_functions! { @whole $(#[$meta])* $visibility fn $($rest)* }
    };
    (@whole $function:item $($rest:tt)*) => {
        #[inline(always)]
        $function
        $crate::__shader_functions! { $($rest)* }
    };
    ($($other:tt)*) => {
        ::core::compile_error! {
            "shader! takes either one `impl Shader for Type { … }` or functions alone; declare \
             types, constants and other implementations outside of shader!"
        }
    };
}

/// Divides the items of an implementation into those of the trait and those of the type.
///
/// The brackets hold the header, the items of the trait, and those of the type.
#[doc(hidden)]
#[macro_export]
macro_rules! __shader_items {
    // The end.
    (
        [$kind:ident [$($meta:tt)*] [$($generics:tt)*] [$shader:ty] [$($clause:tt)*]]
        [$($of_trait:tt)*] [$($of_type:tt)*]
    ) => {
        const _: () = {
            #[allow(unused_imports, reason = "for the shader's body, which may not need all")]
            use $crate::{Int, Operand, Real, Shader, shader::Sample2d};
            #[allow(unused_imports, reason = "the trait that is implemented may be another one")]
            use $crate::shader::{Emit, GeometryShader, TessellationShader};

            $($meta)*
            impl $($generics)* $kind for $shader $($clause)* {
                // As in the shader's crate: dependencies are often built without assertions.
                const ASSERTS_OUTPUTS: bool = ::core::cfg!(debug_assertions);

                $($of_trait)*
            }

            $crate::__shader_items! {
                @of_type [$($generics)*] [$shader] [$($clause)*] $($of_type)*
            }
        };
    };
    (@of_type $generics:tt $shader:tt $clause:tt) => {};
    (@of_type [$($generics:tt)*] [$shader:ty] [$($clause:tt)*] $($of_type:tt)+) => {
        impl $($generics)* $shader $($clause)* {
            $($of_type)+
        }
    };
    // Items with their attributes: whose they are.
    ($header:tt $trait:tt $type:tt $(#[$meta:meta])* type $($rest:tt)*) => {
        $crate::__shader_items! { @trait $header $trait $type [] $(#[$meta])* type $($rest)* }
    };
    ([Shader $($header:tt)*] $trait:tt $type:tt $(#[$meta:meta])* fn vertex $($rest:tt)*) => {
        $crate::__shader_items! {
            @trait [Shader $($header)*] $trait $type [#[inline(always)]]
            $(#[$meta])* fn vertex $($rest)*
        }
    };
    ([Shader $($header:tt)*] $trait:tt $type:tt $(#[$meta:meta])* fn fragment $($rest:tt)*) => {
        $crate::__shader_items! {
            @trait [Shader $($header)*] $trait $type [#[inline(always)]]
            $(#[$meta])* fn fragment $($rest)*
        }
    };
    ([TessellationShader $($header:tt)*] $trait:tt $type:tt $(#[$meta:meta])* fn control $($rest:tt)*) => {
        $crate::__shader_items! {
            @trait [TessellationShader $($header)*] $trait $type [#[inline(always)]]
            $(#[$meta])* fn control $($rest)*
        }
    };
    ([TessellationShader $($header:tt)*] $trait:tt $type:tt $(#[$meta:meta])* fn patch $($rest:tt)*) => {
        $crate::__shader_items! {
            @trait [TessellationShader $($header)*] $trait $type [#[inline(always)]]
            $(#[$meta])* fn patch $($rest)*
        }
    };
    ([TessellationShader $($header:tt)*] $trait:tt $type:tt $(#[$meta:meta])* fn evaluate $($rest:tt)*) => {
        $crate::__shader_items! {
            @trait [TessellationShader $($header)*] $trait $type [#[inline(always)]]
            $(#[$meta])* fn evaluate $($rest)*
        }
    };
    ([GeometryShader $($header:tt)*] $trait:tt $type:tt $(#[$meta:meta])* fn geometry $($rest:tt)*) => {
        $crate::__shader_items! {
            @trait [GeometryShader $($header)*] $trait $type [#[inline(always)]]
            $(#[$meta])* fn geometry $($rest)*
        }
    };
    ($header:tt $trait:tt $type:tt $(#[$meta:meta])* $visibility:vis fn $($rest:tt)*) => {
        $crate::__shader_items! {
            @type $header $trait $type [#[inline(always)]] $(#[$meta])* $visibility fn $($rest)*
        }
    };
    ($header:tt $trait:tt $type:tt $(#[$meta:meta])* $visibility:vis const fn $($rest:tt)*) => {
        $crate::__shader_items! {
            @type $header $trait $type [#[inline(always)]]
            $(#[$meta])* $visibility const fn $($rest)*
        }
    };
    ($header:tt $trait:tt $type:tt $(#[$meta:meta])* $visibility:vis const $name:ident $($rest:tt)*) => {
        $crate::__shader_constant! {
            $name [$header $trait $type []] $(#[$meta])* $visibility const $name $($rest)*
        }
    };
    (@trait $header:tt [$($trait:tt)*] $type:tt [$($mark:tt)*] $item:item $($rest:tt)*) => {
        $crate::__shader_items! { $header [$($trait)* $($mark)* $item] $type $($rest)* }
    };
    (@type $header:tt $trait:tt [$($type:tt)*] [$($mark:tt)*] $item:item $($rest:tt)*) => {
        $crate::__shader_items! { $header $trait [$($type)* $($mark)* $item] $($rest)* }
    };
    ($($other:tt)*) => {
        ::core::compile_error! {
            "an `impl Shader` in shader! holds `type Attributes`, `type Varyings`, functions and \
             constants; declare other items outside of shader!, and mark nothing `unsafe` or `async`"
        }
    };
}

/// Tells the constants of the trait from others.
#[doc(hidden)]
#[macro_export]
macro_rules! __shader_constant {
    (COLOR_TARGETS $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (DISCARDS $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (DEPTH_OUTPUT $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (READS_POSITION $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (PER_SAMPLE $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (READS_COVERAGE $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (WRITES_SAMPLE_MASK $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (STORES $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (STORES_IN_ANY_ORDER $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (DUAL_SOURCE $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (TAKES_DERIVATIVES $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (WRITES_POINT_SIZE $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (CLIP_DISTANCES $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (CULL_DISTANCES $($rest:tt)*) => { $crate::__shader_constant! { @trait $($rest)* } };
    (CONTROL_POINTS [[TessellationShader $($header:tt)*] $($state:tt)*] $($rest:tt)*) => {
        $crate::__shader_constant! { @trait [[TessellationShader $($header)*] $($state)*] $($rest)* }
    };
    (INPUT [[GeometryShader $($header:tt)*] $($state:tt)*] $($rest:tt)*) => {
        $crate::__shader_constant! { @trait [[GeometryShader $($header)*] $($state)*] $($rest)* }
    };
    (OUTPUT [[GeometryShader $($header:tt)*] $($state:tt)*] $($rest:tt)*) => {
        $crate::__shader_constant! { @trait [[GeometryShader $($header)*] $($state)*] $($rest)* }
    };
    (MAX_VERTICES [[GeometryShader $($header:tt)*] $($state:tt)*] $($rest:tt)*) => {
        $crate::__shader_constant! { @trait [[GeometryShader $($header)*] $($state)*] $($rest)* }
    };
    (INVOCATIONS [[GeometryShader $($header:tt)*] $($state:tt)*] $($rest:tt)*) => {
        $crate::__shader_constant! { @trait [[GeometryShader $($header)*] $($state)*] $($rest)* }
    };
    (WRITES_LAYER [[GeometryShader $($header:tt)*] $($state:tt)*] $($rest:tt)*) => {
        $crate::__shader_constant! { @trait [[GeometryShader $($header)*] $($state)*] $($rest)* }
    };
    (WRITES_VIEWPORT_INDEX [[GeometryShader $($header:tt)*] $($state:tt)*] $($rest:tt)*) => {
        $crate::__shader_constant! { @trait [[GeometryShader $($header)*] $($state)*] $($rest)* }
    };
    (@trait [$($state:tt)*] $($rest:tt)*) => {
        $crate::__shader_items! { @trait $($state)* $($rest)* }
    };
    ($name:ident [$($state:tt)*] $($rest:tt)*) => {
        $crate::__shader_items! { @type $($state)* $($rest)* }
    };
}
