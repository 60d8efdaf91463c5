//! Passes of a submission that are drawn side by side: they are at the same time in their middles,
//! and draw what they draw one after the other.

use crate::support::sampling::{FLAT, Turned, sampled_group, sampling_pipeline};
use crate::support::{covering, device_with, noise, texture};
use estampe::{
    BindGroup, ColorAttachment, Command, Device, Draw, FragmentIn, FragmentOut, RenderPass,
    RenderPipeline, RenderPipelineDescriptor, TexelCopyLayout, Texture, TextureFormat, Vec2, Vec4,
    VertexIn, VertexOut,
};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

/// The shaders that have begun, and a bell for each that does.
#[derive(Default)]
struct Meeting {
    /// False while pipelines are made, which run their shaders to learn what they do.
    is_open: AtomicBool,
    begun: Mutex<usize>,
    bell: Condvar,
}

/// Black, once two passes with this shader are drawn at the same time; red if they never are.
struct Meets(Arc<Meeting>);

estampe::shader! {
    impl Shader for Meets {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let at: Vec2<R> = covering(&input);
            VertexOut::new(Vec4::new(at.x, at.y, input.zero, input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let red = if self.0.meet() { 0.0 } else { 1.0 };
            FragmentOut::color(Vec4::new(input.real(red), input.zero, input.zero, input.real(1.0)))
        }
    }
}

impl Meeting {
    fn meet(&self) -> bool {
        if !self.is_open.load(Ordering::SeqCst) {
            return false;
        }
        let mut begun = self.begun.lock().unwrap();
        *begun += 1;
        self.bell.notify_all();
        let alone = |begun: &mut usize| *begun < 2;
        let waited = self
            .bell
            .wait_timeout_while(begun, Duration::from_secs(60), alone);
        *waited.unwrap().0 >= 2
    }
}

fn clear(into: &Texture) -> [Option<ColorAttachment>; 1] {
    [Some(ColorAttachment::clear(&into.view(), [0.0; 4]))]
}

#[test]
fn small_passes_without_common_textures_meet() {
    let device = device_with(2, estampe::Level::best());
    let meeting: Arc<Meeting> = Arc::default();
    let images = [(); 2].map(|()| texture(&device, [8, 8], TextureFormat::Rgba8Unorm));
    let pipelines = [(); 2].map(|()| {
        let descriptor = RenderPipelineDescriptor {
            depth_stencil: None,
            ..RenderPipelineDescriptor::new(Meets(Arc::clone(&meeting)))
        };
        device.create_render_pipeline(&descriptor).unwrap()
    });
    let attachments = images.each_ref().map(clear);
    let draws = pipelines
        .each_ref()
        .map(|pipeline| [Draw::new(pipeline, 0..3)]);
    let passes = [0, 1].map(|number| {
        Command::Render(RenderPass {
            color_attachments: &attachments[number],
            draws: &draws[number],
            ..RenderPass::default()
        })
    });
    meeting.is_open.store(true, Ordering::SeqCst);
    device.submit(&passes).unwrap();
    for image in &images {
        let bytes = device.read_texture(image).unwrap();
        assert!(bytes.chunks(4).all(|texel| texel == [0, 0, 0, 255]));
    }
}

/// Images, the groups that sample them, and the pipeline that does.
struct Objects {
    images: Vec<Texture>,
    groups: Vec<BindGroup>,
    pipeline: RenderPipeline,
}

impl Objects {
    fn new(device: &Device) -> Self {
        let format = TextureFormat::Rgba8Unorm;
        let (layout, pipeline) = sampling_pipeline(device, Turned, FLAT, format);
        // All but the last are small.
        let sizes = [[70, 40], [64, 64], [9, 5], [130, 66], [40, 200], [400, 300]];
        let images = (0..).zip(sizes).map(|(seed, size)| {
            let image = texture(device, size, format);
            let bytes = noise((size[0] * size[1] * 4) as usize, seed);
            let layout = TexelCopyLayout::default();
            let all = image.size();
            device.write_texture(&image, &bytes, &layout, all).unwrap();
            image
        });
        let images: Vec<Texture> = images.collect();
        let groups = images
            .iter()
            .map(|image| sampled_group(device, &layout, &image.view()));
        Self {
            groups: groups.collect(),
            images,
            pipeline,
        }
    }

    /// Runs `commands`, each of which samples one image and draws another, and gives all bytes.
    fn drawn(&self, device: &Device, commands: &[[usize; 2]], submits: bool) -> Vec<Vec<u8>> {
        let attachments: Vec<_> = self.images.iter().map(clear).collect();
        let draws: Vec<_> = (self.groups.iter())
            .map(|group| {
                [Draw {
                    bind_groups: std::slice::from_ref(group),
                    ..Draw::new(&self.pipeline, 0..3)
                }]
            })
            .collect();
        let passes = commands.iter().map(|&[from, into]| RenderPass {
            color_attachments: &attachments[into],
            draws: &draws[from],
            ..RenderPass::default()
        });
        if submits {
            let commands: Vec<_> = passes.map(Command::Render).collect();
            device.submit(&commands).unwrap();
        } else {
            for pass in passes {
                device.render(&pass).unwrap();
            }
        }
        let images = self.images.iter();
        images
            .map(|image| device.read_texture(image).unwrap())
            .collect()
    }
}

/// Random submissions of passes, of which many depend on others.
#[test]
fn submissions_draw_what_passes_draw_one_after_the_other() {
    let mut state = 5_u32;
    let mut random = |below: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 16) as usize % below
    };
    let alone = device_with(1, estampe::Level::best());
    let devices = [2, 3, 8].map(|threads| device_with(threads, estampe::Level::best()));
    let expecting = Objects::new(&alone);
    let objects = devices.each_ref().map(Objects::new);
    let mut independent = 0;
    for _ in 0..40 {
        let commands: Vec<[usize; 2]> = (0..1 + random(12))
            .map(|_| {
                let from = random(6);
                [from, (from + 1 + random(5)) % 6]
            })
            .collect();
        let pairs = commands.windows(2);
        independent += pairs
            .filter(|pair| {
                let ([a, b], [c, d]) = (pair[0], pair[1]);
                b != c && a != d && b != d && b < 5 && d < 5
            })
            .count();
        let expected = expecting.drawn(&alone, &commands, false);
        for (device, objects) in devices.iter().zip(&objects) {
            assert!(
                objects.drawn(device, &commands, true) == expected,
                "{commands:?}"
            );
        }
    }
    assert!(independent > 40, "{independent}");
}
