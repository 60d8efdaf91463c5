//! The objects of a frame on a device: buffers, textures, images, pipelines with their bind groups.

use super::description::{Binding, ComputeStep, Frame, FramePipeline, Pass};
use crate::BenchError;
use crate::generate::MipChain;
use crate::scene::Scene;
use estampe::state::{ColorTargetState, MultisampleState};
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry, BindingResource,
    BindingType, BufferBindingType, BufferSlice, ComputePipeline, ComputePipelineDescriptor,
    Device, EntryPointDescriptor, Extent3d, ProgramDescriptor, RenderPipeline,
    RenderPipelineDescriptor, SampleType, ShaderModule, ShaderModuleDescriptor, ShaderSource,
    Texture, TextureDescriptor, TextureFormat, TextureView, TextureViewDescriptor, ViewDimension,
};

/// What bindings refer to, and the module.
pub(super) struct Objects<'a> {
    device: &'a Device,
    module: ShaderModule,
    textures: Vec<TextureView>,
    /// The scene's buffers.
    pub buffers: Vec<BufferSlice>,
    /// The frame's images.
    pub images: Vec<Texture>,
}

impl<'a> Objects<'a> {
    pub(super) fn new(
        device: &'a Device,
        scene: &Scene,
        frame: &Frame,
    ) -> Result<Self, BenchError> {
        let source = ShaderModuleDescriptor {
            strict_math: scene.strict_math,
            ..ShaderModuleDescriptor::new(ShaderSource::Wgsl(frame.text))
        };
        let buffers = scene.buffers.iter().map(|bytes| {
            let buffer = device.create_buffer_with_contents(bytes)?;
            Ok(BufferSlice::from(&buffer))
        });
        let textures = scene.textures.iter().zip(&frame.textures);
        let textures = textures
            .map(|(chain, &(format, dimension))| create_texture(device, chain, format, dimension));
        let images = frame.images.iter().map(|image| {
            let [width, height] = image.size;
            let descriptor = TextureDescriptor {
                sample_count: image.samples,
                ..TextureDescriptor::new_2d(width, height, image.format)
            };
            Ok(device.create_texture(&descriptor)?)
        });
        Ok(Self {
            device,
            module: device.create_shader_module(&source)?,
            textures: textures.collect::<Result<_, BenchError>>()?,
            buffers: buffers.collect::<Result<_, BenchError>>()?,
            images: images.collect::<Result<_, BenchError>>()?,
        })
    }

    /// A pipeline for a pass, and its bind groups.
    pub(super) fn render_pipeline(
        &self,
        pipeline: &FramePipeline,
        pass: &Pass,
    ) -> Result<(RenderPipeline, Vec<BindGroup>), BenchError> {
        let program = self.device.create_program(&ProgramDescriptor {
            vertex: self.entry_point(pipeline.vertex),
            fragment: Some(self.entry_point(pipeline.fragment)),
        })?;
        let (layouts, groups) = self.bind_groups(&pipeline.bindings)?;
        let targets = pass.colors.iter().map(|color| {
            Some(ColorTargetState {
                blend: pipeline.blend,
                write_mask: pipeline.write_mask,
                ..ColorTargetState::from(self.images[color.image].format())
            })
        });
        let mut images = pass
            .colors
            .iter()
            .map(|color| color.image)
            .chain(pass.depth);
        let samples = images
            .next()
            .map_or(1, |image| self.images[image].sample_count());
        let descriptor = RenderPipelineDescriptor {
            bind_group_layouts: layouts,
            vertex_buffers: pipeline.vertex_buffers.clone(),
            primitive: pipeline.primitive,
            depth_stencil: pass.depth.map(|_| pipeline.depth_stencil),
            multisample: MultisampleState {
                alpha_to_coverage_enabled: pipeline.alpha_to_coverage,
                ..MultisampleState::new(samples)
            },
            targets: targets.collect(),
            ..RenderPipelineDescriptor::with_program(program)
        };
        Ok((self.device.create_render_pipeline(&descriptor)?, groups))
    }

    /// The pipeline of a dispatch, and its bind groups.
    pub(super) fn compute_pipeline(
        &self,
        step: &ComputeStep,
    ) -> Result<(ComputePipeline, Vec<BindGroup>), BenchError> {
        let entry_point = self.entry_point(step.entry_point);
        let program = self.device.create_compute_program(&entry_point)?;
        let (layouts, groups) = self.bind_groups(&step.bindings)?;
        let descriptor = ComputePipelineDescriptor {
            bind_group_layouts: layouts,
            ..ComputePipelineDescriptor::new(program)
        };
        Ok((self.device.create_compute_pipeline(&descriptor)?, groups))
    }

