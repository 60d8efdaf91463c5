//! Where the inputs and outputs of a stage are in a batch: found once for the stage, so that a
//! batch names a few slices alone.

use super::batch::Widths;
use super::nondependent::Reads;
use super::read_place::{MOST as MOST_READS, scalar_of};
use estampe_ir::interface::{Input, Output};
use estampe_ir::interpreter::Part;

/// The data of a batch that inputs of a stage are parts of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    Attributes,
    VertexIndex,
    InstanceIndex,
    Varyings,
    /// The texels of a span of [reads](Reads), by its number.
    Texels(usize),
    Positions,
    FrontFacing,
    SampleIndex,
    SamplesCovered,
    Cover,
    Immediates,
}

/// The data of a batch that outputs of a stage are parts of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Target {
    Positions,
    Varyings,
    PointSizes,
    Distances,
    Colors,
    Depths,
    SampleMasks,
    Cover,
}

/// The most sources of a stage: texels of each read, and what else fragments have.
pub(super) const MOST: usize = MOST_READS + 8;

/// The inputs or outputs of a stage as parts of a batch's data.
#[derive(Debug)]
pub(super) struct Ends<T> {
    /// By input or output: its part of one of `data`.
    parts: Vec<Part>,
    /// Each once.
    data: Vec<T>,
}

impl<T> Default for Ends<T> {
    fn default() -> Self {
        Self {
            parts: Vec::new(),
            data: Vec::new(),
        }
    }
}

impl<T: PartialEq> Ends<T> {
    /// The ends whose data, and element there, are these; `None` for an input that is 0 or an
    /// output that is dropped.
    fn new(ends: impl Iterator<Item = Option<(T, usize)>>) -> Self {
        let mut all = Self::default();
        for end in ends {
            let part = end.map_or(Part::NONE, |(data, first)| all.part(data, first));
            all.parts.push(part);
        }
        all
    }

    fn part(&mut self, data: T, first: usize) -> Part {
        let found = self.data.iter().position(|one| *one == data);
        let at = found.unwrap_or_else(|| {
            self.data.push(data);
            self.data.len() - 1
        });
        // What lies beyond any slice is in none.
        let [data, first] = [at, first].map(|at| u32::try_from(at).unwrap_or(u32::MAX));
        Part { data, first }
    }

    /// The part that each input or output is.
    pub(super) fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The data that they are parts of.
    pub(super) fn data(&self) -> &[T] {
        &self.data
    }
}

impl Ends<Source> {
    /// The inputs of a vertex stage. `attributes` says at which scalar each location begins.
    pub(super) fn of_vertices(inputs: &[Input], attributes: &[usize]) -> Self {
        Self::new(inputs.iter().map(|input| {
            Some(match *input {
                Input::Attribute {
                    location,
                    component,
                } => {
                    let first = *attributes.get(location as usize)?;
                    (Source::Attributes, first + component as usize)
                }
                Input::VertexIndex => (Source::VertexIndex, 0),
                Input::InstanceIndex => (Source::InstanceIndex, 0),
                Input::Cover => (Source::Cover, 0),
                Input::PushConstant(at) => (Source::Immediates, at as usize),
                _ => return None,
            })
        }))
    }

    /// The inputs of a fragment stage. `gradients` lists the scalars that have derivatives, in
    /// ascending order.
    pub(super) fn of_fragments(
        inputs: &[Input],
        reads: &Reads,
        (widths, gradients): (Widths, &[usize]),
    ) -> Self {
        Self::new(inputs.iter().map(|input| {
            Some(match *input {
                Input::Varying(_) | Input::Derivative { .. } => {
                    (Source::Varyings, scalar_of(*input, widths, gradients)?)
                }
                Input::TextureRead { read, component } => {
                    let (span, first) = reads.place(read, component)?;
                    (Source::Texels(span), first)
                }
                Input::Position(part) => (Source::Positions, part as usize),
                Input::FrontFacing => (Source::FrontFacing, 0),
                Input::SampleIndex => (Source::SampleIndex, 0),
                Input::SampleMask => (Source::SamplesCovered, 0),
                Input::Cover => (Source::Cover, 0),
                Input::PushConstant(at) => (Source::Immediates, at as usize),
                _ => return None,
            })
        }))
    }
}

impl Ends<Target> {
    /// The outputs of a vertex stage. `varyings` says to which scalar of the fragments each scalar
    /// of the vertices goes.
    pub(super) fn of_vertices(outputs: &[Output], varyings: &[Option<u32>]) -> Self {
        Self::new(outputs.iter().map(|output| {
            Some(match *output {
                Output::Position(part) => (Target::Positions, part as usize),
                Output::Varying(scalar) => {
                    let to = (*varyings.get(scalar as usize)?)?;
                    (Target::Varyings, to as usize)
                }
                Output::PointSize => (Target::PointSizes, 0),
                Output::ClipDistance(at) => (Target::Distances, at as usize),
                _ => return None,
            })
        }))
    }

    /// The outputs of a fragment stage.
    pub(super) fn of_fragments(outputs: &[Output], widths: Widths) -> Self {
        Self::new(outputs.iter().map(|output| {
            Some(match *output {
                Output::Color { target, component } => {
                    (Target::Colors, (target * 4 + component) as usize)
                }
                Output::SecondColor(component) => {
                    (Target::Colors, widths.targets * 4 + component as usize)
                }
                Output::Depth => (Target::Depths, 0),
                Output::SampleMask => (Target::SampleMasks, 0),
                Output::Cover => (Target::Cover, 0),
                _ => return None,
            })
        }))
    }
}
