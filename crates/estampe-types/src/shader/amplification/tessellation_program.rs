//! Type erasure of tessellation shaders.

use super::output::OutputInterface;
use super::points::{Records, ints, scalars};
use super::record_sink::RecordSink;
use super::tessellation::{ControlIn, EvaluationIn, PatchIn, TessellationShader};
use crate::shader::dry_run;
use crate::{Bindings, Real, ShaderError, Varyings, Vec3};
use estampe_simd::{Level, SimdBase, dispatch, f32x16};

/// Inputs and outputs of a tessellation program.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TessellationInterface {
    /// Scalars of the varyings of a vertex of the patch.
    pub input: usize,
    /// Control points that are made of a patch.
    pub control_points: usize,
    /// Scalars of a control point.
    pub control: usize,
    /// Scalars of the values of a patch.
    pub patch: usize,
    /// The vertices that are made.
    pub output: OutputInterface,
}

/// A compiled tessellation shader: the interface that the pipeline calls, one batch at a time.
///
/// Implementations must stay inside the batch's slices, and must give the same bits at every SIMD
/// level.
pub trait TessellationProgram: Send + Sync + std::fmt::Debug {
    /// The inputs and outputs of the program.
    fn interface(&self) -> &TessellationInterface;
    /// Called when a pipeline is created of the program.
    ///
    /// # Errors
    /// [`ShaderError`] says what is wrong; no pipeline is then created.
    fn validate(&self) -> Result<(), ShaderError> {
        Ok(())
    }
    /// Makes the control points, levels and values of patches.
    fn run_control(&self, level: Level, bindings: &Bindings, batch: ControlBatch<'_>);
    /// Makes the vertices of patches.
    fn run_evaluation(&self, level: Level, bindings: &Bindings, batch: EvaluationBatch<'_>);
}

/// Patches whose control points are to be made.
#[derive(Debug)]
pub struct ControlBatch<'a> {
    /// Records of vertices: x, y, z, w in clip space, then the varyings.
    pub records: &'a [u32],
    /// The number of the record of each vertex of each patch.
    pub corners: &'a [u32],
    /// Vertices of a patch.
    pub patch_points: usize,
    /// The number of each patch in its instance.
    pub primitive_index: &'a [u32],
    /// Out: the control points' records, patch by patch.
    pub control: &'a mut [u32],
    /// Out: the records of the patches' values.
    pub patches: &'a mut [u32],
    /// Out: the four outer and the two inner levels of each patch.
    pub levels: &'a mut [[f32; 6]],
}

/// Vertices that are to be made of patches.
#[derive(Debug)]
pub struct EvaluationBatch<'a> {
    /// The control points' records, patch by patch.
    pub control: &'a [u32],
    /// The records of the patches' values.
    pub patches: &'a [u32],
    /// The number of each patch in its instance.
    pub primitive_index: &'a [u32],
    /// The patch of each vertex.
    pub patch: &'a [u32],
    /// The place of each vertex in the domain.
    pub coordinates: &'a [[f32; 3]],
    /// Out: the vertices' [records](OutputInterface).
    pub records: &'a mut [u32],
}

/// A [`TessellationShader`] whose type a pipeline need not know.
pub struct TessellationShaderProgram<T> {
    shader: T,
    interface: TessellationInterface,
    /// Why no pipeline can be made of the shader, if so.
    error: Option<ShaderError>,
}

impl<T: TessellationShader> TessellationShaderProgram<T> {
    /// Wraps a shader, and finds its interface, for which it is run a few times, as a
    /// [`Shader`](crate::Shader#the-interface) is.
    #[must_use]
    pub fn new(shader: T) -> Self {
        let (interface, error) = match interface_of(&shader) {
            Ok(interface) => (interface, None),
            Err(error) => (TessellationInterface::default(), Some(error)),
        };
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

fn interface_of<T: TessellationShader>(shader: &T) -> Result<TessellationInterface, ShaderError> {
    if T::CONTROL_POINTS == 0 || T::CONTROL_POINTS > crate::state::MAX_PATCH_POINTS as usize {
        return Err(ShaderError::ControlPoints {
            count: T::CONTROL_POINTS,
        });
    }
    let mut output = OutputInterface {
        writes_point_size: T::WRITES_POINT_SIZE,
        clip_distances: T::CLIP_DISTANCES,
        cull_distances: T::CULL_DISTANCES,
        ..OutputInterface::default()
    };
    T::Output::<f32>::modes(&mut output.varyings);
    T::Output::<f32>::sampling(&mut output.sampling);
    let mut interface = TessellationInterface {
        input: scalars::<T::Input<f32>>(),
        control_points: T::CONTROL_POINTS,
        control: scalars::<T::Control<f32>>(),
        patch: scalars::<T::Patch<f32>>(),
        output,
    };
    dry_run::of_tessellation(shader, &mut interface)?;
    Ok(interface)
}

impl<T> std::fmt::Debug for TessellationShaderProgram<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TessellationShaderProgram")
            .field("shader", &std::any::type_name::<T>())
            .field("interface", &self.interface)
            .finish()
    }
}

