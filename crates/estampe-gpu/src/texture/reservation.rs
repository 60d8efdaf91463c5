//! Reservations: passes, dispatches and copies that use a texture now.
//!
//! What only reads a texture shares it with others that do; what changes it has it alone. What uses
//! several textures reserves them in the order of [`Texture::id`], so that nobody waits for ever.

use super::Texture;
use std::sync::{PoisonError, RwLockReadGuard, RwLockWriteGuard};

/// A texture that something uses.
#[derive(Clone, Copy)]
pub(crate) struct TextureUse<'a> {
    pub(crate) texture: &'a Texture,
    /// True if its texels may change.
    pub(crate) writes: bool,
}

/// Textures that keep others waiting until this is dropped.
pub(crate) struct Reservations<'a> {
    _held: Vec<Held<'a>>,
}

#[expect(dead_code, reason = "a guard is held, not read")]
enum Held<'a> {
    Shared(RwLockReadGuard<'a, ()>),
    Alone(RwLockWriteGuard<'a, ()>),
}

impl<'a> Reservations<'a> {
    /// Waits for all of the textures. One may be among them several times.
    pub(crate) fn new(uses: impl Iterator<Item = TextureUse<'a>>) -> Self {
        let mut uses: Vec<TextureUse<'a>> = uses.collect();
        uses.sort_by_key(|one| one.texture.id());
        uses.dedup_by(|next, one| {
            let is_same = next.texture.is_same(one.texture);
            one.writes |= is_same && next.writes;
            is_same
        });
        let held = uses.iter().map(|one| {
            if one.writes {
                Held::Alone(one.texture.reserve())
            } else {
                Held::Shared(one.texture.reserve_to_read())
            }
        });
        Self {
            _held: held.collect(),
        }
    }
}

impl Texture {
    /// Waits until no other pass or copy uses the texture, and keeps them waiting.
    pub(crate) fn reserve(&self) -> RwLockWriteGuard<'_, ()> {
        let reserved = &self.inner.reserved;
        reserved.write().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until no other pass or copy changes the texture, and keeps them waiting.
    fn reserve_to_read(&self) -> RwLockReadGuard<'_, ()> {
        let reserved = &self.inner.reserved;
        reserved.read().unwrap_or_else(PoisonError::into_inner)
    }
}
