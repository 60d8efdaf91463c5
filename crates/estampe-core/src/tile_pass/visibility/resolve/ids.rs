//! The ids of a tile, read: the triangle that a sample shows, and the samples that show it.

use super::{IdStorage, Resolver, ShadingGroup, TileJob};
use estampe_simd::{LANES, Lanes, SimdBase, u32x16};

/// The ids of a tile.
#[inline(always)]
pub(super) fn ids_of<'a>(
    storage: IdStorage,
    job: &'a TileJob<'_>,
    buffer: &'a [[u32; LANES]],
) -> &'a [[u32; LANES]] {
    if storage == IdStorage::Attachment {
        job.colors[0]
    } else {
        buffer
    }
}

/// The lanes whose ids belong to a group.
#[inline(always)]
pub(super) fn lanes_in<S: Lanes>(s: S, ids: u32x16<S>, group: &ShadingGroup) -> u16 {
    let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
    let inside = ids.simd_ge(splat(group.ids.start)) & ids.simd_lt(splat(group.ids.end));
    s.bits_of_mask(inside)
}

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Returns the index of the line that stores the IDs of a packet's sample.
    #[inline(always)]
    pub(super) fn line_of(&self, packet: usize, sample: usize) -> usize {
        packet * self.samples.count() + sample
    }

    /// The lanes of a line of ids that belong to a group.
    #[inline(always)]
    pub(super) fn lanes_in<S: Lanes>(&self, s: S, line: usize, group: &ShadingGroup) -> u16 {
        lanes_in(s, u32x16::load_array_ref(s, &self.ids()[line]), group)
    }

    /// The lanes of a line of ids that hold an id.
    #[inline(always)]
    pub(super) fn lanes_of<S: Lanes>(&self, s: S, line: usize, id: u32) -> u16 {
        let ids = u32x16::load_array_ref(s, &self.ids()[line]);
        s.bits_of_mask(ids.simd_eq(<u32x16<S> as SimdBase<S>>::splat(s, id)))
    }

    #[inline(always)]
    fn ids(&self) -> &[[u32; LANES]] {
        ids_of(self.storage, self.job, &self.scratch.visibility.buffer.ids)
    }

    /// The id at the first of some samples of a packet; there must be one.
    #[inline(always)]
    pub(super) fn first_id(&self, packet: usize, samples: &[u16; N]) -> u32 {
        let mut id = 0;
        for (sample, lanes) in samples.iter().enumerate().rev() {
            if *lanes != 0 {
                id = self.ids()[self.line_of(packet, sample)]
                    [lanes.trailing_zeros() as usize % LANES];
            }
        }
        id
    }

    /// Takes the samples of a packet that show the group's triangles.
    #[inline(always)]
    pub(super) fn take_unresolved<S: Lanes>(
        &mut self,
        s: S,
        packet: usize,
        group: &ShadingGroup,
    ) -> [u16; N] {
        let mut taken = self.scratch.visibility.buffer.unresolved[packet];
        if self.is_only_group {
            self.scratch.visibility.buffer.unresolved[packet] = [0; N];
            return taken;
        }
        for (sample, taken) in taken.iter_mut().enumerate() {
            if *taken != 0 {
                *taken &= self.lanes_in(s, self.line_of(packet, sample), group);
            }
        }
        let unresolved = &mut self.scratch.visibility.buffer.unresolved[packet];
        for (unresolved, taken) in unresolved.iter_mut().zip(taken) {
            *unresolved &= !taken;
        }
        taken
    }

    /// The first triangle that some samples of a packet show, and where; these are taken out.
    #[inline(always)]
    pub(super) fn take_first<S: Lanes>(
        &self,
        s: S,
        packet: usize,
        left: &mut [u16; N],
    ) -> (u32, [u16; N]) {
        let id = self.first_id(packet, left);
        let mut masks = [0; N];
        for (sample, (mask, left)) in masks.iter_mut().zip(left).enumerate() {
            if *left != 0 {
                *mask = self.lanes_of(s, self.line_of(packet, sample), id) & *left;
                *left &= !*mask;
            }
        }
        (id, masks)
    }
}
