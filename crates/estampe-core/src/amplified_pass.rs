//! Passes with tessellation, geometry shaders or several layers: amplified draws become pieces,
//! which are drawn as ordinary draws between the others, each in the layer that it selects.

use crate::amplification::amplify::Amplifier;
use crate::amplification::piece::Piece;
use crate::attachment::RenderTarget;
use crate::commands::{Discards, Draw, DrawList, LoadOp, PassControl, RenderPass, ViewportScissor};
use crate::draw::{Context, Memory};
use crate::plan::pass_check::RenderPassError;
use crate::statistics::Statistics;
use estampe_types::{BufferData, IndexFormat};
use std::time::Instant;

/// Words of pieces that wait until they are drawn: 64 MiB.
const WAITING_WORDS: usize = 1 << 24;

/// Draws of a pass that wait until they are drawn together.
struct Waiting<'a> {
    pass: &'a RenderPass<'a>,
    draws: Vec<&'a Draw<'a>>,
    entries: Vec<Entry>,
    /// Words of the pieces.
    words: usize,
    /// Nothing was drawn yet, so attachments are to be loaded as the pass says.
    is_first: bool,
}

/// A draw that waits, by its number in the pass.
struct Entry {
    draw: usize,
    piece: Option<([BufferData; 1], Piece)>,
}

impl Context {
    /// Draws a pass that was checked, of which draws may have tessellation or a geometry shader.
    pub(crate) fn render_amplified(
        &self,
        layers: &mut [RenderTarget],
        pass: &RenderPass<'_>,
        memory: &mut Memory,
    ) -> Result<Statistics, RenderPassError> {
        let mut waiting = Waiting {
            pass,
            draws: pass.draws.iter().collect(),
            entries: Vec::new(),
            words: 0,
            is_first: true,
        };
        let mut statistics = Statistics::default();
        let amplifier = Amplifier {
            executor: self.executor(),
            level: self.level(),
            // Memory is short before there are 2³².
            layers: u32::try_from(layers.len()).unwrap_or(u32::MAX),
        };
        for (number, draw) in pass.draws.iter().enumerate() {
            let Some(amplified) = draw.pipeline.amplified() else {
                waiting.entries.push(Entry {
                    draw: number,
                    piece: None,
                });
                continue;
            };
            let mut failed = None;
            let mut start = Instant::now();
            amplifier.amplify(draw, amplified, &mut statistics, |pieces, statistics| {
                statistics.geometry += start.elapsed();
                for piece in pieces {
                    if piece.index_count > 0 {
                        waiting.push(number, piece);
                    }
                }
                let drawn = if pass.control.is_cancelled() {
                    Err(RenderPassError::Cancelled)
                } else if waiting.words > WAITING_WORDS {
                    waiting.draw(self, layers, memory, statistics)
                } else {
                    Ok(())
                };
                start = Instant::now();
                failed = drawn.err();
                failed.is_none()
            });
            if let Some(error) = failed {
                // What waits is not drawn.
                return Err(error);
            }
            statistics.geometry += start.elapsed();
        }
        waiting.draw(self, layers, memory, &mut statistics)?;
        Ok(statistics)
    }
}

impl Waiting<'_> {
    fn push(&mut self, draw: usize, piece: Piece) {
        self.words += piece.words();
        self.entries.push(Entry {
            draw,
            piece: Some(([piece.vertices.clone()], piece)),
        });
    }

    /// Draws what waits.
    fn draw(
        &mut self,
        context: &Context,
        layers: &mut [RenderTarget],
        memory: &mut Memory,
        statistics: &mut Statistics,
    ) -> Result<(), RenderPassError> {
        for (layer, target) in (0..).zip(layers) {
            *statistics += self.draw_layer(context, (layer, target), memory)?;
        }
        self.entries.clear();
        self.words = 0;
        self.is_first = false;
        Ok(())
    }

    /// Draws what waits for one layer.
    fn draw_layer(
        &self,
        context: &Context,
        (layer, target): (u32, &mut RenderTarget),
        memory: &mut Memory,
    ) -> Result<Statistics, RenderPassError> {
        let entries = self.entries.iter().filter(|entry| entry.layer() == layer);
        let entries: Vec<&Entry> = entries.collect();
        if entries.is_empty() && !self.is_first {
            return Ok(Statistics::default());
        }
        let draws: Vec<Draw<'_>> = entries
            .iter()
            .map(|entry| entry.as_drawn(self.draws[entry.draw]))
            .collect();
        let begun = |draws: usize, _: usize| {
            let last = draws.checked_sub(1).and_then(|at| entries.get(at));
            let begun = last.map_or(0, |entry| entry.draw + 1);
            self.pass.control.report(begun, self.draws.len());
        };
        let mut part = RenderPass {
            control: PassControl {
                // The first layer has the draws that select none.
                progress: (layer == 0).then_some(&begun),
                ..self.pass.control
            },
            draws: DrawList::Whole(&draws),
            // The next part goes on with the same images.
            discards: Discards::default(),
            ..self.pass.clone()
        };
        if !self.is_first {
            part.load_colors = vec![LoadOp::Load; target.shape().color_formats.len()];
            part.load_depth = LoadOp::Load;
            part.load_stencil = LoadOp::Load;
        }
        let executor = context.executor_of(&draws);
        context.render_checked(executor, target, &part, memory)
    }
}

impl Entry {
    fn layer(&self) -> u32 {
        self.piece.as_ref().map_or(0, |(_, piece)| piece.layer)
    }

    /// The viewport of a piece.
    fn viewport(&self, draw: &Draw<'_>) -> ViewportScissor {
        let first = ViewportScissor {
            viewport: draw.viewport,
            scissor: draw.scissor,
        };
        let number = self.piece.as_ref().map_or(0, |(_, piece)| piece.viewport);
        let more = (number as usize).checked_sub(1);
        let more = more.and_then(|at| draw.more_viewports.get(at));
        more.copied().unwrap_or(first)
    }

    /// The draw of a piece, or the plain draw itself.
    fn as_drawn<'a>(&'a self, draw: &'a Draw<'a>) -> Draw<'a> {
        let amplified = draw.pipeline.amplified();
        let ViewportScissor { viewport, scissor } = self.viewport(draw);
        match (&self.piece, amplified) {
            (Some((vertices, piece)), Some(amplified)) => Draw {
                pipeline: &amplified.rasterized,
                vertex_buffers: vertices,
                indices: Some((&piece.indices, IndexFormat::Uint32)),
                elements: 0..piece.index_count,
                instances: 0..1,
                base_vertex: 0,
                viewport,
                scissor,
                ..draw.clone()
            },
            _ => draw.clone(),
        }
    }
}