impl<T: TessellationShader> TessellationProgram for TessellationShaderProgram<T> {
    fn interface(&self) -> &TessellationInterface {
        &self.interface
    }

    fn validate(&self) -> Result<(), ShaderError> {
        self.error.clone().map_or(Ok(()), Err)
    }

    fn run_control(&self, level: Level, bindings: &Bindings, batch: ControlBatch<'_>) {
        dispatch!(@wide level, s => {
            let zero = <f32x16<_> as SimdBase<_>>::splat(s, 0.0);
            self.control(zero, bindings, batch);
        },
            scalar => self.control(0.0_f32, bindings, batch));
    }

    fn run_evaluation(&self, level: Level, bindings: &Bindings, batch: EvaluationBatch<'_>) {
        dispatch!(@wide level, s => {
            let zero = <f32x16<_> as SimdBase<_>>::splat(s, 0.0);
            self.evaluate(zero, bindings, batch);
        },
            scalar => self.evaluate(0.0_f32, bindings, batch));
    }
}

impl<T: TessellationShader> TessellationShaderProgram<T> {
    #[inline(always)]
    fn control<R: Real>(&self, zero: R, bindings: &Bindings, batch: ControlBatch<'_>) {
        let interface = &self.interface;
        let count = batch.primitive_index.len();
        let vertices = Records {
            records: batch.records,
            corners: Some(batch.corners),
            words: 4 + interface.input,
            count: batch.patch_points,
        };
        for first in (0..count).step_by(R::LANES) {
            // Lanes beyond the last patch repeat it.
            let patch = |lane: usize| (first + lane).min(count - 1);
            let lanes = (count - first).min(R::LANES);
            let primitive_index = ints(zero, |lane| batch.primitive_index[patch(lane)] as usize);
            let points = vertices.points(zero, patch);
            for index in 0..T::CONTROL_POINTS {
                let point = self.shader.control(ControlIn {
                    index,
                    points,
                    primitive_index,
                    bindings,
                    zero,
                });
                let words = T::CONTROL_POINTS * interface.control;
                let from = (first * words + index * interface.control).min(batch.control.len());
                let to = &mut batch.control[from..];
                point.store(&mut RecordSink::consecutive(to, 0, lanes, words));
            }
            let control = Records {
                records: batch.control,
                corners: None,
                words: interface.control,
                count: T::CONTROL_POINTS,
            };
            let (levels, values) = self.shader.patch(PatchIn {
                points: control.points(zero, patch),
                primitive_index,
                bindings,
                zero,
            });
            let to = &mut *batch.patches;
            values.store(&mut RecordSink::consecutive(
                to,
                first,
                lanes,
                interface.patch,
            ));
            let [a, b, c, d] = levels.outer;
            let [e, f] = levels.inner;
            let all = [a, b, c, d, e, f];
            for (lane, to) in batch.levels[first..].iter_mut().take(lanes).enumerate() {
                for (to, level) in to.iter_mut().zip(&all) {
                    *to = level.lane(lane);
                }
            }
        }
    }

    #[inline(always)]
    fn evaluate<R: Real>(&self, zero: R, bindings: &Bindings, batch: EvaluationBatch<'_>) {
        let interface = &self.interface;
        let count = batch.patch.len();
        let control = Records {
            records: batch.control,
            corners: None,
            words: interface.control,
            count: T::CONTROL_POINTS,
        };
        let values = Records {
            records: batch.patches,
            corners: None,
            words: interface.patch,
            count: 1,
        };
        for first in (0..count).step_by(R::LANES) {
            // Lanes beyond the last vertex repeat it.
            let vertex = |lane: usize| (first + lane).min(count - 1);
            let patch = |lane: usize| batch.patch[vertex(lane)] as usize;
            let at = |axis: usize| {
                zero.with_lanes(
                    #[inline(always)]
                    |lane| batch.coordinates[vertex(lane)][axis],
                )
            };
            let input = EvaluationIn {
                coordinates: Vec3::new(at(0), at(1), at(2)),
                points: control.points(zero, patch),
                primitive_index: ints(zero, |lane| batch.primitive_index[patch(lane)] as usize),
                bindings,
                zero,
            };
            let out = self
                .shader
                .evaluate(input, values.points(zero, patch).get(0));
            interface.output.assert_has(T::ASSERTS_OUTPUTS, &out);
            let lanes = (count - first).min(R::LANES);
            let words = interface.output.record_words();
            let mut sink = RecordSink::consecutive(batch.records, first, lanes, words);
            interface.output.store(out, zero, &mut sink);
        }
    }
}
