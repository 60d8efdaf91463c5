//! Every limit of a device: what has the limit's size is created, and what is larger by one is an
//! error that names the limit and both numbers.

use crate::support::{Fill, limited, texture};
use estampe::state::{ColorTargetState, VertexBufferLayout};
use estampe::{
    BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType,
    BufferDescriptor, ColorAttachment, Device, Draw, Extent3d, Limits, RenderPass,
    RenderPipelineDescriptor, TextureDescriptor, TextureDimension, TextureFormat, ViewDimension,
};

const STORAGE: BufferBindingType = BufferBindingType::Storage { read_only: true };

/// What happens on a device with limits of 2, for so many things: the error's text.
type Made = fn(&Device, u32) -> Result<(), String>;

fn buffer(ty: BufferBindingType, has_dynamic_offset: bool) -> BindingType {
    BindingType::Buffer {
        ty,
        has_dynamic_offset,
        min_binding_size: 0,
    }
}

/// A pipeline of a layout of `count` bindings of one kind.
fn pipeline_of(device: &Device, ty: BindingType, count: u32) -> Result<(), String> {
    let entries: Vec<_> = (0..count)
        .map(|binding| BindGroupLayoutEntry { binding, ty })
        .collect();
    // One binding a layout, so that the limits of layouts are not met first.
    let layouts = entries.iter().map(|entry| {
        device
            .create_bind_group_layout(std::slice::from_ref(entry))
            .unwrap()
    });
    let descriptor = RenderPipelineDescriptor {
        bind_group_layouts: layouts.collect(),
        ..RenderPipelineDescriptor::new(Fill::WHITE)
    };
    let made = device.create_render_pipeline(&descriptor);
    made.map(drop).map_err(|error| error.to_string())
}

/// A bind group of so many bytes of a buffer.
fn group_of(device: &Device, ty: BufferBindingType, bytes: u64, offset: u64) -> Result<(), String> {
    let layout = device
        .create_bind_group_layout(&[BindGroupLayoutEntry {
            binding: 0,
            ty: buffer(ty, false),
        }])
        .unwrap();
    let memory = device.create_buffer(&BufferDescriptor::new(64)).unwrap();
    let resource = BindingResource::Buffer(memory.slice(offset..offset + bytes));
    let made = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[(0, resource)],
    });
    made.map(drop).map_err(|error| error.to_string())
}

fn texture_of(device: &Device, dimension: TextureDimension, size: [u32; 3]) -> Result<(), String> {
    let [width, height, depth_or_array_layers] = size;
    let made = device.create_texture(&TextureDescriptor {
        dimension,
        size: Extent3d {
            width,
            height,
            depth_or_array_layers,
        },
        ..TextureDescriptor::new_2d(1, 1, TextureFormat::R8Unorm)
    });
    made.map(drop).map_err(|error| error.to_string())
}

fn draws_of(device: &Device, vertices: u32) -> Result<(), String> {
    let image = texture(device, [4, 4], TextureFormat::Rgba8Unorm).view();
    let descriptor = RenderPipelineDescriptor {
        depth_stencil: None,
        ..RenderPipelineDescriptor::new(Fill::WHITE)
    };
    let pipeline = device.create_render_pipeline(&descriptor).unwrap();
    let drawn = device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::load(&image))],
        draws: &[Draw::new(&pipeline, 0..vertices)],
        ..RenderPass::default()
    });
    drawn.map(drop).map_err(|error| error.to_string())
}

macro_rules! limit {
    ($name:ident, $made:expr) => {
        (
            stringify!($name),
            Limits {
                $name: 2,
                ..Limits::default()
            },
            $made as Made,
        )
    };
}

