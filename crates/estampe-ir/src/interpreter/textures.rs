//! Accesses to textures, which the caller of the interpreter does.

use crate::op::{LevelOfDetail, TextureOp, TextureQuery};
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

#[cfg(test)]
mod tests {
    use super::{Common, TextureAccesses};
    use crate::Value;
    use crate::op::{LevelOfDetail, TextureOp, TextureQuery};
    use estampe_simd::{LANES, Level, Packet};

    fn sample(texture: u32, at: [u32; 2], level: LevelOfDetail) -> TextureOp {
        TextureOp {
            query: TextureQuery::Sample,
            texture,
            sampler: Some(0),
            coordinates: at.map(Value).to_vec(),
            layer: None,
            offset: [0; 3],
            level,
            reference: None,
            sample: None,
            stored: Vec::new(),
            mask: Value(0),
        }
    }

    #[test]
    fn accesses_share_coordinates_a_reference_or_a_texture() {
        use LevelOfDetail::{Explicit, Implicit, Zero};
        let of = |ops: &[TextureOp]| Common::of(ops);
        let (here, there) = ([1, 2], [3, 4]);
        let taps = [sample(0, here, Zero), sample(0, there, Zero)];
        assert_eq!(of(&taps), Common::Texture);
        let by_quads = [sample(0, here, Implicit), sample(0, there, Implicit)];
        assert_eq!(of(&by_quads), Common::Texture);
        let maps = [sample(0, here, Implicit), sample(1, here, Implicit)];
        assert_eq!(of(&maps), Common::Coordinates);
        let levels = [sample(0, here, Zero), sample(0, there, Implicit)];
        assert_eq!(of(&levels), Common::Nothing);
        let computed = [sample(0, here, Explicit(Value(5))), sample(0, there, Zero)];
        assert_eq!(of(&computed), Common::Nothing);
        // An access alone has all in common with itself.
        assert_eq!(of(&taps[..1]), Common::Texture);
        assert_eq!(of(&maps[..1]), Common::Coordinates);
        assert_eq!(of(&computed[..1]), Common::Nothing);
        let others = [sample(0, here, Zero), sample(1, there, Zero)];
        assert_eq!(of(&others), Common::Nothing);
        let mut compared = [taps.to_vec(), levels.to_vec()].concat();
        compared[3].level = gradient(7);
        for op in &mut compared {
            op.query = TextureQuery::SampleCompare;
            op.reference = Some(Value(6));
        }
        assert_eq!(of(&compared), Common::Reference);
    }

    fn gradient(x: u32) -> LevelOfDetail {
        LevelOfDetail::Gradient {
            x: [x, 8].map(Value).to_vec(),
            y: [9, 10].map(Value).to_vec(),
        }
    }

    #[test]
    fn accesses_share_coordinates_with_their_gradients() {
        let at = |texture: u32, at: [u32; 2], x: u32| sample(texture, at, gradient(x));
        let maps = [at(0, [1, 2], 7), at(1, [1, 2], 7), at(0, [1, 2], 7)];
        assert_eq!(Common::of(&maps), Common::Coordinates);
        let by_quads = sample(1, [1, 2], LevelOfDetail::Implicit);
        for other in [
            at(1, [1, 2], 6),
            at(1, [1, 3], 7),
            at(0, [1, 3], 7),
            by_quads,
        ] {
            let ops = [maps[0].clone(), other];
            assert_eq!(Common::of(&ops), Common::Nothing, "{ops:?}");
        }
    }

    #[test]
    fn loads_share_coordinates_and_a_level() {
        let load = |texture: u32, at: [u32; 2], level: u32| TextureOp {
            query: TextureQuery::Load,
            sampler: None,
            ..sample(texture, at, LevelOfDetail::Explicit(Value(level)))
        };
        let texels = [load(0, [1, 2], 3), load(1, [1, 2], 3), load(0, [1, 2], 3)];
        assert_eq!(Common::of(&texels), Common::Texels);
        let mut of_sample = load(1, [1, 2], 3);
        of_sample.sample = Some(Value(4));
        let mut beside = load(1, [1, 2], 3);
        beside.offset[0] = 1;
        let others = [load(1, [1, 3], 3), load(1, [1, 2], 4), of_sample, beside];
        for other in others {
            let ops = [texels[0].clone(), other];
            assert_eq!(Common::of(&ops), Common::Nothing, "{ops:?}");
        }
    }

    /// Operands that are the same ones are there once, and each access has them.
    #[test]
    fn accesses_are_taken_one_after_the_other() {
        let words = |from: u32, count: usize| -> Vec<Packet<u32>> {
            (from..)
                .take(count)
                .map(|word| Packet([word; LANES]))
                .collect()
        };
        let same = [0, 1].map(|texture| sample(texture, [1, 2], gradient(7)));
        let taps = [3, 5].map(|v| sample(0, [1, v], LevelOfDetail::Zero));
        for (ops, operands) in [(same, [1..7, 1..7]), (taps, [1..3, 3..5])] {
            let common = Common::of(&ops);
            let given = words(1, 6);
            let mut results = words(0, 8);
            let context = (Level::best(), &[0xFFFF]);
            let mut all = TextureAccesses::new((&ops, common), context, &given, &mut results);
            for (number, expected) in (0_u32..).zip(operands) {
                let mut access = all.next().expect("there are two");
                let found = access.operands().iter().map(|packet| packet.0[0]);
                assert_eq!(found.collect::<Vec<_>>(), expected.collect::<Vec<_>>());
                access.result_mut(3)[0] = Packet([100 + number; LANES]);
            }
            assert!(all.next().is_none());
            assert_eq!([3, 7].map(|at: usize| results[at].0[0]), [100, 101]);
        }
    }
}
