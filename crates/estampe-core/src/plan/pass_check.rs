//! The checks of a pass before anything is drawn or cleared: whether its draws fit its target.

use crate::attachment::TargetShape;
use crate::commands::{Draw, RenderPass};
use crate::pipeline::RenderPipeline;
use estampe_types::TextureFormat;
use estampe_types::state::Viewport;

/// The reason why a pass was refused. Its target is as it was.
///
/// Draws are numbered from 0, in the order of [`RenderPass::draws`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderPassError {
    /// A pipeline was created for another number of samples.
    #[error(
        "draw {draw}: its pipeline has {pipeline} samples per pixel and the pass {target}; create \
         the pipeline with `multisample.count` {target}"
    )]
    Samples {
        /// The draw.
        draw: usize,
        /// The pipeline's samples.
        pipeline: u32,
        /// The target's.
        target: u32,
    },
    /// A pipeline was created for other colour attachments.
    #[error(
        "draw {draw}: its pipeline writes the colour formats [{}] and the pass has [{}]; give the \
         pipeline one target for each attachment, of the same format",
        format_names(pipeline),
        format_names(target)
    )]
    ColorFormats {
        /// The draw.
        draw: usize,
        /// The pipeline's formats.
        pipeline: Vec<TextureFormat>,
        /// The target's.
        target: Vec<TextureFormat>,
    },
    /// A pipeline tests depth, and the target has no depth attachment.
    #[error(
        "draw {draw}: its pipeline has a depth test and the pass has no depth attachment; attach one \
         with a depth format or create the pipeline without `depth_stencil`"
    )]
    NoDepth {
        /// The draw.
        draw: usize,
    },
    /// A pipeline tests stencil values, and the target has no stencil attachment.
    #[error(
        "draw {draw}: its pipeline has a stencil test and the pass has no stencil attachment; attach \
         one with a stencil format or create the pipeline without `depth_stencil.stencil`"
    )]
    NoStencil {
        /// The draw.
        draw: usize,
    },
    /// A viewport that is empty, too large, not finite, or whose depths are outside 0..=1.
    #[error(
        "draw {draw}: the viewport is at ({}, {}), {}x{} pixels large, with depths {}..{}; its corner must be in \
         -32768..=32767, its sides above 0 and at most 32768, its depths in 0..=1",
        viewport.x, viewport.y, viewport.width, viewport.height, viewport.min_depth, viewport.max_depth
    )]
    Viewport {
        /// The draw.
        draw: usize,
        /// Its viewport.
        viewport: Viewport,
    },
    /// A draw names an occlusion query that the pass does not have.
    #[error(
        "draw {draw}: it counts samples for occlusion query {query} and the pass has {count} of them; set \
         `RenderPass::occlusion_queries` to at least {} queries",
        u64::from(*query) + 1
    )]
    OcclusionQuery {
        /// The draw.
        draw: usize,
        /// The query that it names.
        query: u32,
        /// The number of queries in the pass.
        count: usize,
    },
    /// Another thread has cancelled the pass, whose target holds a part of it.
    #[error("the pass was cancelled; its attachments hold what was drawn until then")]
    Cancelled,
    /// The system has not enough memory for an attachment.
    #[error("no memory for an attachment of {bytes} bytes")]
    OutOfMemory {
        /// The bytes that it takes.
        bytes: u64,
    },
    /// More load operations than colour attachments.
    #[error(
        "the pass has {given} colour load operations and {attachments} colour attachments; \
         drop those beyond"
    )]
    LoadColors {
        /// The number of load operations.
        given: usize,
        /// The number of colour attachments.
        attachments: usize,
    },
}

impl RenderPass<'_> {
    /// Checks that the pass can be drawn into a target.
    ///
    /// # Errors
    /// [`RenderPassError`] names the draw that does not fit.
    pub fn check(&self, target: &TargetShape<'_>) -> Result<(), RenderPassError> {
        let (given, attachments) = (self.load_colors.len(), target.color_formats.len());
        if given > attachments {
            return Err(RenderPassError::LoadColors { given, attachments });
        }
        let queries = self.occlusion_queries.map_or(0, |queries| queries.count());
        let mut last: Option<&RenderPipeline> = None;
        for (number, draw) in self.draws.iter().enumerate() {
            // Draws in a row mostly have one pipeline.
            if !last.is_some_and(|last| std::ptr::eq(last, draw.pipeline)) {
                check_pipeline(target, number, draw.pipeline)?;
                last = Some(draw.pipeline);
            }
            check_draw(queries, number, draw)?;
        }
        Ok(())
    }
}

/// Checks that a draw's pipeline is for the formats and samples of a target.
fn check_pipeline(
    target: &TargetShape<'_>,
    number: usize,
    pipeline: &RenderPipeline,
) -> Result<(), RenderPassError> {
    let descriptor = pipeline.descriptor();
    if descriptor.multisample.count != target.samples {
        return Err(RenderPassError::Samples {
            draw: number,
            pipeline: descriptor.multisample.count,
            target: target.samples,
        });
    }
    let formats = descriptor
        .targets
        .iter()
        .flatten()
        .map(|target| target.format);
    if !formats.clone().eq(target.color_formats.iter().copied()) {
        return Err(RenderPassError::ColorFormats {
            draw: number,
            pipeline: formats.collect(),
            target: target.color_formats.to_vec(),
        });
    }
    if pipeline.key().depth.is_some() && !target.depth_stencil.is_some_and(TextureFormat::has_depth)
    {
        return Err(RenderPassError::NoDepth { draw: number });
    }
    if descriptor
        .depth_stencil
        .is_some_and(|state| state.stencil.is_some())
        && !target.depth_stencil.is_some_and(TextureFormat::has_stencil)
    {
        return Err(RenderPassError::NoStencil { draw: number });
    }
    Ok(())
}

/// Checks a draw's viewports and its occlusion query.
fn check_draw(queries: usize, number: usize, draw: &Draw<'_>) -> Result<(), RenderPassError> {
    let more = draw.more_viewports.iter().filter_map(|more| more.viewport);
    let mut viewports = draw.viewport.into_iter().chain(more);
    if let Some(viewport) = viewports.find(|viewport| !is_valid(viewport)) {
        return Err(RenderPassError::Viewport {
            draw: number,
            viewport,
        });
    }
    match draw.occlusion_query {
        Some(query) if query as usize >= queries => Err(RenderPassError::OcclusionQuery {
            draw: number,
            query,
            count: queries,
        }),
        _ => Ok(()),
    }
}

/// The names of formats, separated by commas: for messages.
fn format_names(formats: &[TextureFormat]) -> String {
    let names: Vec<&str> = formats.iter().map(|format| format.name()).collect();
    names.join(", ")
}

/// A viewport that the arithmetic can stand: finite, with area, its depths in 0..=1.
fn is_valid(viewport: &Viewport) -> bool {
    let Viewport {
        x,
        y,
        width,
        height,
        min_depth,
        max_depth,
    } = *viewport;
    let range = -32_768.0..=32_767.0;
    range.contains(&x)
        && range.contains(&y)
        && width > 0.0
        && height > 0.0
        && width <= 32_768.0
        && height <= 32_768.0
        && (0.0..=1.0).contains(&min_depth)
        && (0.0..=1.0).contains(&max_depth)
}
