//! Several accesses to textures in the same lanes, and what they have in common.

use super::TextureAccess;
use crate::op::{LevelOfDetail, TextureOp, TextureQuery};
use estampe_simd::{Level, Packet};

/// What several accesses have in common, so that they can be done together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Common {
    /// Nothing that is known.
    Nothing,
    /// All sample two coordinates, the same ones, with the level of detail of the quad or all with
    /// the same gradients: they have the same operands, which are there once.
    Coordinates,
    /// All compare texels of one texture with the same depth, at two coordinates each.
    Reference,
    /// All load texels at the same two coordinates, in the same level of one sample each: they have
    /// the same operands, which are there once.
    Texels,
    /// All sample one texture with one sampler, at two coordinates each, in the finest level or all
    /// with the level of detail of the quad.
    Texture,
}

impl Common {
    /// What these accesses have in common.
    #[must_use]
    pub fn of(ops: &[TextureOp]) -> Self {
        let Some((first, others)) = ops.split_first() else {
            return Self::Nothing;
        };
        let is_flat =
            |op: &TextureOp| op.coordinates.len() == 2 && op.layer.is_none() && op.offset == [0; 3];
        let is_plain = |op: &TextureOp| {
            let (implicit, gradient) = (LevelOfDetail::Implicit, is_gradient(&op.level));
            op.query == TextureQuery::Sample && (op.level == implicit || gradient) && is_flat(op)
        };
        let is_same =
            |op: &TextureOp| op.coordinates == first.coordinates && op.level == first.level;
        let compares = |op: &TextureOp| {
            let is_given = matches!(
                op.level,
                LevelOfDetail::Bias(_) | LevelOfDetail::Explicit(_)
            );
            op.query == TextureQuery::SampleCompare && !is_given && is_flat(op)
        };
        let loads =
            |op: &TextureOp| op.query == TextureQuery::Load && op.sample.is_none() && is_flat(op);
        let samples = |op: &TextureOp| {
            op.query == TextureQuery::Sample
                && matches!(op.level, LevelOfDetail::Zero | LevelOfDetail::Implicit)
                && is_flat(op)
        };
        let is_like = |op: &TextureOp| {
            [op.texture, op.sampler.unwrap_or(u32::MAX)]
                == [first.texture, first.sampler.unwrap_or(u32::MAX)]
                && op.reference == first.reference
        };
        if ops.iter().all(is_plain) && others.iter().all(is_same) {
            Self::Coordinates
        } else if ops.iter().all(loads) && others.iter().all(is_same) {
            Self::Texels
        } else if ops.iter().all(compares) && others.iter().all(is_like) {
            Self::Reference
        } else if ops.iter().all(samples)
            && others
                .iter()
                .all(|op| is_like(op) && op.level == first.level)
        {
            Self::Texture
        } else {
            Self::Nothing
        }
    }
}

impl Common {
    /// True if all have the same operands, which are there once.
    #[inline]
    #[must_use]
    pub fn shares_operands(self) -> bool {
        matches!(self, Self::Coordinates | Self::Texels)
    }
}

fn is_gradient(level: &LevelOfDetail) -> bool {
    matches!(level, LevelOfDetail::Gradient { .. })
}

impl<'a> TextureAccess<'a> {
    /// The access to a single packet as the only one of several; `None` of more packets.
    #[must_use]
    pub fn as_several(&mut self) -> Option<TextureAccesses<'_>> {
        let ops = std::slice::from_ref(self.op);
        Some(TextureAccesses {
            ops,
            common: Common::of(ops),
            level: self.level,
            mask: self.mask.first_chunk().filter(|_| self.packets == 1)?,
            operands: self.operands,
            results: self.results,
        })
    }
}

/// Several accesses to textures in the same lanes of one packet.
#[derive(Debug)]
pub struct TextureAccesses<'a> {
    /// What they are, in order, without those that were taken.
    pub ops: &'a [TextureOp],
    /// What all of them have in common.
    pub common: Common,
    level: Level,
    mask: &'a [u16; 1],
    /// The operands of each, as a [`TextureAccess`] has them, one after the other; those of the
    /// first alone if they are the same ones.
    operands: &'a [Packet<u32>],
    results: &'a mut [Packet<u32>],
}

impl<'a> TextureAccesses<'a> {
    /// Accesses in the lanes of a mask; operands and results are those of each
    /// [`TextureAccess`], one after the other; the operands of the first alone if all
    /// [share](Common::shares_operands) them.
    #[must_use]
    pub fn new(
        (ops, common): (&'a [TextureOp], Common),
        (level, mask): (Level, &'a [u16; 1]),
        operands: &'a [Packet<u32>],
        results: &'a mut [Packet<u32>],
    ) -> Self {
        Self {
            ops,
            common,
            level,
            mask,
            operands,
            results,
        }
    }

    /// Takes the next access.
    #[expect(
        clippy::should_implement_trait,
        reason = "an access borrows what an item could not"
    )]
    pub fn next(&mut self) -> Option<TextureAccess<'a>> {
        let (op, ops) = self.ops.split_first()?;
        self.ops = ops;
        let (operands, others) = self.operands.split_at_checked(op.words())?;
        if !self.common.shares_operands() {
            self.operands = others;
        }
        let results = std::mem::take(&mut self.results);
        let (results, others) = results.split_at_mut_checked(op.query.results() as usize)?;
        self.results = others;
        let context = (self.level, &self.mask[..]);
        Some(TextureAccess::new(op, context, operands, results))
    }

    /// The lanes that run.
    #[inline]
    #[must_use]
    pub fn mask(&self) -> u16 {
        self.mask[0]
    }

    /// The SIMD level of the run.
    #[inline]
    #[must_use]
    pub fn level(&self) -> Level {
        self.level
    }

    /// All operands, and all results to set.
    #[inline]
    pub fn all(&mut self) -> (&'a [Packet<u32>], &mut [Packet<u32>]) {
        (self.operands, self.results)
    }
}
