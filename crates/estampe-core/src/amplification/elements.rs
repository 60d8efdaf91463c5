//! The vertices of the patches and primitives of an amplified draw.
//!
//! *In* a draw · *Out* parts of it: the vertex and instance of each corner · *Spec* Vulkan
//! §Primitive Topologies, with all vertices of adjacency.

use crate::commands::Draw;
use crate::geometry::assembly::{elements_of, primitive_count, raw_index, vertex_index};
use estampe_types::state::PrimitiveTopology;
use std::ops::Range;

/// Some primitives of a draw.
#[derive(Debug, Default)]
pub(super) struct InputPart {
    /// Vertices of a primitive.
    pub(super) corners_each: usize,
    /// The index of each primitive's vertices.
    pub(super) vertices: Vec<u32>,
    /// The instance of each primitive.
    pub(super) instances: Vec<u32>,
    /// The number of each primitive in its instance.
    pub(super) numbers: Vec<u32>,
}

/// The position in a draw up to which its primitives are taken.
#[derive(Debug)]
pub(super) struct InputCursor<'a> {
    draw: &'a Draw<'a>,
    topology: PrimitiveTopology,
    /// Vertices of a primitive.
    corners_each: u32,
    instances: Range<u32>,
    /// Elements of an instance.
    elements: u32,
    /// The elements without a restart between them that are taken now.
    run: Range<u32>,
    /// The primitives of the run that are left.
    primitives: Range<u32>,
    /// The number of the next primitive in its instance.
    number: u32,
}

impl<'a> InputCursor<'a> {
    pub(super) fn new(draw: &'a Draw<'a>, corners_each: usize) -> Self {
        let elements = draw.elements.end.saturating_sub(draw.elements.start);
        let mut cursor = Self {
            draw,
            topology: draw.pipeline.descriptor().primitive.topology,
            // At most 32.
            corners_each: u32::try_from(corners_each).unwrap_or(u32::MAX),
            instances: draw.instances.clone(),
            elements,
            run: 0..0,
            primitives: 0..0,
            number: 0,
        };
        if elements == 0 {
            cursor.instances = 0..0;
        }
        if !cursor.instances.is_empty() {
            cursor.begin_run(0);
        }
        cursor
    }

    /// Takes the next primitives, at most `limit`; false if there are none left.
    pub(super) fn take(&mut self, limit: usize, part: &mut InputPart) -> bool {
        part.corners_each = self.corners_each as usize;
        part.vertices.clear();
        part.instances.clear();
        part.numbers.clear();
        while part.instances.len() < limit && !self.instances.is_empty() {
            match self.primitives.next() {
                Some(primitive) => {
                    let count = self.run.end - self.run.start;
                    for corner in 0..self.corners_each {
                        let element = self.element(primitive, corner, count);
                        part.vertices.push(self.vertex(self.run.start + element));
                    }
                    part.instances.push(self.instances.start);
                    part.numbers.push(self.number);
                    self.number += 1;
                }
                None if self.run.end < self.elements => self.begin_run(self.run.end + 1),
                None => {
                    self.instances.start += 1;
                    self.number = 0;
                    self.begin_run(0);
                }
            }
        }
        !part.instances.is_empty()
    }

    /// Finds the elements from `start` on up to the next restart.
    fn begin_run(&mut self, start: u32) {
        let restarts = self.draw.pipeline.descriptor().primitive.primitive_restart;
        let mut end = self.elements;
        if let Some((buffer, format)) = self.draw.indices.filter(|_| restarts) {
            let first = self.draw.elements.start as usize;
            // Indices beyond the buffer's end are zero, and restart nothing.
            let stored = buffer.len_bytes().saturating_sub(first);
            let searched = u32::try_from(stored).unwrap_or(u32::MAX).min(self.elements);
            let restart = (start..searched)
                .find(|at| raw_index(buffer, format, first + *at as usize) == format.restart());
            end = restart.unwrap_or(self.elements);
        }
        self.run = start.min(end)..end;
        let count = end - self.run.start;
        let primitives = match self.topology {
            PrimitiveTopology::PatchList => count / self.corners_each,
            topology => primitive_count(topology, count),
        };
        self.primitives = 0..primitives;
    }

    /// The element of a corner of a primitive in a run of `count` elements.
    fn element(&self, p: u32, corner: u32, count: u32) -> u32 {
        use PrimitiveTopology as T;
        match self.topology {
            T::PatchList | T::LineListAdjacency | T::TriangleListAdjacency => {
                p * self.corners_each + corner
            }
            T::LineStripAdjacency => p + corner,
            T::TriangleStripAdjacency => strip_with_adjacency(p, count)[corner as usize % 6],
            topology => elements_of(topology, p, count)[corner as usize % 3],
        }
    }

    fn vertex(&self, element: u32) -> u32 {
        let at = self.draw.elements.start.saturating_add(element);
        match self.draw.indices {
            Some((buffer, format)) => {
                vertex_index(buffer, format, at as usize, self.draw.base_vertex)
            }
            None => at,
        }
    }
}

/// The six elements of triangle `p` of a strip of `count` elements: its corners, and between two of
/// them the vertex opposite that edge.
fn strip_with_adjacency(p: u32, count: u32) -> [u32; 6] {
    let first = p * 2;
    let is_last = p + 1 == primitive_count(PrimitiveTopology::TriangleStripAdjacency, count);
    let before = if p == 0 { 1 } else { first - 1 };
    let ahead = if is_last { first + 5 } else { first + 6 };
    let beside = first + 3;
    if p.is_multiple_of(2) {
        [first, before, first + 2, ahead, first + 4, beside]
    } else {
        [first, beside, first + 4, ahead, first + 2, before]
    }
}
