//! A pair of GLSL shaders as courses write them: loose uniforms that both declare, set by name, and
//! a structure between the stages. It draws the bytes of the same formulas in WGSL.

use super::{devices, module};
use estampe::state::VertexBufferLayout;
use estampe::{
    BindGroupDescriptor, BindingResource, ColorAttachment, DepthStencilAttachment, Device, Draw,
    Mat4, RenderPass, RenderPipelineDescriptor, ShaderModule, ShaderSource, TextureDescriptor,
    TextureFormat, VertexFormat, bytes_of,
};
use estampe_tests::Random;

const VERTEX: &str = "#version 330 core
layout (location = 0) in vec3 at;
layout (location = 1) in vec3 normal;
out struct Lit { vec3 at; vec3 normal; vec3 paint; } lit;
uniform mat4 model;
uniform mat4 view;
uniform mat4 projection;
uniform vec3 paint;
void main() {
    vec4 world = model * vec4(at, 1.0);
    lit.at = world.xyz;
    lit.normal = (model * vec4(normal, 0.0)).xyz;
    lit.paint = paint;
    gl_Position = projection * view * world;
}";

const FRAGMENT: &str = "#version 330 core
in struct Lit { vec3 at; vec3 normal; vec3 paint; } lit;
#define SHININESS 16.0
uniform mat4 view;
uniform vec3 lamp;
uniform float ambient, diffuse, specular;
layout (location = 0) out vec4 color;
void main() {
    vec3 n = normalize(lit.normal);
    vec3 l = normalize(lamp - lit.at);
    float shine = pow(max(reflect(-l, n).z, 0.0), SHININESS);
    vec3 c = ambient * lit.paint;
    c += diffuse * max(dot(n, l), 0.0) * lit.paint;
    color = vec4(c + specular * shine, view[3][3]);
}";

const WGSL: &str = "
struct Uniforms {
    model: mat4x4f, view: mat4x4f, projection: mat4x4f,
    paint: vec3f, lamp: vec3f, ambient: f32, diffuse: f32, specular: f32,
}
@group(0) @binding(0) var<uniform> u: Uniforms;
struct Lit {
    @builtin(position) position: vec4f,
    @location(0) at: vec3f, @location(1) normal: vec3f, @location(2) paint: vec3f,
}
@vertex fn vs(@location(0) at: vec3f, @location(1) normal: vec3f) -> Lit {
    let world = u.model * vec4f(at, 1.0);
    var position = u.projection * u.view * world;
    // The depths of OpenGL.
    position.z = (position.z + position.w) * 0.5;
    return Lit(position, world.xyz, (u.model * vec4f(normal, 0.0)).xyz, u.paint);
}
@fragment fn fs(lit: Lit) -> @location(0) vec4f {
    let n = normalize(lit.normal);
    let l = normalize(u.lamp - lit.at);
    let shine = pow(max(reflect(-l, n).z, 0.0), 16.0);
    var c = u.ambient * lit.paint;
    c += u.diffuse * max(dot(n, l), 0.0) * lit.paint;
    return vec4f(c + u.specular * shine, u.view[3][3]);
}";

/// Colours and depths that a module draws, whose uniforms are the block of this name.
fn drawn(device: &Device, module: &ShaderModule, block: &str) -> (Vec<u8>, Vec<u8>) {
    let program = device.create_program(&module.program());
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    let formats = [VertexFormat::Float32x3, VertexFormat::Float32x3];
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout::packed(&formats)],
        ..RenderPipelineDescriptor::with_program(program)
    });
    let pipeline = pipeline.unwrap_or_else(|error| panic!("{error}"));
    let mut uniforms = module.uniforms(block).expect("the block");
    let mut set = |name: &str, value: f32| {
        uniforms
            .set(name, value)
            .unwrap_or_else(|error| panic!("{error}"));
    };
    set("ambient", 0.2);
    set("diffuse", 0.7);
    set("specular", 0.4);
    for (name, matrix) in [
        ("model", Mat4::rotation_y(0.5)),
        ("view", Mat4::translation([0.0, 0.0, -4.0])),
        ("projection", Mat4::perspective_gl(1.0, 1.4, 0.5, 20.0)),
    ] {
        uniforms
            .set(name, matrix)
            .unwrap_or_else(|error| panic!("{error}"));
    }
    uniforms
        .set("paint", [0.9_f32, 0.5, 0.2])
        .expect("a uniform");
    uniforms
        .set("lamp", [2.0_f32, 3.0, 4.0])
        .expect("a uniform");
    let buffer = device.create_buffer_with_contents(uniforms.bytes());
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.descriptor().bind_group_layouts[0],
        entries: &[(
            0,
            BindingResource::Buffer(buffer.expect("a small buffer").slice(..)),
        )],
    });
    let mut random = Random::new("glsl", 3);
    let mut vertices = Vec::new();
    for _ in 0..200 * 3 {
        let ([x, y, z, _], [a, b, c, _]) = (random.four(-1.5, 1.5), random.four(-1.0, 1.0));
        vertices.extend([x, y, z, a, b, c]);
    }
    let vertices = device.create_buffer_with_contents(bytes_of(&vertices));
    let image = |format| {
        let descriptor = TextureDescriptor::new_2d(140, 100, format);
        device.create_texture(&descriptor).expect("a small texture")
    };
    let (color, depth) = (
        image(TextureFormat::Rgba8Unorm),
        image(TextureFormat::Depth32Float),
    );
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&color.view(), [0.0; 4]))],
            depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth.view(), 1.0)),
            draws: &[Draw {
                vertex_buffers: &[(&vertices.expect("a small buffer")).into()],
                bind_groups: &[group.unwrap_or_else(|error| panic!("{error}"))],
                ..Draw::new(&pipeline, 0..600)
            }],
            ..RenderPass::default()
        })
        .unwrap_or_else(|error| panic!("{error}"));
    let read = |texture| device.read_texture(texture).expect("it can be read");
    (read(&color), read(&depth))
}

