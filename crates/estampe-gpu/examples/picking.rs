//! Picking: a pass draws the number of each object into an r32uint texture, one texel of which
//! tells the object under the cursor. The second pass draws that object in another colour.
//!
//! `cargo run --release -p estampe-gpu --features png --example picking [OUT.png]`

mod scene;

use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Extent3d, FragmentIn, FragmentOut, Mat4,
    RenderPass, RenderPipelineDescriptor, TexelCopyLayout, Texture, TextureCopy, TextureFormat,
    Vec3, VertexIn, VertexOut, vec4,
};
use scene::{Corner, Objects, Outcome, Screen, Solid};

/// The pixel under the cursor.
const CURSOR: [u32; 2] = [202, 128];
/// The value that the texture of numbers is cleared to.
const NOTHING: u32 = u32::MAX;

/// Draws solids in the colour of their bind group, or as their number.
#[derive(Clone, Copy)]
struct Object {
    clip_from_world: Mat4,
    draws_number: bool,
}

estampe::shader! {
    impl Shader for Object {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Vec3<R>; // normal

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Vec3<R>> {
            let world_from_object = input.bindings.mat4(0, 0, 0);
            let position_world = world_from_object.transform_point(a.position);
            let normal = world_from_object.transform_vector(a.normal);
            VertexOut::new(self.clip_from_world * position_world, normal)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, normal: Vec3<R>) -> FragmentOut<R> {
            if self.draws_number {
                // The fourth number of the colour is the object's; integers are given as bits.
                let [number] = input.bindings.f32s(0, 0, 76);
                let bits = input.real(number).to_int().to_real_bits();
                return FragmentOut::color(vec4(bits, 0.0, 0.0, 0.0));
            }
            let [r, g, b] = input.bindings.f32s(0, 0, 64);
            let light = scene::daylight(normal.normalize(), 1.0);
            FragmentOut::color((light * Vec3::new(r, g, b)).point())
        }
    }
}

/// The object in a pixel of the texture of numbers.
fn pick(device: &Device, numbers: &Texture, [x, y]: [u32; 2]) -> Outcome<Option<u32>> {
    let copy = TextureCopy::from(numbers).at([x, y, 0]);
    let mut bytes = [0; 4];
    let one = Extent3d::new_2d(1, 1);
    device.read_texture_into(copy, &mut bytes, &TexelCopyLayout::default(), one)?;
    let number = u32::from_le_bytes(bytes);
    Ok((number != NOTHING).then_some(number))
}

fn picture(device: &Device) -> Outcome<Texture> {
    let screen = Screen::new(device)?;
    let solids = [Solid::cube(device)?, Solid::sphere(device)?];
    let mut list = Vec::new();
    for k in 0..25_u8 {
        let at = [f32::from(k % 5) - 2.0, 0.0, f32::from(k / 5) - 2.0].map(|x| x * 1.3);
        let matrix = Mat4::translation(at) * Mat4::rotation_y(0.4) * Mat4::scale([0.45; 3]);
        list.push((
            &solids[usize::from(k % 2)],
            matrix,
            [0.16, 0.3, 0.5, f32::from(k)],
        ));
    }
    let objects = Objects::new(device, &list)?;
    let shader = Object {
        clip_from_world: scene::camera([3.2, 5.0, 7.2], [0.0, -0.2, 0.0]),
        draws_number: false,
    };

    let format = TextureFormat::R32Uint;
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![objects.layout.clone()],
        vertex_buffers: vec![Solid::layout()],
        targets: vec![Some(format.into())],
        ..RenderPipelineDescriptor::new(Object {
            draws_number: true,
            ..shader
        })
    })?;
    let numbers = scene::target(device, format, 1)?;
    let depths = scene::target(device, TextureFormat::Depth32Float, 1)?;
    let nothing = [f64::from(NOTHING), 0.0, 0.0, 0.0];
    device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&numbers.view(), nothing))],
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depths.view(), 1.0)),
        draws: &objects.draws(&pipeline),
        ..RenderPass::default()
    })?;
    if let Some(k) = pick(device, &numbers, CURSOR)? {
        list[k as usize].2 = [1.0, 0.45, 0.08, 0.0];
    }

    let objects = Objects::new(device, &list)?;
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![objects.layout.clone()],
        ..screen.pipeline(shader)
    })?;
    device.render(&RenderPass {
        color_attachments: &screen.colors([0.01, 0.012, 0.02]),
        depth_stencil_attachment: screen.depths(),
        draws: &objects.draws(&pipeline),
        ..RenderPass::default()
    })?;
    Ok(screen.picture)
}

fn main() -> Outcome<()> {
    scene::write("picking", picture)
}

#[test]
fn picking_draws_its_picture() {
    scene::kept::check("picking", picture);
}
