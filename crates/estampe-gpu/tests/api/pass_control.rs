//! Pools, passes side by side, cancelling, progress, and the limit of vertices.

use estampe::{
    ColorAttachment, Device, DeviceDescriptor, Draw, DrawError, FragmentIn, FragmentOut, Limits,
    PassControl, PassErrorKind, RenderPass, RenderPipeline, RenderPipelineDescriptor, Texture,
    TextureDescriptor, TextureFormat, ThreadPoolBuilder, Vec4, VertexIn, VertexOut,
};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

/// A triangle over the whole image whose colour varies.
struct Gradient;

estampe::shader! {
    impl Shader for Gradient {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = Vec4<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, Vec4<R>> {
            // All vertices but the first two are the third corner.
            let corner = input.vertex_index.min(input.vertex_index.splat(2));
            let x = (corner & corner.splat(1)).to_real() * 4.0 - 1.0;
            let y = 1.0 - (corner >> 1).to_real() * 4.0;
            let color = Vec4::new(x * 0.5, y * 0.25 + 0.5, input.real(0.3), input.real(1.0));
            VertexOut::new(Vec4::new(x, y, input.real(0.5), input.real(1.0)), color)
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
            FragmentOut::color(color)
        }
    }
}

fn device(threads: usize) -> Device {
    let descriptor = DeviceDescriptor {
        threads,
        ..DeviceDescriptor::default()
    };
    Device::new(&descriptor).unwrap()
}

fn pipeline(device: &Device) -> RenderPipeline {
    let descriptor = RenderPipelineDescriptor {
        depth_stencil: None,
        ..RenderPipelineDescriptor::new(Gradient)
    };
    device.create_render_pipeline(&descriptor).unwrap()
}

fn image(device: &Device) -> Texture {
    let descriptor = TextureDescriptor::new_2d(150, 90, TextureFormat::Rgba8Unorm);
    device.create_texture(&descriptor).unwrap()
}

fn draw_into(device: &Device, pipeline: &RenderPipeline, image: &Texture) -> Vec<u8> {
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
            draws: &[Draw::new(pipeline, 0..3)],
            ..RenderPass::default()
        })
        .unwrap();
    device.read_texture(image).unwrap()
}

#[test]
fn passes_of_several_threads_are_drawn_side_by_side() {
    for threads in [1, 3] {
        let device = device(threads);
        let pipeline = pipeline(&device);
        let expected = draw_into(&device, &pipeline, &image(&device));
        assert!(expected.iter().any(|&byte| byte != 0));
        std::thread::scope(|scope| {
            let workers: Vec<_> = (0..4)
                .map(|_| {
                    scope.spawn(|| {
                        let image = image(&device);
                        let drawn = (0..20).map(|_| draw_into(&device, &pipeline, &image));
                        drawn.filter(|drawn| *drawn == expected).count()
                    })
                })
                .collect();
            for worker in workers {
                assert_eq!(worker.join().unwrap(), 20);
            }
        });
    }
}

/// Two threads draw into one image and read it: each sees a whole picture.
#[test]
fn passes_that_share_an_image_wait_for_each_other() {
    let device = device(2);
    let (pipeline, image) = (pipeline(&device), image(&device));
    let expected = draw_into(&device, &pipeline, &image);
    std::thread::scope(|scope| {
        for _ in 0..3 {
            scope.spawn(|| {
                for _ in 0..20 {
                    assert!(draw_into(&device, &pipeline, &image) == expected);
                }
            });
        }
    });
}

#[test]
fn a_pool_is_shared_by_devices() {
    let pool = Arc::new(ThreadPoolBuilder::new().num_threads(2).build().unwrap());
    let expected = {
        let device = device(1);
        draw_into(&device, &pipeline(&device), &image(&device))
    };
    let on_pool = || {
        let descriptor = DeviceDescriptor {
            pool: Some(Arc::clone(&pool)),
            ..DeviceDescriptor::default()
        };
        Device::new(&descriptor).unwrap()
    };
    let devices = [on_pool(), on_pool()];
    for device in &devices {
        assert_eq!(device.threads(), 3);
        let drawn = draw_into(device, &pipeline(device), &image(device));
        assert!(drawn == expected);
        // From a thread of the pool, too.
        let drawn = pool.install(|| draw_into(device, &pipeline(device), &image(device)));
        assert!(drawn == expected);
    }
}

/// A pass of several batches ends when its progress asks for it, and the device goes on.
#[test]
fn a_pass_is_cancelled_between_batches() {
    let device = device(2);
    let (pipeline, image) = (pipeline(&device), image(&device));
    let expected = draw_into(&device, &pipeline, &image);
    // Each draw is more than a batch: 900,000 triangles.
    let draws = vec![Draw::new(&pipeline, 0..2_700_000); 4];
    let (cancel, calls) = (AtomicBool::new(false), AtomicUsize::new(0));
    let seen = Mutex::new(Vec::new());
    let progress = |begun: usize, all: usize| {
        calls.fetch_add(1, Ordering::Relaxed);
        seen.lock().unwrap().push([begun, all]);
        cancel.store(begun >= 2, Ordering::Relaxed);
    };
    let error = device
        .render(&RenderPass {
            label: Some("endless"),
            color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
            control: PassControl {
                cancel: Some(&cancel),
                progress: Some(&progress),
            },
            draws: &draws,
            ..RenderPass::default()
        })
        .unwrap_err();
    assert_eq!(error.kind, PassErrorKind::Draw(DrawError::Cancelled));
    assert!(
        error
            .to_string()
            .contains("the pass `endless`: the pass was cancelled")
    );
    let seen = seen.into_inner().unwrap();
    let begun = seen.iter().map(|[begun, _]| *begun);
    assert!(
        begun.clone().is_sorted() && begun.max() < Some(4),
        "{seen:?}"
    );
    assert!(seen.iter().all(|[_, all]| *all == 4));
    assert!(draw_into(&device, &pipeline, &image) == expected);
}

#[test]
fn the_vertices_of_a_pass_are_limited() {
    let descriptor = DeviceDescriptor {
        threads: 1,
        limits: Limits {
            max_pass_vertices: 12,
            ..Limits::default()
        },
        ..DeviceDescriptor::default()
    };
    let device = Device::new(&descriptor).unwrap();
    let (pipeline, image) = (pipeline(&device), image(&device));
    let draw = |elements: u32, instances: u32| Draw {
        instances: 0..instances,
        ..Draw::new(&pipeline, 0..elements)
    };
    let render = |draws: &[Draw<'_>]| {
        device.render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
            draws,
            ..RenderPass::default()
        })
    };
    assert!(render(&[draw(3, 2), draw(6, 1)]).is_ok());
    let error = render(&[draw(3, 2), draw(6, 1), draw(1, 1)]).unwrap_err();
    let expected = PassErrorKind::TooManyVertices {
        draw: 2,
        vertices: 13,
        limit: 12,
    };
    assert_eq!(error.kind, expected);
    let error = render(&[draw(u32::MAX, u32::MAX)]).unwrap_err();
    assert!(matches!(
        error.kind,
        PassErrorKind::TooManyVertices { draw: 0, .. }
    ));
}
