//! Every error of attachments and draws: its message names what does not fit, and both sides.

use crate::support::binding::{DYNAMIC, SAMPLED, UNIFORM, entry, material};
use crate::support::{Fill, device, labelled, limited, samples, texture};
use estampe::{
    AspectOperations, BindGroup, BindingResource, BufferDescriptor, ColorAttachment,
    DepthStencilAttachment, DepthStencilResolve, Device, Draw, IndexFormat, Limits, PassErrorKind,
    PassExtent, RenderPass, RenderPipelineDescriptor, ResolveMode, SamplerDescriptor, Texture,
    TextureDescriptor, TextureFormat, TextureUsages,
};

/// The error of a pass, whose message begins with its name.
fn refused_pass(device: &Device, pass: RenderPass<'_>) -> (PassErrorKind, String) {
    let error = device.render(&pass).expect_err("it is refused");
    let message = error.to_string();
    let message = message
        .strip_prefix("the pass: ")
        .expect("its name")
        .to_owned();
    (error.kind, message)
}

macro_rules! refused_pass {
    ($device:expr, $pass:expr, $variant:pat, $message:expr) => {{
        let (kind, message) = refused_pass($device, $pass);
        assert!(matches!(kind, $variant), "{kind:?}");
        assert_eq!(message, $message);
    }};
}

#[test]
fn attachments() {
    use PassErrorKind as E;
    let device = limited(Limits {
        max_color_attachments: 2,
        max_texture_dimension_2d: 100,
        ..Limits::default()
    });
    let pass = RenderPass::default;
    refused_pass!(
        &device,
        pass(),
        E::NoExtent,
        "it has no attachment: give it one, or set `extent`"
    );
    let extent = |width, samples| RenderPass {
        extent: Some(PassExtent {
            width,
            height: 7,
            samples,
        }),
        ..pass()
    };
    for (width, samples) in [(0, 1), (101, 1), (8, 3)] {
        refused_pass!(
            &device,
            extent(width, samples),
            E::Extent { .. },
            format!(
                "it has {width}x7 pixels of {samples} samples: 1 to 100, and 1, 2, 4, 8 or 16 \
                 samples"
            )
        );
    }
    let load = |texture: &Texture| Some(ColorAttachment::load(&texture.view()));
    let rgba = || texture(&device, [8, 4], TextureFormat::Rgba8Unorm);
    refused_pass!(
        &device,
        RenderPass {
            color_attachments: &[load(&rgba()), load(&rgba()), load(&rgba())],
            ..pass()
        },
        E::TooManyColors { .. },
        "3 colour attachments; the limit max_color_attachments is 2"
    );
    let levels = TextureDescriptor::new_2d(8, 4, TextureFormat::Rgba8Unorm).with_all_levels();
    let levels = device.create_texture(&levels).unwrap();
    refused_pass!(
        &device,
        RenderPass {
            color_attachments: &[load(&levels)],
            ..pass()
        },
        E::NotAnImage { .. },
        "colour attachment 0 is a view of 4 mip levels and 1 layers: render to a view of one level \
         (`Texture::image`), of a 3D texture with `depth_slice`"
    );
    refused_pass!(
        &device,
        RenderPass {
            color_attachments: &[load(&rgba())],
            depth_stencil_attachment: Some(DepthStencilAttachment::load(
                &texture(&device, [8, 5], TextureFormat::Depth16Unorm).view()
            )),
            ..pass()
        },
        E::Size { .. },
        "the depth-stencil attachment has 8x5 pixels of 1 samples, and the pass 8x4 of 1: all \
         attachments agree"
    );
    refused_pass!(
        &device,
        RenderPass {
            color_attachments: &[load(&texture(&device, [8, 4], TextureFormat::Bc1RgbaUnorm))],
            ..pass()
        },
        E::Format { .. },
        "colour attachment 0 has the format bc1-rgba-unorm: colours cannot be rendered to depth, \
         stencil and compressed formats and rgb9e5ufloat"
    );
    refused_pass!(
        &device,
        RenderPass {
            depth_stencil_attachment: Some(DepthStencilAttachment::load(&rgba().view())),
            ..pass()
        },
        E::Format { .. },
        "the depth-stencil attachment has the format rgba8unorm: it holds neither depth nor stencil"
    );
    let twice = rgba();
    refused_pass!(
        &device,
        RenderPass {
            color_attachments: &[load(&twice), load(&twice)],
            ..pass()
        },
        E::UsedTwice { .. },
        "colour attachment 0 and colour attachment 1 are the same image: a pass cannot use an image \
         that it writes twice"
    );
    let unused = labelled(&device, "grass", TextureUsages::COPY_SRC);
    refused_pass!(
        &device,
        RenderPass {
            color_attachments: &[None, load(&unused)],
            ..pass()
        },
        E::Texture { .. },
        "colour attachment 1: the texture `grass` was created without \
         TextureUsages::RENDER_ATTACHMENT: add it to its usage"
    );
}

