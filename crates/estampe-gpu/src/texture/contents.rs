//! The texels of a texture: rows, tiles of the images that were rendered to, and which are newest.

use super::blocks::Blocks;
use super::{Texture, TextureError, TextureView, words};
use estampe_core::{ColorTexels, Context, DepthStencilTexels, row_order_words};
use estampe_texture::MipGeneration;
use estampe_types::{Limits, Lines, ShadowMap, StorageTexture, TexelData, TextureFormat};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

/// One image of a texture: a mip level of a layer, or of a slice of a 3D texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ImageKey {
    pub(crate) level: u32,
    pub(crate) layer: u32,
}

/// An image in tiles.
#[derive(Debug)]
pub(crate) enum Image {
    Color(ColorTexels),
    DepthStencil(DepthStencilTexels),
}

/// Where the newest texels of an image are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Newest {
    Tiles,
    Rows,
    Both,
    /// Nowhere: a pass has discarded the image, which reads as zeros.
    Discarded,
}

/// The need of a pass for an image that it takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Needs {
    /// The texels as they are.
    Texels,
    /// The memory alone, whatever it holds.
    Memory,
    /// Nothing: the image is cleared first and discarded last.
    Nothing,
}

/// A mip level in atomic words.
#[derive(Debug)]
struct StoredLevel {
    words: StorageTexture,
    state: WordsState,
}

/// How the words of a level stand to its rows and tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum WordsState {
    /// Rows or tiles are newer.
    OutOfDate,
    /// The rows are the same; tiles may be.
    AsRows,
    /// Shaders have stored to the words since: rows and tiles are out of date.
    Newest,
}

/// The texels of a texture; zeros where neither rows nor tiles have been needed yet, of compressed
/// formats blocks of zero bytes.
#[derive(Debug, Default)]
pub(crate) struct Contents {
    /// All levels and layers in the order in which shaders sample them.
    rows: Option<Arc<TexelData>>,
    /// Images in the order in which passes render to them.
    images: BTreeMap<ImageKey, (Image, Newest)>,
    /// Mip levels as shaders store to them, all layers or slices of a level together.
    stored: BTreeMap<u32, StoredLevel>,
    /// The blocks of compressed images.
    pub(super) blocks: Blocks,
    /// The images that a pass has loaded, so that tiles of them are kept up to date.
    loaded: BTreeSet<ImageKey>,
    /// True if the host wrote rows since their opacity was found out.
    is_written: bool,
}

impl Contents {
    /// The texels of all levels and layers, as they are now.
    pub(crate) fn rows(
        &mut self,
        texture: &Texture,
        context: &Context,
    ) -> Result<Arc<TexelData>, TextureError> {
        self.update_rows(texture, context)?;
        let rows = self.rows.as_mut().expect("the rows were made");
        if std::mem::take(&mut self.is_written) {
            let is_opaque = rows.stored_format() == TextureFormat::Rgba8Unorm
                && words::are_opaque(context, &rows.texels);
            if is_opaque != rows.is_opaque {
                Arc::make_mut(rows).is_opaque = is_opaque;
            }
        }
        Ok(Arc::clone(rows))
    }

    /// Replaces all texels.
    pub(super) fn set_rows(&mut self, data: TexelData) {
        self.rows = Some(Arc::new(data));
        self.images.clear();
        self.stored.clear();
        self.is_written = false;
    }

    /// The level of a view as shaders store to it: without a copy if that is what was last done
    /// with it, else in memory that is kept. After stores, [`Contents::put_stored`] must be called.
    pub(super) fn stored_level(
        &mut self,
        context: &Context,
        view: &TextureView,
        create: impl Fn(&TextureView) -> Result<StorageTexture, TextureError>,
    ) -> Result<StorageTexture, TextureError> {
        let level = view.mip_levels()[0];
        let is_of_view = |words: &StorageTexture| words.format() == view.format();
        if let Some(stored) = self.stored.get(&level)
            && stored.state != WordsState::OutOfDate
            && is_of_view(&stored.words)
        {
            return Ok(stored.words.clone());
        }
        self.update_rows(view.texture(), context)?;
        let kept = self.stored.remove(&level).map(|stored| stored.words);
        let rows = self.rows.as_ref().expect("the rows were made");
        let first = words_of(rows, ImageKey { level, layer: 0 }).start;
        let mut words = match kept.filter(is_of_view) {
            Some(words) => words,
            None => create(view)?,
        };
        let from = &rows.texels[first..][..words.len()];
        if !words::fill(context, &mut words, from) {
            // A shader has kept a clone of the words for itself.
            words = create(view)?;
            let is_filled = words::fill(context, &mut words, from);
            debug_assert!(is_filled, "it was just made");
        }
        let state = WordsState::AsRows;
        let clone = words.clone();
        self.stored.insert(level, StoredLevel { words, state });
        Ok(clone)
    }

