//! A user interface: panels with round corners and letters of an atlas are quads of one pipeline,
//! blended with premultiplied alpha. A scissor rectangle cuts the list.
//!
//! `cargo run --release -p estampe-gpu --features png --example ui [OUT.png]`

mod scene;

use estampe::state::{
    BlendState, ColorTargetState, PrimitiveState, PrimitiveTopology, ScissorRect,
    VertexBufferLayout, VertexStepMode,
};
use estampe::{
    ColorAttachment, Device, Draw, FragmentIn, FragmentOut, RenderPass, RenderPipelineDescriptor,
    SamplerDescriptor, Texture, TextureBindings, TextureFormat, Vec2, Vec4, VertexFormat, VertexIn,
    VertexOut,
};
use scene::{Outcome, SIZE, page};

estampe::attributes! {
    /// A rectangle; all vertices of an instance read the same.
    struct Quad<R> {
        rectangle: Vec4<R>, // left, top, width, height in pixels
        color: Vec4<R>, // premultiplied
        radius: R, // of the corners, in pixels
        cell: R, // of the atlas
    }
}

estampe::varyings! {
    struct Pixel<R> {
        texel: Vec2<R>,
        from_centre: Vec2<R>,
        #[flat] half: Vec2<R>,
        #[flat] radius: R,
        #[flat] color: Vec4<R>,
    }
}

struct Quads;

/// The rectangle of the list, in pixels.
const LIST: ScissorRect = ScissorRect {
    x: 64,
    y: 72,
    width: 184,
    height: 92,
};

estampe::shader! {
    impl Shader for Quads {
        type Attributes<R: Real> = Quad<R>;
        type Varyings<R: Real> = Pixel<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Quad<R>) -> VertexOut<R, Pixel<R>> {
            // Vertices 0 to 3 are (0, 0), (0, 1), (1, 0), (1, 1).
            let index = input.vertex_index;
            let at = Vec2::new((index >> 1).to_real(), (index & index.splat(1)).to_real());
            let size = a.rectangle.zw();
            let [width, height] = SIZE.map(|side| side as f32);
            let position = (a.rectangle.xy() + at * size) * Vec2::new(2.0 / width, -2.0 / height);
            VertexOut::new((position + Vec2::new(-1.0, 1.0)).extend(0.0).point(), Pixel {
                texel: at * Vec2::new(5.0, 7.0) + Vec2::new(a.cell * 6.0, input.zero),
                from_centre: (at - 0.5) * size,
                half: size * 0.5,
                radius: a.radius,
                color: a.color,
            })
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Pixel<R>) -> FragmentOut<R> {
            let at = v.texel / Vec2::new(162.0, 8.0);
            let letter = input.bindings.sampled_texture(0, 0).sample(at).x;
            // The signed distance from the edge of a rectangle with round corners.
            let from_corner = v.from_centre.abs() - v.half + v.radius;
            let inside = from_corner.x.max(from_corner.y).min(0.0);
            let distance = from_corner.max(0.0).length() + inside - v.radius;
            FragmentOut::color(v.color * ((0.5 - distance).saturate() * letter))
        }
    }
}

fn picture(device: &Device) -> Outcome<Texture> {
    let (white, gray, blue) = ([1.0; 3], [0.4, 0.45, 0.55], [0.05, 0.35, 0.9, 1.0]);
    let mut page = page::Page::default();
    page.panel([-40.0, 110.0, 180.0, 180.0], 90.0, [0.9, 0.1, 0.4, 0.8]);
    page.panel([60.0, -70.0, 200.0, 200.0], 100.0, [1.0, 0.55, 0.05, 0.7]);
    page.panel([190.0, 90.0, 190.0, 190.0], 95.0, [0.1, 0.5, 1.0, 0.8]);
    page.panel([46.0, 24.0, 228.0, 198.0], 17.0, [0.0, 0.0, 0.0, 0.25]);
    page.panel([48.0, 24.0, 224.0, 192.0], 14.0, [0.02, 0.025, 0.05, 0.82]);
    page.text([66.0, 40.0], 3.0, white, "ESTAMPE");
    page.panel([64.0, 72.0, 184.0, 92.0], 6.0, [1.0, 1.0, 1.0, 0.06]);
    page.panel([254.0, 84.0, 6.0, 40.0], 3.0, [1.0, 1.0, 1.0, 0.5]);
    page.panel([64.0, 176.0, 94.0, 26.0], 13.0, blue);
    page.text([76.0, 182.0], 2.0, white, "RENDER");
    page.panel([166.0, 176.0, 94.0, 26.0], 13.0, [1.0, 1.0, 1.0, 0.1]);
    page.text([178.0, 182.0], 2.0, white, "CANCEL");
    let list_starts = u32::try_from(page.0.len())?;
    page.panel([68.0, 102.0, 176.0, 22.0], 5.0, blue);
    page.text([76.0, 62.0], 2.0, gray, "BUFFERS");
    page.text([76.0, 84.0], 2.0, gray, "TEXTURES");
    page.text([76.0, 106.0], 2.0, white, "BIND GROUPS");
    page.text([76.0, 128.0], 2.0, gray, "PIPELINES");
    page.text([76.0, 150.0], 2.0, gray, "PASSES");
    let quads = device.create_buffer_with_contents(estampe::bytes_of(&page.0))?;
    let sampler = device.create_sampler(&SamplerDescriptor::default())?;
    let atlas = scene::sampled(&page::atlas(device)?.view(), &sampler);
    let (layout, atlas) = scene::bind(device, &[atlas])?;
    use VertexFormat::{Float32, Float32x4};
    let mut by_instance = VertexBufferLayout::packed(&[Float32x4, Float32x4, Float32, Float32]);
    by_instance.step_mode = VertexStepMode::Instance;
    let mut target = ColorTargetState::from(TextureFormat::Rgba8UnormSrgb);
    target.blend = Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING);
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![layout],
        vertex_buffers: vec![by_instance],
        primitive: PrimitiveState {
            topology: PrimitiveTopology::TriangleStrip,
            ..PrimitiveState::default()
        },
        depth_stencil: None,
        targets: vec![Some(target)],
        ..RenderPipelineDescriptor::new(Quads)
    })?;
    let (quads, groups) = ([(&quads).into()], [atlas]);
    let buttons = Draw {
        vertex_buffers: &quads,
        bind_groups: &groups,
        instances: 0..list_starts,
        ..Draw::new(&pipeline, 0..4)
    };
    let list = Draw {
        instances: list_starts..u32::try_from(page.0.len())?,
        scissor: Some(LIST),
        ..buttons.clone()
    };
    let picture = scene::target(device, target.format, 1)?;
    let clear = ColorAttachment::clear(&picture.view(), [0.03, 0.03, 0.06, 1.0]);
    device.render(&RenderPass {
        color_attachments: &[Some(clear)],
        draws: &[buttons, list],
        ..RenderPass::default()
    })?;
    Ok(picture)
}

fn main() -> Outcome<()> {
    scene::write("ui", picture)
}

#[test]
fn ui_draws_its_picture() {
    scene::kept::check("ui", picture);
}
