//! Fragments that are known to have no effect before a texture is sampled for them.
//!
//! The same picture is drawn with shaders whose alpha test the compiler recognises, and with others
//! that add a varying to alpha, which is −0 everywhere, so that nothing is known of the sum.

use super::{devices, module, program};
use estampe::state::{ColorTargetState, DepthStencilState, MultisampleState, VertexBufferLayout};
use estampe::{
    AddressMode, BindGroup, BindGroupDescriptor, BindingResource, ColorAttachment,
    DepthStencilAttachment, Device, Draw, Extent3d, FilterMode, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, SamplerDescriptor, ShaderModule, ShaderSource, Statistics,
    TextureDescriptor, TextureFormat, TextureViewDescriptor, VertexFormat, ViewDimension, bytes_of,
};
use estampe_tests::Random;

const WGSL: &str = "
struct Test { cutoff: f32, scale: f32, is_on: u32 }
@group(0) @binding(0) var images: texture_2d_array<f32>;
@group(0) @binding(1) var any: sampler;
@group(0) @binding(2) var<uniform> test: Test;
struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) @interpolate(flat) layer: i32,
    @location(2) nothing: f32,
}
@vertex fn vertex(@location(0) position: vec4f, @location(1) uv: vec2f, @location(2) layer: f32)
    -> Varyings {
    return Varyings(position, uv, i32(layer), -0.0);
}
fn tested(color: vec4f, alpha: f32) -> vec4f {
    if test.is_on == 1u && alpha * test.scale < test.cutoff { discard; }
    return color;
}
@fragment fn known(in: Varyings) -> @location(0) vec4f {
    let color = textureSample(images, any, in.uv, in.layer);
    return tested(color, color.a);
}
@fragment fn unknown(in: Varyings) -> @location(0) vec4f {
    let color = textureSample(images, any, in.uv, in.layer);
    return tested(color, color.a + in.nothing);
}
@fragment fn known_edge(in: Varyings) -> @location(0) vec4f {
    let color = textureSample(images, any, in.uv, in.layer);
    return tested(color, color.a + fwidth(color.a));
}
@fragment fn unknown_edge(in: Varyings) -> @location(0) vec4f {
    let color = textureSample(images, any, in.uv, in.layer);
    return tested(color, color.a + in.nothing + fwidth(color.a));
}
fn covered(color: vec4f, alpha: f32) -> vec4f {
    let slope = max(fwidth(alpha), 0.0001);
    return vec4f(color.rgb, clamp((alpha * test.scale - test.cutoff) / slope + 0.5, 0.0, 1.0));
}
@fragment fn known_coverage(in: Varyings) -> @location(0) vec4f {
    let color = textureSample(images, any, in.uv, in.layer);
    return covered(color, color.a);
}
@fragment fn unknown_coverage(in: Varyings) -> @location(0) vec4f {
    let color = textureSample(images, any, in.uv, in.layer);
    return covered(color, color.a + in.nothing);
}
";

const SIZE: [u32; 2] = [150, 110];

/// What decides whether a fragment has an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Alpha.
    Discard,
    /// Alpha and its derivatives, for which quads are shaded whole.
    Edge,
    /// Alpha and its derivatives, as coverage.
    Coverage,
}

/// A picture of textured triangles.
#[derive(Debug)]
struct Picture {
    samples: u32,
    kind: Kind,
    format: TextureFormat,
    /// Width, height and layers of the texture.
    sides: [u32; 3],
    texels: Vec<u8>,
    sampler: SamplerDescriptor,
    /// The uniforms: the threshold, what alpha is multiplied by, and whether there is a test.
    cutoff: f32,
    scale: f32,
    is_on: u32,
    /// x, y, z, w, u, v and layer.
    vertices: Vec<[f32; 7]>,
}

impl Picture {
    fn new(random: &mut Random, samples: u32) -> Self {
        let sides = [
            1 + random.below(48),
            1 + random.below(48),
            1 + random.below(3),
        ];
        let address = [AddressMode::Repeat, AddressMode::ClampToEdge];
        let filters = [FilterMode::Linear, FilterMode::Linear, FilterMode::Nearest];
        let least = random.pick(&[0.0, 0.0, 0.0, 0.7, 2.0]);
        Self {
            samples,
            kind: match random.below(if samples > 1 { 3 } else { 2 }) {
                0 => Kind::Discard,
                1 => Kind::Edge,
                _ => Kind::Coverage,
            },
            format: random.pick(&[TextureFormat::Rgba8Unorm, TextureFormat::Rgba8UnormSrgb]),
            sides,
            texels: blobs(random, sides),
            sampler: SamplerDescriptor {
                address_mode_u: random.pick(&address),
                address_mode_v: random.pick(&address),
                mag_filter: random.pick(&filters),
                min_filter: random.pick(&filters),
                mipmap_filter: random.pick(&filters),
                lod_min_clamp: least,
                lod_max_clamp: random.pick(&[32.0, 32.0, least, least + 1.2]),
                ..SamplerDescriptor::default()
            },
            cutoff: random.pick(&[0.5, 0.5, 0.1, 0.9, 0.004]),
            scale: random.pick(&[1.0, 1.0, 0.8, 1.5]),
            is_on: u32::from(!random.once_in(12)),
            vertices: triangles(random, sides),
        }
    }
}

