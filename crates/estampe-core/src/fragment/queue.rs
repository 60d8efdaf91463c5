//! Packets of fragments that wait to be shaded together.

use super::interpolate::{Surface, TriangleSurface};
use super::quad::QUAD;
use crate::pipeline::RenderPipeline;
use crate::raster::Covered;
use estampe_simd::{LANES, Lanes, Level, Packet, SimdBase, f32x16};
use estampe_types::shader::DepthOutput;
use estampe_types::{Bindings, FragmentBatch};

/// Packets that are shaded in one call.
pub(crate) const CAPACITY: usize = 16;

/// Quads of a packet.
const QUADS: usize = LANES / QUAD;

/// A quad of a triangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct QuadPlace<const N: usize> {
    /// Packet·4 + quad.
    pub(crate) place: u16,
    /// By sample, in the lowest four bits.
    pub(crate) masks: [u16; N],
    /// Its first pixel in the target.
    pub(crate) pixel: [i32; 2],
}

/// Where a queued packet came from.
#[derive(Debug, Clone, Copy)]
struct Queued<const N: usize> {
    /// Packet of the tile, and by lane the samples that are covered.
    covered: Covered<N>,
    /// Where its four quads belong (packet·4 + quad), if they do not belong to one packet.
    places: Option<[u16; QUADS]>,
}

/// Shader inputs and outputs of up to [`CAPACITY`] packets, structure of arrays.
#[derive(Debug)]
pub(crate) struct FragmentQueue<const N: usize> {
    len: usize,
    scalars: usize,
    targets: usize,
    /// Whether colours are the varyings' first four scalars.
    passes_color: bool,
    queued: [Queued<N>; CAPACITY],
    /// The packet that is being filled with quads, and how many it has.
    open: Option<(usize, usize)>,
    varyings: Vec<Packet<f32>>,
    /// The same of quads that are not queued yet.
    spare: Vec<Packet<f32>>,
    positions: [[Packet<f32>; 4]; CAPACITY],
    front_facing: [u16; CAPACITY],
    coverage: [u16; CAPACITY],
    /// Depths of each sample, where depth is tested after shading.
    depths: [[Packet<f32>; N]; CAPACITY],
    colors: Vec<Packet<f32>>,
    depth_out: [Packet<f32>; CAPACITY],
}

impl<const N: usize> Default for FragmentQueue<N> {
    fn default() -> Self {
        let covered = Covered {
            packet: 0,
            masks: [0; N],
        };
        Self {
            len: 0,
            scalars: 0,
            targets: 0,
            passes_color: false,
            queued: [Queued {
                covered,
                places: None,
            }; CAPACITY],
            open: None,
            varyings: Vec::new(),
            spare: Vec::new(),
            positions: [[Packet::default(); 4]; CAPACITY],
            front_facing: [0; CAPACITY],
            coverage: [0; CAPACITY],
            depths: [[Packet::default(); N]; CAPACITY],
            colors: Vec::new(),
            depth_out: [Packet::default(); CAPACITY],
        }
    }
}

/// A shaded packet.
#[derive(Debug)]
pub(crate) struct Shaded<'a, const N: usize> {
    /// Packet of the tile, and its samples that are covered and not discarded.
    pub(crate) covered: Covered<N>,
    /// Where its quads belong (packet·4 + quad), if they are of several packets.
    pub(crate) places: Option<[u16; QUADS]>,
    /// R, G, B, A of each target.
    pub(crate) colors: &'a [Packet<f32>],
    /// Depth of each sample, where depth is tested after shading.
    pub(crate) depths: &'a [Packet<f32>; N],
    /// The shader's depth, where it gives one.
    pub(crate) depth_out: Option<&'a Packet<f32>>,
}

impl<const N: usize> FragmentQueue<N> {
    /// Gets ready for a pipeline's packets. The queue must be empty.
    pub(crate) fn configure(&mut self, pipeline: &RenderPipeline) {
        let interface = pipeline.interface();
        debug_assert_eq!(self.len, 0, "packets of another pipeline are still queued");
        self.scalars = interface.varyings.len();
        self.targets = interface.color_targets;
        self.passes_color = pipeline.key().passes_color;
        self.varyings
            .resize(self.scalars * CAPACITY, Packet::default());
        self.spare.resize(self.scalars, Packet::default());
        self.colors
            .resize(self.targets * 4 * CAPACITY, Packet::default());
    }

    #[inline(always)]
    pub(crate) fn is_full(&self) -> bool {
        self.len >= CAPACITY
    }

