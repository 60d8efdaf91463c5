//! A shadow map: the depths that a light sees are drawn first, then compared with the depths of
//! what the camera sees. Each object has its matrix and colour in a bind group.
//!
//! `cargo run --release -p estampe-gpu --features png --example shadow_map [OUT.png]`

mod scene;

use estampe::state::DepthStencilState;
use estampe::{
    BindingResource, BindingType, DepthStencilAttachment, Device, FragmentIn, FragmentOut, Mat4,
    RenderPass, RenderPipelineDescriptor, Texture, TextureDescriptor, TextureFormat, Vec2, Vec3,
    VertexIn, VertexOut, sample_compare_sum,
};
use scene::{Corner, Objects, Outcome, Screen, Solid};

const MAP_SIDE: u32 = 1024;

/// Depth alone, seen from the light.
struct Depths {
    clip_from_world: Mat4,
}

estampe::shader! {
    impl Shader for Depths {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, ()> {
            let position_world = input.bindings.mat4(0, 0, 0).transform_point(a.position);
            VertexOut::new(self.clip_from_world * position_world, ())
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::none()
        }
    }
}

struct Shadowed {
    clip_from_world: Mat4,
    light_from_world: Mat4,
}

estampe::varyings! {
    struct Surface<R> { normal: Vec3<R>, position_light: Vec3<R> }
}

estampe::shader! {
    impl Shader for Shadowed {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            let world_from_object = input.bindings.mat4(0, 0, 0);
            let position_world = world_from_object.transform_point(a.position);
            VertexOut::new(self.clip_from_world * position_world, Surface {
                normal: world_from_object.transform_vector(a.normal),
                position_light: (self.light_from_world * position_world).xyz(), // w is 1
            })
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            // 5×5 comparisons, one texel apart, are a soft edge.
            let texel = 1.0 / MAP_SIDE as f32;
            let step = |k: usize| (k as f32 - 2.0) * texel;
            let offsets: [[f32; 2]; 25] = std::array::from_fn(|k| [step(k % 5), step(k / 5)]);
            let uv = v.position_light.xy() * Vec2::new(0.5, -0.5) + 0.5;
            let lit = match input.bindings.shadow_map(1, 0) {
                Some(map) => sample_compare_sum(map, uv, &offsets, v.position_light.z) / 25.0,
                None => input.real(1.0),
            };
            // Beyond the map there is light.
            let Vec3 { x, y, z } = v.position_light;
            let is_beyond = x.abs().max(y.abs()).max(z).ge(1.0);
            let lit = R::select(is_beyond, lit.splat(1.0), lit);
            let [r, g, b, _] = input.bindings.f32s(0, 0, 64);
            let light = scene::daylight(v.normal.normalize(), lit);
            FragmentOut::color((light * Vec3::new(r, g, b)).point())
        }
    }
}

fn picture(device: &Device) -> Outcome<Texture> {
    let screen = Screen::new(device)?;
    let (floor, cube) = (Solid::plane(device, 60.0)?, Solid::cube(device)?);
    let ball = Solid::sphere(device)?;
    let object = |solid, at: [f32; 3], size, turn, [r, g, b]: [f32; 3]| {
        let turned = Mat4::rotation_y(turn) * Mat4::scale([size; 3]);
        (solid, Mat4::translation(at) * turned, [r, g, b, 1.0])
    };
    let list = [
        object(&floor, [0.0; 3], 1.0, 0.0, [0.75, 0.73, 0.7]),
        object(&cube, [-1.3, 0.8, -0.4], 0.8, 0.5, [0.85, 0.25, 0.2]),
        object(&cube, [-1.2, 2.0, -0.5], 0.4, 0.1, [0.95, 0.65, 0.15]),
        object(&ball, [1.1, 1.0, -0.2], 1.0, 0.0, [0.2, 0.45, 0.8]),
        object(&ball, [0.1, 0.4, 1.4], 0.4, 0.0, [0.25, 0.65, 0.35]),
    ];
    let objects = Objects::new(device, &list)?;

    // The pass that draws the map: depths alone, moved a little away from the light.
    let format = TextureFormat::Depth32Float;
    let map = device.create_texture(&TextureDescriptor::new_2d(MAP_SIDE, MAP_SIDE, format))?;
    let map = map.view();
    let mut depth_stencil = DepthStencilState::LESS_WRITE;
    (depth_stencil.bias.constant, depth_stencil.bias.slope_scale) = (4.0, 4.0);
    let sun = scene::TOWARDS_SUN.map(|x| x * 10.0);
    let light_from_world = Mat4::orthographic(-4.0, 4.0, -4.0, 4.0, 1.0, 16.0)
        * Mat4::look_at(sun, [0.0; 3], [0.0, 1.0, 0.0]);
    let clip_from_world = light_from_world;
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![objects.layout.clone()],
        vertex_buffers: vec![Solid::layout()],
        targets: Vec::new(),
        depth_stencil: Some(depth_stencil),
        ..RenderPipelineDescriptor::new(Depths { clip_from_world })
    })?;
    device.render(&RenderPass {
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&map, 1.0)),
        draws: &objects.draws(&pipeline),
        ..RenderPass::default()
    })?;

    // The pass that reads it.
    let map = [(BindingType::ShadowMap, BindingResource::Texture(map))];
    let (layout, map) = scene::bind(device, &map)?;
    let clip_from_world = scene::camera([1.2, 3.2, 6.0], [0.0, 0.8, 0.0]);
    let shader = Shadowed {
        clip_from_world,
        light_from_world,
    };
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![objects.layout.clone(), layout],
        ..screen.pipeline(shader)
    })?;
    device.render(&RenderPass {
        color_attachments: &screen.colors([0.5, 0.65, 0.85]),
        depth_stencil_attachment: screen.depths(),
        draws: &objects.bind(&map).draws(&pipeline),
        ..RenderPass::default()
    })?;
    Ok(screen.picture)
}

fn main() -> Outcome<()> {
    scene::write("shadow_map", picture)
}

#[test]
fn shadow_map_draws_its_picture() {
    scene::kept::check("shadow_map", picture);
}
