//! Many small draws: 10,000 draws of one quad each, with one pipeline and 16 bytes of bindings per
//! draw.
//!
//! `cargo run --release -p estampe --example small_draws -- [frames] [draws|instances]` prints the
//! time per quad before and in the tiles, on one thread. With `instances` the same quads are the
//! instances of a single draw. Under `valgrind --tool=callgrind` the difference between two numbers
//! of frames is the cost of a frame.

#![expect(clippy::print_stdout, reason = "the program prints what it measured")]

use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{VertexBufferLayout, VertexStepMode};
use estampe::{
    BindGroup, Binding, Bindings, Buffer, Device, DeviceDescriptor, Draw, IndexFormat, RenderPass,
    RenderPipelineDescriptor, RenderTargetDescriptor, Statistics, Vec2, Vec4, VertexFormat,
};
use std::error::Error;
use std::sync::Arc;

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
    let mut target = device.create_render_target(&RenderTargetDescriptor::new(1280, 720))?;
    let corners = Buffer::from_f32s(&[-1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0]);
    let indices = Buffer::from_bytes(&[0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0]);
    let places: Vec<f32> = (0..QUADS).flat_map(place).collect();
    let places = Buffer::from_f32s(&places);
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
            vertex_buffers: &[corners, places],
            indices: Some((&indices, IndexFormat::Uint16)),
            instances: 0..QUADS,
            ..Draw::new(&pipeline, 0..6)
        };
        for _ in 0..frames {
            let draws = std::slice::from_ref(&draw);
            let pass = RenderPass {
                draws,
                ..RenderPass::default()
            };
            times += device.render(&mut target, &pass)?;
        }
    } else {
        let mut descriptor = RenderPipelineDescriptor::new(Placed);
        descriptor.vertex_buffers = vec![corner_layout];
        let pipeline = device.create_render_pipeline(&descriptor)?;
        let binding = Binding::Buffer {
            buffer: places,
            offset: 0,
            has_dynamic_offset: true,
        };
        let group = Arc::new(BindGroup {
            entries: vec![(0, binding)],
        });
        let bindings = |number| Bindings {
            groups: vec![(Arc::clone(&group), number * 16)],
        };
        let bindings: Vec<Bindings> = (0..QUADS).map(bindings).collect();
        let vertex_buffers = [corners];
        let draw = |bindings| Draw {
            vertex_buffers: &vertex_buffers,
            indices: Some((&indices, IndexFormat::Uint16)),
            bindings: Some(bindings),
            ..Draw::new(&pipeline, 0..6)
        };
        let draws: Vec<Draw<'_>> = bindings.iter().map(draw).collect();
        for _ in 0..frames {
            let pass = RenderPass {
                draws: &draws,
                ..RenderPass::default()
            };
            times += device.render(&mut target, &pass)?;
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
