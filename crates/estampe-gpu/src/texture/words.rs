//! Copies between a texture's rows and the atomic words that shaders store to, on all threads.

use estampe_core::Context;
use estampe_types::StorageTexture;

/// Words that one thread copies at a time: 64 KiB.
const PART: usize = 16_384;

/// Replaces all words of a texture at the rate of a copy; false if a clone of the texture lives,
/// which is not changed then.
#[must_use]
pub(super) fn fill(context: &Context, words: &mut StorageTexture, from: &[u32]) -> bool {
    assert_eq!(from.len(), words.len(), "the words of the whole texture");
    let Some(own) = words.own_words() else {
        return false;
    };
    let mut parts: Vec<_> = own.chunks_mut(PART).zip(from.chunks(PART)).collect();
    context.for_each(&mut parts, |(own, from)| {
        for (to, word) in own.iter_mut().zip(*from) {
            *to.get_mut() = *word;
        }
    });
    true
}

/// Copies all words of a texture: at the rate of a copy, unless a clone of the texture lives.
pub(super) fn copy(context: &Context, words: &mut StorageTexture, into: &mut [u32]) {
    assert_eq!(into.len(), words.len(), "the words of the whole texture");
    let Some(own) = words.own_words() else {
        for (at, to) in into.iter_mut().enumerate() {
            *to = words.load(at);
        }
        return;
    };
    let mut parts: Vec<_> = own.chunks_mut(PART).zip(into.chunks_mut(PART)).collect();
    context.for_each(&mut parts, |(own, into)| {
        for (to, word) in into.iter_mut().zip(own.iter_mut()) {
            *to = *word.get_mut();
        }
    });
}

/// True if all texels of RGBA8 have an alpha of 255.
pub(super) fn are_opaque(context: &Context, texels: &[u32]) -> bool {
    let mut parts: Vec<_> = texels.chunks(PART).map(|part| (part, true)).collect();
    context.for_each(&mut parts, |(part, is_opaque)| {
        *is_opaque = part.iter().fold(u32::MAX, |all, texel| all & texel) >> 24 == 255;
    });
    parts.iter().all(|(_, is_opaque)| *is_opaque)
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::Level;
    use estampe_types::{TextureDimension, TextureFormat};

    #[test]
    fn words_are_filled_and_copied_by_any_number_of_threads() {
        // Three parts, the last of which is short.
        let size = (1024, 33);
        let texels: Vec<u32> = (0..1024 * 33).collect();
        for threads in [1, 3] {
            let context = Context::new(threads, Level::best()).unwrap();
            let format = TextureFormat::Rgba8Unorm;
            let words = StorageTexture::zeros(format, size, TextureDimension::D2, 1);
            let mut words = words.unwrap();
            assert!(fill(&context, &mut words, &texels));
            let mut copied = vec![0; texels.len()];
            copy(&context, &mut words, &mut copied);
            assert_eq!(copied, texels);
            // While a clone lives, words are read one by one and not replaced.
            let clone = words.clone();
            clone.store(5, 77);
            assert!(!fill(&context, &mut words, &texels));
            copy(&context, &mut words, &mut copied);
            assert_eq!((copied[4], copied[5], copied[6]), (4, 77, 6));
        }
    }

    #[test]
    fn one_texel_in_the_last_part_is_seen() {
        let context = Context::new(2, Level::best()).unwrap();
        let mut texels = vec![0xff00_0000; 2 * PART + 3];
        assert!(are_opaque(&context, &texels));
        *texels.last_mut().unwrap() = 0xfe00_0000;
        assert!(!are_opaque(&context, &texels));
        assert!(are_opaque(&context, &[]));
    }
}
