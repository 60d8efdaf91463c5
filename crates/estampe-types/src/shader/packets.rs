//! Conversion between a batch's packets and the numbers that a shader computes with: one packet, a
//! pair, or a pair of pairs.

use super::{Sink, Source};
use crate::{Pair, Real};
use estampe_simd::{Bytes, LANES, Lanes, Packet, SimdBase, f32x16, i32x16, mask32x16, u32x16};

/// As many packets as `N` says: one, a pair, or a pair of pairs.
pub(super) trait Packets<S: Lanes, const N: usize>: Real {
    fn zero(simd: S) -> Self;
    /// The next scalar of each packet.
    fn take(simd: S, left: &mut [&[Packet<f32>]; N]) -> Self;
    /// Each packet.
    fn parts(self) -> [f32x16<S>; N];
    /// The mask whose lane i is bit i of each packet's bits.
    fn mask_of(simd: S, bits: [u16; N]) -> Self::SelectMask;
    /// Integers from each packet's lanes.
    fn ints_of(simd: S, lanes: [&[u32; LANES]; N]) -> Self::Int;
    /// [`Packets::parts`] of integers.
    fn parts_of_ints(ints: Self::Int) -> [i32x16<S>; N];
    /// [`Packets::parts`] of a mask.
    fn parts_of_mask(mask: Self::SelectMask) -> [mask32x16<S>; N];
}

impl<S: Lanes> Packets<S, 1> for f32x16<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        SimdBase::splat(simd, 0.0)
    }
    #[inline(always)]
    fn take(simd: S, [left]: &mut [&[Packet<f32>]; 1]) -> Self {
        next(simd, left)
    }
    #[inline(always)]
    fn parts(self) -> [Self; 1] {
        [self]
    }
    #[inline(always)]
    fn mask_of(simd: S, [bits]: [u16; 1]) -> mask32x16<S> {
        simd.mask_from_bits(bits)
    }
    #[inline(always)]
    fn ints_of(simd: S, [lanes]: [&[u32; LANES]; 1]) -> i32x16<S> {
        ints(simd, lanes)
    }
    #[inline(always)]
    fn parts_of_ints(ints: i32x16<S>) -> [i32x16<S>; 1] {
        [ints]
    }
    #[inline(always)]
    fn parts_of_mask(mask: mask32x16<S>) -> [mask32x16<S>; 1] {
        [mask]
    }
}

/// Implements pairs of numbers that stand for half as many packets.
macro_rules! pair {
    ($half:ty, $n:literal: $($first:ident)+ | $($second:ident)+) => {
        impl<S: Lanes> Packets<S, $n> for Pair<$half> {
            #[inline(always)]
            fn zero(simd: S) -> Self {
                let zero = <$half>::zero(simd);
                Self(zero, zero)
            }
            #[inline(always)]
            fn take(simd: S, left: &mut [&[Packet<f32>]; $n]) -> Self {
                let [$($first,)+ $($second),+] = *left;
                let (mut of_first, mut of_second) = ([$($first),+], [$($second),+]);
                let taken = Self(
                    <$half>::take(simd, &mut of_first),
                    <$half>::take(simd, &mut of_second),
                );
                let ([$($first),+], [$($second),+]) = (of_first, of_second);
                *left = [$($first,)+ $($second),+];
                taken
            }
            #[inline(always)]
            fn parts(self) -> [f32x16<S>; $n] {
                let ([$($first),+], [$($second),+]) = (self.0.parts(), self.1.parts());
                [$($first,)+ $($second),+]
            }
            #[inline(always)]
            fn mask_of(simd: S, [$($first,)+ $($second),+]: [u16; $n]) -> Self::SelectMask {
                Pair(
                    <$half>::mask_of(simd, [$($first),+]),
                    <$half>::mask_of(simd, [$($second),+]),
                )
            }
            #[inline(always)]
            fn ints_of(
                simd: S,
                [$($first,)+ $($second),+]: [&[u32; LANES]; $n],
            ) -> Self::Int {
                Pair(
                    <$half>::ints_of(simd, [$($first),+]),
                    <$half>::ints_of(simd, [$($second),+]),
                )
            }
            #[inline(always)]
            fn parts_of_ints(ints: Self::Int) -> [i32x16<S>; $n] {
                let [$($first),+] = <$half>::parts_of_ints(ints.0);
                let [$($second),+] = <$half>::parts_of_ints(ints.1);
                [$($first,)+ $($second),+]
            }
            #[inline(always)]
            fn parts_of_mask(mask: Self::SelectMask) -> [mask32x16<S>; $n] {
                let [$($first),+] = <$half>::parts_of_mask(mask.0);
                let [$($second),+] = <$half>::parts_of_mask(mask.1);
                [$($first,)+ $($second),+]
            }
        }
    };
}
pair! { f32x16<S>, 2: a | b }
pair! { Pair<f32x16<S>>, 4: a b | c d }

