//! The loads, each of which stresses one stage.

use super::SIZE;
use super::grid::Grid;
use super::layers::{FlatLayers, Layers, SmoothLayers};
use crate::BenchError;
use crate::frame::PreparedScene;
use crate::measure::{Effort, Timing, measure};
use crate::scene::{Scene, SceneDraw, vertex_layout};
use estampe::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, CullMode,
    DepthStencilState, LogicOperation, PrimitiveState, PrimitiveTopology,
};
use estampe::{Device, RenderPipelineDescriptor, TextureFormat, VertexFormat};

/// A load and its purpose.
#[derive(Debug)]
pub struct Load {
    /// The stressed operation, for the table.
    pub purpose: &'static str,
    scene: Scene,
}

impl Load {
    /// Measures the load.
    ///
    /// # Errors
    /// [`BenchError`] if the device refuses the frame's size.
    pub fn measure(&self, device: &Device, effort: Effort) -> Result<Timing, BenchError> {
        let mut prepared = PreparedScene::new(device, &self.scene, SIZE)?;
        Ok(measure(&mut prepared, effort))
    }
}

/// The loads, in pipeline order. They are created one by one, because some are large.
pub fn loads() -> impl Iterator<Item = Load> {
    let grids = [
        ("triangles of 0.06 px", 1.0 / 3.0),
        ("triangles of 0.5 px", 1.0),
        ("triangles of 2 px", 2.0),
        ("triangles of 8 px", 4.0),
        ("triangles of 32 px", 8.0),
        ("triangles of 128 px", 16.0),
        ("triangles of 2048 px", 64.0),
    ];
    let geometry = [vertices as fn() -> Load, facing_away];
    let quads = [
        flat_passing as fn() -> Load,
        flat_hidden,
        smooth_passing,
        smooth_blended,
        general_quads,
        general_blended,
        general_triangles,
    ];
    geometry
        .into_iter()
        .map(|make| make())
        .chain(
            grids
                .into_iter()
                .map(|(purpose, cell_px)| load(purpose, Grid::of(cell_px), Layers::ONE, smooth)),
        )
        .chain(quads.into_iter().map(|make| make()))
        .chain([DRAWS_OF_500, DRAWS_OF_2].into_iter().map(many_draws))
}

/// Points outside the view volume: fetched, shaded and dropped.
fn vertices() -> Load {
    let grid = Grid {
        origin_px: [-4.0 * f64::from(SIZE.width), 0.0],
        ..Grid::of(1.0)
    };
    load("vertices alone", grid, Layers::ONE, |layers| {
        RenderPipelineDescriptor {
            primitive: PrimitiveState {
                topology: PrimitiveTopology::PointList,
                ..PrimitiveState::default()
            },
            ..smooth(layers)
        }
    })
}

fn facing_away() -> Load {
    load(
        "triangles facing away",
        Grid::of(1.0),
        Layers::ONE,
        |layers| RenderPipelineDescriptor {
            primitive: PrimitiveState {
                cull_mode: CullMode::Front,
                ..PrimitiveState::default()
            },
            ..smooth(layers)
        },
    )
}

fn flat_passing() -> Load {
    load(
        "quads, flat, all pass",
        Grid::whole(),
        Layers::BACK_TO_FRONT,
        flat,
    )
}

fn flat_hidden() -> Load {
    load(
        "quads, flat, 1 of 32 passes",
        Grid::whole(),
        Layers::FRONT_TO_BACK,
        flat,
    )
}

fn smooth_passing() -> Load {
    load(
        "quads, smooth, all pass",
        Grid::whole(),
        Layers::BACK_TO_FRONT,
        smooth,
    )
}

fn smooth_blended() -> Load {
    load(
        "quads, smooth, blended",
        Grid::whole(),
        Layers::BACK_TO_FRONT,
        |layers| RenderPipelineDescriptor {
            depth_stencil: Some(DepthStencilState::LESS_READ),
            targets: vec![Some(ColorTargetState {
                blend: Some(BlendState::ALPHA_BLENDING),
                ..TextureFormat::Rgba8Unorm.into()
            })],
            ..smooth(layers)
        },
    )
}

