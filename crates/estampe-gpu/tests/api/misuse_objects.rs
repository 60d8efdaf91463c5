//! Every error of buffers, textures, copies and blits: its message names what does not fit, and
//! both sides.

use crate::support::{Fill, device, labelled, limited, samples, texture};
use estampe::{
    BlitError, BlitRegion, BufferDescriptor, BufferError, BufferUsages, CopyError, Draw, Extent3d,
    FilterMode, Limits, RenderPipelineDescriptor, SamplerDescriptor, TexelCopyLayout, TextureCopy,
    TextureDescriptor, TextureDimension, TextureError, TextureFormat, TextureUsages,
    TextureViewDescriptor,
};

/// Checks an error's variant and its message.
macro_rules! refused {
    ($result:expr, $variant:pat, $message:expr) => {{
        let error = $result.err().expect("it is refused");
        assert!(matches!(error, $variant), "{error:?}");
        assert_eq!(error.to_string(), $message);
    }};
}

#[test]
fn buffers() {
    let device = limited(Limits {
        max_buffer_size: 100,
        ..Limits::default()
    });
    let create = |size, usage| {
        device.create_buffer(&BufferDescriptor {
            label: Some("points"),
            size,
            usage,
        })
    };
    refused!(
        create(101, BufferUsages::all()),
        BufferError::TooLarge { .. },
        "the buffer `points` of 101 bytes exceeds the limit max_buffer_size = 100"
    );
    refused!(
        device.create_buffer_with_contents(&[0; 104]),
        BufferError::TooLarge { .. },
        "a buffer of 104 bytes exceeds the limit max_buffer_size = 100"
    );
    let buffer = create(10, BufferUsages::all()).unwrap();
    let beyond = "bytes 8..11 of the buffer `points`, which has 10: use a range inside the buffer";
    refused!(buffer.write(8, &[0; 3]), BufferError::Range { .. }, beyond);
    refused!(
        buffer.read(8, &mut [0; 3]),
        BufferError::Range { .. },
        beyond
    );
    refused!(
        buffer.map_read(8..11, |_| ()),
        BufferError::Range { .. },
        beyond
    );
    refused!(
        buffer.map_write(8..11, |_| ()),
        BufferError::Range { .. },
        beyond
    );
    refused!(
        buffer.write(u64::MAX, &[0; 3]),
        BufferError::Range { .. },
        "bytes 18446744073709551615..18446744073709551615 of the buffer `points`, which has 10: use \
         a range inside the buffer"
    );
    let none = create(10, BufferUsages::empty()).unwrap();
    let lacks = |usage: &str| {
        format!(
            "the buffer `points` was created without BufferUsages::{usage}: add it to its usage"
        )
    };
    refused!(
        none.write(0, &[0]),
        BufferError::Usage { .. },
        lacks("COPY_DST")
    );
    refused!(
        none.read(0, &mut [0]),
        BufferError::Usage { .. },
        lacks("MAP_READ")
    );
    refused!(
        none.map_read(0..1, |_| ()),
        BufferError::Usage { .. },
        lacks("MAP_READ")
    );
    refused!(
        none.map_write(0..1, |_| ()),
        BufferError::Usage { .. },
        lacks("MAP_WRITE")
    );
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor::new(Fill::WHITE));
    let pipeline = pipeline.unwrap();
    refused!(
        Draw::indirect(&pipeline, &none, 0),
        BufferError::Usage { .. },
        lacks("INDIRECT")
    );
    refused!(
        Draw::indirect(&pipeline, &buffer, 0),
        BufferError::Range { .. },
        "bytes 0..16 of the buffer `points`, which has 10: use a range inside the buffer"
    );
}

