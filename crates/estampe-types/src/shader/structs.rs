//! The macros [`varyings!`](crate::varyings) and [`attributes!`](crate::attributes): structs with
//! named fields instead of tuples.

/// Declares a struct of varyings: the values that a vertex passes to the fragments, by name.
///
/// The struct has one type parameter, which must be called `R`: the number that the shader computes
/// with. A field is a number `R`, a [`Vec2`](crate::Vec2), [`Vec3`](crate::Vec3) or
/// [`Vec4`](crate::Vec4), or another type of varyings, such as a
/// [`WithGradient`](crate::WithGradient). There may be as many fields as the device's limits allow
/// scalars. Attributes of a field choose its interpolation:
///
/// | attribute | GLSL | meaning |
/// |---|---|---|
/// | none | `smooth` | perspective-correct, at the pixel centre |
/// | `#[flat]` | `flat` | the provoking vertex's value |
/// | `#[no_perspective]` | `noperspective` | linear in window space |
/// | `#[centroid]` | `centroid` | at a covered position: [`Sampling::Centroid`] |
/// | `#[sample]` | `sample` | at each sample: [`Sampling::Sample`] |
///
/// `#[centroid]` and `#[sample]` combine with `#[no_perspective]`. Documentation, visibility and
/// other attributes are kept. The struct is `Debug`, `Clone` and `Copy`.
///
/// ```
/// use estampe_types::{Mat4, Vec2, Vec3, shader::*};
///
/// estampe_types::attributes! {
///     struct Corner<R> {
///         position: Vec3<R>,
///         normal: Vec3<R>,
///         uv: Vec2<R>,
///     }
/// }
///
/// estampe_types::varyings! {
///     /// A point of a surface.
///     struct Surface<R> {
///         /// Index of the material.
///         #[flat]
///         material: R,
///         normal: Vec3<R>,
///         #[no_perspective]
///         uv: Vec2<R>,
///     }
/// }
///
/// struct Lit { clip_from_object: Mat4 }
///
/// estampe_types::shader! {
///     impl Shader for Lit {
///         type Attributes<R: Real> = Corner<R>;
///         type Varyings<R: Real> = Surface<R>;
///
///         fn vertex<R: Real>(
///             &self,
///             input: VertexIn<'_, R>,
///             corner: Corner<R>,
///         ) -> VertexOut<R, Surface<R>> {
///             VertexOut::new(
///                 self.clip_from_object.transform_point(corner.position),
///                 Surface { material: input.real(3.0), normal: corner.normal, uv: corner.uv },
///             )
///         }
///
///         fn fragment<R: Real>(
///             &self,
///             _input: FragmentIn<'_, R>,
///             Surface { normal, uv, .. }: Surface<R>,
///         ) -> FragmentOut<R> {
///             FragmentOut::color((normal.normalize() * uv.x).point())
///         }
///     }
/// }
/// ```
///
/// A struct without `<R>` is refused: "write the type parameter: struct `Name<R>`".
///
/// ```compile_fail
/// estampe_types::varyings! {
///     struct Surface { normal: estampe_types::Vec3<R> }
/// }
/// ```
///
/// [`Sampling::Centroid`]: crate::Sampling::Centroid
/// [`Sampling::Sample`]: crate::Sampling::Sample
#[macro_export]
macro_rules! varyings {
    ($(#[$meta:meta])* $visibility:vis struct $name:ident<R> { $($fields:tt)* }) => {
        $crate::__fields! {
            [varyings { $(#[$meta])* $visibility $name }] [] [] [] $($fields)*
        }
    };
    ($(#[$meta:meta])* $visibility:vis struct $name:ident { $($fields:tt)* }) => {
        ::core::compile_error! {
            "write the type parameter: struct Name<R>; R is the number that the shader computes with"
        }
    };
    ($($other:tt)*) => {
        ::core::compile_error! {
            "varyings! takes one struct with named fields and the type parameter R: \
             struct Name<R> { field: R, other: Vec3<R> }"
        }
    };
}

/// Declares a struct of vertex attributes, by name: its fields are the locations 0, 1, … in order.
///
/// A field is a number `R`, a [`Vec2`](crate::Vec2), [`Vec3`](crate::Vec3) or
/// [`Vec4`](crate::Vec4), or another type of attributes. The type parameter must be called `R`.
/// [`varyings!`](crate::varyings) has an example.
///
/// Interpolation is a property of varyings, so `#[flat]` and its like are refused with the sentence
/// "attributes are not interpolated".
///
/// ```compile_fail
/// estampe_types::attributes! {
///     struct Corner<R> { #[flat] position: estampe_types::Vec3<R> }
/// }
/// ```
#[macro_export]
macro_rules! attributes {
    ($(#[$meta:meta])* $visibility:vis struct $name:ident<R> { $($fields:tt)* }) => {
        $crate::__fields! {
            [attributes { $(#[$meta])* $visibility $name }] [] [] [] $($fields)*
        }
    };
    ($(#[$meta:meta])* $visibility:vis struct $name:ident { $($fields:tt)* }) => {
        ::core::compile_error! {
            "write the type parameter: struct Name<R>; R is the number that the shader computes with"
        }
    };
    ($($other:tt)*) => {
        ::core::compile_error! {
            "attributes! takes one struct with named fields and the type parameter R: \
             struct Name<R> { field: R, other: Vec3<R> }"
        }
    };
}

/// Separates the interpolation of each field from its other attributes, then declares the struct.
///
/// The brackets hold the header, the fields done, and the attributes and the interpolation of the
/// next field.
#[doc(hidden)]
#[macro_export]
macro_rules! __fields {
    ($header:tt $done:tt $attributes:tt [$($how:ident)*] #[flat] $($rest:tt)*) => {
        $crate::__fields! { $header $done $attributes [$($how)* flat] $($rest)* }
    };
    ($header:tt $done:tt $attributes:tt [$($how:ident)*] #[no_perspective] $($rest:tt)*) => {
        $crate::__fields! { $header $done $attributes [$($how)* no_perspective] $($rest)* }
    };
    ($header:tt $done:tt $attributes:tt [$($how:ident)*] #[centroid] $($rest:tt)*) => {
        $crate::__fields! { $header $done $attributes [$($how)* centroid] $($rest)* }
    };
    ($header:tt $done:tt $attributes:tt [$($how:ident)*] #[sample] $($rest:tt)*) => {
        $crate::__fields! { $header $done $attributes [$($how)* sample] $($rest)* }
    };
    ($header:tt $done:tt [$($attribute:tt)*] $how:tt #[$meta:meta] $($rest:tt)*) => {
        $crate::__fields! { $header $done [$($attribute)* #[$meta]] $how $($rest)* }
    };
    (
        $header:tt [$($done:tt)*] $attributes:tt $how:tt
        $visibility:vis $field:ident: $type:ty $(, $($rest:tt)*)?
    ) => {
        $crate::__fields! {
            $header [$($done)* { $attributes $how $visibility $field: $type }] [] [] $($($rest)*)?
        }
    };
    (
        [varyings { $(#[$meta:meta])* $visibility:vis $name:ident }]
        [$({
            [$(#[$field_meta:meta])*] [$($how:ident)*]
            $field_visibility:vis $field:ident: $type:ty
        })*]
        [] []
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy)]
        $visibility struct $name<R> {
            $($(#[$field_meta])* $field_visibility $field: $type,)*
        }

        impl<R: $crate::Real> $crate::Varyings<R> for $name<R> {
            fn modes(out: &mut ::std::vec::Vec<$crate::Interpolation>) {
                $(
                    let first = out.len();
                    <$type as $crate::Varyings<R>>::modes(out);
                    $($crate::__fields! { @mode $how out first })*
                    let _ = first;
                )*
            }
            fn sampling(out: &mut ::std::vec::Vec<$crate::Sampling>) {
                $(
                    let first = out.len();
                    <$type as $crate::Varyings<R>>::sampling(out);
                    $($crate::__fields! { @sampling $how out first })*
                    let _ = first;
                )*
            }
            fn gradients(out: &mut ::std::vec::Vec<bool>) {
                $(<$type as $crate::Varyings<R>>::gradients(out);)*
            }
            #[inline(always)]
            fn load(from: &mut impl $crate::shader::Source<R>) -> Self {
                Self { $($field: <$type as $crate::Varyings<R>>::load(from),)* }
            }
            #[inline(always)]
            fn store(self, to: &mut impl $crate::shader::Sink<R>) {
                $(<$type as $crate::Varyings<R>>::store(self.$field, to);)*
            }
        }
    };
    (
        [attributes { $(#[$meta:meta])* $visibility:vis $name:ident }]
        [$({
            [$(#[$field_meta:meta])*] []
            $field_visibility:vis $field:ident: $type:ty
        })*]
        [] []
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy)]
        $visibility struct $name<R> {
            $($(#[$field_meta])* $field_visibility $field: $type,)*
        }

        impl<R: $crate::Real> $crate::Attributes<R> for $name<R> {
            fn components(out: &mut ::std::vec::Vec<usize>) {
                $(<$type as $crate::Attributes<R>>::components(out);)*
            }
            #[inline(always)]
            fn load(from: &mut impl $crate::shader::Source<R>) -> Self {
                Self { $($field: <$type as $crate::Attributes<R>>::load(from),)* }
            }
        }
    };
    (@mode flat $out:ident $first:ident) => {
        $out[$first..].fill($crate::Interpolation::Flat);
    };
    (@mode no_perspective $out:ident $first:ident) => {
        $out[$first..].fill($crate::Interpolation::NoPerspective);
    };
    (@mode $how:ident $out:ident $first:ident) => {};
    (@sampling centroid $out:ident $first:ident) => {
        $out[$first..].fill($crate::Sampling::Centroid);
    };
    (@sampling sample $out:ident $first:ident) => {
        $out[$first..].fill($crate::Sampling::Sample);
    };
    (@sampling $how:ident $out:ident $first:ident) => {};
    ([attributes $header:tt] $($fields:tt)*) => {
        ::core::compile_error! {
            "fields are name: type, with type R, Vec2<R>, Vec3<R> or Vec4<R>; attributes are not \
             interpolated, so #[flat], #[no_perspective], #[centroid] and #[sample] are for varyings!"
        }
    };
    ([varyings $header:tt] $($fields:tt)*) => {
        ::core::compile_error! {
            "fields are name: type, with type R, Vec2<R>, Vec3<R> or Vec4<R>, and the attributes \
             #[flat], #[no_perspective], #[centroid] or #[sample]"
        }
    };
}