/// The limits of sizes and of vertex buffers, set to 2, and what meets each.
fn of_sizes() -> Vec<(&'static str, Limits, Made)> {
    vec![
        limit!(max_texture_dimension_1d, |d, n| texture_of(
            d,
            TextureDimension::D1,
            [n, 1, 1]
        )),
        limit!(max_texture_dimension_2d, |d, n| texture_of(
            d,
            TextureDimension::D2,
            [1, n, 1]
        )),
        limit!(max_texture_dimension_3d, |d, n| texture_of(
            d,
            TextureDimension::D3,
            [1, 1, n]
        )),
        limit!(max_texture_array_layers, |d, n| texture_of(
            d,
            TextureDimension::D2,
            [1, 1, n]
        )),
        limit!(max_buffer_size, |d, n| {
            let made = d.create_buffer(&BufferDescriptor::new(n.into()));
            made.map(drop).map_err(|error| error.to_string())
        }),
        limit!(max_vertex_buffers, |d, n| {
            let descriptor = RenderPipelineDescriptor {
                vertex_buffers: vec![VertexBufferLayout::packed(&[]); n as usize],
                ..RenderPipelineDescriptor::new(Fill::WHITE)
            };
            let made = d.create_render_pipeline(&descriptor);
            made.map(drop).map_err(|error| error.to_string())
        }),
        limit!(max_vertex_buffer_array_stride, |d, n| {
            let layout = VertexBufferLayout {
                array_stride: n,
                ..VertexBufferLayout::packed(&[])
            };
            let descriptor = RenderPipelineDescriptor {
                vertex_buffers: vec![layout],
                ..RenderPipelineDescriptor::new(Fill::WHITE)
            };
            let made = d.create_render_pipeline(&descriptor);
            made.map(drop).map_err(|error| error.to_string())
        }),
        limit!(max_bind_groups_plus_vertex_buffers, |d, n| {
            let layout = d.create_bind_group_layout(&[]).unwrap();
            let descriptor = RenderPipelineDescriptor {
                bind_group_layouts: vec![layout],
                vertex_buffers: vec![VertexBufferLayout::packed(&[]); n as usize - 1],
                ..RenderPipelineDescriptor::new(Fill::WHITE)
            };
            let made = d.create_render_pipeline(&descriptor);
            made.map(drop).map_err(|error| error.to_string())
        }),
        limit!(max_pass_vertices, draws_of),
    ]
}

/// The limits of what a pipeline binds, set to 2, and what meets each.
fn of_bindings() -> Vec<(&'static str, Limits, Made)> {
    const SAMPLED: BindingType = BindingType::sampled_2d();
    const UNIFORM: BufferBindingType = BufferBindingType::Uniform;
    vec![
        limit!(max_bind_groups, |d, n| pipeline_of(d, SAMPLED, n)),
        limit!(max_sampled_textures_per_shader_stage, |d, n| pipeline_of(
            d,
            BindingType::ShadowMap,
            n
        )),
        limit!(max_samplers_per_shader_stage, |d, n| pipeline_of(
            d, SAMPLED, n
        )),
        limit!(max_uniform_buffers_per_shader_stage, |d, n| {
            pipeline_of(d, buffer(UNIFORM, false), n)
        }),
        limit!(max_storage_buffers_per_shader_stage, |d, n| {
            pipeline_of(d, buffer(STORAGE, false), n)
        }),
        limit!(max_dynamic_uniform_buffers_per_pipeline_layout, |d, n| {
            pipeline_of(d, buffer(UNIFORM, true), n)
        }),
        limit!(max_dynamic_storage_buffers_per_pipeline_layout, |d, n| {
            pipeline_of(d, buffer(STORAGE, true), n)
        }),
        limit!(max_storage_textures_per_shader_stage, |d, n| {
            let ty = BindingType::StorageTexture {
                format: TextureFormat::R32Uint,
                view_dimension: ViewDimension::D2,
            };
            pipeline_of(d, ty, n)
        }),
        limit!(max_bindings_per_bind_group, |d, n| {
            let entry = |binding| BindGroupLayoutEntry {
                binding,
                ty: SAMPLED,
            };
            let made = d.create_bind_group_layout(&(0..n).map(entry).collect::<Vec<_>>());
            made.map(drop).map_err(|error| error.to_string())
        }),
        limit!(max_dynamic_offsets_per_bind_group, |d, n| {
            let entry = |binding| BindGroupLayoutEntry {
                binding,
                ty: buffer(UNIFORM, true),
            };
            let made = d.create_bind_group_layout(&(0..n).map(entry).collect::<Vec<_>>());
            made.map(drop).map_err(|error| error.to_string())
        }),
        limit!(max_color_attachment_bytes_per_sample, |d, n| {
            let descriptor = RenderPipelineDescriptor {
                targets: vec![Some(ColorTargetState::from(if n == 2 {
                    TextureFormat::Rg8Unorm
                } else {
                    TextureFormat::Rgba8Unorm
                }))],
                ..RenderPipelineDescriptor::new(Fill::WHITE)
            };
            let made = d.create_render_pipeline(&descriptor);
            made.map(drop).map_err(|error| error.to_string())
        }),
    ]
}

