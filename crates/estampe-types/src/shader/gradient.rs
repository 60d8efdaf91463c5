//! Varyings with their derivatives in the window.

use super::{Attributes, Sampling, Sink, Source, Varyings};
use crate::{Interpolation, Real};

/// A varying with its derivatives in the window, which a fragment takes from its primitive.
///
/// A texture that is sampled at a varying with a gradient takes its level of detail from it,
/// fragment by fragment. Without, the level of detail comes from the differences within a quad of
/// 2×2 fragments, which must then be shaded even where the primitive covers only one of them.
/// Shaders as text have gradients if all their samples are at varyings as they are.
///
/// ```
/// use estampe_types::{Vec2, WithGradient};
///
/// // In the vertex shader.
/// let uv: WithGradient<Vec2<f32>> = Vec2::new(0.5, 0.25).into();
/// # assert_eq!(uv.value.x, 0.5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WithGradient<T> {
    /// The varying.
    pub value: T,
    /// Its derivative in x: its change from a pixel to the next on the right, were its rate that at
    /// this fragment. 0 in a vertex shader, and if the varying is [`Flat`](crate::Flat).
    pub ddx: T,
    /// Its derivative in y, downwards.
    pub ddy: T,
}

impl<T: Copy> From<T> for WithGradient<T> {
    /// The varying of a vertex, which passes on its value alone.
    #[inline(always)]
    fn from(value: T) -> Self {
        Self {
            value,
            ddx: value,
            ddy: value,
        }
    }
}

/// As attributes they have no derivatives.
impl<R: Real, T: Attributes<R> + Copy> Attributes<R> for WithGradient<T> {
    fn components(out: &mut Vec<usize>) {
        T::components(out);
    }
    #[inline(always)]
    fn load(from: &mut impl Source<R>) -> Self {
        T::load(from).into()
    }
}

impl<R: Real, T: Varyings<R>> Varyings<R> for WithGradient<T> {
    fn modes(out: &mut Vec<Interpolation>) {
        T::modes(out);
    }
    fn sampling(out: &mut Vec<Sampling>) {
        T::sampling(out);
    }
    fn gradients(out: &mut Vec<bool>) {
        let first = out.len();
        T::gradients(out);
        out[first..].fill(true);
    }
    #[inline(always)]
    fn load(from: &mut impl Source<R>) -> Self {
        let mut values = Values { from, last: None };
        let value = T::load(&mut values);
        let last = values.last;
        Self {
            value,
            ddx: T::load(&mut Derivatives::<_, _, 0> { from, last }),
            ddy: T::load(&mut Derivatives::<_, _, 1> { from, last }),
        }
    }
    #[inline(always)]
    fn store(self, to: &mut impl Sink<R>) {
        self.value.store(to);
    }
}

/// The scalars of the value; keeps the last one.
struct Values<'a, F, R> {
    from: &'a mut F,
    last: Option<R>,
}

impl<R: Real, F: Source<R>> Source<R> for Values<'_, F, R> {
    #[inline(always)]
    fn take(&mut self) -> R {
        let next = self.from.take();
        self.last = Some(next);
        next
    }
}

/// The derivatives of the scalars along an axis; `last` is one of the scalars.
struct Derivatives<'a, F, R, const AXIS: usize> {
    from: &'a mut F,
    last: Option<R>,
}

impl<R: Real, F: Source<R>, const AXIS: usize> Source<R> for Derivatives<'_, F, R, AXIS> {
    #[inline(always)]
    fn take(&mut self) -> R {
        match self.last {
            Some(like) => self.from.take_derivative(AXIS, like),
            // Not reached: the value has as many scalars.
            None => self.from.take(),
        }
    }
}
