//! The points of a patch or primitive, as a shader reads them.

use crate::shader::{Interpolation, Source};
use crate::{Int, Real, Sampling, Varyings, Vec4};
use std::marker::PhantomData;

/// The points of a patch or primitive: in each lane those of its own.
///
/// A point is read when it is asked for. An index beyond the last point gives the last one.
pub struct Points<'a, R: Real, T> {
    records: &'a [u32],
    /// The number of each point's record; without it, the records of a patch follow each other.
    corners: Option<&'a [u32]>,
    /// The first element in `corners`, or the first word of the first record.
    first: R::Int,
    /// That of all lanes, if they agree.
    shared: Option<usize>,
    /// Words of a record.
    words: usize,
    count: usize,
    zero: R,
    point: PhantomData<fn() -> T>,
}

impl<R: Real, T> Clone for Points<'_, R, T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<R: Real, T> Copy for Points<'_, R, T> {}

impl<R: Real, T> std::fmt::Debug for Points<'_, R, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Points")
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}

/// A vertex as the vertex shader, or the stage before, left it.
#[derive(Debug, Clone, Copy)]
pub struct ShadedPoint<R, V> {
    /// The position in clip space.
    pub position: Vec4<R>,
    /// The varyings.
    pub varyings: V,
}

impl<R: Real, V: Varyings<R>> Varyings<R> for ShadedPoint<R, V> {
    fn modes(out: &mut Vec<Interpolation>) {
        <Vec4<R> as Varyings<R>>::modes(out);
        V::modes(out);
    }
    fn sampling(out: &mut Vec<Sampling>) {
        <Vec4<R> as Varyings<R>>::sampling(out);
        V::sampling(out);
    }
    fn gradients(out: &mut Vec<bool>) {
        <Vec4<R> as Varyings<R>>::gradients(out);
        V::gradients(out);
    }
    #[inline(always)]
    fn load(from: &mut impl Source<R>) -> Self {
        Self {
            position: <Vec4<R> as Varyings<R>>::load(from),
            varyings: V::load(from),
        }
    }
    #[inline(always)]
    fn store(self, to: &mut impl crate::shader::Sink<R>) {
        self.position.store(to);
        self.varyings.store(to);
    }
}

/// The number of scalars of a type.
pub(crate) fn scalars<T: Varyings<f32>>() -> usize {
    let mut modes = Vec::new();
    T::modes(&mut modes);
    modes.len()
}

/// Records that points are read from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Records<'a> {
    pub(crate) records: &'a [u32],
    pub(crate) corners: Option<&'a [u32]>,
    /// Words of a record.
    pub(crate) words: usize,
    /// Points of a patch.
    pub(crate) count: usize,
}

impl<'a> Records<'a> {
    /// The points of the patches `patch`, lane by lane.
    #[inline(always)]
    pub(crate) fn points<R: Real, T>(
        &self,
        zero: R,
        patch: impl Fn(usize) -> usize,
    ) -> Points<'a, R, T> {
        let each = match self.corners {
            Some(_) => self.count,
            None => self.count * self.words,
        };
        let one = patch(0);
        let mut is_shared = true;
        for lane in 1..R::LANES {
            is_shared &= patch(lane) == one;
        }
        Points {
            records: self.records,
            corners: self.corners,
            first: ints(zero, |lane| patch(lane) * each),
            shared: is_shared.then_some(one * each),
            words: self.words,
            count: self.count,
            zero,
            point: PhantomData,
        }
    }
}

/// Integers below 2³¹, lane by lane.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "records of a batch have fewer than 2³¹ words"
)]
pub(crate) fn ints<R: Real>(zero: R, value: impl Fn(usize) -> usize) -> R::Int {
    zero.with_lanes(
        #[inline(always)]
        |lane| f32::from_bits(value(lane) as u32),
    )
    .to_bits()
}

#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "records of a batch have fewer than 2³¹ words"
)]
fn int(value: usize) -> i32 {
    value as i32
}

impl<'a, R: Real, T> Points<'a, R, T> {
    /// The points of one patch or primitive, the same in every lane: records of `words` words, one
    /// after the other.
    #[must_use]
    pub fn of_patch(zero: R, records: &'a [u32], words: usize, count: usize) -> Self {
        let records = Records {
            records,
            corners: None,
            words,
            count,
        };
        records.points(zero, |_| 0)
    }
}

impl<R: Real, T: Varyings<R>> Points<'_, R, T> {
    /// The number of points.
    #[inline(always)]
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Point `index`.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, index: usize) -> T {
        let index = index.min(self.count.saturating_sub(1));
        let Some(first) = self.shared else {
            return self.gathered(self.zero.splat_int(int(index)));
        };
        let at = match self.corners {
            Some(corners) => corners.get(first + index).map_or(0, |at| *at as usize) * self.words,
            None => first + index * self.words,
        };
        let mut source = SharedSource {
            left: self.records.get(at..).unwrap_or_default(),
            zero: self.zero,
        };
        T::load(&mut source)
    }

    /// The point of a number that each lane chooses.
    #[inline(always)]
    #[must_use]
    pub fn get_at(&self, index: R::Int) -> T {
        let last = int(self.count.saturating_sub(1));
        self.gathered(Int::max(Int::min(index, index.splat(last)), index.splat(0)))
    }

    #[inline(always)]
    fn gathered(&self, index: R::Int) -> T {
        let words = index.splat(int(self.words));
        let at = match self.corners {
            Some(corners) => (self.first + index).gather(corners) * words,
            None => self.first + index * words,
        };
        T::load(&mut GatherSource {
            records: self.records,
            at,
            zero: self.zero,
        })
    }
}

/// The words of one record, the same in every lane.
pub(super) struct SharedSource<'a, R> {
    pub(super) left: &'a [u32],
    pub(super) zero: R,
}

impl<R: Real> Source<R> for SharedSource<'_, R> {
    #[inline(always)]
    fn take(&mut self) -> R {
        match self.left.split_first() {
            Some((first, rest)) => {
                self.left = rest;
                self.zero.splat(f32::from_bits(*first))
            }
            None => self.zero,
        }
    }
}

/// The words of a record for each lane.
pub(super) struct GatherSource<'a, R: Real> {
    pub(super) records: &'a [u32],
    /// The next word.
    pub(super) at: R::Int,
    pub(super) zero: R,
}

impl<R: Real> Source<R> for GatherSource<'_, R> {
    #[inline(always)]
    fn take(&mut self) -> R {
        let word = self.at.gather(self.records).to_real_bits();
        self.at = self.at + self.zero.splat_int(1);
        word
    }
}
