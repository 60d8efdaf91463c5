//! Accesses to textures, which the caller of the interpreter does.

mod several;

pub use several::{Common, TextureAccesses};

use crate::op::{LevelOfDetail, TextureOp};
use estampe_simd::{Level, Packet};

/// The textures of a run.
pub trait Textures: std::fmt::Debug {
    /// Does an access: sets all results in the lanes of its mask. Lanes outside of the mask may
    /// have any numbers as operands, NaN too, and results of any value.
    fn access(&self, access: TextureAccess<'_>);

    /// Does several accesses in the same lanes of one packet.
    fn access_all(&self, mut accesses: TextureAccesses<'_>) {
        while let Some(access) = accesses.next() {
            self.access(access);
        }
    }
}

/// No textures: all results are 0.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoTextures;

impl Textures for NoTextures {
    fn access(&self, mut access: TextureAccess<'_>) {
        for at in 0..access.results() {
            access.result_mut(at).fill(Packet::default());
        }
    }
}

/// An access to a texture in many lanes. The values of `op` itself are meaningless: operands are
/// read by the methods, each of which gives `packets` packets.
#[derive(Debug)]
pub struct TextureAccess<'a> {
    /// What is asked, of which texture, with which sampler. An operand that is there has a method
    /// that gives its words.
    pub op: &'a TextureOp,
    /// The SIMD level of the run.
    pub level: Level,
    /// The number of packets.
    pub packets: usize,
    /// The lanes that run, by packet.
    pub mask: &'a [u16],
    /// The operands in the order of [`Op::each_operand`](crate::Op::each_operand), each `packets`
    /// packets.
    pub(super) operands: &'a [Packet<u32>],
    pub(super) results: &'a mut [Packet<u32>],
}

impl<'a> TextureAccess<'a> {
    /// An access in the lanes of these masks, one mask for each packet. Operands that are words
    /// stand in the order of [`Op::each_operand`](crate::Op::each_operand), each as many packets;
    /// results likewise.
    #[must_use]
    pub fn new(
        op: &'a TextureOp,
        (level, mask): (Level, &'a [u16]),
        operands: &'a [Packet<u32>],
        results: &'a mut [Packet<u32>],
    ) -> Self {
        Self {
            op,
            level,
            packets: mask.len(),
            mask,
            operands,
            results,
        }
    }

    /// A coordinate: floats where a sampler is used, else integers.
    #[inline]
    #[must_use]
    pub fn coordinate(&self, at: usize) -> &'a [Packet<u32>] {
        self.operand(at)
    }

    /// The layer, if the operation has one.
    #[inline]
    #[must_use]
    pub fn layer(&self) -> Option<&'a [Packet<u32>]> {
        let at = self.op.coordinates.len();
        self.op.layer.map(|_| self.operand(at))
    }

    /// The explicit level, or the bias, if the operation has one.
    #[inline]
    #[must_use]
    pub fn level_of_detail(&self) -> Option<&'a [Packet<u32>]> {
        match self.op.level {
            LevelOfDetail::Bias(_) | LevelOfDetail::Explicit(_) => {
                Some(self.operand(self.first_of_level()))
            }
            _ => None,
        }
    }

    /// The derivative of a coordinate along a row (axis 0) or a column (axis 1), if the operation
    /// has gradients.
    #[inline]
    #[must_use]
    pub fn gradient(&self, axis: usize, coordinate: usize) -> Option<&'a [Packet<u32>]> {
        let LevelOfDetail::Gradient { x, .. } = &self.op.level else {
            return None;
        };
        Some(self.operand(self.first_of_level() + axis * x.len() + coordinate))
    }

    /// The depth that is compared, if the operation has one.
    #[inline]
    #[must_use]
    pub fn reference(&self) -> Option<&'a [Packet<u32>]> {
        let at = self.first_of_level() + self.words_of_level();
        self.op.reference.map(|_| self.operand(at))
    }

    /// The sample, if the operation names one.
    #[inline]
    #[must_use]
    pub fn sample(&self) -> Option<&'a [Packet<u32>]> {
        let at = self.first_of_level() + self.words_of_level();
        let at = at + usize::from(self.op.reference.is_some());
        self.op.sample.map(|_| self.operand(at))
    }

    /// A word that is stored.
    #[inline]
    #[must_use]
    pub fn stored(&self, at: usize) -> &'a [Packet<u32>] {
        let before = [self.op.reference, self.op.sample];
        let before = before.into_iter().flatten().count();
        self.operand(self.first_of_level() + self.words_of_level() + before + at)
    }

    /// The number of results.
    #[inline]
    #[must_use]
    pub fn results(&self) -> usize {
        self.op.query.results() as usize
    }

    /// A result, to set it.
    #[inline]
    pub fn result_mut(&mut self, at: usize) -> &mut [Packet<u32>] {
        let (first, count) = (at * self.packets, self.packets);
        self.results
            .get_mut(first..)
            .and_then(|results| results.get_mut(..count))
            .unwrap_or_default()
    }

    /// All operands of a single packet that are words: the coordinates, the layer, what gives the
    /// level of detail, the reference, the sample, what is stored.
    #[inline]
    #[must_use]
    pub fn operands(&self) -> &'a [Packet<u32>] {
        self.operands
    }

    /// All results of a single packet.
    #[inline]
    pub fn results_mut(&mut self) -> &mut [Packet<u32>] {
        self.results
    }

    #[inline]
    fn first_of_level(&self) -> usize {
        self.op.coordinates.len() + usize::from(self.op.layer.is_some())
    }

    #[inline]
    fn words_of_level(&self) -> usize {
        match &self.op.level {
            LevelOfDetail::Zero | LevelOfDetail::Implicit => 0,
            LevelOfDetail::Bias(_) | LevelOfDetail::Explicit(_) => 1,
            LevelOfDetail::Gradient { x, y } => x.len() + y.len(),
        }
    }

    #[inline]
    fn operand(&self, at: usize) -> &'a [Packet<u32>] {
        let (first, count) = (at * self.packets, self.packets);
        self.operands
            .get(first..)
            .and_then(|operands| operands.get(..count))
            .unwrap_or_default()
    }
}

#[cfg(test)]
mod tests;
