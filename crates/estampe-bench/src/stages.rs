//! Loads that stress one stage each, through the public API: the cost of a vertex, of a triangle by
//! its size, and of a fragment by the operations on it.
//!
//! Triangles are grids of square cells, two triangles each, that fill the frame. Cells of a third
//! of a pixel are mostly culled before binning; cells of 64 pixels cost mostly rasterization. The
//! statistics of a pass separate geometry from tiles.

use crate::BenchError;
use crate::frame::{FrameSize, PreparedScene};
use crate::generate::{LittleEndian, hash32};
use crate::measure::{Effort, Timing, measure};
use crate::scene::{Scene, SceneDraw, vertex_layout};
use estampe::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, CullMode,
    DepthStencilState, LogicOperation, PrimitiveState, PrimitiveTopology,
};
use estampe::{
    Device, Flat, FragmentIn, FragmentOut, RenderPipelineDescriptor, TextureFormat, Vec2, Vec3,
    Vec4, VertexFormat, VertexIn, VertexOut,
};

/// The frame size of the loads.
pub const SIZE: FrameSize = FrameSize {
    width: 1280,
    height: 720,
};

/// Layers over each other: instance i is at z = first + i·step.
#[derive(Debug, Clone, Copy)]
struct Layers {
    count: u32,
    first: f32,
    step: f32,
}

impl Layers {
    const ONE: Self = Self {
        count: 1,
        first: 0.5,
        step: 0.0,
    };
    /// Every fragment passes *less*.
    const BACK_TO_FRONT: Self = Self {
        count: 32,
        first: 0.97,
        step: -0.03,
    };
    /// Only the first layer's fragments pass *less*.
    const FRONT_TO_BACK: Self = Self {
        count: 32,
        first: 0.03,
        step: 0.03,
    };
}

/// A flat colour per primitive.
struct FlatLayers(Layers);
/// An interpolated colour.
struct SmoothLayers(Layers);

/// The clip-space position of an instance's vertex.
macro_rules! layer_position {
    ($input:ident, $layers:expr, $position:ident) => {{
        let z = $input.instance_index.to_real() * $layers.step + $layers.first;
        Vec4::new($position.x, $position.y, z, $input.real(1.0))
    }};
}

estampe::shader! {
    impl Shader for FlatLayers {
        type Attributes<R: Real> = (Vec2<R>, Vec4<R>); // NDC position, colour
        type Varyings<R: Real> = Flat<Vec3<R>>;        // colour

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, color): (Vec2<R>, Vec4<R>),
        ) -> VertexOut<R, Flat<Vec3<R>>> {
            VertexOut::new(layer_position!(input, self.0, position), Flat(color.xyz()))
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            Flat(color): Flat<Vec3<R>>,
        ) -> FragmentOut<R> {
            FragmentOut::color(color.point())
        }
    }
}

estampe::shader! {
    impl Shader for SmoothLayers {
        type Attributes<R: Real> = (Vec2<R>, Vec4<R>); // NDC position, colour
        type Varyings<R: Real> = Vec4<R>;              // colour

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, color): (Vec2<R>, Vec4<R>),
        ) -> VertexOut<R, Vec4<R>> {
            VertexOut::new(layer_position!(input, self.0, position), color)
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
            FragmentOut::color(color)
        }
    }
}

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

/// Square cells in window space, of two triangles each, with inner corners moved at random.
#[derive(Debug, Clone, Copy)]
struct Grid {
    columns: u32,
    rows: u32,
    cell_px: [f64; 2],
    /// Left and top edge of the grid.
    origin_px: [f64; 2],
}

impl Grid {
    /// The greatest number of cells per row: a square grid of these has a million triangles.
    const MAX_CELLS: f64 = 708.0;

