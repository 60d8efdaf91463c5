//! The pipelines, buffers and bind groups of a scene on a device, for its shaders in Rust or in
//! WGSL.

use crate::BenchError;
use crate::scene::wgsl::WgslShaders;
use crate::scene::{Scene, shadow};
use estampe::state::CompareFunction;
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry, BindingResource,
    BindingType, Buffer, BufferBindingType, BufferSlice, Device, EntryPointDescriptor, FilterMode,
    ProgramDescriptor, RenderPipeline, RenderPipelineDescriptor, SampleType, SamplerDescriptor,
    ShaderModuleDescriptor, ShaderSource, Texture, TextureDescriptor, TextureFormat, ViewDimension,
};

/// The objects to which draws refer.
#[derive(Debug)]
pub(crate) struct Resources {
    /// The scene's pipelines.
    pub pipelines: Vec<RenderPipeline>,
    /// The scene's buffers.
    pub buffers: Vec<BufferSlice>,
    /// Group 0: the uniforms, at each draw's dynamic offset; in WGSL, the textures too.
    pub group_0: Option<BindGroup>,
    /// Group 1: the depth map.
    pub group_1: Option<BindGroup>,
}

/// A group's entries and what is bound to each.
type Bindings = Vec<(BindGroupLayoutEntry, BindingResource)>;

impl Resources {
    /// Creates them. `depth_map` is the texture that the scene's first pass draws.
    ///
    /// # Errors
    /// [`BenchError`] if the device refuses one.
    pub(crate) fn new(
        device: &Device,
        scene: &Scene,
        depth_map: Option<&Texture>,
    ) -> Result<Self, BenchError> {
        let buffers: Vec<BufferSlice> = (scene.buffers.iter())
            .map(|bytes| {
                let buffer = device.create_buffer_with_contents(bytes)?;
                Ok(BufferSlice::from(&buffer))
            })
            .collect::<Result<_, BenchError>>()?;
        let groups = match scene.wgsl {
            None => rust_bindings(scene, &buffers, depth_map),
            Some(_) => wgsl_bindings(device, scene, &buffers, depth_map)?,
        };
        let layouts = groups.each_ref().map(|bindings| {
            let entries: Vec<_> = bindings.iter().map(|(entry, _)| *entry).collect();
            device.create_bind_group_layout(&entries)
        });
        let [layout_0, layout_1] = layouts;
        let layouts = [layout_0?, layout_1?];
        let create = |group: usize| {
            let bindings = groups[group].iter();
            let entries: Vec<_> = bindings
                .map(|(entry, resource)| (entry.binding, resource.clone()))
                .collect();
            let descriptor = BindGroupDescriptor {
                label: None,
                layout: &layouts[group],
                entries: &entries,
            };
            let is_bound = !entries.is_empty();
            is_bound
                .then(|| device.create_bind_group(&descriptor))
                .transpose()
        };
        Ok(Self {
            group_0: create(0)?,
            group_1: create(1)?,
            pipelines: match scene.wgsl {
                None => (scene.pipelines.iter())
                    .map(|descriptor| device.create_render_pipeline(descriptor))
                    .collect::<Result<_, _>>()?,
                Some(shaders) => wgsl_pipelines(device, scene, shaders, &layouts)?,
            },
            buffers,
        })
    }
}

/// What shaders in Rust bind: the uniforms and the depth map. They hold their textures.
fn rust_bindings(
    scene: &Scene,
    buffers: &[BufferSlice],
    depth_map: Option<&Texture>,
) -> [Bindings; 2] {
    let uniforms = scene
        .uniforms
        .map(|index| uniforms(scene, &buffers[index].buffer));
    let depth_map = depth_map.map(|map| {
        let resource = BindingResource::Texture(map.view());
        (entry(shadow::DEPTH_MAP, BindingType::ShadowMap), resource)
    });
    [
        uniforms.into_iter().collect(),
        depth_map.into_iter().collect(),
    ]
}

