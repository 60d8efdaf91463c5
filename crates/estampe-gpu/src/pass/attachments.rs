//! The attachments of a pass, and their checks.

use super::{
    AspectOperations, ColorAttachment, DepthStencilAttachment, PassErrorKind, RenderPass, StoreOp,
};
use crate::Limits;
use crate::texture::{ImageKey, Texture, TextureUsages, TextureView};
use estampe_core::{Discards, ImageSize, LoadOp, TargetShape};
use estampe_types::TextureFormat;

/// The role of an image, as messages name it.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Role {
    Color(usize),
    DepthStencil,
    ResolveOfColor(usize),
    ResolveOfDepthStencil,
}

impl std::fmt::Display for Role {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Color(index) => write!(f, "colour attachment {index}"),
            Self::DepthStencil => f.write_str("the depth-stencil attachment"),
            Self::ResolveOfColor(index) => {
                write!(f, "the resolve target of {}", Self::Color(*index))
            }
            Self::ResolveOfDepthStencil => {
                write!(f, "the resolve target of {}", Self::DepthStencil)
            }
        }
    }
}

/// One image that a pass writes or tests.
#[derive(Debug, Clone)]
pub(crate) struct Use<'a> {
    pub(crate) view: &'a TextureView,
    pub(crate) key: ImageKey,
    pub(crate) role: Role,
    /// False of depth and stencil that are read-only.
    pub(super) is_written: bool,
}

/// The checked attachments of a pass.
#[derive(Debug)]
pub(crate) struct Attachments<'a> {
    pub(crate) size: ImageSize,
    /// By the number of the shader's colour; no holes at the end.
    pub(crate) formats: Vec<Option<TextureFormat>>,
    pub(crate) colors: Vec<Color<'a>>,
    pub(crate) depth_stencil: Option<(Use<'a>, &'a DepthStencilAttachment)>,
    pub(super) resolves: Vec<Use<'a>>,
}

#[derive(Debug)]
pub(crate) struct Color<'a> {
    pub(crate) image: Use<'a>,
    pub(super) attachment: &'a ColorAttachment,
    pub(super) resolve: Option<Use<'a>>,
}

impl<'a> Attachments<'a> {
    pub(super) fn check(pass: &'a RenderPass<'_>, limits: &Limits) -> Result<Self, PassErrorKind> {
        let count = pass.color_attachments.len();
        if count > limits.max_color_attachments as usize {
            return Err(PassErrorKind::TooManyColors {
                count,
                limit: limits.max_color_attachments,
            });
        }
        let mut size = pass.extent.map(|extent| ImageSize {
            width: extent.width,
            height: extent.height,
            samples: extent.samples,
        });
        let mut colors = Vec::new();
        let attachments = pass.color_attachments.iter().enumerate();
        for (index, attachment) in attachments {
            let Some(attachment) = attachment else {
                continue;
            };
            let role = Role::Color(index);
            let format = attachment.view.format();
            if !format.is_renderable() {
                let rule = "colours cannot be rendered to depth, stencil and compressed formats and \
                            rgb9e5ufloat";
                return Err(bad_format(role, format, rule));
            }
            let image = image(&attachment.view, attachment.depth_slice, role)?;
            agree(&mut size, &image)?;
            let resolve = match &attachment.resolve_target {
                Some(target) => Some(resolve_of(&image, target, Role::ResolveOfColor(index))?),
                None => None,
            };
            colors.push(Color {
                image,
                attachment,
                resolve,
            });
        }
        let mut depth_resolve = None;
        let depth_stencil = match &pass.depth_stencil_attachment {
            Some(attachment) => {
                let role = Role::DepthStencil;
                let format = attachment.view.format();
                if format.is_color() {
                    let rule = "it holds neither depth nor stencil";
                    return Err(bad_format(role, format, rule));
                }
                let mut image = image(&attachment.view, None, role)?;
                image.is_written = writes_depth(attachment) || writes_stencil(attachment);
                agree(&mut size, &image)?;
                if let Some(resolve) = &attachment.resolve {
                    let role = Role::ResolveOfDepthStencil;
                    depth_resolve = Some(resolve_of(&image, &resolve.target, role)?);
                    if resolve.stencil == Some(estampe_core::ResolveMode::Average) {
                        return Err(PassErrorKind::Resolve {
                            attachment: image.role.to_string(),
                            rule: "cannot average stencil values: choose another mode",
                        });
                    }
                }
                Some((image, attachment))
            }
            None => None,
        };
        let size = size.ok_or(PassErrorKind::NoExtent)?;
        let limit = limits.max_texture_dimension_2d.min(16_384);
        let sides = 1..=limit;
        let samples = size.samples;
        if !sides.contains(&size.width)
            || !sides.contains(&size.height)
            || !matches!(samples, 1 | 2 | 4 | 8 | 16)
        {
            return Err(PassErrorKind::Extent {
                width: size.width,
                height: size.height,
                samples,
                limit,
            });
        }
        let resolves = colors.iter_mut().filter_map(|color| color.resolve.clone());
        let resolves = resolves.chain(depth_resolve).collect();
        let formats = pass.color_attachments.iter();
        let formats = formats.map(|color| Some(color.as_ref()?.view.format()));
        let made = Self {
            size,
            formats: without_last_holes(formats),
            colors,
            depth_stencil,
            resolves,
        };
        made.check_distinct()?;
        Ok(made)
    }

