//! `textureSampleBaseClampToEdge` of WGSL.

use super::picture::{drawn, pipeline};
use super::{devices, module};
use estampe::{
    BindGroupDescriptor, BindingResource, SamplerDescriptor, ShaderSource, TextureDescriptor,
    TextureFormat,
};
use estampe_tests::Random;

/// A picture of coordinates from −½ to 1½.
fn text(sampled: &str) -> String {
    format!(
        "
@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var any: sampler;
@vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}}
@fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {{
    let uv = at.xy / 16.0 - 0.5;
    return {sampled};
}}
"
    )
}

/// It reads level 0 as if the sampler clamped to the edge, whatever the sampler says: here it
/// repeats, and selects another level.
#[test]
fn the_base_level_is_sampled_inside_its_edge() {
    const CLAMPED: &str = "textureSampleBaseClampToEdge(image, any, uv)";
    const LEVEL_0: &str = "textureSampleLevel(image, any, uv, 0.0)";
    let mut random = Random::new("clamped_sampling", 9);
    let bytes = Vec::from_iter((0..7 * 5 * 4).map(|_| random.byte()));
    for (name, device) in devices() {
        let descriptor = TextureDescriptor::new_2d(7, 5, TextureFormat::Rgba8Unorm);
        let image = device
            .create_texture_with_data(&descriptor.with_all_levels(), &[&bytes])
            .expect("a small texture");
        let draw = |sampled: &str, sampler: SamplerDescriptor| {
            let pipeline = pipeline(
                &device,
                &module(&device, ShaderSource::Wgsl(&text(sampled))),
            );
            let sampler = device.create_sampler(&sampler).expect("a sampler");
            let group = device.create_bind_group(&BindGroupDescriptor {
                label: None,
                layout: &pipeline.descriptor().bind_group_layouts[0],
                entries: &[
                    (0, BindingResource::Texture(image.view())),
                    (1, BindingResource::Sampler(sampler)),
                ],
            });
            let group = group.unwrap_or_else(|error| panic!("{error}"));
            drawn(&device, &pipeline, &[group], [32, 32])
        };
        let repeated = SamplerDescriptor {
            lod_min_clamp: 1.0,
            ..SamplerDescriptor::trilinear_repeat()
        };
        let clamped = draw(CLAMPED, SamplerDescriptor::trilinear_repeat());
        let wanted = draw(LEVEL_0, SamplerDescriptor::linear());
        assert_eq!(clamped, wanted, "{name}");
        let unclamped = draw(LEVEL_0, SamplerDescriptor::trilinear_repeat());
        assert_ne!(clamped, unclamped, "{name}");
        // The sampler's least level holds.
        assert_ne!(clamped, draw(CLAMPED, repeated), "{name}");
    }
}
