//! Shading groups in a tile: the group of each triangle, and the packets that show each group.

use super::{Resolver, ShadingGroup};
use crate::raster::MAX_PACKETS;
use estampe_simd::Lanes;

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Lists the group of each triangle.
    pub(super) fn number_groups(&mut self, groups: &[ShadingGroup]) {
        self.is_only_group = groups.len() == 1;
        let group_of = &mut self.scratch.visibility.resolve.group_of;
        group_of.clear();
        if !self.is_only_group {
            for (number, group) in (0..).zip(groups) {
                group_of.resize(group.ids.end as usize, number);
            }
        }
    }

    /// The number of a triangle's group.
    #[inline(always)]
    pub(super) fn group_of(&self, id: u32) -> usize {
        if self.is_only_group {
            return 0;
        }
        self.scratch.visibility.resolve.group_of[id as usize] as usize
    }

    /// Finds the packets that show triangles of each group.
    #[inline(always)]
    pub(super) fn find_packets<S: Lanes>(&mut self, s: S, groups: &[ShadingGroup]) {
        let mut sets = std::mem::take(&mut self.scratch.visibility.resolve.packets);
        sets.clear();
        if self.is_only_group {
            sets.push([u64::MAX; MAX_PACKETS / 64]);
        } else {
            sets.resize(groups.len(), [0; MAX_PACKETS / 64]);
            for packet in 0..MAX_PACKETS {
                let buffer = &self.scratch.visibility.buffer;
                let mut add = |id: u32| {
                    let group = self.group_of(id);
                    sets[group][packet / 64] |= 1 << (packet % 64);
                    group
                };
                if let Some(id) = buffer.single.of_packet(packet) {
                    add(id);
                    continue;
                }
                let mut left = buffer.unresolved[packet];
                while left != [0; N] {
                    let id = self.first_id(packet, &left);
                    let group = &groups[add(id)];
                    for (sample, left) in left.iter_mut().enumerate() {
                        if *left != 0 {
                            *left &= !self.lanes_in(s, self.line_of(packet, sample), group);
                        }
                    }
                }
            }
        }
        self.scratch.visibility.resolve.packets = sets;
    }
}
