//! Tessellation shaders.

use super::points::{Points, ShadedPoint};
use crate::shader::VertexOut;
use crate::{Bindings, Real, Varyings, Vec3};

/// A tessellation shader in Rust: its control functions run once for each patch of vertices, its
/// evaluation function for each vertex of the tessellated patch.
///
/// Write the implementation inside [`shader!`](macro@crate::shader), as that of
/// [`Shader`](trait@crate::Shader). Control functions run on sixteen patches at a time, the
/// evaluation on sixteen vertices. The domain, its spacing and the number of vertices of a patch
/// are state of the pipeline.
///
/// ```
/// use estampe_types::{Vec4, shader::*};
///
/// /// Flat triangles, divided evenly.
/// struct Divided { level: f32 }
///
/// estampe_types::shader! {
///     impl TessellationShader for Divided {
///         type Input<R: Real> = ();
///         type Control<R: Real> = Vec4<R>;
///         type Patch<R: Real> = ();
///         type Output<R: Real> = ();
///         const CONTROL_POINTS: usize = 3;
///
///         fn control<R: Real>(&self, input: ControlIn<'_, R, ()>) -> Vec4<R> {
///             input.points.get(input.index).position
///         }
///
///         fn patch<R: Real>(
///             &self,
///             input: PatchIn<'_, R, Vec4<R>>,
///         ) -> (TessellationLevels<R>, ()) {
///             (TessellationLevels::repeat(input.zero.splat(self.level)), ())
///         }
///
///         fn evaluate<R: Real>(
///             &self,
///             input: EvaluationIn<'_, R, Vec4<R>>,
///             _: (),
///         ) -> VertexOut<R, ()> {
///             let [a, b, c] = [0, 1, 2].map(|corner| input.points.get(corner));
///             let at = input.coordinates;
///             VertexOut::new(a * at.x + b * at.y + c * at.z, ())
///         }
///     }
/// }
/// ```
///
/// # Edges that patches share
///
/// The coordinates along an edge depend on its level alone, and 1 − u is exact, so the points of an
/// edge are the same to the bit from either side. Patches that compute the level and the positions
/// of a shared edge from the edge alone, in sums of two products, therefore have no cracks.
pub trait TessellationShader: Send + Sync + 'static {
    /// The varyings of the vertex shader.
    type Input<R: Real>: Varyings<R>;
    /// A control point, as the control function makes it.
    type Control<R: Real>: Varyings<R>;
    /// Values of a patch, for the evaluation of all of its vertices.
    type Patch<R: Real>: Varyings<R>;
    /// The varyings of the tessellated vertices.
    type Output<R: Real>: Varyings<R>;

    /// Control points that the control function makes of a patch, 1 to 32.
    const CONTROL_POINTS: usize;
    /// Declares that the evaluation may set a point size, as
    /// [`Shader::WRITES_POINT_SIZE`](crate::Shader::WRITES_POINT_SIZE).
    const WRITES_POINT_SIZE: bool = false;
    /// Declares at least this many clip distances, at most 8.
    const CLIP_DISTANCES: usize = 0;
    /// Declares at least this many cull distances, at most 8.
    const CULL_DISTANCES: usize = 0;
    /// As [`Shader`](crate::Shader)'s constant of this name.
    #[doc(hidden)]
    const ASSERTS_OUTPUTS: bool = cfg!(debug_assertions);

    /// Makes control point [`ControlIn::index`] of a patch.
    fn control<R: Real>(&self, input: ControlIn<'_, R, Self::Input<R>>) -> Self::Control<R>;

    /// Chooses the levels of a patch, and makes the values of the whole patch.
    fn patch<R: Real>(
        &self,
        input: PatchIn<'_, R, Self::Control<R>>,
    ) -> (TessellationLevels<R>, Self::Patch<R>);

    /// Makes the vertex at [`EvaluationIn::coordinates`] of a patch.
    fn evaluate<R: Real>(
        &self,
        input: EvaluationIn<'_, R, Self::Control<R>>,
        patch: Self::Patch<R>,
    ) -> VertexOut<R, Self::Output<R>>;
}

/// The inputs of a control function.
#[derive(Debug, Clone, Copy)]
pub struct ControlIn<'a, R: Real, I> {
    /// The number of the control point that is made, the same in every lane.
    pub index: usize,
    /// The vertices of the patch.
    pub points: Points<'a, R, ShadedPoint<R, I>>,
    /// The number of the patch in its instance.
    pub primitive_index: R::Int,
    /// The resources that the draw binds.
    pub bindings: &'a Bindings,
    /// A number of the shader's kind, to make constants from.
    pub zero: R,
}

/// The inputs of the function of a whole patch.
#[derive(Debug, Clone, Copy)]
pub struct PatchIn<'a, R: Real, C> {
    /// The control points of the patch.
    pub points: Points<'a, R, C>,
    /// The number of the patch in its instance.
    pub primitive_index: R::Int,
    /// The resources that the draw binds.
    pub bindings: &'a Bindings,
    /// A number of the shader's kind, to make constants from.
    pub zero: R,
}

/// The inputs of an evaluation.
#[derive(Debug, Clone, Copy)]
pub struct EvaluationIn<'a, R: Real, C> {
    /// The place in the domain: barycentric (u, v, w) of triangles, (u, v, 0) of quads and
    /// isolines. All are multiples of 2⁻²⁴.
    pub coordinates: Vec3<R>,
    /// The control points of the patch.
    pub points: Points<'a, R, C>,
    /// The number of the patch in its instance.
    pub primitive_index: R::Int,
    /// The resources that the draw binds.
    pub bindings: &'a Bindings,
    /// A number of the shader's kind, to make constants from.
    pub zero: R,
}

/// The levels of a patch: see
/// [`TessellationDomain`](crate::state::TessellationDomain) for the edges that they divide. A patch
/// with an outer level that its domain uses and that is not above 0, or NaN, is dropped.
#[derive(Debug, Clone, Copy)]
pub struct TessellationLevels<R> {
    /// The levels of the edges.
    pub outer: [R; 4],
    /// The levels of the inside.
    pub inner: [R; 2],
}

impl<R: Copy> TessellationLevels<R> {
    /// One level for everything.
    #[inline(always)]
    #[must_use]
    pub fn repeat(level: R) -> Self {
        Self {
            outer: [level; 4],
            inner: [level; 2],
        }
    }
}
