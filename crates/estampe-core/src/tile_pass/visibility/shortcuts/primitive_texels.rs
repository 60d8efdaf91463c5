//! Texels of triangles that have one colour: where every varying is flat and nothing else varies
//! over a primitive.
//!
//! A triangle is shaded once for each tile, in one packet, and its texel is stored wherever it is
//! visible.

use crate::tile_pass::visibility::resolve::NONE;

/// The most colour targets of a pass.
const MAX_TARGETS: usize = crate::tile_pass::MAX_TARGETS;

/// The words of one texel.
pub(in crate::tile_pass::visibility) type TexelWords = [u32; 4];

/// By visible triangle, the texel of each target.
#[derive(Debug, Default)]
pub(in crate::tile_pass::visibility) struct PrimitiveTexels {
    /// By visible triangle: where its texels begin, [`NONE`] before it is shaded.
    first: Vec<u32>,
    texels: Vec<TexelWords>,
}

impl PrimitiveTexels {
    pub(in crate::tile_pass::visibility) fn clear(&mut self) {
        self.first.clear();
        self.texels.clear();
    }

    /// The texels of a triangle, if it was shaded already.
    #[inline(always)]
    pub(in crate::tile_pass::visibility) fn get(
        &self,
        triangle: usize,
        targets: usize,
    ) -> Option<&[TexelWords]> {
        let first = *self.first.get(triangle)?;
        (first != NONE).then(|| &self.texels[first as usize..][..targets])
    }

    /// Keeps the texels of a triangle.
    pub(in crate::tile_pass::visibility) fn set(
        &mut self,
        triangle: usize,
        texels: impl Iterator<Item = TexelWords>,
    ) {
        if self.first.len() <= triangle {
            self.first.resize(triangle + 1, NONE);
        }
        self.first[triangle] = u32::try_from(self.texels.len()).unwrap_or(NONE);
        self.texels.extend(texels.take(MAX_TARGETS));
    }
}
