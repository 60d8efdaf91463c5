//! Contradictions between a shader's body and what it declares.

use super::amplification::{MAX_GEOMETRY_INVOCATIONS, MAX_GEOMETRY_VERTICES};
use super::fragment::MAX_COLORS;
use super::vertex::MAX_DISTANCES;
use crate::state::MAX_PATCH_POINTS;
use std::fmt;

/// Why no pipeline can be made of a shader: its body contradicts a constant of
/// [`Shader`](crate::Shader), or a limit. Found by the dry run; see
/// [the interface](crate::Shader#the-interface).
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShaderError {
    /// `COLOR_TARGETS` is beyond the limit.
    TooManyColors {
        /// The constant.
        count: usize,
    },
    /// The fragment sets the colour of a target beyond the limit.
    ColorIndex {
        /// The index of the target.
        index: usize,
    },
    /// The vertex sets a clip distance beyond the limit.
    ClipDistanceIndex {
        /// The index of the distance.
        index: usize,
    },
    /// The vertex sets a cull distance beyond the limit.
    CullDistanceIndex {
        /// The index of the distance.
        index: usize,
    },
    /// A tessellation shader makes no control points, or too many.
    ControlPoints {
        /// The constant `CONTROL_POINTS`.
        count: usize,
    },
    /// A geometry shader emits no vertices, or too many.
    GeometryVertices {
        /// The constant `MAX_VERTICES`.
        count: usize,
    },
    /// A geometry shader has no invocations, or too many.
    GeometryInvocations {
        /// The constant `INVOCATIONS`.
        count: usize,
    },
    /// The shader panicked.
    Panicked {
        /// The message of the panic.
        message: String,
    },
}

impl fmt::Display for ShaderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let last = MAX_COLORS - 1;
        let last_distance = MAX_DISTANCES - 1;
        match self {
            Self::TooManyColors { count } => write!(
                f,
                "the shader's COLOR_TARGETS is {count}; a fragment has at most {MAX_COLORS} colours"
            ),
            Self::ColorIndex { index } => write!(
                f,
                "the fragment sets the colour of target {index} (with_color); targets are 0 to {last}"
            ),
            Self::ClipDistanceIndex { index } => write!(
                f,
                "the vertex sets clip distance {index} (with_clip_distance); they are 0 to \
                 {last_distance}"
            ),
            Self::CullDistanceIndex { index } => write!(
                f,
                "the vertex sets cull distance {index} (with_cull_distance); they are 0 to \
                 {last_distance}"
            ),
            Self::ControlPoints { count } => write!(
                f,
                "the tessellation shader's CONTROL_POINTS is {count}; a patch has 1 to \
                 {MAX_PATCH_POINTS} control points"
            ),
            Self::GeometryVertices { count } => write!(
                f,
                "the geometry shader's MAX_VERTICES is {count}; an invocation emits 1 to \
                 {MAX_GEOMETRY_VERTICES} vertices"
            ),
            Self::GeometryInvocations { count } => write!(
                f,
                "the geometry shader's INVOCATIONS is {count}; it has 1 to \
                 {MAX_GEOMETRY_INVOCATIONS} for each primitive"
            ),
            Self::Panicked { message } => write!(
                f,
                "the shader panicked: {message}; a pipeline runs it once when it is created, with \
                 nothing bound, and it must not panic then either"
            ),
        }
    }
}

impl std::error::Error for ShaderError {}
