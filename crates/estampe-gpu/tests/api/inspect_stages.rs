//! Any stage can be inspected, also of passes whose shaders store, and within a limit of memory.

use crate::support::{device_with, texture};
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::VertexBufferLayout;
use estampe::{
    BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType, ColorAttachment,
    Device, DeviceDescriptor, Draw, InspectError, Level, PassStages, RenderPass,
    RenderPipelineDescriptor, TextureDescriptor, TextureFormat, Vec2, Vec4, VertexFormat,
    ViewDimension, bytes_of, storage_load, storage_store,
};

const SIZE: [u32; 2] = [75, 141];

/// Discards where a fragment has stored before, and stores 1.
struct Once;

estampe::shader! {
    impl Shader for Once {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = ();
        const STORES: bool = true;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, ()> {
            let (half, one) = (input.real(0.5), input.real(1.0));
            VertexOut::new(Vec4::new(at.x, at.y, half, one), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _nothing: ()) -> FragmentOut<R> {
            let (zero, one) = (input.real(0.0), input.real(1.0));
            let (x, y) = (input.position.x.floor(), input.position.y.floor());
            let at = [x.to_int(), y.to_int(), zero.to_int()];
            let mut before = zero;
            if let Some(texture) = input.bindings.storage_texture(0, 1) {
                before = storage_load(texture, at).x;
                let all = Vec4::new(one, one, one, one);
                storage_store(texture, !input.is_helper, at, all);
            }
            FragmentOut::color(Vec4::new(one, zero, zero, one)).discard_unless(before.le(zero))
        }
    }
}

/// The stages of a pass that draws two triangles, whose boxes share some tiles, twice each; and the
/// texture that was stored to, afterwards.
fn stages(threads: usize) -> (PassStages, Vec<u8>) {
    let device = device_with(threads, Level::best());
    let format = TextureFormat::Rgba8Unorm;
    let stored = texture(&device, SIZE, format);
    let ty = BindingType::StorageTexture {
        format,
        view_dimension: ViewDimension::D2,
    };
    let layout = device.create_bind_group_layout(&[BindGroupLayoutEntry { binding: 1, ty }]);
    let layout = layout.expect("a valid layout");
    let group = device
        .create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[(1, BindingResource::Texture(stored.view()))],
        })
        .expect("it has the layout");
    let mut descriptor = RenderPipelineDescriptor::new(Once);
    descriptor.bind_group_layouts = vec![layout];
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
    descriptor.depth_stencil = None;
    let pipeline = device.create_render_pipeline(&descriptor);
    let pipeline = pipeline.expect("a valid pipeline");
    let corners: [f32; 12] = [
        -0.9, -0.8, 0.7, -0.5, -0.2, 0.9, //
        -0.9, 0.9, 0.9, 0.9, 0.9, -0.9,
    ];
    let buffer = device.create_buffer_with_contents(bytes_of(&corners));
    let buffers = [buffer.expect("it is small").slice(..)];
    let draw = || Draw {
        vertex_buffers: &buffers,
        bind_groups: std::slice::from_ref(&group),
        ..Draw::new(&pipeline, 0..6)
    };
    let color = texture(&device, SIZE, format);
    let pass = RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&color.view(), [0.0; 4]))],
        draws: &[draw(), draw()],
        ..RenderPass::default()
    };
    let stages = device.inspect_stages(&pass).expect("it fits");
    (
        stages,
        device.read_texture(&stored).expect("it can be read"),
    )
}

/// Rows: U2.
#[test]
fn shaders_that_store_are_run_in_order_and_store_nothing() {
    let (of_one, stored) = stages(1);
    assert!(stored.iter().all(|&byte| byte == 0));
    assert_eq!(stages(3), (of_one.clone(), stored));
    assert_eq!((of_one.vertices.len(), of_one.primitives.len()), (12, 4));
    let mut twice = 0;
    for pixel in &of_one.pixels {
        // The first fragment is stored, and all others are discarded.
        assert_eq!(pixel.stored, u32::from(pixel.covered > 0));
        assert_eq!(pixel.discarded, pixel.covered.saturating_sub(1));
        let first = pixel.visible.map(|piece| piece < 2);
        assert_eq!(first, (pixel.covered > 0).then_some(true));
        twice += u32::from(pixel.covered == 4);
    }
    assert!(twice > 500, "{twice} pixels in both triangles");
}

/// Rows: U2.
#[test]
fn pictures_that_need_too_much_memory_are_refused() {
    let device = Device::new(&DeviceDescriptor::default()).expect("the system starts threads");
    let format = TextureFormat::Rgba8Unorm;
    let large = device.create_texture(&TextureDescriptor::new_2d(8192, 8192, format));
    let large = large.expect("within the limits");
    let refused = device.inspect_stages(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&large.view(), [0.0; 4]))],
        ..RenderPass::default()
    });
    let Err(error @ InspectError::TooLarge { bytes, limit }) = refused else {
        panic!("{refused:?}");
    };
    assert!(bytes > limit && error.to_string().contains("smaller picture"));
}
