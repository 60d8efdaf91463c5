//! Depths that a pass has just drawn, compared: their texels are brought into rows only if a shader
//! reads them otherwise, which changes no result.

use super::picture::{drawn, pipeline};
use super::{devices, module};
use estampe::state::CompareFunction;
use estampe::{
    AddressMode, BindGroupDescriptor, BindingResource, DepthStencilAttachment, Device, Draw,
    FilterMode, RenderPass, RenderPipeline, RenderPipelineDescriptor, SamplerDescriptor,
    ShaderSource, Texture, TextureDescriptor, TextureFormat,
};

const SIZE: [u32; 2] = [50, 37];

/// A triangle that slopes, alone.
const SLOPE: &str = "
@vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    let x = f32(i & 1u) * 3.0 - 0.9;
    let y = f32(i >> 1u) * 3.0 - 0.8;
    return vec4f(x, y, 0.2 + f32(i) * 0.3, 1.0);
}
";

fn text(compared: &str) -> String {
    format!(
        "
@group(0) @binding(0) var depths: texture_depth_2d;
@group(0) @binding(1) var any: sampler_comparison;
@vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}}
@fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {{
    let uv = at.xy / 32.0 - 0.25;
    let size = vec2f(textureDimensions(depths));
    return vec4f({compared}, size / 64.0, 1.0);
}}
"
    )
}

fn slope(device: &Device) -> RenderPipeline {
    let module = module(device, ShaderSource::Wgsl(SLOPE));
    let program = device
        .create_program(&module.program())
        .expect("a vertex shader");
    let descriptor = RenderPipelineDescriptor {
        targets: Vec::new(),
        ..RenderPipelineDescriptor::with_program(program)
    };
    device
        .create_render_pipeline(&descriptor)
        .expect("depth alone")
}

/// Draws the slope: until rows are asked for, its depths are in tiles alone.
fn draw_depths(device: &Device, depths: &Texture, slope: &RenderPipeline) {
    let drawn = device.render(&RenderPass {
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depths.view(), 1.0)),
        draws: &[Draw::new(slope, 0..3)],
        ..RenderPass::default()
    });
    drawn.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn depths_that_are_only_compared_need_no_rows() {
    const ALONE: &str = "textureSampleCompareLevel(depths, any, uv, 0.55)";
    // The texel's weight is nothing; it is read all the same.
    const WITH_TEXELS: &str = "textureSampleCompareLevel(depths, any, uv, 0.55)
        + min(textureLoad(depths, vec2i(0), 0), 0.0)";
    const WITH_OFFSET: &str = "textureSampleCompareLevel(depths, any, uv, 0.55, vec2i(1, 0))";
    let common = SamplerDescriptor {
        compare: Some(CompareFunction::LessEqual),
        ..SamplerDescriptor::linear()
    };
    let samplers = [
        common,
        SamplerDescriptor {
            compare: Some(CompareFunction::Greater),
            ..common
        },
        SamplerDescriptor {
            mag_filter: FilterMode::Nearest,
            min_filter: FilterMode::Nearest,
            ..common
        },
        SamplerDescriptor {
            address_mode_u: AddressMode::Repeat,
            ..common
        },
    ];
    for (name, device) in devices() {
        let descriptor = TextureDescriptor::new_2d(SIZE[0], SIZE[1], TextureFormat::Depth32Float);
        let depths = device.create_texture(&descriptor).expect("a small texture");
        let slope = slope(&device);
        let compared = |text_of: &str, sampler: SamplerDescriptor, others: bool| {
            let module = module(&device, ShaderSource::Wgsl(&text(text_of)));
            let pipeline = pipeline(&device, &module);
            assert_eq!(pipeline.texture_reads(0, 0).others, others, "{text_of}");
            let sampler = device.create_sampler(&sampler).expect("a sampler");
            let group = device.create_bind_group(&BindGroupDescriptor {
                label: None,
                layout: &pipeline.descriptor().bind_group_layouts[0],
                entries: &[
                    (0, BindingResource::Texture(depths.view())),
                    (1, BindingResource::Sampler(sampler)),
                ],
            });
            let group = group.unwrap_or_else(|error| panic!("{error}"));
            draw_depths(&device, &depths, &slope);
            drawn(&device, &pipeline, &[group], [48, 48])
        };
        let pictures = samplers.map(|sampler| {
            let alone = compared(ALONE, sampler, false);
            assert!(alone == compared(WITH_TEXELS, sampler, true), "{name}");
            let values = Vec::from_iter(alone.chunks(4).map(|pixel| pixel[0]));
            assert!(values.contains(&0) && values.contains(&255), "{name}");
            alone
        });
        assert!(
            pictures[0] != pictures[1] && pictures[0] != pictures[3],
            "{name}"
        );
        assert!(compared(WITH_OFFSET, common, true) != pictures[0], "{name}");
    }
}
