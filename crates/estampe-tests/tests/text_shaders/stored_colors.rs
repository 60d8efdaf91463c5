//! Panels of one colour, which depends on what another draw of the pass stores.
//!
//! Colours of primitives over which nothing varies are kept from primitive to primitive and from
//! tile to tile. Those that were shaded before a store must not be shown behind it.

use super::{devices, module, program};
use estampe::state::{BlendState, ColorTargetState};
use estampe::{
    BindGroup, BindGroupDescriptor, BindingResource, Buffer, ColorAttachment, Device, Draw,
    RenderPass, RenderPipeline, RenderPipelineDescriptor, ShaderModule, ShaderSource, Statistics,
    TextureDescriptor, TextureFormat, VertexFormat, bytes_of,
};
use estampe_tests::Random;
use estampe_types::state::VertexBufferLayout;

const WGSL: &str = "
@group(0) @binding(0) var<storage, read_write> values: array<u32, 4>;
struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) color: vec4f,
    @location(1) slot: f32,
}
@vertex fn vertex(
    @location(0) position: vec2f,
    @location(1) color: vec4f,
    @location(2) slot: f32,
) -> Varyings {
    return Varyings(vec4f(position, 0.5, 1.0), color, slot);
}
@fragment fn reads(in: Varyings) -> @location(0) vec4f {
    let scale = f32(values[u32(in.slot)]) / 16.0;
    return vec4f(in.color.rgb * scale, in.color.a);
}
@fragment fn stores(in: Varyings) -> @location(0) vec4f {
    let slot = u32(in.slot);
    values[slot] = 5u + 3u * slot;
    return vec4f(0.0);
}
";

/// The slots before the store, and after it.
const BEFORE: [u32; 4] = [16, 2, 9, 0];
const AFTER: [u32; 4] = [5, 8, 11, 14];

const SIZE: [u32; 2] = [200, 140];

/// Position, colour and slot.
type Vertex = [f32; 7];

/// A fan of one colour around a place, or the whole picture.
fn panel(random: &mut Random, is_everywhere: bool, slot: f32) -> Vec<Vertex> {
    let colors = [
        [1.0, 0.5, 0.25, 1.0],
        [0.2, 0.6, 0.4, 0.8],
        [0.0, 0.25, 0.5, 0.5],
    ];
    let [r, g, b, alpha] = random.pick(&colors);
    let alpha = if is_everywhere { 1.0 } else { alpha };
    // Of a hexagon, or of a square around the picture.
    let hexagon = [[2, 0], [1, 2], [-1, 2], [-2, 0], [-1, -2], [1, -2]];
    let square = [[1, 1], [-1, 1], [-1, -1], [1, -1]];
    let ([x, y, width, height], corners) = match is_everywhere {
        true => ([0.0, 0.0, 1.0, 1.0], square.as_slice()),
        false => (random.four(-0.5, 0.5), hexagon.as_slice()),
    };
    let corner = |corner: usize| {
        let [across, down] = corners[corner].map(|at: i8| f32::from(at));
        [x + across * width, y + down * height, r, g, b, alpha, slot]
    };
    let triangles = (1..corners.len() - 1).map(|at| [corner(0), corner(at), corner(at + 1)]);
    triangles.flatten().collect()
}

/// Panels, of which the first one is everywhere.
fn panels(random: &mut Random, count: u32) -> Vec<Vertex> {
    let slot = |random: &mut Random| random.pick(&[0.0, 1.0, 2.0, 3.0]);
    let mut vertices = Vec::new();
    for number in 0..count {
        let slot = slot(random);
        vertices.extend(panel(random, number == 0, slot));
    }
    vertices
}

fn pipeline(device: &Device, module: &ShaderModule, name: &'static str) -> RenderPipeline {
    let formats = [
        VertexFormat::Float32x2,
        VertexFormat::Float32x4,
        VertexFormat::Float32,
    ];
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout::packed(&formats)],
        depth_stencil: None,
        targets: vec![Some(ColorTargetState {
            blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            ..TextureFormat::Rgba8Unorm.into()
        })],
        ..RenderPipelineDescriptor::with_program(program(device, module, name))
    });
    pipeline.unwrap_or_else(|error| panic!("{error}"))
}

fn bound(device: &Device, pipeline: &RenderPipeline, values: &Buffer) -> [BindGroup; 1] {
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.descriptor().bind_group_layouts[0],
        entries: &[(0, BindingResource::Buffer(values.slice(..)))],
    });
    [group.expect("a buffer that fits")]
}

/// The picture of some draws of vertices.
fn drawn(
    device: &Device,
    values: [u32; 4],
    draws: &[(&RenderPipeline, Vec<Vertex>)],
) -> (Vec<u8>, Statistics) {
    let values = device.create_buffer_of_words(values.to_vec());
    let values = values.expect("a small buffer");
    let descriptor = TextureDescriptor::new_2d(SIZE[0], SIZE[1], TextureFormat::Rgba8Unorm);
    let image = device.create_texture(&descriptor).expect("a small texture");
    // Pipelines with one layout share a group: colours are kept as long as bindings are the same.
    let groups = bound(device, draws[0].0, &values);
    let buffers = draws.iter().map(|(_, vertices)| {
        let buffer = device.create_buffer_with_contents(bytes_of(vertices.as_flattened()));
        [buffer.expect("a small buffer").slice(..)]
    });
    let buffers: Vec<_> = buffers.collect();
    let draws = draws
        .iter()
        .zip(&buffers)
        .map(|((pipeline, vertices), buffers)| Draw {
            vertex_buffers: buffers,
            bind_groups: &groups,
            ..Draw::new(pipeline, 0..u32::try_from(vertices.len()).expect("few"))
        });
    let statistics = device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
        draws: &draws.collect::<Vec<_>>(),
        ..RenderPass::default()
    });
    let statistics = statistics.unwrap_or_else(|error| panic!("{error}"));
    (
        device.read_texture(&image).expect("it can be read"),
        statistics,
    )
}

/// Rows: O5
#[test]
fn colors_that_are_kept_are_those_behind_a_store() {
    let mut kept = 0;
    for (name, device) in devices() {
        let module = module(&device, ShaderSource::Wgsl(WGSL));
        let [reads, stores] = ["reads", "stores"].map(|name| pipeline(&device, &module, name));
        for number in 0..6 {
            let mut random = Random::new("stored colors", number);
            let before = panels(&mut random, 12);
            // Each tile stores all of them.
            let slots = [0.0, 1.0, 2.0, 3.0];
            let stored = slots.map(|slot| panel(&mut random, true, slot)).concat();
            let after = panels(&mut random, 30);
            let (expected, _) = drawn(&device, AFTER, &[(&reads, after.clone())]);
            let draws = [(&reads, before), (&stores, stored), (&reads, after)];
            let (image, statistics) = drawn(&device, BEFORE, &draws);
            assert!(
                image == expected,
                "{name}, case {number}: a colour of before the store"
            );
            kept += statistics.colors_kept;
        }
    }
    assert!(kept > 1000, "{kept} colours were kept");
}
