//! Packets of fragments that wait to be shaded together.
//!
//! *In* coverage and interpolants of primitives · *Out* a [`ShadedBatch`] · *Space* window.
//!
//! A packet is sixteen pixels of one primitive, or four quads of any primitives that share a
//! pipeline, or, of shaders without derivatives, sixteen pixels of different small triangles.

mod block;
mod capacity;
mod pixels;
mod quads;
mod shaded;
mod shared;
mod survivors;

use capacity::CAPACITY;

pub(crate) use block::TriangleBlock;
pub(crate) use capacity::{packets_of_call, packets_of_visibility};
pub(crate) use pixels::PixelPacket;
pub(crate) use quads::QuadPlace;
pub(crate) use shaded::{LatePacket, ShadedBatch, depth_after_shading};
pub(crate) use shared::replace;
pub(crate) use survivors::Survivors;

use super::centroid::{centroids, covered_bits};
use super::interpolate::{Interpolant, PixelOffsets};
use super::place::Place;
use crate::depth_format::clamp_depth;
use crate::pipeline::RenderPipeline;
use crate::raster::{Covered, SampleSet};
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, Level, Packet, SimdBase, outline};
use estampe_types::shader::{DepthOutput, Sampling};
use estampe_types::{Bindings, FragmentBatch};

/// A packet of one primitive to be queued.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PrimitivePacket<const N: usize> {
    /// The samples that are covered and have passed the tests so far.
    pub(crate) alive: Covered<N>,
    /// The samples that are covered, before any test.
    pub(crate) covered: [u16; N],
    /// The packet's first pixel in the target.
    pub(crate) pixel: [i32; 2],
    pub(crate) front: bool,
    /// The sample that is shaded, where shading is by sample.
    pub(crate) sample: Option<u8>,
}

/// Shader inputs and outputs of up to [`CAPACITY`] packets, structure of arrays.
#[derive(Debug)]
pub(crate) struct FragmentQueue<const N: usize> {
    samples: SampleSet<N>,
    /// Packets that are shaded in one call, [`CAPACITY`] at most.
    room: usize,
    len: usize,
    /// The packets that the program is run for: fewer than are queued, where some share their
    /// colours.
    shaded_len: usize,
    /// By packet: where the program's inputs and outputs are.
    shaded_of: [u8; CAPACITY],
    scalars: usize,
    targets: usize,
    /// Colours of a fragment: its targets', and the second one.
    colors_each: usize,
    /// True if colours are the varyings' first four scalars.
    color_passthrough: bool,
    depth_output: DepthOutput,
    /// The sampling of each scalar; empty if all are sampled at the centre.
    sampling: Vec<Sampling>,
    needs: Needs,
    places: [Place; CAPACITY],
    /// By packet and sample: the covered lanes; after shading those that the shader kept.
    masks: [[u16; N]; CAPACITY],
    /// The sample that each packet is shaded for, where shading is by sample.
    sample_of: [Option<u8>; CAPACITY],
    /// The packet that is being filled with quads, and how many it has.
    open: Option<(usize, usize)>,
    /// The packet that is being filled with pixels, and how many it has.
    open_pixels: Option<(usize, usize)>,
    varyings: Vec<Packet<f32>>,
    /// Varyings that are not queued yet: of quads, or at centroids.
    spare: Vec<Packet<f32>>,
    /// Window positions and each sample's depths of quads that are not queued yet.
    spare_position: [Packet<f32>; 4],
    spare_depths: [Packet<f32>; N],
    positions: [[Packet<f32>; 4]; CAPACITY],
    front_facing: [u16; CAPACITY],
    sample_index: Vec<u32>,
    samples_covered: Vec<Packet<u32>>,
    coverage: [u16; CAPACITY],
    /// By packet and sample: depths, where tests come after shading.
    depths: Vec<Packet<f32>>,
    colors: Vec<Packet<f32>>,
    depth_out: [Packet<f32>; CAPACITY],
    sample_masks: Vec<Packet<u32>>,
}

/// Inputs and outputs that a program has besides varyings and colours.
#[derive(Debug, Clone, Copy, Default)]
struct Needs {
    position: bool,
    sample_index: bool,
    coverage: bool,
    sample_mask: bool,
    /// True if the depth of each sample is kept for tests after shading.
    depth: bool,
    /// The range that depth is clamped to.
    depth_range: [f32; 2],
}

