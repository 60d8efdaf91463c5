//! Passes into several layers: the pass of each layer.

use super::{ColorAttachment, DepthStencilAttachment, PassErrorKind, RenderPass};
use crate::texture::TextureView;

/// The attachments of one layer of a pass.
#[derive(Debug)]
pub(super) struct Layer {
    colors: Vec<Option<ColorAttachment>>,
    depth_stencil: Option<DepthStencilAttachment>,
}

impl Layer {
    /// The layers of a pass; none if its attachments have one layer each.
    pub(super) fn of(pass: &RenderPass<'_>) -> Result<Vec<Self>, PassErrorKind> {
        let counts = views(pass).map(|view| view.array_layers()[1]);
        let most = counts.clone().max().unwrap_or(1);
        if most <= 1 {
            return Ok(Vec::new());
        }
        if let Some(least) = counts.min().filter(|least| *least != most) {
            return Err(PassErrorKind::Layers {
                counts: [least, most],
            });
        }
        Ok((0..most).map(|layer| Self::new(pass, layer)).collect())
    }

    fn new(pass: &RenderPass<'_>, layer: u32) -> Self {
        let color = |attachment: &Option<ColorAttachment>| {
            let attachment = attachment.as_ref()?;
            let resolve = attachment.resolve_target.as_ref();
            Some(ColorAttachment {
                view: attachment.view.layer(layer),
                resolve_target: resolve.map(|target| target.layer(layer)),
                ..attachment.clone()
            })
        };
        let mut depth_stencil = pass.depth_stencil_attachment.clone();
        if let Some(attachment) = &mut depth_stencil {
            attachment.view = attachment.view.layer(layer);
            if let Some(resolve) = &mut attachment.resolve {
                resolve.target = resolve.target.layer(layer);
            }
        }
        Self {
            colors: pass.color_attachments.iter().map(color).collect(),
            depth_stencil,
        }
    }

    /// The pass of the layer.
    pub(super) fn pass<'a>(&'a self, pass: &RenderPass<'a>) -> RenderPass<'a> {
        RenderPass {
            color_attachments: &self.colors,
            depth_stencil_attachment: self.depth_stencil.clone(),
            ..pass.clone()
        }
    }
}

/// The views of all attachments and resolve targets.
fn views<'a>(pass: &'a RenderPass<'_>) -> impl Iterator<Item = &'a TextureView> + Clone {
    let colors = pass.color_attachments.iter().flatten();
    let colors = colors.flat_map(|color| [Some(&color.view), color.resolve_target.as_ref()]);
    let depth_stencil = pass.depth_stencil_attachment.iter();
    let depth_stencil = depth_stencil.flat_map(|attachment| {
        let resolve = attachment.resolve.as_ref().map(|resolve| &resolve.target);
        [Some(&attachment.view), resolve]
    });
    colors.chain(depth_stencil).flatten()
}
