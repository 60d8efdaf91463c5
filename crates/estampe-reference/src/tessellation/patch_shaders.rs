//! The shaders of a patch as the oracle runs them.
//!
//! In · Out: the vertices of a patch · its control points and levels; places in the domain ·
//! vertices. [`RustPatches`] runs a [`TessellationShader`] with `R = f32`; [`ProgramPatches`] runs
//! any [`TessellationProgram`].

use crate::ClipVertex;
use crate::shading::scalars_of;
use estampe_types::shader::{
    ControlBatch, ControlIn, EvaluationBatch, EvaluationIn, Level, PatchIn, Points, ShaderError,
    TessellationLevels, TessellationProgram, TessellationShader, TessellationShaderProgram,
};
use estampe_types::{Bindings, Vec3};

/// Runs the shaders of patches.
pub trait PatchShaders {
    /// Makes the control points, the levels and the values of a patch.
    fn control(&self, corners: &[ClipVertex], number: i32, bindings: &Bindings) -> ControlledPatch;
    /// Makes the vertices at some places of a patch.
    fn evaluate(
        &self,
        patch: &ControlledPatch,
        coordinates: &[[f32; 3]],
        bindings: &Bindings,
    ) -> Vec<ClipVertex>;
}

/// A patch with its control points.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlledPatch {
    /// The words of the control points, one after the other.
    control: Vec<u32>,
    /// The words of the patch's values; a shader in Rust computes them anew.
    values: Vec<u32>,
    /// The number of the patch in its instance.
    number: i32,
    /// The outer levels.
    pub outer: [f32; 4],
    /// The inner levels.
    pub inner: [f32; 2],
}

/// A tessellation shader in Rust.
#[derive(Debug)]
pub struct RustPatches<'a, T> {
    shader: &'a T,
    /// The numbers of clip and cull distances.
    distances: [usize; 2],
}

impl<'a, T: TessellationShader + Clone> RustPatches<'a, T> {
    /// Finds the interface of a shader.
    ///
    /// # Errors
    /// [`ShaderError`] if no pipeline can be made of the shader.
    pub fn new(shader: &'a T) -> Result<Self, ShaderError> {
        let program = TessellationShaderProgram::new(shader.clone());
        program.validate()?;
        let output = &program.interface().output;
        let distances = [output.clip_distances, output.cull_distances];
        Ok(Self { shader, distances })
    }
}

impl<T: TessellationShader> RustPatches<'_, T> {
    fn points<'a>(&self, control: &'a [u32]) -> Points<'a, f32, T::Control<f32>> {
        let words = control.len() / T::CONTROL_POINTS;
        Points::of_patch(0.0, control, words, T::CONTROL_POINTS)
    }

    fn patch(
        &self,
        control: &[u32],
        number: i32,
        bindings: &Bindings,
    ) -> (TessellationLevels<f32>, T::Patch<f32>) {
        self.shader.patch(PatchIn {
            points: self.points(control),
            primitive_index: number,
            bindings,
            zero: 0.0,
        })
    }
}

impl<T: TessellationShader> PatchShaders for RustPatches<'_, T> {
    fn control(&self, corners: &[ClipVertex], number: i32, bindings: &Bindings) -> ControlledPatch {
        let records: Vec<u32> = corners.iter().flat_map(ClipVertex::words).collect();
        let words = records.len() / corners.len();
        let point = |index| {
            let point = self.shader.control(ControlIn {
                index,
                points: Points::of_patch(0.0_f32, &records, words, corners.len()),
                primitive_index: number,
                bindings,
                zero: 0.0,
            });
            scalars_of(point)
        };
        let control = (0..T::CONTROL_POINTS).flat_map(point);
        let control: Vec<u32> = control.map(f32::to_bits).collect();
        let (TessellationLevels { outer, inner }, _) = self.patch(&control, number, bindings);
        ControlledPatch {
            control,
            values: Vec::new(),
            number,
            outer,
            inner,
        }
    }

    fn evaluate(
        &self,
        patch: &ControlledPatch,
        coordinates: &[[f32; 3]],
        bindings: &Bindings,
    ) -> Vec<ClipVertex> {
        let evaluate = |&[x, y, z]: &[f32; 3]| {
            let input = EvaluationIn {
                coordinates: Vec3::new(x, y, z),
                points: self.points(&patch.control),
                primitive_index: patch.number,
                bindings,
                zero: 0.0_f32,
            };
            let (_, values) = self.patch(&patch.control, patch.number, bindings);
            ClipVertex::of(self.shader.evaluate(input, values), self.distances)
        };
        coordinates.iter().map(evaluate).collect()
    }
}

/// Any tessellation program, run with one patch at a time.
#[derive(Debug, Clone, Copy)]
pub struct ProgramPatches<'a> {
    program: &'a dyn TessellationProgram,
    level: Level,
}

impl<'a> ProgramPatches<'a> {
    /// Runs a program at a SIMD level.
    #[must_use]
    pub fn new(program: &'a dyn TessellationProgram, level: Level) -> Self {
        Self { program, level }
    }
}

impl PatchShaders for ProgramPatches<'_> {
    fn control(&self, corners: &[ClipVertex], number: i32, bindings: &Bindings) -> ControlledPatch {
        let interface = self.program.interface();
        let records: Vec<u32> = corners.iter().flat_map(ClipVertex::words).collect();
        let order: Vec<u32> = (0..).take(corners.len()).collect();
        let mut control = vec![0; interface.control_points * interface.control];
        let mut values = vec![0; interface.patch];
        let mut levels = [[0.0; 6]];
        self.program.run_control(
            self.level,
            bindings,
            ControlBatch {
                records: &records,
                corners: &order,
                patch_points: corners.len(),
                primitive_index: &[number.cast_unsigned()],
                control: &mut control,
                patches: &mut values,
                levels: &mut levels,
            },
        );
        let [[a, b, c, d, e, f]] = levels;
        ControlledPatch {
            control,
            values,
            number,
            outer: [a, b, c, d],
            inner: [e, f],
        }
    }

    fn evaluate(
        &self,
        patch: &ControlledPatch,
        coordinates: &[[f32; 3]],
        bindings: &Bindings,
    ) -> Vec<ClipVertex> {
        let output = &self.program.interface().output;
        let words = output.record_words();
        let mut records = vec![0; coordinates.len() * words];
        if !coordinates.is_empty() {
            self.program.run_evaluation(
                self.level,
                bindings,
                EvaluationBatch {
                    control: &patch.control,
                    patches: &patch.values,
                    primitive_index: &[patch.number.cast_unsigned()],
                    patch: &vec![0; coordinates.len()],
                    coordinates,
                    records: &mut records,
                },
            );
        }
        let records = records.chunks(words);
        records
            .map(|record| ClipVertex::of_record(record, output))
            .collect()
    }
}
