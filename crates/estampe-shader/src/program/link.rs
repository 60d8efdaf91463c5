//! Two stages as one interface: which scalar of the vertices goes to which of the fragments.

use super::StageSource;
use super::facts::Facts;
use estampe_ir::interface::{Input, Output};
use estampe_types::BindingType;
use estampe_types::shader::{DepthOutput, Interface, Interpolation, Sampling};
use std::collections::BTreeSet;

/// A varying: some scalars at a location.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VaryingSlot {
    /// The location.
    pub location: u32,
    /// The number of its scalars, 1 to 4.
    pub components: u32,
    /// The position of its first scalar among those of the stage.
    pub first: u32,
    /// How it is interpolated.
    pub interpolation: Interpolation,
    /// Where it is interpolated.
    pub sampling: Sampling,
}

/// What two stages disagree about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LinkError {
    /// The fragment stage reads a location that the vertex stage does not write.
    #[error(
        "the fragment shader reads location {location}, which the vertex shader does not write: \
         write it there, or do not read it"
    )]
    NotWritten {
        /// The location.
        location: u32,
    },
    /// The fragment stage reads more scalars of a location than the vertex stage writes.
    #[error(
        "the fragment shader reads {read} scalars of location {location}, of which the vertex \
         shader writes {written}: give both the same type"
    )]
    Components {
        /// The location.
        location: u32,
        /// Scalars that the fragment stage reads.
        read: u32,
        /// Scalars that the vertex stage writes.
        written: u32,
    },
    /// The stages declare a location to be interpolated in different ways.
    #[error(
        "location {location} is {vertex:?} in the vertex shader and {fragment:?} in the fragment \
         shader: declare the same interpolation in both"
    )]
    Interpolation {
        /// The location.
        location: u32,
        /// That of the vertex stage.
        vertex: Interpolation,
        /// That of the fragment stage.
        fragment: Interpolation,
    },
    /// The vertex shader stores.
    #[error(
        "the vertex shader stores to a buffer or texture: vertices may be shaded more than once; \
         store in the fragment shader or in a compute shader"
    )]
    VertexStores,
    /// Work-groups are too large.
    #[error(
        "work-groups of {}x{}x{} invocations: at most {} together",
        size[0], size[1], size[2], super::compute::MAX_INVOCATIONS
    )]
    Invocations {
        /// The invocations along x, y and z.
        size: [u32; 3],
    },
    /// The stages bind different kinds of resources at the same number.
    #[error(
        "group {group}, binding {binding} is {vertex} in the vertex shader and {fragment} in the \
         fragment shader: give one of them another number"
    )]
    Binding {
        /// The group.
        group: u32,
        /// The binding.
        binding: u32,
        /// That of the vertex stage.
        vertex: BindingType,
        /// That of the fragment stage.
        fragment: BindingType,
    },
}

/// Where the scalars of the vertices go.
#[derive(Debug)]
pub(super) struct Links {
    /// For each scalar of the vertices, the scalar of the fragments; `None` if no fragment reads
    /// it.
    of_vertex: Vec<Option<u32>>,
    /// The interpolation and the place of each scalar that fragments read.
    read: Vec<(Interpolation, Sampling)>,
}

