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
//! Only samples in the outermost body are taken, which every invocation makes. They are numbered by
//! groups: those of a group are at the same place.

use super::batch::Widths;
use super::textures::BoundTextures;
use estampe_ir::interface::{Input, Interface};
use estampe_ir::op::{Axis, LevelOfDetail, TextureOp, TextureQuery};
use estampe_ir::tree::{Node, Tree, passes};
use estampe_ir::{Op, Value};
use estampe_simd::{Packet, words_of};
use estampe_texture::{PacketLod, PacketPlaces, PacketRequest, SampledTexture};
use std::cell::Cell;
use std::collections::HashMap;

/// The most reads of a stage: the texels of sixteen packets, 4 kB for each read, stay in the first
/// cache. Other samples stay in the code.
const MOST: usize = 8;

/// The channels of a texel.
const CHANNELS: usize = 4;

thread_local! {
    /// The memory of the texels of the last batch.
    static TEXELS: Cell<Vec<Packet<f32>>> = Cell::default();
}

/// The reads of a stage.
#[derive(Debug, Default)]
pub(super) struct Reads {
    groups: Vec<Group>,
    /// For each read, the first one of its group and the number of them there.
    of_read: Vec<(usize, usize)>,
}

/// Reads at the same place.
#[derive(Debug)]
struct Group {
    place: Place,
    /// The positions in the interface of each read's texture and sampler.
    textures: Vec<[u32; 2]>,
}

/// The scalars of a fragment's varyings, derivatives after them, that a read's operands are.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Place {
    coordinates: Vec<usize>,
    layer: Option<usize>,
    level: Level,
    offset: [i32; 3],
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Level {
    /// The base level.
    Zero,
    /// That of the quad.
    Implicit,
    /// That of the derivatives along x, then along y.
    Gradients([Vec<usize>; 2]),
}

impl Reads {
    /// Takes the reads out of a tree of the fragment stage. `gradients` lists the scalars of the
    /// varyings that have derivatives, in ascending order.
    pub(super) fn take(tree: &mut Tree, widths: Widths, gradients: &[usize]) -> Self {
        let scalars = scalars(tree, widths, gradients);
        let mut reads = Self::default();
        // The group of each read and its place there.
        let mut found: HashMap<Value, (usize, usize)> = HashMap::new();
        for node in &tree.body {
            if let Node::Op {
                op: Op::Texture(op),
                first,
            } = node
                && found.len() < MOST
                && let Some(place) = place(tree, op, &scalars)
                && let Some(sampler) = op.sampler
            {
                let read = reads.add(place, [op.texture, sampler]);
                found.insert(*first, read);
            }
        }
        let mut firsts = Vec::new();
        for group in &reads.groups {
            let first = reads.of_read.len();
            firsts.push(first);
            let count = group.textures.len();
            reads
                .of_read
                .extend(std::iter::repeat_n((first, count), count));
        }
        let body = std::mem::take(&mut tree.body);
        for node in body {
            match node {
                Node::Op { first, .. } if found.contains_key(&first) => {
                    let (group, at) = found[&first];
                    push_inputs(tree, firsts[group] + at, first);
                }
                node => tree.body.push(node),
            }
        }
        if !found.is_empty() {
            passes::dead_code(tree);
            passes::unused_inputs(tree);
        }
        reads
    }

    /// Adds a read; its group and its place there.
    fn add(&mut self, place: Place, texture: [u32; 2]) -> (usize, usize) {
        let group = self.groups.iter().position(|group| group.place == place);
        let group = group.unwrap_or_else(|| {
            let textures = Vec::new();
            self.groups.push(Group { place, textures });
            self.groups.len() - 1
        });
        let textures = &mut self.groups[group].textures;
        textures.push(texture);
        (group, textures.len() - 1)
    }

    /// The number of reads.
    pub(super) fn count(&self) -> usize {
        self.of_read.len()
    }

    /// True if one of them is of the texture at this position in the interface.
    pub(super) fn are_of(&self, texture: u32) -> bool {
        let mut textures = self.groups.iter().flat_map(|group| &group.textures);
        textures.any(|[of, _]| *of == texture)
    }

    /// Where a component of a read is among the texels of so many packets: its first packet, and
    /// the step to the next.
    pub(super) fn place(&self, read: u32, component: u32, packets: usize) -> (usize, usize) {
        let Some(&(first, count)) = self.of_read.get(read as usize) else {
            return (usize::MAX, 0);
        };
        // Groups follow each other; in a group, the packets.
        let in_group = (read as usize - first) * CHANNELS + component as usize;
        (first * packets * CHANNELS + in_group, count * CHANNELS)
    }

    /// Makes all reads of so many packets, each of which has `stride` scalars. Gives the texels, of
    /// which [`place`](Self::place) tells where they are, to `then`.
    pub(super) fn with_texels<T>(
        &self,
        textures: &BoundTextures<'_>,
        (scalars, stride, packets): (&[Packet<f32>], usize, usize),
        then: impl FnOnce(&[Packet<f32>]) -> T,
    ) -> T {
        if self.groups.is_empty() {
            return then(&[]);
        }
        let mut texels = TEXELS.take();
        let needed = self.of_read.len() * packets * CHANNELS;
        if texels.len() < needed {
            texels.resize(needed, Packet::default());
        }
        self.sample(textures, (scalars, stride, packets), &mut texels);
        let result = then(&texels);
        TEXELS.set(texels);
        result
    }

