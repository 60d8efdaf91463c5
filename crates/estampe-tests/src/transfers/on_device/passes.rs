//! Passes through the public interface.

use super::Objects;
use crate::fast_path;
use crate::geometry::{Vertex, vertex_buffer, vertex_layout, whole_target};
use crate::shaders::{BoundDepth, BoundTexture, StoresPlaces};
use crate::transfers::on_model::case_of;
use crate::transfers::sequence::{
    ColorUse, ComparedDraw, DepthUse, Draws, ImageAt, Pass, TexturedDraw,
};
use estampe::state::ColorTargetState;
use estampe::{
    AspectOperations, BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType,
    ColorAttachment, DepthStencilAttachment, DepthStencilResolve, Draw, LoadOp, PassExtent,
    RenderPass, RenderPipelineDescriptor, SampleType, StoreOp, TextureViewDescriptor,
};
use estampe_types::{TextureAspect, TextureDimension, ViewDimension};

impl Objects<'_> {
    /// Draws a pass.
    pub(super) fn render(&self, pass: &Pass) {
        let colors = pass.colors.iter().map(|color| Some(self.color(color)));
        let colors: Vec<_> = colors.collect();
        let depth_stencil = pass.depth_stencil.as_ref().map(|depth| self.depth(depth));
        let attachments = RenderPass {
            color_attachments: &colors,
            depth_stencil_attachment: depth_stencil,
            ..RenderPass::default()
        };
        match &pass.draws {
            Draws::Cases(draws) => {
                let depth = pass.depth_stencil.as_ref();
                let format = depth.map(|depth| self.textures[depth.image.texture].format());
                let case = case_of(pass, format);
                fast_path::draw_pass(self.device, &case, (draws, 0), attachments);
            }
            Draws::Textured(draw) => self.draw_textured(draw, attachments),
            Draws::Compared(draw) => self.draw_compared(draw, attachments),
        }
    }

    fn color(&self, color: &ColorUse) -> ColorAttachment {
        let is_3d = self.textures[color.image.texture].dimension() == TextureDimension::D3;
        let view = |image| self.view(image, color.format, TextureAspect::All);
        ColorAttachment {
            view: view(color.image),
            depth_slice: is_3d.then_some(color.image.slice),
            resolve_target: color.resolve.map(view),
            load: load(color.clear),
            store: store(color.is_stored),
        }
    }

    fn depth(&self, depth: &DepthUse) -> DepthStencilAttachment {
        let format = self.textures[depth.image.texture].format();
        let view = |image| self.view(image, format, TextureAspect::All);
        DepthStencilAttachment {
            view: view(depth.image),
            depth: depth.depth.map_or(AspectOperations::ReadOnly, |depth| {
                AspectOperations::Write {
                    load: load(depth.clear),
                    store: store(depth.is_stored),
                }
            }),
            stencil: depth.stencil.map_or(AspectOperations::ReadOnly, |stencil| {
                AspectOperations::Write {
                    load: load(stencil.clear),
                    store: store(stencil.is_stored),
                }
            }),
            resolve: depth
                .resolve
                .map(|(image, [depth, stencil])| DepthStencilResolve {
                    target: view(image),
                    depth,
                    stencil,
                }),
        }
    }

    fn draw_textured(&self, draw: &TexturedDraw, attachments: RenderPass<'_>) {
        let texture = &self.textures[draw.texture];
        let view = texture.create_view(&TextureViewDescriptor {
            format: Some(draw.format),
            base_mip_level: draw.levels[0],
            mip_level_count: Some(draw.levels[1]),
            ..TextureViewDescriptor::image(0, draw.layer)
        });
        let sampler = self.device.create_sampler(&draw.sampler);
        let texture =
            BindingResource::SampledTexture(view.expect("a 2D view"), sampler.expect("a sampler"));
        let ty = BindingType::SampledTexture {
            sample_type: draw.format.sample_type(),
            view_dimension: ViewDimension::D2,
        };
        let descriptor = RenderPipelineDescriptor::new(BoundTexture);
        self.draw_bound(descriptor, (ty, texture), &draw.vertices, attachments);
    }

    fn draw_compared(&self, draw: &ComparedDraw, attachments: RenderPass<'_>) {
        let format = self.textures[draw.image.texture].format();
        let view = self.view(draw.image, format, TextureAspect::All);
        let map = (BindingType::ShadowMap, BindingResource::Texture(view));
        let descriptor = RenderPipelineDescriptor::new(BoundDepth(draw.reference));
        self.draw_bound(descriptor, map, &draw.vertices, attachments);
    }

    /// Stores to each texel of an image.
    pub(super) fn store(&self, at: ImageAt) {
        let texture = &self.textures[at.texture];
        let format = texture.format();
        let view = texture.create_view(&TextureViewDescriptor {
            base_mip_level: at.level,
            mip_level_count: Some(1),
            ..TextureViewDescriptor::default()
        });
        let view = view.expect("one level");
        let ty = BindingType::StorageTexture {
            format,
            view_dimension: view.dimension(),
        };
        let shader = StoresPlaces {
            slice: at.slice.cast_signed(),
            is_integer: format.sample_type() != SampleType::Float,
        };
        let size = texture.level_size(at.level);
        let attachments = RenderPass {
            extent: Some(PassExtent {
                width: size.width,
                height: size.height,
                samples: 1,
            }),
            ..RenderPass::default()
        };
        let vertices = whole_target([size.width, size.height], |_| [0.0; 4]);
        let descriptor = RenderPipelineDescriptor::new(shader);
        let texture = (ty, BindingResource::Texture(view));
        self.draw_bound(descriptor, texture, &vertices, attachments);
    }

    /// Draws a triangle list with one binding.
    fn draw_bound(
        &self,
        mut descriptor: RenderPipelineDescriptor,
        (ty, resource): (BindingType, BindingResource),
        vertices: &[Vertex],
        attachments: RenderPass<'_>,
    ) {
        let device = self.device;
        let layout = device.create_bind_group_layout(&[BindGroupLayoutEntry { binding: 0, ty }]);
        let layout = layout.expect("one binding");
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[(0, resource)],
        });
        let group = group.expect("a texture that fits the layout");
        let colors = attachments.color_attachments.iter().flatten();
        let targets = colors.clone();
        let targets = targets.map(|color| Some(ColorTargetState::from(color.view.format())));
        let samples = colors.map(|color| color.view.texture().sample_count());
        descriptor.targets = targets.collect();
        descriptor.multisample.count = samples.max().unwrap_or(1);
        descriptor.vertex_buffers = vec![vertex_layout()];
        descriptor.bind_group_layouts = vec![layout];
        descriptor.depth_stencil = None;
        let pipeline = device.create_render_pipeline(&descriptor);
        let pipeline = pipeline.expect("a valid pipeline");
        let words = vertex_buffer(vertices).words().to_vec();
        let buffer = device.create_buffer_of_words(words).expect("few vertices");
        let count = u32::try_from(vertices.len()).expect("few vertices");
        let pass = RenderPass {
            draws: &[Draw {
                vertex_buffers: &[buffer.slice(..)],
                bind_groups: std::slice::from_ref(&group),
                ..Draw::new(&pipeline, 0..count)
            }],
            ..attachments
        };
        device.render(&pass).expect("a pass that fits");
    }
}

fn load<T>(clear: Option<T>) -> LoadOp<T> {
    clear.map_or(LoadOp::Load, LoadOp::Clear)
}

fn store(is_stored: bool) -> StoreOp {
    if is_stored {
        StoreOp::Store
    } else {
        StoreOp::Discard
    }
}
