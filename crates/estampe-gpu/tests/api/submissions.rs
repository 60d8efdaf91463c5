//! Submissions: commands in order, all of them checked before the first one is done.

use crate::support::{Fill, device, devices, texture};
use estampe::{
    BlitRegion, Buffer, BufferDescriptor, ColorAttachment, Command, CommandError, Device, Draw,
    Extent3d, FilterMode, RenderPass, RenderPipelineDescriptor, TexelCopyLayout, Texture,
    TextureDescriptor, TextureFormat, TextureView,
};

const TIGHT: TexelCopyLayout = TexelCopyLayout {
    offset: 0,
    bytes_per_row: None,
    rows_per_image: None,
};

/// The objects of every kind of command.
struct Objects {
    first: Texture,
    second: Texture,
    half: TextureView,
    bytes: Buffer,
    copy: Buffer,
}

impl Objects {
    fn new(device: &Device) -> Self {
        let descriptor = TextureDescriptor::new_2d(8, 4, TextureFormat::Rgba8Unorm);
        let first = device
            .create_texture(&descriptor.with_all_levels())
            .unwrap();
        let half = first.image(1, 0).unwrap();
        let buffer = |size| device.create_buffer(&BufferDescriptor::new(size)).unwrap();
        Self {
            second: texture(device, [8, 4], TextureFormat::Rgba8Unorm),
            first,
            half,
            bytes: buffer(128),
            copy: buffer(128),
        }
    }

    /// A command of each kind; the right half becomes white, the rest red and green.
    fn commands<'a>(&'a self, pass: RenderPass<'a>) -> Vec<Command<'a>> {
        let size = Extent3d::new_2d(8, 4);
        vec![
            pass.into(),
            Command::CopyTextureToBuffer {
                from: (&self.second).into(),
                into: (&self.bytes, TIGHT),
                size,
            },
            Command::WriteBuffer {
                buffer: &self.bytes,
                offset: 0,
                bytes: &[0, 255, 0, 255],
            },
            Command::CopyBufferToBuffer {
                from: (&self.bytes, 0),
                into: (&self.copy, 0),
                size: 128,
            },
            Command::ClearBuffer {
                buffer: &self.copy,
                offset: 4,
                size: 4,
            },
            Command::CopyBufferToTexture {
                from: (&self.copy, TIGHT),
                into: (&self.first).into(),
                size,
            },
            Command::GenerateMips(&self.first),
            Command::Blit {
                from: BlitRegion::from(&self.half),
                into: BlitRegion {
                    view: &self.half,
                    origin: [0; 2],
                    size: [1; 2],
                },
                filter: FilterMode::Nearest,
            },
        ]
    }
}

#[test]
fn commands_are_done_in_order() {
    for (name, device) in devices() {
        let objects = Objects::new(&device);
        let second = objects.second.view();
        let mut descriptor = RenderPipelineDescriptor::new(Fill::WHITE);
        descriptor.depth_stencil = None;
        let pipeline = device.create_render_pipeline(&descriptor).unwrap();
        let attachments = [Some(ColorAttachment::clear(&second, [1.0, 0.0, 0.0, 1.0]))];
        let draws = [Draw {
            scissor: Some(estampe::state::ScissorRect {
                x: 4,
                y: 0,
                width: 4,
                height: 4,
            }),
            ..Draw::new(&pipeline, 0..3)
        }];
        let mut commands = objects.commands(RenderPass {
            color_attachments: &attachments,
            draws: &draws,
            ..RenderPass::default()
        });
        // The last one reads and writes the same texture.
        commands.pop();
        let size = Extent3d::new_2d(4, 2);
        commands.push(Command::CopyTextureToTexture {
            from: estampe::TextureCopy {
                mip_level: 1,
                ..(&objects.first).into()
            },
            into: (&objects.second).into(),
            size,
        });
        let statistics = device.submit(&commands).unwrap();
        assert_eq!(statistics.primitives_in, 1, "{name}");
        let seen = device.read_texture(&objects.second).unwrap();
        let texel = |x: usize, y: usize| &seen[(y * 8 + x) * 4..][..4];
        // Green, zeros, red and red: their mean. Below it red; on the right white.
        assert_eq!(texel(0, 0), [128, 64, 0, 191], "{name}");
        assert_eq!(texel(1, 0), [255, 0, 0, 255], "{name}");
        assert_eq!(texel(3, 1), [255; 4], "{name}");
        assert_eq!(texel(0, 3), [255, 0, 0, 255], "{name}");
        // Clears and writes of textures.
        let white = [255; 4];
        device
            .submit(&[
                Command::ClearTexture(&second),
                Command::WriteTexture {
                    into: (&objects.second).into(),
                    bytes: &white,
                    layout: TIGHT,
                    size: Extent3d::new_2d(1, 1),
                },
                Command::Blit {
                    from: BlitRegion {
                        view: &second,
                        origin: [0; 2],
                        size: [1; 2],
                    },
                    into: (&objects.half).into(),
                    filter: FilterMode::Nearest,
                },
            ])
            .unwrap();
        let seen = device.read_texture(&objects.second).unwrap();
        assert_eq!([&seen[..4], &seen[4..8]], [&[255; 4], &[0; 4]], "{name}");
        let mut half = [0; 32];
        let from = estampe::TextureCopy {
            mip_level: 1,
            ..(&objects.first).into()
        };
        device
            .read_texture_into(from, &mut half, &TIGHT, size)
            .unwrap();
        assert_eq!(half, [255; 32], "{name}");
    }
}

