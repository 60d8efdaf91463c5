//! Multisampling: thin rays with one sample per pixel on the left, and with eight on the right,
//! which the pass resolves at its end. Each pixel is shown as 2×2.
//!
//! `cargo run --release -p estampe-gpu --features png --example multisampling [OUT.png]`

mod scene;

use estampe::state::{MultisampleState, VertexBufferLayout};
use estampe::{
    BlitRegion, ColorAttachment, Device, Draw, FilterMode, FragmentIn, FragmentOut, RenderPass,
    RenderPipelineDescriptor, StoreOp, Texture, TextureDescriptor, TextureFormat, Vec2, Vec3,
    VertexFormat, VertexIn, VertexOut, maths,
};
use scene::{Outcome, SIZE};

const FORMAT: TextureFormat = TextureFormat::Rgba8UnormSrgb;
const RAYS: u16 = 36;

struct Rays;

estampe::shader! {
    impl Shader for Rays {
        type Attributes<R: Real> = (Vec2<R>, Vec3<R>); // position, colour
        type Varyings<R: Real> = Vec3<R>; // colour

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec2<R>, Vec3<R>),
        ) -> VertexOut<R, Vec3<R>> {
            VertexOut::new((position * Vec2::new(0.75, 1.0)).extend(0.0).point(), color)
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec3<R>) -> FragmentOut<R> {
            FragmentOut::color(color.point())
        }
    }
}

/// Three vertices for each ray: thin near the middle, or thin far from it.
fn rays() -> Vec<[f32; 5]> {
    let mut vertices = Vec::new();
    for ray in 0..RAYS {
        let part = f32::from(ray) / f32::from(RAYS);
        let angle = std::f32::consts::TAU * part + 0.02;
        let hue = |shift: f32| 0.5 + 0.5 * maths::cos((part + shift) * std::f32::consts::TAU);
        let (r, g, b) = (hue(0.0), hue(0.667), hue(0.333));
        let corner = |radius: f32, turn: f32| {
            let (x, y) = (
                maths::cos(angle + turn) * radius,
                maths::sin(angle + turn) * radius,
            );
            [x, y, r, g, b]
        };
        if ray % 2 == 0 {
            vertices.extend([corner(0.12, 0.0), corner(0.95, -0.03), corner(0.95, 0.03)]);
        } else {
            vertices.extend([corner(0.3, -0.07), corner(0.95, 0.0), corner(0.3, 0.07)]);
        }
    }
    vertices
}

/// The rays with so many samples per pixel.
fn draw(device: &Device, samples: u32) -> Outcome<Texture> {
    let small = TextureDescriptor::new_2d(SIZE[0] / 2, SIZE[1] / 2, FORMAT);
    let rays = rays();
    let count = u32::try_from(rays.len())?;
    let vertices = device.create_buffer_with_contents(estampe::bytes_of(&rays))?;
    let formats = [VertexFormat::Float32x2, VertexFormat::Float32x3];
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout::packed(&formats)],
        depth_stencil: None,
        multisample: MultisampleState::new(samples),
        targets: vec![Some(FORMAT.into())],
        ..RenderPipelineDescriptor::new(Rays)
    })?;
    let picture = device.create_texture(&small)?;
    let mut attachment = ColorAttachment::clear(&picture.view(), [0.01, 0.01, 0.015, 1.0]);
    if samples > 1 {
        // Render to a texture of several samples, and keep their mean alone.
        attachment.view = device
            .create_texture(&TextureDescriptor {
                sample_count: samples,
                ..small
            })?
            .view();
        attachment.resolve_target = Some(picture.view());
        attachment.store = StoreOp::Discard;
    }
    device.render(&RenderPass {
        color_attachments: &[Some(attachment)],
        draws: &[Draw {
            vertex_buffers: &[(&vertices).into()],
            ..Draw::new(&pipeline, 0..count)
        }],
        ..RenderPass::default()
    })?;
    Ok(picture)
}

fn picture(device: &Device) -> Outcome<Texture> {
    let picture = scene::target(device, FORMAT, 1)?.view();
    let [width, height] = SIZE.map(|side| side / 2);
    for (half, samples) in [(0, 1), (1, 8)] {
        let drawn = draw(device, samples)?.view();
        let from = BlitRegion {
            view: &drawn,
            origin: [half * width / 2, 0],
            size: [width / 2, height],
        };
        let into = BlitRegion {
            view: &picture,
            origin: [half * width, 0],
            size: [width, height * 2],
        };
        device.blit(from, into, FilterMode::Nearest)?;
    }
    Ok(picture.texture().clone())
}

fn main() -> Outcome<()> {
    scene::write("multisampling", picture)
}

#[test]
fn multisampling_draws_its_picture() {
    scene::kept::check("multisampling", picture);
}