#[test]
fn resolves() {
    let device = device();
    let color = |samples: &Texture, target: &Texture| {
        let attachment = ColorAttachment {
            resolve_target: Some(target.view()),
            ..ColorAttachment::load(&samples.view())
        };
        let pass = RenderPass {
            color_attachments: &[Some(attachment)],
            ..RenderPass::default()
        };
        refused_pass(&device, pass)
    };
    let one = |size, format| texture(&device, size, format);
    let unorm = TextureFormat::Rgba8Unorm;
    let four = samples(&device, unorm);
    let srgb = TextureFormat::Rgba8UnormSrgb;
    for (from, into, rule) in [
        (
            one([8, 4], unorm),
            one([8, 4], unorm),
            "is not needed: the attachment has one sample",
        ),
        (
            four.clone(),
            samples(&device, unorm),
            "has several samples: it must have one",
        ),
        (
            four.clone(),
            one([8, 5], unorm),
            "has another size: it must have that of the attachment",
        ),
        (
            four.clone(),
            one([8, 4], srgb),
            "has another format: it must have that of the attachment",
        ),
    ] {
        let (kind, message) = color(&from, &into);
        assert!(matches!(kind, PassErrorKind::Resolve { .. }));
        assert_eq!(
            message,
            format!("the resolve target of colour attachment 0 {rule}")
        );
    }
    let format = TextureFormat::Depth24PlusStencil8;
    let attachment = DepthStencilAttachment {
        resolve: Some(DepthStencilResolve {
            target: one([8, 4], format).view(),
            depth: Some(ResolveMode::Average),
            stencil: Some(ResolveMode::Average),
        }),
        ..DepthStencilAttachment::load(&samples(&device, format).view())
    };
    refused_pass!(
        &device,
        RenderPass {
            depth_stencil_attachment: Some(attachment),
            ..RenderPass::default()
        },
        PassErrorKind::Resolve { .. },
        "the resolve target of the depth-stencil attachment cannot average stencil values: choose \
         another mode"
    );
}

#[test]
fn draws() {
    use PassErrorKind as E;
    let device = device();
    let image = texture(&device, [8, 4], TextureFormat::Rgba8Unorm).view();
    let depth = texture(&device, [8, 4], TextureFormat::Depth16Unorm).view();
    let mut descriptor = RenderPipelineDescriptor::new(Fill::WHITE);
    let writes_depth = device.create_render_pipeline(&descriptor).unwrap();
    descriptor.depth_stencil = None;
    let plain = device.create_render_pipeline(&descriptor).unwrap();
    let refuse = |draw: Draw<'_>| {
        refused_pass(
            &device,
            RenderPass {
                color_attachments: &[Some(ColorAttachment::load(&image))],
                depth_stencil_attachment: Some(DepthStencilAttachment {
                    depth: AspectOperations::ReadOnly,
                    ..DepthStencilAttachment::load(&depth)
                }),
                draws: &[Draw::new(&plain, 0..3), draw],
                ..RenderPass::default()
            },
        )
    };
    let (kind, message) = refuse(Draw::new(&writes_depth, 0..3));
    assert!(matches!(kind, E::ReadOnly { draw: 1, .. }));
    assert_eq!(
        message,
        "draw 1: its pipeline writes depth, which is read-only in this pass: create the pipeline \
         without, or attach with `AspectOperations::Write`"
    );
    let buffer = device.create_buffer(&BufferDescriptor::new(64)).unwrap();
    let (kind, message) = refuse(Draw {
        vertex_buffers: &[buffer.slice(..)],
        ..Draw::new(&plain, 0..3)
    });
    assert!(matches!(kind, E::VertexBuffers { draw: 1, .. }));
    assert_eq!(
        message,
        "draw 1: 1 vertex buffers, and its pipeline reads 0"
    );
    let index = |slice: &estampe::BufferSlice| {
        refuse(Draw {
            index_buffer: Some((slice, IndexFormat::Uint32)),
            ..Draw::new(&plain, 0..3)
        })
    };
    let (kind, message) = index(&buffer.slice(60..68));
    assert!(matches!(kind, E::Buffer { draw: 1, .. }));
    assert_eq!(
        message,
        "draw 1: the index buffer: bytes 60..68 of a buffer, which has 64: use a range inside the \
         buffer"
    );
    let (kind, message) = index(&buffer.slice(6..));
    assert!(matches!(kind, E::Offset { draw: 1, .. }));
    assert_eq!(
        message,
        "draw 1: the index buffer begins at byte 6, which is not a multiple of 4"
    );
}