    /// Says that shaders have stored to a level: rows and tiles of it are out of date.
    pub(super) fn put_stored(&mut self, level: u32) {
        if let Some(stored) = self.stored.get_mut(&level) {
            stored.state = WordsState::Newest;
        }
        for (key, (_, newest)) in &mut self.images {
            if key.level == level {
                *newest = Newest::Rows;
            }
        }
    }

    /// Says that rows or tiles of a level change: its words are out of date.
    fn outdate_words(&mut self, level: u32) {
        if let Some(stored) = self.stored.get_mut(&level) {
            debug_assert_ne!(stored.state, WordsState::Newest, "the rows are up to date");
            stored.state = WordsState::OutOfDate;
        }
    }

    /// Brings the rows, which must have been made, up to date with the words.
    fn update_rows_from_words(&mut self, context: &Context) {
        let stored = self.stored.iter_mut();
        let newest = stored.filter(|(_, stored)| stored.state == WordsState::Newest);
        for (&level, stored) in newest {
            let data = Arc::make_mut(self.rows.as_mut().expect("the rows were made"));
            let first = words_of(data, ImageKey { level, layer: 0 }).start;
            let mut texels = data.take_texels();
            let rows = &mut Arc::make_mut(&mut texels)[first..][..stored.words.len()];
            words::copy(context, &mut stored.words, rows);
            data.texels = texels;
            stored.state = WordsState::AsRows;
            self.is_written = true;
        }
    }

    /// Lets `write` change the rows of some images; the tiles of these are out of date afterwards.
    pub(crate) fn write_rows<T>(
        &mut self,
        texture: &Texture,
        context: &Context,
        images: impl Iterator<Item = ImageKey>,
        write: impl FnOnce(&TexelData, &mut [u32]) -> T,
    ) -> Result<T, TextureError> {
        self.update_rows(texture, context)?;
        for key in images {
            if let Some((_, newest)) = self.images.get_mut(&key) {
                *newest = Newest::Rows;
            }
            self.outdate_words(key.level);
        }
        self.is_written = true;
        let data = Arc::make_mut(self.rows.as_mut().expect("the rows were made"));
        let mut texels = data.take_texels();
        let result = write(data, &mut Arc::make_mut(&mut texels)[..]);
        data.texels = texels;
        Ok(result)
    }

    /// Makes the rows, and brings them up to date with words and tiles.
    fn update_rows(&mut self, texture: &Texture, context: &Context) -> Result<(), TextureError> {
        if self.rows.is_none() {
            let limits = Limits::default();
            let data = texture
                .descriptor()
                .create(&[], MipGeneration::None, &limits)?;
            self.rows = Some(Arc::new(data));
        }
        self.update_rows_from_words(context);
        let images = self.images.iter_mut();
        let mut newer = images
            .filter(|(_, (_, newest))| matches!(newest, Newest::Tiles | Newest::Discarded))
            .peekable();
        if newer.peek().is_none() {
            return Ok(());
        }
        let data = Arc::make_mut(self.rows.as_mut().expect("just made"));
        data.is_opaque = false;
        let mut texels = data.take_texels();
        let words = &mut Arc::make_mut(&mut texels)[..];
        for (key, (image, newest)) in newer {
            let rows = &mut words[words_of(data, *key)];
            if *newest == Newest::Discarded {
                rows.fill(0);
                *newest = Newest::Rows;
                continue;
            }
            match image {
                Image::Color(image) => context.color_to_rows(image, rows),
                Image::DepthStencil(image) => context.depth_stencil_to_rows(image, rows),
            }
            *newest = Newest::Both;
        }
        data.texels = texels;
        Ok(())
    }

    /// Takes an image out in tiles, for a pass that renders to it, and says where its newest texels
    /// are.
    pub(crate) fn take(
        &mut self,
        texture: &Texture,
        context: &Context,
        key: ImageKey,
        needs: Needs,
    ) -> Result<(Image, Newest), TextureError> {
        let keeps = needs == Needs::Texels;
        if keeps {
            self.loaded.insert(key);
        }
        let stored = self.stored.get(&key.level);
        if stored.is_some_and(|stored| stored.state == WordsState::Newest) {
            self.update_rows(texture, context)?;
        }
        let (mut image, mut newest) = match self.images.remove(&key) {
            Some((_, Newest::Discarded)) if keeps => {
                if self.rows.is_some() {
                    let image = without_memory(texture, key);
                    self.images.insert(key, (image, Newest::Discarded));
                    self.update_rows(texture, context)?;
                    self.images.remove(&key);
                }
                (without_memory(texture, key), Newest::Rows)
            }
            Some(stored) => stored,
            None => (without_memory(texture, key), Newest::Rows),
        };
        if needs != Needs::Nothing && !image.has_memory() {
            match zeros(texture, key) {
                Ok(zeros) => image = zeros,
                Err(error) => {
                    self.put_unchanged(key, (image, newest));
                    return Err(error);
                }
            }
        }
        if keeps && newest == Newest::Rows {
            newest = Newest::Tiles;
            if let Some(data) = &self.rows {
                newest = Newest::Both;
                let rows = &data.texels[words_of(data, key)];
                match &mut image {
                    Image::Color(image) => context.rows_to_color(rows, image),
                    Image::DepthStencil(image) => context.rows_to_depth_stencil(rows, image),
                }
            }
        }
        Ok((image, newest))
    }

