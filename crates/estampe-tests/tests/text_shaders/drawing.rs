//! A shader as text draws the same bytes as the same formulas in Rust.

use super::{devices, module};
use estampe::state::VertexBufferLayout;
use estampe::{
    BindGroup, BindGroupDescriptor, BindingResource, ColorAttachment, Device, Draw,
    EntryPointDescriptor, FragmentIn, FragmentOut, Mat4, ProgramDescriptor, RenderPass,
    RenderPipeline, RenderPipelineDescriptor, SampledTexture, Sampler, SamplerDescriptor,
    ShaderSource, Texture, TextureDescriptor, TextureFormat, Vec2, Vec3, Vec4, VertexFormat,
    VertexIn, VertexOut, WithGradient, bytes_of,
};
use estampe_tests::Random;

const WGSL: &str = "
struct Scene {
    clip_from_object: mat4x4f,
    towards_light: vec3f,
    ambient: f32,
}
@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var base: texture_2d<f32>;
@group(0) @binding(2) var linear: sampler;

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
    @location(1) uv: vec2f,
}

@vertex fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) uv: vec2f)
    -> Varyings {
    return Varyings(scene.clip_from_object * vec4f(position, 1.0), normal, uv);
}

@fragment fn fragment(in: Varyings) -> @location(0) vec4f {
    let color = textureSample(base, linear, in.uv);
    let light = max(dot(normalize(in.normal), scene.towards_light), 0.0) + scene.ambient;
    if color.a < 0.25 { discard; }
    return vec4f(color.rgb * light, color.a);
}
";

#[derive(Clone)]
struct Lit {
    clip_from_object: Mat4,
    towards_light: [f32; 3],
    ambient: f32,
    base: SampledTexture,
}

estampe::shader! {
    impl Shader for Lit {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>, Vec2<R>);
        type Varyings<R: Real> = (Vec3<R>, WithGradient<Vec2<R>>);

        fn vertex<R: Real>(
            &self,
            _: VertexIn<'_, R>,
            (position, normal, uv): (Vec3<R>, Vec3<R>, Vec2<R>),
        ) -> VertexOut<R, (Vec3<R>, WithGradient<Vec2<R>>)> {
            VertexOut::new(self.clip_from_object.transform_point(position), (normal, uv.into()))
        }

        fn fragment<R: Real>(
            &self,
            _: FragmentIn<'_, R>,
            (normal, uv): (Vec3<R>, WithGradient<Vec2<R>>),
        ) -> FragmentOut<R> {
            let color = self.base.sample(uv);
            let [x, y, z] = self.towards_light;
            let light = normal.normalize().dot(Vec3::new(x, y, z)).max(0.0) + self.ambient;
            let kept = !color.w.lt(0.25);
            FragmentOut::color(Vec4::new(
                color.x * light,
                color.y * light,
                color.z * light,
                color.w,
            ))
            .discard_unless(kept)
        }
    }
}

/// Triangles in and out of the view, some large and some behind the eye.
fn vertices() -> Vec<[f32; 8]> {
    let mut random = Random::new("text shaders", 11);
    let mut vertices = Vec::new();
    for _ in 0..60 {
        let center = random.four(-2.0, 2.0);
        for _ in 0..3 {
            let [x, y, z, u] = random.four(-1.0, 1.0);
            let [nx, ny, nz, v] = random.four(-1.0, 1.0);
            let at = [x + center[0], y + center[1], z + center[2]];
            vertices.push([at[0], at[1], at[2], nx, ny, nz, u * 3.0, v * 3.0]);
        }
    }
    vertices
}

/// A texture of noise, whose alpha is small in places.
fn noise(device: &Device) -> (Texture, Sampler) {
    let mut random = Random::new("text shaders", 5);
    let texels: Vec<u8> = (0..16 * 16 * 4)
        .map(|_| random.pick(&[0, 40, 90, 255]))
        .collect();
    let descriptor = TextureDescriptor::new_2d(16, 16, TextureFormat::Rgba8Unorm);
    let texture = device
        .create_texture_with_data(&descriptor.with_all_levels(), &[&texels])
        .expect("a small texture");
    let sampler = device.create_sampler(&SamplerDescriptor::default());
    (texture, sampler.expect("the default"))
}

fn drawn(device: &Device, pipeline: &RenderPipeline, groups: &[BindGroup]) -> Vec<u8> {
    let descriptor = TextureDescriptor::new_2d(150, 100, TextureFormat::Rgba8Unorm);
    let color = device.create_texture(&descriptor).expect("a small texture");
    let vertices = vertices();
    let buffer = device.create_buffer_with_contents(bytes_of(vertices.as_flattened()));
    let buffer = buffer.expect("a small buffer");
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&color.view(), [0.2; 4]))],
            draws: &[Draw {
                vertex_buffers: &[(&buffer).into()],
                bind_groups: groups,
                ..Draw::new(pipeline, 0..180)
            }],
            ..RenderPass::default()
        })
        .unwrap_or_else(|error| panic!("{error}"));
    device.read_texture(&color).expect("a color attachment")
}

