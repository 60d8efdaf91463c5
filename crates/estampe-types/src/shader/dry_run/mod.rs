//! The dry run: the interface of a shader, found by running it on numbers that record what is done
//! to them.
//!
//! A shader's body is straight-line code on lanes, apart from branches on its own fields, on
//! bindings, and on questions about masks ([`Real::any`](crate::Real::any)). The dry run is done
//! with the very value that will draw, so branches on fields are those that will be taken.
//! Questions are answered in three ways, truly, with yes and with no, so both branches are run.
//! Nothing is bound, so uses that depend on bindings are not found: constants declare them.
//!
//! * **Outputs** are what the returned value holds: colours, depth, a mask of kept lanes, …
//! * **Inputs** carry a mark. The first operation on a marked number, or its return, records that
//!   the input is used. So an unused field of [`FragmentIn`](crate::FragmentIn) costs nothing.
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

/// The interface of a shader: what its dry run finds, and what its constants declare beyond that.
///
/// # Errors
/// [`ShaderError`] says how the body contradicts a constant or a limit.
pub fn interface_of<T: Shader>(shader: &T) -> Result<Interface, ShaderError> {
    let declared = declared::<T>()?;
    let found = Found::of(shader, &declared)?;
    let interface = found.widen(declared);
    if T::COLOR_PASSTHROUGH && !runs::passes_color_through(shader, &interface)? {
        return Err(ShaderError::NoPassthrough);
    }
    if T::NO_DERIVATIVES
        && (found.takes_derivatives() || runs::depends_on_neighbours(shader, &interface)?)
    {
        return Err(ShaderError::Derivatives);
    }
    Ok(interface)
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
        color_passthrough: T::COLOR_PASSTHROUGH,
        no_derivatives: T::NO_DERIVATIVES,
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
    interface.per_sample |= interface.sampling.contains(&Sampling::Sample);
    Ok(interface)
}

#[cfg(test)]
mod tests;
