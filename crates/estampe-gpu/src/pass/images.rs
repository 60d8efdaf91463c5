//! The images of a pass: taken out of their textures before it, resolved and put back after it.

use super::attachments::{Attachments, Use, is_discarded, load_of};
use super::{DepthStencilAttachment, PassErrorKind, StoreOp};
use crate::Context;
use crate::texture::{Image, Needs, Newest};
use estampe_core::{DepthStencilTexels, LoadOp, RenderTarget};

/// The images of a pass, and where the newest texels of each are.
#[derive(Debug)]
pub(super) struct Taken {
    colors: Vec<(Image, Newest)>,
    /// The images that colour attachments are resolved into, with the attachments' numbers.
    resolves: Vec<(usize, (Image, Newest))>,
    depth_stencil: Option<(Image, Newest)>,
}

impl Attachments<'_> {
    /// Takes the images out of their textures; none if memory is short for one of them.
    pub(super) fn take(&self, context: &Context) -> Result<Taken, PassErrorKind> {
        let mut taken = Taken {
            colors: Vec::with_capacity(self.colors.len()),
            resolves: Vec::new(),
            depth_stencil: None,
        };
        for color in &self.colors {
            let needs = match (color.attachment.load, color.attachment.store) {
                (LoadOp::Load, _) => Needs::Texels,
                (LoadOp::Clear(_), StoreOp::Store) => Needs::Memory,
                (LoadOp::Clear(_), StoreOp::Discard) => Needs::Nothing,
            };
            match take(context, &color.image, needs) {
                Ok(image) => taken.colors.push(image),
                Err(error) => return Err(self.put_back(taken, error)),
            }
        }
        for (number, color) in self.colors.iter().enumerate() {
            let Some(resolve) = &color.resolve else {
                continue;
            };
            match take(context, resolve, Needs::Memory) {
                Ok(image) => taken.resolves.push((number, image)),
                Err(error) => return Err(self.put_back(taken, error)),
            }
        }
        if let Some((image, attachment)) = &self.depth_stencil {
            let format = image.view.format();
            let keeps_depth = load_of(attachment.depth) == LoadOp::Load;
            let keeps_stencil = load_of(attachment.stencil) == LoadOp::Load;
            let keeps = format.has_depth() && keeps_depth || format.has_stencil() && keeps_stencil;
            let needs = match (keeps, self.discards().depth_stencil) {
                (true, _) => Needs::Texels,
                (false, false) => Needs::Memory,
                (false, true) => Needs::Nothing,
            };
            match take(context, image, needs) {
                Ok(image) => taken.depth_stencil = Some(image),
                Err(error) => return Err(self.put_back(taken, error)),
            }
        }
        Ok(taken)
    }

    /// Puts images back as they were taken.
    pub(super) fn put_back(&self, taken: Taken, error: PassErrorKind) -> PassErrorKind {
        for (color, image) in self.colors.iter().zip(taken.colors) {
            let mut contents = color.image.view.texture().lock();
            contents.put_unchanged(color.image.key, image);
        }
        for (number, image) in taken.resolves {
            if let Some(resolve) = &self.colors[number].resolve {
                let mut contents = resolve.view.texture().lock();
                contents.put_unchanged(resolve.key, image);
            }
        }
        if let (Some((image, _)), Some(texels)) = (&self.depth_stencil, taken.depth_stencil) {
            let mut contents = image.view.texture().lock();
            contents.put_unchanged(image.key, texels);
        }
        error
    }

    /// The images as the core draws into them, and where the newest texels of depth and stencil
    /// are.
    pub(super) fn target(&self, taken: Taken) -> (RenderTarget, Option<Newest>) {
        let colors = self.colors.iter().zip(taken.colors);
        let colors = colors.map(|(color, (image, _))| match image {
            Image::Color(image) => image.with_format(color.image.view.format()),
            Image::DepthStencil(_) => unreachable!("a colour format"),
        });
        let (depth_stencil, newest) = match taken.depth_stencil {
            Some((Image::DepthStencil(image), newest)) => (Some(image), Some(newest)),
            Some((Image::Color(_), _)) => unreachable!("a depth format"),
            None => (None, None),
        };
        let mut target = RenderTarget::of_images(self.size, colors.collect(), depth_stencil);
        for (number, (image, _)) in taken.resolves {
            let format = self.colors[number].image.view.format();
            match image {
                Image::Color(into) => target.resolve_into(number, into.with_format(format)),
                Image::DepthStencil(_) => unreachable!("a colour format"),
            }
        }
        (target, newest)
    }

    /// Has the core store rows of the colours that shaders sampled before; returns the attachments
    /// of which it may leave the tiles as they are, a bit for each.
    ///
    /// An image that is sampled after each pass is then neither written in tiles nor converted.
    pub(super) fn store_rows(&self, target: &mut RenderTarget) -> u8 {
        let mut without_tiles = 0;
        if self.size.samples > 1 {
            return without_tiles;
        }
        for (number, color) in self.colors.iter().enumerate() {
            let mut contents = color.image.view.texture().lock();
            if color.attachment.store == StoreOp::Store
                && let Some((texels, range)) = contents.take_rows(color.image.key)
            {
                target.store_rows(number, texels, range);
                without_tiles |= u8::from(!contents.is_loaded(color.image.key)) << number;
            }
        }
        without_tiles
    }

    /// Resolves the images, and puts them back into their textures.
    pub(super) fn finish(
        &self,
        context: &Context,
        mut target: RenderTarget,
        depth_newest: Option<Newest>,
    ) -> Result<(), PassErrorKind> {
        let mut has_rows = 0;
        for rows in target.take_rows() {
            let mut contents = self.colors[rows.color].image.view.texture().lock();
            contents.put_rows(rows.texels);
            has_rows |= u8::from(rows.is_done) << rows.color;
        }
        let resolves = target.take_resolves();
        let (colors, depth_stencil) = target.into_images();
        let mut result = Ok(());
        for mut resolved in resolves {
            if !resolved.is_done {
                context.resolve_color(&colors[resolved.color], &mut resolved.into);
            }
            if let Some(resolve) = &self.colors[resolved.color].resolve {
                let format = resolve.view.texture().format();
                let into = Image::Color(resolved.into.with_format(format));
                resolve.view.texture().lock().put(resolve.key, into);
            }
        }
        for (number, (color, image)) in self.colors.iter().zip(colors).enumerate() {
            let format = color.image.view.texture().format();
            let image = Image::Color(image.with_format(format));
            let mut contents = color.image.view.texture().lock();
            let key = color.image.key;
            match color.attachment.store {
                StoreOp::Store if has_rows >> number & 1 == 1 => {
                    let has_tiles = contents.is_loaded(key);
                    contents.put_with_rows(key, image, has_tiles);
                }
                StoreOp::Store => contents.put(key, image),
                StoreOp::Discard => contents.discard(color.image.key, image),
            }
        }
        if let (Some((image, attachment)), Some(texels)) = (&self.depth_stencil, depth_stencil) {
            if let (Some(resolve), Some(into)) = (&attachment.resolve, self.resolves.last()) {
                let format = image.view.format();
                let modes = [
                    resolve.depth.filter(|_| format.has_depth()),
                    resolve.stencil.filter(|_| format.has_stencil()),
                ];
                match take(context, into, Needs::Texels) {
                    Ok((Image::DepthStencil(mut resolved), _)) => {
                        context.resolve_depth_stencil(&texels, &mut resolved, modes);
                        let resolved = Image::DepthStencil(resolved);
                        into.view.texture().lock().put(into.key, resolved);
                    }
                    Ok((Image::Color(_), _)) => unreachable!("a depth format"),
                    Err(error) => result = Err(error),
                }
            }
            self.put_depth_stencil(context, (image, attachment), texels, depth_newest);
        }
        result
    }

    fn put_depth_stencil(
        &self,
        context: &Context,
        (image, attachment): (&Use<'_>, &DepthStencilAttachment),
        texels: DepthStencilTexels,
        newest: Option<Newest>,
    ) {
        let format = image.view.format();
        let texture = image.view.texture();
        let discards_depth = format.has_depth() && is_discarded(&attachment.depth);
        let discards_stencil = format.has_stencil() && is_discarded(&attachment.stencil);
        let keeps_depth = format.has_depth() && !discards_depth;
        let keeps_stencil = format.has_stencil() && !discards_stencil;
        if let Some(newest) = newest.filter(|_| !image.is_written) {
            let texels = Image::DepthStencil(texels);
            texture.lock().put_unchanged(image.key, (texels, newest));
        } else if !keeps_depth && !keeps_stencil {
            let texels = Image::DepthStencil(texels);
            texture.lock().discard(image.key, texels);
        } else {
            let mut texels = Some(texels);
            if discards_depth || discards_stencil {
                // One aspect alone becomes zeros.
                let mut target = RenderTarget::of_images(self.size, Vec::new(), texels);
                let cleared = context.render(
                    &mut target,
                    &estampe_core::RenderPass {
                        load_depth: if discards_depth {
                            LoadOp::Clear(0.0)
                        } else {
                            LoadOp::Load
                        },
                        load_stencil: if discards_stencil {
                            LoadOp::Clear(0)
                        } else {
                            LoadOp::Load
                        },
                        ..estampe_core::RenderPass::default()
                    },
                );
                cleared.expect("a pass without draws fits");
                texels = target.into_images().1;
            }
            if let Some(texels) = texels {
                texture.lock().put(image.key, Image::DepthStencil(texels));
            }
        }
    }
}

fn take(
    context: &Context,
    image: &Use<'_>,
    needs: Needs,
) -> Result<(Image, Newest), PassErrorKind> {
    let texture = image.view.texture();
    let taken = texture.lock().take(texture, context, image.key, needs);
    taken.map_err(|error| PassErrorKind::Texture {
        attachment: image.role.to_string(),
        error,
    })
}
