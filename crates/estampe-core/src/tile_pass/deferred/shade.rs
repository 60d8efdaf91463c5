//! Shading a run: every sample once, by the triangle that it shows.
//!
//! A packet that shows one triangle is shaded whole; of others each triangle's quads are shaded in packets
//! that they share with those of other triangles and places. Where a triangle has one colour it is
//! shaded once.

use super::super::{TileItem, TileJob, TilePass, TileScratch};
use super::Deferred;
use crate::fragment::interpolate::{
    PlaneOrigin, TriangleSurface, VaryingPlanes, VaryingSource, set_planes,
};
use crate::fragment::quad::QUAD;
use crate::fragment::queue::{Needs, Shaded};
use crate::per_sample::codes::pack;
use crate::per_sample::depth::line_mut;
use crate::per_sample::owners::Owners;
use crate::per_sample::visibility::{ONLY_WIDE, SHADED};
use crate::raster::{Covered, MAX_PACKETS, packet_origin};
use crate::tiles::Plane;
use estampe_simd::{Bytes, LANES, Lanes, Select, SimdBase, dispatch, f32x16, i32x16, u32x16};
use estampe_types::Interpolation;

/// A triangle that is seen: what its fragments are made of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shown {
    origin: PlaneOrigin,
    z: Plane,
    iw: Plane,
    equal_w: bool,
    front: bool,
}

/// No place in `shown` yet.
pub(super) const NONE: u32 = u32::MAX;

/// Shades the run, if there is one, and ends it.
pub(in crate::tile_pass) fn shade_run<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    let Some(number) = scratch.deferred.item.take() else {
        scratch.deferred.visibility.slots.clear();
        scratch.deferred.row_codes.clear();
        scratch.deferred.row_count = 0;
        scratch.deferred.visibility.owners = Owners::default();
        return;
    };
    scratch.statistics.deferred_runs += 1;
    let item = &pass.items[number];
    let deferred = &mut scratch.deferred;
    deferred.shown.clear();
    deferred.planes.clear();
    deferred.codes.clear();
    deferred.shown_of.clear();
    deferred
        .shown_of
        .resize(deferred.visibility.slots.len(), NONE);
    deferred.quads.clear(deferred.visibility.slots.len());
    scratch.queue.configure(item.pipeline);
    let interface = item.pipeline.interface();
    let (x, y) = pass.grid.tile_origin(job.tile);
    let mut shading = Shading {
        pass,
        item,
        origin: [x.cast_signed(), y.cast_signed()],
        needs: Needs {
            position: interface.reads_position,
            depth: false,
            depth_range: item.depth_range,
        },
        modes: &interface.varyings,
        job,
        scratch,
    };
    if !shading.scratch.deferred.row_codes.is_empty() {
        dispatch!(@wide pass.level, s => shading.write_rows(s),
            scalar => unreachable!("{ONLY_WIDE}"));
    }
    if item.pipeline.key().uniform_over_primitive {
        shading.shade_uniform();
    } else {
        dispatch!(@wide pass.level, s => shading.packets(s),
            scalar => unreachable!("{ONLY_WIDE}"));
        if !shading.scratch.deferred.quads.triangles.is_empty() {
            dispatch!(@wide pass.level, s => shading.quads(s),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
        shading.flush();
    }
    let deferred = &mut scratch.deferred;
    deferred.row_codes.clear();
    deferred.row_count = 0;
    let visibility = &mut deferred.visibility;
    visibility.slots.clear();
    visibility.pending.fill([0; N]);
    visibility.owners = Owners::default();
}

pub(super) struct Shading<'a, 'j, 't, const N: usize> {
    pub(super) pass: &'a TilePass<'a>,
    pub(super) item: &'a TileItem<'a>,
    /// The tile's first pixel.
    pub(super) origin: [i32; 2],
    pub(super) needs: Needs,
    /// How each scalar of the varyings is interpolated.
    pub(super) modes: &'a [Interpolation],
    pub(super) job: &'j mut TileJob<'t>,
    pub(super) scratch: &'j mut TileScratch<N>,
}

