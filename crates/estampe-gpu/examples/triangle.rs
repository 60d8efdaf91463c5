//! A triangle with a colour at each corner: the whole way from numbers to a picture.
//!
//! `cargo run --release -p estampe-gpu --features png --example triangle [OUT.png]`

mod scene;

use estampe::state::VertexBufferLayout;
use estampe::{
    ColorAttachment, Device, Draw, FragmentIn, FragmentOut, RenderPass, RenderPipelineDescriptor,
    Texture, TextureDescriptor, TextureFormat, Vec2, Vec3, VertexFormat, VertexIn, VertexOut,
};
use scene::Outcome;

/// Vertices in clip space; colours are interpolated between them.
struct Rainbow;

estampe::shader! {
    impl Shader for Rainbow {
        type Attributes<R: Real> = (Vec2<R>, Vec3<R>); // position, colour
        type Varyings<R: Real> = Vec3<R>; // colour

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec2<R>, Vec3<R>),
        ) -> VertexOut<R, Vec3<R>> {
            VertexOut::new(position.extend(0.0).point(), color)
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec3<R>) -> FragmentOut<R> {
            FragmentOut::color(color.point())
        }
    }
}

fn picture(device: &Device) -> Outcome<Texture> {
    // The picture. Colours are linear; an sRGB format stores them as monitors expect them.
    let format = TextureFormat::Rgba8UnormSrgb;
    let picture = device.create_texture(&TextureDescriptor::new_2d(320, 240, format))?;

    // The corners: x to the right, y up, then red, green and blue.
    let corners: [[f32; 5]; 3] = [
        [-0.8, -0.8, 1.0, 0.0, 0.0],
        [0.8, -0.8, 0.0, 1.0, 0.0],
        [0.0, 0.85, 0.0, 0.0, 1.0],
    ];
    let vertices = device.create_buffer_with_contents(estampe::bytes_of(&corners))?;

    // The pipeline: the shader, and how it is fed.
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout::packed(&[
            VertexFormat::Float32x2,
            VertexFormat::Float32x3,
        ])],
        depth_stencil: None,
        targets: vec![Some(format.into())],
        ..RenderPipelineDescriptor::new(Rainbow)
    })?;

    // One pass of one draw. It is complete when `render` returns.
    let background = [0.02, 0.02, 0.03, 1.0];
    device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&picture.view(), background))],
        draws: &[Draw {
            vertex_buffers: &[(&vertices).into()],
            ..Draw::new(&pipeline, 0..3)
        }],
        ..RenderPass::default()
    })?;
    Ok(picture)
}

fn main() -> Outcome<()> {
    scene::write("triangle", picture)
}

#[test]
fn triangle_draws_its_picture() {
    scene::kept::check("triangle", picture);
}