    /// Checks that no two uses are of the same image.
    fn check_distinct(&self) -> Result<(), PassErrorKind> {
        for (at, second) in self.uses().enumerate() {
            let is_same = |first: &&Use<'_>| {
                first.key == second.key && first.view.texture().is_same(second.view.texture())
            };
            if let Some(first) = self.uses().take(at).find(is_same) {
                return Err(PassErrorKind::UsedTwice {
                    first: first.role.to_string(),
                    second: second.role.to_string(),
                });
            }
        }
        Ok(())
    }

    /// All images that the pass writes or tests.
    pub(super) fn uses(&self) -> impl Iterator<Item = &Use<'a>> {
        let depth_stencil = self.depth_stencil.iter().map(|(image, _)| image);
        let colors = self.colors.iter().map(|color| &color.image);
        colors.chain(depth_stencil).chain(&self.resolves)
    }

    pub(super) fn textures(&self) -> impl Iterator<Item = &'a Texture> {
        self.uses().map(|image| image.view.texture())
    }

    /// Returns true if the pass declares depth, or stencil, read-only.
    pub(super) fn read_only(&self) -> [bool; 2] {
        self.depth_stencil
            .as_ref()
            .map_or([false; 2], |(_, attachment)| {
                [!writes_depth(attachment), !writes_stencil(attachment)]
            })
    }

    /// The core's load operations.
    pub(crate) fn loads(&self) -> (Vec<LoadOp<[f64; 4]>>, LoadOp<f32>, LoadOp<u8>) {
        let colors = self.colors.iter().map(|color| color.attachment.load);
        let depth_stencil = self
            .depth_stencil
            .as_ref()
            .map(|(_, attachment)| attachment);
        (
            colors.collect(),
            depth_stencil.map_or(LoadOp::Load, |attachment| load_of(attachment.depth)),
            depth_stencil.map_or(LoadOp::Load, |attachment| load_of(attachment.stencil)),
        )
    }

    /// The attachments that the pass discards at its end.
    pub(super) fn discards(&self) -> Discards {
        let colors = self.colors.iter().rev().fold(0, |bits, color| {
            bits << 1 | u8::from(color.attachment.store == StoreOp::Discard)
        });
        let depth_stencil = self
            .depth_stencil
            .as_ref()
            .is_some_and(|(image, attachment)| {
                let format = image.view.format();
                let keeps_depth = format.has_depth() && !is_discarded(&attachment.depth);
                let keeps_stencil = format.has_stencil() && !is_discarded(&attachment.stencil);
                !keeps_depth && !keeps_stencil && attachment.resolve.is_none()
            });
        Discards {
            colors,
            depth_stencil,
        }
    }

    /// The samples and formats, as pipelines must have them.
    pub(crate) fn with_shape<T>(&self, use_shape: impl FnOnce(&TargetShape<'_>) -> T) -> T {
        let formats = self.colors.iter().map(|color| color.image.view.format());
        let formats: Vec<_> = formats.collect();
        let depth_stencil = self.depth_stencil.as_ref();
        use_shape(&TargetShape {
            samples: self.size.samples,
            color_formats: &formats,
            depth_stencil: depth_stencil.map(|(image, _)| image.view.format()),
        })
    }
}

