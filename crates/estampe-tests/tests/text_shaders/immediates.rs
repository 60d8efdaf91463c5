//! Immediates: bytes that are part of a draw. The pictures are compared with rectangles that the
//! test fills.

use super::{devices, module};
use estampe::state::{PrimitiveTopology, VertexBufferLayout};
use estampe::{
    ColorAttachment, ComputePipelineDescriptor, Device, DeviceDescriptor, Draw,
    EntryPointDescriptor, Limits, PassErrorKind, RenderPass, RenderPassError, RenderPipeline,
    RenderPipelineDescriptor, ShaderModule, ShaderSource, TextureDescriptor, TextureFormat,
    bytes_of,
};
use estampe_tests::Random;

const SIZE: [usize; 2] = [64, 48];

/// A rectangle in pixels, and its two colours; `turn` chooses the colour of each column.
struct Rect {
    from: [u32; 2],
    to: [u32; 2],
    turn: u32,
    colors: [[u8; 4]; 2],
}

impl Rect {
    /// As the shaders declare it: 64 bytes.
    fn bytes(&self) -> Vec<u8> {
        let [x, y, to_x, to_y] =
            [self.from[0], self.from[1], self.to[0], self.to[1]].map(|pixel| pixel as f32);
        let scale = [2.0 / SIZE[0] as f32, 2.0 / SIZE[1] as f32];
        let at = [x * scale[0] - 1.0, y * scale[1] - 1.0];
        let size = [(to_x - x) * scale[0], (to_y - y) * scale[1]];
        let colors = self
            .colors
            .map(|color| color.map(|part| f32::from(part) / 255.0));
        let mut words = [at, size].as_flattened().to_vec();
        words.extend([f32::from_bits(self.turn), 0.0, 0.0, 0.0]);
        words.extend(colors.as_flattened());
        bytes_of(&words).to_vec()
    }
}

const WGSL: &str = "
struct Rect { at: vec2f, size: vec2f, turn: u32, colors: array<vec4f, 2> }
var<immediate> rect: Rect;
@vertex fn vs(@location(0) corner: vec2f) -> @builtin(position) vec4f {
    let at = rect.at + corner * rect.size;
    return vec4f(at.x, -at.y, 0.0, 1.0);
}
@fragment fn fs(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return rect.colors[(u32(at.x) + rect.turn) % 2u];
}
";

/// The stages declare the parts of the block that they read, as programs for Vulkan do.
const VERTEX: &str = "#version 450
layout(push_constant) uniform Place { vec2 at; vec2 size; } place;
layout(location = 0) in vec2 corner;
void main() {
    vec2 at = place.at + corner * place.size;
    gl_Position = vec4(at.x, -at.y, 0.0, 1.0);
}";
const FRAGMENT: &str = "#version 450
layout(push_constant) uniform Paint { layout(offset = 16) uint turn; layout(offset = 32) vec4 colors[2]; };
layout(location = 0) out vec4 color;
void main() { color = colors[(uint(gl_FragCoord.x) + turn) % 2u]; }
";

fn pipeline(device: &Device, module: &ShaderModule) -> RenderPipeline {
    let program = device.create_program(&module.program());
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    let mut descriptor = RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout::packed(&[
            estampe::VertexFormat::Float32x2,
        ])],
        depth_stencil: None,
        ..RenderPipelineDescriptor::with_program(program)
    };
    descriptor.primitive.topology = PrimitiveTopology::TriangleStrip;
    let pipeline = device.create_render_pipeline(&descriptor);
    pipeline.unwrap_or_else(|error| panic!("{error}"))
}

/// Draws a rectangle for each of these immediates, in one pass.
fn drawn(
    device: &Device,
    pipeline: &RenderPipeline,
    immediates: &[Vec<u8>],
) -> Result<Vec<u8>, RenderPassError> {
    let corners = [[0.0_f32, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let corners = device.create_buffer_with_contents(bytes_of(corners.as_flattened()));
    let corners = [(&corners.expect("a small buffer")).into()];
    let draws = immediates.iter().map(|immediates| Draw {
        vertex_buffers: &corners,
        immediates,
        ..Draw::new(pipeline, 0..4)
    });
    let [width, height] = SIZE.map(|side| u32::try_from(side).unwrap());
    let descriptor = TextureDescriptor::new_2d(width, height, TextureFormat::Rgba8Unorm);
    let image = device.create_texture(&descriptor).expect("a small texture");
    device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
        draws: &draws.collect::<Vec<_>>(),
        ..RenderPass::default()
    })?;
    Ok(device.read_texture(&image).expect("it can be read"))
}

