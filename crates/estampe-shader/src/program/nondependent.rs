//! Non-dependent texture reads: samples that are made before the shader runs.
//!
//! In · Out: a tree of the fragment stage · the same tree, of which samples have become inputs; the
//! inputs of a batch · the texels.
//!
//! A sample whose coordinates, layer and derivatives are varyings as they are depends on nothing
//! that the shader computes. So it is made for all packets of a batch in one call: operands are
//! read where the pipeline put them, texels are inputs of the shader like others, and no register
//! is saved around a call. Of the samples in the shader's code each packet's is a call.
//!
//! So are samples at uniform shifts from varyings, which are [filters](super::taps),
//! [loads at the pixel itself](super::pixel_loads), and [comparisons](super::comparisons).
//!
//! Only samples in the outermost body are taken, which every invocation makes. They are numbered by
//! spans: those of a span are at the same place, or are the taps of one filter; the loads are one
//! span.

use super::batch::Widths;
use super::comparisons::{self, ShadowFilter};
use super::groups::Group;
use super::pixel_loads;
use super::read_inputs::with_inputs;
use super::read_place::{MOST, Place, Read, found};
use super::taps::{Filter, Shift};
use super::uniforms::{Finder, Sources, Uniforms};
use estampe_ir::interface::{Input, Output};
use estampe_ir::tree::{Node, Tree, passes};
use estampe_ir::{Op, Value};
use estampe_simd::{Level, Packet};
use estampe_texture::TapShifts;
use estampe_types::shader::TextureReads;
use std::cell::Cell;
use std::collections::HashMap;

/// The channels of a texel.
pub(super) const CHANNELS: usize = 4;

thread_local! {
    /// The memory of the last batch.
    static MEMORY: Cell<Memory> = Cell::default();
}

/// The inputs of a batch of fragments that reads depend on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fragments<'a> {
    /// The SIMD level.
    pub(super) level: Level,
    /// The scalars of varyings and their derivatives, `stride` of each packet.
    pub(super) scalars: &'a [Packet<f32>],
    pub(super) stride: usize,
    /// x, y, z and 1/w in the window, if the shader reads them.
    pub(super) positions: &'a [Packet<f32>],
    pub(super) packets: usize,
}

/// Results for a batch, in memory that the next one uses again.
#[derive(Debug, Default)]
struct Memory {
    texels: Vec<Packet<f32>>,
    /// The uniform values.
    values: Vec<u32>,
    /// The shifts of each filter.
    shifts: Vec<TapShifts>,
}

/// The reads of a stage.
#[derive(Debug, Default)]
pub(super) struct Reads {
    groups: Vec<Group>,
    /// After the groups.
    filters: Vec<Filter>,
    /// After the filters: the positions in the interface of the textures that are loaded from at
    /// the pixel.
    loads: Vec<u32>,
    /// After the loads.
    shadows: Vec<ShadowFilter>,
    /// The shifts of filters.
    uniforms: Uniforms,
    spans: Vec<Span>,
    /// For each read, the number of its span and its first scalar there.
    of_read: Vec<(usize, usize)>,
}

/// The reads of a group, of a filter, or the loads.
#[derive(Debug, Clone, Copy)]
struct Span {
    /// The scalars of a packet before the span's.
    before: usize,
    /// Those of the span.
    scalars: usize,
}

impl Reads {
    /// Takes the reads out of a tree of the fragment stage. `gradients` lists the scalars of the
    /// varyings that have derivatives, in ascending order.
    pub(super) fn take(tree: &mut Tree, widths: Widths, gradients: &[usize]) -> Self {
        let found = found(tree, widths, gradients);
        let loads = pixel_loads::found(tree, MOST - found.len());
        let most = MOST - found.len() - loads.len();
        let compared = comparisons::found(tree, widths, gradients, most);
        if found.is_empty() && loads.is_empty() && compared.is_empty() {
            return Self::default();
        }
        let mut reads = Self {
            loads: loads.iter().map(|load| load.texture).collect(),
            ..Self::default()
        };
        // Of each read, its group and its place there; those of filters come after the others.
        let mut places = Vec::new();
        let mut uniforms = Finder::new(tree);
        for read in &found {
            let is_filter = found.iter().any(|other| {
                other.is_shifted() && other.place == read.place && other.texture == read.texture
            });
            places.push(match &read.shifts[..] {
                &[u, v] if is_filter => {
                    let shifts =
                        [u, v].map(|shift| shift.numbered(|value| uniforms.number_of(tree, value)));
                    (true, reads.add_tap(read, shifts))
                }
                _ => (false, reads.add(read)),
            });
        }
        let (shadows, shadow_places) = ShadowFilter::of_all(tree, &compared, &mut uniforms);
        reads.shadows = shadows;
        reads.uniforms = uniforms.finish();
        let first_reads = reads.add_spans();
        let mut numbers: HashMap<Value, usize> = HashMap::new();
        for (read, (is_tap, (group, at))) in found.iter().zip(places) {
            let before = if is_tap { reads.groups.len() } else { 0 };
            numbers.insert(read.first, first_reads[before + group] + at);
        }
        let mut others = first_reads
            .iter()
            .skip(reads.groups.len() + reads.filters.len());
        if !loads.is_empty()
            && let Some(first) = others.next()
        {
            numbers.extend((loads.iter().map(|load| load.first)).zip(*first..));
        }
        let first_reads: Vec<usize> = others.copied().collect();
        for (compared, (filter, at)) in compared.iter().zip(shadow_places) {
            numbers.insert(compared.first, first_reads[filter] + at);
        }
        let body = std::mem::take(&mut tree.body);
        tree.body = with_inputs(&mut tree.interface, body, &numbers);
        passes::dead_code(tree);
        passes::unused_inputs(tree);
        reads.note_alpha(&tree.interface.inputs);
        reads
    }

