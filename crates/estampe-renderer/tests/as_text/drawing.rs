//! Pipelines, bind groups and pictures of materials.

use super::scene;
use super::{Material, Wgsl};
use estampe::state::{DepthState, PrimitiveState};
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType, Buffer,
    ClipSpace, ColorAttachment, DepthStencilAttachment, Device, Draw, EntryPointDescriptor,
    Program, ProgramDescriptor, RenderPass, RenderPipelineDescriptor, SampledTexture, Sampler,
    SamplerDescriptor, ShaderModule, ShaderModuleDescriptor, ShaderSource, Texture,
    TextureDescriptor, TextureFormat, TextureView, TextureViewDescriptor, ViewDimension, bytes_of,
};
use std::sync::Arc;

pub(super) const WIDTH: u32 = 144;
pub(super) const HEIGHT: u32 = 96;

/// The textures of materials in Rust.
pub(super) struct Textures {
    pub(super) base: SampledTexture,
    pub(super) heights: SampledTexture,
    pub(super) surroundings: SampledTexture,
    pub(super) albedos: SampledTexture,
}

/// A device with the scene and the textures.
pub(super) struct Stage<'a> {
    device: &'a Device,
    vertices: Buffer,
    count: u32,
    base: Texture,
    heights: Texture,
    surroundings: TextureView,
    albedos: Texture,
    behind: Texture,
    sampler: Sampler,
    textures: Textures,
}

impl<'a> Stage<'a> {
    pub(super) fn new(device: &'a Device) -> Self {
        let vertices = scene::vertices();
        let buffer = device.create_buffer_with_contents(bytes_of(&vertices));
        let mut random = fastrand::Rng::with_seed(3);
        let mut texture = |size: u32, format, smoothness: u8| {
            let texels: Vec<u8> = (0..size * size * 4)
                .map(|_| 255 - random.u8(0..=255) / smoothness)
                .collect();
            let descriptor = TextureDescriptor::new_2d(size, size, format);
            device
                .create_texture_with_data(&descriptor.with_all_levels(), &[&texels])
                .expect("a small texture")
        };
        let base = texture(16, TextureFormat::Rgba8UnormSrgb, 1);
        let heights = texture(8, TextureFormat::Rgba8Unorm, 2);
        let sampler = device
            .create_sampler(&SamplerDescriptor::trilinear_repeat())
            .expect("a common sampler");
        let mut numbers = |sides: &[u32], layers: u32| {
            let mut descriptor =
                TextureDescriptor::new_2d(sides[0], sides[0], TextureFormat::Rgba32Float);
            descriptor.size.depth_or_array_layers = layers;
            descriptor.mip_level_count = u32::try_from(sides.len()).expect("few levels");
            let levels = sides.iter().map(|side| {
                let count = side * side * layers * 4;
                let bytes = (0..count).flat_map(|_| (random.f32() * 0.45).to_le_bytes());
                bytes.collect::<Vec<u8>>()
            });
            let levels: Vec<Vec<u8>> = levels.collect();
            let levels: Vec<&[u8]> = levels.iter().map(Vec::as_slice).collect();
            device
                .create_texture_with_data(&descriptor, &levels)
                .expect("a small texture")
        };
        let albedos = numbers(&[32], 1);
        let surroundings = numbers(&[4, 2, 1], 6).create_view(&TextureViewDescriptor {
            dimension: Some(ViewDimension::Cube),
            ..TextureViewDescriptor::default()
        });
        let surroundings = surroundings.expect("six faces");
        let behind = numbers(&[8, 4, 2, 1], 1);
        let sampled = |view: &TextureView| device.sampled_texture(view, &sampler).expect("it fits");
        let textures = Textures {
            base: sampled(&base.view()),
            heights: sampled(&heights.view()),
            surroundings: sampled(&surroundings),
            albedos: sampled(&albedos.view()),
        };
        Self {
            device,
            vertices: buffer.expect("a small buffer"),
            count: scene::count(&vertices),
            base,
            heights,
            surroundings,
            albedos,
            behind,
            sampler,
            textures,
        }
    }

    /// The program in Rust.
    pub(super) fn rust(&self, material: &Material) -> Arc<dyn Program> {
        (material.in_rust)(&self.textures)
    }

    /// The bind groups of programs in Rust: what is behind surfaces is number 1.
    pub(super) fn rust_groups(&self) -> Vec<BindGroup> {
        let behind = BindingResource::SampledTexture(self.behind.view(), self.sampler.clone());
        let entry = BindGroupLayoutEntry {
            binding: 0,
            ty: BindingType::sampled_2d(),
        };
        let group = |types: &[BindGroupLayoutEntry], entries: &[(u32, BindingResource)]| {
            let layout = self.device.create_bind_group_layout(types).expect("one");
            let group = self.device.create_bind_group(&BindGroupDescriptor {
                label: None,
                layout: &layout,
                entries,
            });
            group.expect("as in the layout")
        };
        vec![group(&[], &[]), group(&[entry], &[(0, behind)])]
    }

