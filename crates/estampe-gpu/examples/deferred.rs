//! Deferred shading: one pass writes albedo, normal and position of every pixel into three colour
//! targets, a second one lights the pixels by 40 lamps. A blit halves the result.
//!
//! `cargo run --release -p estampe-gpu --features png --example deferred [OUT.png]`

mod scene;

use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, FilterMode, FragmentIn, FragmentOut, Mat4,
    RenderPass, RenderPipelineDescriptor, SamplerDescriptor, Texture, TextureBindings,
    TextureDescriptor, TextureFormat, Vec3, VertexIn, VertexOut, maths,
};
use scene::{Corner, Objects, Outcome, SIZE, Solid};

const LAMPS: u32 = 40;
const FORMATS: [TextureFormat; 3] = [
    TextureFormat::Rgba8UnormSrgb,
    TextureFormat::Rgba16Float,
    TextureFormat::Rgba16Float,
];

struct Geometry {
    clip_from_world: Mat4,
}

estampe::varyings! {
    struct Surface<R> { normal: Vec3<R>, position_world: Vec3<R> }
}

estampe::shader! {
    impl Shader for Geometry {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Surface<R>> {
            let world_from_object = input.bindings.mat4(0, 0, 0);
            let position_world = world_from_object.transform_point(a.position);
            VertexOut::new(self.clip_from_world * position_world, Surface {
                normal: world_from_object.transform_vector(a.normal),
                position_world: position_world.xyz(),
            })
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Surface<R>) -> FragmentOut<R> {
            let [r, g, b, _] = input.bindings.f32s(0, 0, 64);
            FragmentOut::color(Vec3::uniform(input.zero, [r, g, b]).point())
                .with_color(1, v.normal.normalize().point())
                .with_color(2, v.position_world.point())
        }
    }
}

/// Three vertices without attributes that cover the picture; the sum of what the lamps give.
struct Lamps;

estampe::shader! {
    impl Shader for Lamps {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            VertexOut::new(scene::covering(input), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let (x, y) = (input.position.x.to_int(), input.position.y.to_int());
            let zero = x.splat(0);
            let texel = |binding| {
                let texture = input.bindings.sampled_texture(1, binding);
                texture.view().fetch([x, y, zero], zero, zero)
            };
            let (albedo, normal, position) = (texel(0), texel(1).xyz(), texel(2).xyz());
            let mut light = Vec3::repeat(normal.y * 0.01 + 0.02);
            for lamp in 0..LAMPS {
                let [lx, ly, lz, _, r, g, b, _] = input.bindings.f32s::<8>(0, 0, lamp * 32);
                let towards = Vec3::new(lx, ly, lz) - position;
                let distance2 = towards.dot(towards);
                let facing = normal.dot(towards) / distance2.sqrt();
                // Inverse square, and zero from a distance of 2 on.
                let window = (1.0 - distance2 * 0.25).saturate();
                light += facing.saturate() * window * window / (distance2 * 2.5 + 0.1)
                    * Vec3::new(r, g, b);
            }
            FragmentOut::color((albedo.rgb() * light).point())
        }
    }
}

/// Position and colour of each lamp, on a spiral around the middle.
fn lamps() -> Vec<f32> {
    let lamp = |k: u32| {
        let turn = k as f32 * 2.4;
        let radius = 0.75 * (k as f32 + 0.5).sqrt();
        let hue = |shift: f32| 0.5 + 0.5 * maths::cos(k as f32 * 0.9 + shift);
        let (x, z) = (maths::cos(turn) * radius, maths::sin(turn) * radius);
        [x, 0.35, z, 1.0, hue(0.0), hue(2.1), hue(4.2), 1.0]
    };
    (0..LAMPS).flat_map(lamp).collect()
}

fn picture(device: &Device) -> Outcome<Texture> {
    // Twice the size of the picture.
    let [width, height] = SIZE.map(|side| side * 2);
    let image = |format| device.create_texture(&TextureDescriptor::new_2d(width, height, format));
    let targets = [image(FORMATS[0])?, image(FORMATS[1])?, image(FORMATS[2])?];
    let depth = image(TextureFormat::Depth32Float)?;

    let (floor, ball) = (Solid::plane(device, 20.0)?, Solid::sphere(device)?);
    let mut list = vec![(&floor, Mat4::IDENTITY, [0.7; 4])];
    for (x, z) in (0..49_u8).map(|k| (f32::from(k % 7), f32::from(k / 7))) {
        let at = Mat4::translation([x - 3.0, 0.3, z - 3.0]);
        list.push((&ball, at * Mat4::scale([0.3; 3]), [0.9; 4]));
    }
    let objects = Objects::new(device, &list)?;
    let clip_from_world = scene::camera([0.0, 3.4, 5.2], [0.0, -0.1, 0.3]);
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![objects.layout.clone()],
        vertex_buffers: vec![Solid::layout()],
        targets: FORMATS.map(|format| Some(format.into())).to_vec(),
        ..RenderPipelineDescriptor::new(Geometry { clip_from_world })
    })?;
    let clear = |target: &Texture| Some(ColorAttachment::clear(&target.view(), [0.0; 4]));
    device.render(&RenderPass {
        color_attachments: &targets.each_ref().map(clear),
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth.view(), 1.0)),
        draws: &objects.draws(&pipeline),
        ..RenderPass::default()
    })?;

    let sampler = device.create_sampler(&SamplerDescriptor::default())?;
    let targets = targets.map(|target| scene::sampled(&target.view(), &sampler));
    let bound = [
        scene::bind_numbers(device, &lamps())?,
        scene::bind(device, &targets)?,
    ];
    let lit = image(FORMATS[0])?.view();
    let into = ColorAttachment::clear(&lit, [0.0; 4]);
    scene::fill(device, Lamps, &bound.each_ref(), into, None)?;

    let picture = scene::target(device, FORMATS[0], 1)?;
    let whole = picture.view();
    device.blit(&lit, &whole, FilterMode::Linear)?;
    Ok(picture)
}

fn main() -> Outcome<()> {
    scene::write("deferred", picture)
}

#[test]
fn deferred_draws_its_picture() {
    scene::kept::check("deferred", picture);
}