    /// Notes of which groups and filters the last channel is read, given the inputs that are used.
    fn note_alpha(&mut self, inputs: &[Input]) {
        let is_alpha = |input: &Input| match input {
            Input::TextureRead { read, component } if *component as usize == CHANNELS - 1 => {
                self.of_read.get(*read as usize).map(|(span, _)| *span)
            }
            _ => None,
        };
        let spans: Vec<usize> = inputs.iter().filter_map(is_alpha).collect();
        let groups = self.groups.iter_mut().map(|group| &mut group.reads_alpha);
        let filters = self
            .filters
            .iter_mut()
            .map(|filter| &mut filter.reads_alpha);
        for (span, reads_alpha) in groups.chain(filters).enumerate() {
            *reads_alpha = spans.contains(&span);
        }
    }

    /// Adds the spans; returns the number of the first read of each.
    fn add_spans(&mut self) -> Vec<usize> {
        let groups = self.groups.iter().map(|group| group.textures.len());
        let filters = self.filters.iter().map(|filter| filter.shifts.len());
        let loaded = Some(self.loads.len()).filter(|count| *count > 0);
        let texels = groups.chain(filters).chain(loaded);
        let shadows = self.shadows.iter().map(ShadowFilter::count);
        let all = texels.map(|count| (count, CHANNELS));
        let (mut before, mut firsts) = (0, Vec::new());
        for (span, (count, each)) in all.chain(shadows.map(|count| (count, 1))).enumerate() {
            firsts.push(self.of_read.len());
            let of_reads = (0..count).map(|at| (span, at * each));
            self.of_read.extend(of_reads);
            let scalars = count * each;
            self.spans.push(Span { before, scalars });
            before += scalars;
        }
        firsts
    }

    /// Adds a read; its group and its place there.
    fn add(&mut self, read: &Read) -> (usize, usize) {
        let group = self
            .groups
            .iter()
            .position(|group| group.place == read.place);
        let group = group.unwrap_or_else(|| {
            self.groups.push(Group {
                place: read.place.clone(),
                textures: Vec::new(),
                reads_alpha: true,
            });
            self.groups.len() - 1
        });
        let textures = &mut self.groups[group].textures;
        textures.push(read.texture);
        (group, textures.len() - 1)
    }

    /// Adds a tap; its filter and its place there.
    fn add_tap(&mut self, read: &Read, shifts: [Shift<usize>; 2]) -> (usize, usize) {
        let mut filters = self.filters.iter();
        let filter =
            filters.position(|filter| filter.place == read.place && filter.texture == read.texture);
        let filter = filter.unwrap_or_else(|| {
            self.filters.push(Filter {
                place: read.place.clone(),
                texture: read.texture,
                shifts: Vec::new(),
                reads_alpha: true,
            });
            self.filters.len() - 1
        });
        let taps = &mut self.filters[filter].shifts;
        taps.push(shifts);
        (filter, taps.len() - 1)
    }

    /// The place of a read whose alpha may [decide](super::alpha_test), and the positions in the
    /// interface of its texture and sampler.
    pub(super) fn place_of(&self, read: u32) -> Option<(&Place, [u32; 2])> {
        let (span, first) = *self.of_read.get(read as usize)?;
        let group = self.groups.get(span)?;
        Some((&group.place, *group.textures.get(first / CHANNELS)?))
    }

    /// The number of reads.
    pub(super) fn count(&self) -> usize {
        self.of_read.len()
    }

    /// How they read the texture at this position in the interface.
    pub(super) fn of_texture(&self, texture: u32) -> TextureReads {
        let groups = self.groups.iter().flat_map(|group| &group.textures);
        let filters = self.filters.iter().map(|filter| &filter.texture);
        TextureReads {
            compares: self.shadows.iter().any(|filter| filter.is_of(texture)),
            at_pixel: self.loads.contains(&texture),
            others: groups.chain(filters).any(|[of, _]| *of == texture),
        }
    }

