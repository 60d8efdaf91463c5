//! Quads of packets that show several triangles, sorted by triangle.
//!
//! A list for each triangle, linked through one array: to add a quad is two stores, and a
//! triangle's quads come together although its packets lie far apart. Which of a packet's four
//! quads a triangle has cannot be predicted, so there is no branch on it.

use crate::fragment::quad::{QUAD, QUADS};
use crate::raster::Covered;

use super::resolve::NONE;
use std::hint::select_unpredictable;

/// A quad, and the one of the same triangle that was added before it.
#[derive(Debug, Clone, Copy)]
struct Quad<const N: usize> {
    before: u32,
    place: u16,
    masks: [u16; N],
}

/// Quads by triangle.
#[derive(Debug)]
pub(super) struct Quads<const N: usize> {
    /// Four more than there are, as four are written at a time.
    quads: Vec<Quad<N>>,
    len: usize,
    /// By visibility id: the triangle's last quad.
    last: Vec<u32>,
}

impl<const N: usize> Default for Quads<N> {
    fn default() -> Self {
        Self {
            quads: Vec::new(),
            len: 0,
            last: Vec::new(),
        }
    }
}

impl<const N: usize> Quads<N> {
    /// Begins a run of so many triangles.
    pub(super) fn begin_run(&mut self, triangles: usize) {
        self.begin_group();
        self.last.clear();
        self.last.resize(triangles, NONE);
    }

    /// Forgets the quads of the triangles before.
    pub(super) fn begin_group(&mut self) {
        self.len = 0;
    }

    /// Returns true if no triangle of the group has quads.
    pub(super) fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// By visibility id: the number of the triangle's last quad, or [`NONE`].
    #[inline(always)]
    pub(super) fn last(&self) -> &[u32] {
        &self.last
    }

    /// Adds a triangle's quads of one packet; bit 4·i of `quads` is quad i.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a tile has 1024 quads")]
    pub(super) fn add(&mut self, id: u32, covered: Covered<N>, quads: u16) {
        let Some(last) = self.last.get_mut(id as usize) else {
            return;
        };
        if self.quads.len() < self.len + QUADS {
            let nothing = Quad {
                before: NONE,
                place: 0,
                masks: [0; N],
            };
            self.quads.resize((self.len + QUADS) * 2, nothing);
        }
        // In registers: each quad would wait for the numbers that the one before it stored.
        let (mut before, mut len) = (*last, 0);
        let Some(out) = self
            .quads
            .get_mut(self.len..)
            .and_then(<[_]>::first_chunk_mut)
        else {
            unreachable!("four more quads than there are");
        };
        let out: &mut [Quad<N>; QUADS] = out;
        for quad in 0..QUADS {
            let shift = quad * QUAD;
            let mut masks = covered.masks;
            for mask in &mut masks {
                *mask = *mask >> shift & 0xF;
            }
            // The next one takes its place, unless the triangle has it.
            out[len % QUADS] = Quad {
                before,
                place: covered.packet * 4 + quad as u16,
                masks,
            };
            let is_there = quads >> shift & 1 == 1;
            // At most four for each sample of a tile.
            before = select_unpredictable(is_there, (self.len + len) as u32, before);
            len += usize::from(is_there);
        }
        *last = before;
        self.len += len;
    }

    /// A triangle's first quad to take.
    #[inline(always)]
    pub(super) fn begin(&self, id: u32) -> u32 {
        self.last.get(id as usize).copied().unwrap_or(NONE)
    }

    /// A quad, packet·4 + quad, and by sample its mask in the lowest four bits; and the number of
    /// the next one to take.
    #[inline(always)]
    pub(super) fn quad(&self, number: u32) -> ((u16, [u16; N]), u32) {
        let Quad {
            before,
            place,
            masks,
        } = self.quads[number as usize];
        ((place, masks), before)
    }
}
