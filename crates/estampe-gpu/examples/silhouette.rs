//! A drawing in ink: a geometry shader reads triangles with adjacency and emits the edges between
//! one that faces the viewer and one that faces away.
//!
//! `cargo run --release -p estampe-gpu --features png --example silhouette [OUT.png]`

mod scene;

use estampe::state::{
    LineRasterization, LineState, PrimitiveState, PrimitiveTopology, VertexBufferLayout,
};
use estampe::{
    Device, FragmentIn, FragmentOut, GeometryIn, GeometryPrimitive, GeometryShaderProgram,
    GeometryTopology, Mat4, Real, RenderPass, RenderPipelineDescriptor, Texture, Vec3, Vec4,
    VertexFormat, VertexIn, VertexOut, maths,
};
use scene::{Outcome, Screen, Solid};
use std::f32::consts::TAU;
use std::sync::Arc;

/// Cells around and along a trefoil.
const CELLS: [u32; 2] = [24, 240];

/// Clip space from the world, and whether lines are drawn.
#[derive(Clone, Copy)]
struct Ink(Mat4, bool);

estampe::shader! {
    impl Shader for Ink {
        type Attributes<R: Real> = Vec3<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec3<R>) -> VertexOut<R, ()> {
            VertexOut::new(self.0.transform_point(at), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _: ()) -> FragmentOut<R> {
            let color = if self.1 { [0.01, 0.01, 0.03] } else { [0.93, 0.88, 0.76] };
            FragmentOut::color(Vec3::uniform(input.zero, color).point())
        }
    }
}

estampe::shader! {
    impl GeometryShader for Ink {
        type Input<R: Real> = ();
        type Output<R: Real> = ();
        const INPUT: GeometryPrimitive = GeometryPrimitive::TrianglesAdjacency;
        const OUTPUT: GeometryTopology = GeometryTopology::LineStrip;
        const MAX_VERTICES: usize = 6;

        fn geometry<R: Real, E: Emit<R, ()>>(&self, input: GeometryIn<'_, R, ()>, out: &mut E) {
            let at = |corner: usize| input.points.get(corner % 6).position;
            let faces = facing([at(0), at(2), at(4)]).gt(0.0);
            for edge in [0, 2, 4] {
                let beyond = facing([at(edge), at(edge + 1), at(edge + 2)]);
                let is_outline = faces & beyond.le(0.0);
                for corner in [edge, edge + 2] {
                    // A little nearer to the viewer than the surface.
                    let mut position = at(corner);
                    position.z -= position.w * 0.0008;
                    out.emit(is_outline, VertexOut::new(position, ()));
                }
                out.end_primitive(is_outline);
            }
        }
    }
}

estampe::shader! {
    /// Twice the area of a triangle in NDC: positive if it runs counter-clockwise.
    fn facing<R: Real>(triangle: [Vec4<R>; 3]) -> R {
        let [a, b, c] = triangle.map(|corner| (corner.x / corner.w, corner.y / corner.w));
        (b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1)
    }
}

/// The position of a vertex of the trefoil's tube.
fn vertex(around: u32, along: u32) -> [f32; 3] {
    let turn = along as f32 / CELLS[1] as f32 * TAU;
    let at = |turn: f32| {
        let radius = 2.0 + maths::cos(turn * 3.0);
        [
            radius * maths::cos(turn * 2.0),
            radius * maths::sin(turn * 2.0),
            maths::sin(turn * 3.0),
        ]
    };
    let (here, next) = (Vec3::from(at(turn)), Vec3::from(at(turn + 0.001)));
    let forward = (next - here).normalize();
    let side = forward.cross(here).normalize();
    let up = side.cross(forward);
    let angle = around as f32 / CELLS[0] as f32 * TAU;
    let p = here + side * (maths::cos(angle) * 0.55) + up * (maths::sin(angle) * 0.55);
    [p.x, p.y, p.z]
}

/// The six vertices of each triangle.
fn indices() -> Vec<u32> {
    let number = |around: u32, along: u32| along % CELLS[1] * CELLS[0] + around % CELLS[0];
    let mut indices = Vec::new();
    for along in CELLS[1]..2 * CELLS[1] {
        for around in CELLS[0]..2 * CELLS[0] {
            let at = |i: u32, j: u32| number(around + i - 1, along + j - 1);
            // The cell (1, 1)–(2, 2), and the corners of its neighbours.
            indices.extend([at(1, 1), at(2, 0), at(2, 1), at(2, 2), at(1, 2), at(0, 2)]);
            indices.extend([at(2, 1), at(3, 1), at(2, 2), at(1, 3), at(1, 2), at(1, 1)]);
        }
    }
    indices
}

fn picture(device: &Device) -> Outcome<Texture> {
    let rows = (0..CELLS[1]).flat_map(|along| (0..CELLS[0]).map(move |at| vertex(at, along)));
    let mesh = Solid::new(device, &rows.collect::<Vec<_>>(), indices())?;
    let screen = Screen::new(device)?;
    let pipeline = |is_lines| {
        let shader = Ink(scene::camera([0.0, -2.6, 8.2], [0.0; 3]), is_lines);
        let geometry = GeometryShaderProgram::new(shader);
        device.create_render_pipeline(&RenderPipelineDescriptor {
            geometry: is_lines.then_some(Arc::new(geometry) as _),
            vertex_buffers: vec![VertexBufferLayout::packed(&[VertexFormat::Float32x3])],
            primitive: PrimitiveState {
                topology: PrimitiveTopology::TriangleListAdjacency,
                line: LineState {
                    width: 2.5,
                    rasterization: LineRasterization::Rectangular,
                    ..LineState::default()
                },
                ..PrimitiveState::default()
            },
            ..screen.pipeline(shader)
        })
    };
    let pipelines = [pipeline(false)?, pipeline(true)?];
    device.render(&RenderPass {
        color_attachments: &screen.colors([0.8, 0.72, 0.58]),
        depth_stencil_attachment: screen.depths(),
        draws: &pipelines.each_ref().map(|pipeline| mesh.draw(pipeline)),
        ..RenderPass::default()
    })?;
    Ok(screen.picture)
}

fn main() -> Outcome<()> {
    scene::write("silhouette", picture)
}

#[test]
fn silhouette_draws_its_picture() {
    scene::kept::check("silhouette", picture);
}
