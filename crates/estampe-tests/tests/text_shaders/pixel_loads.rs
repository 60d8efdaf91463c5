//! Images that a pass has drawn, loaded by the next one at its own pixels: they are read where the
//! attachment stores them, with no rows made, and give the bits that rows give.

use super::{devices, module};
use estampe::state::ScissorRect;
use estampe::{
    BindGroup, BindGroupDescriptor, BindingResource, ColorAttachment, DepthStencilAttachment,
    Device, Draw, RenderPass, RenderPipeline, RenderPipelineDescriptor, ShaderModule, ShaderSource,
    Statistics, Texture, TextureDescriptor, TextureFormat, TextureViewDescriptor,
};
use estampe_tests::Random;
use std::collections::BTreeSet;

/// What is drawn into the image: numbers of any size and sign, and an edge.
const SOURCE: &str = "
@vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 3.2 - 1.0, f32(i >> 1u) * 3.1 - 0.9, 0.1 + f32(i) * 0.4, 1.0);
}
@fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(sin(at.x * 7.3 + at.y), cos(at.y * 3.1), at.x * at.y * 0.01, at.z);
}
";

/// Reads an image at the pixel, and the difference to the pixel beside it. `one` is 1, which the
/// compiler does not know.
fn reader(of_depth: bool, is_known: bool) -> String {
    let (kind, load) = match of_depth {
        true => ("texture_depth_2d", "vec4f(textureLoad(image, pixel, 0))"),
        false => ("texture_2d<f32>", "textureLoad(image, pixel, 0)"),
    };
    let pixel = match is_known {
        true => "vec2i(at.xy)",
        false => "vec2i(at.xy * one)",
    };
    format!(
        "
@group(0) @binding(0) var image: {kind};
@vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
    return vec4f(f32(i & 1u) * 3.0 - 1.0, f32(i >> 1u) * 2.9 - 1.0, 0.5, 1.0);
}}
@fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {{
    let one = min(abs(at.z) + 1.0, 1.0);
    let size = vec2f(textureDimensions(image));
    let pixel = {pixel};
    let texel = {load};
    return texel + dpdx(texel) * 0.5 + vec4f(size, 0.0, 0.0) / 1024.0;
}}
"
    )
}

fn texture(device: &Device, [width, height]: [u32; 2], format: TextureFormat) -> Texture {
    let descriptor = TextureDescriptor::new_2d(width, height, format);
    device.create_texture(&descriptor).expect("a small texture")
}

/// A pipeline of a module that draws into images of a format.
fn pipeline(
    device: &Device,
    (module, format): (&ShaderModule, TextureFormat),
    count: u32,
) -> RenderPipeline {
    let program = device.create_program(&module.program());
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    let mut descriptor = RenderPipelineDescriptor::with_program(program);
    descriptor.multisample.count = count;
    if format.is_color() {
        descriptor.depth_stencil = None;
        descriptor.targets = vec![format.into()];
    } else {
        descriptor.targets = Vec::new();
    }
    let made = device.create_render_pipeline(&descriptor);
    made.unwrap_or_else(|error| panic!("{error}"))
}

/// An image, what draws into it, and what reads it.
struct Scene<'a> {
    device: &'a Device,
    image: Texture,
    /// With one sample, and with four.
    sources: [RenderPipeline; 2],
    /// By loads that are known to be at the pixel, and by others.
    readers: [(RenderPipeline, BindGroup); 2],
}

impl<'a> Scene<'a> {
    fn new(
        device: &'a Device,
        (format, read_as): (TextureFormat, TextureFormat),
        size: [u32; 2],
    ) -> Self {
        let image = texture(device, size, format);
        let source = match format.is_color() {
            true => SOURCE,
            false => SOURCE.split("@fragment").next().expect("a vertex shader"),
        };
        let source = module(device, ShaderSource::Wgsl(source));
        let view = image.create_view(&TextureViewDescriptor {
            format: Some(read_as),
            ..TextureViewDescriptor::default()
        });
        let view = view.expect("a view of all");
        let readers = [true, false].map(|is_known| {
            let text = reader(!format.is_color(), is_known);
            let module = module(device, ShaderSource::Wgsl(&text));
            let pipeline = pipeline(device, (&module, PICTURE), 1);
            let reads = pipeline.texture_reads(0, 0);
            assert_eq!((reads.at_pixel, reads.others), (is_known, !is_known));
            let group = device.create_bind_group(&BindGroupDescriptor {
                label: None,
                layout: &pipeline.descriptor().bind_group_layouts[0],
                entries: &[(0, BindingResource::Texture(view.clone()))],
            });
            (pipeline, group.unwrap_or_else(|error| panic!("{error}")))
        });
        Self {
            device,
            image,
            sources: [1, 4].map(|count| pipeline(device, (&source, format), count)),
            readers,
        }
    }

