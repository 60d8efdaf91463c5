//! Batches of the pipeline as runs of a kernel.

use super::read_place::scalar_of;
use super::stage::Stage;
use estampe_ir::interface::{Input, Output};
use estampe_ir::interpreter::{InputData, OutputData, cells};
use estampe_simd::Packet;
use estampe_types::{FragmentBatch, VertexBatch};
use std::cell::Cell;

/// The scalars of a packet of each kind. A fragment's varyings have derivatives after them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Widths {
    pub(super) attributes: usize,
    pub(super) varyings: usize,
    pub(super) colors: usize,
    pub(super) targets: usize,
    pub(super) clip_distances: usize,
}

/// The places of a batch of vertices. `attributes` says at which scalar each location begins, and
/// `varyings` to which scalar of the fragments each scalar of the vertices goes.
pub(super) fn with_vertices<T>(
    stage: &Stage,
    (widths, varyings, immediates): (Widths, &[Option<u32>], &[u32]),
    attributes: &[usize],
    batch: VertexBatch<'_>,
    run: impl FnOnce(usize, &[InputData<'_>], &[OutputData<'_>]) -> T,
) -> T {
    let packets = batch.vertex_index.len();
    let (positions, sizes) = (cells(batch.positions), cells(batch.point_sizes));
    let (to_varyings, distances) = (cells(batch.varyings), cells(batch.distances));
    let input = |input: &Input| match *input {
        Input::Attribute {
            location,
            component,
        } => {
            let first = attributes.get(location as usize).copied();
            let first = first
                .unwrap_or(usize::MAX)
                .saturating_add(component as usize);
            InputData::floats(batch.attributes, first, widths.attributes)
        }
        Input::VertexIndex => InputData::words(batch.vertex_index, 0, 1),
        Input::InstanceIndex => InputData::words(batch.instance_index, 0, 1),
        Input::Cover => InputData::Uniform(1),
        Input::PushConstant(at) => immediate(immediates, at),
        _ => InputData::Uniform(0),
    };
    let output = |output: &Output| match *output {
        Output::Position(part) => OutputData::floats(positions, part as usize, 4),
        Output::Varying(scalar) => match varyings.get(scalar as usize) {
            Some(Some(to)) => OutputData::floats(to_varyings, *to as usize, widths.varyings),
            _ => OutputData::Dropped,
        },
        Output::PointSize => OutputData::floats(sizes, 0, 1),
        Output::ClipDistance(at) => {
            OutputData::floats(distances, at as usize, widths.clip_distances)
        }
        _ => OutputData::Dropped,
    };
    let interface = stage.interface();
    let mut ends = Ends::take();
    ends.inputs.extend(interface.inputs.iter().map(input));
    ends.outputs.extend(interface.outputs.iter().map(output));
    let result = run(packets, &ends.inputs, &ends.outputs);
    ends.give_back();
    result
}

/// The places of a batch of fragments, of one packet each time if the sample index is read: it
/// differs from packet to packet. `gradients` lists the scalars that have derivatives, in ascending
/// order; `texels` are those of the stage's [reads](Stage::reads).
pub(super) fn with_fragments<E>(
    stage: &Stage,
    (widths, gradients, immediates): (Widths, &[usize], &[u32]),
    (batch, texels): (FragmentBatch<'_>, &[Packet<f32>]),
    mut run: impl FnMut(usize, &[InputData<'_>], &[OutputData<'_>]) -> Result<(), E>,
) -> Result<(), E> {
    let all = batch.coverage.len();
    let interface = stage.interface();
    let by_packet = interface.inputs.contains(&Input::SampleIndex);
    let (coverage, colors) = (cells(batch.coverage), cells(batch.colors));
    let (depths, masks) = (cells(batch.depths), cells(batch.sample_masks));
    let step = if by_packet { 1 } else { all.max(1) };
    let scalars = widths.varyings + 2 * gradients.len();
    let mut ends = Ends::take();
    let mut result = Ok(());
    for first in (0..all).step_by(step) {
        let coverage: &[Cell<u16>] = &coverage[first..];
        let floats = |packets, part: usize, stride: usize| {
            InputData::floats(packets, first * stride + part, stride)
        };
        let input = |input: &Input| match *input {
            Input::Varying(_) | Input::Derivative { .. } => {
                match scalar_of(*input, widths, gradients) {
                    Some(scalar) => floats(batch.varyings, scalar, scalars),
                    None => InputData::Uniform(0),
                }
            }
            Input::TextureRead { read, component } => {
                let (part, stride) = stage.reads().place(read, component, all);
                floats(texels, part, stride)
            }
            Input::Position(part) => floats(batch.positions, part as usize, 4),
            Input::FrontFacing => {
                InputData::Mask(batch.front_facing.get(first..).unwrap_or_default())
            }
            Input::SampleIndex => {
                InputData::Uniform(batch.sample_index.get(first).copied().unwrap_or(0))
            }
            Input::SampleMask => InputData::words(batch.samples_covered, first, 1),
            Input::Cover => InputData::SharedMask(coverage),
            Input::PushConstant(at) => immediate(immediates, at),
            _ => InputData::Uniform(0),
        };
        let to = |packets, part: usize, stride: usize| {
            OutputData::floats(packets, first * stride + part, stride)
        };
        let output = |output: &Output| match *output {
            Output::Color { target, component } => {
                let part = (target * 4 + component) as usize;
                to(colors, part, widths.colors * 4)
            }
            Output::SecondColor(component) => {
                let part = widths.targets * 4 + component as usize;
                to(colors, part, widths.colors * 4)
            }
            Output::Depth => to(depths, 0, 1),
            Output::SampleMask => OutputData::words(masks, first, 1),
            Output::Cover => OutputData::Mask(coverage),
            _ => OutputData::Dropped,
        };
        ends.inputs.clear();
        ends.inputs.extend(interface.inputs.iter().map(input));
        ends.outputs.clear();
        ends.outputs.extend(interface.outputs.iter().map(output));
        result = run(step.min(all - first), &ends.inputs, &ends.outputs);
        if result.is_err() {
            break;
        }
    }
    ends.give_back();
    result
}

thread_local! {
    /// The memory of the last batch's inputs and outputs, which are none now.
    static ENDS: Cell<Ends<'static>> = Cell::default();
}

/// The inputs and outputs of a batch.
#[derive(Debug, Default)]
struct Ends<'a> {
    inputs: Vec<InputData<'a>>,
    outputs: Vec<OutputData<'a>>,
}

impl<'a> Ends<'a> {
    /// None, with room for those of the thread's last batch.
    fn take() -> Self {
        ENDS.take().emptied()
    }

    /// Keeps the room for the thread's next batch.
    fn give_back(self) {
        ENDS.set(self.emptied());
    }

    /// None, with the same room: the standard library collects a vector's own elements in place.
    fn emptied<'b>(mut self) -> Ends<'b> {
        self.inputs.clear();
        self.outputs.clear();
        let inputs = self.inputs.into_iter().map(|_| InputData::Uniform(0));
        let outputs = self.outputs.into_iter().map(|_| OutputData::Dropped);
        Ends {
            inputs: inputs.collect(),
            outputs: outputs.collect(),
        }
    }
}

/// A word of the immediates.
pub(super) fn immediate(immediates: &[u32], at: u32) -> InputData<'static> {
    InputData::Uniform(immediates.get(at as usize).copied().unwrap_or(0))
}