#[test]
fn bind_groups_of_draws() {
    use PassErrorKind as E;
    let device = device();
    let image = texture(&device, [8, 4], TextureFormat::Rgba8Unorm).view();
    let layout = |ty| device.create_bind_group_layout(&[entry(3, ty)]).unwrap();
    let mut descriptor = RenderPipelineDescriptor::new(Fill::WHITE);
    descriptor.depth_stencil = None;
    let plain = device.create_render_pipeline(&descriptor).unwrap();
    descriptor.bind_group_layouts = vec![layout(DYNAMIC)];
    let grouped = device.create_render_pipeline(&descriptor).unwrap();
    let refuse = |draw: Draw<'_>| {
        refused_pass(
            &device,
            RenderPass {
                color_attachments: &[Some(ColorAttachment::load(&image))],
                draws: &[Draw::new(&plain, 0..3), draw],
                ..RenderPass::default()
            },
        )
    };
    let buffer = device.create_buffer(&BufferDescriptor::new(64)).unwrap();
    let bind = |ty, resource| material(&device, ty, &[(3, resource)]).unwrap();
    let dynamic = bind(DYNAMIC, BindingResource::Buffer(buffer.slice(0..16)));
    let fixed = bind(UNIFORM, BindingResource::Buffer(buffer.slice(0..16)));
    let group = |groups: &[BindGroup], dynamic_offsets: &[u32]| {
        let (kind, message) = refuse(Draw {
            bind_groups: groups,
            dynamic_offsets,
            ..Draw::new(&grouped, 0..3)
        });
        assert!(matches!(kind, E::BindGroup { draw: 1, .. }), "{kind:?}");
        message
    };
    let dynamic = std::slice::from_ref(&dynamic);
    assert_eq!(
        group(&[], &[]),
        "draw 1: bind group 0: the pipeline needs it, and none is bound"
    );
    let message = group(&[fixed], &[]);
    assert!(
        message.starts_with("draw 1: bind group 0: the bind group `material` has the layout [")
            && message.contains("], and the pipeline needs ["),
        "{message}"
    );
    assert_eq!(
        group(dynamic, &[]),
        "draw 1: bind group 0: the bind group `material` has 1 dynamic offsets, and 0 of the 0 that \
         are given are left for it"
    );
    assert_eq!(
        group(dynamic, &[0, 4]),
        "draw 1: bind group 0: 2 dynamic offsets are given, and the bind groups have 1"
    );
    assert_eq!(
        group(dynamic, &[6]),
        "draw 1: bind group 0: the dynamic offset 6 of binding 3 is not a multiple of 4"
    );
    assert_eq!(
        group(dynamic, &[52]),
        "draw 1: bind group 0: binding 3 with the dynamic offset 52 ends at byte 68 of a buffer, \
         which has 64"
    );
    assert_eq!(
        group(&vec![dynamic[0].clone(); 5], &[0; 5]),
        "draw 1: bind group 4: the limit max_bind_groups is 4"
    );
    // A pass cannot sample what it draws into.
    let sampler = device
        .create_sampler(&SamplerDescriptor::default())
        .unwrap();
    let sampled = bind(
        SAMPLED,
        BindingResource::SampledTexture(image.clone(), sampler),
    );
    let (kind, message) = refuse(Draw {
        bind_groups: std::slice::from_ref(&sampled),
        ..Draw::new(&plain, 0..3)
    });
    assert!(matches!(kind, E::UsedTwice { .. }));
    assert_eq!(
        message,
        "colour attachment 0 and binding 3 of the bind group `material` are the same image: a pass \
         cannot use an image that it writes twice"
    );
}