impl Links {
    /// Links two stages. The varyings that the fragment stage does not read are dropped, and those
    /// that it reads are numbered anew, with their derivatives.
    pub(super) fn new(
        vertex: &StageSource,
        fragment: Option<&mut StageSource>,
    ) -> Result<Self, LinkError> {
        let ends = vertex
            .varyings
            .iter()
            .map(|slot| slot.first + slot.components);
        let scalars = ends.max().unwrap_or(0);
        let mut of_vertex = vec![None; scalars as usize];
        let mut read_scalars = Vec::new();
        let Some(fragment) = fragment else {
            return Ok(Self {
                of_vertex,
                read: read_scalars,
            });
        };
        let inputs = &mut fragment.tree.interface.inputs;
        let unlinked = inputs.clone();
        for read in &fragment.varyings {
            let location = read.location;
            let mut written = vertex
                .varyings
                .iter()
                .filter(|slot| slot.location == location);
            let written = written.next().ok_or(LinkError::NotWritten { location })?;
            if written.components < read.components {
                return Err(LinkError::Components {
                    location,
                    read: read.components,
                    written: written.components,
                });
            }
            if written.interpolation != read.interpolation {
                return Err(LinkError::Interpolation {
                    location,
                    vertex: written.interpolation,
                    fragment: read.interpolation,
                });
            }
            for component in 0..read.components {
                let scalar = read.first + component;
                let number = u32::try_from(read_scalars.len()).unwrap_or(u32::MAX);
                let mut is_read = false;
                for (input, unlinked) in inputs.iter_mut().zip(&unlinked) {
                    *input = match *unlinked {
                        Input::Varying(of) if of == scalar => Input::Varying(number),
                        Input::Derivative { scalar: of, axis } if of == scalar => {
                            let scalar = number;
                            Input::Derivative { scalar, axis }
                        }
                        _ => continue,
                    };
                    is_read = true;
                }
                if !is_read {
                    continue;
                }
                of_vertex[(written.first + component) as usize] = Some(number);
                read_scalars.push((read.interpolation, read.sampling));
            }
        }
        Ok(Self {
            of_vertex,
            read: read_scalars,
        })
    }

    pub(super) fn of_vertex(&self) -> &[Option<u32>] {
        &self.of_vertex
    }
}

/// The interface of the program: the attributes of the vertices, and the varyings that fragments
/// read.
pub(super) fn interface(
    vertex: &StageSource,
    fragment: Option<&StageSource>,
    links: &Links,
) -> Interface {
    let mut interface = Interface {
        attributes: attributes(&vertex.tree.interface.inputs),
        writes_point_size: vertex.tree.interface.outputs.contains(&Output::PointSize),
        clip_distances: clip_distances(&vertex.tree.interface.outputs),
        no_derivatives: true,
        ..Interface::default()
    };
    debug_assert!(links.of_vertex.len() < 1 << 16, "a location has 4 scalars");
    let Some(fragment) = fragment else {
        return interface;
    };
    (interface.varyings, interface.sampling) = links.read.iter().copied().unzip();
    let (inputs, outputs) = (
        &fragment.tree.interface.inputs,
        &fragment.tree.interface.outputs,
    );
    interface.gradients = gradients(inputs);
    let targets = outputs.iter().filter_map(|output| match output {
        Output::Color { target, .. } => Some(*target as usize + 1),
        _ => None,
    });
    interface.color_targets = targets.max().unwrap_or(0);
    interface.color_types.clone_from(&fragment.color_types);
    interface.dual_source = outputs
        .iter()
        .any(|output| matches!(output, Output::SecondColor(_)));
    interface.depth_output = if outputs.contains(&Output::Depth) {
        DepthOutput::Any
    } else {
        DepthOutput::None
    };
    interface.reads_position = inputs
        .iter()
        .any(|input| matches!(input, Input::Position(_)));
    interface.per_sample =
        inputs.contains(&Input::SampleIndex) || interface.sampling.contains(&Sampling::Sample);
    interface.reads_coverage = inputs.contains(&Input::SampleMask);
    interface.writes_sample_mask = outputs.contains(&Output::SampleMask);
    Facts::of(&fragment.tree).add_to(&mut interface);
    interface
}

/// The scalars of the varyings whose derivatives are read, in ascending order.
fn gradients(inputs: &[Input]) -> Vec<usize> {
    let scalars = inputs.iter().filter_map(|input| match *input {
        Input::Derivative { scalar, .. } => Some(scalar as usize),
        _ => None,
    });
    scalars.collect::<BTreeSet<usize>>().into_iter().collect()
}

/// The components of each attribute that is read, by location.
fn attributes(inputs: &[Input]) -> Vec<usize> {
    let mut attributes = Vec::new();
    for input in inputs {
        if let Input::Attribute {
            location,
            component,
        } = *input
        {
            let at = location as usize;
            if attributes.len() <= at {
                attributes.resize(at + 1, 0);
            }
            attributes[at] = attributes[at].max(component as usize + 1);
        }
    }
    attributes
}

fn clip_distances(outputs: &[Output]) -> usize {
    let distances = outputs.iter().filter_map(|output| match output {
        Output::ClipDistance(at) => Some(*at as usize + 1),
        _ => None,
    });
    distances.max().unwrap_or(0)
}
