//! Layers and viewports that a geometry shader selects, against the oracle.

use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Draw, InspectError, Level, PassErrorKind,
    RenderPass, RenderPipelineDescriptor, TextureDescriptor, ViewportScissor,
};
use estampe_reference::{State, Target, TargetState, draw_vertices, geometry_shader};
use estampe_tests::Random;
use estampe_tests::amplification::Passing;
use estampe_tests::fast_path::{all_devices, name};
use estampe_tests::geometry::{Vertex, clip_at, vertex_buffer, vertex_layout};
use estampe_tests::inspection::follow;
use estampe_types::shader::{
    EmittedVertex, GeometryIn, GeometryPrimitive, GeometryShaderProgram, GeometryTopology,
    VertexOut,
};
use estampe_types::state::{BlendState, ColorTargetState, DepthState, ScissorRect, Viewport};
use estampe_types::{Bindings, TextureFormat, Vec4};
use std::collections::BTreeSet;
use std::sync::Arc;

const LAYERS: u32 = 4;
const VIEWPORTS: u32 = 3;

/// Passes triangles on, to layers and viewports of which some do not exist.
#[derive(Debug, Clone, Copy)]
struct Placing;

estampe_types::shader! {
    impl GeometryShader for Placing {
        type Input<R: Real> = Vec4<R>;
        type Output<R: Real> = Vec4<R>;
        const INPUT: GeometryPrimitive = GeometryPrimitive::Triangles;
        const OUTPUT: GeometryTopology = GeometryTopology::TriangleStrip;
        const MAX_VERTICES: usize = 3;
        const INVOCATIONS: usize = 2;

        fn geometry<R: Real, E: Emit<R, Vec4<R>>>(
            &self,
            input: GeometryIn<'_, R, Vec4<R>>,
            out: &mut E,
        ) {
            let number = input.primitive_index + input.zero.splat_int(i32::from(input.invocation == 1));
            // −1 to 5, and 0 to 3.
            let layer = (number.to_real() * 0.37).fract() * 7.0 - 1.0;
            let viewport = (number.to_real() * 0.73).fract() * 4.0;
            for corner in 0..3 {
                let point = input.points.get(corner);
                let vertex = EmittedVertex::from(VertexOut::new(point.position, point.varyings));
                let vertex = vertex.with_layer(layer.floor().to_int());
                let vertex = vertex.with_viewport_index(viewport.floor().to_int());
                out.emit(input.zero.splat_mask(true), vertex);
            }
        }
    }
}

fn vertices(size: [u32; 2]) -> Vec<Vertex> {
    let mut random = Random::new("layers", 1);
    let mut vertex = || Vertex {
        position: clip_at(
            size,
            [
                random.range(0.0, size[0] as f32),
                random.range(0.0, size[1] as f32),
            ],
            random.unit(),
            1.0,
        ),
        values: random.four(0.0, 1.0),
    };
    (0..3 * 120).map(|_| vertex()).collect()
}

fn viewports() -> [(Viewport, ScissorRect); VIEWPORTS as usize] {
    let at = |x, y, width, height, min_depth| Viewport {
        x,
        y,
        width,
        height,
        min_depth,
        max_depth: 1.0,
    };
    let rect = |x, y, width, height| ScissorRect {
        x,
        y,
        width,
        height,
    };
    [
        (at(0.0, 0.0, 40.0, 30.0, 0.0), rect(0, 0, 40, 30)),
        (at(5.0, 2.5, 20.0, 15.0, 0.25), rect(8, 0, 9, 30)),
        (at(-10.0, 10.0, 50.0, 40.0, 0.5), rect(0, 12, 35, 40)),
    ]
}

/// Triangles go to the layer and the viewport that they select, 0 where there is no such one, and
/// keep their order; a draw without a geometry shader goes to layer 0; all layers are cleared.
///
/// Rows: V4
#[test]
fn primitives_select_layers_and_viewports() {
    let size = [40, 30];
    let vertices = vertices(size);
    let count = u32::try_from(vertices.len()).unwrap();
    let clear = [0.25, 0.5, 0.75, 1.0];
    let blend = Some(BlendState::ALPHA_BLENDING);
    let wanted = by_oracle(size, &vertices, clear, blend);
    let [first, more @ ..] = viewports();
    let more = more.map(|(viewport, scissor)| ViewportScissor {
        viewport: Some(viewport),
        scissor: Some(scissor),
    });
    for device in all_devices() {
        let texture = |format| {
            let mut descriptor = TextureDescriptor::new_2d(size[0], size[1], format);
            descriptor.size.depth_or_array_layers = LAYERS;
            device.create_texture(&descriptor).unwrap()
        };
        let colors = texture(TextureFormat::Rgba8Unorm);
        let depths = texture(TextureFormat::Depth32Float);
        let target = ColorTargetState {
            blend,
            ..TextureFormat::Rgba8Unorm.into()
        };
        let plain = RenderPipelineDescriptor {
            vertex_buffers: vec![vertex_layout()],
            targets: vec![Some(target)],
            ..RenderPipelineDescriptor::new(Passing)
        };
        let placing = RenderPipelineDescriptor {
            geometry: Some(Arc::new(GeometryShaderProgram::new(Placing))),
            ..plain.clone()
        };
        let [plain, placing] =
            [plain, placing].map(|descriptor| device.create_render_pipeline(&descriptor).unwrap());
        let words = vertex_buffer(&vertices).words().to_vec();
        let buffer = device.create_buffer_of_words(words).unwrap();
        let buffers = [(&buffer).into()];
        let pass = RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(
                &colors.view(),
                clear.map(f64::from),
            ))],
            depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depths.view(), 1.0)),
            draws: &[
                Draw {
                    vertex_buffers: &buffers,
                    viewport: Some(first.0),
                    scissor: Some(first.1),
                    more_viewports: &more,
                    ..Draw::new(&placing, 0..count)
                },
                Draw {
                    vertex_buffers: &buffers,
                    ..Draw::new(&plain, 0..30)
                },
            ],
            ..RenderPass::default()
        };
        let statistics = device.render(&pass).unwrap();
        let on = name(device);
        assert_eq!(
            statistics.geometry_invocations,
            u64::from(count / 3 * 2),
            "{on}"
        );
        assert_eq!(
            statistics.geometry_primitives,
            u64::from(count / 3 * 2),
            "{on}"
        );
        for (layer, wanted) in (0..).zip(&wanted) {
            let view = colors.image(0, layer).unwrap();
            let got = device.read_sample(&view, 0).unwrap();
            assert!(got == *wanted, "{on}: layer {layer} differs");
        }
        if device.level() == Level::best() {
            check_histories(device, &pass, &wanted);
        }
    }
}