/// Rows: G2
#[test]
fn wgsl_draws_the_bytes_of_the_same_shader_in_rust() {
    let clip_from_object =
        Mat4::perspective(1.0, 1.5, 0.1, 10.0) * Mat4::translation([0.0, 0.0, -3.0]);
    let (towards_light, ambient) = ([0.6, 0.0, 0.8], 0.25);
    let mut before: Option<Vec<u8>> = None;
    for (name, device) in devices() {
        let (texture, sampler) = noise(&device);
        let base = device
            .sampled_texture(&texture.view(), &sampler)
            .expect("it fits");
        let formats = [
            VertexFormat::Float32x3,
            VertexFormat::Float32x3,
            VertexFormat::Float32x2,
        ];
        let with_state = |descriptor: RenderPipelineDescriptor| RenderPipelineDescriptor {
            vertex_buffers: vec![VertexBufferLayout::packed(&formats)],
            depth_stencil: None,
            ..descriptor
        };
        let in_rust = with_state(RenderPipelineDescriptor::new(Lit {
            clip_from_object,
            towards_light,
            ambient,
            base,
        }));
        let in_rust = device.create_render_pipeline(&in_rust).expect("it fits");
        let expected = drawn(&device, &in_rust, &[]);
        assert!(before.is_none_or(|before| before == expected), "{name}");

        let module = module(&device, ShaderSource::Wgsl(WGSL));
        let program = device.create_program(&module.program());
        let program = program.unwrap_or_else(|error| panic!("{error}"));
        let in_wgsl = with_state(RenderPipelineDescriptor::with_program(program));
        let in_wgsl = device.create_render_pipeline(&in_wgsl);
        let in_wgsl = in_wgsl.unwrap_or_else(|error| panic!("{error}"));
        let mut scene: Vec<f32> = clip_from_object.0.as_flattened().to_vec();
        scene.extend(towards_light);
        scene.push(ambient);
        let scene = device.create_buffer_with_contents(bytes_of(&scene));
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &in_wgsl.descriptor().bind_group_layouts[0],
            entries: &[
                (
                    0,
                    BindingResource::Buffer(scene.expect("a small buffer").slice(..)),
                ),
                (1, BindingResource::Texture(texture.view())),
                (2, BindingResource::Sampler(sampler)),
            ],
        });
        let group = group.unwrap_or_else(|error| panic!("{error}"));
        let bytes = drawn(&device, &in_wgsl, &[group]);
        let colors: std::collections::BTreeSet<_> = expected.chunks(4).collect();
        assert!(colors.len() > 1000, "something is drawn");
        let different = bytes.iter().zip(&expected).filter(|(a, b)| a != b).count();
        assert_eq!(different, 0, "{name}");
        before = Some(expected);
    }
}

const STORING: &str = "
struct List { count: atomic<u32>, pixels: array<u32> }
@group(0) @binding(0) var<storage, read_write> list: List;
@group(0) @binding(1) var image: texture_storage_2d<r32uint, read_write>;
@vertex fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return vec4f(position.xy / 3.0, 0.5, 1.0);
}
@fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(at.xy);
    list.pixels[atomicAdd(&list.count, 1u)] = pixel.y * 150u + pixel.x;
    return vec4f(1.0);
}
@fragment fn counting(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(at.xy);
    textureStore(image, pixel, textureLoad(image, pixel) + vec4u(1u));
    atomicAdd(&list.count, 1u);
    return vec4f(1.0);
}
";

/// A list of the fragments in the order in which they were shaded, which is one at every level and
/// on every number of threads; and counts by pixel, which are shaded on all threads.
#[test]
fn fragments_store_in_one_order() {
    let mut before: Option<[Vec<u8>; 3]> = None;
    for (name, device) in devices() {
        let list = device
            .create_buffer_of_words(vec![0; 1 + 200_000])
            .expect("it is small");
        let descriptor = TextureDescriptor::new_2d(150, 100, TextureFormat::R32Uint);
        let image = device.create_texture(&descriptor).expect("a small texture");
        let mut read = Vec::new();
        let module = module(&device, ShaderSource::Wgsl(STORING));
        for (at, name) in ["fragment", "counting"].into_iter().enumerate() {
            let program = device.create_program(&ProgramDescriptor {
                fragment: Some(EntryPointDescriptor {
                    name: Some(name),
                    ..EntryPointDescriptor::new(&module)
                }),
                ..module.program()
            });
            let program = program.unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(program.interface().stores_in_any_order, at == 1);
            let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
                vertex_buffers: vec![VertexBufferLayout {
                    array_stride: 32,
                    ..VertexBufferLayout::packed(&[VertexFormat::Float32x3])
                }],
                depth_stencil: None,
                ..RenderPipelineDescriptor::with_program(program)
            });
            let pipeline = pipeline.unwrap_or_else(|error| panic!("{error}"));
            let entries = [
                (0, BindingResource::Buffer(list.slice(..))),
                (1, BindingResource::Texture(image.view())),
            ];
            let group = device.create_bind_group(&BindGroupDescriptor {
                label: None,
                layout: &pipeline.descriptor().bind_group_layouts[0],
                entries: &entries[..=at],
            });
            drawn(
                &device,
                &pipeline,
                &[group.unwrap_or_else(|error| panic!("{error}"))],
            );
            let mut bytes = vec![0; 4 * 200_001];
            list.read(0, &mut bytes).expect("a readable buffer");
            read.push(bytes);
        }
        read.push(device.read_texture(&image).expect("a readable texture"));
        let count = |bytes: &[u8]| u32::from_le_bytes(bytes[..4].try_into().expect("four"));
        let fragments = count(&read[0]);
        assert!((5_000..200_000).contains(&fragments), "{fragments}");
        assert_eq!(count(&read[1]), 2 * fragments, "{name}");
        let counted: u32 = read[2].chunks(4).map(count).sum();
        assert_eq!(counted, fragments, "{name}");
        let read: [Vec<u8>; 3] = read.try_into().expect("three");
        assert!(before.is_none_or(|before| before == read), "{name}");
        before = Some(read);
    }
}
