//! A SPIR-V module draws the bytes of the WGSL of which naga wrote it.

use super::{devices, module};
use estampe::state::VertexBufferLayout;
use estampe::{
    BindGroupDescriptor, BindingResource, ColorAttachment, Device, Draw, RenderPass,
    RenderPipelineDescriptor, ShaderModule, ShaderSource, TextureDescriptor, TextureFormat,
    VertexFormat, bytes_of,
};

const WGSL: &str = "
@group(0) @binding(0) var<uniform> tint: vec4f;
struct Out { @builtin(position) position: vec4f, @location(0) color: vec3f }
@vertex fn vs(@location(0) at: vec2f, @location(1) color: vec3f) -> Out {
    return Out(vec4f(at, 0.5, 1.0), color);
}
@fragment fn fs(@location(0) color: vec3f) -> @location(0) vec4f {
    return vec4f(color, 1.0) * tint;
}
";

#[rustfmt::skip]
const SPIRV: [u32; 265] = [
    0x0723_0203, 0x0001_0000, 0x0000_001c, 0x0000_002c, 0x0000_0000, 0x0002_0011, 0x0000_0001, 0x0006_000b,
    0x0000_0001, 0x4c53_4c47, 0x6474_732e, 0x3035_342e, 0x0000_0000, 0x0003_000e, 0x0000_0000, 0x0000_0001,
    0x0008_000f, 0x0000_0000, 0x0000_0016, 0x0000_7376, 0x0000_000c, 0x0000_000f, 0x0000_0012, 0x0000_0014,
    0x0006_000f, 0x0000_0004, 0x0000_0023, 0x0000_7366, 0x0000_0020, 0x0000_0022, 0x0003_0010, 0x0000_0023,
    0x0000_0007, 0x0005_0048, 0x0000_0006, 0x0000_0000, 0x0000_0023, 0x0000_0000, 0x0005_0048, 0x0000_0006,
    0x0000_0001, 0x0000_0023, 0x0000_0010, 0x0004_0047, 0x0000_0008, 0x0000_0022, 0x0000_0000, 0x0004_0047,
    0x0000_0008, 0x0000_0021, 0x0000_0000, 0x0003_0047, 0x0000_0009, 0x0000_0002, 0x0005_0048, 0x0000_0009,
    0x0000_0000, 0x0000_0023, 0x0000_0000, 0x0004_0047, 0x0000_000c, 0x0000_001e, 0x0000_0000, 0x0004_0047,
    0x0000_000f, 0x0000_001e, 0x0000_0001, 0x0004_0047, 0x0000_0012, 0x0000_000b, 0x0000_0000, 0x0004_0047,
    0x0000_0014, 0x0000_001e, 0x0000_0000, 0x0004_0047, 0x0000_0020, 0x0000_001e, 0x0000_0000, 0x0004_0047,
    0x0000_0022, 0x0000_001e, 0x0000_0000, 0x0002_0013, 0x0000_0002, 0x0003_0016, 0x0000_0004, 0x0000_0020,
    0x0004_0017, 0x0000_0003, 0x0000_0004, 0x0000_0004, 0x0004_0017, 0x0000_0005, 0x0000_0004, 0x0000_0003,
    0x0004_001e, 0x0000_0006, 0x0000_0003, 0x0000_0005, 0x0004_0017, 0x0000_0007, 0x0000_0004, 0x0000_0002,
    0x0003_001e, 0x0000_0009, 0x0000_0003, 0x0004_0020, 0x0000_000a, 0x0000_0002, 0x0000_0009, 0x0004_003b,
    0x0000_000a, 0x0000_0008, 0x0000_0002, 0x0004_0020, 0x0000_000d, 0x0000_0001, 0x0000_0007, 0x0004_003b,
    0x0000_000d, 0x0000_000c, 0x0000_0001, 0x0004_0020, 0x0000_0010, 0x0000_0001, 0x0000_0005, 0x0004_003b,
    0x0000_0010, 0x0000_000f, 0x0000_0001, 0x0004_0020, 0x0000_0013, 0x0000_0003, 0x0000_0003, 0x0004_003b,
    0x0000_0013, 0x0000_0012, 0x0000_0003, 0x0004_0020, 0x0000_0015, 0x0000_0003, 0x0000_0005, 0x0004_003b,
    0x0000_0015, 0x0000_0014, 0x0000_0003, 0x0003_0021, 0x0000_0017, 0x0000_0002, 0x0004_002b, 0x0000_0004,
    0x0000_0018, 0x3f00_0000, 0x0004_002b, 0x0000_0004, 0x0000_0019, 0x3f80_0000, 0x0004_003b, 0x0000_0010,
    0x0000_0020, 0x0000_0001, 0x0004_003b, 0x0000_0013, 0x0000_0022, 0x0000_0003, 0x0004_0020, 0x0000_0024,
    0x0000_0002, 0x0000_0003, 0x0004_0015, 0x0000_0026, 0x0000_0020, 0x0000_0000, 0x0004_002b, 0x0000_0026,
    0x0000_0025, 0x0000_0000, 0x0005_0036, 0x0000_0002, 0x0000_0016, 0x0000_0000, 0x0000_0017, 0x0002_00f8,
    0x0000_000b, 0x0004_003d, 0x0000_0007, 0x0000_000e, 0x0000_000c, 0x0004_003d, 0x0000_0005, 0x0000_0011,
    0x0000_000f, 0x0002_00f9, 0x0000_001a, 0x0002_00f8, 0x0000_001a, 0x0006_0050, 0x0000_0003, 0x0000_001b,
    0x0000_000e, 0x0000_0018, 0x0000_0019, 0x0005_0050, 0x0000_0006, 0x0000_001c, 0x0000_001b, 0x0000_0011,
    0x0005_0051, 0x0000_0003, 0x0000_001d, 0x0000_001c, 0x0000_0000, 0x0003_003e, 0x0000_0012, 0x0000_001d,
    0x0005_0051, 0x0000_0005, 0x0000_001e, 0x0000_001c, 0x0000_0001, 0x0003_003e, 0x0000_0014, 0x0000_001e,
    0x0001_00fd, 0x0001_0038, 0x0005_0036, 0x0000_0002, 0x0000_0023, 0x0000_0000, 0x0000_0017, 0x0002_00f8,
    0x0000_001f, 0x0004_003d, 0x0000_0005, 0x0000_0021, 0x0000_0020, 0x0005_0041, 0x0000_0024, 0x0000_0027,
    0x0000_0008, 0x0000_0025, 0x0002_00f9, 0x0000_0028, 0x0002_00f8, 0x0000_0028, 0x0005_0050, 0x0000_0003,
    0x0000_0029, 0x0000_0021, 0x0000_0019, 0x0004_003d, 0x0000_0003, 0x0000_002a, 0x0000_0027, 0x0005_0085,
    0x0000_0003, 0x0000_002b, 0x0000_0029, 0x0000_002a, 0x0003_003e, 0x0000_0022, 0x0000_002b, 0x0001_00fd,
    0x0001_0038,
];

