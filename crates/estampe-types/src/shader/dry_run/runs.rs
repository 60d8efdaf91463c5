//! Single runs of a shader on recording numbers.

use super::found::Found;
use super::number::Recorded;
use super::recorder::{Answers, Facts, Recorder};
use super::{Shader, ShaderError};
use crate::bindings::Unbound;
use crate::shader::{FragmentOut, Source};
use crate::{Attributes, Bindings, FragmentIn, Quad, Varyings, Vec4, VertexIn};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// The lanes of a quad, for each scalar.
type Scalars = [[f32; 4]];

/// Different numbers in 0..1 for each scalar and lane: an index made of them is 0.
pub(super) fn plain_varyings(scalars: usize) -> Vec<[f32; 4]> {
    let lanes = |scalar: usize| [0, 1, 2, 3].map(|lane| fraction(scalar * 4 + lane));
    (0..scalars).map(lanes).collect()
}

/// A number in 0..1, different for the first thousands of numbers.
fn fraction(number: usize) -> f32 {
    (number % 4093 + 1) as f32 / 4096.0
}

/// Scalars of a run, in order, then zeros.
struct Scripted<'a, 'r> {
    left: &'a Scalars,
    /// The number of the next scalar, where each has a mark.
    number: Option<usize>,
    recorder: &'r Recorder,
}

impl<'r> Source<Recorded<'r>> for Scripted<'_, 'r> {
    fn take(&mut self) -> Recorded<'r> {
        let lanes = match self.left.split_first() {
            Some((first, rest)) => {
                self.left = rest;
                *first
            }
            None => [0.0; 4],
        };
        let input = self.number.map_or(Facts::NONE, Facts::varying);
        self.number = self.number.map(|number| number + 1);
        Recorded::new(Quad(lanes), input, self.recorder)
    }

    fn take_derivative(&mut self, axis: usize, _like: Recorded<'r>) -> Recorded<'r> {
        let lanes = [0, 1, 2, 3].map(|lane| fraction(lane + 4 * axis));
        Recorded::new(Quad(lanes), Facts::GRADIENT, self.recorder)
    }
}

/// Bindings of a run in which nothing is bound.
fn unbound(word: u16) -> (Arc<Unbound>, Bindings) {
    let unbound = Arc::new(Unbound::new(word));
    let bindings = Bindings {
        unbound: Some(unbound.clone()),
        ..Bindings::default()
    };
    (unbound, bindings)
}

/// Runs the vertex shader on zeros.
pub(super) fn vertex<T: Shader>(
    shader: &T,
    answers: Answers,
    word: u16,
) -> Result<Found, ShaderError> {
    let recorder = Recorder::new(answers);
    let (unbound, bindings) = unbound(word);
    let shade = || {
        let zeros = Recorded::new(Quad([0; 4]), Facts::NONE, &recorder);
        let input = VertexIn {
            vertex_index: zeros,
            instance_index: zeros,
            bindings: &bindings,
            zero: Recorded::new(Quad([0.0; 4]), Facts::NONE, &recorder),
        };
        let mut source = Scripted {
            left: &[],
            number: None,
            recorder: &recorder,
        };
        let out = shader.vertex(input, T::Attributes::load(&mut source));
        Found {
            point_size: out.point_size.is_some(),
            clip_distances: set(&out.clip_distances),
            cull_distances: set(&out.cull_distances),
            reads_words: unbound.reads_words(),
            ..Found::default()
        }
    };
    let found = unwound(shade)?;
    recorder.misuse().map_or(Ok(found), Err)
}

/// The number of elements up to the last one that is set.
fn set<T>(elements: &[Option<T>]) -> usize {
    let last = elements.iter().rposition(Option::is_some);
    last.map_or(0, |last| last + 1)
}

/// Runs the fragment shader on the quad in the upper left corner, all of it helper invocations, so
/// that it stores nothing.
pub(super) fn fragment<T: Shader>(
    shader: &T,
    answers: Answers,
    word: u16,
    varyings: &Scalars,
) -> Result<Found, ShaderError> {
    let recorder = Recorder::new(answers);
    let (unbound, bindings) = unbound(word);
    let shade = || {
        let position = |lanes| Recorded::new(Quad(lanes), Facts::POSITION, &recorder);
        let ints = |value, input| Recorded::new(Quad([value; 4]), input, &recorder);
        let masks = |value, input| Recorded::new(Quad([value; 4]), input, &recorder);
        let input = FragmentIn {
            position: Vec4::new(
                position([0.5, 1.5, 0.5, 1.5]),
                position([0.5, 0.5, 1.5, 1.5]),
                position([0.5; 4]),
                position([1.0; 4]),
            ),
            front_facing: masks(true, Facts::NONE),
            is_helper: masks(true, Facts::HELPER),
            sample_index: ints(0, Facts::SAMPLE_INDEX),
            coverage: ints(1, Facts::COVERAGE),
            bindings: &bindings,
            zero: Recorded::new(Quad([0.0; 4]), Facts::NONE, &recorder),
        };
        let mut source = Scripted {
            left: varyings,
            number: Some(0),
            recorder: &recorder,
        };
        let out = shader.fragment(input, T::Varyings::load(&mut source));
        use_all(&out);
        if unbound.is_missed() {
            recorder.note(Facts::UNKNOWN.and(Facts::UNTRIED));
        }
        Found {
            color_targets: set(&out.colors),
            second_color: out.second.is_some(),
            changes_color: !passes_color(&out),
            discards: out.keep.is_some(),
            sample_mask: out.sample_mask.is_some(),
            depth: out.depth.is_some(),
            no_depth: out.depth.is_none(),
            reads_words: unbound.reads_words(),
            ..Found::default()
        }
    };
    let found = unwound(shade)?;
    let (facts, questions) = (recorder.facts(), recorder.questions());
    match recorder.misuse() {
        Some(error) => Err(error),
        None => Ok(Found {
            facts,
            questions,
            ..found
        }),
    }
}

/// Records that all outputs are used.
fn use_all(out: &FragmentOut<Recorded<'_>>) {
    for Vec4 { x, y, z, w } in out.colors.iter().chain([&out.second]).flatten() {
        for component in [x, y, z, w] {
            component.used();
        }
    }
    out.depth.map(Recorded::used);
    out.keep.map(Recorded::used);
    out.sample_mask.map(Recorded::used);
}

/// True if the first colour consists of the first four scalars of the varyings, in order.
fn passes_color(out: &FragmentOut<Recorded<'_>>) -> bool {
    out.colors[0].is_some_and(|Vec4 { x, y, z, w }| {
        let mut components = [x, y, z, w].into_iter().enumerate();
        components.all(|(number, component)| component.is(Facts::varying(number)))
    })
}

/// The result of a run, or its panic.
pub(super) fn unwound<U>(run: impl FnOnce() -> U) -> Result<U, ShaderError> {
    // The shader is shared by reference, and what it may have left half done is its own affair:
    // every thread that shades has this freedom.
    catch_unwind(AssertUnwindSafe(run)).map_err(|panic| {
        let message = match panic.downcast::<String>() {
            Ok(message) => *message,
            Err(panic) => match panic.downcast::<&str>() {
                Ok(message) => (*message).to_owned(),
                Err(_) => "no message".to_owned(),
            },
        };
        ShaderError::Panicked { message }
    })
}
