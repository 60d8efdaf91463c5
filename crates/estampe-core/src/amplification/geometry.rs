//! Geometry shaders (V4).
//!
//! *In* primitives and the records of their vertices · *Out* pieces: emitted vertices and lists of
//! the points, lines or triangles of their strips, in order.

use super::piece::Piece;
use super::vertices::Primitives;
use estampe_simd::Level;
use estampe_types::shader::{
    GeometryBatch, GeometryProgram, GeometryTopology, MAX_GEOMETRY_VERTICES,
};
use estampe_types::state::ProvokingVertex;
use estampe_types::{Bindings, BufferData};
use std::ops::Range;

/// The geometry stage of a draw.
#[derive(Debug, Clone, Copy)]
pub(super) struct GeometryStage<'a> {
    pub(super) program: &'a dyn GeometryProgram,
    pub(super) provoking: ProvokingVertex,
    pub(super) bindings: &'a Bindings,
    /// Layers of the target.
    pub(super) layers: u32,
    /// Viewports of the draw.
    pub(super) viewports: u32,
}

/// What a unit of primitives became.
#[derive(Debug, Default)]
pub(super) struct Emitted {
    pub(super) pieces: Vec<Piece>,
    /// Primitives of all pieces.
    pub(super) primitives: u64,
}

impl GeometryStage<'_> {
    /// Words that a primitive may make at most.
    pub(super) fn words_each(&self) -> usize {
        let interface = self.program.interface();
        interface.invocations * interface.max_vertices * interface.record_words()
    }

    /// Runs the shader on some primitives.
    pub(super) fn run(&self, level: Level, from: &Primitives, range: Range<usize>) -> Emitted {
        let interface = self.program.interface();
        let each = interface.primitive.vertices();
        let invocations = range.len() * interface.invocations;
        let words = interface.record_words();
        let mut emitted = vec![0; invocations * interface.max_vertices * words];
        let mut counts = vec![0; invocations];
        let mut ends = vec![[0; MAX_GEOMETRY_VERTICES / 32]; invocations];
        self.program.run(
            level,
            self.bindings,
            GeometryBatch {
                records: &from.records,
                words: from.words,
                corners: &from.corners[range.start * each..range.end * each],
                primitive_index: &from.numbers[range],
                emitted: &mut emitted,
                counts: &mut counts,
                ends: &mut ends,
            },
        );
        let mut assembled = Assembled::default();
        let (mut records, mut first) = (Vec::new(), 0);
        let slots = emitted.chunks_exact(interface.max_vertices * words);
        for ((slot, &count), ends) in slots.zip(&counts).zip(&ends) {
            let count = count.min(u32::try_from(interface.max_vertices).unwrap_or(u32::MAX));
            let slot = &slot[..count as usize * words];
            let place = |vertex: u32| match slot.get(vertex as usize * words..) {
                Some(record) if words > interface.output.record_words() => {
                    let inside = |number: u32, count| if number < count { number } else { 0 };
                    [
                        inside(record[words - 2], self.layers),
                        inside(record[words - 1], self.viewports),
                    ]
                }
                _ => [0; 2],
            };
            let mut start = 0;
            for vertex in 0..count {
                let ends_here = ends[vertex as usize / 32] >> (vertex % 32) & 1 == 1;
                if ends_here || vertex + 1 == count {
                    let strip = start..vertex + 1;
                    self.assemble(interface.topology, strip, first, place, &mut assembled);
                    start = vertex + 1;
                }
            }
            records.extend_from_slice(slot);
            first += count;
        }
        let primitives = assembled.primitives;
        let buffer = BufferData::from_words(records);
        let pieces = assembled.runs.into_iter().map(|run| Piece {
            layer: run.layer,
            viewport: run.viewport,
            ..Piece::of_buffer(buffer.clone(), run.indices)
        });
        Emitted {
            pieces: pieces.collect(),
            primitives,
        }
    }

    /// Appends the primitives of a strip, whose vertex 0 of the invocation is number `first` of
    /// the unit.
    fn assemble(
        &self,
        topology: GeometryTopology,
        strip: Range<u32>,
        first: u32,
        place: impl Fn(u32) -> [u32; 2],
        out: &mut Assembled,
    ) {
        let last = self.provoking == ProvokingVertex::Last;
        match topology {
            GeometryTopology::PointList => {
                for vertex in strip {
                    out.push(place(vertex), &[first + vertex]);
                }
            }
            GeometryTopology::LineStrip => {
                for vertex in strip.start..strip.end - 1 {
                    let provoking = if last { vertex + 1 } else { vertex };
                    let line = [first + vertex, first + vertex + 1];
                    out.push(place(provoking), &line);
                }
            }
            GeometryTopology::TriangleStrip => {
                for number in 0..(strip.end - strip.start).saturating_sub(2) {
                    let vertex = strip.start + number;
                    let provoking = if last { vertex + 2 } else { vertex };
                    let at = first + vertex;
                    // The same winding for all, and the provoking vertex where the list has it.
                    let triangle = match (number % 2 == 1, last) {
                        (false, _) => [at, at + 1, at + 2],
                        (true, false) => [at, at + 2, at + 1],
                        (true, true) => [at + 1, at, at + 2],
                    };
                    out.push(place(provoking), &triangle);
                }
            }
        }
    }
}

/// The primitives of a unit: those that follow each other with one layer and viewport together.
#[derive(Debug, Default)]
struct Assembled {
    runs: Vec<Run>,
    /// By layer: one more than the number of its last run.
    last_of_layer: Vec<usize>,
    primitives: u64,
}

#[derive(Debug)]
struct Run {
    layer: u32,
    viewport: u32,
    indices: Vec<u32>,
}

impl Assembled {
    fn push(&mut self, [layer, viewport]: [u32; 2], corners: &[u32]) {
        self.primitives += 1;
        let at = layer as usize;
        if self.last_of_layer.len() <= at {
            self.last_of_layer.resize(at + 1, 0);
        }
        // Layers do not see each other, so only the order within a layer counts.
        let last = self.last_of_layer[at].checked_sub(1);
        match last.map(|last| &mut self.runs[last]) {
            Some(run) if run.viewport == viewport => run.indices.extend_from_slice(corners),
            _ => {
                self.runs.push(Run {
                    layer,
                    viewport,
                    indices: corners.to_vec(),
                });
                self.last_of_layer[at] = self.runs.len();
            }
        }
    }
}
