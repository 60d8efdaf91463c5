//! Quads of packets that show several triangles, sorted by triangle.
//!
//! A list for each triangle, linked through one array: to add a quad is two stores, and a
//! triangle's quads come together although its packets lie far apart.

use crate::fragment::quad::QUAD;
use crate::fragment::queue::QuadPlace;
use crate::raster::{Covered, packet_origin};

use super::resolve::NONE;

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
    quads: Vec<Quad<N>>,
    /// By visibility id: the triangle's last quad.
    last: Vec<u32>,
    /// The ids of triangles that have quads.
    pub(super) triangles: Vec<u32>,
}

impl<const N: usize> Default for Quads<N> {
    fn default() -> Self {
        Self {
            quads: Vec::new(),
            last: Vec::new(),
            triangles: Vec::new(),
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
        self.quads.clear();
        self.triangles.clear();
    }

    /// Adds a triangle's quads of one packet; bit 4·i of `quads` is quad i.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a tile has 1024 quads")]
    pub(super) fn add(&mut self, id: u32, covered: Covered<N>, mut quads: u16) {
        let Some(last) = self.last.get_mut(id as usize) else {
            return;
        };
        if *last == NONE {
            self.triangles.push(id);
        }
        while quads != 0 {
            let shift = quads.trailing_zeros();
            quads &= quads - 1;
            let mut masks = covered.masks;
            masks
                .iter_mut()
                .for_each(|mask| *mask = *mask >> shift & 0xF);
            self.quads.push(Quad {
                before: *last,
                place: covered.packet * 4 + (shift as usize / QUAD) as u16,
                masks,
            });
            // At most four for each sample of a tile.
            *last = self.quads.len() as u32 - 1;
        }
    }

    /// A triangle's first quad to take.
    #[inline(always)]
    pub(super) fn begin(&self, id: u32) -> u32 {
        self.last.get(id as usize).copied().unwrap_or(NONE)
    }

    /// Up to four quads of a triangle from one on, how many, and where to go on. Places that are
    /// left over repeat a quad.
    #[inline(always)]
    pub(super) fn four(&self, first: u32, origin: [i32; 2]) -> ([QuadPlace<N>; QUAD], usize, u32) {
        let place = |quad: &Quad<N>| {
            let (x, y) = packet_origin(u32::from(quad.place / 4));
            let inside = i32::from(quad.place % 4);
            QuadPlace {
                place: quad.place,
                masks: quad.masks,
                pixel: [
                    origin[0] + x + (inside & 1) * 2,
                    origin[1] + y + (inside >> 1) * 2,
                ],
            }
        };
        let mut places = [place(&self.quads[first as usize]); QUAD];
        let (mut count, mut next) = (0, first);
        while count < QUAD && next != NONE {
            let quad = &self.quads[next as usize];
            places[count] = place(quad);
            count += 1;
            next = quad.before;
        }
        (places, count, next)
    }
}
