//! The dry runs of tessellation and geometry shaders, which find the outputs of their vertices.

use super::number::Recorded;
use super::recorder::{Answers, Facts, Recorder};
use super::runs::unwound;
use crate::shader::amplification::{
    ControlIn, Emit, EmittedVertex, EvaluationIn, GeometryIn, GeometryInterface, GeometryShader,
    OutputsFound, PatchIn, Records, TessellationInterface, TessellationShader,
};
use crate::{Bindings, Quad, Real, ShaderError, Vec3};

/// The ways in which questions about masks are answered: see `found`.
fn ways() -> &'static [Answers] {
    if cfg!(panic = "unwind") {
        &[Answers::True, Answers::SomeLane, Answers::NoLane]
    } else {
        &[Answers::True]
    }
}

/// Runs `shade` in each way; a panic is an error only if the answers were true.
fn run(mut shade: impl FnMut(&Recorder)) -> Result<(), ShaderError> {
    for &answers in ways() {
        let recorder = Recorder::new(answers);
        match unwound(|| shade(&recorder)) {
            Err(ShaderError::Panicked { .. }) if answers != Answers::True => {}
            Err(error) => return Err(error),
            Ok(()) => {
                if let Some(error) = recorder.misuse() {
                    return Err(error);
                }
            }
        }
    }
    Ok(())
}

fn zero(recorder: &Recorder) -> Recorded<'_> {
    Recorded::new(Quad([0.0; 4]), Facts::NONE, recorder)
}

/// Runs a tessellation shader on zeros, and adds the outputs that it sets to the interface.
pub(in crate::shader) fn of_tessellation<T: TessellationShader>(
    shader: &T,
    interface: &mut TessellationInterface,
) -> Result<(), ShaderError> {
    let bindings = Bindings::default();
    let words = 4 + interface.input + interface.control + interface.patch;
    let zeros = vec![0; words * (T::CONTROL_POINTS + 1)];
    let records = |words, count| Records {
        records: &zeros,
        corners: None,
        words,
        count,
    };
    run(|recorder| {
        let zero = zero(recorder);
        let primitive_index = zero.splat_int(0);
        for index in 0..T::CONTROL_POINTS {
            let _ = shader.control(ControlIn {
                index,
                points: records(0, 1).points(zero, |_| 0),
                primitive_index,
                bindings: &bindings,
                zero,
            });
        }
        let control = records(interface.control, T::CONTROL_POINTS);
        let (_, values) = shader.patch(PatchIn {
            points: control.points(zero, |_| 0),
            primitive_index,
            bindings: &bindings,
            zero,
        });
        let input = EvaluationIn {
            coordinates: Vec3::new(zero, zero, zero),
            points: control.points(zero, |_| 0),
            primitive_index,
            bindings: &bindings,
            zero,
        };
        let out = shader.evaluate(input, values);
        OutputsFound::of(&out).widen(&mut interface.output);
    })
}

/// Runs a geometry shader on zeros, and adds the outputs that it sets to the interface.
pub(in crate::shader) fn of_geometry<T: GeometryShader>(
    shader: &T,
    interface: &mut GeometryInterface,
) -> Result<(), ShaderError> {
    let bindings = Bindings::default();
    let words = 4 + interface.input;
    let count = T::INPUT.vertices();
    let zeros = vec![0; words * count];
    run(|recorder| {
        let zero = zero(recorder);
        for invocation in 0..T::INVOCATIONS {
            let records = Records {
                records: &zeros,
                corners: None,
                words,
                count,
            };
            let input = GeometryIn {
                points: records.points(zero, |_| 0),
                primitive_index: zero.splat_int(0),
                invocation,
                bindings: &bindings,
                zero,
            };
            shader.geometry(input, &mut Finder(interface));
        }
    })
}

/// Receives what a shader emits, and notes which outputs are set.
struct Finder<'a>(&'a mut GeometryInterface);

impl<R: Real, V> Emit<R, V> for Finder<'_> {
    fn emit(&mut self, _: R::SelectMask, vertex: impl Into<EmittedVertex<R, V>>) {
        let vertex = vertex.into();
        OutputsFound::of(&vertex.vertex).widen(&mut self.0.output);
        self.0.writes_layer |= vertex.layer.is_some();
        self.0.writes_viewport_index |= vertex.viewport_index.is_some();
    }

    fn end_primitive(&mut self, _: R::SelectMask) {}
}
