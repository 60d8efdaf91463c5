//! Precision of depth formats: two planes a centimetre apart, at distances up to nine kilometres.
//!
//! ```text
//! cargo run --release -p estampe --example depth_formats -- depth-formats.png
//! ```
//!
//! The upper plane is blue; at each red pixel the depth buffer could not resolve the two. From left
//! to right: `Depth16Unorm`, `Depth24Plus`, `Depth32Float` with reversed z and an infinite far
//! plane, and `Depth16Unorm` again with logarithmic depth, which the fragment shader writes.

#![expect(clippy::print_stdout, reason = "examples print their results")]

use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{CompareFunction, DepthState, PrimitiveTopology, VertexBufferLayout};
use estampe::{
    BufferError, BufferSlice, ColorAttachment, DepthStencilAttachment, Device, DeviceDescriptor,
    Draw, Mat4, RenderPass, RenderPipelineDescriptor, TextureDescriptor, TextureFormat, Vec3, Vec4,
    VertexFormat, bytes_of, maths,
};
use estampe_assets::image::{AlphaChannel, encode_png};
use estampe_renderer::transforms::projection::{DepthConvention, perspective};
use estampe_renderer::transforms::{to_f32, view::CameraFrame};
use estampe_scene::Image;
use glam::DVec3;
use std::error::Error;

const NEAR: f32 = 0.01;
const FAR: f32 = 10_000.0;
/// Size of one panel, in pixels.
const SIZE: [u32; 2] = [240, 320];

/// A plane of one colour with stripes by distance. Its depth is the projection's.
struct Plane {
    clip_from_world: Mat4,
    color: [f32; 3],
}

/// A [`Plane`] whose depth is log₂(1 + w) / log₂(1 + far).
struct LogarithmicPlane(Plane);

estampe::shader! {
    impl Shader for Plane {
        type Attributes<R: Real> = Vec3<R>;
        type Varyings<R: Real> = [R; 1];

        fn vertex<R: Real>(&self, _input: VertexIn<'_, R>, at: Vec3<R>) -> VertexOut<R, [R; 1]> {
            let clip = self.clip_from_world.transform_point(at);
            VertexOut::new(clip, [clip.w])
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, [w]: [R; 1]) -> FragmentOut<R> {
            // A stripe for each doubling of the distance.
            let is_bright = (maths::log2(w) * 0.5).fract().lt(w.splat(0.5));
            let light = R::select(is_bright, w.splat(1.0), w.splat(0.75));
            let [r, g, b] = self.color;
            FragmentOut::color(Vec4::new(light * r, light * g, light * b, input.real(1.0)))
        }
    }
}

estampe::shader! {
    impl Shader for LogarithmicPlane {
        type Attributes<R: Real> = Vec3<R>;
        type Varyings<R: Real> = [R; 1];

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec3<R>) -> VertexOut<R, [R; 1]> {
            self.0.vertex(input, at)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, [w]: [R; 1]) -> FragmentOut<R> {
            let depth = maths::log2(w + 1.0) / maths::log2(input.real(1.0 + FAR));
            self.0.fragment(input, [w]).with_depth(depth)
        }
    }
}

/// A depth format with its projection and shader.
#[derive(Debug, Clone, Copy)]
struct Method {
    format: TextureFormat,
    is_reversed: bool,
    is_logarithmic: bool,
}

const METHODS: [Method; 4] = [
    Method::new(TextureFormat::Depth16Unorm),
    Method::new(TextureFormat::Depth24Plus),
    Method {
        is_reversed: true,
        ..Method::new(TextureFormat::Depth32Float)
    },
    Method {
        is_logarithmic: true,
        ..Method::new(TextureFormat::Depth16Unorm)
    },
];

impl Method {
    const fn new(format: TextureFormat) -> Self {
        Self {
            format,
            is_reversed: false,
            is_logarithmic: false,
        }
    }
}

