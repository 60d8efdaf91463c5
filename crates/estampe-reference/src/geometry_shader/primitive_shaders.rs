//! A geometry shader as the oracle runs it.
//!
//! In · Out: the vertices of a primitive · the strips that each invocation emits.
//! [`RustPrimitives`] runs a [`GeometryShader`] with `R = f32`; [`ProgramPrimitives`] runs any
//! [`GeometryProgram`].

use crate::ClipVertex;
use estampe_types::shader::{
    Emit, EmittedVertex, GeometryBatch, GeometryIn, GeometryProgram, GeometryShader,
    GeometryShaderProgram, GeometryTopology, Level, MAX_GEOMETRY_VERTICES, Points, ShaderError,
};
use estampe_types::{Bindings, Varyings};

/// Runs a geometry shader.
pub trait PrimitiveShaders {
    /// Vertices of a primitive that is read.
    fn corners(&self) -> usize;
    /// The primitives that are made.
    fn topology(&self) -> GeometryTopology;
    /// The strips of each invocation on a primitive, in the order in which they are emitted.
    fn strips(
        &self,
        corners: &[ClipVertex],
        number: i32,
        bindings: &Bindings,
    ) -> Vec<Vec<Vec<Placed>>>;
}

/// A vertex with its layer and viewport index.
pub type Placed = (ClipVertex, [u32; 2]);

/// A geometry shader in Rust.
#[derive(Debug)]
pub struct RustPrimitives<'a, G> {
    shader: &'a G,
    /// The numbers of clip and cull distances.
    distances: [usize; 2],
}

impl<'a, G: GeometryShader + Clone> RustPrimitives<'a, G> {
    /// Finds the interface of a shader.
    ///
    /// # Errors
    /// [`ShaderError`] if no pipeline can be made of the shader.
    pub fn new(shader: &'a G) -> Result<Self, ShaderError> {
        let program = GeometryShaderProgram::new(shader.clone());
        program.validate()?;
        let output = &program.interface().output;
        let distances = [output.clip_distances, output.cull_distances];
        Ok(Self { shader, distances })
    }
}

impl<G: GeometryShader> PrimitiveShaders for RustPrimitives<'_, G> {
    fn corners(&self) -> usize {
        G::INPUT.vertices()
    }

    fn topology(&self) -> GeometryTopology {
        G::OUTPUT
    }

    fn strips(
        &self,
        corners: &[ClipVertex],
        number: i32,
        bindings: &Bindings,
    ) -> Vec<Vec<Vec<Placed>>> {
        let records: Vec<u32> = corners.iter().flat_map(ClipVertex::words).collect();
        let words = records.len() / corners.len();
        let run = |invocation| {
            let mut strips = Strips {
                strips: vec![Vec::new()],
                left: G::MAX_VERTICES,
                distances: self.distances,
            };
            let input = GeometryIn {
                points: Points::of_patch(0.0_f32, &records, words, corners.len()),
                primitive_index: number,
                invocation,
                bindings,
                zero: 0.0,
            };
            self.shader.geometry(input, &mut strips);
            strips.strips
        };
        (0..G::INVOCATIONS).map(run).collect()
    }
}

/// The strips that one invocation emits.
struct Strips {
    strips: Vec<Vec<Placed>>,
    /// Vertices that may still be emitted.
    left: usize,
    distances: [usize; 2],
}

impl<V: Varyings<f32>> Emit<f32, V> for Strips {
    fn emit(&mut self, lanes: bool, vertex: impl Into<EmittedVertex<f32, V>>) {
        if !lanes || self.left == 0 {
            return;
        }
        self.left -= 1;
        let vertex = vertex.into();
        let place = [vertex.layer, vertex.viewport_index];
        let place = place.map(|number| number.unwrap_or(0).cast_unsigned());
        let vertex = ClipVertex::of(vertex.vertex, self.distances);
        if let Some(strip) = self.strips.last_mut() {
            strip.push((vertex, place));
        }
    }

    fn end_primitive(&mut self, lanes: bool) {
        if lanes {
            self.strips.push(Vec::new());
        }
    }
}

/// Any geometry program, run with one primitive at a time.
#[derive(Debug, Clone, Copy)]
pub struct ProgramPrimitives<'a> {
    program: &'a dyn GeometryProgram,
    level: Level,
}

impl<'a> ProgramPrimitives<'a> {
    /// Runs a program at a SIMD level.
    #[must_use]
    pub fn new(program: &'a dyn GeometryProgram, level: Level) -> Self {
        Self { program, level }
    }
}

impl PrimitiveShaders for ProgramPrimitives<'_> {
    fn corners(&self) -> usize {
        self.program.interface().primitive.vertices()
    }

    fn topology(&self) -> GeometryTopology {
        self.program.interface().topology
    }

    fn strips(
        &self,
        corners: &[ClipVertex],
        number: i32,
        bindings: &Bindings,
    ) -> Vec<Vec<Vec<Placed>>> {
        let interface = self.program.interface();
        let records: Vec<u32> = corners.iter().flat_map(ClipVertex::words).collect();
        let order: Vec<u32> = (0..).take(corners.len()).collect();
        let words = interface.record_words();
        let mut emitted = vec![0; interface.invocations * interface.max_vertices * words];
        let mut counts = vec![0; interface.invocations];
        let mut ends = vec![[0; MAX_GEOMETRY_VERTICES / 32]; interface.invocations];
        self.program.run(
            self.level,
            bindings,
            GeometryBatch {
                records: &records,
                words: records.len() / corners.len(),
                corners: &order,
                primitive_index: &[number.cast_unsigned()],
                emitted: &mut emitted,
                counts: &mut counts,
                ends: &mut ends,
            },
        );
        let own = interface.output.record_words();
        let slots = emitted.chunks(interface.max_vertices * words);
        let invocations = slots.zip(&counts).zip(&ends).map(|((slot, &count), ends)| {
            let mut strips = vec![Vec::new()];
            let records = slot.chunks(words).take(count as usize);
            for (vertex, record) in records.enumerate() {
                let place = match record[own..] {
                    [layer, viewport] => [layer, viewport],
                    _ => [0; 2],
                };
                let placed = (ClipVertex::of_record(record, &interface.output), place);
                strips.last_mut().expect("never empty").push(placed);
                if ends[vertex / 32] >> (vertex % 32) & 1 == 1 {
                    strips.push(Vec::new());
                }
            }
            strips
        });
        invocations.collect()
    }
}
