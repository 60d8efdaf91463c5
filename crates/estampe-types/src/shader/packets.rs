//! Conversion between a batch's packets and the numbers that a shader computes with: one packet, or
//! a pair.

use super::{Sink, Source};
use crate::{Pair, Real};
use estampe_simd::{Bytes, LANES, Lanes, Packet, SimdBase, f32x16, i32x16, mask32x16, u32x16};

/// One packet or a pair of packets.
pub(super) trait Packets<S: Lanes>: Real {
    /// Number of packets.
    const COUNT: usize;

    fn zero(simd: S) -> Self;
    /// The next scalar of each packet.
    fn take(simd: S, left: &mut [&[Packet<f32>]; 2]) -> Self;
    /// Both packets; a single packet is returned twice.
    fn parts(self) -> [f32x16<S>; 2];
    /// The mask whose lane i is bit i of each packet's bits.
    fn mask_of(simd: S, bits: [u16; 2]) -> Self::SelectMask;
    /// Integers from each packet's lanes.
    fn ints_of(simd: S, lanes: [[u32; LANES]; 2]) -> Self::Int;
    /// [`Packets::parts`] of integers.
    fn parts_of_ints(ints: Self::Int) -> [i32x16<S>; 2];
    /// [`Packets::parts`] of a mask.
    fn parts_of_mask(mask: Self::SelectMask) -> [mask32x16<S>; 2];
}

impl<S: Lanes> Packets<S> for f32x16<S> {
    const COUNT: usize = 1;

    #[inline(always)]
    fn zero(simd: S) -> Self {
        SimdBase::splat(simd, 0.0)
    }
    #[inline(always)]
    fn take(simd: S, [left, _]: &mut [&[Packet<f32>]; 2]) -> Self {
        next(simd, left)
    }
    #[inline(always)]
    fn parts(self) -> [Self; 2] {
        [self; 2]
    }
    #[inline(always)]
    fn mask_of(simd: S, [bits, _]: [u16; 2]) -> mask32x16<S> {
        simd.mask_from_bits(bits)
    }
    #[inline(always)]
    fn ints_of(simd: S, [lanes, _]: [[u32; LANES]; 2]) -> i32x16<S> {
        ints(simd, lanes)
    }
    #[inline(always)]
    fn parts_of_ints(ints: i32x16<S>) -> [i32x16<S>; 2] {
        [ints; 2]
    }
    #[inline(always)]
    fn parts_of_mask(mask: mask32x16<S>) -> [mask32x16<S>; 2] {
        [mask; 2]
    }
}

impl<S: Lanes> Packets<S> for Pair<f32x16<S>> {
    const COUNT: usize = 2;

    #[inline(always)]
    fn zero(simd: S) -> Self {
        let zero = SimdBase::splat(simd, 0.0);
        Self(zero, zero)
    }
    #[inline(always)]
    fn take(simd: S, [first, second]: &mut [&[Packet<f32>]; 2]) -> Self {
        Self(next(simd, first), next(simd, second))
    }
    #[inline(always)]
    fn parts(self) -> [f32x16<S>; 2] {
        [self.0, self.1]
    }
    #[inline(always)]
    fn mask_of(simd: S, [first, second]: [u16; 2]) -> Self::SelectMask {
        Pair(simd.mask_from_bits(first), simd.mask_from_bits(second))
    }
    #[inline(always)]
    fn ints_of(simd: S, [first, second]: [[u32; LANES]; 2]) -> Self::Int {
        Pair(ints(simd, first), ints(simd, second))
    }
    #[inline(always)]
    fn parts_of_ints(ints: Self::Int) -> [i32x16<S>; 2] {
        [ints.0, ints.1]
    }
    #[inline(always)]
    fn parts_of_mask(mask: Self::SelectMask) -> [mask32x16<S>; 2] {
        [mask.0, mask.1]
    }
}

#[inline(always)]
fn ints<S: Lanes>(simd: S, lanes: [u32; LANES]) -> i32x16<S> {
    <u32x16<S> as SimdBase<S>>::load_array(simd, lanes).bitcast()
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

/// Scalars of one packet, or of each of two, read in order.
pub(super) struct PacketSource<'a, S> {
    pub(super) simd: S,
    pub(super) left: [&'a [Packet<f32>]; 2],
    /// Derivatives along x and along y, of each packet.
    pub(super) derivatives: [[&'a [Packet<f32>]; 2]; 2],
}

impl<'a, S> PacketSource<'a, S> {
    /// Scalars without derivatives.
    #[inline(always)]
    pub(super) fn new(simd: S, left: [&'a [Packet<f32>]; 2]) -> Self {
        Self {
            simd,
            left,
            derivatives: [[&[]; 2]; 2],
        }
    }

    /// The scalars of fragments, of which each packet has `varyings`, then derivatives.
    #[inline(always)]
    pub(super) fn of_fragments(simd: S, packets: [&'a [Packet<f32>]; 2], varyings: usize) -> Self {
        let [first, second] = packets;
        let each = (first.len() - varyings) / 2;
        let (first, derivatives) = first.split_at(varyings);
        let (first_x, first_y) = derivatives.split_at(each);
        let (second, derivatives) = second.split_at(varyings);
        let (second_x, second_y) = derivatives.split_at(each);
        Self {
            simd,
            left: [first, second],
            derivatives: [[first_x, second_x], [first_y, second_y]],
        }
    }
}

impl<S: Lanes, R: Packets<S>> Source<R> for PacketSource<'_, S> {
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