/// A panel's pixels: RGBA, rows from the top.
fn panel(device: &Device, method: Method) -> Result<Vec<u8>, Box<dyn Error>> {
    let [width, height] = SIZE;
    let aspect = f64::from(width) / f64::from(height);
    let (far, convention) = if method.is_reversed {
        (f64::INFINITY, DepthConvention::Reversed)
    } else {
        (f64::from(FAR), DepthConvention::ZeroToOne)
    };
    let projection = perspective(1.0, aspect, f64::from(NEAR), far, convention);
    let (eye, centre) = (DVec3::new(0.0, 1.7, 0.0), DVec3::new(0.0, 1.2, -1.0));
    let view = CameraFrame::look_at(eye, centre, DVec3::Y).view_from_world();
    let clip_from_world: Mat4 = to_f32(&(projection * view)).into();
    let plane = |height: f32| -> Result<[BufferSlice; 1], BufferError> {
        let far = -0.9 * FAR;
        let ends = [(-FAR, -0.5), (FAR, -0.5), (-FAR, far), (FAR, far)];
        let corners: Vec<f32> = ends.iter().flat_map(|&(x, z)| [x, height, z]).collect();
        let buffer = device.create_buffer_with_contents(bytes_of(&corners))?;
        Ok([BufferSlice::from(&buffer)])
    };
    let pipeline = |color: [f32; 3]| {
        let plane = Plane {
            clip_from_world,
            color,
        };
        let mut descriptor = if method.is_logarithmic {
            RenderPipelineDescriptor::new(LogarithmicPlane(plane))
        } else {
            RenderPipelineDescriptor::new(plane)
        };
        descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x3])];
        descriptor.primitive.topology = PrimitiveTopology::TriangleStrip;
        descriptor.depth_stencil = Some(
            DepthState {
                write_enabled: true,
                compare: if method.is_reversed {
                    CompareFunction::Greater
                } else {
                    CompareFunction::Less
                },
            }
            .into(),
        );
        device.create_render_pipeline(&descriptor)
    };
    // The lower plane is drawn first, so that it stays visible where both depths are stored alike.
    let (lower, upper) = (pipeline([0.9, 0.15, 0.1])?, pipeline([0.2, 0.45, 0.9])?);
    let (lower_corners, upper_corners) = (plane(0.0)?, plane(0.01)?);
    let draws = [(&lower, &lower_corners), (&upper, &upper_corners)];
    let draws = draws.map(|(pipeline, corners)| Draw {
        vertex_buffers: corners,
        ..Draw::new(pipeline, 0..4)
    });
    let image = |format| {
        let descriptor = TextureDescriptor::new_2d(width, height, format);
        device.create_texture(&descriptor)
    };
    let (color, depth) = (image(TextureFormat::Rgba8Unorm)?, image(method.format)?);
    let background = [0.9, 0.93, 1.0, 1.0];
    let farthest = if method.is_reversed { 0.0 } else { 1.0 };
    device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&color.view(), background))],
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth.view(), farthest)),
        draws: &draws,
        ..RenderPass::default()
    })?;
    Ok(device.read_texture(&color)?)
}

/// Number of pixels that show the lower plane.
fn pixels_of_the_lower(pixels: &[u8]) -> usize {
    let is_lower = |[r, _, b, _]: &&[u8; 4]| r > b;
    pixels.as_chunks().0.iter().filter(is_lower).count()
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1);
    let path = path.unwrap_or_else(|| "depth-formats.png".to_owned());
    let device = Device::new(&DeviceDescriptor::default())?;
    let [width, height] = SIZE;
    let gap = 4;
    let whole = width * 4 + gap * 3;
    let mut image = Image {
        width: whole,
        height,
        rgba: vec![255; whole as usize * height as usize * 4],
    };
    for (number, method) in METHODS.into_iter().enumerate() {
        let pixels = panel(&device, method)?;
        let wrong = pixels_of_the_lower(&pixels);
        println!("{method:?}: {wrong} pixels show the lower plane");
        let left = number * (width + gap) as usize * 4;
        let rows = image.rgba.chunks_exact_mut(whole as usize * 4);
        for (row, pixels) in rows.zip(pixels.chunks_exact(width as usize * 4)) {
            row[left..left + pixels.len()].copy_from_slice(pixels);
        }
    }
    std::fs::write(&path, encode_png(&image, AlphaChannel::Never)?)?;
    println!("wrote {path}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows: D1, F1.
    #[test]
    fn reversed_and_logarithmic_depth_are_finer_than_fixed_point() {
        let device = Device::new(&DeviceDescriptor::default()).expect("the system starts threads");
        let wrong = METHODS.map(|method| {
            let pixels = panel(&device, method).expect("it is small");
            pixels_of_the_lower(&pixels)
        });
        let [depth16, depth24, reversed, logarithmic] = wrong;
        assert!(
            depth16 > 10_000 && depth24 > 0 && depth24 < 200,
            "{wrong:?}"
        );
        assert_eq!([reversed, logarithmic], [0, 0]);
    }
}
