//! Tessellation: the domain of a patch in exact rationals, and the vertices of its primitives.
//!
//! In · Out: the vertices of patches · the vertices of points, lines or triangles, as a list.
//! Spec: Vulkan §Tessellation; docs/NUMERICS.md, *Tessellation*.

mod domain;
mod edge;
mod fraction;

pub use domain::{Domain, divide};
pub use edge::Edge;
pub use fraction::Fraction;

use crate::pipeline::draw_runs;
use crate::program::RustShaders;
use crate::shading::{scalars_of, shade_vertex};
use crate::{ClipVertex, Draw, State};
use estampe_types::shader::{
    ControlIn, EvaluationIn, PatchIn, Points, Shader, TessellationLevels, TessellationProgram,
    TessellationShader, TessellationShaderProgram,
};
use estampe_types::state::TessellationMode;
use estampe_types::{Bindings, Vec3};

/// A patch with its control points.
struct Patch {
    /// The words of the control points, one after the other.
    control: Vec<u32>,
    number: i32,
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
    let program = TessellationShaderProgram::new(shader.clone());
    let (Ok(shaders), Ok(())) = (RustShaders::new(vertex), program.validate()) else {
        return Default::default();
    };
    let distances = &program.interface().output;
    let distances = [distances.clip_distances, distances.cull_distances];
    let (mut vertices, mut numbers) = (Vec::new(), Vec::new());
    for instance in draw.instances.clone() {
        let mut number = 0;
        for run in draw_runs(state, draw) {
            for patch in 0..(run.end - run.start) / patch_points {
                let corners = (0..patch_points).map(|corner| {
                    let at = run.start + patch * patch_points + corner;
                    shade_vertex(&shaders, draw, at, instance)
                });
                let corners: Vec<ClipVertex> = corners.collect();
                let patch = Patch::new(shader, &corners, number, draw.bindings);
                let of_patch = patch.vertices(shader, mode, distances, draw.bindings);
                let corners = corners_of(mode);
                numbers.resize(numbers.len() + of_patch.len() / corners, number);
                vertices.extend(of_patch);
                number += 1;
            }
        }
    }
    (vertices, numbers)
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

impl Patch {
    fn new<T: TessellationShader>(
        shader: &T,
        corners: &[ClipVertex],
        number: i32,
        bindings: &Bindings,
    ) -> Self {
        let records: Vec<u32> = corners.iter().flat_map(ClipVertex::words).collect();
        let words = records.len() / corners.len();
        let point = |index| {
            let point = shader.control(ControlIn {
                index,
                points: Points::of_patch(0.0_f32, &records, words, corners.len()),
                primitive_index: number,
                bindings,
                zero: 0.0,
            });
            scalars_of(point)
        };
        let control = (0..T::CONTROL_POINTS).flat_map(point);
        Self {
            control: control.map(f32::to_bits).collect(),
            number,
        }
    }

    fn points<T: TessellationShader>(&self) -> Points<'_, f32, T::Control<f32>> {
        let words = self.control.len() / T::CONTROL_POINTS;
        Points::of_patch(0.0, &self.control, words, T::CONTROL_POINTS)
    }

    /// The vertices of all primitives.
    fn vertices<T: TessellationShader>(
        &self,
        shader: &T,
        mode: &TessellationMode,
        distances: [usize; 2],
        bindings: &Bindings,
    ) -> Vec<ClipVertex> {
        let levels_and_values = || {
            shader.patch(PatchIn {
                points: self.points::<T>(),
                primitive_index: self.number,
                bindings,
                zero: 0.0_f32,
            })
        };
        let (TessellationLevels { outer, inner }, _) = levels_and_values();
        let domain = divide(mode, outer, inner);
        let evaluate = |at: &usize| {
            let [x, y, z] = domain.points[*at].map(|place| place as f32 / 16_777_216.0);
            let input = EvaluationIn {
                coordinates: Vec3::new(x, y, z),
                points: self.points::<T>(),
                primitive_index: self.number,
                bindings,
                zero: 0.0_f32,
            };
            let (_, values) = levels_and_values();
            ClipVertex::of(shader.evaluate(input, values), distances)
        };
        domain.primitives.iter().flatten().map(evaluate).collect()
    }
}
