//! Attachments whose texels are not stored: they are zeros wherever they are read.

use crate::support::sampling::{FLAT, Turned, draw_over, sampled_group, sampling_pipeline};
use crate::support::{clear, device, devices, f32s, read_layer, texture};
use estampe::{
    AspectOperations, ColorAttachment, DepthStencilAttachment, LoadOp, RenderPass, StoreOp,
    TextureFormat,
};

#[test]
fn discarded_colors_are_zeros_wherever_they_are_read() {
    let white = [1.0; 4];
    for (name, device) in devices() {
        let format = TextureFormat::Rgba8Unorm;
        let image = texture(&device, [40, 21], format);
        let discard = || {
            let attachment = ColorAttachment {
                store: StoreOp::Discard,
                ..ColorAttachment::clear(&image.view(), white)
            };
            device
                .render(&RenderPass {
                    color_attachments: &[Some(attachment)],
                    ..RenderPass::default()
                })
                .unwrap();
        };
        let is_zero = |bytes: &[u8]| bytes.iter().all(|byte| *byte == 0);
        // By the host, at first and after it was white.
        discard();
        assert!(is_zero(&read_layer(&device, &image, 0, 0)), "{name}");
        clear(&device, &image.view(), white);
        assert!(!is_zero(&read_layer(&device, &image, 0, 0)), "{name}");
        discard();
        assert!(is_zero(&read_layer(&device, &image, 0, 0)), "{name}");
        // By a shader.
        clear(&device, &image.view(), white);
        discard();
        let target = texture(&device, [40, 21], format);
        clear(&device, &target.view(), white);
        let (layout, pipeline) = sampling_pipeline(&device, Turned, FLAT, format);
        draw_over(
            &device,
            &pipeline,
            &sampled_group(&device, &layout, &image.view()),
            &target.view(),
        );
        assert!(is_zero(&read_layer(&device, &target, 0, 0)), "{name}");
        // By a pass that loads.
        clear(&device, &image.view(), white);
        discard();
        device
            .render(&RenderPass {
                color_attachments: &[Some(ColorAttachment::load(&image.view()))],
                ..RenderPass::default()
            })
            .unwrap();
        assert!(is_zero(&read_layer(&device, &image, 0, 0)), "{name}");
    }
}

#[test]
fn depth_and_stencil_are_discarded_one_by_one() {
    let device = device();
    let format = TextureFormat::Depth32FloatStencil8;
    let image = texture(&device, [40, 21], format);
    let render = |depth: [StoreOp; 2]| {
        let [depth, stencil] = depth;
        device
            .render(&RenderPass {
                depth_stencil_attachment: Some(DepthStencilAttachment {
                    depth: AspectOperations::Write {
                        load: LoadOp::Clear(0.5),
                        store: depth,
                    },
                    stencil: AspectOperations::Write {
                        load: LoadOp::Clear(77),
                        store: stencil,
                    },
                    ..DepthStencilAttachment::load(&image.view())
                }),
                ..RenderPass::default()
            })
            .unwrap();
        let texels = read_layer(&device, &image, 0, 0);
        let texels = texels.as_chunks::<8>().0;
        assert!(texels.iter().all(|texel| *texel == texels[0]));
        (f32s(&texels[0][..4])[0], texels[0][4])
    };
    use StoreOp::{Discard, Store};
    assert_eq!(render([Store, Store]), (0.5, 77));
    assert_eq!(render([Discard, Store]), (0.0, 77));
    assert_eq!(render([Store, Discard]), (0.5, 0));
    assert_eq!(render([Discard, Discard]), (0.0, 0));
}
