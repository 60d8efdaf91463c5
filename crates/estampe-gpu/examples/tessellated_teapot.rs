//! The teapot from its 32 Bézier patches: a tessellation shader divides each edge by its length on
//! the screen, so that neighbours agree, and computes points and normals of the surface.
//!
//! `cargo run --release -p estampe-gpu --features png --example tessellated_teapot [OUT.png]`

mod scene;

use estampe::state::{
    PolygonMode, PrimitiveState, PrimitiveTopology, TessellationDomain, TessellationMode,
    TessellationSpacing, VertexBufferLayout,
};
use estampe::{
    ControlIn, Device, EvaluationIn, FragmentIn, FragmentOut, Mat4, PatchIn, RenderPass,
    RenderPipelineDescriptor, TessellationLevels, TessellationShaderProgram, TessellationState,
    Texture, Vec2, Vec3, VertexFormat, VertexIn, VertexOut,
};
use estampe_shapes::teapot::{PATCHES, POINTS};
use scene::bezier::{slopes, sum, weights};
use scene::{Outcome, Screen, Solid};
use std::sync::Arc;

/// The length of a segment of a patch's edge, in pixels.
const SEGMENT_PX: f32 = 9.0;

/// Clip space from the world, and whether the edges of the triangles are drawn, not the surface.
#[derive(Clone, Copy)]
struct Teapot(Mat4, bool);

estampe::shader! {
    impl Shader for Teapot {
        type Attributes<R: Real> = Vec3<R>;
        type Varyings<R: Real> = Vec3<R>; // of vertices the position, of fragments the normal

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec3<R>) -> VertexOut<R, Vec3<R>> {
            VertexOut::new(self.0.transform_point(at), at)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, normal: Vec3<R>) -> FragmentOut<R> {
            if self.1 {
                return FragmentOut::color(Vec3::uniform(input.zero, [0.03, 0.06, 0.12]).point());
            }
            let light = scene::daylight(normal.normalize(), 1.0);
            FragmentOut::color((light * Vec3::uniform(input.zero, [0.9, 0.62, 0.34])).point())
        }
    }
}

estampe::shader! {
    impl TessellationShader for Teapot {
        type Input<R: Real> = Vec3<R>;
        type Control<R: Real> = (Vec3<R>, Vec2<R>); // position, place in pixels
        type Patch<R: Real> = ();
        type Output<R: Real> = Vec3<R>;
        const CONTROL_POINTS: usize = 16;

        fn control<R: Real>(&self, input: ControlIn<'_, R, Vec3<R>>) -> (Vec3<R>, Vec2<R>) {
            let point = input.points.get(input.index);
            let [width, height] = scene::SIZE.map(|side| side as f32 * 0.5);
            let at = point.position;
            (point.varyings, Vec2::new(at.x / at.w * width, at.y / at.w * height))
        }

        fn patch<R: Real>(
            &self,
            input: PatchIn<'_, R, (Vec3<R>, Vec2<R>)>,
        ) -> (TessellationLevels<R>, ()) {
            // The same bits from either end: the sum of the outer legs, then the middle one.
            let level = |edge: [usize; 4]| {
                let [a, b, c, d] = edge.map(|at| input.points.get(at).1);
                let length = (a.distance(b) + c.distance(d)) + b.distance(c);
                (length * (1.0 / SEGMENT_PX)).max(1.0)
            };
            let edges = [[0, 4, 8, 12], [0, 1, 2, 3], [3, 7, 11, 15], [12, 13, 14, 15]];
            let outer = edges.map(level);
            let inner = [outer[1].max(outer[3]), outer[0].max(outer[2])];
            (TessellationLevels { outer, inner }, ())
        }

        fn evaluate<R: Real>(
            &self,
            input: EvaluationIn<'_, R, (Vec3<R>, Vec2<R>)>,
            _: (),
        ) -> VertexOut<R, Vec3<R>> {
            let at = input.coordinates;
            let point = |row: usize, column: usize| input.points.get(row * 4 + column).0;
            let rows = |weights: [R; 4]| {
                [0, 1, 2, 3].map(|row| sum([0, 1, 2, 3].map(|column| point(row, column)), weights))
            };
            let position = sum(rows(weights(at.x)), weights(at.y));
            // Where an edge is a point, the normal of its neighbourhood.
            let (u, v) = (at.x.clamp(0.002, 0.998), at.y.clamp(0.002, 0.998));
            let along_u = sum(rows(slopes(u)), weights(v));
            let along_v = sum(rows(weights(u)), slopes(v));
            let normal = along_v.cross(along_u).normalize();
            VertexOut::new(self.0.transform_point(position), normal)
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a few digits")]
fn picture(device: &Device) -> Outcome<Texture> {
    let points = POINTS.map(|[x, y, z]| [x as f32, z as f32, -y as f32]);
    let indices = PATCHES.iter().flatten().map(|at| u32::from(*at) - 1);
    let patches = Solid::new(device, &points, indices.collect())?;
    let screen = Screen::new(device)?;
    let clip_from_world = scene::camera([3.2, 4.6, 6.2], [0.25, 1.35, 0.0]);
    let mode = TessellationMode {
        domain: TessellationDomain::Quads,
        spacing: TessellationSpacing::FractionalEven,
        ..TessellationMode::default()
    };
    let pipeline = |is_wire, polygon_mode| {
        let shader = Teapot(clip_from_world, is_wire);
        let program = Arc::new(TessellationShaderProgram::new(shader));
        let mut descriptor = RenderPipelineDescriptor {
            tessellation: Some(TessellationState {
                program,
                patch_points: 16,
                mode,
            }),
            vertex_buffers: vec![VertexBufferLayout::packed(&[VertexFormat::Float32x3])],
            primitive: PrimitiveState {
                topology: PrimitiveTopology::PatchList,
                polygon_mode,
                ..PrimitiveState::default()
            },
            ..screen.pipeline(shader)
        };
        if let Some(depth) = descriptor.depth_stencil.as_mut().filter(|_| !is_wire) {
            // Behind the lines.
            (depth.bias.constant, depth.bias.slope_scale) = (2.0, 1.0);
        }
        device.create_render_pipeline(&descriptor)
    };
    let pipelines = [
        pipeline(false, PolygonMode::Fill)?,
        pipeline(true, PolygonMode::Line)?,
    ];
    device.render(&RenderPass {
        color_attachments: &screen.colors([0.55, 0.65, 0.75]),
        depth_stencil_attachment: screen.depths(),
        draws: &pipelines.each_ref().map(|pipeline| patches.draw(pipeline)),
        ..RenderPass::default()
    })?;
    Ok(screen.picture)
}

fn main() -> Outcome<()> {
    scene::write("tessellated_teapot", picture)
}

#[test]
fn tessellated_teapot_draws_its_picture() {
    scene::kept::check("tessellated_teapot", picture);
}
