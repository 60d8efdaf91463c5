//! Tessellation: the domain of a patch in exact rationals, and the vertices of its primitives.
//!
//! In · Out: the vertices of patches · the vertices of points, lines or triangles, as a list.
//! Spec: Vulkan §Tessellation; docs/NUMERICS.md, *Tessellation*.

mod domain;
mod edge;
mod fraction;
mod patch_shaders;

pub use domain::{Domain, divide};
pub use edge::Edge;
pub use fraction::Fraction;
pub use patch_shaders::{ControlledPatch, PatchShaders, ProgramPatches, RustPatches};

use crate::pipeline::draw_runs;
use crate::program::{RustShaders, Shaders};
use crate::shading::shade_vertex;
use crate::{ClipVertex, Draw, State};
use estampe_types::shader::{Shader, TessellationShader};
use estampe_types::state::TessellationMode;

/// The tessellation stage of a draw.
#[derive(Clone, Copy)]
pub struct Tessellation<'a> {
    /// The shaders of patches.
    pub shaders: &'a dyn PatchShaders,
    /// How domains are divided.
    pub mode: &'a TessellationMode,
    /// Vertices of a patch, at least 1.
    pub patch_points: u32,
}

impl std::fmt::Debug for Tessellation<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Tessellation")
            .field("mode", self.mode)
            .field("patch_points", &self.patch_points)
            .finish_non_exhaustive()
    }
}

/// A patch, divided.
#[derive(Debug, Clone, PartialEq)]
pub struct TessellatedPatch {
    /// The index of the instance.
    pub instance: u32,
    /// The number of the patch in its instance.
    pub number: i32,
    /// The positions of its vertices in the draw's range.
    pub positions: Vec<u32>,
    /// Its vertices, as the vertex shader left them.
    pub corners: Vec<ClipVertex>,
    /// The outer levels, as the shader left them.
    pub outer: [f32; 4],
    /// The inner levels, as the shader left them.
    pub inner: [f32; 2],
    /// The points of the divided domain.
    pub coordinates: Vec<[f32; 3]>,
    /// The vertex of each point.
    pub vertices: Vec<ClipVertex>,
    /// The points of each primitive.
    pub primitives: Vec<Vec<usize>>,
}

/// The vertices that tessellation makes of a draw's patches, and for each of its primitives the
/// number of the patch. A shader of which no pipeline can be made makes none.
pub fn tessellate<V: Shader, T: TessellationShader + Clone>(
    vertex: &V,
    shader: &T,
    (mode, patch_points): (&TessellationMode, u32),
    state: &State,
    draw: &Draw<'_>,
) -> (Vec<ClipVertex>, Vec<i32>) {
    let (Ok(shaders), Ok(patches)) = (RustShaders::new(vertex), RustPatches::new(shader)) else {
        return Default::default();
    };
    let stage = Tessellation {
        shaders: &patches,
        mode,
        patch_points,
    };
    let (mut vertices, mut numbers) = (Vec::new(), Vec::new());
    for_each_patch(&shaders, &stage, state, draw, &mut |patch| {
        let points = patch.primitives.iter().flatten();
        vertices.extend(points.map(|&point| patch.vertices[point].clone()));
        numbers.resize(numbers.len() + patch.primitives.len(), patch.number);
    });
    (vertices, numbers)
}

/// Divides the patches of a draw, one after the other.
pub fn for_each_patch(
    vertex: &dyn Shaders,
    stage: &Tessellation<'_>,
    state: &State,
    draw: &Draw<'_>,
    visit: &mut dyn FnMut(&TessellatedPatch),
) {
    let points = stage.patch_points;
    for instance in draw.instances.clone() {
        let mut number = 0;
        for run in draw_runs(state, draw) {
            for patch in 0..(run.end - run.start) / points {
                let first = run.start + patch * points;
                let positions: Vec<u32> = (first..first + points).collect();
                visit(&divided(vertex, stage, draw, positions, [instance, number]));
                number += 1;
            }
        }
    }
}

fn divided(
    vertex: &dyn Shaders,
    stage: &Tessellation<'_>,
    draw: &Draw<'_>,
    positions: Vec<u32>,
    [instance, number]: [u32; 2],
) -> TessellatedPatch {
    let corners = positions.iter();
    let corners = corners.map(|&at| shade_vertex(vertex, draw, at, instance));
    let corners: Vec<ClipVertex> = corners.collect();
    let number = number.cast_signed();
    let patch = stage.shaders.control(&corners, number, draw.bindings);
    let domain = divide(stage.mode, patch.outer, patch.inner);
    let places = domain.points.iter();
    let places = places.map(|place| place.map(|place| place as f32 / 16_777_216.0));
    let coordinates: Vec<[f32; 3]> = places.collect();
    let vertices = stage.shaders.evaluate(&patch, &coordinates, draw.bindings);
    TessellatedPatch {
        instance,
        number,
        positions,
        corners,
        outer: patch.outer,
        inner: patch.inner,
        coordinates,
        vertices,
        primitives: domain.primitives,
    }
}

/// The vertices of each primitive of a domain.
#[must_use]
pub fn corners_of(mode: &TessellationMode) -> usize {
    use estampe_types::state::TessellationDomain as D;
    match (mode.point_mode, mode.domain) {
        (true, _) => 1,
        (false, D::Isolines) => 2,
        (false, D::Triangles | D::Quads) => 3,
    }
}