/// A logic operation that copies: the same picture as without it, in a rarely used state.
fn copied(layers: Layers) -> RenderPipelineDescriptor {
    RenderPipelineDescriptor {
        logic_operation: Some(LogicOperation::Copy),
        ..smooth(layers)
    }
}

fn general_quads() -> Load {
    load(
        "quads, smooth, rare state",
        Grid::whole(),
        Layers::BACK_TO_FRONT,
        copied,
    )
}

fn general_blended() -> Load {
    load(
        "quads, smooth, rare factors",
        Grid::whole(),
        Layers::BACK_TO_FRONT,
        |layers| RenderPipelineDescriptor {
            depth_stencil: Some(DepthStencilState::LESS_READ),
            targets: vec![Some(ColorTargetState {
                blend: Some(BlendState {
                    color: BlendComponent {
                        operation: BlendOperation::Add,
                        src_factor: BlendFactor::ConstantAlpha,
                        dst_factor: BlendFactor::OneMinusConstantAlpha,
                    },
                    alpha: BlendComponent::OVER,
                }),
                ..TextureFormat::Rgba8Unorm.into()
            })],
            ..smooth(layers)
        },
    )
}

fn general_triangles() -> Load {
    load(
        "triangles of 8 px, rare state",
        Grid::of(4.0),
        Layers::ONE,
        copied,
    )
}

/// Purpose, number of draws, and cells along a side of each draw's patch.
type ManyDraws = (&'static str, u32, u32);

const DRAWS_OF_500: ManyDraws = ("1900 draws of 512 triangles", 1900, 16);
const DRAWS_OF_2: ManyDraws = ("10000 draws of 2 triangles", 10_000, 1);

/// Draws of small meshes, whose patches are beside each other: the cost of a draw.
fn many_draws((purpose, draws, cells): ManyDraws) -> Load {
    let patch = |number: u32| Grid {
        columns: cells,
        rows: cells,
        cell_px: [1.5; 2],
        origin_px: [
            f64::from(number % 50) * 25.0,
            f64::from(number / 50 % 40) * 17.5,
        ],
    };
    let Load { mut scene, .. } = load(purpose, patch(0), Layers::ONE, smooth);
    let first = scene.draws[0];
    scene
        .buffers
        .extend((1..draws).map(|number| patch(number).vertices()));
    scene.draws.extend(
        (2..)
            .take(draws as usize - 1)
            .map(|vertices| SceneDraw { vertices, ..first }),
    );
    Load { purpose, scene }
}

fn flat(layers: Layers) -> RenderPipelineDescriptor {
    RenderPipelineDescriptor::new(FlatLayers(layers))
}

fn smooth(layers: Layers) -> RenderPipelineDescriptor {
    RenderPipelineDescriptor::new(SmoothLayers(layers))
}

fn load(
    purpose: &'static str,
    grid: Grid,
    layers: Layers,
    pipeline: impl Fn(Layers) -> RenderPipelineDescriptor,
) -> Load {
    let pipeline = RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout(
            12,
            &[(VertexFormat::Float32x2, 0), (VertexFormat::Unorm8x4, 8)],
        )],
        ..pipeline(layers)
    };
    let is_points = pipeline.primitive.topology == PrimitiveTopology::PointList;
    let indices = if is_points {
        grid.points()
    } else {
        grid.triangles()
    };
    let mut scene = Scene::of_one_draw(
        purpose,
        vec![grid.vertices(), indices],
        Vec::new(),
        pipeline,
    );
    scene.draws[0].instances = layers.count;
    Load { purpose, scene }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_have_at_most_a_million_triangles() {
        for load in loads() {
            let triangles = load.scene.triangles();
            assert!(
                (1..=1_010_000).contains(&triangles),
                "{}: {triangles}",
                load.purpose
            );
        }
    }
}
