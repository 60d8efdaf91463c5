//! A golden picture: a small scene is drawn and compared, byte for byte, with a committed file.
//!
//! Copy this test to guard pictures of your own. Since every machine, SIMD level and number of
//! threads gives the same bits, no tolerance is needed, and none hides a change.
//!
//! ```sh
//! UPDATE_GOLDEN=1 cargo test -p estampe-gpu --test golden # writes the file anew
//! ```

use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, DeviceDescriptor, Draw, FragmentIn,
    FragmentOut, RenderPass, RenderPipelineDescriptor, Texture, TextureDescriptor, TextureFormat,
    Vec3, VertexFormat, VertexIn, VertexOut, state::VertexBufferLayout,
};
use std::error::Error;
use std::path::Path;

/// Triangles in clip space, with a colour at each corner.
struct Colored;

estampe::shader! {
    impl Shader for Colored {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>); // position, colour
        type Varyings<R: Real> = Vec3<R>; // colour

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec3<R>, Vec3<R>),
        ) -> VertexOut<R, Vec3<R>> {
            VertexOut::new(position.point(), color)
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec3<R>) -> FragmentOut<R> {
            FragmentOut::color(color.point())
        }
    }
}

/// Two triangles that cut each other, 64×48 pixels.
fn picture(device: &Device) -> Result<Texture, Box<dyn Error>> {
    let image = |format| device.create_texture(&TextureDescriptor::new_2d(64, 48, format));
    let picture = image(TextureFormat::Rgba8UnormSrgb)?;
    let depths = image(TextureFormat::Depth32Float)?;
    let corners: [[f32; 6]; 6] = [
        [-0.9, -0.8, 0.2, 1.0, 0.1, 0.1],
        [0.7, -0.6, 0.8, 1.0, 0.6, 0.1],
        [-0.3, 0.9, 0.5, 1.0, 0.9, 0.2],
        [0.9, -0.8, 0.2, 0.1, 0.2, 1.0],
        [0.4, 0.8, 0.6, 0.2, 0.9, 0.9],
        [-0.8, -0.3, 0.8, 0.4, 0.1, 0.8],
    ];
    let vertices = device.create_buffer_with_contents(estampe::bytes_of(&corners))?;
    let formats = [VertexFormat::Float32x3, VertexFormat::Float32x3];
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout::packed(&formats)],
        targets: vec![Some(picture.format().into())],
        ..RenderPipelineDescriptor::new(Colored)
    })?;
    let background = [0.02, 0.02, 0.03, 1.0];
    device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&picture.view(), background))],
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depths.view(), 1.0)),
        draws: &[Draw {
            vertex_buffers: &[(&vertices).into()],
            ..Draw::new(&pipeline, 0..6)
        }],
        ..RenderPass::default()
    })?;
    Ok(picture)
}

/// Compares a texture with `tests/golden/NAME.png`. The picture that differs is written beside the
/// build's other files, to be looked at.
fn check_golden(device: &Device, name: &str, texture: &Texture) -> Result<(), Box<dyn Error>> {
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/golden/{name}.png"));
    let drawn = device.encode_png(texture)?;
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&golden, &drawn)?;
    }
    if std::fs::read(&golden).is_ok_and(|expected| expected == drawn) {
        return Ok(());
    }
    let actual = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
    std::fs::write(&actual, &drawn)?;
    panic!(
        "the picture differs from the golden one\n  golden: {}\n  drawn:  {}\nif the change is \
         meant: UPDATE_GOLDEN=1 cargo test -p estampe-gpu --test golden",
        golden.display(),
        actual.display()
    );
}

#[test]
fn triangles_that_cut_each_other_are_the_golden_picture() -> Result<(), Box<dyn Error>> {
    let device = Device::new(&DeviceDescriptor::default())?;
    check_golden(&device, "triangles", &picture(&device)?)
}
