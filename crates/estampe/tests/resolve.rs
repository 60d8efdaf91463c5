//! Resolving gives the same image as reading the samples back, and targets that do not fit are
//! refused.

use estampe::{
    Device, DeviceDescriptor, Draw, FragmentIn, FragmentOut, RenderPipelineDescriptor,
    RenderTarget, RenderTargetDescriptor, TextureFormat, Vec4, VertexIn, VertexOut,
};

/// One triangle across the target, its colour by vertex.
struct Ramp;

estampe::shader! {
    impl Shader for Ramp {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = Vec4<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, Vec4<R>> {
            let index = input.vertex_index.to_real();
            let (one, zero) = (input.real(1.0), input.zero);
            let x = R::select(index.eq(one), input.real(0.9), input.real(-0.8));
            let y = R::select(index.eq(zero), input.real(0.95), input.real(-0.7));
            let color = Vec4::new(index * 0.5, one - index * 0.4, index * 0.3, one - index * 0.2);
            VertexOut::new(Vec4::new(x, y, input.real(0.5), one), color)
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
            FragmentOut::color(color)
        }
    }
}

fn descriptor(samples: u32, format: TextureFormat, size: (u32, u32)) -> RenderTargetDescriptor {
    RenderTargetDescriptor {
        samples,
        color_formats: vec![format],
        ..RenderTargetDescriptor::new(size.0, size.1)
    }
}

fn drawn(device: &Device, format: TextureFormat, size: (u32, u32)) -> RenderTarget {
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor {
            samples: 4,
            targets: vec![format.into()],
            ..RenderPipelineDescriptor::new(Ramp)
        })
        .unwrap();
    let mut target = device
        .create_render_target(&descriptor(4, format, size))
        .unwrap();
    device
        .draw(&mut target, &[Draw::new(&pipeline, 0..3)])
        .unwrap();
    target
}

/// Rows: R6.
#[test]
fn a_resolved_picture_is_the_one_that_is_read_back() {
    for threads in [1, 2, 7] {
        let device = Device::new(&DeviceDescriptor {
            threads,
            ..DeviceDescriptor::default()
        })
        .unwrap();
        for format in [
            TextureFormat::Rgba8Unorm,
            TextureFormat::Rgba8UnormSrgb,
            TextureFormat::Bgra8Unorm,
            TextureFormat::Bgra8UnormSrgb,
        ] {
            for size in [(1, 1), (63, 65), (200, 130)] {
                let samples = drawn(&device, format, size);
                let mut image = device
                    .create_render_target(&descriptor(1, format, size))
                    .unwrap();
                device.resolve(&samples, &mut image).unwrap();
                let expected = samples.read_color(0);
                assert!(image.read_color(0) == expected, "{format:?} {size:?}");
                assert!(
                    device.read_color(&samples, 0) == expected,
                    "{format:?} {size:?}"
                );
                let mut memory = vec![0xA5; image.color_len_bytes(0)];
                device.read_color_into(&image, 0, &mut memory).unwrap();
                assert!(memory == expected, "{format:?} {size:?}");
                // Some pixel is partly covered, so resolving changes something.
                let colors = expected.as_chunks::<4>().0;
                let shades: std::collections::BTreeSet<_> = colors.iter().collect();
                assert!(size.0 == 1 || shades.len() > 100, "{}", shades.len());
            }
        }
    }
}

#[test]
fn targets_that_do_not_fit_are_an_error() {
    let device = Device::new(&DeviceDescriptor::default()).unwrap();
    let unorm = TextureFormat::Rgba8Unorm;
    let samples = drawn(&device, unorm, (70, 40));
    let without_colors = RenderTargetDescriptor {
        color_formats: Vec::new(),
        ..descriptor(1, unorm, (70, 40))
    };
    for (other, message) in [
        (
            descriptor(1, unorm, (70, 41)),
            "resolving a target of 70x40 pixels into one of 70x41: they must have the same size",
        ),
        (
            descriptor(1, TextureFormat::Rgba8UnormSrgb, (70, 40)),
            "resolving the colour formats [rgba8unorm] into [rgba8unorm-srgb]: they must be the same",
        ),
        (
            descriptor(4, unorm, (70, 40)),
            "resolving a target of 4 samples into one of 4: the source must have several samples \
             and the destination one",
        ),
        (
            without_colors,
            "resolving the colour formats [rgba8unorm] into []: they must be the same",
        ),
    ] {
        let mut image = device.create_render_target(&other).unwrap();
        let before = image.read_color(0);
        let error = device.resolve(&samples, &mut image).unwrap_err();
        assert_eq!(error.to_string(), message);
        assert!(image.read_color(0) == before, "{other:?}");
    }
}