pub(super) fn is_discarded<T>(operations: &AspectOperations<T>) -> bool {
    matches!(
        operations,
        AspectOperations::Write {
            store: StoreOp::Discard,
            ..
        }
    )
}

pub(super) fn load_of<T>(operations: AspectOperations<T>) -> LoadOp<T> {
    match operations {
        AspectOperations::ReadOnly => LoadOp::Load,
        AspectOperations::Write { load, .. } => load,
    }
}

fn writes_depth(attachment: &DepthStencilAttachment) -> bool {
    let is_read_only = matches!(attachment.depth, AspectOperations::ReadOnly);
    attachment.view.format().has_depth() && !is_read_only
}

fn writes_stencil(attachment: &DepthStencilAttachment) -> bool {
    let is_read_only = matches!(attachment.stencil, AspectOperations::ReadOnly);
    attachment.view.format().has_stencil() && !is_read_only
}

/// A list of formats without the holes at its end, which mean nothing.
fn without_last_holes(
    formats: impl Iterator<Item = Option<TextureFormat>>,
) -> Vec<Option<TextureFormat>> {
    let mut formats: Vec<_> = formats.collect();
    while formats.last() == Some(&None) {
        formats.pop();
    }
    formats
}

fn bad_format(role: Role, format: TextureFormat, rule: &'static str) -> PassErrorKind {
    PassErrorKind::Format {
        attachment: role.to_string(),
        format,
        rule,
    }
}

fn image(
    view: &TextureView,
    depth_slice: Option<u32>,
    role: Role,
) -> Result<Use<'_>, PassErrorKind> {
    let Some(key) = view.image_key(depth_slice) else {
        return Err(PassErrorKind::NotAnImage {
            attachment: role.to_string(),
            levels: view.mip_levels()[1],
            layers: view.array_layers()[1],
        });
    };
    let usage = view.texture().require(TextureUsages::RENDER_ATTACHMENT);
    if let Err(error) = usage {
        return Err(PassErrorKind::Texture {
            attachment: role.to_string(),
            error,
        });
    }
    Ok(Use {
        view,
        key,
        role,
        is_written: true,
    })
}

/// The size of the pass, which all attachments have.
fn agree(size: &mut Option<ImageSize>, image: &Use<'_>) -> Result<(), PassErrorKind> {
    let actual = image.view.texture().image_size(image.key.level);
    let expected = *size.get_or_insert(actual);
    if expected == actual {
        return Ok(());
    }
    let numbers = |size: ImageSize| [size.width, size.height, size.samples];
    Err(PassErrorKind::Size {
        attachment: image.role.to_string(),
        actual: numbers(actual),
        expected: numbers(expected),
    })
}

fn resolve_of<'a>(
    from: &Use<'a>,
    target: &'a TextureView,
    role: Role,
) -> Result<Use<'a>, PassErrorKind> {
    let into = image(target, None, role)?;
    let size = |image: &Use<'_>| image.view.texture().image_size(image.key.level);
    let (source, destination) = (size(from), size(&into));
    let rule = if source.samples == 1 {
        "is not needed: the attachment has one sample"
    } else if destination.samples != 1 {
        "has several samples: it must have one"
    } else if [source.width, source.height] != [destination.width, destination.height] {
        "has another size: it must have that of the attachment"
    } else if from.view.format() != target.format() {
        "has another format: it must have that of the attachment"
    } else {
        return Ok(into);
    };
    Err(PassErrorKind::Resolve {
        attachment: from.role.to_string(),
        rule,
    })
}