#[test]
#[expect(clippy::too_many_lines, reason = "a list of cases")]
fn textures() {
    let device = limited(Limits {
        max_texture_dimension_3d: 64,
        ..Limits::default()
    });
    let size = |depth_or_array_layers| Extent3d {
        depth_or_array_layers,
        ..Extent3d::new_2d(8, 4)
    };
    let create = |dimension, layers| {
        device.create_texture(&TextureDescriptor {
            dimension,
            size: size(layers),
            ..TextureDescriptor::new_2d(8, 4, TextureFormat::R8Unorm)
        })
    };
    refused!(
        create(TextureDimension::D2, 257),
        TextureError::Limit { .. },
        "257 layers exceed the limit max_texture_array_layers = 256"
    );
    refused!(
        create(TextureDimension::D3, 65),
        TextureError::Limit { .. },
        "65 texels of a 3D texture's side exceed the limit max_texture_dimension_3d = 64"
    );
    refused!(
        create(TextureDimension::D2, 0),
        TextureError::Rule(_),
        "a D2 texture has 1 to 256 layers or slices, not 0, and a D1 texture has height 1, not 4"
    );
    let image = labelled(&device, "grass", TextureUsages::all());
    refused!(
        image.create_view(&TextureViewDescriptor {
            format: Some(TextureFormat::Bgra8Unorm),
            ..TextureViewDescriptor::default()
        }),
        TextureError::Unsupported { .. },
        "the texture `grass` of format rgba8unorm with 1 samples: a view has the same format, or \
         the one that differs in sRGB alone"
    );
    refused!(
        image.image(1, 0),
        TextureError::Rule(_),
        "the view asks for levels, which the texture does not have"
    );
    refused!(
        device.create_sampler(&SamplerDescriptor {
            max_anisotropy: 17,
            ..SamplerDescriptor::default()
        }),
        TextureError::Rule(_),
        "max_anisotropy is 1 to 16"
    );
    let none = labelled(&device, "grass", TextureUsages::empty());
    let lacks = |usage: &str| {
        format!(
            "the texture `grass` was created without TextureUsages::{usage}: add it to its usage"
        )
    };
    let (tight, all) = (TexelCopyLayout::default(), image.size());
    let bytes = [0; 128];
    refused!(
        device.write_texture(&none, &bytes, &tight, all),
        TextureError::Usage { .. },
        lacks("COPY_DST")
    );
    refused!(
        device.clear_texture(&none.view()),
        TextureError::Usage { .. },
        lacks("COPY_DST")
    );
    refused!(
        device.read_texture(&none),
        TextureError::Usage { .. },
        lacks("COPY_SRC")
    );
    let sampler = device
        .create_sampler(&SamplerDescriptor::default())
        .unwrap();
    refused!(
        device.sampled_texture(&none.view(), &sampler),
        TextureError::Usage { .. },
        lacks("TEXTURE_BINDING")
    );
    let from = TextureCopy {
        origin: [6, 0, 0],
        ..(&image).into()
    };
    refused!(
        device.write_texture(from, &bytes, &tight, Extent3d::new_2d(3, 4)),
        TextureError::Region { .. },
        "texels (6, 0, 0) to (9, 4, 1) of level 0 of the texture `grass`: the level has 8x4x1, and \
         a region begins and ends at blocks of 1x1 texels or at the level's end"
    );
    let blocks = texture(&device, [9, 9], TextureFormat::Bc1RgbaUnorm);
    refused!(
        device.write_texture(&blocks, &bytes, &tight, Extent3d::new_2d(6, 4)),
        TextureError::Region { .. },
        "texels (0, 0, 0) to (6, 4, 1) of level 0 of a texture: the level has 9x9x1, and a region \
         begins and ends at blocks of 4x4 texels or at the level's end"
    );
    refused!(
        device.write_texture(&image, &bytes[1..], &tight, all),
        TextureError::Bytes { .. },
        "a region of the texture `grass` takes 128 bytes with 32 bytes a row, and 127 are given"
    );
    let narrow = TexelCopyLayout {
        bytes_per_row: Some(31),
        ..tight
    };
    refused!(
        device.write_texture(&image, &bytes, &narrow, all),
        TextureError::Bytes { .. },
        "a region of the texture `grass` takes 125 bytes with 32 bytes a row, and 128 are given"
    );
    let mut short = [7; 127];
    refused!(
        device.read_texture_into(&image, &mut short, &tight, all),
        TextureError::Bytes { .. },
        "a region of the texture `grass` takes 128 bytes with 32 bytes a row, and 127 are given"
    );
    assert_eq!(short, [7; 127]);
    let samples = samples(&device, TextureFormat::Rgba8Unorm);
    refused!(
        device.read_texture(&samples),
        TextureError::Unsupported { .. },
        "a texture of format rgba8unorm with 4 samples: resolve a multisampled texture before it is \
         copied to or from the host"
    );
    let integers = texture(&device, [8, 4], TextureFormat::R32Uint);
    refused!(
        device.generate_mips(&integers),
        TextureError::Unsupported { .. },
        "a texture of format r32uint with 1 samples: mip levels are made of colours that can be \
         filtered, and not of compressed blocks"
    );
}