    /// The bind group of a program as text.
    fn group(
        &self,
        material: &Material,
        module: &ShaderModule,
        program: &Arc<dyn Program>,
        block: &str,
    ) -> Vec<BindGroup> {
        let mut uniforms = module.uniforms(block).expect("the block");
        material.numbers.write(&mut uniforms, material.name);
        let buffer = self.device.create_buffer_with_contents(uniforms.bytes());
        let buffer = buffer.expect("a small buffer");
        let pipeline = RenderPipelineDescriptor::with_program(Arc::clone(program));
        let layout = &pipeline.bind_group_layouts[0];
        let name_of = |number: u32| {
            let mut bindings = module
                .reflections()
                .flat_map(|reflection| &reflection.bindings);
            let binding = bindings.find(|binding| binding.binding == number);
            binding.map_or("", |binding| binding.name.as_str())
        };
        let entries = layout.entries().iter().map(|entry| {
            let resource = match entry.ty {
                BindingType::Buffer { .. } => BindingResource::Buffer(buffer.slice(..)),
                BindingType::Sampler { .. } => BindingResource::Sampler(self.sampler.clone()),
                _ => BindingResource::Texture(match name_of(entry.binding) {
                    "heights" => self.heights.view(),
                    "albedos" => self.albedos.view(),
                    "behind" => self.behind.view(),
                    "surroundings" => self.surroundings.clone(),
                    _ => self.base.view(),
                }),
            };
            (entry.binding, resource)
        });
        let entries: Vec<_> = entries.collect();
        let group = self.device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        });
        vec![group.unwrap_or_else(|error| panic!("{}: {error}", material.name))]
    }
}

/// The program in WGSL and its bind groups.
pub(super) fn in_wgsl(
    stage: &Stage<'_>,
    material: &Material,
) -> (Arc<dyn Program>, Vec<BindGroup>) {
    let Wgsl {
        text,
        vertex,
        fragment,
        constants,
    } = &material.wgsl;
    let module = stage
        .device
        .create_shader_module(&ShaderModuleDescriptor::new(ShaderSource::Wgsl(text)));
    let module = module.unwrap_or_else(|errors| panic!("{}: {errors}", material.name));
    let entry = |name| EntryPointDescriptor {
        module: &module,
        name: Some(name),
        constants,
    };
    let program = stage.device.create_program(&ProgramDescriptor {
        vertex: entry(vertex),
        fragment: Some(entry(fragment)),
    });
    let program = program.unwrap_or_else(|error| panic!("{}: {error}", material.name));
    let groups = stage.group(material, &module, &program, "scene");
    (program, groups)
}

/// The program in GLSL and its bind groups.
pub(super) fn in_glsl(
    stage: &Stage<'_>,
    material: &Material,
) -> (Arc<dyn Program>, Vec<BindGroup>) {
    let glsl = &material.glsl;
    let versioned = |text: &str| format!("#version 330 core\n{text}");
    let (vertex, fragment) = (versioned(&glsl.vertex), versioned(&glsl.fragment));
    let defines: Vec<_> = glsl
        .defines
        .iter()
        .map(|(name, value)| (*name, value.as_str()))
        .collect();
    let module = stage.device.create_shader_module(&ShaderModuleDescriptor {
        defines: &defines,
        // The camera's depths are from 0 to 1 already.
        clip_space: Some(ClipSpace::Webgpu),
        ..ShaderModuleDescriptor::new(ShaderSource::Glsl {
            vertex: &vertex,
            fragment: &fragment,
        })
    });
    let module = module.unwrap_or_else(|errors| panic!("{}: {errors}", material.name));
    let program = stage.device.create_program(&module.program());
    let program = program.unwrap_or_else(|error| panic!("{}: {error}", material.name));
    let groups = stage.group(material, &module, &program, "");
    (program, groups)
}

/// The bytes of all colour targets, and of depth.
pub(super) fn drawn(
    stage: &Stage<'_>,
    material: &Material,
    program: Arc<dyn Program>,
    groups: &[BindGroup],
) -> Vec<Vec<u8>> {
    let device = stage.device;
    let mut descriptor = RenderPipelineDescriptor {
        vertex_buffers: vec![scene::layout(&material.streams)],
        primitive: PrimitiveState {
            topology: material.topology,
            ..PrimitiveState::default()
        },
        depth_stencil: Some(DepthState::LESS_WRITE.into()),
        targets: material.targets.clone(),
        ..RenderPipelineDescriptor::with_program(program)
    };
    if descriptor.bind_group_layouts.is_empty() {
        let layouts = groups.iter().map(|group| group.layout().clone());
        descriptor.bind_group_layouts = layouts.collect();
    }
    let pipeline = device
        .create_render_pipeline(&descriptor)
        .unwrap_or_else(|error| panic!("{}: {error}", material.name));
    let texture = |format| {
        let descriptor = TextureDescriptor::new_2d(WIDTH, HEIGHT, format);
        device.create_texture(&descriptor).expect("a small texture")
    };
    let colors: Vec<Texture> = material
        .targets
        .iter()
        .flatten()
        .map(|target| texture(target.format))
        .collect();
    let views: Vec<_> = colors.iter().map(Texture::view).collect();
    let attachments = views
        .iter()
        .map(|view| Some(ColorAttachment::clear(view, [0.25; 4])));
    let attachments: Vec<_> = attachments.collect();
    let depth = texture(TextureFormat::Depth32Float);
    device
        .render(&RenderPass {
            color_attachments: &attachments,
            depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth.view(), 1.0)),
            draws: &[Draw {
                vertex_buffers: &[(&stage.vertices).into()],
                bind_groups: groups,
                ..Draw::new(&pipeline, 0..stage.count)
            }],
            ..RenderPass::default()
        })
        .unwrap_or_else(|error| panic!("{}: {error}", material.name));
    let read = |texture| device.read_texture(texture).expect("it can be read");
    colors.iter().chain([&depth]).map(read).collect()
}

/// The numbers of a pixel, for messages.
pub(super) fn floats(bytes: &[u8]) -> Vec<f32> {
    let words = bytes.as_chunks::<4>().0.iter();
    words.map(|word| f32::from_le_bytes(*word)).collect()
}