/// Rows: G1
#[test]
fn glsl_draws_the_bytes_of_the_same_shader_in_wgsl() {
    let mut before = None;
    for (name, device) in devices() {
        let glsl = module(
            &device,
            ShaderSource::Glsl {
                vertex: VERTEX,
                fragment: FRAGMENT,
            },
        );
        let of_glsl = drawn(&device, &glsl, "");
        let of_wgsl = drawn(&device, &module(&device, ShaderSource::Wgsl(WGSL)), "u");
        assert!(of_glsl == of_wgsl, "{name}");
        let colors: std::collections::BTreeSet<_> = of_glsl.0.chunks(4).collect();
        assert!(colors.len() > 300, "{}", colors.len());
        assert!(before.is_none_or(|before| before == of_glsl), "{name}");
        before = Some(of_glsl);
    }
}

/// Rows: G1
#[test]
fn uniforms_begin_with_the_values_that_the_shader_gives() {
    let (_, device) = devices().next().expect("a device");
    let device = &device;
    let glsl = module(
        device,
        ShaderSource::Glsl {
            vertex: "#version 330 core
                struct Lamp { vec3 at; bool lit; float reach; };
                const float TWO = 2.0;
                uniform float size = TWO * 0.75;
                uniform mat2 turn = mat2(1.0, 2.0, 3.0, 4.0);
                uniform Lamp lamps[2] = Lamp[2](Lamp(vec3(1), true, 5.0), Lamp(vec3(2, 3, 4), false, 6.0));
                uniform vec2 plain;
                void main() { gl_Position = vec4(turn * plain * size, lamps[1].reach, lamps[0].at.x); }",
            fragment: "#version 330 core
                uniform int counts[3] = int[](-1, 2, 3);
                uniform vec4 tint = vec4(0.25), shade;
                uniform float size = 1.5;
                out vec4 color;
                void main() { color = tint * shade * size * float(counts[1]); }",
        },
    );
    let uniforms = glsl.uniforms("").expect("loose uniforms");
    let expected: [(&str, &[u32]); 11] = [
        ("size", &[1.5_f32.to_bits()]),
        ("turn", &[1.0, 2.0, 3.0, 4.0].map(f32::to_bits)),
        ("lamps[0].at", &[1.0; 3].map(f32::to_bits)),
        ("lamps[0].lit", &[1]),
        ("lamps[0].reach", &[5.0_f32.to_bits()]),
        ("lamps[1].at", &[2.0, 3.0, 4.0].map(f32::to_bits)),
        ("lamps[1].lit", &[0]),
        ("lamps[1].reach", &[6.0_f32.to_bits()]),
        ("counts", &[u32::MAX, 2, 3]),
        ("tint", &[0.25; 4].map(f32::to_bits)),
        ("plain", &[0, 0]),
    ];
    let mut described = vec![0; uniforms.bytes().len()];
    for (name, words) in expected {
        let members = &uniforms.block().members;
        let member = members.iter().find(|member| member.name == name);
        let member = member.unwrap_or_else(|| panic!("{name}"));
        // A column of `turn`, an element of `counts`, or all of it.
        let (length, stride) = match name {
            "turn" => (2, member.matrix_stride),
            "counts" => (1, member.array_stride),
            _ => (words.len(), 0),
        };
        for (part, words) in words.chunks(length).enumerate() {
            let offset = member.offset as usize + part * stride as usize;
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            described[offset..][..bytes.len()].copy_from_slice(&bytes);
        }
    }
    assert_eq!(uniforms.bytes(), described);
}