    /// Whether another quad finds no place.
    #[inline(always)]
    pub(crate) fn is_full_of_quads(&self) -> bool {
        self.is_full() && self.open.is_none_or(|(_, quads)| quads >= QUADS)
    }

    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Queues a packet of a primitive at the target's pixel (x, y).
    #[inline(always)]
    pub(crate) fn push<S: Lanes>(
        &mut self,
        s: S,
        surface: &impl Surface<S>,
        (covered, pixel): (Covered<N>, [i32; 2]),
        front: bool,
        needs: Needs,
    ) {
        let depth_range = needs.depth_range;
        let slot = self.len % CAPACITY;
        self.queued[slot] = Queued {
            covered,
            places: None,
        };
        self.coverage[slot] = covered.any();
        self.front_facing[slot] = if front { u16::MAX } else { 0 };
        let out = &mut self.varyings[slot * self.scalars..][..self.scalars];
        if !out.is_empty() {
            surface.varyings(s, pixel, out);
        }
        if needs.position {
            let [x, y, z, w] = &mut self.positions[slot];
            let lanes = |base: i32, lanes: &[u8; 16]| {
                let mut centers = [0.0; 16];
                for (center, lane) in centers.iter_mut().zip(lanes) {
                    *center = (base + i32::from(*lane)) as f32 + 0.5;
                }
                centers
            };
            x.0 = lanes(pixel[0], &estampe_simd::LANE_X);
            y.0 = lanes(pixel[1], &estampe_simd::LANE_Y);
            let depth = clamp_depth(s, surface.depth(s, pixel, [0.5; 2]), depth_range);
            depth.store_array(&mut z.0);
            surface.inverse_w(s, pixel).store_array(&mut w.0);
        }
        if needs.depth {
            for (depth, [sx, sy]) in self.depths[slot].iter_mut().zip(sample_offsets::<N>()) {
                let value = surface.depth(s, pixel, [sx, sy]);
                clamp_depth(s, value, depth_range).store_array(&mut depth.0);
            }
        }
        self.len += 1;
    }

    /// Interpolates up to four quads of a triangle, for [`FragmentQueue::push_quad`] or, if there are four, as
    /// a packet of their own: then they are queued, and it says so.
    #[inline(always)]
    pub(crate) fn push_quads<S: Lanes>(
        &mut self,
        s: S,
        surface: &TriangleSurface<'_>,
        quads: &[QuadPlace<N>; QUADS],
        (count, front): (usize, bool),
        needs: Needs,
    ) -> bool {
        let [a, b, c, d] = quads;
        let pixels = [a.pixel, b.pixel, c.pixel, d.pixel];
        let distances = surface.distances_of_quads(s, pixels);
        if count < QUADS {
            surface.varyings_at(s, distances, &mut self.spare);
            return false;
        }
        let slot = self.len % CAPACITY;
        self.len += 1;
        let mut masks = [0; N];
        for (quad, from) in quads.iter().enumerate() {
            for (mask, of_quad) in masks.iter_mut().zip(from.masks) {
                *mask |= of_quad << (quad * QUAD);
            }
        }
        let covered = Covered { packet: 0, masks };
        self.coverage[slot] = covered.any();
        self.front_facing[slot] = if front { u16::MAX } else { 0 };
        self.queued[slot] = Queued {
            covered,
            places: Some([a.place, b.place, c.place, d.place]),
        };
        let out = &mut self.varyings[slot * self.scalars..][..self.scalars];
        surface.varyings_at(s, distances, out);
        if needs.position {
            let out = &mut self.positions[slot];
            for (quad, from) in quads.iter().enumerate() {
                surface.quad_position(s, from.pixel, quad, needs.depth_range, out);
            }
        }
        true
    }

    /// Queues a quad, the `at`-th of those that were interpolated last, into a packet that it shares with
    /// others. The queue must not be [full of quads](FragmentQueue::is_full_of_quads).
    #[inline(always)]
    pub(crate) fn push_quad<S: Lanes>(
        &mut self,
        s: S,
        surface: &TriangleSurface<'_>,
        (at, from): (usize, &QuadPlace<N>),
        front: bool,
        needs: Needs,
    ) {
        let (slot, quad) = match self.open {
            Some((slot, quad)) if quad < QUADS => (slot % CAPACITY, quad),
            _ => {
                let slot = self.len % CAPACITY;
                self.len += 1;
                self.queued[slot] = Queued {
                    covered: Covered {
                        packet: 0,
                        masks: [0; N],
                    },
                    places: Some([from.place; QUADS]),
                };
                (self.coverage[slot], self.front_facing[slot]) = (0, 0);
                (slot, 0)
            }
        };
        self.open = Some((slot, quad + 1));
        let shift = quad * QUAD;
        let queued = &mut self.queued[slot];
        if let Some(places) = &mut queued.places {
            places[quad] = from.place;
        }
        let mut any = 0;
        for (to, mask) in queued.covered.masks.iter_mut().zip(from.masks) {
            *to |= mask << shift;
            any |= mask << shift;
        }
        self.coverage[slot] |= any;
        if front {
            self.front_facing[slot] |= 0xF << shift;
        }
        let out = &mut self.varyings[slot * self.scalars..][..self.scalars];
        let at = at % QUADS * QUAD;
        for (to, from) in out.iter_mut().zip(&self.spare) {
            to.0[shift..shift + QUAD].copy_from_slice(&from.0[at..at + QUAD]);
        }
        if needs.position {
            let out = &mut self.positions[slot];
            surface.quad_position(s, from.pixel, quad, needs.depth_range, out);
        }
    }

