//! Loops over the packets of operands, sixteen lanes at once. An operand that is one word for all
//! lanes is loaded once, before the loop.

use super::state::{Masks, Operand, Words};
use estampe_simd::{Bytes, Lanes, Packet, Select, SimdBase, f32x16, mask32x16, u32x16};
use std::cell::Cell;

#[inline(always)]
pub(super) fn splat<S: Lanes>(s: S, word: u32) -> u32x16<S> {
    SimdBase::splat(s, word)
}

#[inline(always)]
pub(super) fn load<S: Lanes>(s: S, from: &Cell<Packet<u32>>) -> u32x16<S> {
    SimdBase::load_array(s, from.get().0)
}

#[inline(always)]
pub(super) fn float<S: Lanes>(s: S, from: &Cell<Packet<u32>>) -> f32x16<S> {
    load(s, from).bitcast()
}

#[inline(always)]
pub(super) fn store_float<S: Lanes>(to: &Cell<Packet<u32>>, floats: f32x16<S>) {
    store(to, floats.bitcast());
}

#[inline(always)]
pub(super) fn store<S: Lanes>(to: &Cell<Packet<u32>>, words: u32x16<S>) {
    let mut packet = Packet([0; 16]);
    words.store_array(&mut packet.0);
    to.set(packet);
}

#[inline(always)]
pub(super) fn choose<S: Lanes>(s: S, bits: &Cell<u16>, yes: u32x16<S>, no: u32x16<S>) -> u32x16<S> {
    s.mask_from_bits(bits.get()).select(yes, no)
}

#[inline(always)]
pub(super) fn copy<S: Lanes>(s: S, to: Words<'_>, from: Operand<'_>) {
    match from {
        Operand::Many(from) => map(
            s,
            to,
            from,
            #[inline(always)]
            |from| from,
        ),
        Operand::One(from) => {
            let from = splat(s, from);
            for to in to {
                store(to, from);
            }
        }
    }
}

#[inline(always)]
pub(super) fn map<S: Lanes>(s: S, to: Words<'_>, a: Words<'_>, f: impl Fn(u32x16<S>) -> u32x16<S>) {
    for (to, a) in to.iter().zip(a) {
        store(to, f(load(s, a)));
    }
}

#[inline(always)]
pub(super) fn map2<S: Lanes>(
    s: S,
    to: Words<'_>,
    pair: [Operand<'_>; 2],
    f: impl Fn(u32x16<S>, u32x16<S>) -> u32x16<S>,
) {
    match pair {
        [Operand::Many(a), Operand::Many(b)] => {
            for ((to, a), b) in to.iter().zip(a).zip(b) {
                store(to, f(load(s, a), load(s, b)));
            }
        }
        [Operand::Many(a), Operand::One(b)] => {
            let b = splat(s, b);
            for (to, a) in to.iter().zip(a) {
                store(to, f(load(s, a), b));
            }
        }
        [Operand::One(a), Operand::Many(b)] => {
            let a = splat(s, a);
            for (to, b) in to.iter().zip(b) {
                store(to, f(a, load(s, b)));
            }
        }
        [Operand::One(_), Operand::One(_)] => {}
    }
}

#[inline(always)]
pub(super) fn map3<S: Lanes>(
    s: S,
    to: Words<'_>,
    a: Words<'_>,
    rest: [Operand<'_>; 2],
    f: impl Fn(f32x16<S>, f32x16<S>, f32x16<S>) -> f32x16<S>,
) {
    let places = to.iter().zip(a);
    match rest {
        [Operand::Many(b), Operand::Many(c)] => {
            for (((to, a), b), c) in places.zip(b).zip(c) {
                store_float(to, f(float(s, a), float(s, b), float(s, c)));
            }
        }
        [Operand::Many(b), Operand::One(c)] => {
            let c = splat(s, c).bitcast();
            for ((to, a), b) in places.zip(b) {
                store_float(to, f(float(s, a), float(s, b), c));
            }
        }
        [Operand::One(b), Operand::Many(c)] => {
            let b = splat(s, b).bitcast();
            for ((to, a), c) in places.zip(c) {
                store_float(to, f(float(s, a), b, float(s, c)));
            }
        }
        [Operand::One(b), Operand::One(c)] => {
            let (b, c) = (splat(s, b).bitcast(), splat(s, c).bitcast());
            for (to, a) in places {
                store_float(to, f(float(s, a), b, c));
            }
        }
    }
}

#[inline(always)]
pub(super) fn masks<S: Lanes>(
    s: S,
    to: Masks<'_>,
    pair: [Operand<'_>; 2],
    f: impl Fn(u32x16<S>, u32x16<S>) -> mask32x16<S>,
) {
    match pair {
        [Operand::Many(a), Operand::Many(b)] => {
            for ((to, a), b) in to.iter().zip(a).zip(b) {
                to.set(s.bits_of_mask(f(load(s, a), load(s, b))));
            }
        }
        [Operand::Many(a), Operand::One(b)] => {
            let b = splat(s, b);
            for (to, a) in to.iter().zip(a) {
                to.set(s.bits_of_mask(f(load(s, a), b)));
            }
        }
        [Operand::One(a), Operand::Many(b)] => {
            let a = splat(s, a);
            for (to, b) in to.iter().zip(b) {
                to.set(s.bits_of_mask(f(a, load(s, b))));
            }
        }
        [Operand::One(_), Operand::One(_)] => {}
    }
}
