//! The dry run: the interface of a shader, found by running it on numbers that record what is done
//! to them.
//!
//! A shader's body is straight-line code on lanes, apart from branches on its own fields, on
//! bindings, and on questions about masks ([`Real::any`](crate::Real::any)). The dry run is done
//! with the very value that will draw, so branches on fields are those that will be taken.
//! Questions are answered in three ways, truly, with yes and with no, so both branches are run.
//! Nothing is bound, and words of bindings read as 0, 1, 2 and 3 in turn; where a shadow map may be
//! bound there is none, then one of as many texels along a side. So uses that depend on other
//! values, or on another resource that is bound, are not found: constants declare them.
//!
//! * **Outputs** are what the returned value holds: colours, depth, a mask of kept lanes, …
//! * **Inputs** carry a mark. The first operation on a marked number, or its return, records that
//!   the input is used. So an unused field of [`FragmentIn`](crate::FragmentIn) costs nothing.
//! * **Derivatives** are recorded, and so is what a texture takes its level of detail from. A
//!   fragment that takes none can be shaded beside fragments of other triangles. That holds only of
//!   a body that asks no question, looks at no single lane and misses no resource, as any of these
//!   may lead elsewhere in a draw.
//! * **Derivatives of varyings** that primitives give are inputs, too: where none is used, none is
//!   computed.
//! * **A colour that is passed through** consists of the first four scalars of the varyings, which
//!   still have their marks when they are returned.
//! * **Long loops** are those in which one run asks dozens of questions. It changes no result that
//!   they are not found, or wrongly.
//! * **Stores** are found if the stored lanes exclude helper invocations, as they must.
//!
//! The rejected alternative, accessors in place of the fields of `FragmentIn`, would find less: a
//! body that reads an input and ignores it looks like one that uses it.

mod amplification;
mod found;
mod number;
mod recorder;
mod runs;

pub(super) use amplification::{of_geometry, of_tessellation};

use super::{DepthOutput, Sampling};
use crate::{Attributes, Interface, Shader, ShaderError, Varyings};
use found::Found;
use recorder::Facts;

/// The interface of a shader: what its dry run finds, and what its constants declare beyond that.
///
/// # Errors
/// [`ShaderError`] says how the body contradicts a constant or a limit.
pub fn interface_of<T: Shader>(shader: &T) -> Result<Interface, ShaderError> {
    examine(shader).map(|examined| examined.interface)
}

/// What dry runs tell of a shader.
#[derive(Debug, Default)]
pub(super) struct Examined {
    pub(super) interface: Interface,
    /// Fragments have long loops that ask each time whether lanes are left. What depends on it may
    /// only be how fast they are shaded.
    pub(super) loops_long: bool,
}

/// The questions about masks of one run from which on the loops of a body are long.
const LONG: u32 = 32;

/// [`interface_of`], and whether fragments have long loops.
pub(super) fn examine<T: Shader>(shader: &T) -> Result<Examined, ShaderError> {
    let declared = declared::<T>()?;
    let mut found = Found::of(shader, &declared)?;
    if T::TAKES_DERIVATIVES {
        found.facts = found.facts.and(Facts::DERIVATIVES);
    }
    Ok(Examined {
        loops_long: found.questions >= LONG,
        interface: found.widen(declared),
    })
}

/// The interface that a shader's types and constants declare.
pub(super) fn declared<T: Shader>() -> Result<Interface, ShaderError> {
    if T::COLOR_TARGETS > super::fragment::MAX_COLORS {
        return Err(ShaderError::TooManyColors {
            count: T::COLOR_TARGETS,
        });
    }
    let mut interface = Interface {
        color_targets: T::COLOR_TARGETS,
        discards: T::DISCARDS,
        depth_output: T::DEPTH_OUTPUT,
        reads_position: T::READS_POSITION,
        writes_point_size: T::WRITES_POINT_SIZE,
        clip_distances: T::CLIP_DISTANCES,
        cull_distances: T::CULL_DISTANCES,
        per_sample: T::PER_SAMPLE,
        reads_coverage: T::READS_COVERAGE,
        writes_sample_mask: T::WRITES_SAMPLE_MASK,
        dual_source: T::DUAL_SOURCE,
        stores: T::STORES,
        stores_in_any_order: T::STORES_IN_ANY_ORDER,
        ..Interface::default()
    };
    T::Attributes::<f32>::components(&mut interface.attributes);
    T::Varyings::<f32>::modes(&mut interface.varyings);
    T::Varyings::<f32>::sampling(&mut interface.sampling);
    let mut have_gradients = Vec::new();
    T::Varyings::<f32>::gradients(&mut have_gradients);
    let with_gradient = |(scalar, has): (usize, bool)| has.then_some(scalar);
    interface.gradients = have_gradients
        .into_iter()
        .enumerate()
        .filter_map(with_gradient)
        .collect();
    interface.per_sample |= interface.sampling.contains(&Sampling::Sample);
    Ok(interface)
}

#[cfg(test)]
mod gradient_tests;
#[cfg(test)]
mod tests;
