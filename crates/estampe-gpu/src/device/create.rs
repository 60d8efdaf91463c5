//! Creating objects.

use super::Device;
use crate::texture::{self, Sampler, Texture, TextureDescriptor};
use crate::{
    BindGroup, BindGroupDescriptor, BindGroupError, BindGroupLayout, BindGroupLayoutEntry, Buffer,
    BufferDescriptor, BufferError, BufferUsages, ComputePipeline, ComputePipelineDescriptor,
    ComputePipelineError, PipelineError, RenderPipeline, RenderPipelineDescriptor, SampledTexture,
    SamplerDescriptor, TextureError, TextureView,
};

impl Device {
    /// Creates a pipeline. The descriptor is checked here, so that drawing cannot fail.
    ///
    /// # Errors
    /// [`PipelineError`] names the rule that the descriptor breaks.
    pub fn create_render_pipeline(
        &self,
        descriptor: &RenderPipelineDescriptor,
    ) -> Result<RenderPipeline, PipelineError> {
        RenderPipeline::new(descriptor, &self.limits)
    }

    /// Checks a shader that is text.
    ///
    /// # Errors
    /// [`ShaderErrors`](crate::ShaderErrors): for each error file, line, column, the line itself
    /// with a caret, and what to do.
    #[cfg(feature = "shader-text")]
    pub fn create_shader_module(
        &self,
        descriptor: &crate::ShaderModuleDescriptor<'_>,
    ) -> Result<crate::ShaderModule, crate::ShaderErrors> {
        crate::ShaderModule::new(descriptor)
    }

    /// Makes the program of a render pipeline of entry points of shader modules. It is compiled
    /// when it is first drawn with.
    ///
    /// # Errors
    /// [`ShaderModuleError`](crate::ShaderModuleError) if there are no such entry points, or they
    /// do not fit each other.
    #[cfg(feature = "shader-text")]
    pub fn create_program(
        &self,
        descriptor: &crate::ProgramDescriptor<'_>,
    ) -> Result<std::sync::Arc<dyn crate::Program>, crate::ShaderModuleError> {
        let program = descriptor.program(self.limits.max_shader_jumps)?;
        Ok(match self.interprets_shaders {
            true => std::sync::Arc::new(program.interpreted()),
            false => std::sync::Arc::new(program),
        })
    }

    /// Makes the program of a compute pipeline of an entry point of a shader module.
    ///
    /// # Errors
    /// [`ShaderModuleError`](crate::ShaderModuleError) if there is no such entry point.
    #[cfg(feature = "shader-text")]
    pub fn create_compute_program(
        &self,
        entry_point: &crate::EntryPointDescriptor<'_>,
    ) -> Result<std::sync::Arc<dyn crate::ComputeProgram>, crate::ShaderModuleError> {
        let program = entry_point.compute(self.limits.max_shader_jumps)?;
        Ok(match self.interprets_shaders {
            true => std::sync::Arc::new(program.interpreted()),
            false => std::sync::Arc::new(program),
        })
    }

    /// Creates a compute pipeline.
    ///
    /// # Errors
    /// [`ComputePipelineError`] names the limit that the descriptor exceeds.
    pub fn create_compute_pipeline(
        &self,
        descriptor: &ComputePipelineDescriptor<'_>,
    ) -> Result<ComputePipeline, ComputePipelineError> {
        ComputePipeline::new(descriptor, &self.limits)
    }

    /// Creates a buffer of zeros.
    ///
    /// # Errors
    /// [`BufferError`] if the size exceeds
    /// [`Limits::max_buffer_size`](crate::Limits), or memory is short.
    pub fn create_buffer(&self, descriptor: &BufferDescriptor<'_>) -> Result<Buffer, BufferError> {
        Buffer::new(descriptor, &self.limits)
    }

    /// Creates a buffer with these bytes, for all uses; [`bytes_of`](crate::bytes_of) makes bytes
    /// of numbers.
    ///
    /// # Errors
    /// [`BufferError`] as for [`Device::create_buffer`].
    pub fn create_buffer_with_contents(&self, contents: &[u8]) -> Result<Buffer, BufferError> {
        Buffer::with_contents(None, BufferUsages::all(), contents, &self.limits)
    }

    /// Creates a buffer of 32-bit words, for all uses, without a copy.
    ///
    /// # Errors
    /// [`BufferError`] as for [`Device::create_buffer`].
    pub fn create_buffer_of_words(&self, words: Vec<u32>) -> Result<Buffer, BufferError> {
        Buffer::of_words(words, &self.limits)
    }

    /// Creates a texture of zeros, of a compressed format of blocks of zero bytes, which shaders
    /// sample as such blocks are decoded (BC1's are black, those of ASTC its error colour). Its
    /// memory is allocated when it is first used.
    ///
    /// # Errors
    /// [`TextureError`] names the rule or limit that the descriptor breaks.
    pub fn create_texture(
        &self,
        descriptor: &TextureDescriptor<'_>,
    ) -> Result<Texture, TextureError> {
        Texture::new(descriptor, &self.limits)
    }

    /// Creates a texture from the bytes of its first mip levels, each without padding: layer after
    /// layer, row after row from the top. The other levels are generated, as by
    /// [`Device::generate_mips`]; those of compressed formats must all be given.
    ///
    /// # Errors
    /// [`TextureError`] names the rule or limit that the descriptor breaks, or the level with
    /// another number of bytes.
    pub fn create_texture_with_data(
        &self,
        descriptor: &TextureDescriptor<'_>,
        levels: &[&[u8]],
    ) -> Result<Texture, TextureError> {
        Texture::with_data(descriptor, levels, &self.limits)
    }

    /// Creates a sampler.
    ///
    /// # Errors
    /// [`TextureError`] names the rule that the descriptor breaks.
    pub fn create_sampler(&self, descriptor: &SamplerDescriptor) -> Result<Sampler, TextureError> {
        Sampler::new(descriptor)
    }

    /// Creates the layout of bind groups. Layouts with the same entries are compatible.
    ///
    /// # Errors
    /// [`BindGroupError`] if two entries have the same binding number, or there are too many.
    pub fn create_bind_group_layout(
        &self,
        entries: &[BindGroupLayoutEntry],
    ) -> Result<BindGroupLayout, BindGroupError> {
        crate::bind_group::create_layout(entries, &self.limits)
    }

    /// Creates a bind group.
    ///
    /// # Errors
    /// [`BindGroupError`] names the binding that does not fit the layout, and both sides.
    pub fn create_bind_group(
        &self,
        descriptor: &BindGroupDescriptor<'_>,
    ) -> Result<BindGroup, BindGroupError> {
        BindGroup::new(descriptor, &self.limits)
    }

    /// The texels of a view as they are now, with a sampler: for a shader that owns its textures.
    /// Later changes of the texture do not reach it; while it lives, they are made in a copy.
    ///
    /// # Errors
    /// [`TextureError`] if the sampler cannot sample the view, or memory is short.
    pub fn sampled_texture(
        &self,
        view: &TextureView,
        sampler: &Sampler,
    ) -> Result<SampledTexture, TextureError> {
        view.texture()
            .require(crate::TextureUsages::TEXTURE_BINDING)?;
        let _reserved = view.texture().reserve();
        texture::sampled_texture(&self.context, view, sampler)
    }
}
