//! Mode TRIANGLES: indices from the edges and vertices of recent triangles.
//!
//! ```text
//! 0xe1 | one code per triangle | further numbers | 16 codes of pairs
//!
//! code X Y    X < 15: the edge that came X edges before, and a vertex by Y:
//!             0 the next new one · 1–12 a recent one · 13 last − 1 · 14 last + 1 · 15 a difference
//! code 15 Y   three vertices: Y < 14 a new one, and a pair by the table of pairs;
//!             14 a new one, 15 a difference, each with a pair in a byte that follows
//! pair Z W    two vertices: 0 the next new one · 1–14 a recent one · 15 a difference
//! ```
//!
//! Differences are zigzag codes, relative to the last vertex that was given so.

use super::{Damage, TOO_LONG, TOO_SHORT, WRONG_HEADER, next_byte, next_varint, unzigzag};

const HEADER: u8 = 0xe1;
const TABLE: usize = 16;

/// The last sixteen items.
#[derive(Debug, Default)]
struct Recent<T> {
    items: [T; 16],
    next: usize,
}

impl<T: Copy> Recent<T> {
    fn push(&mut self, item: T) {
        self.items[self.next] = item;
        self.next = (self.next + 1) % 16;
    }

    /// The item that came `age` items before the newest one.
    fn get(&self, age: usize) -> T {
        self.items[(self.next + 31 - age) % 16]
    }
}

/// What was decoded so far.
struct State<'a> {
    data: &'a [u8],
    edges: Recent<[u32; 2]>,
    vertices: Recent<u32>,
    /// The next new vertex.
    next: u32,
    last: u32,
}

/// Decodes `count` triangles.
pub(super) fn decode(mut data: &[u8], count: usize) -> Result<Vec<u32>, Damage> {
    if next_byte(&mut data)? != HEADER {
        return Err(WRONG_HEADER);
    }
    let (codes, data) = data.split_at_checked(count).ok_or(TOO_SHORT)?;
    let (data, table) = data.split_last_chunk::<TABLE>().ok_or(TOO_SHORT)?;
    let mut state = State {
        data,
        edges: Recent::default(),
        vertices: Recent::default(),
        next: 0,
        last: 0,
    };
    let mut indices = Vec::with_capacity(count * 3);
    for &code in codes {
        let triangle = match code >> 4 {
            15 => state.three_vertices(code & 15, table)?,
            edge => state.edge_and_vertex(usize::from(edge), code & 15)?,
        };
        indices.extend(triangle);
    }
    if state.data.is_empty() {
        Ok(indices)
    } else {
        Err(TOO_LONG)
    }
}

impl State<'_> {
    fn edge_and_vertex(&mut self, edge: usize, vertex: u8) -> Result<[u32; 3], Damage> {
        let [a, b] = self.edges.get(edge);
        let c = match vertex {
            0 => self.new_vertex(),
            13 => self.moved(1_u32.wrapping_neg()),
            14 => self.moved(1),
            15 => self.difference()?,
            recent => self.vertices.get(usize::from(recent)),
        };
        if !(1..13).contains(&vertex) {
            self.vertices.push(c);
        }
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        Ok([a, b, c])
    }

    fn three_vertices(&mut self, code: u8, table: &[u8; TABLE]) -> Result<[u32; 3], Damage> {
        let pair = match code {
            14 | 15 => {
                let pair = next_byte(&mut self.data)?;
                if pair == 0 {
                    self.next = 0;
                }
                pair
            }
            entry => table[usize::from(entry)],
        };
        let a = match code {
            15 => self.difference()?,
            _ => self.new_vertex(),
        };
        // The vertices of the pair are read before any of the three is a recent one.
        let b = self.vertex_of_pair(pair >> 4)?;
        let c = self.vertex_of_pair(pair & 15)?;
        self.vertices.push(a);
        for (vertex, code) in [(b, pair >> 4), (c, pair & 15)] {
            if matches!(code, 0 | 15) {
                self.vertices.push(vertex);
            }
        }
        self.edges.push([b, a]);
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        Ok([a, b, c])
    }

    fn vertex_of_pair(&mut self, code: u8) -> Result<u32, Damage> {
        match code {
            0 => Ok(self.new_vertex()),
            15 => self.difference(),
            recent => Ok(self.vertices.get(usize::from(recent) - 1)),
        }
    }

    fn new_vertex(&mut self) -> u32 {
        let vertex = self.next;
        self.next = vertex.wrapping_add(1);
        vertex
    }

    fn moved(&mut self, difference: u32) -> u32 {
        self.last = self.last.wrapping_add(difference);
        self.last
    }

    fn difference(&mut self) -> Result<u32, Damage> {
        let code = next_varint(&mut self.data)?;
        Ok(self.moved(unzigzag(code)))
    }
}
