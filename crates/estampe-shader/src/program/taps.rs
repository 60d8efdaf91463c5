//! Filters: samples of one texture at uniform shifts from a varying, `uv + step`, made before the
//! shader runs.
//!
//! Post-processing shaders take five or thirteen such taps. In the code each packet's taps are a
//! call, and which of them stand in the same columns of texels is found for each packet anew.

use super::nondependent::{CHANNELS, TOGETHER};
use super::read_place::Place;
use super::textures::BoundTextures;
use super::uniforms::Finder;
use estampe_ir::op::Binary;
use estampe_ir::tree::{Node, Tree};
use estampe_ir::{Op, Value};
use estampe_simd::Packet;
use estampe_texture::{PacketRequest, TapShifts, shifted};
use std::collections::HashMap;

/// The most taps of a filter.
pub(super) const MOST_TAPS: usize = 16;

/// A number that is added to a coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shift<V> {
    /// Nothing.
    Zero,
    /// A uniform value.
    Plus(V),
    /// A uniform value, negated.
    Minus(V),
}

impl<V> Shift<V> {
    pub(super) fn numbered<W>(self, number: impl FnOnce(V) -> W) -> Shift<W> {
        match self {
            Self::Zero => Shift::Zero,
            Self::Plus(value) => Shift::Plus(number(value)),
            Self::Minus(value) => Shift::Minus(number(value)),
        }
    }
}

impl Shift<usize> {
    /// The number that is added, given the uniform values.
    pub(super) fn amount(self, values: &[u32]) -> f32 {
        match self {
            // Unlike +0, −0 changes no number.
            Self::Zero => -0.0,
            Self::Plus(number) => f32::from_bits(values[number]),
            Self::Minus(number) => -f32::from_bits(values[number]),
        }
    }
}

/// The scalars of varyings at uniform shifts.
pub(super) struct Shifted<'a> {
    scalars: &'a HashMap<Value, usize>,
    uniform: &'a Finder<'a>,
    sums: HashMap<Value, (Binary, [Value; 2])>,
}

impl<'a> Shifted<'a> {
    pub(super) fn new(
        tree: &Tree,
        scalars: &'a HashMap<Value, usize>,
        uniform: &'a Finder<'a>,
    ) -> Self {
        let sum = |node: &Node| match node {
            Node::Op {
                op: Op::Binary(kind @ (Binary::FAdd | Binary::FSub), operands),
                first,
            } => Some((*first, (*kind, *operands))),
            _ => None,
        };
        Self {
            scalars,
            uniform,
            sums: tree.body.iter().filter_map(sum).collect(),
        }
    }

    /// The scalar that a coordinate is, and its shift.
    pub(super) fn of(&self, coordinate: Value) -> Option<(usize, Shift<Value>)> {
        if let Some(scalar) = self.scalars.get(&coordinate) {
            return Some((*scalar, Shift::Zero));
        }
        let (kind, [a, b]) = *self.sums.get(&coordinate)?;
        let scalar = |value: Value| self.scalars.get(&value).copied();
        match (kind, scalar(a), scalar(b)) {
            (Binary::FAdd, Some(scalar), _) if self.uniform.is_uniform(b) => {
                Some((scalar, Shift::Plus(b)))
            }
            (Binary::FSub, Some(scalar), _) if self.uniform.is_uniform(b) => {
                Some((scalar, Shift::Minus(b)))
            }
            (Binary::FAdd, _, Some(scalar)) if self.uniform.is_uniform(a) => {
                Some((scalar, Shift::Plus(a)))
            }
            _ => None,
        }
    }
}

/// Samples of one texture at shifts from a place.
#[derive(Debug)]
pub(super) struct Filter {
    pub(super) place: Place,
    /// The positions in the interface of the texture and the sampler.
    pub(super) texture: [u32; 2],
    /// Of each tap.
    pub(super) shifts: Vec<[Shift<usize>; 2]>,
    /// True if the last channel of a tap is read.
    pub(super) reads_alpha: bool,
}

impl Filter {
    /// Samples packets of `stride` scalars; the texels of a packet are those of its taps. `known`
    /// are the shifts of some batch before, most often of the same.
    pub(super) fn sample(
        &self,
        (textures, values): (&BoundTextures<'_>, &[u32]),
        known: &mut TapShifts,
        (scalars, stride): (&[Packet<f32>], usize),
        texels: &mut [[Packet<f32>; CHANNELS]],
    ) {
        let each = self.shifts.len();
        let [texture, sampler] = self.texture;
        let Some(texture) = textures.sampled(texture, sampler) else {
            texels.fill([Packet::default(); CHANNELS]);
            return;
        };
        let mut amounts = [[0.0; 2]; MOST_TAPS];
        for (to, shifts) in amounts.iter_mut().zip(&self.shifts) {
            *to = shifts.map(|shift| shift.amount(values));
        }
        let amounts = &amounts[..each.min(MOST_TAPS)];
        if !known.are(amounts) {
            *known = TapShifts::new(amounts);
        }
        if let Some((places, lod)) = self.place.flat(scalars, stride)
            && texture.sample_shifted(lod, &places, (known, self.reads_alpha), texels)
        {
            return;
        }
        let packets = scalars.chunks(stride.max(1) * TOGETHER);
        for (scalars, texels) in packets.zip(texels.chunks_mut(TOGETHER * each)) {
            for (tap, amount) in amounts.iter().enumerate() {
                let mut at = [[Packet::default(); 2]; TOGETHER];
                let mut count = 0;
                for (at, scalars) in at.iter_mut().zip(scalars.chunks_exact(stride.max(1))) {
                    let mut asked = PacketRequest::ZEROS;
                    self.place.ask(scalars, &mut asked);
                    *at = shifted([asked.at[0], asked.at[1]], *amount);
                    count += 1;
                }
                let mut requests = [PacketRequest::ZEROS; TOGETHER];
                for (asked, (scalars, [u, v])) in requests
                    .iter_mut()
                    .zip(scalars.chunks_exact(stride.max(1)).zip(&at))
                {
                    self.place.ask(scalars, asked);
                    (asked.at[0], asked.at[1]) = (u, v);
                }
                let Some(texels) = texels.get_mut(tap..) else {
                    break;
                };
                texture.sample_requests(&requests[..count], texels, each);
            }
        }
    }
}