#[inline(always)]
fn ints<S: Lanes>(simd: S, lanes: &[u32; LANES]) -> i32x16<S> {
    <u32x16<S> as SimdBase<S>>::load_array_ref(simd, lanes).bitcast()
}

/// The next scalar of a packet.
#[inline(always)]
fn next<S: Lanes>(simd: S, left: &mut &[Packet<f32>]) -> f32x16<S> {
    match left.split_first() {
        Some((first, rest)) => {
            *left = rest;
            SimdBase::load_array_ref(simd, &first.0)
        }
        // Unreachable: the slice has as many packets as the type has scalars.
        None => SimdBase::splat(simd, 0.0),
    }
}

/// Scalars of each of `N` packets, read in order.
pub(super) struct PacketSource<'a, S, const N: usize> {
    pub(super) simd: S,
    pub(super) left: [&'a [Packet<f32>]; N],
    /// Derivatives along x and along y, of each packet.
    pub(super) derivatives: [[&'a [Packet<f32>]; N]; 2],
}

impl<'a, S, const N: usize> PacketSource<'a, S, N> {
    /// Scalars without derivatives.
    #[inline(always)]
    pub(super) fn new(simd: S, left: [&'a [Packet<f32>]; N]) -> Self {
        Self {
            simd,
            left,
            derivatives: [[&[]; N]; 2],
        }
    }

    /// The scalars of fragments, of which each packet has `varyings`, then derivatives.
    #[inline(always)]
    pub(super) fn of_fragments(simd: S, packets: [&'a [Packet<f32>]; N], varyings: usize) -> Self {
        let mut source = Self::new(simd, packets);
        for (at, packet) in packets.into_iter().enumerate() {
            let (left, derivatives) = packet.split_at(varyings);
            let [along_x, along_y] = &mut source.derivatives;
            source.left[at] = left;
            (along_x[at], along_y[at]) = derivatives.split_at(derivatives.len() / 2);
        }
        source
    }
}

impl<S: Lanes, R: Packets<S, N>, const N: usize> Source<R> for PacketSource<'_, S, N> {
    #[inline(always)]
    fn take(&mut self) -> R {
        R::take(self.simd, &mut self.left)
    }

    #[inline(always)]
    fn take_derivative(&mut self, axis: usize, _like: R) -> R {
        R::take(self.simd, &mut self.derivatives[axis])
    }
}

/// Scalars of one packet, written in order.
pub(super) struct PacketSink<'a> {
    pub(super) left: &'a mut [Packet<f32>],
}

impl<S: Lanes> Sink<f32x16<S>> for PacketSink<'_> {
    #[inline(always)]
    fn put(&mut self, value: f32x16<S>) {
        if let Some((first, rest)) = std::mem::take(&mut self.left).split_first_mut() {
            value.store_array(&mut first.0);
            self.left = rest;
        }
    }
}
