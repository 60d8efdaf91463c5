//! Primitive restart (V2): the greatest index of a format ends a strip, fan, loop or list and
//! begins another.
//!
//! *In* an index buffer, a run of its elements · *Out* the vertices of each primitive · *Spec*
//! Vulkan §Primitive Topologies, `primitiveRestartEnable` and
//! `VK_EXT_primitive_topology_list_restart`.
//!
//! A primitive is written out when the element that completes it is met, so that a draw is cut
//! anywhere, also within a fan, and memory is bounded by the cut.

use super::assembly::{corners_of, primitive_count, raw_index};
use estampe_types::state::{PrimitiveTopology, ProvokingVertex};
use estampe_types::{BufferData, IndexFormat};

/// The position in a draw's elements at which the search for the next primitive begins.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RestartCursor {
    /// The next element, counted from the draw's first one.
    next: u32,
    /// The first element of the run that `next` belongs to, counted from the draw's first one.
    run_start: u32,
}

/// The indexed elements of a draw.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RestartSource<'a> {
    pub(crate) topology: PrimitiveTopology,
    pub(crate) provoking: ProvokingVertex,
    pub(crate) buffer: &'a BufferData,
    pub(crate) format: IndexFormat,
    pub(crate) base_vertex: i32,
    /// The first element, and how many there are.
    pub(crate) elements: [u32; 2],
}

impl RestartCursor {
    /// Returns true if no element has been examined yet.
    pub(crate) fn is_at_start(self) -> bool {
        self.next == 0
    }

    /// Returns true if all elements have been examined.
    pub(crate) fn is_done(self, source: &RestartSource<'_>) -> bool {
        self.next >= source.elements[1]
    }

    /// The vertices of the next primitives, as many as `limit` or few more; `begins` gets the
    /// numbers of those that are a run's first.
    pub(crate) fn take(
        &mut self,
        source: &RestartSource<'_>,
        limit: u32,
        begins: &mut Vec<u32>,
    ) -> Vec<[u32; 3]> {
        let mut corners = Vec::new();
        // Most of the elements may be restarts.
        let end = source.elements[1].min(self.next.saturating_add(limit.saturating_mul(4)));
        while self.next < end && corners.len() < limit as usize {
            let element = self.next;
            self.next += 1;
            if source.raw(element) == source.format.restart() {
                self.close_loop(source, element, &mut corners);
                self.run_start = self.next;
                continue;
            }
            let vertices = element - self.run_start;
            let count = |vertices| match source.topology {
                // Until its run ends a loop is a strip.
                PrimitiveTopology::LineLoop => {
                    primitive_count(PrimitiveTopology::LineStrip, vertices)
                }
                topology => primitive_count(topology, vertices),
            };
            let number = count(vertices);
            if count(vertices + 1) > number {
                if number == 0 {
                    begins.push(number_of(&corners));
                }
                // One more than there are, so that no loop is closed here.
                let elements = vertices + 2;
                let of_run = corners_of(source.topology, source.provoking, number, elements);
                corners.push(of_run.map(|element| source.vertex(self.run_start + element)));
            }
        }
        if self.is_done(source) {
            self.close_loop(source, self.next, &mut corners);
        }
        corners
    }

    /// The line from a loop's last vertex, the one before `end`, to its first.
    fn close_loop(self, source: &RestartSource<'_>, end: u32, corners: &mut Vec<[u32; 3]>) {
        let vertices = end - self.run_start;
        if source.topology == PrimitiveTopology::LineLoop && vertices >= 2 {
            let of_run = corners_of(source.topology, source.provoking, vertices - 1, vertices);
            corners.push(of_run.map(|element| source.vertex(self.run_start + element)));
        }
    }
}

/// The number of the primitive that is next in a list, which has at most one for each element of a
/// draw.
fn number_of(corners: &[[u32; 3]]) -> u32 {
    debug_assert!(u32::try_from(corners.len()).is_ok());
    u32::try_from(corners.len()).unwrap_or(u32::MAX)
}

impl RestartSource<'_> {
    fn raw(&self, element: u32) -> u32 {
        let at = self.elements[0] as usize + element as usize;
        raw_index(self.buffer, self.format, at)
    }

    fn vertex(&self, element: u32) -> u32 {
        self.raw(element).wrapping_add_signed(self.base_vertex)
    }
}
