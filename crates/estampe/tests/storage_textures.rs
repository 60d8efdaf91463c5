//! Fragment shaders that store to a texture: all covered fragments store, helper invocations do
//! not.

use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{DepthState, VertexBufferLayout};
use estampe::texture::{
    StorageTexture, TextureDescriptor, create_storage_texture, storage_bytes, storage_store,
};
use estampe::{
    Buffer, Device, DeviceDescriptor, Draw, Level, Limits, LoadOp, RenderPass,
    RenderPipelineDescriptor, RenderTargetDescriptor, TextureFormat, Vec2, Vec4, VertexFormat,
};
use std::sync::Arc;

const SIZE: [u32; 2] = [75, 41];

/// Writes a colour that depends on the position, to the target and to a texture.
struct Storing {
    texture: Arc<StorageTexture>,
    depth: f32,
}

estampe::shader! {
    impl Shader for Storing {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, ()> {
            let (depth, w) = (input.real(self.depth), input.real(1.0));
            VertexOut::new(Vec4::new(at.x, at.y, depth, w), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _nothing: ()) -> FragmentOut<R> {
            let (x, y) = (input.position.x, input.position.y);
            let color = Vec4::new(x / 128.0, y / 128.0, input.real(1.0), input.real(1.0));
            let at = [x.floor().to_int(), y.floor().to_int()];
            let slice = at[0].splat(0);
            storage_store(&self.texture, !input.is_helper, [at[0], at[1], slice], color);
            FragmentOut::color(color)
        }
    }
}

/// The contents of the target and of the texture after triangles at depth ½ were drawn into a
/// target cleared to `clear_depth`.
fn drawn(level: Level, threads: usize, clear_depth: f32) -> [Vec<u8>; 2] {
    let device = Device::new(&DeviceDescriptor {
        threads,
        level,
        ..DeviceDescriptor::default()
    });
    let device = device.expect("the system starts two threads");
    let [width, height] = SIZE;
    let format = TextureFormat::Rgba8Unorm;
    let descriptor = TextureDescriptor::new_2d(width, height, format);
    let texture = create_storage_texture(&descriptor, None, &Limits::default());
    let texture = Arc::new(texture.expect("it is small"));
    let mut descriptor = RenderPipelineDescriptor::new(Storing {
        texture: Arc::clone(&texture),
        depth: 0.5,
    });
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
    descriptor.depth = Some(DepthState::LESS_WRITE);
    let pipeline = device
        .create_render_pipeline(&descriptor)
        .expect("a valid pipeline");
    let corners = [
        -0.9, -0.8, 0.7, -0.5, -0.2, 0.9, // large
        0.8, 0.8, 0.81, 0.84, 0.85, 0.79, // of a pixel or two
    ];
    let buffers = [Buffer::from_f32s(&corners)];
    let draws = [Draw {
        vertex_buffers: &buffers,
        ..Draw::new(&pipeline, 0..6)
    }];
    let mut target = device
        .create_render_target(&RenderTargetDescriptor::new(width, height))
        .expect("it is small");
    let pass = RenderPass {
        load_depth: LoadOp::Clear(clear_depth),
        draws: &draws,
        ..RenderPass::default()
    };
    device.render(&mut target, &pass).expect("it fits");
    [target.read_color(0), storage_bytes(&texture)]
}

/// Rows: F2, O9.
#[test]
fn covered_fragments_store_even_if_invisible() {
    let [seen, _] = drawn(Level::best(), 1, 1.0);
    let white = |pixels: &[u8]| pixels.iter().filter(|&&byte| byte == 255).count();
    assert!(white(&seen) > 500);
    for level in Level::all_available() {
        for threads in [1, 2] {
            let [target, stored] = drawn(level, threads, 1.0);
            assert_eq!(target, seen, "{}", level.name());
            assert_eq!(stored, seen, "{}", level.name());
            // No fragment passes the depth test, but all are shaded.
            let [target, stored] = drawn(level, threads, 0.25);
            assert_eq!(white(&target), 0);
            assert_eq!(stored, seen, "{}", level.name());
        }
    }
}
