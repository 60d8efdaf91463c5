//! Type erasure of geometry shaders.

use super::geometry::{
    Emit, EmittedVertex, GeometryIn, GeometryPrimitive, GeometryShader, GeometryTopology,
    MAX_GEOMETRY_INVOCATIONS, MAX_GEOMETRY_VERTICES,
};
use super::output::OutputInterface;
use super::points::{Records, ints, scalars};
use super::record_sink::{MAX_LANES, RecordSink};
use crate::shader::{Sink, dry_run};
use crate::{Bindings, Int, Real, ShaderError, Varyings};
use estampe_simd::{Level, SimdBase, dispatch, f32x16};

/// Inputs and outputs of a geometry program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GeometryInterface {
    /// Scalars of the varyings of a vertex of the primitive.
    pub input: usize,
    /// The primitives that are read.
    pub primitive: GeometryPrimitive,
    /// The primitives that are made.
    pub topology: GeometryTopology,
    /// Vertices that an invocation emits at most.
    pub max_vertices: usize,
    /// Invocations for each primitive.
    pub invocations: usize,
    /// The vertices that are made.
    pub output: OutputInterface,
    /// True if vertices name a layer.
    pub writes_layer: bool,
    /// True if vertices name a viewport.
    pub writes_viewport_index: bool,
}

impl GeometryInterface {
    /// Words of an emitted vertex: those of [`OutputInterface::record_words`], then, if either of
    /// them is written, the layer and the viewport index.
    #[must_use]
    pub fn record_words(&self) -> usize {
        let places = self.writes_layer || self.writes_viewport_index;
        self.output.record_words() + if places { 2 } else { 0 }
    }
}

/// A compiled geometry shader: the interface that the pipeline calls, one batch at a time.
///
/// Implementations must stay inside the batch's slices, and must give the same bits at every SIMD
/// level.
pub trait GeometryProgram: Send + Sync + std::fmt::Debug {
    /// The inputs and outputs of the program.
    fn interface(&self) -> &GeometryInterface;
    /// Called when a pipeline is created of the program.
    ///
    /// # Errors
    /// [`ShaderError`] says what is wrong; no pipeline is then created.
    fn validate(&self) -> Result<(), ShaderError> {
        Ok(())
    }
    /// Runs all invocations of some primitives.
    fn run(&self, level: Level, bindings: &Bindings, batch: GeometryBatch<'_>);
}

/// Primitives for a geometry shader. Invocation i of primitive p is number p·invocations + i.
#[derive(Debug)]
pub struct GeometryBatch<'a> {
    /// Records of vertices, at least x, y, z, w in clip space and the varyings.
    pub records: &'a [u32],
    /// Words of a record.
    pub words: usize,
    /// The number of the record of each vertex of each primitive.
    pub corners: &'a [u32],
    /// The number of each primitive in its instance.
    pub primitive_index: &'a [u32],
    /// Out: the [records](GeometryInterface::record_words) of emitted vertices, with a place for
    /// `max_vertices` in each invocation.
    pub emitted: &'a mut [u32],
    /// Out: the number of vertices that each invocation emits.
    pub counts: &'a mut [u32],
    /// Out: for each invocation, bit i is set if a strip ends after vertex i; cleared before.
    pub ends: &'a mut [[u32; MAX_GEOMETRY_VERTICES / 32]],
}

/// A [`GeometryShader`] whose type a pipeline need not know.
pub struct GeometryShaderProgram<T> {
    shader: T,
    interface: GeometryInterface,
    /// Why no pipeline can be made of the shader, if so.
    error: Option<ShaderError>,
}

impl<T: GeometryShader> GeometryShaderProgram<T> {
    /// Wraps a shader, and finds its interface, for which it is run a few times, as a
    /// [`Shader`](crate::Shader#the-interface) is.
    #[must_use]
    pub fn new(shader: T) -> Self {
        let mut interface = declared::<T>();
        let error = check::<T>()
            .and_then(|()| dry_run::of_geometry(&shader, &mut interface))
            .err();
        Self {
            shader,
            interface,
            error,
        }
    }

    /// The shader.
    #[must_use]
    pub fn shader(&self) -> &T {
        &self.shader
    }
}

fn check<T: GeometryShader>() -> Result<(), ShaderError> {
    if T::MAX_VERTICES == 0 || T::MAX_VERTICES > MAX_GEOMETRY_VERTICES {
        return Err(ShaderError::GeometryVertices {
            count: T::MAX_VERTICES,
        });
    }
    if T::INVOCATIONS == 0 || T::INVOCATIONS > MAX_GEOMETRY_INVOCATIONS {
        return Err(ShaderError::GeometryInvocations {
            count: T::INVOCATIONS,
        });
    }
    Ok(())
}

fn declared<T: GeometryShader>() -> GeometryInterface {
    let mut output = OutputInterface {
        writes_point_size: T::WRITES_POINT_SIZE,
        clip_distances: T::CLIP_DISTANCES,
        cull_distances: T::CULL_DISTANCES,
        ..OutputInterface::default()
    };
    T::Output::<f32>::modes(&mut output.varyings);
    T::Output::<f32>::sampling(&mut output.sampling);
    GeometryInterface {
        input: scalars::<T::Input<f32>>(),
        primitive: T::INPUT,
        topology: T::OUTPUT,
        max_vertices: T::MAX_VERTICES,
        invocations: T::INVOCATIONS,
        output,
        writes_layer: T::WRITES_LAYER,
        writes_viewport_index: T::WRITES_VIEWPORT_INDEX,
    }
}

