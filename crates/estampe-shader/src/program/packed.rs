//! A compute stage for textures whose texels are packed: one word each, in rows.
//!
//! Its kernel loads and stores texels as words of buffers, in place of calls. Another one is needed
//! where some texture is of another kind, so both are made, and the bindings choose.

use super::stage::Stage;
use super::textures::BoundTextures;
use estampe_ir::interface::TextureSlot;
use estampe_ir::interpreter::Buffer;
use estampe_ir::tree::Tree;
use estampe_ir::tree::passes::{
    PackedTexture, access_packed, dead_code, loop_invariants, packed_textures,
};
use estampe_texture::stored_unorm8_words;
use estampe_types::Bindings;

/// The stage, and the textures that must be packed.
#[derive(Debug)]
pub(super) struct PackedStage {
    stage: Stage,
    textures: Vec<(PackedTexture, TextureSlot)>,
    /// The buffers of the interface before those of textures.
    buffers: usize,
}

/// The buffers and textures of a dispatch.
#[derive(Debug)]
pub(super) struct PackedBindings<'a> {
    buffers: Vec<Buffer<'a>>,
    /// The texture of each, and its sides.
    sides: Vec<(u32, [u32; 2])>,
}

impl PackedStage {
    /// `None` if no texels are accessed in a way for which this counts.
    pub(super) fn new(tree: &Tree, budget: u64) -> Option<Self> {
        let textures = packed_textures(tree);
        if textures.is_empty() {
            return None;
        }
        let mut packed = tree.clone();
        access_packed(&mut packed, &textures);
        loop_invariants(&mut packed);
        dead_code(&mut packed);
        let slot = |of: PackedTexture| {
            let slot = tree.interface.textures.get(of.texture as usize)?;
            Some((of, *slot))
        };
        Some(Self {
            stage: Stage::new(&packed, budget),
            textures: textures.into_iter().filter_map(slot).collect(),
            buffers: tree.interface.buffers.len(),
        })
    }

    pub(super) fn stage(&self) -> &Stage {
        &self.stage
    }

    /// What a dispatch binds; `None` if some texture is not packed.
    pub(super) fn bind<'a>(
        &self,
        bindings: &'a Bindings,
        textures: &BoundTextures<'a>,
    ) -> Option<PackedBindings<'a>> {
        let mut buffers = self.stage.buffers(bindings).all().to_vec();
        buffers.truncate(self.buffers);
        let mut sides = Vec::with_capacity(self.textures.len());
        for &(PackedTexture { texture, is_stored }, slot) in &self.textures {
            let (buffer, of_texture) = if is_stored {
                let stored = bindings.storage_texture(slot.group, slot.binding)?;
                let (words, sides) = stored_unorm8_words(stored)?;
                (Buffer::shared(words, words.len().saturating_mul(4)), sides)
            } else {
                let (words, sides) = textures.loaded(texture)?.unorm8_words()?;
                (Buffer::read_only(words, size_of_val(words)), sides)
            };
            buffers.push(buffer);
            sides.push((texture, of_texture));
        }
        Some(PackedBindings { buffers, sides })
    }
}

impl<'a> PackedBindings<'a> {
    /// The buffers, in the order of the interface.
    pub(super) fn buffers(&self) -> &[Buffer<'a>] {
        &self.buffers
    }

    /// The width or height of a texture; 0 if it is none of those that are packed.
    pub(super) fn side(&self, texture: u32, axis: u32) -> u32 {
        let mut sides = self.sides.iter();
        let found = sides.find(|(of, _)| *of == texture);
        let side = found.and_then(|(_, sides)| sides.get(axis as usize));
        side.copied().unwrap_or_default()
    }
}
