//! Resolve targets hold the means of the samples, as shaders read these.

use crate::support::{Images, covering, texture};
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::MultisampleState;
use estampe::{
    BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType, ColorAttachment,
    Device, DeviceDescriptor, Draw, RenderPass, RenderPipelineDescriptor, SampleType, StoreOp,
    Texture, TextureBindings, TextureFormat, Vec2, Vec4, ViewDimension, srgb,
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

/// Copies one sample of each texel of binding 0.
struct OneSample(i32);

estampe::shader! {
    impl Shader for OneSample {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();
        const READS_POSITION: bool = true;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let at: Vec2<R> = covering(&input);
            VertexOut::new(Vec4::new(at.x, at.y, input.zero, input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let [x, y] = [input.position.x, input.position.y].map(|at| at.floor().to_int());
            let (zero, sample) = (x.splat(0), x.splat(self.0));
            let texture = input.bindings.texture(0, 0);
            FragmentOut::color(texture.fetch([x, y, zero], zero, sample))
        }
    }
}

/// The bytes of one sample of each texel.
fn sample_of(device: &Device, samples: &Texture, sample: i32) -> Vec<u8> {
    let layout = device
        .create_bind_group_layout(&[BindGroupLayoutEntry {
            binding: 0,
            ty: BindingType::Texture {
                sample_type: SampleType::Float,
                view_dimension: ViewDimension::D2,
                multisampled: true,
            },
        }])
        .unwrap();
    let group = device
        .create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[(0, BindingResource::Texture(samples.view()))],
        })
        .unwrap();
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor {
            bind_group_layouts: vec![layout],
            depth_stencil: None,
            targets: vec![samples.format().into()],
            ..RenderPipelineDescriptor::new(OneSample(sample))
        })
        .unwrap();
    let size = [samples.width(), samples.height()];
    let image = texture(device, size, samples.format());
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
            draws: &[Draw {
                bind_groups: std::slice::from_ref(&group),
                ..Draw::new(&pipeline, 0..3)
            }],
            ..RenderPass::default()
        })
        .unwrap();
    device.read_texture(&image).unwrap()
}

/// The mean of four codes as `docs/NUMERICS.md` defines it.
fn mean(codes: [u8; 4], is_srgb: bool) -> u8 {
    if is_srgb {
        let sum: f32 = codes
            .into_iter()
            .map(srgb::decode)
            .fold(0.0, |sum, v| sum + v);
        return srgb::encode(sum * 0.25);
    }
    let sum: u32 = codes.into_iter().map(u32::from).sum();
    u8::try_from((sum + 2) / 4).unwrap()
}

/// Rows: R6.
#[test]
fn a_resolve_target_holds_the_means_of_the_samples() {
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
            let pipeline = device
                .create_render_pipeline(&RenderPipelineDescriptor {
                    multisample: MultisampleState::new(4),
                    targets: vec![format.into()],
                    ..RenderPipelineDescriptor::new(Ramp)
                })
                .unwrap();
            for size in [[1, 1], [63, 65], [200, 130]] {
                let samples = Images::with(&device, size, format, 4);
                let image = texture(&device, size, format);
                let attachment = ColorAttachment {
                    resolve_target: Some(image.view()),
                    ..ColorAttachment::clear(&samples.color.view(), [0.0; 4])
                };
                let pass = |store| {
                    let attachment = ColorAttachment {
                        store,
                        ..attachment.clone()
                    };
                    let statistics = device
                        .render(&RenderPass {
                            color_attachments: &[Some(attachment)],
                            depth_stencil_attachment: Some(samples.cleared_depth()),
                            draws: &[Draw::new(&pipeline, 0..3)],
                            ..RenderPass::default()
                        })
                        .unwrap();
                    assert!(statistics.tiles_resolved > 0, "resolved after the pass");
                    let is_discarded = store == StoreOp::Discard;
                    assert_eq!(statistics.tiles_in_workers > 0, is_discarded);
                    let is_wide = cfg!(target_arch = "x86_64") && !device.level().is_scalar();
                    assert_eq!(statistics.tiles_streamed > 0, is_wide, "depths are stored");
                    device.read_texture(&image).unwrap()
                };
                let resolved = pass(StoreOp::Store);
                let four = [0, 1, 2, 3].map(|sample| sample_of(&device, &samples.color, sample));
                for (at, code) in resolved.iter().enumerate() {
                    let codes = four.each_ref().map(|bytes| bytes[at]);
                    let is_srgb = format.is_srgb() && at % 4 != 3;
                    assert_eq!(*code, mean(codes, is_srgb), "{format:?} {size:?} byte {at}");
                }
                // Some pixel is partly covered, so resolving changes something.
                assert!(size[0] == 1 || four[0] != four[3]);
                let colors = resolved.as_chunks::<4>().0;
                let shades: std::collections::BTreeSet<_> = colors.iter().collect();
                assert!(size[0] == 1 || shades.len() > 100, "{}", shades.len());
                // Samples that are discarded are resolved all the same, and then are zeros.
                assert!(pass(StoreOp::Discard) == resolved);
                let zeros = sample_of(&device, &samples.color, 3);
                assert!(zeros.iter().all(|byte| *byte == 0));
            }
        }
    }
}