/// Rows: N1
#[test]
fn each_limit_is_reached_and_no_more() {
    for (name, limits, made) in of_sizes().into_iter().chain(of_bindings()) {
        let device = limited(limits);
        made(&device, 2).unwrap_or_else(|error| panic!("{name}: {error}"));
        let error = made(&device, 3).expect_err(name);
        // What the program meant, the limit's name and its value.
        assert!(error.contains(name), "{name}: {error}");
        assert!(
            error.contains(&format!("{name} is 2")) || error.contains(&format!("{name} = 2")),
            "{error}"
        );
    }
}

/// Limits whose least value is more than 2.
///
/// Rows: N1
#[test]
fn sizes_and_offsets_of_bindings_are_limited() {
    let limits = Limits {
        max_uniform_buffer_binding_size: 16,
        max_storage_buffer_binding_size: 32,
        min_uniform_buffer_offset_alignment: 8,
        min_storage_buffer_offset_alignment: 16,
        ..Limits::default()
    };
    let device = limited(limits);
    for (ty, most, alignment) in [(BufferBindingType::Uniform, 16, 8), (STORAGE, 32, 16)] {
        group_of(&device, ty, most, 0).unwrap();
        group_of(&device, ty, 4, alignment).unwrap();
        let error = group_of(&device, ty, most + 4, 0).unwrap_err();
        assert!(
            error.contains(&format!("the size 1 to {most} bytes")),
            "{error}"
        );
        let error = group_of(&device, ty, 4, alignment / 2).unwrap_err();
        assert!(
            error.contains(&format!("a multiple of {alignment}")),
            "{error}"
        );
    }
}

/// WebGPU's guaranteed limits (its *default* column) are met by a device that asks for nothing.
///
/// Rows: N1
#[test]
fn default_limits_are_at_least_webgpus() {
    let limits = Limits::default();
    let most = [
        (limits.max_texture_dimension_1d, 8192),
        (limits.max_texture_dimension_2d, 8192),
        (limits.max_texture_dimension_3d, 2048),
        (limits.max_texture_array_layers, 256),
        (limits.max_bind_groups, 4),
        (limits.max_bind_groups_plus_vertex_buffers, 24),
        (limits.max_bindings_per_bind_group, 1000),
        (limits.max_dynamic_uniform_buffers_per_pipeline_layout, 8),
        (limits.max_dynamic_storage_buffers_per_pipeline_layout, 4),
        (limits.max_dynamic_offsets_per_bind_group, 8 + 4),
        (limits.max_sampled_textures_per_shader_stage, 16),
        (limits.max_samplers_per_shader_stage, 16),
        (limits.max_storage_buffers_per_shader_stage, 8),
        (limits.max_storage_textures_per_shader_stage, 4),
        (limits.max_uniform_buffers_per_shader_stage, 12),
        (limits.max_vertex_buffers, 8),
        (limits.max_vertex_attributes, 16),
        (limits.max_vertex_buffer_array_stride, 2048),
        (limits.max_inter_stage_scalars, 16 * 4),
        (limits.max_color_attachments, 8),
        (limits.max_color_attachment_bytes_per_sample, 32),
        (limits.max_immediate_size, 64),
    ];
    for (index, (limit, guaranteed)) in most.into_iter().enumerate() {
        assert!(limit >= guaranteed, "{index}: {limit} < {guaranteed}");
    }
    assert!(limits.max_uniform_buffer_binding_size >= 1 << 16);
    assert!(limits.max_storage_buffer_binding_size >= 1 << 27);
    assert!(limits.max_buffer_size >= 1 << 28);
    assert!(limits.min_uniform_buffer_offset_alignment <= 256);
    assert!(limits.min_storage_buffer_offset_alignment <= 256);
}