    /// Draws into the image, over what it holds or over a colour of its own; or with four samples,
    /// which are resolved into it.
    fn draw(&self, random: &mut Random) -> Statistics {
        let (view, format) = (self.image.view(), self.image.format());
        let [width, height] = view.size();
        let four_samples = format.is_color() && random.below(4) == 0;
        let draws = &[Draw {
            scissor: (random.below(2) == 0).then(|| ScissorRect {
                x: random.below(width),
                y: random.below(height),
                width: 1 + random.below(width),
                height: 1 + random.below(height),
            }),
            ..Draw::new(&self.sources[usize::from(four_samples)], 0..3)
        }];
        let loads = random.below(3) == 0;
        let clear = [0.25, 0.5, 0.75, 1.0].map(|part| part * f64::from(random.unit()));
        let pass = RenderPass {
            draws,
            ..RenderPass::default()
        };
        let drawn = if !format.is_color() {
            let attachment = match loads {
                true => DepthStencilAttachment::load(&view),
                false => DepthStencilAttachment::clear(&view, random.unit()),
            };
            self.device.render(&RenderPass {
                depth_stencil_attachment: Some(attachment),
                ..pass
            })
        } else if four_samples {
            let samples = self.device.create_texture(&TextureDescriptor {
                sample_count: 4,
                ..TextureDescriptor::new_2d(width, height, format)
            });
            let samples = samples.expect("a small texture").view();
            self.device.render(&RenderPass {
                color_attachments: &[Some(ColorAttachment {
                    resolve_target: Some(view),
                    ..ColorAttachment::clear(&samples, clear)
                })],
                ..pass
            })
        } else {
            let attachment = match loads {
                true => ColorAttachment::load(&view),
                false => ColorAttachment::clear(&view, clear),
            };
            self.device.render(&RenderPass {
                color_attachments: &[Some(attachment)],
                ..pass
            })
        };
        drawn.unwrap_or_else(|error| panic!("{error}"))
    }

    /// The bytes of a picture of this size by one of the readers.
    fn read(&self, reader: usize, size: [u32; 2]) -> Vec<u8> {
        let picture = texture(self.device, size, PICTURE);
        let (pipeline, group) = &self.readers[reader];
        let drawn = self.device.render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&picture.view(), [0.0; 4]))],
            draws: &[Draw {
                bind_groups: std::slice::from_ref(group),
                ..Draw::new(pipeline, 0..3)
            }],
            ..RenderPass::default()
        });
        drawn.unwrap_or_else(|error| panic!("{error}"));
        self.device.read_texture(&picture).expect("it can be read")
    }
}

/// Float numbers, so that no bit of a texel is lost.
const PICTURE: TextureFormat = TextureFormat::Rgba32Float;

/// The formats that are read in tiles, but at the scalar level: the first ones.
const IN_TILES: u64 = 6;

/// Formats of images, and those of their views.
const FORMATS: [(TextureFormat, TextureFormat); 9] = {
    use TextureFormat as F;
    [
        (F::Rgba8Unorm, F::Rgba8Unorm),
        (F::Rgba8Unorm, F::Rgba8UnormSrgb),
        (F::Rgba8UnormSrgb, F::Rgba8UnormSrgb),
        (F::Rgba16Float, F::Rgba16Float),
        (F::R32Float, F::R32Float),
        (F::Depth32Float, F::Depth32Float),
        (F::Bgra8Unorm, F::Bgra8Unorm),
        (F::Rg16Float, F::Rg16Float),
        (F::Depth24Plus, F::Depth24Plus),
    ]
};

#[test]
fn loads_at_the_pixel_are_those_from_rows() {
    let mut without_rows = 0;
    for (name, device) in devices() {
        for (number, formats) in (0..).zip(FORMATS) {
            let in_tiles = number < IN_TILES && !device.level().is_scalar();
            let random = &mut Random::new("loads at the pixel", number);
            for size in [[50, 37], [133, 70]] {
                let scene = Scene::new(&device, formats, size);
                let (mut has_rows, mut texels) = (!in_tiles, BTreeSet::<[u8; 16]>::new());
                for step in 0..8 {
                    let what = format!("{formats:?}, {size:?}, step {step}, {name}");
                    let drawn = scene.draw(random);
                    assert!(has_rows || drawn.tiles_to_rows == 0, "{what}");
                    let picture = [size, [40, 90]][random.index(2)];
                    let at_pixel = scene.read(0, picture);
                    without_rows += u32::from(!has_rows && step > 0);
                    // Rows that are made stay.
                    if step >= 3 {
                        assert!(at_pixel == scene.read(1, picture), "{what}");
                        has_rows = true;
                    }
                    texels.extend(at_pixel.as_chunks::<16>().0);
                }
                assert!(texels.len() > 100, "{formats:?}, {} texels", texels.len());
            }
        }
    }
    assert!(without_rows > 0);
}
