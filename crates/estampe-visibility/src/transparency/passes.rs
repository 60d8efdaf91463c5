//! The passes: opaque polygons, then blending, peeling or weighing.

use super::shader::{FORMATS, Output, Tinted, vertices};
use crate::DrawError;
use crate::picture::View;
use crate::polygon::{Corner, Polygon};
use estampe::state::{
    BlendState, ColorTargetState, CompareFunction, DepthState, DepthStencilState, PrimitiveState,
    VertexBufferLayout,
};
use estampe::{
    BufferSlice, ColorAttachment, DepthStencilAttachment, Device, Draw, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, Texture, TextureDescriptor, TextureFormat, bytes_of,
};
use estampe_scene::Image;
use estampe_transparency::{
    DepthOrder, Finder, PeelDraws, Target, blend_weighted, layer_state, peel, weighted_targets,
};

/// Colours are blended without rounding to 8 bits.
const COLOR: TextureFormat = TextureFormat::Rgba32Float;
const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// Views have reversed depth.
const ORDER: DepthOrder = DepthOrder::NearIsOne;

/// The picture of the opaque polygons, before which others are blended.
pub(super) struct Passes<'d> {
    device: &'d Device,
    view: View,
    color: Texture,
    /// The depths of the opaque polygons.
    depth: Texture,
}

/// Vertices in memory of the device.
struct Vertices {
    buffers: [BufferSlice; 1],
    count: u32,
}

impl<'d> Passes<'d> {
    /// Draws the opaque polygons.
    pub(super) fn new(
        device: &'d Device,
        view: &View,
        opaque: &[Polygon<3>],
    ) -> Result<Self, DrawError> {
        let texture = |format| {
            let [width, height] = view.size;
            device.create_texture(&TextureDescriptor::new_2d(width, height, format))
        };
        let passes = Self {
            device,
            view: *view,
            color: texture(COLOR)?,
            depth: texture(DEPTH)?,
        };
        let vertices = passes.vertices(opaque.iter().map(Polygon::corners))?;
        let depth = DepthState {
            write_enabled: true,
            compare: CompareFunction::GreaterEqual,
        };
        let pipeline = passes.pipeline(Output::Color, vec![Some(COLOR.into())], depth.into())?;
        let [r, g, b] = view.background.map(f64::from);
        let cleared = ColorAttachment::clear(&passes.color.view(), [r, g, b, 1.0]);
        let depths = DepthStencilAttachment::clear(&passes.depth.view(), 0.0);
        passes.run(cleared, depths, vertices.draw(&pipeline))?;
        Ok(passes)
    }