    fn sample(
        &self,
        textures: &BoundTextures<'_>,
        (scalars, stride, packets): (&[Packet<f32>], usize, usize),
        texels: &mut [Packet<f32>],
    ) {
        let (mut left, _) = texels.as_chunks_mut::<CHANNELS>();
        for group in &self.groups {
            let count = packets * group.textures.len();
            let Some((texels, others)) = left.split_at_mut_checked(count) else {
                return;
            };
            left = others;
            group.sample(textures, (scalars, stride), texels);
        }
    }
}

/// Packets that a texture is asked for together: those of most batches.
const TOGETHER: usize = 16;

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
            if each == 1 && lod != PacketLod::Gradients && first.sample_batch(lod, &places, texels)
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

impl Place {
    /// Two coordinates, and where the level of detail comes from, if the place is no more.
    fn flat<'a>(
        &self,
        scalars: &'a [Packet<f32>],
        stride: usize,
    ) -> Option<(PacketPlaces<'a>, PacketLod)> {
        let &[u, v] = &self.coordinates[..] else {
            return None;
        };
        let (gradients, lod) = match &self.level {
            Level::Zero => (None, PacketLod::Level),
            Level::Implicit => (None, PacketLod::Implicit),
            Level::Gradients([x, y]) => match (&x[..], &y[..]) {
                (&[ux, vx], &[uy, vy]) => (Some([ux, vx, uy, vy]), PacketLod::Gradients),
                _ => return None,
            },
        };
        let is_plain = self.layer.is_none() && self.offset == [0; 3];
        let places = PacketPlaces {
            scalars,
            stride,
            at: [u, v],
            gradients,
        };
        is_plain.then_some((places, lod))
    }

    /// Sets what a packet with these scalars asks for, in a request of zeros.
    #[inline]
    fn ask<'a>(&self, scalars: &'a [Packet<f32>], asked: &mut PacketRequest<'a>) {
        for (to, scalar) in asked.at.iter_mut().zip(&self.coordinates) {
            *to = &scalars[*scalar];
        }
        asked.offset = self.offset;
        if let Some(layer) = self.layer {
            asked.layer = &words_of(scalars)[layer];
        }
        match &self.level {
            Level::Zero => asked.lod = PacketLod::Level,
            Level::Implicit => {}
            Level::Gradients(axes) => {
                asked.lod = PacketLod::Gradients;
                for (along, axis) in asked.gradients.chunks_mut(3).zip(axes) {
                    for (to, scalar) in along.iter_mut().zip(axis) {
                        *to = &scalars[*scalar];
                    }
                }
            }
        }
    }
}

/// The values of a tree's outermost body that are scalars of the fragment's varyings or their
/// derivatives.
fn scalars(tree: &Tree, widths: Widths, gradients: &[usize]) -> HashMap<Value, usize> {
    let scalar = |node: &Node| {
        let Node::Op {
            op: Op::Input(at),
            first,
        } = node
        else {
            return None;
        };
        let input = tree.interface.inputs.get(*at as usize)?;
        Some((*first, scalar_of(*input, widths, gradients)?))
    };
    tree.body.iter().filter_map(scalar).collect()
}

/// The scalar of the fragments' varyings, derivatives after them, that an input is.
pub(super) fn scalar_of(input: Input, widths: Widths, gradients: &[usize]) -> Option<usize> {
    match input {
        Input::Varying(scalar) => Some(scalar as usize),
        Input::Derivative { scalar, axis } => {
            let first = match axis {
                Axis::X => widths.varyings,
                Axis::Y => widths.varyings + gradients.len(),
            };
            Some(first + gradients.binary_search(&(scalar as usize)).ok()?)
        }
        _ => None,
    }
}

/// The place of a sample, if its operands are scalars.
fn place(tree: &Tree, op: &TextureOp, scalars: &HashMap<Value, usize>) -> Option<Place> {
    let of = |value: &Value| scalars.get(value).copied();
    let all = |values: &[Value]| values.iter().map(of).collect::<Option<Vec<_>>>();
    let runs_everywhere = || {
        let is_all = |node: &Node| matches!(node, Node::Op { op: Op::MaskConstant(true), first } if *first == op.mask);
        tree.body.iter().any(is_all)
    };
    if op.query != TextureQuery::Sample || op.coordinates.len() > 3 {
        return None;
    }
    Some(Place {
        coordinates: all(&op.coordinates)?,
        layer: match &op.layer {
            Some(layer) => Some(of(layer)?),
            None => None,
        },
        level: match &op.level {
            LevelOfDetail::Zero => Level::Zero,
            LevelOfDetail::Implicit if runs_everywhere() => Level::Implicit,
            LevelOfDetail::Gradient { x, y } => Level::Gradients([all(x)?, all(y)?]),
            _ => return None,
        },
        offset: op.offset,
    })
}

/// Reads a read's texel: inputs in place of the results of the sample.
fn push_inputs(tree: &mut Tree, read: usize, first: Value) {
    let number = |count: usize| u32::try_from(count).expect("a tree of fewer than 2^32 values");
    let Interface { inputs, .. } = &mut tree.interface;
    for (component, first) in (0..).zip(first.and_next(CHANNELS)) {
        let op = Op::Input(number(inputs.len()));
        inputs.push(Input::TextureRead {
            read: number(read),
            component,
        });
        tree.body.push(Node::Op { op, first });
    }
}
