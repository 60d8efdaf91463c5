//! Exact transparency: layers from the farthest on.
//!
//! ```text
//!   behind = the opaque depths
//!   loop: find    the farthest fragments nearer than behind -> layer, found mark
//!         blend   the fragments at the layer's depths, where the mark is set
//!         behind = layer
//!   until nothing is found; after the greatest number of layers, all nearer fragments at once
//! ```

use crate::finding::FOUND;
use crate::{DepthOrder, Finder, Target, TransparencyError};
use estampe::state::{CompareFunction, DepthStencilState, StencilFaceState, StencilState};
use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Draw, OcclusionQueries, RenderPass,
    Statistics, Texture, TextureFormat,
};

/// The depths of a layer, and the mark of samples that have a fragment in it: a fragment may lie at
/// the near plane, so no depth can mean that there is none.
const LAYER: TextureFormat = TextureFormat::Depth32FloatStencil8;

/// The transparent draws of [`peel`], in three forms.
#[derive(Debug, Clone, Copy, Default)]
pub struct PeelDraws<'a> {
    /// With the pipelines of the [`Finder`]; bind groups are set by [`peel`].
    pub finding: &'a [Draw<'a>],
    /// The same draws with pipelines that blend and have [`layer_state`]. Draws of both forms have
    /// the same primitives in the same order. Fragments must not be discarded.
    pub blending: &'a [Draw<'a>],
    /// All draws in another order, such as from the farthest triangle on, with pipelines that
    /// blend and test [`DepthOrder::nearer`]: for fragments in front of the last layer that is
    /// peeled.
    pub rest: &'a [Draw<'a>],
}

/// The result of [`peel`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Peeled {
    /// The number of layers that were peeled.
    pub layers: u32,
    /// False if fragments were left, which are blended in the order of [`PeelDraws::rest`].
    pub is_complete: bool,
    /// Counts and times of all passes.
    pub statistics: Statistics,
}

/// The depth and stencil state of pipelines that blend a layer.
#[must_use]
pub fn layer_state() -> DepthStencilState {
    let found = StencilFaceState {
        compare: CompareFunction::Equal,
        ..StencilFaceState::default()
    };
    DepthStencilState {
        depth_write_enabled: false,
        depth_compare: CompareFunction::Equal,
        stencil: Some(StencilState::from(found)),
        ..DepthStencilState::default()
    }
}

/// Blends the fragments of each sample from the farthest on, whatever the order of the draws.
///
/// Fragments hidden by the target's depths, or at them, are left out. At most `most_layers` layers
/// are peeled; what is nearer then comes in the order of [`PeelDraws::rest`], so nothing is lost.
///
/// # Errors
/// [`TransparencyError`] if memory is short, or a draw does not fit the target.
pub fn peel(
    device: &Device,
    target: &Target<'_>,
    finder: &Finder,
    draws: PeelDraws<'_>,
    most_layers: u32,
) -> Result<Peeled, TransparencyError> {
    let layer = || device.create_texture(&target.texture_like(LAYER));
    let (mut next, mut spare) = (layer()?, Some(layer()?));
    let mut behind = target.depth.clone();
    let mut peeled = Peeled {
        layers: 0,
        is_complete: true,
        statistics: Statistics::default(),
    };
    let blending = marked(draws.blending);
    loop {
        let (found, statistics) =
            find(device, target.order, finder, draws.finding, &behind, &next)?;
        peeled.statistics += statistics;
        if !found {
            return Ok(peeled);
        }
        if peeled.layers == most_layers {
            peeled.is_complete = false;
            peeled.statistics += blend(device, target, &behind, draws.rest)?;
            return Ok(peeled);
        }
        peeled.statistics += blend(device, target, &next, &blending)?;
        peeled.layers += 1;
        // The opaque depths are kept; from then on two textures take turns.
        let free = spare.take().unwrap_or(behind);
        behind = std::mem::replace(&mut next, free);
    }
}

/// Writes the depths of the next layer; true if some sample has a fragment in it.
fn find(
    device: &Device,
    order: DepthOrder,
    finder: &Finder,
    draws: &[Draw<'_>],
    behind: &Texture,
    layer: &Texture,
) -> Result<(bool, Statistics), TransparencyError> {
    let groups = [finder.bind(device, behind)?];
    let queries = OcclusionQueries::new(1);
    let draws: Vec<Draw<'_>> = draws
        .iter()
        .map(|draw| Draw {
            bind_groups: &groups,
            occlusion_query: Some(0),
            stencil_reference: [FOUND; 2],
            ..draw.clone()
        })
        .collect();
    let statistics = device.render(&RenderPass {
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(
            &layer.view(),
            order.nearest(),
        )),
        occlusion_queries: Some(&queries),
        draws: &draws,
        ..RenderPass::default()
    })?;
    Ok((queries.samples_passed(0) > 0, statistics))
}

/// Blends draws that test depths and do not change them.
fn blend(
    device: &Device,
    target: &Target<'_>,
    depths: &Texture,
    draws: &[Draw<'_>],
) -> Result<Statistics, TransparencyError> {
    Ok(device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::load(&target.color.view()))],
        depth_stencil_attachment: Some(DepthStencilAttachment::read_only(&depths.view())),
        draws,
        ..RenderPass::default()
    })?)
}

/// The draws with the mark as stencil reference.
fn marked<'a>(draws: &[Draw<'a>]) -> Vec<Draw<'a>> {
    let marked = draws.iter().map(|draw| Draw {
        stencil_reference: [FOUND; 2],
        ..draw.clone()
    });
    marked.collect()
}