    /// A grid of cells of this size that fills the frame, with a million triangles at most.
    fn of(cell_px: f64) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "1 to 708"
        )]
        let cells = |length_px: u32| (f64::from(length_px) / cell_px).min(Self::MAX_CELLS) as u32;
        Self {
            columns: cells(SIZE.width),
            rows: cells(SIZE.height),
            cell_px: [cell_px; 2],
            origin_px: [0.0; 2],
        }
    }

    /// One cell as large as the frame.
    fn whole() -> Self {
        Self {
            columns: 1,
            rows: 1,
            cell_px: [f64::from(SIZE.width), f64::from(SIZE.height)],
            origin_px: [0.0; 2],
        }
    }

    fn vertices(&self) -> Vec<u8> {
        let mut vertices = LittleEndian::default();
        for row in 0..=self.rows {
            for column in 0..=self.columns {
                let hash = hash32(row * 65_536 + column);
                let [red, green, blue, alpha] = hash.to_le_bytes();
                // Corners on the border are not moved, so that the grid fills its rectangle.
                let is_inner = |at: u32, count: u32| f64::from(u8::from(at > 0 && at < count));
                let moved = |bits: u8| (f64::from(bits) / 255.0 - 0.5) * 0.5;
                let x = f64::from(column) + moved(red) * is_inner(column, self.columns);
                let y = f64::from(row) + moved(green) * is_inner(row, self.rows);
                let x_px = x * self.cell_px[0] + self.origin_px[0];
                let y_px = y * self.cell_px[1] + self.origin_px[1];
                vertices.reals(&[
                    x_px / f64::from(SIZE.width) * 2.0 - 1.0,
                    1.0 - y_px / f64::from(SIZE.height) * 2.0,
                ]);
                vertices.raw(&[red, green, blue, alpha]);
            }
        }
        vertices.into_bytes()
    }

    /// Two counter-clockwise triangles per cell.
    fn triangles(&self) -> Vec<u8> {
        let width = self.columns + 1;
        let mut indices = LittleEndian::default();
        for row in 0..self.rows {
            for upper_left in (0..self.columns).map(|column| row * width + column) {
                let lower_left = upper_left + width;
                indices.words(&[upper_left, lower_left, lower_left + 1]);
                indices.words(&[upper_left, lower_left + 1, upper_left + 1]);
            }
        }
        indices.into_bytes()
    }

    /// Each vertex once.
    fn points(&self) -> Vec<u8> {
        let mut indices = LittleEndian::default();
        for index in 0..(self.columns + 1) * (self.rows + 1) {
            indices.words(&[index]);
        }
        indices.into_bytes()
    }
}

/// The header of the table. Times are wall time, in nanoseconds per vertex, primitive or fragment.
pub const HEADER: &str = "load                           primitives    binned   fragments     ms  \
                          geometry   raster  geo/vertex  geo/prim  ras/prim  ras/fragment";

/// A load's line in the table.
#[must_use]
pub fn line(purpose: &str, timing: &Timing) -> String {
    let counts = timing.statistics;
    let each_ns = |ms: f64, count: u64| ms * 1e6 / count.max(1) as f64;
    format!(
        "{purpose:<30}{:>11}{:>10}{:>12}{:>7.2}{:>10.3}{:>9.3}{:>12.2}{:>10.2}{:>10.2}{:>14.3}",
        counts.primitives_in,
        counts.primitives_binned,
        counts.fragments_shaded,
        timing.median_ms,
        timing.geometry_ms,
        timing.raster_ms,
        each_ns(timing.geometry_ms, counts.vertices_shaded),
        each_ns(timing.geometry_ms, counts.primitives_in),
        each_ns(timing.raster_ms, counts.primitives_in),
        each_ns(timing.raster_ms, counts.fragments_shaded),
    )
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

    #[test]
    fn a_grid_of_whole_pixels_fills_the_frame() {
        let grid = Grid::of(16.0);
        assert_eq!((grid.columns, grid.rows), (80, 45));
        let vertices = grid.vertices();
        let float = |at: usize| f32::from_le_bytes(vertices[at..at + 4].try_into().unwrap());
        let last = vertices.len() - 12;
        assert_eq!([float(0), float(4)], [-1.0, 1.0]);
        assert_eq!([float(last), float(last + 4)], [1.0, -1.0]);
    }
}