impl<const N: usize> Default for FragmentQueue<N> {
    fn default() -> Self {
        Self {
            samples: SampleSet::new(N),
            room: CAPACITY,
            len: 0,
            shaded_len: 0,
            shaded_of: [0; CAPACITY],
            scalars: 0,
            targets: 0,
            colors_each: 0,
            color_passthrough: false,
            depth_output: DepthOutput::None,
            sampling: Vec::new(),
            needs: Needs::default(),
            places: [const { Place::Packet(0) }; CAPACITY],
            masks: [[0; N]; CAPACITY],
            sample_of: [None; CAPACITY],
            open: None,
            open_pixels: None,
            varyings: Vec::new(),
            spare: Vec::new(),
            spare_position: [Packet::default(); 4],
            spare_depths: [Packet::default(); N],
            positions: [[Packet::default(); 4]; CAPACITY],
            front_facing: [0; CAPACITY],
            sample_index: Vec::new(),
            samples_covered: Vec::new(),
            coverage: [0; CAPACITY],
            depths: Vec::new(),
            colors: Vec::new(),
            depth_out: [Packet::default(); CAPACITY],
            sample_masks: Vec::new(),
        }
    }
}

impl<const N: usize> FragmentQueue<N> {
    /// Gets ready for a pipeline's packets, of which `room` are shaded in one call. The queue must
    /// be empty. `tests_late` says that samples are tested after shading, so that their depths are
    /// kept.
    pub(crate) fn configure(
        &mut self,
        pipeline: &RenderPipeline,
        samples: SampleSet<N>,
        depth_range: [f32; 2],
        (tests_late, room): (bool, usize),
    ) {
        let interface = pipeline.interface();
        debug_assert_eq!(self.len, 0, "packets of another pipeline are still queued");
        self.samples = samples;
        self.room = room;
        self.open = None;
        self.open_pixels = None;
        self.scalars = interface.fragment_scalars();
        self.targets = interface.color_targets;
        self.colors_each = interface.colors();
        self.color_passthrough = pipeline.key().color_passthrough;
        self.depth_output = interface.depth_output;
        self.sampling.clear();
        if samples.count() > 1 && interface.sampling.contains(&Sampling::Centroid) {
            self.sampling.extend(&interface.sampling);
            // A program of a caller's own may list fewer or more than it has.
            self.sampling
                .resize(interface.varyings.len(), Sampling::Center);
            // Derivatives are those at the place of the varying.
            for _axis in 0..2 {
                let of_gradients = interface
                    .gradients
                    .iter()
                    .map(|&scalar| self.sampling[scalar]);
                let of_gradients: Vec<_> = of_gradients.collect();
                self.sampling.extend(of_gradients);
            }
        }
        self.needs = Needs {
            position: interface.reads_position,
            sample_index: interface.per_sample,
            coverage: interface.reads_coverage,
            sample_mask: interface.writes_sample_mask,
            depth: tests_late,
            depth_range,
        };
        let zero = Packet::default();
        let of = |needed: bool, each: usize| if needed { each * CAPACITY } else { 0 };
        // What they held before may stay, so that pipelines in turns clear nothing.
        grow(&mut self.varyings, self.scalars * CAPACITY);
        grow(&mut self.colors, self.colors_each * 4 * CAPACITY);
        self.spare.resize(self.scalars, zero);
        self.sample_index.resize(of(self.needs.sample_index, 1), 0);
        self.samples_covered
            .resize(of(self.needs.coverage, 1), Packet::default());
        self.depths.resize(of(tests_late, N), zero);
        self.sample_masks
            .resize(of(self.needs.sample_mask, 1), Packet::default());
    }

    #[inline(always)]
    pub(crate) fn is_full(&self) -> bool {
        self.len >= self.room
    }

    /// Returns true if there is no room for another quad.
    #[inline(always)]
    pub(crate) fn is_full_of_quads(&self) -> bool {
        self.is_full() && self.begins_with_next_quad()
    }

    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The places of the queued packets, and the lanes of which a sample is covered.
    #[inline(always)]
    pub(crate) fn queued(&self) -> impl Iterator<Item = (&Place, u16)> {
        let packets = self.places.iter().zip(&self.masks);
        let packets = packets.take(self.len.min(CAPACITY));
        packets.map(|(place, masks)| (place, masks.iter().fold(0, |any, mask| any | mask)))
    }