impl<const N: usize> Shading<'_, '_, '_, N> {
    /// Puts the colours of fragments that are shaded already in the place of their numbers.
    #[inline(always)]
    fn write_rows<S: Lanes>(&mut self, s: S) {
        let Deferred {
            visibility,
            row_codes,
            ..
        } = &mut self.scratch.deferred;
        let codes = &row_codes[..];
        for (packet, pending) in visibility.pending.iter_mut().enumerate() {
            // Rows are for one sample a pixel.
            if pending[0] == 0 {
                continue;
            }
            let Some(line) = line_mut(self.job.colors[0], packet * N) else {
                continue;
            };
            let numbers = u32x16::load_array_ref(s, line);
            let signed: i32x16<S> = numbers.bitcast();
            let mask = s.sign_bits(signed) & pending[0];
            pending[0] &= !mask;
            let within = numbers & <u32x16<S> as SimdBase<S>>::splat(s, !SHADED);
            let colors = s.gather(codes, within);
            s.mask_from_bits(mask)
                .select(colors, numbers)
                .store_array(line);
        }
    }

    /// Queues everything that is seen.
    #[inline(always)]
    fn packets<S: Lanes>(&mut self, s: S) {
        for (place, packet) in (0..MAX_PACKETS).zip(0..) {
            let visibility = &self.scratch.deferred.visibility;
            let (mut pending, owner) = (
                visibility.pending[place],
                visibility.owners.of_packet(place),
            );
            if owner.is_some() {
                pending = [u16::MAX; N];
            }
            while pending != [0; N] {
                let (number, masks) = match owner {
                    Some(number) => (number, std::mem::replace(&mut pending, [0; N])),
                    None => self.next_seen(s, place, &mut pending),
                };
                let covered = Covered { packet, masks };
                self.queue(s, number, covered);
            }
        }
    }

    /// The first triangle that is seen in a packet's pending samples, and where; they are taken out.
    #[inline(always)]
    pub(super) fn next_seen<S: Lanes>(
        &self,
        s: S,
        packet: usize,
        pending: &mut [u16; N],
    ) -> (u32, [u16; N]) {
        let mut number = 0;
        for (sample, pending) in pending.iter().enumerate().rev() {
            if *pending != 0 {
                let at = (packet * N + sample) * LANES + pending.trailing_zeros() as usize;
                // Pending samples lie in the attachment, so there always is one.
                number = self.job.colors[0].get(at).copied().unwrap_or_default();
            }
        }
        let mut masks = [0; N];
        for (sample, (mask, pending)) in masks.iter_mut().zip(pending).enumerate() {
            if *pending != 0 {
                *mask = self.lanes_of(s, packet * N + sample, number) & *pending;
                *pending &= !*mask;
            }
        }
        (number, masks)
    }

    /// The lanes of a line of the first attachment that hold a number.
    #[inline(always)]
    pub(super) fn lanes_of<S: Lanes>(&self, s: S, line: usize, number: u32) -> u16 {
        let line = self.job.colors[0].get(line * LANES..(line + 1) * LANES);
        let Some(line) = line.and_then(|line| <&[u32; LANES]>::try_from(line).ok()) else {
            return u16::MAX;
        };
        let numbers = u32x16::load_array_ref(s, line);
        s.bits_of_mask(numbers.simd_eq(<u32x16<S> as SimdBase<S>>::splat(s, number)))
    }

    /// Queues a triangle's part of a packet if no quad of it is empty; otherwise notes its quads.
    #[inline(always)]
    fn queue<S: Lanes>(&mut self, s: S, number: u32, covered: Covered<N>) {
        let any = covered.any();
        let quads = (any | any >> 1 | any >> 2 | any >> 3) & 0x1111;
        if quads != 0x1111 {
            self.scratch.deferred.quads.add(number, covered, quads);
            return;
        }
        let shown = self.shown(s, number) as usize;
        let (x, y) = packet_origin(u32::from(covered.packet));
        let pixel = [self.origin[0] + x, self.origin[1] + y];
        if self.scratch.queue.is_full() {
            self.flush();
        }
        let TileScratch {
            queue, deferred, ..
        } = &mut *self.scratch;
        let (surface, front) = surface_of(deferred, (self.modes, self.item.all_smooth), shown);
        queue.push(s, &surface, (covered, pixel), front, self.needs);
    }

    /// Queues the quads that were noted, triangle by triangle.
    #[inline(always)]
    fn quads<S: Lanes>(&mut self, s: S) {
        for at in 0..self.scratch.deferred.quads.triangles.len() {
            let number = self.scratch.deferred.quads.triangles[at];
            let shown = self.shown(s, number) as usize;
            let mut next = self.scratch.deferred.quads.begin(number);
            while next != NONE {
                let (quads, count, rest) = self.scratch.deferred.quads.four(next, self.origin);
                next = rest;
                let style = (self.modes, self.item.all_smooth);
                if self.scratch.queue.is_full() {
                    self.flush();
                }
                let TileScratch {
                    queue, deferred, ..
                } = &mut *self.scratch;
                let (surface, front) = surface_of(deferred, style, shown);
                if queue.push_quads(s, &surface, &quads, (count, front), self.needs) {
                    continue;
                }
                for (at, quad) in quads.iter().enumerate().take(count) {
                    if self.scratch.queue.is_full_of_quads() {
                        self.flush();
                    }
                    let TileScratch {
                        queue, deferred, ..
                    } = &mut *self.scratch;
                    let (surface, front) = surface_of(deferred, style, shown);
                    queue.push_quad(s, &surface, (at, quad), front, self.needs);
                }
            }
        }
    }

    /// Where a triangle is in `shown`; its planes are made when it is first met.
    #[inline(always)]
    pub(super) fn shown<S: Lanes>(&mut self, s: S, number: u32) -> u32 {
        let deferred = &mut self.scratch.deferred;
        // Numbers are those of slots.
        let at = number as usize % deferred.shown_of.len().max(1);
        if deferred.shown_of[at] != NONE {
            return deferred.shown_of[at];
        }
        let slot = deferred.visibility.slots[at];
        let chunk = &self.pass.chunks[slot.chunk as usize];
        let (packet, lane) = (
            &chunk.triangles[slot.packet as usize],
            usize::from(slot.lane),
        );
        // Fewer than there are slots, whose numbers have 32 bits.
        let place = u32::try_from(deferred.shown.len()).unwrap_or(NONE);
        deferred.shown_of[at] = place;
        deferred.shown.push(Shown {
            origin: PlaneOrigin::new(packet, lane),
            z: packet.z.lane(lane),
            iw: packet.iw.lane(lane),
            equal_w: packet.equal_w >> lane & 1 == 1,
            front: packet.front >> lane & 1 == 1,
        });
        let from = deferred.planes.len();
        let size = VaryingPlanes::size(self.modes.len());
        deferred.planes.resize(from + size, 0.0);
        let source = VaryingSource {
            shaded: self.item.varyings,
            clipped: &chunk.clipped_varyings,
            modes: self.modes,
        };
        let planes = &mut deferred.planes[from..];
        set_planes(s, planes, (packet, lane), &source, self.item.all_smooth);
        place
    }

    /// Shades what is queued and writes it.
    fn flush(&mut self) {
        let queue = &mut self.scratch.queue;
        if queue.is_empty() {
            return;
        }
        let fragments = queue.shade(self.pass.level, self.item.pipeline, self.item.bindings);
        self.scratch.statistics.fragments_shaded += fragments;
        dispatch!(@wide self.pass.level, s => self.store(s),
            scalar => unreachable!("{ONLY_WIDE}"));
    }

    #[inline(always)]
    fn store<S: Lanes>(&mut self, s: S) {
        for shaded in self.scratch.queue.drain(false) {
            let targets = self.item.targets.iter().flatten().zip(&mut self.job.colors);
            for ((target, stored), colors) in targets.zip(shaded.colors.chunks_exact(4)) {
                let [r, g, b, a] = colors else { continue };
                let load =
                    |channel: &estampe_simd::Packet<f32>| f32x16::load_array_ref(s, &channel.0);
                let codes = pack(s, [load(r), load(g), load(b), load(a)], target.is_srgb());
                match shaded.places {
                    None => write_packet(s, codes, &shaded, stored),
                    Some(places) => write_quads(&codes.to_array(), places, &shaded, stored),
                }
            }
        }
    }
}

