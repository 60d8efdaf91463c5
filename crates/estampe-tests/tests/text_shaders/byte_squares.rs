//! Sprites with a mask of one byte a texel, which changes between passes: squares of its texels,
//! made once a pass has sampled it, change no picture.

use super::{devices, module};
use estampe::state::{BlendComponent, BlendFactor, BlendState, ColorTargetState};
use estampe::{
    AddressMode, BindGroup, BindGroupDescriptor, BindingResource, ColorAttachment, Device, Draw,
    Extent3d, RenderPass, RenderPipeline, RenderPipelineDescriptor, SamplerDescriptor,
    ShaderSource, TexelCopyLayout, Texture, TextureDescriptor, TextureFormat,
};

/// Sprites of 1 to 40 pixels, whose coordinates are beyond the mask's edges, too.
const WGSL: &str = "
@group(0) @binding(0) var mask: texture_2d<f32>;
@group(0) @binding(1) var any: sampler;
struct Varyings { @builtin(position) position: vec4f, @location(0) uv: vec2f }
@vertex fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) n: u32) -> Varyings {
    let corner = vec2f(f32(i & 1u), f32(i >> 1u));
    let k = f32(n);
    let place = vec2f(fract(k * 0.618), fract(k * 0.414)) * 2.0 - 1.0;
    let size = vec2f(0.01 + fract(k * 0.271) * 0.4, 0.01 + fract(k * 0.733) * 0.5);
    return Varyings(vec4f(place + (corner - 0.5) * size, 0.5, 1.0), corner * 1.3 - 0.15);
}
@fragment fn fragment(in: Varyings) -> @location(0) vec4f {
    return vec4f(0.3, 0.2, 0.1, 0.0) * textureSample(mask, any, in.uv).r;
}
";

/// A triangle over the upper left half.
const HALF: &str = "
@vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 2.0 - 1.0, 1.0 - f32(i >> 1u) * 2.0, 0.5, 1.0);
}
@fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(fract(at.x * 0.37 + at.y * 0.61));
}
";

fn pipeline(device: &Device, text: &str, target: ColorTargetState) -> RenderPipeline {
    let module = module(device, ShaderSource::Wgsl(text));
    let program = device.create_program(&module.program());
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    let mut descriptor = RenderPipelineDescriptor::with_program(program);
    descriptor.depth_stencil = None;
    descriptor.targets = vec![Some(target)];
    if text == WGSL {
        descriptor.primitive.topology = estampe::state::PrimitiveTopology::TriangleStrip;
    }
    let made = device.create_render_pipeline(&descriptor);
    made.unwrap_or_else(|error| panic!("{error}"))
}

/// The picture of the sprites.
fn sprites(device: &Device, pipeline: &RenderPipeline, group: &BindGroup) -> Vec<u8> {
    let descriptor = TextureDescriptor::new_2d(150, 90, TextureFormat::Rgba8Unorm);
    let picture = device.create_texture(&descriptor).expect("a small texture");
    let drawn = device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&picture.view(), [0.0; 4]))],
        draws: &[Draw {
            bind_groups: std::slice::from_ref(group),
            instances: 0..200,
            ..Draw::new(pipeline, 0..4)
        }],
        ..RenderPass::default()
    });
    drawn.unwrap_or_else(|error| panic!("{error}"));
    device.read_texture(&picture).expect("it can be read")
}

/// The pictures after each change of the mask, of which three passes each sample the mask.
fn pictures(device: &Device, sampler: &SamplerDescriptor) -> Vec<Vec<u8>> {
    let add = BlendComponent {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
        ..BlendComponent::default()
    };
    let adds = ColorTargetState {
        blend: Some(BlendState {
            color: add,
            alpha: add,
        }),
        ..TextureFormat::Rgba8Unorm.into()
    };
    let pipelines = [
        pipeline(device, WGSL, adds),
        pipeline(device, HALF, TextureFormat::R8Unorm.into()),
    ];
    let descriptor = TextureDescriptor::new_2d(24, 18, TextureFormat::R8Unorm).with_all_levels();
    let texels: Vec<u8> = (0..24 * 18_u32).map(|at| (at * 89 % 251) as u8).collect();
    let mask = device.create_texture_with_data(&descriptor, &[&texels]);
    let mask: Texture = mask.expect("a small texture");
    let sampler = device.create_sampler(sampler).expect("a sampler");
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipelines[0].descriptor().bind_group_layouts[0],
        entries: &[
            (0, BindingResource::Texture(mask.view())),
            (1, BindingResource::Sampler(sampler)),
        ],
    });
    let group = group.unwrap_or_else(|error| panic!("{error}"));
    let mut pictures = Vec::new();
    for change in 0..4 {
        match change {
            1 => {
                let part = Extent3d::new_2d(5, 3);
                let layout = TexelCopyLayout::default();
                let written = device.write_texture(&mask, &[200; 15], &layout, part);
                written.unwrap_or_else(|error| panic!("{error}"));
            }
            2 => {
                let image = mask.image(0, 0).expect("level 0");
                let drawn = device.render(&RenderPass {
                    color_attachments: &[Some(ColorAttachment::load(&image))],
                    draws: &[Draw::new(&pipelines[1], 0..3)],
                    ..RenderPass::default()
                });
                drawn.unwrap_or_else(|error| panic!("{error}"));
            }
            _ => {}
        }
        let passes = [(); 3].map(|()| sprites(device, &pipelines[0], &group));
        assert!(
            passes[0] == passes[1] && passes[0] == passes[2],
            "change {change}"
        );
        pictures.extend(passes.into_iter().next());
    }
    pictures
}

#[test]
fn masks_that_change_are_sampled_as_they_are() {
    let clamped = SamplerDescriptor {
        address_mode_u: AddressMode::ClampToEdge,
        address_mode_v: AddressMode::MirrorRepeat,
        ..SamplerDescriptor::trilinear_repeat()
    };
    for sampler in [SamplerDescriptor::trilinear_repeat(), clamped] {
        // The first one has no code for squares.
        let mut expected = None;
        for (name, device) in devices() {
            let drawn = pictures(&device, &sampler);
            let changes = drawn.windows(2).map(|pair| pair[0] != pair[1]);
            assert_eq!(changes.collect::<Vec<_>>(), [true, true, false], "{name}");
            if expected.is_none() {
                assert!(!device.level().is_specialized(), "{name}");
            }
            let expected = expected.get_or_insert_with(|| drawn.clone());
            assert!(*expected == drawn, "{name}");
        }
    }
}
