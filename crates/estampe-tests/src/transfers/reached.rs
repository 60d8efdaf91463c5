//! What random sequences reached: operations by class of format, and what was done to images by
//! where their newest texels were.

use super::on_model::Outcome;
use super::roles::{FormatClass, Newest, Role};
use super::sequence::{Draws, ImageAt, Memory, Operation, Pass, Sequence, Side};
use estampe_reference::transfer::Layout;
use estampe_types::{TextureAspect, TextureDimension};
use std::collections::{BTreeMap, BTreeSet};

/// Counts of what sequences reached.
#[derive(Debug, Default)]
pub struct Reached {
    /// What was done to images of a class of formats.
    pub classes: BTreeMap<(Role, FormatClass), u64>,
    /// What was done to images by where their newest texels were.
    pub roles: BTreeMap<(Newest, Role), u64>,
    /// The names of formats that took part in an operation.
    pub formats: BTreeSet<&'static str>,
    /// The numbers of samples of images that took part in an operation.
    pub samples: BTreeSet<u32>,
    /// Operations that were refused.
    pub refused: u64,
    /// Operations on buffers that were done.
    pub buffers: u64,
}

impl Reached {
    /// Counts the operations of a sequence, whose outcomes are those of the model.
    pub fn count(&mut self, sequence: &Sequence, outcomes: &[Outcome]) {
        let mut images = Images {
            sequence,
            newest: BTreeMap::new(),
            reached: self,
        };
        for (number, shape) in sequence.textures.iter().enumerate() {
            if shape.given.is_some() {
                images.set_texture(number, Newest::Rows);
            }
        }
        for (operation, outcome) in sequence.operations.iter().zip(outcomes) {
            if *outcome == Outcome::Refused {
                images.reached.refused += 1;
            } else {
                images.count(operation);
            }
        }
    }
}

impl Reached {
    /// The counts as text: for each role those by place of the newest texels.
    #[must_use]
    pub fn described(&self) -> String {
        let mut text = format!(
            "{} operations refused, {} on buffers",
            self.refused, self.buffers
        );
        for role in Role::ALL {
            text.push_str(&format!("\n{role:?}:"));
            for newest in Newest::ALL {
                let count = self.roles.get(&(newest, role)).copied().unwrap_or_default();
                text.push_str(&format!(" {newest:?} {count}"));
            }
        }
        text
    }
}

/// The images of a sequence while its operations are counted.
struct Images<'a> {
    sequence: &'a Sequence,
    /// Images that were never written are not in it.
    newest: BTreeMap<ImageAt, Newest>,
    reached: &'a mut Reached,
}