fn drawn(device: &Device, module: &ShaderModule) -> Vec<u8> {
    let program = device.create_program(&module.program());
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    let formats = [VertexFormat::Float32x2, VertexFormat::Float32x3];
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout::packed(&formats)],
        depth_stencil: None,
        ..RenderPipelineDescriptor::with_program(program)
    });
    let pipeline = pipeline.unwrap_or_else(|error| panic!("{error}"));
    let tint = device.create_buffer_with_contents(bytes_of(&[1.0_f32, 0.5, 0.25, 1.0]));
    let tint = BindingResource::Buffer(tint.expect("a small buffer").slice(..));
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.descriptor().bind_group_layouts[0],
        entries: &[(0, tint)],
    });
    let corners = [
        [-0.9_f32, -0.8, 1.0, 0.0, 0.0],
        [0.9, -0.5, 0.0, 1.0, 0.0],
        [0.1, 0.9, 0.0, 0.0, 1.0],
    ];
    let corners = device.create_buffer_with_contents(bytes_of(corners.as_flattened()));
    let descriptor = TextureDescriptor::new_2d(64, 48, TextureFormat::Rgba8Unorm);
    let image = device.create_texture(&descriptor).expect("a small texture");
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
            draws: &[Draw {
                vertex_buffers: &[(&corners.expect("a small buffer")).into()],
                bind_groups: &[group.unwrap_or_else(|error| panic!("{error}"))],
                ..Draw::new(&pipeline, 0..3)
            }],
            ..RenderPass::default()
        })
        .unwrap_or_else(|error| panic!("{error}"));
    device.read_texture(&image).expect("it can be read")
}

/// Rows: G3
#[test]
fn spirv_draws_the_bytes_of_its_wgsl() {
    let bytes: Vec<u8> = SPIRV.iter().flat_map(|word| word.to_be_bytes()).collect();
    for (name, device) in devices() {
        let expected = drawn(&device, &module(&device, ShaderSource::Wgsl(WGSL)));
        let colors: std::collections::BTreeSet<_> = expected.chunks(4).collect();
        assert!(colors.len() > 200, "{}", colors.len());
        for source in [
            ShaderSource::SpirV(&SPIRV),
            ShaderSource::SpirVBytes(&bytes),
        ] {
            assert!(
                drawn(&device, &module(&device, source)) == expected,
                "{name}"
            );
        }
    }
}
