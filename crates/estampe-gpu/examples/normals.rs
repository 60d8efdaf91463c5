//! Normals as lines: a geometry shader reads the triangles of a mesh and emits a line from each
//! corner along its normal, coloured by the direction.
//!
//! `cargo run --release -p estampe-gpu --features png --example normals [OUT.png]`

mod scene;

use estampe::state::VertexBufferLayout;
use estampe::{
    Device, FragmentIn, FragmentOut, GeometryIn, GeometryPrimitive, GeometryShaderProgram,
    GeometryTopology, Mat4, RenderPass, RenderPipelineDescriptor, Texture, Vec3, VertexFormat,
    VertexIn, VertexOut,
};
use scene::{Outcome, Screen, Solid};
use std::sync::Arc;

/// The length of the lines in the world.
const LENGTH: f32 = 0.28;

/// Draws a mesh in daylight, with the normal as varying; or the geometry shader's lines, with their
/// colour.
#[derive(Clone, Copy)]
struct Bristles {
    clip_from_world: Mat4,
    is_lines: bool,
}

estampe::shader! {
    impl Shader for Bristles {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>); // position, normal
        type Varyings<R: Real> = Vec3<R>;

        fn vertex<R: Real>(
            &self,
            _: VertexIn<'_, R>,
            (position, normal): (Vec3<R>, Vec3<R>),
        ) -> VertexOut<R, Vec3<R>> {
            VertexOut::new(self.clip_from_world.transform_point(position), normal)
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, varying: Vec3<R>) -> FragmentOut<R> {
            if self.is_lines {
                return FragmentOut::color(varying.point());
            }
            FragmentOut::color((scene::daylight(varying.normalize(), 1.0) * 0.45).point())
        }
    }
}

estampe::shader! {
    impl GeometryShader for Bristles {
        type Input<R: Real> = Vec3<R>;
        type Output<R: Real> = Vec3<R>;
        const INPUT: GeometryPrimitive = GeometryPrimitive::Triangles;
        const OUTPUT: GeometryTopology = GeometryTopology::LineStrip;
        const MAX_VERTICES: usize = 6;

        fn geometry<R: Real, E: Emit<R, Vec3<R>>>(
            &self,
            input: GeometryIn<'_, R, Vec3<R>>,
            out: &mut E,
        ) {
            let all = input.zero.splat_mask(true);
            for corner in 0..3 {
                let point = input.points.get(corner);
                let normal = point.varyings;
                // A direction moves a point in clip space by its image without the translation.
                let [x, y, z, w] = [0, 1, 2, 3].map(|row| {
                    let [a, b, c] = [0, 1, 2].map(|column| self.clip_from_world.0[column][row]);
                    (normal.x * a + normal.y * b + normal.z * c) * LENGTH
                });
                let end = point.position + estampe::Vec4::new(x, y, z, w);
                let color = normal * 0.5 + 0.5;
                out.emit(all, VertexOut::new(point.position, color * 0.25));
                out.emit(all, VertexOut::new(end, color));
                out.end_primitive(all);
            }
        }
    }
}

fn picture(device: &Device) -> Outcome<Texture> {
    let mesh = estampe_shapes::teapot::teapot(4);
    let vertices = mesh.positions.iter().zip(&mesh.normals);
    let vertices: Vec<[f32; 6]> = vertices
        .map(|(at, normal)| [at.x, at.y, at.z, normal.x, normal.y, normal.z])
        .collect();
    let mesh = Solid::new(device, &vertices, mesh.triangles.into_flattened())?;
    let screen = Screen::new(device)?;
    let clip_from_world = scene::camera([2.2, 4.4, 6.8], [0.25, 1.4, 0.0]);
    let descriptor = |is_lines| {
        use VertexFormat::Float32x3;
        let shader = Bristles {
            clip_from_world,
            is_lines,
        };
        let geometry = GeometryShaderProgram::new(shader);
        RenderPipelineDescriptor {
            geometry: is_lines.then_some(Arc::new(geometry) as _),
            vertex_buffers: vec![VertexBufferLayout::packed(&[Float32x3, Float32x3])],
            ..screen.pipeline(shader)
        }
    };
    let pipelines = [
        device.create_render_pipeline(&descriptor(false))?,
        device.create_render_pipeline(&descriptor(true))?,
    ];
    device.render(&RenderPass {
        color_attachments: &screen.colors([0.01, 0.012, 0.02]),
        depth_stencil_attachment: screen.depths(),
        draws: &pipelines.each_ref().map(|pipeline| mesh.draw(pipeline)),
        ..RenderPass::default()
    })?;
    Ok(screen.picture)
}

fn main() -> Outcome<()> {
    scene::write("normals", picture)
}

#[test]
fn normals_draws_its_picture() {
    scene::kept::check("normals", picture);
}