/// A triangle's surface, and whether it faces the viewer.
#[inline(always)]
pub(super) fn surface_of<'a, const N: usize>(
    deferred: &'a Deferred<N>,
    (modes, all_smooth): (&'a [Interpolation], bool),
    place: usize,
) -> (TriangleSurface<'a>, bool) {
    let shown = &deferred.shown[place];
    let size = VaryingPlanes::size(modes.len());
    let surface = TriangleSurface {
        origin: shown.origin,
        z: shown.z,
        iw: shown.iw,
        equal_w: shown.equal_w,
        planes: VaryingPlanes::new(&deferred.planes[place * size..][..size]),
        modes,
        all_smooth,
    };
    (surface, shown.front)
}

/// Writes the covered samples of one packet.
#[inline(always)]
fn write_packet<S: Lanes, const N: usize>(
    s: S,
    codes: u32x16<S>,
    shaded: &Shaded<'_, N>,
    stored: &mut [u32],
) {
    for (sample, &mask) in shaded.covered.masks.iter().enumerate() {
        if mask != 0
            && let Some(line) = line_mut(stored, usize::from(shaded.covered.packet) * N + sample)
        {
            let old = u32x16::load_array_ref(s, line);
            s.mask_from_bits(mask).select(codes, old).store_array(line);
        }
    }
}

/// Writes the covered samples of four quads, each to its place.
#[inline(always)]
fn write_quads<const N: usize>(
    codes: &[u32; LANES],
    places: [u16; LANES / QUAD],
    shaded: &Shaded<'_, N>,
    stored: &mut [u32],
) {
    for (quad, place) in places.into_iter().enumerate() {
        let (packet, inside) = (usize::from(place) / 4, usize::from(place) % 4);
        let codes = &codes[quad * QUAD..][..QUAD];
        for (sample, &mask) in shaded.covered.masks.iter().enumerate() {
            let from = (packet * N + sample) * LANES + inside * QUAD;
            let Some(line) = stored.get_mut(from..from + QUAD) else {
                continue;
            };
            let masks = &QUAD_MASKS[usize::from(mask >> (quad * QUAD)) % 16];
            for ((to, code), mask) in line.iter_mut().zip(codes).zip(masks) {
                *to = (*to & !mask) | (code & mask);
            }
        }
    }
}

/// For each mask of four lanes, all bits of the lanes that it has.
const QUAD_MASKS: [[u32; QUAD]; 16] = {
    let mut masks = [[0; QUAD]; 16];
    let mut at = 0;
    while at < 16 * QUAD {
        if (at / QUAD) >> (at % QUAD) & 1 == 1 {
            masks[at / QUAD][at % QUAD] = u32::MAX;
        }
        at += 1;
    }
    masks
};
