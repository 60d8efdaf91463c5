//! The passes: opaque polygons, then blending, peeling or weighing.

use super::shader::{FORMATS, Output, Tinted, vertices};
use crate::DrawError;
use crate::picture::View;
use crate::polygon::{Corner, Polygon};
use estampe::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, CompareFunction,
    DepthState, VertexBufferLayout,
};
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry, BindingResource,
    BindingType, BufferSlice, ColorAttachment, DepthStencilAttachment, Device, Draw,
    OcclusionQueries, RenderPass, RenderPipeline, RenderPipelineDescriptor, SampleType, Texture,
    TextureDescriptor, TextureFormat, ViewDimension, bytes_of,
};
use estampe_scene::Image;

/// Colours are blended without rounding to 8 bits.
const COLOR: TextureFormat = TextureFormat::Rgba32Float;
const REVEALAGE: TextureFormat = TextureFormat::R32Float;
const DEPTH: TextureFormat = TextureFormat::Depth32Float;

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
        let pipeline = passes.pipeline(Output::Color, vec![Some(COLOR.into())], depth, None)?;
        let [r, g, b] = view.background.map(f64::from);
        let cleared = ColorAttachment::clear(&passes.color.view(), [r, g, b, 1.0]);
        let depths = DepthStencilAttachment::clear(&passes.depth.view(), 0.0);
        passes.run(
            &[Some(cleared)],
            depths,
            vertices.draw(&pipeline, &[]),
            None,
        )?;
        Ok(passes)
    }

    /// Blends polygons in their order.
    pub(super) fn blend<'p>(
        &self,
        polygons: impl Iterator<Item = &'p [Corner<4>]>,
    ) -> Result<(), DrawError> {
        let vertices = self.vertices(polygons)?;
        let nearer = DepthState {
            write_enabled: false,
            compare: CompareFunction::Greater,
        };
        let pipeline = self.pipeline(Output::Color, vec![Some(over())], nearer, None)?;
        let color = ColorAttachment::load(&self.color.view());
        let depths = DepthStencilAttachment::read_only(&self.depth.view());
        self.run(&[Some(color)], depths, vertices.draw(&pipeline, &[]), None)
    }

    /// Blends the fragments of each pixel from the farthest on, layer by layer. Each layer has a
    /// fragment in some pixel, and a pixel one fragment of each polygon: there are no more layers
    /// than polygons. Returns their number.
    pub(super) fn peel<'p>(
        &self,
        polygons: impl Iterator<Item = &'p [Corner<4>]>,
    ) -> Result<usize, DrawError> {
        let vertices = self.vertices(polygons)?;
        let layout = self
            .device
            .create_bind_group_layout(&[BindGroupLayoutEntry {
                binding: 0,
                ty: BindingType::Texture {
                    sample_type: SampleType::Depth,
                    view_dimension: ViewDimension::D2,
                    multisampled: false,
                },
            }])?;
        let farthest = DepthState {
            write_enabled: true,
            compare: CompareFunction::LessEqual,
        };
        let layer = DepthState {
            write_enabled: false,
            compare: CompareFunction::Equal,
        };
        let finding = self.pipeline(Output::NearerDepth, Vec::new(), farthest, Some(&layout))?;
        let blending = self.pipeline(
            Output::NearerColor,
            vec![Some(over())],
            layer,
            Some(&layout),
        )?;
        let [width, height] = self.view.size;
        let texture = TextureDescriptor::new_2d(width, height, DEPTH);
        let mut next = self.device.create_texture(&texture)?;
        let mut spare = Some(self.device.create_texture(&texture)?);
        let mut peeled = self.depth.clone();
        let mut layers = 0;
        loop {
            let behind = [self.bind(&layout, &peeled)?];
            let mut found = OcclusionQueries::new(1);
            // Pixels without a fragment have the depth 1: none is nearer in the next layer.
            let depths = DepthStencilAttachment::clear(&next.view(), 1.0);
            self.run(&[], depths, vertices.draw(&finding, &behind), Some(&found))?;
            if found.samples_passed(0) == 0 {
                return Ok(layers);
            }
            found.reset();
            let color = ColorAttachment::load(&self.color.view());
            let depths = DepthStencilAttachment::read_only(&next.view());
            self.run(
                &[Some(color)],
                depths,
                vertices.draw(&blending, &behind),
                None,
            )?;
            layers += 1;
            // The opaque depths are kept; from then on two textures take turns.
            let free = spare.take().unwrap_or(peeled);
            peeled = std::mem::replace(&mut next, free);
        }
    }

    /// Sums the weighted fragments, and composes the picture of the sums.
    pub(super) fn weigh<'p>(
        &self,
        polygons: impl Iterator<Item = &'p [Corner<4>]>,
    ) -> Result<Image, DrawError> {
        let vertices = self.vertices(polygons)?;
        let [width, height] = self.view.size;
        let texture = |format| {
            let descriptor = TextureDescriptor::new_2d(width, height, format);
            self.device.create_texture(&descriptor)
        };
        let (sums, revealage) = (texture(COLOR)?, texture(REVEALAGE)?);
        let nearer = DepthState {
            write_enabled: false,
            compare: CompareFunction::Greater,
        };
        let product = BlendComponent {
            operation: BlendOperation::Add,
            src_factor: BlendFactor::Zero,
            dst_factor: BlendFactor::OneMinusSrc,
        };
        let targets = vec![
            Some(blended(COLOR, BlendState::ADDITIVE)),
            Some(blended(
                REVEALAGE,
                BlendState {
                    color: product,
                    alpha: product,
                },
            )),
        ];
        let pipeline = self.pipeline(Output::Weighted, targets, nearer, None)?;
        let attachments = [
            Some(ColorAttachment::clear(&sums.view(), [0.0; 4])),
            Some(ColorAttachment::clear(&revealage.view(), [1.0; 4])),
        ];
        let depths = DepthStencilAttachment::read_only(&self.depth.view());
        self.run(&attachments, depths, vertices.draw(&pipeline, &[]), None)?;

        let [sums, revealage, opaque] = [
            self.floats(&sums)?,
            self.floats(&revealage)?,
            self.floats(&self.color)?,
        ];
        let pixels = sums
            .as_chunks::<4>()
            .0
            .iter()
            .zip(opaque.as_chunks::<4>().0);
        let pixels = pixels.zip(revealage).flat_map(|((sum, behind), revealed)| {
            // The weights of one far fragment may be tiny.
            let scale = (1.0 - revealed) / sum[3].max(1e-12);
            [0, 1, 2].map(|k: usize| sum[k] * scale + behind[k] * revealed)
        });
        Ok(self.encoded(pixels))
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
        depth: DepthState,
        layout: Option<&BindGroupLayout>,
    ) -> Result<RenderPipeline, DrawError> {
        let shader = Tinted {
            clip_from_world: self.view.clip_from_world,
            output,
        };
        Ok(self
            .device
            .create_render_pipeline(&RenderPipelineDescriptor {
                bind_group_layouts: layout.cloned().into_iter().collect(),
                vertex_buffers: vec![VertexBufferLayout::packed(&FORMATS)],
                targets,
                depth_stencil: Some(depth.into()),
                ..RenderPipelineDescriptor::new(shader)
            })?)
    }

    fn bind(&self, layout: &BindGroupLayout, depths: &Texture) -> Result<BindGroup, DrawError> {
        Ok(self.device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout,
            entries: &[(0, BindingResource::Texture(depths.view()))],
        })?)
    }

    fn run(
        &self,
        colors: &[Option<ColorAttachment>],
        depths: DepthStencilAttachment,
        draw: Draw<'_>,
        queries: Option<&OcclusionQueries>,
    ) -> Result<(), DrawError> {
        let draw = Draw {
            occlusion_query: queries.map(|_| 0),
            ..draw
        };
        self.device.render(&RenderPass {
            color_attachments: colors,
            depth_stencil_attachment: Some(depths),
            occlusion_queries: queries,
            draws: &[draw],
            ..RenderPass::default()
        })?;
        Ok(())
    }
}

impl Vertices {
    fn draw<'a>(&'a self, pipeline: &'a RenderPipeline, groups: &'a [BindGroup]) -> Draw<'a> {
        Draw {
            vertex_buffers: &self.buffers,
            bind_groups: groups,
            ..Draw::new(pipeline, 0..self.count)
        }
    }
}

fn blended(format: TextureFormat, blend: BlendState) -> ColorTargetState {
    ColorTargetState {
        blend: Some(blend),
        ..format.into()
    }
}

/// Source over destination.
fn over() -> ColorTargetState {
    blended(COLOR, BlendState::ALPHA_BLENDING)
}
