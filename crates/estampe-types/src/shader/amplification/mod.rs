//! The stages between vertices and primitives: tessellation and the geometry shader.
//!
//! Vertices travel between these stages as *records*: the words of a vertex one after the other. A
//! shader reads the records of its patch or primitive through [`Points`], which gathers the words
//! of sixteen patches, or repeats those of one.

mod geometry;
mod geometry_program;
mod output;
mod points;
mod record_sink;
mod tessellation;
mod tessellation_program;

pub use geometry::{
    Emit, EmittedVertex, GeometryIn, GeometryPrimitive, GeometryShader, GeometryTopology,
    MAX_GEOMETRY_INVOCATIONS, MAX_GEOMETRY_VERTICES,
};
pub use geometry_program::{
    GeometryBatch, GeometryInterface, GeometryProgram, GeometryShaderProgram,
};
pub use output::OutputInterface;
pub(crate) use output::OutputsFound;
pub(crate) use points::Records;
pub use points::{Points, ShadedPoint};
pub use tessellation::{ControlIn, EvaluationIn, PatchIn, TessellationLevels, TessellationShader};
pub use tessellation_program::{
    ControlBatch, EvaluationBatch, TessellationInterface, TessellationProgram,
    TessellationShaderProgram,
};
