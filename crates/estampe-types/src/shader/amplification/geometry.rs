//! Geometry shaders.

use super::points::{Points, ShadedPoint};
use crate::shader::VertexOut;
use crate::{Bindings, Real, Varyings};

/// Vertices that an invocation of a geometry shader emits, at most.
pub const MAX_GEOMETRY_VERTICES: usize = 256;

/// Invocations of a geometry shader for each primitive, at most.
pub const MAX_GEOMETRY_INVOCATIONS: usize = 32;

/// The primitives that a geometry shader reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GeometryPrimitive {
    /// One vertex.
    Points,
    /// Two vertices.
    Lines,
    /// Three vertices.
    Triangles,
    /// Four vertices: the line is (1, 2), the others belong to its neighbours.
    LinesAdjacency,
    /// Six vertices: the triangle is (0, 2, 4). Vertex 1 is opposite the edge (0, 2), vertex 3
    /// opposite (2, 4), vertex 5 opposite (4, 0).
    TrianglesAdjacency,
}

impl GeometryPrimitive {
    /// Vertices of a primitive.
    #[must_use]
    pub fn vertices(self) -> usize {
        match self {
            Self::Points => 1,
            Self::Lines => 2,
            Self::Triangles => 3,
            Self::LinesAdjacency => 4,
            Self::TrianglesAdjacency => 6,
        }
    }
}

/// The primitives that the emitted vertices of a geometry shader make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GeometryTopology {
    /// Each vertex is a point.
    PointList,
    /// Each vertex after the first of a strip ends a line.
    LineStrip,
    /// Each vertex after the second of a strip ends a triangle.
    TriangleStrip,
}

/// A geometry shader in Rust: it runs once for each primitive, or several times, and emits
/// vertices of new ones.
///
/// Write the implementation inside [`shader!`](macro@crate::shader). It runs on sixteen primitives
/// at a time: what one lane emits is named by a mask. Primitives keep the order of the primitives
/// that they were made of, then that of invocations, then that of emission.
///
/// ```
/// use estampe_types::{Vec4, shader::*};
///
/// /// Each triangle, and a copy of it that is moved to the right.
/// struct Twice;
///
/// estampe_types::shader! {
///     impl GeometryShader for Twice {
///         type Input<R: Real> = Vec4<R>;
///         type Output<R: Real> = Vec4<R>;
///         const INPUT: GeometryPrimitive = GeometryPrimitive::Triangles;
///         const OUTPUT: GeometryTopology = GeometryTopology::TriangleStrip;
///         const MAX_VERTICES: usize = 3;
///         const INVOCATIONS: usize = 2;
///
///         fn geometry<R: Real, E: Emit<R, Vec4<R>>>(
///             &self,
///             input: GeometryIn<'_, R, Vec4<R>>,
///             out: &mut E,
///         ) {
///             let all = input.zero.splat_mask(true);
///             let moved = if input.invocation == 0 { 0.0 } else { 0.5 };
///             for corner in 0..3 {
///                 let point = input.points.get(corner);
///                 let mut position = point.position;
///                 position.x += position.w * moved;
///                 out.emit(all, VertexOut::new(position, point.varyings));
///             }
///         }
///     }
/// }
/// ```
pub trait GeometryShader: Send + Sync + 'static {
    /// The varyings of the stage before: the vertex shader, or tessellation.
    type Input<R: Real>: Varyings<R>;
    /// The varyings of the emitted vertices.
    type Output<R: Real>: Varyings<R>;

    /// The primitives that are read.
    const INPUT: GeometryPrimitive;
    /// The primitives that are made.
    const OUTPUT: GeometryTopology;
    /// Vertices that an invocation emits at most, 1 to 256; those beyond are dropped.
    const MAX_VERTICES: usize;
    /// Invocations for each primitive, 1 to 32.
    const INVOCATIONS: usize = 1;
    /// Declares that vertices may set a point size, as
    /// [`Shader::WRITES_POINT_SIZE`](crate::Shader::WRITES_POINT_SIZE).
    const WRITES_POINT_SIZE: bool = false;
    /// Declares at least this many clip distances, at most 8.
    const CLIP_DISTANCES: usize = 0;
    /// Declares at least this many cull distances, at most 8.
    const CULL_DISTANCES: usize = 0;
    /// Declares that vertices may set a layer ([`EmittedVertex::with_layer`]).
    const WRITES_LAYER: bool = false;
    /// Declares that vertices may set a viewport index ([`EmittedVertex::with_viewport_index`]).
    const WRITES_VIEWPORT_INDEX: bool = false;
    /// As [`Shader`](crate::Shader)'s constant of this name.
    #[doc(hidden)]
    const ASSERTS_OUTPUTS: bool = cfg!(debug_assertions);

    /// Reads a primitive and emits vertices.
    fn geometry<R: Real, E: Emit<R, Self::Output<R>>>(
        &self,
        input: GeometryIn<'_, R, Self::Input<R>>,
        out: &mut E,
    );
}

/// The inputs of a geometry shader.
#[derive(Debug, Clone, Copy)]
pub struct GeometryIn<'a, R: Real, I> {
    /// The vertices of the primitive.
    pub points: Points<'a, R, ShadedPoint<R, I>>,
    /// The number of the primitive in its instance; of tessellated ones that of the patch.
    pub primitive_index: R::Int,
    /// The number of the invocation, the same in every lane.
    pub invocation: usize,
    /// The resources that the draw binds.
    pub bindings: &'a Bindings,
    /// A number of the shader's kind, to make constants from.
    pub zero: R,
}

/// The receiver of what a geometry shader emits.
pub trait Emit<R: Real, V> {
    /// Emits a vertex in the lanes of the mask. It follows the strip that the lane has begun.
    fn emit(&mut self, lanes: R::SelectMask, vertex: impl Into<EmittedVertex<R, V>>);

    /// Ends the strip of the lanes of the mask; the next vertex begins another one.
    fn end_primitive(&mut self, lanes: R::SelectMask);
}

/// A vertex that a geometry shader emits.
#[derive(Debug, Clone, Copy)]
pub struct EmittedVertex<R: Real, V> {
    /// Position, varyings, point size and distances.
    pub vertex: VertexOut<R, V>,
    /// The layer of the attachments, if the shader sets it.
    pub layer: Option<R::Int>,
    /// The number of the draw's viewport and scissor, if the shader sets it.
    pub viewport_index: Option<R::Int>,
}

impl<R: Real, V> EmittedVertex<R, V> {
    /// Draws the primitive into a layer of the attachments. The provoking vertex decides. A layer
    /// that they do not have counts as 0, which is also the default.
    #[inline(always)]
    #[must_use]
    pub fn with_layer(self, layer: R::Int) -> Self {
        Self {
            layer: Some(layer),
            ..self
        }
    }

    /// Draws the primitive in one of the draw's viewports. The provoking vertex decides. A number
    /// that the draw does not have counts as 0, which is also the default.
    #[inline(always)]
    #[must_use]
    pub fn with_viewport_index(self, index: R::Int) -> Self {
        Self {
            viewport_index: Some(index),
            ..self
        }
    }
}

impl<R: Real, V> From<VertexOut<R, V>> for EmittedVertex<R, V> {
    #[inline(always)]
    fn from(vertex: VertexOut<R, V>) -> Self {
        Self {
            vertex,
            layer: None,
            viewport_index: None,
        }
    }
}
