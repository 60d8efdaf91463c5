//! Batches of the pipeline as runs of a kernel.

use super::ends::{MOST, Source, Target};
use super::stage::Stage;
use estampe_ir::interpreter::{InputData, OutputData, cells};
use estampe_simd::Packet;
use estampe_types::{FragmentBatch, VertexBatch};
use std::cell::Cell;

/// The scalars of a packet of each kind. A fragment's varyings have derivatives after them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Widths {
    pub(super) attributes: usize,
    pub(super) varyings: usize,
    /// Those of the varyings that have derivatives along each axis.
    pub(super) gradients: usize,
    pub(super) colors: usize,
    pub(super) targets: usize,
    pub(super) clip_distances: usize,
}

impl Widths {
    /// The scalars of a fragment's varyings and their derivatives.
    pub(super) fn fragment_scalars(&self) -> usize {
        self.varyings + 2 * self.gradients
    }
}

/// The data of a batch of vertices.
#[inline(always)]
pub(super) fn with_vertices<T>(
    stage: &Stage,
    (widths, immediates): (Widths, &[u32]),
    batch: VertexBatch<'_>,
    run: impl FnOnce(usize, &[InputData<'_>], &[OutputData<'_>]) -> T,
) -> T {
    let packets = batch.vertex_index.len();
    let (positions, sizes) = (cells(batch.positions), cells(batch.point_sizes));
    let (varyings, distances) = (cells(batch.varyings), cells(batch.distances));
    let input = |source: Source| match source {
        Source::Attributes => InputData::floats(batch.attributes, 0, widths.attributes),
        Source::VertexIndex => InputData::words(batch.vertex_index, 0, 1),
        Source::InstanceIndex => InputData::words(batch.instance_index, 0, 1),
        Source::Cover => InputData::Uniform(1),
        Source::Immediates => InputData::UniformWords(immediates),
        _ => InputData::Uniform(0),
    };
    let output = |target: Target| match target {
        Target::Positions => OutputData::floats(positions, 0, 4),
        Target::Varyings => OutputData::floats(varyings, 0, widths.varyings),
        Target::PointSizes => OutputData::floats(sizes, 0, 1),
        Target::Distances => OutputData::floats(distances, 0, widths.clip_distances),
        _ => OutputData::Dropped,
    };
    let (inputs, outputs) = (stage.sources(), stage.targets());
    run(
        packets,
        list(&mut [InputData::Uniform(0); MOST], inputs, input),
        list(&mut [OutputData::Dropped; MOST], outputs, output),
    )
}

/// The data of a batch of fragments, of one packet each time if the sample index is read: it
/// differs from packet to packet. `texels` are those of the stage's [reads](Stage::reads).
#[inline(always)]
pub(super) fn with_fragments<E>(
    stage: &Stage,
    (widths, immediates): (Widths, &[u32]),
    (batch, texels): (FragmentBatch<'_>, &[Packet<f32>]),
    mut run: impl FnMut(usize, &[InputData<'_>], &[OutputData<'_>]) -> Result<(), E>,
) -> Result<(), E> {
    let all = batch.coverage.len();
    let (coverage, colors) = (cells(batch.coverage), cells(batch.colors));
    let (depths, masks) = (cells(batch.depths), cells(batch.sample_masks));
    let (inputs, outputs) = (stage.sources(), stage.targets());
    let by_packet = inputs.contains(&Source::SampleIndex);
    let step = if by_packet { 1 } else { all.max(1) };
    for first in (0..all).step_by(step) {
        let coverage: &[Cell<u16>] = &coverage[first..];
        let floats = |packets, stride: usize| InputData::floats(packets, first * stride, stride);
        let input = |source: Source| match source {
            Source::Varyings => floats(batch.varyings, widths.fragment_scalars()),
            Source::Texels(span) => {
                let (start, stride) = stage.reads().places(span, all);
                InputData::floats(texels, start + first * stride, stride)
            }
            Source::Positions => floats(batch.positions, 4),
            Source::FrontFacing => {
                InputData::Mask(batch.front_facing.get(first..).unwrap_or_default())
            }
            Source::SampleIndex => {
                InputData::Uniform(batch.sample_index.get(first).copied().unwrap_or(0))
            }
            Source::SamplesCovered => InputData::words(batch.samples_covered, first, 1),
            Source::Cover => InputData::SharedMask(coverage),
            Source::Immediates => InputData::UniformWords(immediates),
            _ => InputData::Uniform(0),
        };
        let to = |packets, stride: usize| OutputData::floats(packets, first * stride, stride);
        let output = |target: Target| match target {
            Target::Colors => to(colors, widths.colors * 4),
            Target::Depths => to(depths, 1),
            Target::SampleMasks => OutputData::words(masks, first, 1),
            Target::Cover => OutputData::Mask(coverage),
            _ => OutputData::Dropped,
        };
        run(
            step.min(all - first),
            list(&mut [InputData::Uniform(0); MOST], inputs, input),
            list(&mut [OutputData::Dropped; MOST], outputs, output),
        )?;
    }
    Ok(())
}

/// Fills a list with what each of a stage's sources or targets is in a batch.
#[inline(always)]
fn list<'a, T: Copy, D>(room: &'a mut [D; MOST], ends: &[T], data: impl Fn(T) -> D) -> &'a [D] {
    debug_assert!(ends.len() <= MOST, "a stage has few kinds of data");
    for (to, end) in room.iter_mut().zip(ends) {
        *to = data(*end);
    }
    &room[..ends.len().min(MOST)]
}

/// A word of the immediates.
pub(super) fn immediate(immediates: &[u32], at: u32) -> InputData<'static> {
    InputData::Uniform(immediates.get(at as usize).copied().unwrap_or(0))
}
