//! Drawings as images, drawn by the pipeline's smooth lines.

use super::{Drawing, Stroke};
use crate::DrawError;
use estampe::state::{
    BlendState, ColorTargetState, LineRasterization, LineState, PrimitiveTopology,
    VertexBufferLayout,
};
use estampe::{
    ColorAttachment, Device, Draw, FragmentIn, FragmentOut, RenderPass, RenderPipelineDescriptor,
    Texture, TextureDescriptor, TextureFormat, Vec2, Vec3, Vec4, VertexFormat, VertexIn, VertexOut,
    bytes_of,
};
use estampe_scene::Image;

/// Lines in pixels, each vertex with its colour.
struct Ink {
    size: [f32; 2],
}

estampe::attributes! {
    struct Point<R> { at: Vec2<R>, color: Vec3<R> }
}

estampe::varyings! {
    struct Color<R> { color: Vec3<R> }
}

estampe::shader! {
    impl Shader for Ink {
        type Attributes<R: Real> = Point<R>;
        type Varyings<R: Real> = Color<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Point<R>) -> VertexOut<R, Color<R>> {
            let x = a.at.x * (2.0 / self.size[0]) - 1.0;
            let y = 1.0 - a.at.y * (2.0 / self.size[1]);
            let position = Vec4::new(x, y, input.real(0.0), input.real(1.0));
            VertexOut::new(position, Color { color: a.color })
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, v: Color<R>) -> FragmentOut<R> {
            FragmentOut::color(v.color.point())
        }
    }
}

impl Drawing {
    /// The drawing as an image: smooth lines of the pipeline, text of strokes.
    ///
    /// # Errors
    /// If the size or a stroke does not fit the device.
    pub fn to_image(&self, device: &Device) -> Result<Image, DrawError> {
        let [width, height] = self.size;
        let format = TextureFormat::Rgba8Unorm;
        let color = device.create_texture(&TextureDescriptor::new_2d(width, height, format))?;
        let white = ColorAttachment::clear(&color.view(), [1.0; 4]);
        self.draw(device, &color, white)
    }

    /// An image of this size with the drawing above it.
    ///
    /// # Errors
    /// As of [`Drawing::to_image`], or if the image has another size.
    pub fn over(&self, device: &Device, below: &Image) -> Result<Image, DrawError> {
        let [width, height] = self.size;
        let format = TextureFormat::Rgba8Unorm;
        let descriptor = TextureDescriptor::new_2d(width, height, format);
        let color = device.create_texture_with_data(&descriptor, &[&below.rgba])?;
        let kept = ColorAttachment::load(&color.view());
        self.draw(device, &color, kept)
    }

    fn draw(
        &self,
        device: &Device,
        color: &Texture,
        attachment: ColorAttachment,
    ) -> Result<Image, DrawError> {
        let texts = self.texts.iter().flat_map(super::Text::strokes);
        let strokes: Vec<Stroke> = self.strokes.iter().cloned().chain(texts).collect();
        let format = TextureFormat::Rgba8Unorm;
        // A draw has one width; neighbours in the order share it.
        let mut runs = Vec::new();
        for run in strokes.chunk_by(|a, b| a.width == b.width) {
            let numbers: Vec<f32> = run.iter().flat_map(segments).collect();
            if numbers.is_empty() {
                continue;
            }
            let count = u32::try_from(numbers.len() / FLOATS).unwrap_or(u32::MAX);
            let buffer = device.create_buffer_with_contents(bytes_of(&numbers))?;
            let pipeline = device.create_render_pipeline(&self.pipeline(run[0].width, format))?;
            runs.push((pipeline, [(&buffer).into()], count));
        }
        let draws: Vec<Draw<'_>> = runs
            .iter()
            .map(|(pipeline, buffers, count)| Draw {
                vertex_buffers: buffers,
                ..Draw::new(pipeline, 0..*count)
            })
            .collect();
        device.render(&RenderPass {
            color_attachments: &[Some(attachment)],
            draws: &draws,
            ..RenderPass::default()
        })?;
        let [width, height] = self.size;
        Ok(Image {
            width,
            height,
            rgba: device.read_texture(color)?,
        })
    }

    fn pipeline(&self, width: f32, format: TextureFormat) -> RenderPipelineDescriptor {
        let ink = Ink {
            size: self.size.map(|side| side as f32),
        };
        let formats = [VertexFormat::Float32x2, VertexFormat::Float32x3];
        let mut descriptor = RenderPipelineDescriptor::new(ink);
        descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&formats)];
        descriptor.primitive.topology = PrimitiveTopology::LineList;
        descriptor.primitive.line = LineState {
            width,
            rasterization: LineRasterization::RectangularSmooth,
            stipple: None,
        };
        descriptor.depth_stencil = None;
        descriptor.targets = vec![Some(ColorTargetState {
            blend: Some(BlendState::ALPHA_BLENDING),
            ..format.into()
        })];
        descriptor
    }
}

/// Numbers of one vertex: position and colour.
const FLOATS: usize = 5;

/// The segments of a stroke as pairs of vertices.
fn segments(stroke: &Stroke) -> Vec<f32> {
    let color = stroke.color.map(|code| f32::from(code) / 255.0);
    let pairs = stroke.points.windows(2).flatten();
    let vertices = pairs.map(|[x, y]| [*x, *y, color[0], color[1], color[2]]);
    vertices.flatten().collect()
}
