//! Loops that never end: the pass ends with an error, and later ones draw again.

use super::module;
use estampe::{
    BindGroupDescriptor, BindingResource, ColorAttachment, Device, DeviceDescriptor, Draw, Level,
    Limits, PassErrorKind, RenderPass, RenderPipeline, RenderPipelineDescriptor, ShaderSource,
    TextureDescriptor, TextureFormat,
};

/// The loop of a stage goes on until a number of the buffer is reached; 0 never is.
const TEXT: &str = "
@group(0) @binding(0) var<uniform> ends: vec4u;

fn count(end: u32) -> f32 {
    var n = 1u;
    loop {
        n += 2u;
        if n == end { break; }
    }
    return f32(n);
}

@vertex fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4f(corner * count(ends.x) / 9.0, 0.0, 1.0);
}

@fragment fn fragment() -> @location(0) vec4f {
    return vec4f(count(ends.y) / 18.0, 0.0, 0.0, 1.0);
}
";

const LIMIT: u64 = 5_000;

fn draw(
    device: &Device,
    pipeline: &RenderPipeline,
    ends: [u32; 2],
) -> Result<Vec<u8>, PassErrorKind> {
    let [vertex, fragment] = ends;
    let words = vec![vertex, fragment, 0, 0];
    let buffer = device.create_buffer_of_words(words).unwrap();
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.descriptor().bind_group_layouts[0],
        entries: &[(0, BindingResource::Buffer(buffer.slice(..)))],
    });
    let group = group.unwrap();
    let format = TextureFormat::Rgba8Unorm;
    let image = device
        .create_texture(&TextureDescriptor::new_2d(64, 64, format))
        .unwrap();
    let drawn = device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
        draws: &[Draw {
            bind_groups: &[group],
            ..Draw::new(pipeline, 0..3)
        }],
        ..RenderPass::default()
    });
    drawn.map_err(|error| error.kind)?;
    Ok(device.read_texture(&image).unwrap())
}

#[test]
fn a_loop_that_never_ends_ends_the_pass() {
    let levels = Level::all_available().into_iter();
    let ways = levels.map(|level| (level, false));
    for (level, interprets_shaders) in ways.chain([(Level::best(), true)]) {
        let device = Device::new(&DeviceDescriptor {
            level,
            interprets_shaders,
            limits: Limits {
                max_shader_jumps: LIMIT,
                ..Limits::default()
            },
            ..DeviceDescriptor::default()
        });
        let device = device.unwrap();
        let module = module(&device, ShaderSource::Wgsl(TEXT));
        let program = device.create_program(&module.program()).unwrap();
        let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
            depth_stencil: None,
            ..RenderPipelineDescriptor::with_program(program)
        });
        let pipeline = pipeline.unwrap();
        let stopped = PassErrorKind::Stopped {
            draw: 0,
            limit: LIMIT,
        };
        for endless in [[0, 9], [9, 0]] {
            let found = draw(&device, &pipeline, endless).unwrap_err();
            assert_eq!(found, stopped, "{endless:?} at {level:?}");
            let picture = draw(&device, &pipeline, [9, 9]).unwrap();
            assert_eq!(
                picture[..4],
                [128, 0, 0, 255],
                "after {endless:?} at {level:?}"
            );
            assert_eq!(picture[..4], picture[picture.len() - 4..]);
        }
    }
}