    /// Blends polygons in their order.
    pub(super) fn blend<'p>(
        &self,
        polygons: impl Iterator<Item = &'p [Corner<4>]>,
    ) -> Result<(), DrawError> {
        let vertices = self.vertices(polygons)?;
        let pipeline = self.pipeline(Output::Color, vec![Some(over())], ORDER.nearer().into())?;
        let color = ColorAttachment::load(&self.color.view());
        let depths = DepthStencilAttachment::read_only(&self.depth.view());
        self.run(color, depths, vertices.draw(&pipeline))
    }

    /// Blends the fragments of each pixel from the farthest on, layer by layer. Each layer has a
    /// fragment in some pixel, and a pixel one fragment of each polygon: there are no more layers
    /// than polygons.
    pub(super) fn peel<'p>(
        &self,
        polygons: impl Iterator<Item = &'p [Corner<4>]>,
    ) -> Result<(), DrawError> {
        let vertices = self.vertices(polygons)?;
        let finder = Finder::new(self.device, ORDER, 1)?;
        let finding = finder.pipeline(
            self.device,
            self.view.clip_from_world,
            vec![VertexBufferLayout::packed(&FORMATS)],
            PrimitiveState::default(),
        )?;
        let blending = self.pipeline(Output::Color, vec![Some(over())], layer_state())?;
        let draws = PeelDraws {
            finding: &[vertices.draw(&finding)],
            blending: &[vertices.draw(&blending)],
            rest: &[],
        };
        peel(self.device, &self.target(), &finder, draws, u32::MAX)?;
        Ok(())
    }

    /// Blends weighted sums of the fragments.
    pub(super) fn weigh<'p>(
        &self,
        polygons: impl Iterator<Item = &'p [Corner<4>]>,
    ) -> Result<(), DrawError> {
        let vertices = self.vertices(polygons)?;
        let pipeline =
            self.pipeline(Output::Weighted, weighted_targets(), ORDER.nearer().into())?;
        blend_weighted(self.device, &self.target(), &[vertices.draw(&pipeline)])?;
        Ok(())
    }

    fn target(&self) -> Target<'_> {
        Target {
            color: &self.color,
            depth: &self.depth,
            order: ORDER,
        }
    }

    /// The picture as it is blended so far.
    pub(super) fn image(&self) -> Result<Image, DrawError> {
        let colors = self.floats(&self.color)?;
        let pixels = colors.as_chunks::<4>().0.iter();
        Ok(self.encoded(pixels.flat_map(|[r, g, b, _]| [*r, *g, *b])))
    }

    /// Red, green and blue of all pixels, 0 to 1, as an image.
    fn encoded(&self, numbers: impl Iterator<Item = f32>) -> Image {
        let [width, height] = self.view.size;
        #[expect(clippy::cast_possible_truncation, reason = "clamped to a byte")]
        #[expect(clippy::cast_sign_loss, reason = "clamped to a byte")]
        let codes: Vec<u8> = numbers
            .map(|number| (number.clamp(0.0, 1.0) * 255.0).round_ties_even() as u8)
            .collect();
        let pixels = codes.as_chunks::<3>().0.iter();
        Image {
            width,
            height,
            rgba: pixels.flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect(),
        }
    }

    fn floats(&self, texture: &Texture) -> Result<Vec<f32>, DrawError> {
        let bytes = self.device.read_texture(texture)?;
        let words = bytes.as_chunks::<4>().0.iter();
        Ok(words.map(|word| f32::from_le_bytes(*word)).collect())
    }

    fn vertices<'p, const N: usize>(
        &self,
        polygons: impl Iterator<Item = &'p [Corner<N>]>,
    ) -> Result<Vertices, DrawError> {
        let numbers = vertices(polygons);
        let buffer = self
            .device
            .create_buffer_with_contents(bytes_of(&numbers))?;
        Ok(Vertices {
            buffers: [(&buffer).into()],
            count: u32::try_from(numbers.len() / 7).unwrap_or(u32::MAX),
        })
    }

    fn pipeline(
        &self,
        output: Output,
        targets: Vec<Option<ColorTargetState>>,
        depth_stencil: DepthStencilState,
    ) -> Result<RenderPipeline, DrawError> {
        let shader = Tinted {
            clip_from_world: self.view.clip_from_world,
            output,
        };
        Ok(self
            .device
            .create_render_pipeline(&RenderPipelineDescriptor {
                vertex_buffers: vec![VertexBufferLayout::packed(&FORMATS)],
                targets,
                depth_stencil: Some(depth_stencil),
                ..RenderPipelineDescriptor::new(shader)
            })?)
    }

    fn run(
        &self,
        color: ColorAttachment,
        depths: DepthStencilAttachment,
        draw: Draw<'_>,
    ) -> Result<(), DrawError> {
        self.device.render(&RenderPass {
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(depths),
            draws: &[draw],
            ..RenderPass::default()
        })?;
        Ok(())
    }
}

impl Vertices {
    fn draw<'a>(&'a self, pipeline: &'a RenderPipeline) -> Draw<'a> {
        Draw {
            vertex_buffers: &self.buffers,
            ..Draw::new(pipeline, 0..self.count)
        }
    }
}

/// Source over destination.
fn over() -> ColorTargetState {
    ColorTargetState {
        blend: Some(BlendState::ALPHA_BLENDING),
        ..COLOR.into()
    }
}
