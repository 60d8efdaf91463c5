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
//! So are samples at uniform shifts from varyings, which are [filters](super::taps), and
//! [loads at the pixel itself](super::pixel_loads).
//!
//! Only samples in the outermost body are taken, which every invocation makes. They are numbered by
//! groups: those of a group are at the same place, or are the taps of one filter; the loads are the
//! last group.

use super::batch::Widths;
use super::pixel_loads;
use super::read_place::{MOST, Place, Read, found};
use super::taps::{Filter, Shift};
use super::textures::BoundTextures;
use super::uniforms::{Finder, Sources, Uniforms};
use estampe_ir::interface::{Input, Interface, Output};
use estampe_ir::tree::{Node, Tree, passes};
use estampe_ir::{Op, Value};
use estampe_simd::{Level, Packet};
use estampe_texture::{PacketLod, PacketRequest, SampledTexture, TapShifts};
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
    /// The shifts of filters.
    uniforms: Uniforms,
    /// For each group, each filter, and then the loads, if there are any: the number of its first
    /// read, and how many it has.
    spans: Vec<[usize; 2]>,
    /// For each read, the number of its span and its place there.
    of_read: Vec<(usize, usize)>,
}

/// Reads at the same place.
#[derive(Debug)]
struct Group {
    place: Place,
    /// The positions in the interface of each read's texture and sampler.
    textures: Vec<[u32; 2]>,
}

impl Reads {
    /// Takes the reads out of a tree of the fragment stage. `gradients` lists the scalars of the
    /// varyings that have derivatives, in ascending order.
    pub(super) fn take(tree: &mut Tree, widths: Widths, gradients: &[usize]) -> Self {
        let found = found(tree, widths, gradients);
        let loads = pixel_loads::found(tree, MOST - found.len());
        if found.is_empty() && loads.is_empty() {
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
        reads.uniforms = uniforms.finish();
        let groups = reads.groups.iter().map(|group| group.textures.len());
        let filters = reads.filters.iter().map(|filter| filter.shifts.len());
        let loaded = Some(loads.len()).filter(|count| *count > 0);
        for (span, count) in groups.chain(filters).chain(loaded).enumerate() {
            reads.spans.push([reads.of_read.len(), count]);
            reads.of_read.extend((0..count).map(|at| (span, at)));
        }
        let mut numbers: HashMap<Value, usize> = HashMap::new();
        for (read, (is_tap, (group, at))) in found.iter().zip(places) {
            let before = if is_tap { reads.groups.len() } else { 0 };
            let [first, _] = reads.spans[before + group];
            numbers.insert(read.first, first + at);
        }
        let first_load = reads.of_read.len() - loads.len();
        numbers.extend((loads.iter().map(|load| load.first)).zip(first_load..));
        let body = std::mem::take(&mut tree.body);
        tree.body = with_inputs(&mut tree.interface, body, &numbers);
        passes::dead_code(tree);
        passes::unused_inputs(tree);
        reads
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
            });
            self.filters.len() - 1
        });
        let taps = &mut self.filters[filter].shifts;
        taps.push(shifts);
        (filter, taps.len() - 1)
    }

    /// The number of reads.
    pub(super) fn count(&self) -> usize {
        self.of_read.len()
    }

    /// True if one of them is of the texture at this position in the interface.
    pub(super) fn are_of(&self, texture: u32) -> bool {
        let groups = self.groups.iter().flat_map(|group| &group.textures);
        let filters = self.filters.iter().map(|filter| &filter.texture);
        groups.chain(filters).any(|[of, _]| *of == texture) || self.loads.contains(&texture)
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
        let (span, at) = *self.of_read.get(read as usize)?;
        Some((span, at * CHANNELS + component as usize))
    }

    /// Where a span's first packet is among the texels of so many packets, and the step to the
    /// next. Spans follow each other; in a span, the packets.
    pub(super) fn places(&self, span: usize, packets: usize) -> (usize, usize) {
        let Some([first, count]) = self.spans.get(span) else {
            return (usize::MAX, 0);
        };
        (first * packets * CHANNELS, count * CHANNELS)
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
        let needed = self.of_read.len() * fragments.packets * CHANNELS;
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

fn clear(texel: &mut [Packet<f32>; CHANNELS]) {
    *texel = [Packet::default(); CHANNELS];
}

impl Group {
    fn sample(
        &self,
        textures: &BoundTextures<'_>,
        (scalars, stride): (&[Packet<f32>], usize),
        texels: &mut [[Packet<f32>; CHANNELS]],
    ) {
        let each = self.textures.len();
        let mut sampled = [None; MOST];
        for (to, [texture, sampler]) in sampled.iter_mut().zip(&self.textures) {
            *to = textures.sampled(*texture, *sampler);
        }
        let sampled = &sampled[..each.min(MOST)];
        if let (Some((places, lod)), Some(first)) = (self.place.flat(scalars, stride), sampled[0]) {
            let mut all = [first; MOST];
            let mut known = all.iter_mut().zip(sampled);
            let are_known = known.all(|(to, one)| one.map(|one| *to = one).is_some());
            let is_common = are_known
                && lod != PacketLod::Level
                && SampledTexture::sample_places(&all[..each], &places, texels);
            if is_common {
                return;
            }
            if each == 1
                && lod != PacketLod::Gradients
                && first.sample_shifted(lod, &places, &TapShifts::UNSHIFTED, texels)
            {
                return;
            }
        }
        let mut packets = scalars.chunks_exact(stride.max(1));
        for texels in texels.chunks_mut(TOGETHER * each) {
            let mut requests = [PacketRequest::ZEROS; TOGETHER];
            let mut count = 0;
            for (asked, scalars) in requests.iter_mut().zip(&mut packets) {
                self.place.ask(scalars, asked);
                count += 1;
            }
            for (texture, first) in sampled.iter().zip(0..) {
                let Some(texels) = texels.get_mut(first..) else {
                    break;
                };
                match texture {
                    Some(texture) => {
                        texture.sample_requests(&requests[..count], texels, each);
                    }
                    None => texels.iter_mut().step_by(each).for_each(clear),
                }
            }
        }
    }
}

/// A body in which reads, whose numbers are given by their first results, are inputs.
fn with_inputs(
    interface: &mut Interface,
    body: Vec<Node>,
    numbers: &HashMap<Value, usize>,
) -> Vec<Node> {
    let mut nodes = Vec::with_capacity(body.len());
    for node in body {
        match node {
            Node::Op { first, .. } if numbers.contains_key(&first) => {
                push_inputs((interface, &mut nodes), numbers[&first], first);
            }
            Node::Block {
                label,
                results,
                body,
            } => nodes.push(Node::Block {
                label,
                results,
                body: with_inputs(interface, body, numbers),
            }),
            node => nodes.push(node),
        }
    }
    nodes
}

/// Reads a read's texel: inputs in place of the results of the sample.
fn push_inputs((interface, nodes): (&mut Interface, &mut Vec<Node>), read: usize, first: Value) {
    let number = |count: usize| u32::try_from(count).expect("a tree of fewer than 2^32 values");
    let Interface { inputs, .. } = interface;
    for (component, first) in (0..).zip(first.and_next(CHANNELS)) {
        let op = Op::Input(number(inputs.len()));
        inputs.push(Input::TextureRead {
            read: number(read),
            component,
        });
        nodes.push(Node::Op { op, first });
    }
}
