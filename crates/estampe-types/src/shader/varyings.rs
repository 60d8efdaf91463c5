//! Attributes and varyings as types, which are split into scalars: numbers, vectors, tuples, and
//! the structs of [`attributes!`](crate::attributes) and [`varyings!`](crate::varyings).

use super::Sampling;
use crate::{Interpolation, Real, Vec2, Vec3, Vec4};

/// A source of scalars, in order.
pub trait Source<R> {
    /// The next scalar.
    fn take(&mut self) -> R;
    /// The derivative along x (0) or y (1) of the next of the scalars that have one; `like` is a
    /// number to make others from. 0 where there are none, as in vertex shaders.
    #[inline(always)]
    fn take_derivative(&mut self, _axis: usize, like: R) -> R
    where
        R: Real,
    {
        like.splat(0.0)
    }
}

/// A destination of scalars, in order.
pub trait Sink<R> {
    /// Accepts the next scalar.
    fn put(&mut self, value: R);
}

/// The attributes that a vertex shader reads: one location per element.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be attributes of a vertex",
    label = "this must be numbers or vectors of numbers",
    note = "attributes of a vertex are `R`, `Vec2<R>`, `Vec3<R>`, `Vec4<R>`, `()`, tuples of them, and structs of \
            `estampe::attributes!`"
)]
pub trait Attributes<R: Real>: Sized {
    /// Appends the number of components of each location.
    fn components(out: &mut Vec<usize>);
    /// Reads the value from its scalars.
    fn load(from: &mut impl Source<R>) -> Self;
}

/// The varyings that a vertex shader passes to the fragments.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be varyings",
    label = "this must be numbers or vectors of numbers",
    note = "varyings are `R`, `Vec2<R>`, `Vec3<R>`, `Vec4<R>`, `()`, tuples of them, and structs of \
            `estampe::varyings!`"
)]
pub trait Varyings<R: Real>: Sized {
    /// Appends the interpolation of each scalar.
    fn modes(out: &mut Vec<Interpolation>);
    /// Appends the sampling position of each scalar; by default the centre.
    fn sampling(out: &mut Vec<Sampling>) {
        let mut modes = Vec::new();
        Self::modes(&mut modes);
        out.resize(out.len() + modes.len(), Sampling::Center);
    }
    /// Appends whether each scalar has derivatives, as of [`WithGradient`](crate::WithGradient); by
    /// default none has.
    fn gradients(out: &mut Vec<bool>) {
        let mut modes = Vec::new();
        Self::modes(&mut modes);
        out.resize(out.len() + modes.len(), false);
    }
    /// Reads the value from its scalars.
    fn load(from: &mut impl Source<R>) -> Self;
    /// Writes the value's scalars.
    fn store(self, to: &mut impl Sink<R>);
}

/// A varying that has the provoking vertex's value in the whole primitive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flat<T>(pub T);

/// A varying that is linear in window space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoPerspective<T>(pub T);

/// A varying that is interpolated at a covered position; see [`Sampling::Centroid`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Centroid<T>(pub T);

/// A varying that is interpolated at each sample; see [`Sampling::Sample`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PerSample<T>(pub T);

macro_rules! element {
    ($type:ty; $n:literal; $($field:tt)+) => {
        impl<R: Real> Attributes<R> for $type {
            fn components(out: &mut Vec<usize>) {
                out.push($n);
            }
            #[inline(always)]
            fn load(from: &mut impl Source<R>) -> Self {
                <Self as Varyings<R>>::load(from)
            }
        }

        impl<R: Real> Varyings<R> for $type {
            fn modes(out: &mut Vec<Interpolation>) {
                out.extend([Interpolation::Smooth; $n]);
            }
            #[inline(always)]
            fn load(from: &mut impl Source<R>) -> Self {
                Self { $($field: from.take()),+ }
            }
            #[inline(always)]
            fn store(self, to: &mut impl Sink<R>) {
                $(to.put(self.$field);)+
            }
        }
    };
}
element! { Vec2<R>; 2; x y }
element! { Vec3<R>; 3; x y z }
element! { Vec4<R>; 4; x y z w }

