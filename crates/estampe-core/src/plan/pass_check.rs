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

/// The needs of the draws of a pass, found when they were [checked](DrawChecker).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DrawNeeds {
    /// Tessellation or a geometry shader.
    pub(crate) amplification: bool,
    /// One thread, because shaders store in an order that can be seen, or because other threads
    /// draw other passes.
    pub(crate) one_thread: bool,
}

impl DrawNeeds {
    /// The same, of a pass that the calling thread draws alone, as others are drawn beside it.
    #[must_use]
    pub fn by_one_thread(self) -> Self {
        Self {
            one_thread: true,
            ..self
        }
    }
}

impl std::ops::BitOrAssign for DrawNeeds {
    fn bitor_assign(&mut self, other: Self) {
        self.amplification |= other.amplification;
        self.one_thread |= other.one_thread;
    }
}

/// Checks draws one after the other: whether they can be drawn into a target.
#[derive(Debug)]
pub struct DrawChecker<'a> {
    target: TargetShape<'a>,
    queries: usize,
    /// The pipeline that was checked last: draws in a row mostly have one.
    last: Option<&'a RenderPipeline>,
    needs: DrawNeeds,
}

impl<'a> DrawChecker<'a> {
    /// Nothing is checked yet; the pass has a target, and so many occlusion queries.
    #[must_use]
    pub fn new(target: &TargetShape<'a>, queries: usize) -> Self {
        Self {
            target: *target,
            queries,
            last: None,
            needs: DrawNeeds::default(),
        }
    }

    /// Checks the next draw, by what the rules are about.
    ///
    /// # Errors
    /// [`RenderPassError`] names the draw by its number if it does not fit.
    pub fn check(
        &mut self,
        number: usize,
        pipeline: &'a RenderPipeline,
        viewports: impl Iterator<Item = Viewport>,
        query: Option<u32>,
    ) -> Result<(), RenderPassError> {
        if !self.last.is_some_and(|last| std::ptr::eq(last, pipeline)) {
            check_pipeline(&self.target, number, pipeline)?;
            self.last = Some(pipeline);
            self.needs |= DrawNeeds {
                amplification: pipeline.amplified().is_some(),
                one_thread: pipeline.key().stores_in_order,
            };
        }
        check_viewports(number, viewports)?;
        match query {
            Some(query) if query as usize >= self.queries => Err(RenderPassError::OcclusionQuery {
                draw: number,
                query,
                count: self.queries,
            }),
            _ => Ok(()),
        }
    }

    /// The needs of the draws so far.
    #[must_use]
    pub fn needs(&self) -> DrawNeeds {
        self.needs
    }
}

impl RenderPass<'_> {
    /// Checks that the pass can be drawn into a target, and says what its draws need.
    ///
    /// # Errors
    /// [`RenderPassError`] names the draw that does not fit.
    pub fn check(&self, target: &TargetShape<'_>) -> Result<DrawNeeds, RenderPassError> {
        self.check_loads(target)?;
        let queries = self.occlusion_queries.map_or(0, |queries| queries.count());
        let mut checker = DrawChecker::new(target, queries);
        for (number, draw) in self.draws.iter().enumerate() {
            let viewports = draw.viewports();
            checker.check(number, draw.pipeline, viewports, draw.occlusion_query)?;
        }
        Ok(checker.needs())
    }

    /// Checks that no load operation is without its attachment.
    pub(crate) fn check_loads(&self, target: &TargetShape<'_>) -> Result<(), RenderPassError> {
        let (given, attachments) = (self.load_colors.len(), target.color_formats.len());
        if given > attachments {
            return Err(RenderPassError::LoadColors { given, attachments });
        }
        Ok(())
    }
}

impl Draw<'_> {
    /// The viewports that are set.
    fn viewports(&self) -> impl Iterator<Item = Viewport> {
        let more = self.more_viewports.iter().filter_map(|more| more.viewport);
        self.viewport.into_iter().chain(more)
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

/// Checks a draw's viewports.
fn check_viewports(
    number: usize,
    mut viewports: impl Iterator<Item = Viewport>,
) -> Result<(), RenderPassError> {
    match viewports.find(|viewport| !is_valid(viewport)) {
        Some(viewport) => Err(RenderPassError::Viewport {
            draw: number,
            viewport,
        }),
        None => Ok(()),
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