/// A mistake in any command is found before the first one is done, and its place is named.
#[test]
fn nothing_is_done_if_one_command_does_not_fit() {
    let device = device();
    let objects = Objects::new(&device);
    let second = objects.second.view();
    let attachments = [Some(ColorAttachment::clear(&second, [1.0; 4]))];
    let good = RenderPass {
        color_attachments: &attachments,
        ..RenderPass::default()
    };
    let size = Extent3d::new_2d(9, 4);
    let (into, bad_pass) = ((&objects.first).into(), RenderPass::default());
    let depth = texture(&device, [8, 4], TextureFormat::Depth16Unorm);
    let small = device.create_buffer(&BufferDescriptor::new(4)).unwrap();
    let bad = [
        Command::Render(bad_pass),
        Command::WriteBuffer {
            buffer: &small,
            offset: 2,
            bytes: &[0; 4],
        },
        Command::WriteTexture {
            into,
            bytes: &[0; 144],
            layout: TIGHT,
            size,
        },
        Command::CopyBufferToBuffer {
            from: (&small, 0),
            into: (&small, 4),
            size: 4,
        },
        Command::CopyBufferToTexture {
            from: (&small, TIGHT),
            into: (&objects.first).into(),
            size: Extent3d::new_2d(8, 4),
        },
        Command::CopyTextureToBuffer {
            from: (&objects.first).into(),
            into: (&small, TIGHT),
            size: Extent3d::new_2d(8, 4),
        },
        Command::CopyTextureToTexture {
            from: (&objects.first).into(),
            into: (&depth).into(),
            size: Extent3d::new_2d(8, 4),
        },
        Command::ClearBuffer {
            buffer: &small,
            offset: 0,
            size: 8,
        },
        Command::GenerateMips(&depth),
        Command::Blit {
            from: (&second).into(),
            into: (&second).into(),
            filter: FilterMode::Linear,
        },
    ];
    for command in bad {
        let what = format!("{command:?}");
        let error = device.submit(&[good.clone().into(), command]).unwrap_err();
        assert_eq!(error.command, 1, "{what}");
        let fits = match &*error.error {
            CommandError::Pass(_) => what.starts_with("Render"),
            CommandError::Copy(_) => what.starts_with("Copy"),
            CommandError::Blit(_) => what.starts_with("Blit"),
            CommandError::Buffer(_) => {
                what.starts_with("WriteBuffer") || what.starts_with("ClearBuffer")
            }
            CommandError::Texture(_) => {
                what.starts_with("WriteTexture") || what.starts_with("GenerateMips")
            }
            _ => false,
        };
        assert!(fits, "{what}: {error:?}");
        assert!(error.to_string().starts_with("command 1: "), "{error}");
        let untouched = device.read_texture(&objects.second).unwrap();
        assert!(untouched.iter().all(|byte| *byte == 0), "{what}");
    }
}