    /// Puts an image back that a pass has changed.
    pub(crate) fn put(&mut self, key: ImageKey, image: Image) {
        self.outdate_words(key.level);
        self.images.insert(key, (image, Newest::Tiles));
    }

    /// Takes the words of all rows out, and says which are those of an image, for a pass that
    /// stores the image's rows while it draws. `None` if nothing has read rows yet, so that they
    /// may never be needed, or if somebody reads them now. [`Contents::put_rows`] must be called
    /// afterwards.
    pub(crate) fn take_rows(&mut self, key: ImageKey) -> Option<(Arc<Lines<u32>>, Range<usize>)> {
        let data = Arc::get_mut(self.rows.as_mut()?)?;
        let range = words_of(data, key);
        Arc::get_mut(&mut data.texels)?.get(range.clone())?;
        data.is_opaque = false;
        Some((data.take_texels(), range))
    }

    /// Puts the words of all rows back.
    pub(crate) fn put_rows(&mut self, texels: Arc<Lines<u32>>) {
        let data = self.rows.as_mut().and_then(Arc::get_mut);
        data.expect("nobody reads rows that were taken").texels = texels;
    }

    /// True if a pass has loaded an image: the next one may do so again.
    pub(crate) fn is_loaded(&self, key: ImageKey) -> bool {
        self.loaded.contains(&key)
    }

    /// Puts an image back of which a pass has stored the rows; without `has_tiles` the tiles are
    /// out of date.
    pub(crate) fn put_with_rows(&mut self, key: ImageKey, image: Image, has_tiles: bool) {
        self.outdate_words(key.level);
        let newest = if has_tiles {
            Newest::Both
        } else {
            Newest::Rows
        };
        self.images.insert(key, (image, newest));
    }

    /// Puts an image back that is as it was taken.
    pub(crate) fn put_unchanged(&mut self, key: ImageKey, (image, newest): (Image, Newest)) {
        self.images.insert(key, (image, newest));
    }

    /// Puts an image back whose texels are not kept: they read as zeros.
    pub(crate) fn discard(&mut self, key: ImageKey, image: Image) {
        self.outdate_words(key.level);
        self.images.insert(key, (image, Newest::Discarded));
    }

    /// The image in tiles if these are up to date, so that it can be read without a conversion.
    pub(crate) fn tiles(&self, key: ImageKey) -> Option<&Image> {
        let (image, newest) = self.images.get(&key)?;
        matches!(newest, Newest::Tiles | Newest::Both).then_some(image)
    }

    /// The image in tiles if only these are up to date. Where rows are too, float depths in them
    /// may be others: a pass clamps them.
    pub(crate) fn newest_tiles(&self, key: ImageKey) -> Option<&Image> {
        let (image, newest) = self.images.get(&key)?;
        (*newest == Newest::Tiles).then_some(image)
    }

    /// The depths of an image of one sample for comparisons, in the attachment's own memory.
    pub(crate) fn shadow_map(
        &mut self,
        texture: &Texture,
        context: &Context,
        key: ImageKey,
    ) -> Result<Option<ShadowMap>, TextureError> {
        let (mut image, newest) = self.take(texture, context, key, Needs::Texels)?;
        let map = match &mut image {
            Image::DepthStencil(depth) => context.shadow_map_of(depth),
            Image::Color(_) => None,
        };
        self.put_unchanged(key, (image, newest));
        Ok(map)
    }
}

impl Image {
    fn has_memory(&self) -> bool {
        match self {
            Self::Color(image) => image.has_memory(),
            Self::DepthStencil(image) => image.has_memory(),
        }
    }
}

fn without_memory(texture: &Texture, key: ImageKey) -> Image {
    let (format, size) = (texture.format(), texture.image_size(key.level));
    if format.is_color() {
        Image::Color(ColorTexels::without_memory(format, size))
    } else {
        Image::DepthStencil(DepthStencilTexels::without_memory(format, size))
    }
}

fn zeros(texture: &Texture, key: ImageKey) -> Result<Image, TextureError> {
    let (format, size) = (texture.format(), texture.image_size(key.level));
    let image = if format.is_color() {
        ColorTexels::zeros(format, size).map(Image::Color)
    } else {
        DepthStencilTexels::zeros(format, size).map(Image::DepthStencil)
    };
    image.ok_or(TextureError::OutOfMemory {
        bytes: row_order_words(format, size) as u64 * 4,
    })
}

/// The words of an image among those of all levels and layers.
pub(crate) fn words_of(data: &TexelData, key: ImageKey) -> Range<usize> {
    let level = data.levels[key.level as usize];
    let texels = level.width as usize * level.height as usize * data.shape.samples as usize;
    let first = level.offset as usize + key.layer as usize * texels;
    let words = data.words_per_texel();
    first * words..(first + texels) * words
}