impl Images<'_> {
    fn count(&mut self, operation: &Operation) {
        match operation {
            Operation::WriteBuffer { .. }
            | Operation::CopyBuffer { .. }
            | Operation::ClearBuffer { .. } => self.reached.buffers += 1,
            Operation::WriteTexture { into, size, .. }
            | Operation::BufferToTexture { into, size, .. } => self.copy_into(into, *size),
            Operation::ReadTexture { from, size, memory } => {
                let images = self.region(from, *size);
                self.uses(&images, Role::Read);
                if !self.is_read_in_tiles(from, *size, memory) {
                    self.read_rows(from.texture);
                }
            }
            Operation::TextureToBuffer { from, size, .. } => {
                let images = self.region(from, *size);
                self.uses(&images, Role::CopiedFrom);
                self.read_rows(from.texture);
            }
            Operation::TextureToTexture { from, into, size } => {
                let images = self.region(from, *size);
                self.uses(&images, Role::CopiedFrom);
                self.read_rows(from.texture);
                self.copy_into(into, *size);
            }
            Operation::ClearTexture {
                texture,
                levels: [first, count],
                layers,
                ..
            } => {
                let all = self.images_of(*texture, *first..first + count);
                let dimension = self.sequence.textures[*texture].dimension;
                let is_3d = dimension == TextureDimension::D3;
                let shown = |image: &ImageAt| {
                    is_3d || (layers[0]..layers[0] + layers[1]).contains(&image.slice)
                };
                let images: Vec<ImageAt> = all.into_iter().filter(shown).collect();
                self.uses(&images, Role::Cleared);
                self.read_rows(*texture);
                self.set(&images, Newest::Rows);
            }
            Operation::GenerateMips { texture } => {
                let levels = self.sequence.textures[*texture].levels;
                let above = self.images_of(*texture, 0..levels - 1);
                let made = self.images_of(*texture, 1..levels);
                self.uses(&above, Role::MipSource);
                self.uses(&made, Role::MipMade);
                self.read_rows(*texture);
                self.set(&made, Newest::Rows);
            }
            Operation::Blit { from, into, .. } => {
                self.uses(&[from.image], Role::BlittedFrom);
                self.read_rows(from.image.texture);
                self.uses(&[into.image], Role::Loaded);
                self.set(&[into.image], Newest::Tiles);
            }
            Operation::Render(pass) => self.render(pass),
            Operation::Store { image } => {
                self.uses(&[*image], Role::Stored);
                self.read_rows(image.texture);
                // The other slices of the level are written back too.
                let images = self.images_of(image.texture, image.level..image.level + 1);
                self.set(&images, Newest::Rows);
            }
            Operation::Hold { texture } => {
                let levels = self.sequence.textures[*texture].levels;
                let images = self.images_of(*texture, 0..levels);
                self.uses(&images, Role::Held);
                self.read_rows(*texture);
            }
        }
    }

    fn render(&mut self, pass: &Pass) {
        if let Draws::Textured(draw) = &pass.draws {
            let [first, count] = draw.levels;
            let all = self.images_of(draw.texture, first..first + count);
            let shown = |image: &ImageAt| image.slice == draw.layer;
            let images: Vec<ImageAt> = all.into_iter().filter(shown).collect();
            self.uses(&images, Role::Sampled);
            self.read_rows(draw.texture);
        }
        if let Draws::Compared(draw) = &pass.draws {
            self.uses(&[draw.image], Role::Compared);
            self.read_tiles(draw.image);
        }
        let role_of = |is_cleared: bool| match is_cleared {
            true => Role::ClearedByPass,
            false => Role::Loaded,
        };
        let stored = |is_stored: bool| match is_stored {
            true => Newest::Tiles,
            false => Newest::Discarded,
        };
        for color in &pass.colors {
            self.uses(&[color.image], role_of(color.clear.is_some()));
            self.set(&[color.image], stored(color.is_stored));
            if let Some(image) = color.resolve {
                self.uses(&[image], Role::ResolvedInto);
                self.set(&[image], Newest::Tiles);
            }
        }
        let Some(depth) = &pass.depth_stencil else {
            return;
        };
        if let Some((image, _)) = depth.resolve {
            self.uses(&[image], Role::ResolvedInto);
            self.set(&[image], Newest::Tiles);
        }
        let format = self.sequence.textures[depth.image.texture].format;
        if !depth.is_written(format) {
            self.uses(&[depth.image], Role::ReadOnly);
            self.read_tiles(depth.image);
            return;
        }
        let depths = depth.depth.filter(|_| format.has_depth());
        let stencils = depth.stencil.filter(|_| format.has_stencil());
        let is_cleared = |is_there: bool, cleared: Option<bool>| !is_there || cleared == Some(true);
        let are_cleared = is_cleared(format.has_depth(), depths.map(|d| d.clear.is_some()))
            && is_cleared(format.has_stencil(), stencils.map(|s| s.clear.is_some()));
        let is_kept = |is_there: bool, stored: Option<bool>| is_there && stored != Some(false);
        let are_kept = is_kept(format.has_depth(), depths.map(|d| d.is_stored))
            || is_kept(format.has_stencil(), stencils.map(|s| s.is_stored));
        self.uses(&[depth.image], role_of(are_cleared));
        self.set(&[depth.image], stored(are_kept));
    }

    fn copy_into(&mut self, into: &Side, size: [u32; 3]) {
        let images = self.region(into, size);
        self.uses(&images, Role::CopiedInto);
        self.read_rows(into.texture);
        self.set(&images, Newest::Rows);
    }

    /// The images that a region touches.
    fn region(&self, side: &Side, [width, height, layers]: [u32; 3]) -> Vec<ImageAt> {
        let first = side.place.origin[2];
        let layers = if width > 0 && height > 0 { layers } else { 0 };
        let image = |slice| ImageAt {
            texture: side.texture,
            level: side.place.level,
            slice,
        };
        (first..first + layers).map(image).collect()
    }

    fn images_of(&self, texture: usize, levels: std::ops::Range<u32>) -> Vec<ImageAt> {
        let shape = &self.sequence.textures[texture];
        let slices = |level: u32| (0..shape.level_size(level)[2]).map(move |slice| (level, slice));
        let images = levels.flat_map(slices).map(|(level, slice)| ImageAt {
            texture,
            level,
            slice,
        });
        images.collect()
    }

    /// A whole colour image in tight memory is read without making rows.
    fn is_read_in_tiles(&self, from: &Side, size: [u32; 3], memory: &Memory) -> bool {
        let shape = &self.sequence.textures[from.texture];
        let [width, height, _] = shape.level_size(from.place.level);
        let len = (width * height * shape.format.block_bytes()) as usize;
        size == [width, height, 1]
            && memory.layout == Layout::default()
            && memory.len == len
            && from.place.aspect == TextureAspect::All
            && shape.format.is_renderable()
    }

    fn uses(&mut self, images: &[ImageAt], role: Role) {
        for image in images {
            let shape = &self.sequence.textures[image.texture];
            let class = FormatClass::of(shape.format);
            let newest = self.newest_of(*image);
            *self.reached.classes.entry((role, class)).or_default() += 1;
            *self.reached.roles.entry((newest, role)).or_default() += 1;
            self.reached.formats.insert(shape.format.name());
            self.reached.samples.insert(shape.samples);
        }
    }

    fn newest_of(&self, image: ImageAt) -> Newest {
        self.newest.get(&image).copied().unwrap_or(Newest::Zeros)
    }

    fn set(&mut self, images: &[ImageAt], newest: Newest) {
        self.newest
            .extend(images.iter().map(|image| (*image, newest)));
    }

    fn set_texture(&mut self, texture: usize, newest: Newest) {
        let images = self.images_of(texture, 0..self.sequence.textures[texture].levels);
        self.set(&images, newest);
    }

    /// The tiles of an image are brought up to date.
    fn read_tiles(&mut self, image: ImageAt) {
        if self.newest_of(image) != Newest::Tiles {
            self.set(&[image], Newest::Both);
        }
    }

    /// The rows of a texture are brought up to date.
    fn read_rows(&mut self, texture: usize) {
        for (image, newest) in &mut self.newest {
            if image.texture == texture {
                *newest = match *newest {
                    Newest::Tiles => Newest::Both,
                    Newest::Discarded => Newest::Rows,
                    other => other,
                };
            }
        }
    }
}