/// Texels whose alpha is 0 but in some rectangles.
fn blobs(random: &mut Random, [width, height, layers]: [u32; 3]) -> Vec<u8> {
    let mut texels = Vec::new();
    for _ in 0..layers {
        let rectangles: Vec<[u32; 4]> = (0..1 + random.below(4))
            .map(|_| {
                let [x, y] = [random.below(width), random.below(height)];
                [
                    x,
                    y,
                    x + 1 + random.below(width),
                    y + 1 + random.below(height),
                ]
            })
            .collect();
        let is_rough = random.once_in(3);
        for y in 0..height {
            for x in 0..width {
                let is_inside = |[x0, y0, x1, y1]: &[u32; 4]| {
                    (*x0..*x1).contains(&x) && (*y0..*y1).contains(&y) && (x * y) % 7 != 0
                };
                let alpha = match rectangles.iter().filter(|of| is_inside(of)).count() {
                    0 if is_rough => random.byte() / 3,
                    0 => 0,
                    1 => 255,
                    _ => random.byte(),
                };
                texels.extend([random.byte(), random.byte(), random.byte(), alpha]);
            }
        }
    }
    texels
}

/// Small triangles, large ones, and rectangles, with and without perspective.
fn triangles(random: &mut Random, [width, height, layers]: [u32; 3]) -> Vec<[f32; 7]> {
    let mut vertices = Vec::new();
    for _ in 0..60 {
        let extent = random.pick(&[0.06, 0.1, 0.2, 0.5, 1.5]);
        let texels = random.pick(&[0.3, 1.0, 1.0, 3.0, 9.0]) * extent;
        let has_perspective = random.once_in(3);
        let [x, y, z, turn] = random.four(-1.0, 1.0);
        let [u, v, ..] = random.four(-0.3, 1.0);
        let layer = random.below(layers + 1) as f32;
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let corners = corners.map(|[across, down]: [f32; 2]| {
            let w = match has_perspective {
                true => random.range(0.5, 2.0),
                false => 1.0,
            };
            let (right, below) = match turn > 0.5 {
                true => (across + turn * down, down - turn * across),
                false => (across, down),
            };
            [
                (x + right * extent) * w,
                (y + below * extent) * w,
                (z * 0.5 + 0.5) * w,
                w,
                u + across * texels * SIZE[0] as f32 / (2 * width) as f32,
                v + down * texels * SIZE[1] as f32 / (2 * height) as f32,
                layer,
            ]
        });
        vertices.extend([0, 1, 2, 0, 2, 3].map(|corner| corners[corner]));
    }
    vertices
}

fn pipeline(
    device: &Device,
    module: &ShaderModule,
    (picture, name): (&Picture, &'static str),
) -> RenderPipeline {
    let formats = [
        VertexFormat::Float32x4,
        VertexFormat::Float32x2,
        VertexFormat::Float32,
    ];
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout::packed(&formats)],
        depth_stencil: Some(DepthStencilState::LESS_WRITE),
        multisample: MultisampleState {
            count: picture.samples,
            alpha_to_coverage_enabled: picture.kind == Kind::Coverage,
            ..MultisampleState::default()
        },
        targets: vec![Some(ColorTargetState::from(TextureFormat::Rgba8Unorm))],
        ..RenderPipelineDescriptor::with_program(program(device, module, name))
    });
    pipeline.unwrap_or_else(|error| panic!("{error}"))
}

