//! Colours of shaders as text on targets of their type, and on others.

use super::{devices, module};
use estampe::{
    ColorAttachment, Device, Draw, RenderPass, RenderPipeline, RenderPipelineDescriptor,
    ShaderSource, TextureDescriptor, TextureFormat,
};

/// A triangle over the whole target, whose colours are integers of the pixel's position.
const WGSL: &str = "
@vertex fn vertex(@builtin(vertex_index) at: u32) -> @builtin(position) vec4f {
    return vec4f(f32(at % 2u) * 4.0 - 1.0, f32(at / 2u) * 4.0 - 1.0, 0.5, 1.0);
}
struct Colors { @location(0) unsigned: vec2u, @location(1) signed: i32 }
@fragment fn fragment(@builtin(position) at: vec4f) -> Colors {
    let pixel = vec2i(at.xy);
    return Colors(vec2u(pixel * 1000), pixel.x - 3 * pixel.y);
}
";

const GLSL: [&str; 2] = [
    "#version 330 core
void main() {
    gl_Position = vec4(float(gl_VertexID % 2) * 4.0 - 1.0, float(gl_VertexID / 2) * 4.0 - 1.0, 0.5, 1.0);
}",
    "#version 330 core
layout(location = 0) out uvec2 unsigneds;
layout(location = 1) out int signeds;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    unsigneds = uvec2(pixel * 1000);
    signeds = pixel.x - 3 * pixel.y;
}",
];

const SIZE: [u16; 2] = [40, 25];

fn pipelines(device: &Device, formats: [TextureFormat; 2]) -> Vec<Result<RenderPipeline, String>> {
    let [vertex, fragment] = GLSL;
    let sources = [
        ShaderSource::Wgsl(WGSL),
        ShaderSource::Glsl { vertex, fragment },
    ];
    let made = sources.map(|source| {
        let module = module(device, source);
        let program = device.create_program(&module.program());
        let program = program.unwrap_or_else(|error| panic!("{error}"));
        let made = device.create_render_pipeline(&RenderPipelineDescriptor {
            targets: formats.map(|format| Some(format.into())).to_vec(),
            depth_stencil: None,
            ..RenderPipelineDescriptor::with_program(program)
        });
        made.map_err(|error| error.to_string())
    });
    made.into()
}

/// Colours lack a blue of 0 and an alpha of 1: both are integers, too.
#[test]
fn integers_are_drawn_as_they_are() {
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
    let unsigned = pixels.clone().flat_map(|[x, y]| [x * 1000, y * 1000, 0, 1]);
    let unsigned: Vec<u8> = unsigned.flat_map(u16::to_le_bytes).collect();
    let signed = pixels.map(|[x, y]| i32::from(x) - 3 * i32::from(y));
    let signed: Vec<u8> = signed.flat_map(i32::to_le_bytes).collect();
    for (name, device) in devices() {
        let formats = [TextureFormat::Rgba16Uint, TextureFormat::R32Sint];
        let [width, height] = SIZE.map(u32::from);
        for pipeline in pipelines(&device, formats) {
            let pipeline = pipeline.unwrap_or_else(|error| panic!("{error}"));
            let targets = formats.map(|format| {
                let descriptor = TextureDescriptor::new_2d(width, height, format);
                device.create_texture(&descriptor).expect("a small texture")
            });
            let attachments = targets
                .each_ref()
                .map(|target| Some(ColorAttachment::clear(&target.view(), [0.0; 4])));
            device
                .render(&RenderPass {
                    color_attachments: &attachments,
                    draws: &[Draw::new(&pipeline, 0..3)],
                    ..RenderPass::default()
                })
                .unwrap_or_else(|error| panic!("{error}"));
            let read = targets.map(|target| device.read_texture(&target).expect("readable"));
            assert!(read == [unsigned.clone(), signed.clone()], "{name}");
        }
    }
}

#[test]
fn targets_of_another_type_are_refused() {
    use TextureFormat::{R32Float, R32Sint, Rgba16Sint, Rgba16Uint};
    let (_, device) = devices().next().expect("a level");
    for (formats, location, shader, format) in [
        (
            [Rgba16Sint, R32Sint],
            0,
            "unsigned integers (u32)",
            "rgba16sint, which holds signed integers (i32)",
        ),
        (
            [Rgba16Uint, R32Float],
            1,
            "signed integers (i32)",
            "r32float, which holds floats (f32)",
        ),
    ] {
        for made in pipelines(&device, formats) {
            assert_eq!(
                made.err(),
                Some(format!(
                    "the shader writes {shader} at location {location}, and colour target \
                     {location} has the format {format}: give the output or the target the \
                     other's type"
                ))
            );
        }
    }
}
