//! Draws with tessellation or a geometry shader: the oracle makes their primitives one by one, and
//! draws each into the layer that it names.

use super::history::{
    EmittedRecord, InspectedVertex, PrimitiveOrigin, PrimitiveRecord, TessellatedRecord,
    TessellatedVertex,
};
use super::oracle_draw::OracleDraw;
use super::record::Recorder;
use crate::Level;
use estampe_reference::amplification::{MadePrimitive, Stages};
use estampe_reference::geometry_shader::{PrimitiveShaders, ProgramPrimitives};
use estampe_reference::program::{ProgramShaders, Shaders};
use estampe_reference::shading::fetch_attributes;
use estampe_reference::tessellation::{ProgramPatches, Tessellation};
use estampe_reference::{Draw, State, Target, draw_vertices_observed};

/// A primitive that was made, and its number in the draw.
#[derive(Clone, Copy)]
pub(super) struct Made<'a> {
    pub(super) primitive: &'a MadePrimitive<'a>,
    pub(super) number: u64,
    /// The shader of the vertices that it was made of.
    vertex: &'a dyn Shaders,
}

/// Draws into the layers that have a target; returns what covers the pixel of a layer.
pub(super) fn draw_amplified<'a>(
    (draw, level): (&estampe_core::Draw<'_>, Level),
    oracle: &OracleDraw<'_>,
    targets: &mut [Option<Target>],
    inspected: usize,
    recorder: impl Fn() -> Recorder<'a>,
) -> Vec<PrimitiveRecord> {
    let descriptor = draw.pipeline.descriptor();
    let vertex_program = descriptor.vertex_program.as_ref();
    let vertex = ProgramShaders::new(&**vertex_program.unwrap_or(&descriptor.program), level);
    let tessellation = descriptor.tessellation.as_ref();
    let patches = tessellation.map(|state| ProgramPatches::new(&*state.program, level));
    let primitives = descriptor.geometry.as_deref();
    let primitives = primitives.map(|program| ProgramPrimitives::new(program, level));
    let stages = Stages {
        vertex: &vertex,
        tessellation: tessellation
            .zip(patches.as_ref())
            .map(|(state, shaders)| Tessellation {
                shaders,
                mode: &state.mode,
                patch_points: state.patch_points,
            }),
        geometry: primitives
            .as_ref()
            .map(|shaders| shaders as &dyn PrimitiveShaders),
    };
    // The layers have one size.
    let size = targets.iter().flatten().next();
    let size = size.map_or([0; 2], |target| [target.width, target.height]);
    let mut states = viewport_states(draw, oracle.state, size);
    for state in &mut states {
        state.primitive.topology = stages.topology();
        state.primitive.primitive_restart = false;
    }
    let mut records = Vec::new();
    let mut number = 0;
    stages.for_each(oracle.state, oracle.draw, &mut |primitive| {
        let [layer, viewport] = primitive.emitted.map_or([0; 2], |emitted| emitted.place);
        let layer = if (layer as usize) < targets.len() {
            layer as usize
        } else {
            0
        };
        let state = states.get(viewport as usize).unwrap_or(&states[0]);
        if let Some(target) = &mut targets[layer] {
            let made = Made {
                primitive,
                number,
                vertex: &vertex,
            };
            let mut recorder = recorder().of_made(made);
            let bindings = oracle.draw.bindings;
            let vertices = primitive.vertices;
            draw_vertices_observed(
                target,
                oracle.shaders,
                state,
                bindings,
                vertices,
                &mut recorder,
            );
            if layer == inspected {
                records.append(&mut recorder.primitives);
            }
        }
        number += 1;
    });
    records
}

/// The state with each viewport of a draw; at least one.
fn viewport_states(
    draw: &estampe_core::Draw<'_>,
    state: &State,
    [width, height]: [u32; 2],
) -> Vec<State> {
    let whole = State::new(width, height);
    let more = draw.more_viewports.iter().map(|more| State {
        viewport: more.viewport.unwrap_or(whole.viewport),
        scissor: more.scissor.unwrap_or(whole.scissor),
        ..state.clone()
    });
    std::iter::once(state.clone()).chain(more).collect()
}

impl Made<'_> {
    /// What the primitive was made of.
    pub(super) fn origin(&self, draw: &Draw<'_>) -> PrimitiveOrigin {
        let made = self.primitive;
        let input = made.positions.iter().zip(made.input);
        let input = input.map(|(&position, vertex)| InspectedVertex {
            index: draw.vertex_index(position),
            attributes: fetch_attributes(self.vertex, draw, position, made.instance),
            clip: vertex.position,
            varyings: vertex.varyings.clone(),
        });
        let tessellated = made.tessellated.map(|(patch, number)| {
            let points = patch.primitives[number].iter();
            TessellatedRecord {
                outer: patch.outer,
                inner: patch.inner,
                primitive: u32::try_from(number).unwrap_or(u32::MAX),
                vertices: points
                    .map(|&point| TessellatedVertex {
                        coordinates: patch.coordinates[point],
                        clip: patch.vertices[point].position,
                        varyings: patch.vertices[point].varyings.clone(),
                    })
                    .collect(),
            }
        });
        let emitted = made.emitted.map(|emitted| EmittedRecord {
            invocation: u32::try_from(emitted.invocation).unwrap_or(u32::MAX),
            layer: emitted.place[0],
            viewport_index: emitted.place[1],
        });
        PrimitiveOrigin {
            number: made.number.cast_unsigned(),
            vertices: input.collect(),
            tessellated,
            emitted,
        }
    }
}
