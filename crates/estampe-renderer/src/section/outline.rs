//! Where a plane meets a mesh: rings of points on the plane.

use super::{HalfSpace, bits};
use estampe_scene::Mesh;
use glam::Vec3;
use std::collections::HashMap;

/// The rings in which a plane meets a mesh.
#[derive(Debug, Default)]
pub(super) struct Outline {
    /// Each without repetition of its first point.
    pub(super) rings: Vec<Vec<Vec3>>,
    /// True if all triangles have the same side outside, so that the winding of rings tells solids
    /// from cavities; else rings within rings are cavities.
    pub(super) is_oriented: bool,
}

/// The gap between the ends of chains up to which they are joined, as a fraction of the rings' box:
/// files with rounded coordinates are closed so.
const JOINED_GAP: f32 = 1e-4;
/// The gap between the ends of a chain up to which it is closed, as a fraction of its length: scans
/// have small holes.
const CLOSED_GAP: f32 = 0.05;
/// The most chains with ends that are joined; each is compared with all others.
const MOST_CHAINS: usize = 4096;

impl Outline {
    pub(super) fn new(mesh: &Mesh, plane: &HalfSpace) -> Self {
        let mut segments = Segments::default();
        for triangle in &mesh.triangles {
            segments.add(mesh, plane, *triangle);
        }
        let (mut rings, chains) = segments.walk();
        let gap =
            JOINED_GAP * estampe_scene::Bounds::of(segments.points.iter().copied()).diagonal();
        let is_oriented = join(chains, gap, &mut rings);
        rings.retain(|ring| ring.len() > 2);
        Self { rings, is_oriented }
    }
}

/// The segments in which the plane meets triangles. Each begins where the triangle's border enters
/// the kept side, so it ends where the neighbour's segment begins.
#[derive(Debug, Default)]
struct Segments {
    points: Vec<Vec3>,
    /// Numbers of positions, by their bits: files such as STL repeat them for each triangle.
    position_numbers: HashMap<[u32; 3], u32>,
    /// Numbers of points, by the ends of the edge that the plane crosses.
    point_numbers: HashMap<[u32; 2], u32>,
    /// Numbers of the points at their beginning and end.
    ends: Vec<[u32; 2]>,
}

impl Segments {
    fn add(&mut self, mesh: &Mesh, plane: &HalfSpace, triangle: [u32; 3]) {
        let corners = triangle.map(|corner| mesh.positions.get(corner as usize).copied());
        let [Some(a), Some(b), Some(c)] = corners else {
            return;
        };
        let corners = [a, b, c];
        let distances = corners.map(|corner| plane.distance(corner));
        let kept = distances.map(|distance| distance < 0.0);
        if kept == [true; 3] || kept == [false; 3] || !distances.iter().all(|d| d.is_finite()) {
            return;
        }
        let mut ends = [0; 2];
        for corner in 0..3 {
            let next = (corner + 1) % 3;
            if kept[corner] != kept[next] {
                let point = self.point(plane, corners[corner], corners[next]);
                ends[usize::from(kept[corner])] = point;
            }
        }
        self.ends.push(ends);
    }

    fn point(&mut self, plane: &HalfSpace, a: Vec3, b: Vec3) -> u32 {
        let mut number = |position: Vec3| {
            let next = u32::try_from(self.position_numbers.len()).unwrap_or(u32::MAX);
            *self.position_numbers.entry(bits(position)).or_insert(next)
        };
        let (p, q) = (number(a), number(b));
        *self
            .point_numbers
            .entry([p.min(q), p.max(q)])
            .or_insert_with(|| {
                self.points.push(plane.crossing(a, b).0);
                u32::try_from(self.points.len() - 1).unwrap_or(u32::MAX)
            })
    }

    /// The rings, and the chains whose ends differ.
    fn walk(&self) -> (Vec<Vec<Vec3>>, Vec<Vec<Vec3>>) {
        let mut begins: Vec<Vec<u32>> = vec![Vec::new(); self.points.len()];
        let mut surplus = vec![0_i64; self.points.len()];
        for (&[from, to], number) in self.ends.iter().zip(0_u32..) {
            begins[from as usize].push(number);
            surplus[from as usize] += 1;
            surplus[to as usize] -= 1;
        }
        let mut chain_from = |first: usize| {
            let mut at = first;
            let mut numbers = vec![first];
            while let Some(segment) = begins[at].pop() {
                at = self.ends[segment as usize][1] as usize;
                numbers.push(at);
            }
            numbers
        };
        let points = |numbers: &[usize]| numbers.iter().map(|&n| self.points[n]).collect();
        let (mut rings, mut chains): (Vec<Vec<Vec3>>, Vec<Vec<Vec3>>) = Default::default();
        // Chains begin where more segments begin than end.
        for (first, &surplus) in surplus.iter().enumerate() {
            for _ in 0..surplus.max(0) {
                chains.push(points(&chain_from(first)));
            }
        }
        // As many segments begin as end at each point of the rest, so a walk ends where it began.
        for first in 0..self.points.len() {
            loop {
                let numbers = chain_from(first);
                if numbers.len() < 2 {
                    break;
                }
                rings.push(points(&numbers[1..]));
            }
        }
        (rings, chains)
    }
}

/// Joins chains whose ends are near each other to rings. Returns true if none was reversed for it.
fn join(mut chains: Vec<Vec<Vec3>>, gap: f32, rings: &mut Vec<Vec<Vec3>>) -> bool {
    let mut is_oriented = true;
    if chains.len() > MOST_CHAINS {
        return true;
    }
    while let Some(mut ring) = chains.pop() {
        loop {
            let (first, last) = (ring[0], ring[ring.len() - 1]);
            let near = |end: Vec3| Some((last - end).length()).filter(|&way| way <= gap);
            let mut best: Option<(f32, usize, bool)> = None;
            for (number, chain) in chains.iter().enumerate() {
                for (end, is_reversed) in [(chain[0], false), (chain[chain.len() - 1], true)] {
                    if let Some(way) = near(end)
                        && best.is_none_or(|(least, ..)| way < least)
                    {
                        best = Some((way, number, is_reversed));
                    }
                }
            }
            let closing = near(first).filter(|_| ring.len() > 2);
            match (closing, best) {
                (Some(way), best) if best.is_none_or(|(least, ..)| way <= least) => {
                    rings.push(ring);
                    break;
                }
                (_, Some((_, number, is_reversed))) => {
                    let mut next = chains.swap_remove(number);
                    if is_reversed {
                        next.reverse();
                        is_oriented = false;
                    }
                    ring.extend(next);
                }
                _ => {
                    let steps = ring.windows(2).map(|pair| (pair[1] - pair[0]).length());
                    if (last - first).length() <= CLOSED_GAP * steps.sum::<f32>() {
                        rings.push(ring);
                    }
                    break;
                }
            }
        }
    }
    is_oriented
}