    /// Queues a packet whose lanes are fragments of several triangles; gives where its varyings go.
    #[inline(always)]
    pub(crate) fn push_row(&mut self, lanes: u16, front: u16) -> &mut [Packet<f32>] {
        let slot = self.len % CAPACITY;
        self.len += 1;
        let covered = Covered {
            packet: 0,
            masks: [lanes; N],
        };
        self.queued[slot] = Queued {
            covered,
            places: None,
        };
        (self.coverage[slot], self.front_facing[slot]) = (lanes, front);
        &mut self.varyings[slot * self.scalars..][..self.scalars]
    }

    /// Runs the program over what is queued, and says how many fragments that were.
    pub(crate) fn shade(
        &mut self,
        level: Level,
        pipeline: &RenderPipeline,
        bindings: &Bindings,
    ) -> u64 {
        let len = self.len.min(CAPACITY);
        let interface = pipeline.interface();
        let fragments = self.coverage[..len]
            .iter()
            .map(|mask| u64::from(mask.count_ones()))
            .sum();
        if self.passes_color {
            return fragments;
        }
        let positions = if interface.reads_position { len * 4 } else { 0 };
        let depths = if interface.depth_output == DepthOutput::None {
            0
        } else {
            len
        };
        pipeline.program().run_fragments(
            level,
            bindings,
            FragmentBatch {
                varyings: &self.varyings[..len * self.scalars],
                positions: &self.positions.as_flattened()[..positions],
                front_facing: &self.front_facing[..len],
                coverage: &mut self.coverage[..len],
                colors: &mut self.colors[..len * self.targets * 4],
                depths: &mut self.depth_out[..depths],
                ..FragmentBatch::default()
            },
        );
        fragments
    }

    /// Multiplies every colour's alpha by a factor for each of the packets that are queued.
    pub(crate) fn scale_alpha(&mut self, factors: impl Fn(u16) -> Packet<f32>) {
        let len = self.len.min(CAPACITY);
        for (slot, queued) in self.queued[..len].iter().enumerate() {
            let factors = factors(queued.covered.packet);
            let colors = &mut self.colors[slot * self.targets * 4..][..self.targets * 4];
            for color in colors.as_chunks_mut::<4>().0 {
                for (alpha, factor) in color[3].0.iter_mut().zip(factors.0) {
                    *alpha *= factor;
                }
            }
        }
    }

    /// The shaded packets in order; the queue is empty afterwards.
    #[inline(always)]
    pub(crate) fn drain(&mut self, has_depth_out: bool) -> impl Iterator<Item = Shaded<'_, N>> {
        let len = std::mem::take(&mut self.len).min(CAPACITY);
        self.open = None;
        let this = &*self;
        (0..len).map(move |slot| {
            let mut covered = this.queued[slot].covered;
            covered
                .masks
                .iter_mut()
                .for_each(|mask| *mask &= this.coverage[slot]);
            Shaded {
                covered,
                places: this.queued[slot].places,
                colors: if this.passes_color {
                    &this.varyings[slot * this.scalars..][..4]
                } else {
                    &this.colors[slot * this.targets * 4..][..this.targets * 4]
                },
                depths: &this.depths[slot],
                depth_out: has_depth_out.then_some(&this.depth_out[slot]),
            }
        })
    }
}

/// What a queued packet must bring besides varyings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Needs {
    /// The window position.
    pub(crate) position: bool,
    /// The depth of each sample.
    pub(crate) depth: bool,
    /// The range that depth is clamped to.
    pub(crate) depth_range: [f32; 2],
}

/// The samples' offsets in their pixel, in pixels.
#[inline(always)]
pub(crate) fn sample_offsets<const N: usize>() -> [[f32; 2]; N] {
    let mut offsets = [[0.5; 2]; N];
    for (offset, [x, y]) in offsets
        .iter_mut()
        .zip(crate::raster::sample_positions::<N>())
    {
        *offset = [x as f32 * (1.0 / 256.0), y as f32 * (1.0 / 256.0)];
    }
    offsets
}

/// Depth confined to the viewport's range; NaN becomes its lower end.
#[inline(always)]
pub(crate) fn clamp_depth<S: Lanes>(s: S, depth: f32x16<S>, [low, high]: [f32; 2]) -> f32x16<S> {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    s.min_f32(s.max_f32(depth, splat(low)), splat(high))
}