/// Compares the histories of some pixels of each layer with the images.
fn check_histories(device: &Device, pass: &RenderPass<'_>, wanted: &[Vec<u8>]) {
    let mut seen = BTreeSet::new();
    for (layer, image) in (0..).zip(wanted) {
        for pixel in [[3, 2], [10, 5], [12, 14], [20, 25], [33, 13]] {
            let history = device.inspect_layer(pass, pixel, layer).unwrap();
            follow(&history).unwrap();
            assert_eq!((history.pixel, history.layer), (pixel, layer));
            let at = (pixel[1] * 40 + pixel[0]) as usize * 4;
            let drawn = image[at..at + 4].to_vec();
            assert_eq!(history.texels, [Some(drawn)], "layer {layer}, {pixel:?}");
            for primitive in &history.primitives {
                let emitted = primitive.origin.as_ref().and_then(|origin| origin.emitted);
                let Some(emitted) = emitted else {
                    assert_eq!((layer, primitive.draw), (0, 1));
                    seen.insert("plain");
                    continue;
                };
                let exists = emitted.layer < LAYERS;
                assert_eq!(if exists { emitted.layer } else { 0 }, layer);
                seen.insert(if exists { "a layer" } else { "none such" });
                seen.insert(["first", "second"][emitted.invocation as usize]);
                seen.insert(if emitted.viewport_index == 0 {
                    "whole"
                } else {
                    "viewport"
                });
            }
        }
    }
    assert_eq!(seen.len(), 7, "{seen:?}");
    let error = device.inspect_layer(pass, [0, 0], LAYERS).unwrap_err();
    let (layer, layers) = (LAYERS, LAYERS);
    assert_eq!(error, InspectError::NoLayer { layer, layers });
}

/// The image of each layer.
fn by_oracle(
    [width, height]: [u32; 2],
    vertices: &[Vertex],
    clear: [f32; 4],
    blend: Option<BlendState>,
) -> Vec<Vec<u8>> {
    let bindings = Bindings::default();
    let buffers = [(vertex_layout(), vertex_buffer(vertices))];
    let draw = estampe_reference::Draw {
        buffers: &buffers,
        indices: None,
        vertices: 0..u32::try_from(vertices.len()).unwrap(),
        instances: 0..1,
        base_vertex: 0,
        bindings: &bindings,
    };
    let state = State {
        depth: Some(DepthState::LESS_WRITE),
        targets: vec![TargetState {
            blend,
            ..TargetState::default()
        }],
        ..State::new(width, height)
    };
    let input = geometry_shader::input(&Passing, &state, &draw);
    let provoking = state.primitive.provoking_vertex;
    let emitted = geometry_shader::emit(&Placing, &input, provoking, &bindings);
    let mut seen = [[0; VIEWPORTS as usize]; LAYERS as usize];
    let images = (0..LAYERS).map(|layer| {
        let mut target = Target::new(width, height, 1, TextureFormat::Rgba8Unorm);
        target.clear(clear, 1.0);
        for primitive in &emitted {
            let [at, viewport] = primitive.place;
            let at = if at < LAYERS { at } else { 0 };
            let viewport = if viewport < VIEWPORTS { viewport } else { 0 };
            if at != layer {
                continue;
            }
            seen[at as usize][viewport as usize] += 1;
            let (viewport, scissor) = viewports()[viewport as usize];
            let state = State {
                viewport,
                scissor,
                ..state.clone()
            };
            draw_vertices(
                &mut target,
                &Passing,
                &state,
                &bindings,
                &primitive.vertices,
            );
        }
        if layer == 0 {
            draw_vertices(&mut target, &Passing, &state, &bindings, &input.0[..30]);
        }
        target.texels(0, 0)
    });
    let images = images.collect();
    assert!(
        seen.as_flattened().iter().all(|count| *count > 0),
        "{seen:?}"
    );
    images
}

/// Attachments of different numbers of layers are refused.
///
/// Rows: V4
#[test]
fn attachments_have_the_same_number_of_layers() {
    let device = all_devices()[0];
    let texture = |layers, format| {
        let mut descriptor = TextureDescriptor::new_2d(8, 8, format);
        descriptor.size.depth_or_array_layers = layers;
        device.create_texture(&descriptor).unwrap()
    };
    let colors = texture(3, TextureFormat::Rgba8Unorm);
    let depths = texture(2, TextureFormat::Depth32Float);
    let error = device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&colors.view(), [0.0; 4]))],
            depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depths.view(), 1.0)),
            ..RenderPass::default()
        })
        .unwrap_err();
    assert!(
        matches!(error.kind, PassErrorKind::Layers { counts: [2, 3] }),
        "{error}"
    );
}
