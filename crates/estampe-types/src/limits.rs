//! The largest sizes of resources and pipelines.

/// The largest sizes that creation accepts. If a limit is exceeded, creation fails with an error
/// that names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Limits {
    /// Width of a 1D texture, in texels. Default and maximum 16384.
    pub max_texture_dimension_1d: u32,
    /// Width and height of a render target or texture, in pixels. Default and maximum 16384: the
    /// guard band of the fixed-point rasterizer is sized for it.
    pub max_texture_dimension_2d: u32,
    /// Bytes of one buffer. Default 2³⁰.
    pub max_buffer_size: u64,
    /// Vertex attributes of a pipeline. Default 16.
    pub max_vertex_attributes: u32,
    /// Vertex buffers of a pipeline. Default 8.
    pub max_vertex_buffers: u32,
    /// Stride of a vertex buffer: bytes from one element to the next. Default 2048.
    pub max_vertex_buffer_array_stride: u32,
    /// Scalars of all varyings together. Default 64: 16 variables of 4 components.
    pub max_inter_stage_scalars: u32,
    /// Colour targets of a pipeline. Default 8.
    pub max_color_attachments: u32,
    /// Bytes of all colour targets of a pipeline for one sample. Default 128: eight targets of the
    /// widest format.
    pub max_color_attachment_bytes_per_sample: u32,
    /// Bind groups of a draw. Default 4.
    pub max_bind_groups: u32,
    /// Bind groups and vertex buffers of a pipeline together. Default 24.
    pub max_bind_groups_plus_vertex_buffers: u32,
    /// Bindings of a bind group. Default 1000.
    pub max_bindings_per_bind_group: u32,
    /// Dynamic offsets of a bind group. Default and maximum 12.
    pub max_dynamic_offsets_per_bind_group: u32,
    /// Uniform buffers with a dynamic offset of a pipeline. Default 48.
    pub max_dynamic_uniform_buffers_per_pipeline_layout: u32,
    /// Storage buffers with a dynamic offset of a pipeline. Default 48.
    pub max_dynamic_storage_buffers_per_pipeline_layout: u32,
    /// Textures that a pipeline samples or fetches from. Default 1000.
    pub max_sampled_textures_per_shader_stage: u32,
    /// Samplers of a pipeline. Default 1000.
    pub max_samplers_per_shader_stage: u32,
    /// Storage buffers of a pipeline. Default 1000.
    pub max_storage_buffers_per_shader_stage: u32,
    /// Storage textures of a pipeline. Default 1000.
    pub max_storage_textures_per_shader_stage: u32,
    /// Uniform buffers of a pipeline. Default 1000.
    pub max_uniform_buffers_per_shader_stage: u32,
    /// Bytes of a uniform buffer's binding. Default 2³⁰.
    pub max_uniform_buffer_binding_size: u64,
    /// Bytes of a storage buffer's binding. Default 2³⁰.
    pub max_storage_buffer_binding_size: u64,
    /// Multiple that offsets of uniform buffers must be of, in bytes. Default and minimum 4.
    pub min_uniform_buffer_offset_alignment: u32,
    /// Multiple that offsets of storage buffers must be of, in bytes. Default and minimum 4.
    pub min_storage_buffer_offset_alignment: u32,
    /// Bytes of the immediates (Vulkan's push constants) of a draw or dispatch. Default 128, which
    /// every implementation of Vulkan has; WebGPU's default is 64.
    pub max_immediate_size: u32,
    /// Vertices or indices of all draws of a pass, times their instances: what keeps a hostile draw
    /// from running for hours. Default 2³⁰.
    pub max_pass_vertices: u64,
    /// Layers of a texture. Default and maximum 256.
    pub max_texture_array_layers: u32,
    /// Sides of a 3D texture, in texels. Default and maximum 2048.
    pub max_texture_dimension_3d: u32,
    /// The most invocations of a work-group along x.
    pub max_compute_workgroup_size_x: u32,
    /// The most invocations of a work-group along y.
    pub max_compute_workgroup_size_y: u32,
    /// The most invocations of a work-group along z.
    pub max_compute_workgroup_size_z: u32,
    /// The most invocations of a work-group.
    pub max_compute_invocations_per_workgroup: u32,
    /// The most bytes that the invocations of a work-group share.
    pub max_compute_workgroup_storage_size: u32,
    /// The most work-groups of a dispatch along each axis.
    pub max_compute_workgroups_per_dimension: u32,
    /// The most jumps that a shader as text executes for a batch of vertices or fragments or for a
    /// work-group, as a bound to loops that never end. What needs more is stopped: a dispatch with
    /// an error, a draw with undefined results.
    pub max_shader_jumps: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_texture_dimension_1d: 16_384,
            max_texture_dimension_2d: 16_384,
            max_buffer_size: 1 << 30,
            max_vertex_attributes: 16,
            max_vertex_buffers: 8,
            max_vertex_buffer_array_stride: 2048,
            max_inter_stage_scalars: 64,
            max_color_attachments: 8,
            max_color_attachment_bytes_per_sample: 128,
            max_bind_groups: 4,
            max_bind_groups_plus_vertex_buffers: 24,
            max_bindings_per_bind_group: 1000,
            max_dynamic_offsets_per_bind_group: 12,
            max_dynamic_uniform_buffers_per_pipeline_layout: 48,
            max_dynamic_storage_buffers_per_pipeline_layout: 48,
            max_sampled_textures_per_shader_stage: 1000,
            max_samplers_per_shader_stage: 1000,
            max_storage_buffers_per_shader_stage: 1000,
            max_storage_textures_per_shader_stage: 1000,
            max_uniform_buffers_per_shader_stage: 1000,
            max_uniform_buffer_binding_size: 1 << 30,
            max_storage_buffer_binding_size: 1 << 30,
            min_uniform_buffer_offset_alignment: 4,
            min_storage_buffer_offset_alignment: 4,
            max_immediate_size: 128,
            max_pass_vertices: 1 << 30,
            max_texture_array_layers: 256,
            max_texture_dimension_3d: 2048,
            max_compute_workgroup_size_x: 1024,
            max_compute_workgroup_size_y: 1024,
            max_compute_workgroup_size_z: 1024,
            max_compute_invocations_per_workgroup: 1024,
            max_compute_workgroup_storage_size: 1 << 15,
            max_compute_workgroups_per_dimension: 65_535,
            max_shader_jumps: 1 << 26,
        }
    }
}