fn bound(device: &Device, pipeline: &RenderPipeline, picture: &Picture) -> [BindGroup; 1] {
    let [width, height, layers] = picture.sides;
    let descriptor = TextureDescriptor {
        size: Extent3d {
            width,
            height,
            depth_or_array_layers: layers,
        },
        ..TextureDescriptor::new_2d(width, height, picture.format)
    };
    let images = device
        .create_texture_with_data(&descriptor.with_all_levels(), &[picture.texels.as_slice()]);
    let images = images.unwrap_or_else(|error| panic!("{error}"));
    let uniforms = [
        picture.cutoff.to_bits(),
        picture.scale.to_bits(),
        picture.is_on,
    ];
    let uniforms = device.create_buffer_of_words(uniforms.to_vec());
    let view = images.create_view(&TextureViewDescriptor {
        dimension: Some(ViewDimension::D2Array),
        ..TextureViewDescriptor::default()
    });
    let sampler = device.create_sampler(&picture.sampler).expect("a sampler");
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.descriptor().bind_group_layouts[0],
        entries: &[
            (0, BindingResource::Texture(view.expect("a view"))),
            (1, BindingResource::Sampler(sampler)),
            (
                2,
                BindingResource::Buffer(uniforms.expect("small").slice(..)),
            ),
        ],
    });
    [group.unwrap_or_else(|error| panic!("{error}"))]
}

/// The bytes of a picture by a fragment shader, drawn in turns with its texture and uniforms and
/// with those of another one.
fn drawn(
    device: &Device,
    module: &ShaderModule,
    (picture, other, name): (&Picture, &Picture, &'static str),
) -> (Vec<u8>, Statistics) {
    let pipeline = pipeline(device, module, (picture, name));
    let groups = [picture, other].map(|of| bound(device, &pipeline, of));
    let [width, height] = SIZE;
    let image = |format, samples| {
        let descriptor = TextureDescriptor {
            sample_count: samples,
            ..TextureDescriptor::new_2d(width, height, format)
        };
        device.create_texture(&descriptor).expect("a small texture")
    };
    let color = image(TextureFormat::Rgba8Unorm, picture.samples);
    let resolved = image(TextureFormat::Rgba8Unorm, 1);
    let depth = image(TextureFormat::Depth32Float, picture.samples);
    let vertices = device.create_buffer_with_contents(bytes_of(picture.vertices.as_flattened()));
    let buffers = [vertices.expect("a small buffer").slice(..)];
    let count = u32::try_from(picture.vertices.len()).expect("few");
    let parts = (0..count).step_by(90).zip(groups.iter().cycle());
    let draws = parts.map(|(first, bind_groups)| Draw {
        vertex_buffers: &buffers,
        bind_groups,
        ..Draw::new(&pipeline, first..count.min(first + 90))
    });
    let clear = ColorAttachment::clear(&color.view(), [0.2, 0.0, 0.0, 0.0]);
    let attachment = match picture.samples {
        1 => clear,
        _ => ColorAttachment {
            resolve_target: Some(resolved.view()),
            ..clear
        },
    };
    let statistics = device.render(&RenderPass {
        color_attachments: &[Some(attachment)],
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth.view(), 1.0)),
        draws: &draws.collect::<Vec<_>>(),
        ..RenderPass::default()
    });
    let statistics = statistics.unwrap_or_else(|error| panic!("{error}"));
    let shown = if picture.samples == 1 {
        &color
    } else {
        &resolved
    };
    (
        device.read_texture(shown).expect("it can be read"),
        statistics,
    )
}

/// Rows: F1, F2, R6, O9
#[test]
fn fragments_that_fail_by_alpha_alone_change_nothing() {
    let mut failing = [[0; 2]; 3];
    for (name, device) in devices() {
        let module = module(&device, ShaderSource::Wgsl(WGSL));
        for number in 0..60 {
            let mut random = Random::new("alpha tests", number);
            let samples = random.pick(&[1, 4]);
            let [picture, other] = [(); 2].map(|()| Picture::new(&mut random, samples));
            let names = match picture.kind {
                Kind::Discard => ["known", "unknown"],
                Kind::Edge => ["known_edge", "unknown_edge"],
                Kind::Coverage => ["known_coverage", "unknown_coverage"],
            };
            let [known, unknown] =
                names.map(|name| drawn(&device, &module, (&picture, &other, name)));
            assert!(
                known.0 == unknown.0,
                "{name}, case {number}: {} fragments changed {picture:?}",
                known.1.fragments_failing_alpha
            );
            assert_eq!(
                unknown.1.fragments_failing_alpha, 0,
                "{name}, case {number}"
            );
            let counts = &mut failing[picture.kind as usize];
            counts[0] += known.1.fragments_failing_alpha;
            counts[1] += unknown.1.fragments_shaded;
        }
    }
    for [failing, all] in failing {
        assert!(failing * 8 > all && failing < all, "{failing} of {all}");
    }
}