    /// True if all that a tree does, out of which these reads were taken, is to give the texels of
    /// the only one as its colour.
    pub(super) fn are_colors(&self, tree: &Tree) -> bool {
        let mut inputs = HashMap::new();
        for node in &tree.body {
            let Node::Op {
                op: Op::Input(at) | Op::InputMask(at),
                first,
            } = node
            else {
                return false;
            };
            inputs.insert(*first, tree.interface.inputs[*at as usize]);
        }
        let outputs = || tree.interface.outputs.iter().zip(&tree.outputs);
        let is_passed = |(output, value): (&Output, &Value)| {
            let expected = match *output {
                Output::Color {
                    target: 0,
                    component,
                } => Input::TextureRead { read: 0, component },
                Output::Cover => Input::Cover,
                _ => return false,
            };
            inputs.get(value) == Some(&expected)
        };
        let colors = outputs().filter(|(output, _)| **output != Output::Cover);
        self.of_read.len() == 1 && colors.count() == CHANNELS && outputs().all(is_passed)
    }

    /// The span of a read, and where a component is among those of a packet there.
    pub(super) fn place(&self, read: u32, component: u32) -> Option<(usize, usize)> {
        let (span, first) = *self.of_read.get(read as usize)?;
        Some((span, first + component as usize))
    }

    /// Where a span's first packet is among the results for so many packets, and the step to the
    /// next. Spans follow each other; in a span, the packets.
    pub(super) fn places(&self, span: usize, packets: usize) -> (usize, usize) {
        let span = self.spans.get(span);
        span.map_or((usize::MAX, 0), |span| {
            (span.before * packets, span.scalars)
        })
    }

    /// The scalars of all results for a packet.
    fn scalars(&self) -> usize {
        self.spans
            .last()
            .map_or(0, |last| last.before + last.scalars)
    }

    /// Makes all reads of a batch. Gives the texels, of which [`place`](Self::place) tells where
    /// they are, to `then`.
    pub(super) fn with_texels<T>(
        &self,
        sources: Sources<'_>,
        fragments: Fragments<'_>,
        then: impl FnOnce(&[Packet<f32>]) -> T,
    ) -> T {
        if self.of_read.is_empty() {
            return then(&[]);
        }
        let mut memory = MEMORY.take();
        let needed = self.scalars() * fragments.packets;
        let mut texels = std::mem::take(&mut memory.texels);
        if texels.len() < needed {
            texels.resize(needed, Packet::default());
        }
        self.sample(sources, fragments, &mut memory, &mut texels);
        let result = then(&texels);
        memory.texels = texels;
        MEMORY.set(memory);
        result
    }

    /// Makes the reads of a batch; the texels go where they are told.
    pub(super) fn sample_into(
        &self,
        sources: Sources<'_>,
        fragments: Fragments<'_>,
        texels: &mut [Packet<f32>],
    ) {
        let mut memory = MEMORY.take();
        self.sample(sources, fragments, &mut memory, texels);
        MEMORY.set(memory);
    }

    fn sample(
        &self,
        sources: Sources<'_>,
        fragments: Fragments<'_>,
        memory: &mut Memory,
        texels: &mut [Packet<f32>],
    ) {
        if memory.shifts.len() < self.filters.len() {
            memory
                .shifts
                .resize(self.filters.len(), TapShifts::UNSHIFTED);
        }
        self.uniforms.compute(sources, &mut memory.values);
        let textures = sources.textures;
        let Fragments {
            scalars,
            stride,
            packets,
            ..
        } = fragments;
        let compared: usize = self.shadows.iter().map(ShadowFilter::count).sum();
        let sampled = (self.scalars() - compared) * packets;
        let Some((texels, mut shares)) = texels.split_at_mut_checked(sampled) else {
            return;
        };
        for filter in &self.shadows {
            let count = packets * filter.count();
            let Some((shares_of_filter, others)) = shares.split_at_mut_checked(count) else {
                return;
            };
            shares = others;
            let of = (textures, &memory.values[..]);
            filter.compare(of, (scalars, stride), shares_of_filter);
        }
        let (mut left, _) = texels.as_chunks_mut::<CHANNELS>();
        for group in &self.groups {
            let count = packets * group.textures.len();
            let Some((texels, others)) = left.split_at_mut_checked(count) else {
                return;
            };
            left = others;
            group.sample(textures, (scalars, stride), texels);
        }
        for (filter, known) in self.filters.iter().zip(&mut memory.shifts) {
            let count = packets * filter.shifts.len();
            let Some((texels, others)) = left.split_at_mut_checked(count) else {
                return;
            };
            left = others;
            filter.sample((textures, &memory.values), known, (scalars, stride), texels);
        }
        if !self.loads.is_empty() {
            let (positions, _) = fragments.positions.as_chunks();
            textures.load_at_pixels(fragments.level, &self.loads, positions, left);
        }
    }
}

/// Packets that a texture is asked for together: those of most batches.
pub(super) const TOGETHER: usize = 16;
