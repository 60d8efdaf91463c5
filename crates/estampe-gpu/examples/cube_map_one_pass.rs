//! A cube map in one pass: a geometry shader with six invocations sends each triangle to all faces,
//! which are the layers of the attachments. A ball then mirrors it.
//!
//! `cargo run --release -p estampe-gpu --features png --example cube_map_one_pass [OUT.png]`

mod scene;

use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, EmittedVertex, FragmentIn, FragmentOut,
    GeometryIn, GeometryPrimitive, GeometryShaderProgram, GeometryTopology, Mat4, RenderPass,
    RenderPipelineDescriptor, SamplerDescriptor, Texture, TextureBindings, TextureDescriptor,
    TextureFormat, TextureViewDescriptor, Vec3, VertexIn, VertexOut, ViewDimension, maths,
};
use scene::{Corner, Objects, Outcome, Screen, Solid};
use std::sync::Arc;

const FORMAT: TextureFormat = TextureFormat::Rgba8UnormSrgb;
const SIDE: u32 = 256;
const EYE: [f32; 3] = [0.7, 1.9, 3.3];

/// The fourth number of a mirror's colour.
const MIRROR: f32 = 1.0;

/// Draws painted objects, and mirrors of a cube map, in clip space from the world.
struct Painted(Mat4);

estampe::varyings! {
    struct Surface<R> { normal: Vec3<R>, position: Vec3<R> }
}

estampe::shader! {
    impl Shader for Painted {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            let world_from_object = input.bindings.mat4(0, 0, 0);
            let position_world = world_from_object.transform_point(a.position);
            VertexOut::new(self.0 * position_world, Surface {
                normal: world_from_object.transform_vector(a.normal),
                position: position_world.xyz(),
            })
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let [r, g, b, kind] = input.bindings.f32s(0, 0, 64);
            let (color, normal) = (Vec3::uniform(input.zero, [r, g, b]), v.normal.normalize());
            if kind >= MIRROR {
                let sight = (v.position - Vec3::from(EYE)).normalize();
                let cube = input.bindings.sampled_texture(1, 0);
                return FragmentOut::color((cube.sample(sight.reflect(normal)).rgb() * color).point());
            }
            let tile = (v.position.x.floor() + v.position.z.floor()).modulo(2.0);
            let light = scene::daylight(normal, tile * 0.5 + 0.5) + kind;
            FragmentOut::color((light * color).point())
        }
    }
}

/// Sends triangles, whose varyings hold the positions in the world, to the faces.
struct Faces([Mat4; 6]);

estampe::shader! {
    impl GeometryShader for Faces {
        type Input<R: Real> = Surface<R>;
        type Output<R: Real> = Surface<R>;
        const INPUT: GeometryPrimitive = GeometryPrimitive::Triangles;
        const OUTPUT: GeometryTopology = GeometryTopology::TriangleStrip;
        const MAX_VERTICES: usize = 3;
        const INVOCATIONS: usize = 6;

        fn geometry<R: Real, E: Emit<R, Surface<R>>>(
            &self,
            input: GeometryIn<'_, R, Surface<R>>,
            out: &mut E,
        ) {
            let face = input.invocation;
            let layer = input.zero.splat_int([0, 1, 2, 3, 4, 5][face]);
            for corner in 0..3 {
                let surface = input.points.get(corner).varyings;
                let position = self.0[face].transform_point(surface.position);
                let vertex = EmittedVertex::from(VertexOut::new(position, surface));
                out.emit(input.zero.splat_mask(true), vertex.with_layer(layer));
            }
        }
    }
}

fn picture(device: &Device) -> Outcome<Texture> {
    let (cube, ball) = (Solid::cube(device)?, Solid::sphere(device)?);
    let floor = Solid::plane(device, 30.0)?;
    let mut list = vec![(&floor, Mat4::IDENTITY, [0.8, 0.76, 0.7, 0.05])];
    for k in 0..11_u8 {
        let turn = f32::from(k) * std::f32::consts::TAU / 11.0 + 0.2;
        let hue = |shift: f32| 0.5 + 0.45 * maths::cos(turn + shift);
        let height = 0.4 + 0.3 * f32::from(k * 7 % 4);
        let block = Mat4::rotation_y(turn)
            * Mat4::translation([0.0, height, -3.4])
            * Mat4::scale([0.4, height, 0.4]);
        list.push((&cube, block, [hue(0.0), hue(2.1), hue(4.2), 0.1]));
    }
    let surroundings = Objects::new(device, &list)?;
    let texture = |format| {
        let mut descriptor = TextureDescriptor::new_2d(SIDE, SIDE, format);
        descriptor.size.depth_or_array_layers = 6;
        device.create_texture(&descriptor)
    };
    let (map, depths) = (texture(FORMAT)?, texture(TextureFormat::Depth32Float)?);
    let center = [0.0, 1.0, 0.0];
    let faces = [0, 1, 2, 3, 4, 5].map(|face| scene::clip_from_cube_face(center, face));
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        geometry: Some(Arc::new(GeometryShaderProgram::new(Faces(faces)))),
        bind_group_layouts: vec![surroundings.layout.clone()],
        vertex_buffers: vec![Solid::layout()],
        targets: vec![Some(FORMAT.into())],
        ..RenderPipelineDescriptor::new(Painted(Mat4::IDENTITY)) // faces have their own
    })?;
    let sky = [0.25, 0.45, 0.8, 1.0];
    device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&map.view(), sky))],
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depths.view(), 1.0)),
        draws: &surroundings.draws(&pipeline),
        ..RenderPass::default()
    })?;
    let view = map.create_view(&TextureViewDescriptor {
        dimension: Some(ViewDimension::Cube),
        ..TextureViewDescriptor::default()
    })?;
    let sampler = device.create_sampler(&SamplerDescriptor::trilinear_repeat())?;
    let (layout, map) = scene::bind(device, &[scene::sampled(&view, &sampler)])?;
    list.push((&ball, Mat4::translation(center), [0.95, 0.96, 1.0, MIRROR]));
    let objects = Objects::new(device, &list)?;
    let screen = Screen::new(device)?;
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![objects.layout.clone(), layout],
        ..screen.pipeline(Painted(scene::camera(EYE, [0.0, 0.9, 0.0])))
    })?;
    device.render(&RenderPass {
        color_attachments: &screen.colors([sky[0], sky[1], sky[2]]),
        depth_stencil_attachment: screen.depths(),
        draws: &objects.bind(&map).draws(&pipeline),
        ..RenderPass::default()
    })?;
    Ok(screen.picture)
}

fn main() -> Outcome<()> {
    scene::write("cube_map_one_pass", picture)
}

#[test]
fn cube_map_one_pass_draws_its_picture() {
    scene::kept::check("cube_map_one_pass", picture);
}
