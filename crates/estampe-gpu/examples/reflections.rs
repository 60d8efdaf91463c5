//! Reflections: the surroundings of two balls are drawn into the six faces of a cube map, its mip
//! levels are generated, and the balls mirror it: one sharply, the other with a rough surface.
//!
//! `cargo run --release -p estampe-gpu --features png --example reflections [OUT.png]`

mod scene;

use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, FragmentIn, FragmentOut, Mat4, RenderPass,
    RenderPipelineDescriptor, SamplerDescriptor, Texture, TextureBindings, TextureDescriptor,
    TextureFormat, TextureViewDescriptor, Vec3, VertexIn, VertexOut, ViewDimension, maths,
};
use scene::{Corner, Objects, Outcome, Screen, Solid};

const FORMAT: TextureFormat = TextureFormat::Rgba16Float;
const SIDE: u32 = 256;
const EYE: [f32; 3] = [0.0, 2.1, 6.2];

/// Draws objects by the fourth number of their colour: a painted one, a sky, a floor of tiles, and
/// from 1 on a mirror, which is the rougher the greater the number.
#[derive(Clone, Copy)]
struct Surroundings {
    clip_from_world: Mat4,
}

const PAINT: f32 = 0.0;
const SKY: f32 = 0.25;
const TILES: f32 = 0.5;
const MIRROR: f32 = 1.0;

estampe::varyings! {
    struct Surface<R> { normal: Vec3<R>, position: Vec3<R> }
}

estampe::shader! {
    impl Shader for Surroundings {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            let world_from_object = input.bindings.mat4(0, 0, 0);
            let position_world = world_from_object.transform_point(a.position);
            VertexOut::new(self.clip_from_world * position_world, Surface {
                normal: world_from_object.transform_vector(a.normal),
                position: position_world.xyz(),
            })
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let [r, g, b, kind] = input.bindings.f32s(0, 0, 64);
            let (color, normal) = (Vec3::uniform(input.zero, [r, g, b]), v.normal.normalize());
            if kind == SKY {
                let direction = v.position.normalize();
                let height = direction.y.abs().sqrt();
                let sky = Vec3::uniform(input.zero, [0.85, 0.88, 0.9]).mix(color, height);
                let sun = direction.dot_uniform(scene::TOWARDS_SUN).saturate();
                return FragmentOut::color((sky + maths::powi(sun, 64) * 3.0).point());
            }
            if kind >= MIRROR {
                let cube = input.bindings.sampled_texture(1, 0);
                let sight = (v.position - Vec3::from(EYE)).normalize();
                let level = input.real(kind - MIRROR);
                let light = cube.sample_level(sight.reflect(normal), level).rgb();
                // Grazing light is reflected without the colour of the metal.
                let grazing = maths::powi(1.0 + sight.dot(normal).min(0.0), 5);
                let metal = color.mix(Vec3::repeat(input.real(1.0)), grazing);
                return FragmentOut::color((metal * light).point());
            }
            let light = color * scene::daylight(normal, 1.0);
            let parity = (v.position.x.floor() + v.position.z.floor()).modulo(2.0);
            let tile = if kind == TILES { parity * 0.7 + 0.3 } else { input.real(1.0) };
            FragmentOut::color((light * tile).point())
        }
    }
}

fn picture(device: &Device) -> Outcome<Texture> {
    let (cube, ball) = (Solid::cube(device)?, Solid::sphere(device)?);
    let floor = Solid::plane(device, 30.0)?;
    let sky = Mat4::scale([40.0; 3]);
    let mut list = vec![(&ball, sky, [0.1, 0.3, 0.75, SKY])];
    list.push((&floor, Mat4::IDENTITY, [0.8, 0.76, 0.7, TILES]));
    for k in 0..9_u8 {
        let turn = (f32::from(k) - 4.0) * std::f32::consts::TAU / 12.0 + 0.1;
        let hue = |shift: f32| 0.5 + 0.45 * maths::cos(turn + shift);
        let height = 0.5 + 0.35 * f32::from(k * 7 % 4);
        let place = Mat4::rotation_y(turn) * Mat4::translation([0.0, height, -4.2]);
        let block = place * Mat4::scale([0.45, height, 0.45]);
        list.push((&cube, block, [hue(0.0), hue(2.1), hue(4.2), PAINT]));
    }
    let surroundings = Objects::new(device, &list)?;

    // The cube map, drawn from between the balls.
    let mut descriptor = TextureDescriptor::new_2d(SIDE, SIDE, FORMAT).with_all_levels();
    descriptor.size.depth_or_array_layers = 6;
    let map = device.create_texture(&descriptor)?;
    let depths = TextureDescriptor::new_2d(SIDE, SIDE, TextureFormat::Depth32Float);
    let depths = device.create_texture(&depths)?.view();
    for face in 0..6 {
        let clip_from_world = scene::clip_from_cube_face([0.0, 1.0, 0.0], face);
        let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
            bind_group_layouts: vec![surroundings.layout.clone()],
            vertex_buffers: vec![Solid::layout()],
            targets: vec![Some(FORMAT.into())],
            ..RenderPipelineDescriptor::new(Surroundings { clip_from_world })
        })?;
        let view = map.image(0, u32::try_from(face)?)?;
        device.render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&view, [0.0; 4]))],
            depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depths, 1.0)),
            draws: &surroundings.draws(&pipeline),
            ..RenderPass::default()
        })?;
    }
    device.generate_mips(&map)?;
    let view = map.create_view(&TextureViewDescriptor {
        dimension: Some(ViewDimension::Cube),
        ..TextureViewDescriptor::default()
    })?;
    let sampler = device.create_sampler(&SamplerDescriptor::trilinear_repeat())?;
    let (layout, map) = scene::bind(device, &[scene::sampled(&view, &sampler)])?;

    let left = Mat4::translation([-1.1, 1.0, 0.0]);
    list.push((&ball, left, [0.95, 0.96, 1.0, MIRROR]));
    let right = Mat4::translation([1.1, 1.0, 0.0]);
    list.push((&ball, right, [1.0, 0.76, 0.34, MIRROR + 3.5]));
    let objects = Objects::new(device, &list)?;
    let screen = Screen::new(device)?;
    let clip_from_world = scene::camera(EYE, [0.0, 1.0, 0.0]);
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![objects.layout.clone(), layout],
        ..screen.pipeline(Surroundings { clip_from_world })
    })?;
    device.render(&RenderPass {
        color_attachments: &screen.colors([0.0; 3]),
        depth_stencil_attachment: screen.depths(),
        draws: &objects.bind(&map).draws(&pipeline),
        ..RenderPass::default()
    })?;
    Ok(screen.picture)
}

fn main() -> Outcome<()> {
    scene::write("reflections", picture)
}

#[test]
fn reflections_draws_its_picture() {
    scene::kept::check("reflections", picture);
}