/// The rectangles one over the other.
fn filled(rects: &[Rect]) -> Vec<u8> {
    let mut image = vec![[0; 4]; SIZE[0] * SIZE[1]];
    for Rect {
        from,
        to,
        turn,
        colors,
    } in rects
    {
        for y in from[1]..to[1] {
            for x in from[0]..to[0] {
                image[y as usize * SIZE[0] + x as usize] = colors[((x + turn) % 2) as usize];
            }
        }
    }
    image.as_flattened().to_vec()
}

fn rects(count: usize) -> Vec<Rect> {
    let mut random = Random::new("immediates", 3);
    let mut side = |most: u32| {
        let all: Vec<u32> = (0..=most).collect();
        let (a, b) = (random.pick(&all), random.pick(&all));
        (a.min(b), a.max(b))
    };
    let mut places: Vec<_> = (0..count).map(|_| (side(64), side(48))).collect();
    // All is covered.
    places[0] = ((0, 64), (0, 48));
    let mut random = Random::new("immediates", 4);
    let mut color = || [0; 4].map(|_: u8| random.pick(&[0, 20, 77, 130, 200, 255]));
    let places = (0..).zip(places);
    places
        .map(|(turn, ((left, right), (top, bottom)))| Rect {
            from: [left, top],
            to: [right, bottom],
            turn,
            colors: [color(), color()],
        })
        .collect()
}

/// Rows: G1, G2
#[test]
fn each_draw_of_a_pass_has_its_own() {
    for count in [2, 50] {
        let rects = rects(count);
        let expected = filled(&rects);
        let immediates: Vec<_> = rects.iter().map(Rect::bytes).collect();
        for (name, device) in devices() {
            for source in [
                ShaderSource::Wgsl(WGSL),
                ShaderSource::Glsl {
                    vertex: VERTEX,
                    fragment: FRAGMENT,
                },
            ] {
                let pipeline = pipeline(&device, &module(&device, source));
                assert_eq!(pipeline.descriptor().immediate_size(), 64);
                let bytes = drawn(&device, &pipeline, &immediates);
                let bytes = bytes.unwrap_or_else(|error| panic!("{error}"));
                assert!(bytes == expected, "{name}, {count} draws: {source:?}");
            }
        }
    }
}

