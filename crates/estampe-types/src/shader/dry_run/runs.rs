//! Single runs of a shader on recording numbers.

use super::found::Found;
use super::number::Recorded;
use super::recorder::{Answers, Facts, Recorder};
use super::{DepthOutput, Shader, ShaderError};
use crate::shader::{FragmentOut, Source};
use crate::{Attributes, Bindings, FragmentIn, Interface, Quad, Varyings, Vec4, VertexIn};
use std::panic::{AssertUnwindSafe, catch_unwind};

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
        Recorded::new(Quad(lanes), Facts::NONE, self.recorder)
    }
}

/// Runs the vertex shader on zeros.
pub(super) fn vertex<T: Shader>(shader: &T, answers: Answers) -> Result<Found, ShaderError> {
    let recorder = Recorder::new(answers);
    let bindings = Bindings::default();
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
            recorder: &recorder,
        };
        let out = shader.vertex(input, T::Attributes::load(&mut source));
        Found {
            point_size: out.point_size.is_some(),
            clip_distances: set(&out.clip_distances),
            cull_distances: set(&out.cull_distances),
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
/// that it stores nothing. Returns the numbers of its outputs too.
pub(super) fn fragment<T: Shader>(
    shader: &T,
    answers: Answers,
    varyings: &Scalars,
) -> Result<(Found, Vec<[f32; 4]>), ShaderError> {
    let recorder = Recorder::new(answers);
    let bindings = Bindings::default();
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
            recorder: &recorder,
        };
        let out = shader.fragment(input, T::Varyings::load(&mut source));
        let found = Found {
            color_targets: set(&out.colors),
            second_color: out.second.is_some(),
            discards: out.keep.is_some(),
            sample_mask: out.sample_mask.is_some(),
            depth: out.depth.is_some(),
            no_depth: out.depth.is_none(),
            ..Found::default()
        };
        (found, numbers(&out))
    };
    let (found, numbers) = unwound(shade)?;
    let facts = recorder.facts();
    match recorder.misuse() {
        Some(error) => Err(error),
        None => Ok((Found { facts, ..found }, numbers)),
    }
}

/// The numbers of all outputs, which are thereby used.
fn numbers(out: &FragmentOut<Recorded<'_>>) -> Vec<[f32; 4]> {
    let colors = out.colors.iter().chain([&out.second]).flatten();
    let components = colors.flat_map(|color| [color.x, color.y, color.z, color.w]);
    let mut all: Vec<_> = components
        .chain(out.depth)
        .map(|number| number.used().0)
        .collect();
    all.extend(
        out.keep
            .map(|keep| keep.used().0.map(|kept| if kept { 1.0 } else { 0.0 })),
    );
    all.extend(out.sample_mask.map(|mask| {
        mask.used()
            .0
            .map(|bits| f32::from_bits(bits.cast_unsigned()))
    }));
    all
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

/// True if the fragment returns the first four scalars of its varyings as its only output, for
/// sixteen colours of which some are outside 0..=1.
pub(super) fn passes_color_through<T: Shader>(
    shader: &T,
    interface: &Interface,
) -> Result<bool, ShaderError> {
    let scalars = interface.varyings.len();
    if interface.discards
        || interface.reads_position
        || interface.depth_output != DepthOutput::None
        || interface.color_targets != 1
        || interface.dual_source
        || interface.stores
        || interface.writes_sample_mask
        || scalars < 4
    {
        return Ok(false);
    }
    for quad in 0..4 {
        let number = |scalar: usize, lane: usize| ((scalar * 4 + quad) * 4 + lane + 1) as f32;
        let lanes = |scalar| [0, 1, 2, 3].map(|lane| number(scalar, lane) * 0.037 - 0.5);
        let varyings: Vec<_> = (0..scalars).map(lanes).collect();
        let (_, colors) = fragment(shader, Answers::True, &varyings)?;
        if colors != varyings[..4] {
            return Ok(false);
        }
    }
    Ok(true)
}

/// True if the first fragment of a quad has another result when only its neighbours' varyings
/// change. So a texture shows that takes its level of detail from the lanes.
pub(super) fn depends_on_neighbours<T: Shader>(
    shader: &T,
    interface: &Interface,
) -> Result<bool, ShaderError> {
    let varyings = plain_varyings(interface.varyings.len());
    let mut changed = varyings.clone();
    for (scalar, lanes) in changed.iter_mut().enumerate() {
        for (lane, value) in lanes.iter_mut().enumerate().skip(1) {
            *value = 1.0 - fraction(scalar * 331 + lane * 1009);
        }
    }
    let first = |varyings: &Scalars| {
        let (_, numbers) = fragment(shader, Answers::True, varyings)?;
        Ok(numbers
            .iter()
            .map(|lanes| lanes[0].to_bits())
            .collect::<Vec<_>>())
    };
    Ok(first(&varyings)? != first(&changed)?)
}
