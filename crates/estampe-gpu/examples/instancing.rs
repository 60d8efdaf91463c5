//! Instancing: one draw of 4,096 cubes, whose place, height and colour come from a second vertex
//! buffer that advances by instance.
//!
//! `cargo run --release -p estampe-gpu --features png --example instancing [OUT.png]`

mod scene;

use estampe::state::{VertexAttribute, VertexBufferLayout, VertexStepMode};
use estampe::{
    Device, Draw, FragmentIn, FragmentOut, Mat4, RenderPass, RenderPipelineDescriptor, Texture,
    Vec2, Vec3, VertexFormat, VertexIn, VertexOut, maths,
};
use scene::{Outcome, Screen, Solid};

const SIDE: u16 = 64;

struct Tower {
    clip_from_world: Mat4,
}

estampe::attributes! {
    struct Corner<R> {
        // Locations 0 to 2: a vertex of the cube.
        position: Vec3<R>,
        normal: Vec3<R>,
        uv: Vec2<R>,
        // Locations 3 to 5: the instance.
        place: Vec2<R>,
        height: R,
        color: Vec3<R>,
    }
}

estampe::varyings! {
    struct Surface<R> {
        normal: Vec3<R>,
        height: R,
        #[flat]
        color: Vec3<R>,
    }
}

estampe::shader! {
    impl Shader for Tower {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            let x = a.position.x * 0.45 + a.place.x;
            let y = (a.position.y * 0.5 + 0.5) * a.height;
            let z = a.position.z * 0.45 + a.place.y;
            VertexOut::new(self.clip_from_world.transform_point(Vec3::new(x, y, z)), Surface {
                normal: a.normal,
                height: y,
                color: a.color,
            })
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            // It is darker between the towers.
            let open = (v.height * 0.22 + 0.25).saturate();
            FragmentOut::color((scene::daylight(v.normal, 1.0) * v.color * open).point())
        }
    }
}

/// Place, height and colour of each instance: ripples around two points.
fn instances() -> Vec<[f32; 6]> {
    let instance = |k: u16| {
        let middle = |at: u16| f32::from(at) - f32::from(SIDE) * 0.5 + 0.5;
        let (x, z) = (middle(k % SIDE), middle(k / SIDE));
        let ripple = |a: f32, b: f32| {
            let distance = ((x - a) * (x - a) + (z - b) * (z - b)).sqrt();
            maths::cos(distance * 0.55) * maths::exp(distance * -0.05)
        };
        let height = 3.2 + 2.2 * ripple(-9.0, -6.0) + 1.5 * ripple(14.0, 8.0);
        let t = ((height - 1.8) / 3.4).clamp(0.0, 1.0);
        let mix = |a: f32, b: f32| a + (b - a) * t;
        [x, z, height, mix(0.02, 1.0), mix(0.16, 0.5), mix(0.5, 0.12)]
    };
    (0..SIDE * SIDE).map(instance).collect()
}

fn picture(device: &Device) -> Outcome<Texture> {
    let screen = Screen::new(device)?;
    let cube = Solid::cube(device)?;
    let instances = instances();
    let count = u32::try_from(instances.len())?;
    let instances = device.create_buffer_with_contents(estampe::bytes_of(&instances))?;
    let attribute = |format, offset, shader_location| VertexAttribute {
        format,
        offset,
        shader_location,
    };
    let by_instance = VertexBufferLayout {
        array_stride: 24,
        step_mode: VertexStepMode::Instance,
        attributes: vec![
            attribute(VertexFormat::Float32x2, 0, 3),
            attribute(VertexFormat::Float32, 8, 4),
            attribute(VertexFormat::Float32x3, 12, 5),
        ],
        ..VertexBufferLayout::default()
    };
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        vertex_buffers: vec![Solid::layout(), by_instance],
        ..screen.pipeline(Tower {
            clip_from_world: scene::camera([17.0, 21.0, 30.0], [1.0, 0.0, 2.0]),
        })
    })?;
    let one = cube.draw(&pipeline);
    device.render(&RenderPass {
        color_attachments: &screen.colors([0.02, 0.035, 0.06]),
        depth_stencil_attachment: screen.depths(),
        draws: &[Draw {
            vertex_buffers: &[one.vertex_buffers[0].clone(), (&instances).into()],
            instances: 0..count,
            ..one
        }],
        ..RenderPass::default()
    })?;
    Ok(screen.picture)
}

fn main() -> Outcome<()> {
    scene::write("instancing", picture)
}

#[test]
fn instancing_draws_its_picture() {
    scene::kept::check("instancing", picture);
}