impl<T> std::fmt::Debug for GeometryShaderProgram<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("GeometryShaderProgram")
            .field("shader", &std::any::type_name::<T>())
            .field("interface", &self.interface)
            .finish()
    }
}

impl<T: GeometryShader> GeometryProgram for GeometryShaderProgram<T> {
    fn interface(&self) -> &GeometryInterface {
        &self.interface
    }

    fn validate(&self) -> Result<(), ShaderError> {
        self.error.clone().map_or(Ok(()), Err)
    }

    fn run(&self, level: Level, bindings: &Bindings, batch: GeometryBatch<'_>) {
        dispatch!(@wide level, s => {
            let zero = <f32x16<_> as SimdBase<_>>::splat(s, 0.0);
            self.primitives(zero, bindings, batch);
        },
            scalar => self.primitives(0.0_f32, bindings, batch));
    }
}

impl<T: GeometryShader> GeometryShaderProgram<T> {
    #[inline(always)]
    fn primitives<R: Real>(&self, zero: R, bindings: &Bindings, batch: GeometryBatch<'_>) {
        let interface = &self.interface;
        let count = batch.primitive_index.len();
        let vertices = Records {
            records: batch.records,
            corners: Some(batch.corners),
            words: batch.words,
            count: interface.primitive.vertices(),
        };
        for first in (0..count).step_by(R::LANES) {
            // Lanes beyond the last primitive repeat it, and emit nothing.
            let primitive = |lane: usize| (first + lane).min(count - 1);
            let lanes = (count - first).min(R::LANES);
            for invocation in 0..T::INVOCATIONS {
                let mut slots = [0; MAX_LANES];
                for (lane, slot) in slots.iter_mut().enumerate() {
                    *slot = (first + lane) * T::INVOCATIONS + invocation;
                }
                let mut emitter = Emitter::<T> {
                    interface,
                    active: if lanes >= 32 {
                        u32::MAX
                    } else {
                        (1 << lanes) - 1
                    },
                    slots,
                    emitted: &mut *batch.emitted,
                    counts: &mut *batch.counts,
                    ends: &mut *batch.ends,
                    shader: std::marker::PhantomData,
                };
                let input = GeometryIn {
                    points: vertices.points(zero, primitive),
                    primitive_index: ints(zero, |lane| {
                        batch.primitive_index[primitive(lane)] as usize
                    }),
                    invocation,
                    bindings,
                    zero,
                };
                self.shader.geometry(input, &mut emitter);
            }
        }
    }
}

/// Writes what the lanes of one invocation emit.
struct Emitter<'a, T> {
    interface: &'a GeometryInterface,
    /// The lanes that have a primitive, as bits.
    active: u32,
    /// By lane: the number of the invocation.
    slots: [usize; MAX_LANES],
    emitted: &'a mut [u32],
    counts: &'a mut [u32],
    ends: &'a mut [[u32; MAX_GEOMETRY_VERTICES / 32]],
    shader: std::marker::PhantomData<fn() -> T>,
}

impl<R: Real, T: GeometryShader> Emit<R, T::Output<R>> for Emitter<'_, T> {
    #[inline(always)]
    fn emit(&mut self, lanes: R::SelectMask, vertex: impl Into<EmittedVertex<R, T::Output<R>>>) {
        let EmittedVertex {
            vertex,
            layer,
            viewport_index,
        } = vertex.into();
        let interface = self.interface;
        interface.output.assert_has(T::ASSERTS_OUTPUTS, &vertex);
        let words = interface.record_words();
        let zero = vertex.position.x.splat(0.0);
        let (mut first, mut kept) = ([0; MAX_LANES], 0);
        let wanted = R::mask_bits(lanes) & u64::from(self.active);
        for (lane, first) in first.iter_mut().enumerate().take(R::LANES) {
            if wanted >> lane & 1 == 0 {
                continue;
            }
            let slot = self.slots[lane];
            let count = &mut self.counts[slot];
            if (*count as usize) < T::MAX_VERTICES {
                *first = (slot * T::MAX_VERTICES + *count as usize) * words;
                kept |= 1 << lane;
                *count += 1;
            }
        }
        let mut sink = RecordSink::new(self.emitted, first, kept);
        interface.output.store(vertex, zero, &mut sink);
        if interface.writes_layer || interface.writes_viewport_index {
            let none = zero.splat_int(0);
            sink.put(layer.unwrap_or(none).to_real_bits());
            sink.put(viewport_index.unwrap_or(none).to_real_bits());
        }
    }

    #[inline(always)]
    fn end_primitive(&mut self, lanes: R::SelectMask) {
        let wanted = R::mask_bits(lanes) & u64::from(self.active);
        for lane in 0..R::LANES {
            if wanted >> lane & 1 == 0 {
                continue;
            }
            let slot = self.slots[lane];
            if let Some(last) = (self.counts[slot] as usize).checked_sub(1) {
                self.ends[slot][last / 32] |= 1 << (last % 32);
            }
        }
    }
}