#[test]
fn copies() {
    let device = device();
    let [one, other] = [1, 2].map(|_| {
        let descriptor = BufferDescriptor {
            label: Some("points"),
            size: 64,
            usage: BufferUsages::COPY_SRC,
        };
        device.create_buffer(&descriptor).unwrap()
    });
    let lacks =
        "the buffer `points` was created without BufferUsages::COPY_DST: add it to its usage";
    refused!(
        device.copy_buffer_to_buffer((&one, 0), (&other, 0), 4),
        CopyError::Buffer(_),
        lacks
    );
    refused!(device.clear_buffer(&one, 0, 4), CopyError::Buffer(_), lacks);
    let image = labelled(&device, "grass", TextureUsages::all());
    let tight = TexelCopyLayout::default();
    let size = Extent3d::new_2d(8, 4);
    refused!(
        device.copy_texture_to_buffer(&image, (&one, &tight), size),
        CopyError::Buffer(_),
        lacks
    );
    refused!(
        device.copy_buffer_to_texture((&one, &tight), &image, size),
        CopyError::Texture(_),
        "a region of the texture `grass` takes 128 bytes with 32 bytes a row, and 64 are given"
    );
    let float = texture(&device, [8, 4], TextureFormat::Rgba16Float);
    refused!(
        device.copy_texture_to_texture(&image, &float, size),
        CopyError::Formats { .. },
        "the texture `grass` and a texture have formats that differ in more than sRGB: convert \
         with a blit"
    );
    // Formats that differ in sRGB alone are copied.
    let srgb = texture(&device, [8, 4], TextureFormat::Rgba8UnormSrgb);
    device.copy_texture_to_texture(&image, &srgb, size).unwrap();
}

#[test]
fn blits() {
    let device = device();
    let image = labelled(&device, "grass", TextureUsages::all()).view();
    let other = texture(&device, [4, 4], TextureFormat::Rgba8Unorm).view();
    let blit = |from: &BlitRegion<'_>, into: &BlitRegion<'_>| {
        device.blit(*from, *into, FilterMode::Nearest)
    };
    let region = |origin, size| BlitRegion {
        view: &image,
        origin,
        size,
    };
    refused!(
        blit(&region([2, 0], [7, 4]), &(&other).into()),
        BlitError::Region { .. },
        "the source of the blit is 7x4 texels at (2, 0) of an image of 8x4: it must not be empty, \
         and lie in the image"
    );
    refused!(
        blit(&(&other).into(), &region([2, 0], [0, 4])),
        BlitError::Region { .. },
        "the destination of the blit is 0x4 texels at (2, 0) of an image of 8x4: it must not be \
         empty, and lie in the image"
    );
    for view in [
        samples(&device, TextureFormat::Rgba8Unorm).view(),
        texture(&device, [8, 4], TextureFormat::R8Uint).view(),
        texture(&device, [8, 4], TextureFormat::Depth32Float).view(),
    ] {
        refused!(
            blit(&(&view).into(), &(&other).into()),
            BlitError::NotAnImage("source"),
            "the source of the blit is not a 2D view of one level of one layer, of one sample and \
             numbers"
        );
    }
    refused!(
        blit(&(&image).into(), &(&image).into()),
        BlitError::SameTexture,
        "source and destination of the blit are the same texture: copy to another one first"
    );
    let unused = labelled(&device, "grass", TextureUsages::COPY_SRC).view();
    refused!(
        blit(&(&unused).into(), &(&other).into()),
        BlitError::Texture(_),
        "the texture `grass` was created without TextureUsages::TEXTURE_BINDING: add it to its usage"
    );
    let shared = texture(&device, [8, 4], TextureFormat::Rgb9e5Ufloat).view();
    refused!(
        blit(&(&image).into(), &(&shared).into()),
        BlitError::Pass(_),
        "the pass `blit`: colour attachment 0 has the format rgb9e5ufloat: colours cannot be rendered \
         to depth, stencil and compressed formats and rgb9e5ufloat"
    );
    refused!(
        blit(&(&other).into(), &(&unused).into()),
        BlitError::Pass(_),
        "the pass `blit`: colour attachment 0: the texture `grass` was created without \
         TextureUsages::RENDER_ATTACHMENT: add it to its usage"
    );
}
