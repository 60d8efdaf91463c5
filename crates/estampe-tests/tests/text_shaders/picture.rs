//! A picture of a pipeline without vertex buffers.

use estampe::{
    BindGroup, ColorAttachment, Device, Draw, RenderPass, RenderPipeline, RenderPipelineDescriptor,
    ShaderModule, TextureDescriptor, TextureFormat,
};

/// A pipeline of a module's stages, without depth.
pub(super) fn pipeline(device: &Device, module: &ShaderModule) -> RenderPipeline {
    let program = device.create_program(&module.program());
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        depth_stencil: None,
        ..RenderPipelineDescriptor::with_program(program)
    });
    pipeline.unwrap_or_else(|error| panic!("{error}"))
}

/// The bytes of a picture that a triangle covers.
pub(super) fn drawn(
    device: &Device,
    pipeline: &RenderPipeline,
    bind_groups: &[BindGroup],
    [width, height]: [u32; 2],
) -> Vec<u8> {
    let descriptor = TextureDescriptor::new_2d(width, height, TextureFormat::Rgba8Unorm);
    let image = device.create_texture(&descriptor).expect("a small texture");
    let drawn = device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
        draws: &[Draw {
            bind_groups,
            ..Draw::new(pipeline, 0..3)
        }],
        ..RenderPass::default()
    });
    drawn.unwrap_or_else(|error| panic!("{error}"));
    device.read_texture(&image).expect("it can be read")
}