/// One colour a draw, with and without immediates in turn: all of a pass is one batch.
///
/// Rows: G2
#[test]
fn draws_without_immediates_stand_beside_draws_with_them() {
    let plain = "
        @vertex fn vs(@location(0) corner: vec2f) -> @builtin(position) vec4f {
            return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
        }
        @fragment fn fs() -> @location(0) vec4f { return vec4f(1.0, 0.0, 0.0, 1.0); }";
    let tinted = "
        struct Place { at: vec2f, size: vec2f }
        struct Rect { place: Place, turn: u32, colors: array<vec4f, 2> }
        var<immediate> rect: Rect;
        fn corner_of(place: Place, corner: vec2f) -> vec2f { return place.at + corner * place.size; }
        @vertex fn vs(@location(0) corner: vec2f) -> @builtin(position) vec4f {
            let at = corner_of(rect.place, corner);
            return vec4f(at.x, -at.y, 0.0, 1.0);
        }
        @fragment fn fs() -> @location(0) vec4f { return rect.colors[1]; }";
    let rect = Rect {
        from: [5, 7],
        to: [40, 31],
        turn: 0,
        colors: [[0, 0, 255, 255]; 2],
    };
    let whole = Rect {
        from: [0, 0],
        to: [64, 48],
        turn: 0,
        colors: [[255, 0, 0, 255]; 2],
    };
    let bytes = rect.bytes();
    let expected = filled(&[whole, rect]);
    for (name, device) in devices() {
        let [plain, tinted] = [plain, tinted]
            .map(|text| pipeline(&device, &module(&device, ShaderSource::Wgsl(text))));
        // What a pipeline does not read may be given.
        let image = drawn(&device, &plain, &[bytes.clone(), Vec::new()]).expect("it reads none");
        assert!(image.chunks(4).all(|pixel| pixel == [255, 0, 0, 255]));
        let corners = [[0.0_f32, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        let corners = device.create_buffer_with_contents(bytes_of(corners.as_flattened()));
        let corners = [(&corners.expect("a small buffer")).into()];
        let draw = |pipeline, immediates| Draw {
            vertex_buffers: &corners,
            immediates,
            ..Draw::new(pipeline, 0..4)
        };
        let descriptor = TextureDescriptor::new_2d(64, 48, TextureFormat::Rgba8Unorm);
        let image = device.create_texture(&descriptor).expect("a small texture");
        let none = &[][..];
        device
            .render(&RenderPass {
                color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
                draws: &[
                    draw(&tinted, &bytes[..]),
                    draw(&plain, none),
                    draw(&tinted, &bytes[..]),
                ],
                ..RenderPass::default()
            })
            .unwrap_or_else(|error| panic!("{error}"));
        let read = device.read_texture(&image).expect("it can be read");
        assert!(read == expected, "{name}");
    }
}

/// Rows: G2
#[test]
fn a_draw_gives_what_its_pipeline_reads() {
    let device = Device::new(&DeviceDescriptor::default()).expect("a device");
    let pipeline = pipeline(&device, &module(&device, ShaderSource::Wgsl(WGSL)));
    let bytes = rects(1)[0].bytes();
    for (given, expected) in [
        (
            0,
            "the pass: draw 1: 0 bytes of immediates are given, and the shader reads 64",
        ),
        (
            60,
            "the pass: draw 1: 60 bytes of immediates are given, and the shader reads 64",
        ),
        (
            66,
            "the pass: draw 1: 66 bytes of immediates are given, which is not a multiple of 4",
        ),
        (
            132,
            "the pass: draw 1: 132 bytes of immediates are given; the limit max_immediate_size is 128",
        ),
    ] {
        let mut wrong = bytes.clone();
        wrong.resize(given, 0);
        let error = drawn(&device, &pipeline, &[bytes.clone(), wrong]).expect_err("refused");
        assert!(matches!(
            error.kind,
            PassErrorKind::Immediates { draw: 1, .. }
        ));
        assert_eq!(error.to_string(), expected);
    }
    let mut more = bytes.clone();
    more.resize(128, 7);
    let exact = drawn(&device, &pipeline, &[bytes]).expect("as many as are read");
    assert!(drawn(&device, &pipeline, &[more]).expect("more than are read") == exact);
}

/// Only what an entry point reads counts, and that against the limit.
///
/// Rows: G2
#[test]
fn pipelines_read_no_more_than_the_limit() {
    let text = "
        struct Block { first: vec4f, others: array<vec4f, 8> }
        var<immediate> block: Block;
        @vertex fn vs(@location(0) corner: vec2f) -> @builtin(position) vec4f {
            return block.first * vec4f(corner, 0.0, 1.0);
        }
        @fragment fn fs() -> @location(0) vec4f { return block.others[ENDS]; }
        @compute @workgroup_size(1) fn cs(@builtin(workgroup_id) id: vec3u) {
            out[id.x] = block.others[id.y].x;
        }
        @group(0) @binding(0) var<storage, read_write> out: array<f32>;";
    let made = |limit: u32, index: &str| {
        let device = Device::new(&DeviceDescriptor {
            limits: Limits {
                max_immediate_size: limit,
                ..Limits::default()
            },
            ..DeviceDescriptor::default()
        });
        let device = device.expect("a device");
        let text = text.replace("ENDS", index);
        let module = module(&device, ShaderSource::Wgsl(&text));
        let program = device.create_program(&module.program()).expect("it links");
        let size = program.immediate_size();
        let draws = device.create_render_pipeline(&RenderPipelineDescriptor {
            vertex_buffers: vec![VertexBufferLayout::packed(&[
                estampe::VertexFormat::Float32x2,
            ])],
            depth_stencil: None,
            ..RenderPipelineDescriptor::with_program(program)
        });
        let program = device.create_compute_program(&EntryPointDescriptor::new(&module));
        let descriptor = ComputePipelineDescriptor::new(program.expect("it is small"));
        let computes = device.create_compute_pipeline(&descriptor);
        (
            size,
            draws.map(drop).map_err(|error| error.to_string()),
            computes.map(drop).map_err(|error| error.to_string()),
        )
    };
    let refused = |size: u32, limit: u32| {
        Err(format!(
            "the pipeline has {size} bytes of immediates; the limit max_immediate_size is {limit}"
        ))
    };
    // The work-groups read any of the others.
    assert_eq!(made(128, "0"), (32, Ok(()), refused(144, 128)));
    assert_eq!(made(128, "6"), (128, Ok(()), refused(144, 128)));
    assert_eq!(made(128, "7"), (144, refused(144, 128), refused(144, 128)));
    assert_eq!(made(144, "7"), (144, Ok(()), Ok(())));
    assert_eq!(made(28, "0"), (32, refused(32, 28), refused(144, 28)));
}