macro_rules! number {
    ($type:ty; $x:ident => $load:expr, $store:expr) => {
        impl<R: Real> Attributes<R> for $type {
            fn components(out: &mut Vec<usize>) {
                out.push(1);
            }
            #[inline(always)]
            fn load(from: &mut impl Source<R>) -> Self {
                let $x = from.take();
                $load
            }
        }

        impl<R: Real> Varyings<R> for $type {
            fn modes(out: &mut Vec<Interpolation>) {
                out.push(Interpolation::Smooth);
            }
            #[inline(always)]
            fn load(from: &mut impl Source<R>) -> Self {
                let $x = from.take();
                $load
            }
            #[inline(always)]
            fn store(self, to: &mut impl Sink<R>) {
                let $x = self;
                to.put($store);
            }
        }
    };
}
number! { R; x => x, x }
number! { [R; 1]; x => [x], x[0] }

macro_rules! mode {
    ($wrapper:ident) => {
        impl<R: Real, T: Varyings<R>> Varyings<R> for $wrapper<T> {
            fn modes(out: &mut Vec<Interpolation>) {
                let first = out.len();
                T::modes(out);
                out[first..].fill(Interpolation::$wrapper);
            }
            fn sampling(out: &mut Vec<Sampling>) {
                T::sampling(out);
            }
            fn gradients(out: &mut Vec<bool>) {
                T::gradients(out);
            }
            #[inline(always)]
            fn load(from: &mut impl Source<R>) -> Self {
                Self(T::load(from))
            }
            #[inline(always)]
            fn store(self, to: &mut impl Sink<R>) {
                self.0.store(to);
            }
        }
    };
}
mode!(Flat);
mode!(NoPerspective);

macro_rules! place {
    ($wrapper:ident $sampling:ident) => {
        impl<R: Real, T: Varyings<R>> Varyings<R> for $wrapper<T> {
            fn modes(out: &mut Vec<Interpolation>) {
                T::modes(out);
            }
            fn sampling(out: &mut Vec<Sampling>) {
                let first = out.len();
                T::sampling(out);
                out[first..].fill(Sampling::$sampling);
            }
            fn gradients(out: &mut Vec<bool>) {
                T::gradients(out);
            }
            #[inline(always)]
            fn load(from: &mut impl Source<R>) -> Self {
                Self(T::load(from))
            }
            #[inline(always)]
            fn store(self, to: &mut impl Sink<R>) {
                self.0.store(to);
            }
        }
    };
}
place!(Centroid Centroid);
place!(PerSample Sample);

macro_rules! tuple {
    ($($name:ident $index:tt),*) => {
        impl<R: Real, $($name: Attributes<R>),*> Attributes<R> for ($($name,)*) {
            fn components(out: &mut Vec<usize>) {
                let _ = &out;
                $($name::components(out);)*
            }
            #[inline(always)]
            #[allow(clippy::unused_unit, reason = "the empty tuple is one of the cases")]
            fn load(from: &mut impl Source<R>) -> Self {
                let _ = &from;
                ($($name::load(from),)*)
            }
        }

        impl<R: Real, $($name: Varyings<R>),*> Varyings<R> for ($($name,)*) {
            fn modes(out: &mut Vec<Interpolation>) {
                let _ = &out;
                $($name::modes(out);)*
            }
            fn sampling(out: &mut Vec<Sampling>) {
                let _ = &out;
                $($name::sampling(out);)*
            }
            fn gradients(out: &mut Vec<bool>) {
                let _ = &out;
                $($name::gradients(out);)*
            }
            #[inline(always)]
            #[allow(clippy::unused_unit, reason = "the empty tuple is one of the cases")]
            fn load(from: &mut impl Source<R>) -> Self {
                let _ = &from;
                ($($name::load(from),)*)
            }
            #[inline(always)]
            fn store(self, to: &mut impl Sink<R>) {
                let _ = &to;
                $(self.$index.store(to);)*
            }
        }
    };
}
tuple!();
tuple!(A 0);
tuple!(A 0, B 1);
tuple!(A 0, B 1, C 2);
tuple!(A 0, B 1, C 2, D 3);
tuple!(A 0, B 1, C 2, D 3, E 4);
tuple!(A 0, B 1, C 2, D 3, E 4, F 5);
