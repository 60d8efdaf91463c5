//! A frame of several steps on a device: recorded anew and submitted as one list each time.

use super::description::{Frame, FrameDraw, PICTURE, Pass, Step};
use super::objects::Objects;
use crate::BenchError;
use crate::frame::FrameTimes;
use crate::scene::Scene;
use estampe::{
    BindGroup, BufferSlice, ColorAttachment, Command, ComputePipeline, DepthStencilAttachment,
    Device, Dispatch, Draw, IndexFormat, RenderPass, RenderPipeline, Texture, TextureView,
};
use std::time::Instant;

/// The objects of the steps.
#[derive(Debug)]
pub(crate) struct PreparedFrame<'d> {
    device: &'d Device,
    pipelines: Vec<(RenderPipeline, Vec<BindGroup>)>,
    steps: Vec<PreparedStep>,
    picture: Texture,
}

#[derive(Debug)]
enum PreparedStep {
    Pass {
        colors: Vec<Option<ColorAttachment>>,
        depth: Option<TextureView>,
        draws: Vec<PreparedDraw>,
    },
    Dispatch {
        pipeline: ComputePipeline,
        groups: Vec<BindGroup>,
        workgroups: [u32; 3],
    },
}

#[derive(Debug)]
struct PreparedDraw {
    draw: FrameDraw,
    vertices: Vec<BufferSlice>,
    indices: Option<BufferSlice>,
}

impl<'d> PreparedFrame<'d> {
    /// Creates the objects.
    ///
    /// # Errors
    /// [`BenchError`] if the device refuses one.
    pub(crate) fn new(
        device: &'d Device,
        scene: &Scene,
        frame: &Frame,
    ) -> Result<Self, BenchError> {
        let objects = Objects::new(device, scene, frame)?;
        let pipelines = (0..).zip(&frame.pipelines).map(|(number, pipeline)| {
            let uses = |pass: &&Pass| pass.draws.iter().any(|draw| draw.pipeline == number);
            let pass = frame.passes().find(uses);
            objects.render_pipeline(pipeline, pass.expect("every pipeline is drawn with"))
        });
        let steps = frame.steps.iter().map(|step| {
            Ok(match step {
                Step::Pass(pass) => prepared_pass(&objects, pass),
                Step::Dispatch(step) => {
                    let (pipeline, groups) = objects.compute_pipeline(step)?;
                    PreparedStep::Dispatch {
                        pipeline,
                        groups,
                        workgroups: step.workgroups,
                    }
                }
            })
        });
        Ok(Self {
            device,
            pipelines: pipelines.collect::<Result<_, _>>()?,
            steps: steps.collect::<Result<_, BenchError>>()?,
            picture: objects.images[PICTURE].clone(),
        })
    }

    /// The image that is shown.
    pub(crate) fn picture(&self) -> &Texture {
        &self.picture
    }

    /// Records all steps and runs them.
    pub(crate) fn draw(&self) -> FrameTimes {
        let start = Instant::now();
        let draws = self.steps.iter().map(|step| match step {
            PreparedStep::Pass { draws, .. } => {
                draws.iter().map(|draw| self.recorded(draw)).collect()
            }
            PreparedStep::Dispatch { .. } => Vec::new(),
        });
        let draws: Vec<Vec<Draw<'_>>> = draws.collect();
        let commands = self
            .steps
            .iter()
            .zip(&draws)
            .map(|(step, draws)| match step {
                PreparedStep::Pass { colors, depth, .. } => {
                    let depth = depth.as_ref();
                    Command::from(RenderPass {
                        color_attachments: colors,
                        depth_stencil_attachment: depth
                            .map(|view| DepthStencilAttachment::clear(view, 1.0)),
                        draws,
                        ..RenderPass::default()
                    })
                }
                PreparedStep::Dispatch {
                    pipeline,
                    groups,
                    workgroups,
                } => Command::from(Dispatch {
                    bind_groups: groups,
                    ..Dispatch::new(pipeline, *workgroups)
                }),
            });
        let commands: Vec<Command<'_>> = commands.collect();
        let recording = start.elapsed();
        let statistics = self.device.submit(&commands);
        FrameTimes {
            recording,
            statistics: statistics.expect("the pipelines are made for their passes"),
        }
    }

    fn recorded<'f>(&'f self, prepared: &'f PreparedDraw) -> Draw<'f> {
        let PreparedDraw {
            draw,
            vertices,
            indices,
        } = prepared;
        let (pipeline, groups) = &self.pipelines[draw.pipeline];
        Draw {
            vertex_buffers: vertices,
            index_buffer: indices.as_ref().map(|slice| (slice, IndexFormat::Uint32)),
            instances: 0..draw.instances,
            bind_groups: groups,
            dynamic_offsets: draw.dynamic_offset.as_slice(),
            scissor: draw.scissor,
            ..Draw::new(pipeline, draw.elements.clone())
        }
    }
}

fn prepared_pass(objects: &Objects<'_>, pass: &Pass) -> PreparedStep {
    let view = |image: usize| objects.images[image].view();
    let colors = pass.colors.iter().map(|color| {
        let attachment = match color.clear {
            Some(clear) => ColorAttachment::clear(&view(color.image), clear),
            None => ColorAttachment::load(&view(color.image)),
        };
        Some(ColorAttachment {
            resolve_target: color.resolve.map(view),
            ..attachment
        })
    });
    let draws = pass.draws.iter().map(|draw| {
        let slice = |number: &usize| objects.buffers[*number].clone();
        PreparedDraw {
            draw: draw.clone(),
            vertices: draw.vertices.iter().map(slice).collect(),
            indices: draw.indices.as_ref().map(slice),
        }
    });
    PreparedStep::Pass {
        colors: colors.collect(),
        depth: pass.depth.map(view),
        draws: draws.collect(),
    }
}