    /// Takes the next slot, for packets at a place; gives its number, and where the program's
    /// inputs go.
    #[inline(always)]
    fn begin(&mut self, place: Place, masks: [u16; N], front: u16) -> (usize, usize) {
        let shaded = self.shaded_len % CAPACITY;
        self.shaded_len += 1;
        let slot = self.take_slot(place, masks, shaded);
        self.coverage[shaded] = masks.iter().fold(0, |any, mask| any | mask);
        self.front_facing[shaded] = front;
        (slot, shaded)
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "below CAPACITY")]
    fn take_slot(&mut self, place: Place, masks: [u16; N], shaded: usize) -> usize {
        debug_assert!(self.len < CAPACITY, "a full queue is shaded first");
        let slot = self.len % CAPACITY;
        self.len += 1;
        self.places[slot] = place;
        self.masks[slot] = masks;
        self.sample_of[slot] = None;
        self.shaded_of[slot] = shaded as u8;
        slot
    }

    /// Where a packet's inputs and outputs of the program are.
    #[inline(always)]
    fn shaded(&self, slot: usize) -> usize {
        usize::from(self.shaded_of[slot]) % CAPACITY
    }

    /// Queues a packet of a primitive.
    #[inline(always)]
    pub(crate) fn push<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl Interpolant<S>,
        packet: &PrimitivePacket<N>,
    ) {
        outline!(s, {
            let (pixel, sample) = (packet.pixel, packet.sample);
            let front = if packet.front { u16::MAX } else { 0 };
            let place = Place::Packet(packet.alive.packet);
            let (slot, shaded) = self.begin(place, packet.alive.masks, front);
            let mut at = [0.5; 2];
            if let Some(sample) = sample {
                let number = usize::from(sample) % N;
                self.sample_of[slot] = Some(sample);
                self.coverage[shaded] = packet.alive.masks[number];
                at = self.samples.offsets()[number];
            }
            let out = &mut self.varyings[shaded * self.scalars..][..self.scalars];
            if sample.is_some() {
                if !out.is_empty() {
                    interpolant.varyings_in(s, pixel, &PixelOffsets::all(at), out);
                }
            } else {
                if !out.is_empty() {
                    interpolant.varyings(s, pixel, out);
                }
                if !self.sampling.is_empty() {
                    let places = centroids(&packet.covered, self.samples);
                    interpolant.varyings_in(s, pixel, &places, &mut self.spare);
                    for ((out, spare), sampling) in
                        out.iter_mut().zip(&self.spare).zip(&self.sampling)
                    {
                        if *sampling == Sampling::Centroid {
                            *out = *spare;
                        }
                    }
                }
            }
            if self.needs.position {
                let [x, y, z, w] = &mut self.positions[shaded];
                let lanes = |base: i32, lanes: &[u8; LANES], offset: f32| {
                    let mut places = [0.0; LANES];
                    for (place, lane) in places.iter_mut().zip(lanes) {
                        *place = (base + i32::from(*lane)) as f32 + offset;
                    }
                    places
                };
                x.0 = lanes(pixel[0], &LANE_X, at[0]);
                y.0 = lanes(pixel[1], &LANE_Y, at[1]);
                let depth = interpolant.depth(s, pixel, at);
                clamp_depth(s, depth, self.needs.depth_range).store_array(&mut z.0);
                let inverse_w = if sample.is_some() {
                    interpolant.inverse_w_at(s, pixel, &PixelOffsets::all(at))
                } else {
                    interpolant.inverse_w(s, pixel)
                };
                inverse_w.store_array(&mut w.0);
            }
            if self.needs.sample_index {
                self.sample_index[shaded] = sample.map_or(0, u32::from);
            }
            if self.needs.coverage {
                self.samples_covered[shaded] = covered_bits(&packet.covered, sample);
            }
            if self.needs.depth {
                let depths = &mut self.depths[slot * N..][..self.samples.count()];
                for (depth, offset) in depths.iter_mut().zip(self.samples.offsets()) {
                    let value = interpolant.depth(s, pixel, offset);
                    clamp_depth(s, value, self.needs.depth_range).store_array(&mut depth.0);
                }
            }
        })
    }

    /// Queues a packet whose lanes are fragments of several triangles; gives where its varyings go.
    #[inline(always)]
    pub(crate) fn push_across_triangles(&mut self, lanes: u16, front: u16) -> &mut [Packet<f32>] {
        let (_, shaded) = self.begin(Place::Packet(0), [lanes; N], front);
        &mut self.varyings[shaded * self.scalars..][..self.scalars]
    }

    /// Adds fragments to the packet that was queued last across triangles, in lanes that it does
    /// not use yet; gives where its varyings are.
    #[inline(always)]
    pub(crate) fn join_across_triangles(&mut self, lanes: u16, front: u16) -> &mut [Packet<f32>] {
        debug_assert!(self.len != 0, "there is no packet to join");
        let slot = self.len.wrapping_sub(1) % CAPACITY;
        let shaded = self.shaded(slot);
        for mask in &mut self.masks[slot] {
            *mask |= lanes;
        }
        self.coverage[shaded] |= lanes;
        self.front_facing[shaded] |= front;
        &mut self.varyings[shaded * self.scalars..][..self.scalars]
    }

    /// Runs the program over the queued packets. Returns how many fragments that were.
    pub(crate) fn shade(
        &mut self,
        level: Level,
        pipeline: &RenderPipeline,
        bindings: &Bindings,
    ) -> u64 {
        let len = self.shaded_len.min(CAPACITY);
        let run: u64 = self.coverage[..len]
            .iter()
            .map(|mask| u64::from(mask.count_ones()))
            .sum();
        if !self.color_passthrough {
            let of = |needed: bool, each: usize| if needed { len * each } else { 0 };
            let writes_depth = self.depth_output != DepthOutput::None;
            pipeline.program().run_fragments(
                level,
                bindings,
                FragmentBatch {
                    varyings: &self.varyings[..len * self.scalars],
                    positions: &self.positions.as_flattened()[..of(self.needs.position, 4)],
                    front_facing: &self.front_facing[..len],
                    sample_index: &self.sample_index[..of(self.needs.sample_index, 1)],
                    samples_covered: &self.samples_covered[..of(self.needs.coverage, 1)],
                    coverage: &mut self.coverage[..len],
                    colors: &mut self.colors[..len * self.colors_each * 4],
                    depths: &mut self.depth_out[..of(writes_depth, 1)],
                    sample_masks: &mut self.sample_masks[..of(self.needs.sample_mask, 1)],
                },
            );
            self.keep_shaded();
        }
        run
    }

    /// Drops the samples that the shader discarded, and those that a packet is not shaded for.
    fn keep_shaded(&mut self) {
        let packets = self.masks.iter_mut().zip(&self.shaded_of);
        let packets = packets.zip(&self.sample_of).take(self.len.min(CAPACITY));
        for ((masks, shaded), sample_of) in packets {
            let coverage = self.coverage[usize::from(*shaded) % CAPACITY];
            for (sample, mask) in masks.iter_mut().enumerate() {
                let is_shaded = sample_of.is_none_or(|of| usize::from(of) == sample);
                *mask &= if is_shaded { coverage } else { 0 };
            }
        }
    }

    /// Multiplies every target's alpha by a factor for each pixel of the queued packets.
    pub(crate) fn scale_alpha(&mut self, factors: impl Fn(u16) -> Packet<f32>) {
        let len = self.len.min(CAPACITY);
        for (slot, place) in self.places[..len].iter().enumerate() {
            let Place::Packet(packet) = *place else {
                unreachable!("lines are queued by packets");
            };
            let factors = factors(packet);
            let from = usize::from(self.shaded_of[slot]) * self.colors_each * 4;
            let colors = &mut self.colors[from..][..self.targets * 4];
            for color in colors.as_chunks_mut::<4>().0 {
                for (alpha, factor) in color[3].0.iter_mut().zip(factors.0) {
                    *alpha *= factor;
                }
            }
        }
    }

    /// Forgets the packets.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.len = 0;
        self.shaded_len = 0;
        self.open = None;
        self.open_pixels = None;
    }
}

/// Makes room for so many packets.
fn grow(packets: &mut Vec<Packet<f32>>, count: usize) {
    if packets.len() < count {
        packets.resize(count, Packet::default());
    }
}
