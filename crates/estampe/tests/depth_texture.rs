//! A depth attachment as a texture: the same depths, without a copy, and immutable.

use estampe::{
    DepthTexture, Device, DeviceDescriptor, Draw, FragmentIn, FragmentOut,
    RenderPipelineDescriptor, RenderTarget, RenderTargetDescriptor, Vec4, VertexIn, VertexOut,
};

/// A triangle that slopes towards the viewer, depth only.
struct Slope;

estampe::shader! {
    impl Shader for Slope {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let index = input.vertex_index.to_real();
            let (one, zero) = (input.real(1.0), input.zero);
            let x = R::select(index.eq(one), input.real(0.9), input.real(-0.8));
            let y = R::select(index.eq(zero), input.real(0.95), input.real(-0.7));
            VertexOut::new(Vec4::new(x, y, index * 0.4 + 0.1, one), ())
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::none()
        }
    }
}

const SIZE: (u32, u32) = (200, 130);

fn depth_only() -> RenderTargetDescriptor {
    RenderTargetDescriptor {
        color_formats: Vec::new(),
        ..RenderTargetDescriptor::new(SIZE.0, SIZE.1)
    }
}

fn draw(device: &Device, target: &mut RenderTarget) {
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor {
            targets: Vec::new(),
            ..RenderPipelineDescriptor::new(Slope)
        })
        .unwrap();
    device.draw(target, &[Draw::new(&pipeline, 0..3)]).unwrap();
}

fn rows(texture: &DepthTexture) -> Vec<f32> {
    let (width, height) = (texture.width(), texture.height());
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    texels.map(|(x, y)| texture.texel(x, y)).collect()
}

#[test]
fn the_texture_holds_the_depths_and_bounds_them() {
    for threads in [1, 2, 7] {
        let device = Device::new(&DeviceDescriptor {
            threads,
            ..DeviceDescriptor::default()
        })
        .unwrap();
        let mut target = device.create_render_target(&depth_only()).unwrap();
        draw(&device, &mut target);
        let texture = device.depth_texture(&mut target).unwrap();
        assert_eq!((texture.width(), texture.height()), SIZE);
        let depths = target.read_depth();
        assert!(rows(&texture) == depths);
        assert!(depths.iter().filter(|depth| **depth < 1.0).count() > 5000);
        let stride = DepthTexture::bounds_stride(SIZE.0);
        for (index, depth) in depths.iter().enumerate() {
            let (x, y) = (index % SIZE.0 as usize, index / SIZE.0 as usize);
            let word = texture.bounds()[y / 4 * stride + x / 4];
            let scaled = depth * DepthTexture::BOUND_SCALE;
            assert!((word & 0xFFFF) as f32 <= scaled && (word >> 16) as f32 >= scaled);
        }
        // The same image from rows; the bounds differ only where packets extend beyond the image.
        let brought = DepthTexture::from_rows(SIZE.0, SIZE.1, &depths);
        assert!(rows(&brought) == depths);
        assert_eq!(brought.bounds()[..32], texture.bounds()[..32]);
    }
}

#[test]
fn a_texture_outlives_its_target_and_is_not_drawn_over() {
    let device = Device::new(&DeviceDescriptor::default()).unwrap();
    let mut target = device.create_render_target(&depth_only()).unwrap();
    let cleared = device.depth_texture(&mut target).unwrap();
    let before = rows(&cleared);
    draw(&device, &mut target);
    assert!(rows(&cleared) == before);
    let drawn = device.depth_texture(&mut target).unwrap();
    assert!(rows(&drawn) != before);
    drop((cleared, target));
    assert!(rows(&drawn) != before);
}

#[test]
fn there_is_no_texture_without_depth_or_with_several_samples() {
    let device = Device::new(&DeviceDescriptor::default()).unwrap();
    for descriptor in [
        RenderTargetDescriptor {
            depth_stencil: None,
            ..RenderTargetDescriptor::new(8, 8)
        },
        RenderTargetDescriptor {
            samples: 4,
            ..depth_only()
        },
    ] {
        let mut target = device.create_render_target(&descriptor).unwrap();
        assert!(device.depth_texture(&mut target).is_none());
    }
}
