//! The passes of a frame: one, or those of order-independent transparency.
//!
//! ```text
//!   one pass       opaque surfaces, sorted transparent triangles, edges over them
//!   several        opaque surfaces → layers, or sums and their composition → edges, resolve
//! ```
//!
//! The samples are of the same format between passes as in one, so a pixel without transparent
//! surface has the same bits with every method.

use crate::attachments::Attachments;
use crate::backdrop::BackdropDraw;
use crate::draw_plan::DrawPlan;
use crate::frame::{FrameStage, OnStage, TransparentLayers};
use crate::ground::GroundShadow;
use crate::options::{RenderOptions, Transparency};
use crate::render_error::RenderError;
use crate::shading::surface::DEPTH_ORDER;
use crate::surface_pipelines::FrameStyle;
use estampe::{
    AspectOperations, ColorAttachment, DepthStencilAttachment, Device, Draw, LoadOp, PassControl,
    RenderPass, Statistics, StoreOp, Texture,
};
use estampe_transparency::{PeelDraws, Target, blend_weighted, peel};

/// Counts and times of all passes of a frame, and the layers that were peeled.
pub(crate) struct DrawnPasses {
    pub(crate) statistics: Statistics,
    pub(crate) layers: Option<TransparentLayers>,
}

/// The passes of a frame.
pub(crate) struct FramePasses<'a> {
    pub(crate) plan: &'a DrawPlan,
    pub(crate) style: &'a FrameStyle,
    pub(crate) attachments: &'a Attachments,
    pub(crate) options: &'a RenderOptions,
    /// Is told how many draws of the passes are begun.
    pub(crate) on_stage: OnStage<'a>,
    /// The work of the passes before: shadow maps.
    pub(crate) before: Statistics,
    /// The gradient behind everything, if there is one.
    pub(crate) backdrop: Option<&'a BackdropDraw>,
    /// The ground, if the model stands on one.
    pub(crate) ground: Option<&'a GroundShadow>,
}

impl FramePasses<'_> {
    /// Draws the frame. Marks on the finished image are not part of it.
    pub(crate) fn draw(&self, device: &Device) -> Result<DrawnPasses, RenderError> {
        let method = self.options.transparency;
        if method == Transparency::Sorted || !self.has_transparent_surfaces() {
            let mut statistics = self.before;
            let unused = StoreOp::Discard;
            statistics += self.with_one_pass(unused, |pass| Ok(device.render(pass)?))?;
            return Ok(DrawnPasses {
                statistics,
                layers: None,
            });
        }
        let samples = self.attachments.samples();
        let progress = |begun, all| (self.on_stage)(FrameStage::Drawing { begun, all });
        let mut statistics = self.before;
        statistics += device.render(&RenderPass {
            color_attachments: &[Some(ColorAttachment {
                resolve_target: None,
                ..self.attachments.color(self.options)
            })],
            depth_stencil_attachment: Some(self.attachments.cleared_depth()),
            draws: &self.opaque_and_ground(),
            control: watched(&progress),
            ..RenderPass::default()
        })?;
        let target = Target {
            color: samples,
            depth: &self.attachments.depth,
            order: DEPTH_ORDER,
        };
        let transparent = self.plan.transparent();
        let mut layers = None;
        if method == Transparency::Weighted {
            statistics += blend_weighted(device, &target, &transparent)?;
        } else {
            let draws = PeelDraws {
                finding: &self.plan.finding(),
                blending: &self.plan.layer(),
                rest: &transparent,
            };
            let most = Transparency::MOST_LAYERS;
            let peeled = peel(device, &target, &self.style.finder, draws, most)?;
            statistics += peeled.statistics;
            layers = Some(TransparentLayers {
                count: peeled.layers,
                is_complete: peeled.is_complete,
            });
        }
        statistics += self.finish(device, samples)?;
        Ok(DrawnPasses { statistics, layers })
    }

    fn opaque_and_ground(&self) -> Vec<Draw<'_>> {
        let mut draws = self.plan.opaque();
        draws.extend(self.backdrop.map(BackdropDraw::draw));
        draws.extend(self.ground.map(GroundShadow::draw));
        draws.extend(self.plan.guides());
        draws
    }

    /// True if some surface is transparent.
    pub(crate) fn has_transparent_surfaces(&self) -> bool {
        !self.plan.transparent().is_empty()
    }

    /// The pass that draws the whole frame, if transparent surfaces are sorted. `unused` is what
    /// becomes of depths, and of samples that are resolved.
    pub(crate) fn with_one_pass<T>(
        &self,
        unused: StoreOp,
        use_pass: impl FnOnce(&RenderPass<'_>) -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        let mut draws = self.opaque_and_ground();
        draws.extend(self.plan.transparent());
        draws.extend(self.plan.edges());
        let progress = |begun, all| (self.on_stage)(FrameStage::Drawing { begun, all });
        let mut color = self.attachments.color(self.options);
        if color.resolve_target.is_some() {
            color.store = unused;
        }
        use_pass(&RenderPass {
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(DepthStencilAttachment {
                depth: AspectOperations::Write {
                    load: LoadOp::Clear(1.0),
                    store: unused,
                },
                ..self.attachments.cleared_depth()
            }),
            draws: &draws,
            control: watched(&progress),
            ..RenderPass::default()
        })
    }

    /// Draws the edges over all surfaces, and makes the image of the samples.
    fn finish(&self, device: &Device, samples: &Texture) -> Result<Statistics, RenderError> {
        let edges = self.plan.edges();
        let is_multisampled = samples.sample_count() > 1;
        if edges.is_empty() && !is_multisampled {
            return Ok(Statistics::default());
        }
        Ok(device.render(&RenderPass {
            color_attachments: &[Some(ColorAttachment {
                resolve_target: is_multisampled.then(|| self.attachments.image.view()),
                ..ColorAttachment::load(&samples.view())
            })],
            draws: &edges,
            depth_stencil_attachment: Some(DepthStencilAttachment::read_only(
                &self.attachments.depth.view(),
            )),
            ..RenderPass::default()
        })?)
    }
}

/// The control of a pass whose progress is watched.
fn watched(progress: &(dyn Fn(usize, usize) + Sync)) -> PassControl<'_> {
    PassControl {
        progress: Some(progress),
        cancel: None,
    }
}
