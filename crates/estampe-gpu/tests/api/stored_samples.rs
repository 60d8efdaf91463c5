//! Samples that go to memory tile by tile are those that are drawn where they lie.

use crate::support::{covering, devices};
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{
    DepthStencilState, MultisampleState, StencilFaceState, StencilOperation, StencilState,
};
use estampe::{
    AspectOperations, ColorAttachment, DepthStencilAttachment, Device, Draw, LoadOp, RenderPass,
    RenderPipelineDescriptor, Statistics, StoreOp, Texture, TextureAspect, TextureDescriptor,
    TextureFormat, TextureViewDescriptor, Vec2, Vec4,
};

/// A triangle that slopes, alone, in two colours.
struct Slope;

estampe::shader! {
    impl Shader for Slope {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let at: Vec2<R> = covering(&input);
            let depth = at.x * 0.11 + at.y * 0.02 + 0.52;
            VertexOut::new(Vec4::new(at.x - 0.3, at.y - 0.2, depth, input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let (one, half) = (input.real(1.0), input.real(0.5));
            FragmentOut::color(Vec4::new(one, half, half, one))
                .with_color(1, Vec4::new(half, one, half * half, half))
        }
    }
}

const COLORS: [TextureFormat; 2] = [TextureFormat::Rgba8Unorm, TextureFormat::Rgba16Float];
const DEPTH: TextureFormat = TextureFormat::Depth32FloatStencil8;

/// What the pipeline draws into.
struct Samples {
    colors: [Texture; 2],
    depth: Texture,
}

impl Samples {
    fn new(device: &Device, [width, height]: [u32; 2], sample_count: u32) -> Self {
        let create = |format| {
            let descriptor = TextureDescriptor {
                sample_count,
                ..TextureDescriptor::new_2d(width, height, format)
            };
            device.create_texture(&descriptor).unwrap()
        };
        Self {
            colors: COLORS.map(create),
            depth: create(DEPTH),
        }
    }

    /// Draws; each attachment is cleared first or not, the colours and then depth and stencil.
    fn draw(&self, device: &Device, clears: [bool; 3], draws: &[Draw<'_>]) -> Statistics {
        let [first, second] = self.colors.each_ref().map(Texture::view);
        let color = |view, clears| match clears {
            true => Some(ColorAttachment::clear(view, [0.25, 0.5, 0.75, 0.125])),
            false => Some(ColorAttachment::load(view)),
        };
        let loads = match clears[2] {
            true => (LoadOp::Clear(0.625), LoadOp::Clear(0x5A)),
            false => (LoadOp::Load, LoadOp::Load),
        };
        let pass = RenderPass {
            color_attachments: &[color(&first, clears[0]), color(&second, clears[1])],
            depth_stencil_attachment: Some(DepthStencilAttachment {
                depth: AspectOperations::Write {
                    load: loads.0,
                    store: StoreOp::Store,
                },
                stencil: AspectOperations::Write {
                    load: loads.1,
                    store: StoreOp::Store,
                },
                ..DepthStencilAttachment::load(&self.depth.view())
            }),
            draws,
            ..RenderPass::default()
        };
        device.render(&pass).unwrap()
    }

    /// The bytes of all samples of all attachments.
    fn bytes(&self, device: &Device, count: u32) -> Vec<Vec<u8>> {
        let aspect = |aspect| {
            let view = self.depth.create_view(&TextureViewDescriptor {
                aspect,
                ..TextureViewDescriptor::default()
            });
            view.unwrap()
        };
        let [first, second] = self.colors.each_ref().map(Texture::view);
        let views = [
            first,
            second,
            aspect(TextureAspect::Depth),
            aspect(TextureAspect::Stencil),
        ];
        let samples = views
            .iter()
            .flat_map(|view| (0..count).map(move |sample| (view, sample)));
        samples
            .map(|(view, sample)| device.read_sample(view, sample).unwrap())
            .collect()
    }
}

#[test]
fn samples_are_stored_wherever_they_were_drawn() {
    for (name, device) in devices() {
        for (count, size) in [(2, [70, 45]), (4, [200, 130]), (8, [33, 64]), (16, [40, 9])] {
            let what = format!("{name}, {count} samples");
            let mut descriptor = RenderPipelineDescriptor::new(Slope);
            descriptor.multisample = MultisampleState::new(count);
            descriptor.targets = COLORS.map(Into::into).to_vec();
            let increments = StencilFaceState {
                pass_op: StencilOperation::IncrementClamp,
                ..StencilFaceState::default()
            };
            descriptor.depth_stencil = Some(DepthStencilState {
                stencil: Some(StencilState {
                    front: increments,
                    back: increments,
                }),
                ..DepthStencilState::LESS_WRITE
            });
            let pipeline = device.create_render_pipeline(&descriptor).unwrap();
            let draws = [Draw::new(&pipeline, 0..3)];
            // Drawn where they lie, as they were cleared by a pass before.
            let expected = Samples::new(&device, size, count);
            expected.draw(&device, [true; 3], &[]);
            let statistics = expected.draw(&device, [false; 3], &draws);
            assert_eq!(statistics.tiles_streamed, 0, "{what}");
            let expected = expected.bytes(&device, count);
            for samples in expected.chunks(count as usize) {
                assert!(
                    samples[0] != samples[1],
                    "an edge, {what}, {}",
                    samples[0].len()
                );
            }
            let is_wide = cfg!(target_arch = "x86_64") && !device.level().is_scalar();
            for cleared in 0..8_u8 {
                let clears = [1, 2, 4].map(|bit| cleared & bit != 0);
                let samples = Samples::new(&device, size, count);
                // What is not cleared with the draws is before.
                samples.draw(&device, [true; 3], &[]);
                let statistics = samples.draw(&device, clears, &draws);
                assert_eq!(
                    statistics.tiles_streamed > 0,
                    is_wide && cleared != 0,
                    "{what}, {clears:?}"
                );
                assert!(
                    samples.bytes(&device, count) == expected,
                    "{what}, {clears:?}"
                );
            }
        }
    }
}
