//! Parts of packets that show several triangles, sorted by triangle: which samples show it.
//!
//! A list for each triangle, linked through one array.

use super::resolve::NONE;
use crate::raster::Covered;

/// A part, and the one of the same triangle that was added before it.
#[derive(Debug, Clone, Copy)]
struct Part<const N: usize> {
    before: u32,
    covered: Covered<N>,
}

/// Parts by triangle.
#[derive(Debug)]
pub(super) struct Parts<const N: usize> {
    parts: Vec<Part<N>>,
    /// By visibility id: the triangle's last part.
    last: Vec<u32>,
}

impl<const N: usize> Default for Parts<N> {
    fn default() -> Self {
        Self {
            parts: Vec::new(),
            last: Vec::new(),
        }
    }
}

impl<const N: usize> Parts<N> {
    /// Begins a run of so many triangles.
    pub(super) fn begin_run(&mut self, triangles: usize) {
        self.begin_group();
        self.last.clear();
        self.last.resize(triangles, NONE);
    }

    /// Forgets the parts of the triangles before.
    pub(super) fn begin_group(&mut self) {
        self.parts.clear();
    }

    /// Returns true if no triangle of the group has parts.
    pub(super) fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Adds a triangle's part of a packet.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "at most one for each sample of a tile"
    )]
    pub(super) fn add(&mut self, id: u32, covered: Covered<N>) {
        let Some(last) = self.last.get_mut(id as usize) else {
            return;
        };
        let before = std::mem::replace(last, self.parts.len() as u32);
        self.parts.push(Part { before, covered });
    }

    /// Takes a triangle's parts: the number of the last one.
    #[inline(always)]
    pub(super) fn begin(&self, id: u32) -> u32 {
        self.last.get(id as usize).copied().unwrap_or(NONE)
    }

    /// A part, and the number of the next one to take.
    #[inline(always)]
    pub(super) fn part(&self, number: u32) -> (&Covered<N>, u32) {
        let part = &self.parts[number as usize];
        (&part.covered, part.before)
    }
}
