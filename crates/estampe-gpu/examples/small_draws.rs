//! Many small draws: 10,000 draws of one quad each, with one pipeline and one bind group, whose
//! dynamic offset finds 16 bytes per draw.
//!
//! `cargo run --release -p estampe-gpu --example small_draws -- [frames] [draws|instances]` prints
//! the time per quad before and in the tiles, on one thread. With `instances` the same quads are
//! the instances of a single draw. Under `valgrind --tool=callgrind` the difference between two
//! numbers of frames is the cost of a frame.

#![expect(clippy::print_stdout, reason = "the program prints what it measured")]

use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{VertexBufferLayout, VertexStepMode};
use estampe::{
    BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType,
    ColorAttachment, DepthStencilAttachment, Device, DeviceDescriptor, Draw, IndexFormat,
    RenderPass, RenderPipelineDescriptor, Statistics, TextureDescriptor, TextureFormat, Vec2, Vec4,
    VertexFormat, bytes_of,
};
use std::error::Error;

const QUADS: u32 = 10_000;

/// A quad whose position is in 16 bytes of its draw's bindings.
struct Placed;

estampe::shader! {
    impl Shader for Placed {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, Vec2<R>> {
            let [x, y, depth, scale] = input.bindings.f32s::<4>(0, 0, 0);
            let one = input.real(1.0);
            let position = Vec4::new(at.x * scale + x, at.y * scale + y, input.real(depth), one);
            VertexOut::new(position, at)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, at: Vec2<R>) -> FragmentOut<R> {
            let one = input.real(1.0);
            FragmentOut::color(Vec4::new(at.x, at.y, one, one))
        }
    }
}

/// A quad like that of [`Placed`], whose position is an attribute stepped by instance.
struct Instanced;

estampe::shader! {
    impl Shader for Instanced {
        type Attributes<R: Real> = (Vec2<R>, Vec4<R>);
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (at, place): (Vec2<R>, Vec4<R>),
        ) -> VertexOut<R, Vec2<R>> {
            let one = input.real(1.0);
            let position = Vec4::new(
                at.x * place.w + place.x,
                at.y * place.w + place.y,
                place.z,
                one,
            );
            VertexOut::new(position, at)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, at: Vec2<R>) -> FragmentOut<R> {
            let one = input.real(1.0);
            FragmentOut::color(Vec4::new(at.x, at.y, one, one))
        }
    }
}

/// The position of quad `number`: x, y, depth and scale. Neighbours in the list are far apart in
/// the window.
fn place(number: u32) -> [f32; 4] {
    let random = |salt: u32| {
        let hash = (number * 4 + salt).wrapping_mul(0x9E37_79B9);
        (hash ^ (hash >> 15)).wrapping_mul(0x85EB_CA6B) >> 8
    };
    let unit = |salt| random(salt) as f32 * (1.0 / 16_777_216.0);
    [unit(0) * 1.9 - 0.95, unit(1) * 1.9 - 0.95, unit(2), 0.008]
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let frames: u32 = arguments.next().map_or(Ok(200), |text| text.parse())?;
    let is_instanced = arguments.next().is_some_and(|text| text == "instances");
    let device = Device::new(&DeviceDescriptor {
        threads: 1,
        ..DeviceDescriptor::default()
    })?;
    let image = |format| device.create_texture(&TextureDescriptor::new_2d(1280, 720, format));
    let color = image(TextureFormat::Rgba8Unorm)?.view();
    let depth = image(TextureFormat::Depth32Float)?.view();
    let pass = RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&color, [0.0; 4]))],
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth, 1.0)),
        ..RenderPass::default()
    };
    let corners: [f32; 8] = [-1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0];
    let corners = device.create_buffer_with_contents(bytes_of(&corners))?;
    let indices: [u16; 6] = [0, 1, 2, 0, 2, 3];
    let indices = device.create_buffer_with_contents(bytes_of(&indices))?;
    let indices = indices.slice(..);
    let places: Vec<f32> = (0..QUADS).flat_map(place).collect();
    let places = device.create_buffer_with_contents(bytes_of(&places))?;
    let corner_layout = VertexBufferLayout::packed(&[VertexFormat::Float32x2]);
    let mut times = Statistics::default();
    if is_instanced {
        let mut place_layout = VertexBufferLayout::packed(&[VertexFormat::Float32x4]);
        place_layout.step_mode = VertexStepMode::Instance;
        place_layout.attributes[0].shader_location = 1;
        let mut descriptor = RenderPipelineDescriptor::new(Instanced);
        descriptor.vertex_buffers = vec![corner_layout, place_layout];
        let pipeline = device.create_render_pipeline(&descriptor)?;
        let draw = Draw {
            vertex_buffers: &[corners.slice(..), places.slice(..)],
            index_buffer: Some((&indices, IndexFormat::Uint16)),
            instances: 0..QUADS,
            ..Draw::new(&pipeline, 0..6)
        };
        for _ in 0..frames {
            times += device.render(&RenderPass {
                draws: std::slice::from_ref(&draw),
                ..pass.clone()
            })?;
        }
    } else {
        let layout = device.create_bind_group_layout(&[BindGroupLayoutEntry {
            binding: 0,
            ty: BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset: true,
                min_binding_size: 16,
            },
        }])?;
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[(0, BindingResource::Buffer(places.slice(..16)))],
        })?;
        let mut descriptor = RenderPipelineDescriptor::new(Placed);
        descriptor.bind_group_layouts = vec![layout];
        descriptor.vertex_buffers = vec![corner_layout];
        let pipeline = device.create_render_pipeline(&descriptor)?;
        let offsets: Vec<[u32; 1]> = (0..QUADS).map(|number| [number * 16]).collect();
        let groups = [group];
        let vertex_buffers = [corners.slice(..)];
        let draws = offsets.iter().map(|offsets| Draw {
            vertex_buffers: &vertex_buffers,
            index_buffer: Some((&indices, IndexFormat::Uint16)),
            bind_groups: &groups,
            dynamic_offsets: offsets,
            ..Draw::new(&pipeline, 0..6)
        });
        let draws: Vec<Draw<'_>> = draws.collect();
        for _ in 0..frames {
            times += device.render(&RenderPass {
                draws: &draws,
                ..pass.clone()
            })?;
        }
    }
    let quads = f64::from(QUADS) * f64::from(frames.max(1));
    println!(
        "geometry {:.0} ns, tiles {:.0} ns a quad; {} fragments a frame",
        times.geometry.as_secs_f64() * 1e9 / quads,
        times.raster.as_secs_f64() * 1e9 / quads,
        times.fragments_shaded / u64::from(frames.max(1)),
    );
    Ok(())
}
