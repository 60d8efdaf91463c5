//! Assertions of debug builds: a shader outputs what its interface says.
//!
//! The dry run cannot find a use that depends on bindings. If such a use is not declared either, it
//! has no effect, and debug builds stop here; derivatives that are not declared are undefined.

use super::vertex::VertexOut;
use crate::{FragmentOut, Interface, Real, Shader, derivatives};

/// Asserts, in debug builds, that the interface has the outputs of a vertex.
#[inline(always)]
pub(super) fn assert_vertex<T: Shader, R, V>(interface: &Interface, out: &VertexOut<R, V>) {
    if !T::ASSERTS_OUTPUTS {
        return;
    }
    let is_beyond = |set: &[Option<R>], count: usize| set.iter().skip(count).any(Option::is_some);
    assert_found(
        interface.writes_point_size || out.point_size.is_none(),
        "the vertex sets its point size",
        "WRITES_POINT_SIZE",
    );
    assert_found(
        !is_beyond(&out.clip_distances, interface.clip_distances),
        "the vertex sets a clip distance",
        "CLIP_DISTANCES",
    );
    assert_found(
        !is_beyond(&out.cull_distances, interface.cull_distances),
        "the vertex sets a cull distance",
        "CULL_DISTANCES",
    );
}

/// Asserts, in debug builds, that the interface has the outputs of a fragment.
#[inline(always)]
pub(super) fn assert_fragment<T: Shader, R: Real>(interface: &Interface, out: &FragmentOut<R>) {
    if !T::ASSERTS_OUTPUTS {
        return;
    }
    let targets = interface.color_targets;
    assert_found(
        out.colors.iter().skip(targets).all(Option::is_none),
        "the fragment sets the colour of a further target",
        "COLOR_TARGETS",
    );
    assert_found(
        interface.dual_source || out.second.is_none(),
        "the fragment sets a second colour",
        "DUAL_SOURCE",
    );
    assert_found(
        interface.writes_sample_mask || out.sample_mask.is_none(),
        "the fragment sets a sample mask",
        "WRITES_SAMPLE_MASK",
    );
    assert_found(
        interface.discards || out.keep.is_none(),
        "the fragment discards",
        "DISCARDS",
    );
    assert_found(
        interface.depth_output != super::DepthOutput::None || out.depth.is_none(),
        "the fragment sets its depth",
        "DEPTH_OUTPUT",
    );
}

/// Asserts, in debug builds, that no derivatives were taken where the interface says that none are.
#[inline(always)]
pub(super) fn assert_derivatives<T: Shader>(interface: &Interface) {
    if T::ASSERTS_OUTPUTS {
        let were_taken = derivatives::were_taken();
        assert_found(
            !(were_taken && interface.no_derivatives),
            "the fragment takes derivatives",
            "TAKES_DERIVATIVES",
        );
    }
}

#[inline(always)]
fn assert_found(is_found: bool, does: &str, constant: &str) {
    assert!(
        is_found,
        "{does}, which it did not do with nothing bound; set {constant} of the shader"
    );
}