/// What shaders in WGSL bind: in group 0 the uniforms, a sampler and the textures, in this order;
/// in group 1 the depth map and its sampler.
fn wgsl_bindings(
    device: &Device,
    scene: &Scene,
    buffers: &[BufferSlice],
    depth_map: Option<&Texture>,
) -> Result<[Bindings; 2], BenchError> {
    // Scenes of one draw have their uniforms after vertices and indices.
    let index = scene.uniforms.unwrap_or(2);
    let mut group_0 = Bindings::new();
    group_0.extend((buffers.get(index)).map(|slice| uniforms(scene, &slice.buffer)));
    if !scene.textures.is_empty() {
        let sampler = device.create_sampler(&SamplerDescriptor::trilinear_repeat())?;
        let ty = BindingType::Sampler { comparison: false };
        group_0.push((entry(1, ty), BindingResource::Sampler(sampler)));
    }
    for (binding, chain) in (2..).zip(&scene.textures) {
        let levels: Vec<&[u8]> = chain.levels.iter().map(Vec::as_slice).collect();
        let format = TextureFormat::Rgba8Unorm;
        let descriptor = TextureDescriptor::new_2d(chain.size, chain.size, format);
        let texture = device.create_texture_with_data(&descriptor.with_all_levels(), &levels)?;
        let ty = texture_2d(SampleType::Float);
        group_0.push((entry(binding, ty), BindingResource::Texture(texture.view())));
    }
    let mut group_1 = Bindings::new();
    if let Some(map) = depth_map {
        let sampler = device.create_sampler(&SamplerDescriptor {
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            compare: Some(CompareFunction::LessEqual),
            ..SamplerDescriptor::default()
        })?;
        let ty = texture_2d(SampleType::Depth);
        group_1.push((entry(0, ty), BindingResource::Texture(map.view())));
        let ty = BindingType::Sampler { comparison: true };
        group_1.push((entry(1, ty), BindingResource::Sampler(sampler)));
    }
    Ok([group_0, group_1])
}

/// The scene's pipelines with the programs of its module.
fn wgsl_pipelines(
    device: &Device,
    scene: &Scene,
    shaders: &WgslShaders,
    layouts: &[BindGroupLayout],
) -> Result<Vec<RenderPipeline>, BenchError> {
    let descriptor = ShaderModuleDescriptor {
        strict_math: scene.strict_math,
        ..ShaderModuleDescriptor::new(ShaderSource::Wgsl(shaders.text))
    };
    let module = device.create_shader_module(&descriptor)?;
    let pipelines = scene.pipelines.iter().zip(shaders.entry_points);
    pipelines
        .map(|(pipeline, [vertex, fragment])| {
            let entry_point = |name| EntryPointDescriptor {
                name: Some(name),
                ..EntryPointDescriptor::new(&module)
            };
            let has_color = !pipeline.targets.is_empty();
            let program = device.create_program(&ProgramDescriptor {
                vertex: entry_point(vertex),
                fragment: has_color.then(|| entry_point(fragment)),
            })?;
            let groups = program.bind_group_layouts().len();
            Ok(device.create_render_pipeline(&RenderPipelineDescriptor {
                program,
                bind_group_layouts: layouts[..groups].to_vec(),
                ..pipeline.clone()
            })?)
        })
        .collect()
}

fn entry(binding: u32, ty: BindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry { binding, ty }
}

fn texture_2d(sample_type: SampleType) -> BindingType {
    BindingType::Texture {
        sample_type,
        view_dimension: ViewDimension::D2,
        multisampled: false,
    }
}

/// Binding 0, at the dynamic offset of each draw.
fn uniforms(scene: &Scene, buffer: &Buffer) -> (BindGroupLayoutEntry, BindingResource) {
    let ty = BindingType::Buffer {
        ty: BufferBindingType::Uniform,
        has_dynamic_offset: true,
        min_binding_size: 0,
    };
    // What is left of the buffer at the greatest offset of a draw.
    let map = scene.depth_map.iter().flat_map(|map| &map.draws);
    let draws = scene.draws.iter().chain(map);
    let greatest = draws.map(|draw| draw.dynamic_offset).max().unwrap_or(0);
    let size = buffer.size() - u64::from(greatest);
    (entry(0, ty), BindingResource::Buffer(buffer.slice(0..size)))
}