    fn entry_point(&self, name: &'static str) -> EntryPointDescriptor<'_> {
        EntryPointDescriptor {
            name: Some(name),
            ..EntryPointDescriptor::new(&self.module)
        }
    }

    /// Group 0 and its layout; nothing if nothing is bound.
    fn bind_groups(
        &self,
        bindings: &[Binding],
    ) -> Result<(Vec<BindGroupLayout>, Vec<BindGroup>), BenchError> {
        if bindings.is_empty() {
            return Ok((Vec::new(), Vec::new()));
        }
        let (mut layout, mut entries) = (Vec::new(), Vec::new());
        for (binding, bound) in (0..).zip(bindings) {
            let (ty, resource) = self.resource(bound)?;
            layout.push(BindGroupLayoutEntry { binding, ty });
            entries.push((binding, resource));
        }
        let layout = self.device.create_bind_group_layout(&layout)?;
        let group = self.device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &entries,
        })?;
        Ok((vec![layout], vec![group]))
    }

    fn resource(&self, binding: &Binding) -> Result<(BindingType, BindingResource), BenchError> {
        let buffer = |number: usize, ty| {
            let ty = BindingType::Buffer {
                ty,
                has_dynamic_offset: false,
                min_binding_size: 0,
            };
            (ty, BindingResource::Buffer(self.buffers[number].clone()))
        };
        let texture = |view: TextureView, sample_type| {
            let ty = BindingType::Texture {
                sample_type,
                view_dimension: view.dimension(),
                multisampled: false,
            };
            (ty, BindingResource::Texture(view))
        };
        Ok(match *binding {
            Binding::Uniform(number) => buffer(number, BufferBindingType::Uniform),
            Binding::UniformAtOffset(number, size) => {
                let ty = BindingType::Buffer {
                    ty: BufferBindingType::Uniform,
                    has_dynamic_offset: true,
                    min_binding_size: 0,
                };
                let slice = self.buffers[number].buffer.slice(0..size);
                (ty, BindingResource::Buffer(slice))
            }
            Binding::StorageRead(number) => {
                buffer(number, BufferBindingType::Storage { read_only: true })
            }
            Binding::Storage(number) => {
                buffer(number, BufferBindingType::Storage { read_only: false })
            }
            Binding::Texture(number) => texture(self.textures[number].clone(), SampleType::Float),
            Binding::Image(number) => {
                let view = self.images[number].view();
                let sample_type = view.format().sample_type();
                texture(view, sample_type)
            }
            Binding::StorageImage(number) => {
                let view = self.images[number].view();
                let ty = BindingType::StorageTexture {
                    format: view.format(),
                    view_dimension: view.dimension(),
                };
                (ty, BindingResource::Texture(view))
            }
            Binding::Sampler(descriptor) => {
                let comparison = descriptor.compare.is_some();
                let sampler = self.device.create_sampler(&descriptor)?;
                let ty = BindingType::Sampler { comparison };
                (ty, BindingResource::Sampler(sampler))
            }
        })
    }
}

/// A texture with all its levels; the number of layers follows from the bytes of the first.
fn create_texture(
    device: &Device,
    chain: &MipChain,
    format: TextureFormat,
    dimension: ViewDimension,
) -> Result<TextureView, BenchError> {
    let levels: Vec<&[u8]> = chain.levels.iter().map(Vec::as_slice).collect();
    let layer_bytes = chain.size * chain.size * format.block_bytes();
    let bytes = u32::try_from(levels[0].len()).expect("the generators make less than 4 GiB");
    let texture = device.create_texture_with_data(
        &TextureDescriptor {
            size: Extent3d {
                width: chain.size,
                height: chain.size,
                depth_or_array_layers: bytes / layer_bytes,
            },
            mip_level_count: u32::try_from(levels.len()).expect("levels halve 32-bit sizes"),
            ..TextureDescriptor::new_2d(chain.size, chain.size, format)
        },
        &levels,
    )?;
    Ok(texture.create_view(&TextureViewDescriptor {
        dimension: Some(dimension),
        ..TextureViewDescriptor::default()
    })?)
}
