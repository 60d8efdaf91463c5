//! A cube with tiles on each side, on a floor of tiles: mip levels keep distant tiles calm. The
//! texture and the matrices are in a bind group.
//!
//! `cargo run --release -p estampe-gpu --features png --example textured_cube [OUT.png]`

mod scene;

use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry, BindingResource,
    BindingType, BufferBindingType, Device, Draw, FragmentIn, FragmentOut, Mat4, RenderPass,
    RenderPipelineDescriptor, SampleType, SamplerDescriptor, Texture, TextureBindings,
    TextureDescriptor, TextureFormat, Vec2, Vec3, VertexIn, VertexOut, ViewDimension,
};
use scene::{Corner, Outcome, Screen, Solid};

struct Textured;

estampe::varyings! {
    struct Surface<R> { normal: Vec3<R>, uv: Vec2<R> }
}

estampe::shader! {
    impl Shader for Textured {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            let clip_from_world = input.bindings.mat4(0, 0, 0);
            let world_from_object = input.bindings.mat4(0, 0, 64);
            let position_world = world_from_object.transform_point(a.position);
            let normal = world_from_object.transform_vector(a.normal);
            VertexOut::new(clip_from_world * position_world, Surface { normal, uv: a.uv })
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let texture = input.bindings.sampled_texture(0, 1);
            let texel = texture.sample(v.uv).rgb();
            FragmentOut::color((texel * scene::daylight(v.normal, 1.0)).point())
        }
    }
}

/// Tiles of two colours, 8×8 of them, with dark joints. The mip levels are generated.
fn tiles(device: &Device, [a, b]: [[u8; 4]; 2]) -> Outcome<Texture> {
    let mut texels = Vec::new();
    for y in 0..256 {
        for x in 0..256 {
            let is_joint = x % 32 < 2 || y % 32 < 2;
            texels.extend(match (is_joint, (x / 32 + y / 32) % 2) {
                (true, _) => [58, 52, 50, 255],
                (false, 0) => a,
                (false, _) => b,
            });
        }
    }
    let format = TextureFormat::Rgba8UnormSrgb;
    let descriptor = TextureDescriptor::new_2d(256, 256, format).with_all_levels();
    Ok(device.create_texture_with_data(&descriptor, &[&texels])?)
}

fn layout(device: &Device) -> Outcome<BindGroupLayout> {
    Ok(device.create_bind_group_layout(&[
        BindGroupLayoutEntry {
            binding: 0,
            ty: BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: 128,
            },
        },
        BindGroupLayoutEntry {
            binding: 1,
            ty: BindingType::SampledTexture {
                sample_type: SampleType::Float,
                view_dimension: ViewDimension::D2,
            },
        },
    ])?)
}

fn group(device: &Device, tiles: &Texture, world_from_object: Mat4) -> Outcome<BindGroup> {
    let clip_from_world = scene::camera([2.6, 2.4, 4.2], [0.0, 0.7, 0.0]);
    let matrices = [clip_from_world.0, world_from_object.0];
    let numbers = matrices.as_flattened().as_flattened();
    let uniforms = device.create_buffer_with_contents(estampe::bytes_of(numbers))?;
    let sampler = device.create_sampler(&SamplerDescriptor {
        max_anisotropy: 8,
        ..SamplerDescriptor::trilinear_repeat()
    })?;
    Ok(device.create_bind_group(&BindGroupDescriptor {
        label: Some("tiles"),
        layout: &layout(device)?,
        entries: &[
            (0, BindingResource::Buffer((&uniforms).into())),
            (1, BindingResource::SampledTexture(tiles.view(), sampler)),
        ],
    })?)
}

fn picture(device: &Device) -> Outcome<Texture> {
    let screen = Screen::new(device)?;
    let (cube, floor) = (Solid::cube(device)?, Solid::plane(device, 60.0)?);
    let bright = tiles(device, [[232, 214, 178, 255], [176, 66, 48, 255]])?;
    let gray = tiles(device, [[150, 156, 160, 255], [118, 124, 130, 255]])?;
    let turned = Mat4::translation([0.0, 1.0, 0.0]) * Mat4::rotation_y(-0.15);
    let of_cube = group(device, &bright, turned)?;
    let of_floor = group(device, &gray, Mat4::IDENTITY)?;
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![layout(device)?],
        ..screen.pipeline(Textured)
    })?;
    device.render(&RenderPass {
        color_attachments: &screen.colors([0.45, 0.62, 0.8]),
        depth_stencil_attachment: screen.depths(),
        draws: &[
            Draw {
                bind_groups: std::slice::from_ref(&of_floor),
                ..floor.draw(&pipeline)
            },
            Draw {
                bind_groups: std::slice::from_ref(&of_cube),
                ..cube.draw(&pipeline)
            },
        ],
        ..RenderPass::default()
    })?;
    Ok(screen.picture)
}

fn main() -> Outcome<()> {
    scene::write("textured_cube", picture)
}

#[test]
fn textured_cube_draws_its_picture() {
    scene::kept::check("textured_cube", picture);
}
