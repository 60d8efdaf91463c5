//! Groups of primitives: the primitives of a run, assembled sixteen at a time.
//!
//! *In* a range of primitives, counted over all instances · *Out* the vertices of each.
//!
//! A group of triangles spans instances: a glyph or sprite is an instance of two triangles, and
//! eight of them fill sixteen lanes.

use super::assembly::ElementSource;
use super::shading::PACKET;
use estampe_simd::LANES;

/// The primitives of a run, instances one after the other.
#[derive(Debug)]
pub(crate) struct PrimitiveGroups<'a> {
    elements: &'a ElementSource<'a>,
    instance: InstanceSize,
    /// The next primitive, counted in its instance.
    local: u32,
    /// The first vertex of that instance.
    base: u32,
    /// Primitives that are left.
    left: u32,
    /// The vertices of the first instance's primitives, if a group spans several.
    pattern: [[u32; 3]; LANES],
    has_pattern: bool,
}

/// The size of one instance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InstanceSize {
    pub(crate) vertices: u32,
    /// Not 0.
    pub(crate) primitives: u32,
}

impl<'a> PrimitiveGroups<'a> {
    /// Groups of the primitives from `from` up to `to`, counted over all instances.
    pub(crate) fn new(
        elements: &'a ElementSource<'a>,
        instance: InstanceSize,
        [from, to]: [u32; 2],
    ) -> Self {
        let (turn, local) = if from < instance.primitives {
            (0, from)
        } else {
            (from / instance.primitives, from % instance.primitives)
        };
        let mut pattern = [[0; 3]; LANES];
        let left = to - from;
        let has_pattern = instance.primitives < PACKET && left > instance.primitives;
        if has_pattern {
            elements.assemble(0, 0, &mut pattern[..instance.primitives as usize]);
        }
        Self {
            elements,
            instance,
            local,
            base: turn * instance.vertices,
            left,
            has_pattern,
            pattern,
        }
    }

    /// Assembles the next group and says how many primitives it has, none at the end. Lanes beyond
    /// repeat the first.
    #[inline(always)]
    pub(crate) fn next_group(&mut self, out: &mut [[u32; 3]; LANES]) -> Option<usize> {
        let count = self.left.min(PACKET) as usize;
        let first = self.next_of_instance(out)?;
        let mut done = first.count;
        while done < count {
            done += self.next_of_instance(&mut out[done..])?.count;
        }
        if done < LANES {
            let first = out[0];
            out[done..].fill(first);
        }
        Some(done)
    }

    /// Assembles the next primitives of one instance, as many as `out` holds; none at the end.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a group has at most sixteen"
    )]
    pub(crate) fn next_of_instance(&mut self, out: &mut [[u32; 3]]) -> Option<InstanceGroup> {
        let count = self.left.min(self.instance.primitives - self.local);
        let count = (count as usize).min(out.len());
        if count == 0 {
            return None;
        }
        let (first, out) = (self.local, &mut out[..count]);
        if self.has_pattern {
            let pattern = &self.pattern[first as usize..][..count];
            for (vertices, pattern) in out.iter_mut().zip(pattern) {
                for (vertex, pattern) in vertices.iter_mut().zip(pattern) {
                    *vertex = pattern.wrapping_add(self.base);
                }
            }
        } else {
            self.elements.assemble(first, self.base, out);
        }
        let taken = count as u32;
        self.left -= taken;
        self.local += taken;
        if self.local == self.instance.primitives {
            self.local = 0;
            self.base = self.base.wrapping_add(self.instance.vertices);
        }
        Some(InstanceGroup { first, count })
    }
}

/// Primitives of one instance that were assembled together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct InstanceGroup {
    /// The first one, counted in the instance.
    pub(crate) first: u32,
    pub(crate) count: usize,
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_types::state::{PrimitiveTopology, ProvokingVertex};

    #[test]
    fn a_group_spans_instances_and_a_group_of_an_instance_does_not() {
        for primitives in [1, 2, 5, 16, 23] {
            let elements = ElementSource {
                topology: PrimitiveTopology::TriangleList,
                provoking: ProvokingVertex::First,
                restarted: None,
                elements: primitives * 3,
                indices: None,
                first_element: 0,
                first_vertex: 0,
                base_vertex: 0,
            };
            let vertices = primitives * 3 + 1;
            let instance = InstanceSize {
                vertices,
                primitives,
            };
            let range = [primitives / 2, primitives * 9 + primitives / 2];
            let expected: Vec<[u32; 3]> = (range[0]..range[1])
                .map(|p| {
                    let first = p % primitives * 3 + p / primitives * vertices;
                    [first, first + 1, first + 2]
                })
                .collect();

            let mut groups = PrimitiveGroups::new(&elements, instance, range);
            let (mut found, mut out) = (Vec::new(), [[0; 3]; LANES]);
            while let Some(count) = groups.next_group(&mut out) {
                assert!(count == LANES || found.len() + count == expected.len());
                assert!(out[count..].iter().all(|lane| *lane == out[0]));
                found.extend_from_slice(&out[..count]);
            }
            assert_eq!(found, expected, "{primitives}");

            let mut groups = PrimitiveGroups::new(&elements, instance, range);
            let mut found = Vec::new();
            while let Some(group) = groups.next_of_instance(&mut out) {
                assert!(group.first as usize + group.count <= primitives as usize);
                found.extend_from_slice(&out[..group.count]);
            }
            assert_eq!(found, expected, "{primitives}");
        }
    }
}
