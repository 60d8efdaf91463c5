//! A compute shader in WGSL: each invocation counts the steps of one pixel of the Mandelbrot set,
//! and work-groups add the counts to a histogram, by which a second shader chooses colours.
//!
//! `cargo run --release -p estampe-gpu --features png --example mandelbrot [OUT.png]`

use estampe::{
    BindGroup, BindGroupDescriptor, BindingResource, BufferDescriptor, ComputePipeline,
    ComputePipelineDescriptor, Device, DeviceDescriptor, Dispatch, EntryPointDescriptor,
    ShaderModuleDescriptor, ShaderSource, Texture, TextureDescriptor, TextureFormat,
};
use std::error::Error;

type Outcome<T> = Result<T, Box<dyn Error>>;

const WIDTH: u32 = 300;
const HEIGHT: u32 = 200;

const SHADERS: &str = "
@group(0) @binding(0) var<storage, read_write> steps: array<u32>;
@group(0) @binding(1) var<storage, read_write> histogram: array<atomic<u32>, 256>;
@group(0) @binding(2) var<storage, read> counts: array<u32, 256>;
@group(0) @binding(3) var image: texture_storage_2d<rgba8unorm, write>;

override width: u32;
override height: u32;

@compute @workgroup_size(16, 4)
fn count(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= width || id.y >= height { return; }
    let pixel = vec2f(id.xy) + 0.5;
    let c = (pixel - vec2f(0.72, 0.5) * vec2f(f32(width), f32(height))) * 2.6 / f32(height);
    var z = vec2f(0.0);
    var n = 0u;
    while n < 255u && dot(z, z) <= 16.0 {
        z = vec2f(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + c;
        n++;
    }
    steps[id.y * width + id.x] = n;
    atomicAdd(&histogram[n], 1u);
}

@compute @workgroup_size(16, 4)
fn paint(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= width || id.y >= height { return; }
    let n = steps[id.y * width + id.x];
    var below = 0u;
    for (var k = 0u; k < n; k++) { below += counts[k]; }
    let share = f32(below) / f32(width * height - counts[255]);
    let color = 0.5 + 0.5 * cos(6.28318 * (share * 0.8 + vec3f(0.6, 0.7, 0.8)));
    textureStore(image, id.xy, vec4f(select(color, vec3f(0.05), n == 255u), 1.0));
}
";

/// Draws the picture.
fn picture(device: &Device) -> Outcome<Texture> {
    let module = device.create_shader_module(&ShaderModuleDescriptor {
        label: Some("mandelbrot.wgsl"),
        ..ShaderModuleDescriptor::new(ShaderSource::Wgsl(SHADERS))
    })?;
    let pipeline = |name| -> Outcome<ComputePipeline> {
        let program = device.create_compute_program(&EntryPointDescriptor {
            name: Some(name),
            constants: &[("width", WIDTH.into()), ("height", HEIGHT.into())],
            ..EntryPointDescriptor::new(&module)
        })?;
        Ok(device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some(name),
            ..ComputePipelineDescriptor::new(program)
        })?)
    };
    let steps = device.create_buffer(&BufferDescriptor::new(u64::from(WIDTH * HEIGHT * 4)))?;
    let histogram = device.create_buffer(&BufferDescriptor::new(256 * 4))?;
    let format = TextureFormat::Rgba8Unorm;
    let image = device.create_texture(&TextureDescriptor::new_2d(WIDTH, HEIGHT, format))?;
    let buffer = |buffer: &estampe::Buffer| BindingResource::Buffer(buffer.slice(..));
    // A pipeline has the bind group layouts that its entry point uses.
    let group = |pipeline: &ComputePipeline, entries: &[(u32, BindingResource)]| {
        device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &pipeline.bind_group_layouts()[0],
            entries,
        })
    };
    let run = |pipeline: &ComputePipeline, group: BindGroup| {
        device.dispatch(&Dispatch {
            bind_groups: &[group],
            ..Dispatch::new(pipeline, [WIDTH.div_ceil(16), HEIGHT.div_ceil(4), 1])
        })
    };
    let count = pipeline("count")?;
    let counted = [(0, buffer(&steps)), (1, buffer(&histogram))];
    run(&count, group(&count, &counted)?)?;
    let paint = pipeline("paint")?;
    let painted = [
        (0, buffer(&steps)),
        (2, buffer(&histogram)),
        (3, BindingResource::Texture(image.view())),
    ];
    run(&paint, group(&paint, &painted)?)?;
    Ok(image)
}

fn main() -> Outcome<()> {
    let out = std::env::args().nth(1).unwrap_or("mandelbrot.png".into());
    let device = Device::new(&DeviceDescriptor::default())?;
    device.write_png(&picture(&device)?, out)?;
    Ok(())
}

#[cfg(test)]
#[path = "scene/kept.rs"]
mod kept;

#[test]
fn mandelbrot_draws_its_picture() {
    kept::check("mandelbrot", picture);
}
