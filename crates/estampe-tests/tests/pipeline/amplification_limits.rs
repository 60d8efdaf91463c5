//! Pipelines whose stages do not fit, and draws that would make more than fits in memory.

use estampe::{
    ColorAttachment, Draw, DrawError, PassControl, PassErrorKind, PipelineError, RenderPass,
    RenderPipelineDescriptor, ShaderProgram, TessellationShaderProgram, TessellationState,
    TextureDescriptor,
};
use estampe_tests::amplification::{Dividing, Emitting, Passing};
use estampe_tests::fast_path::all_devices;
use estampe_tests::geometry::vertex_layout;
use estampe_types::TextureFormat;
use estampe_types::shader::{GeometryPrimitive, GeometryShaderProgram};
use estampe_types::state::{
    PrimitiveState, PrimitiveTopology as T, TessellationDomain, TessellationMode,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

fn dividing(levels: f32) -> TessellationState {
    let shader = Dividing {
        domain: TessellationDomain::Triangles,
        inner: [levels; 2],
        bend: 0.0,
        point_size: None,
    };
    TessellationState {
        program: Arc::new(TessellationShaderProgram::new(shader)),
        patch_points: 3,
        mode: TessellationMode::default(),
    }
}

fn descriptor(topology: T) -> RenderPipelineDescriptor {
    RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout()],
        primitive: PrimitiveState {
            topology,
            ..PrimitiveState::default()
        },
        depth_stencil: None,
        ..RenderPipelineDescriptor::new(Passing)
    }
}

/// Reads points and gives no varyings.
#[derive(Debug, Clone, Copy)]
struct Mute;

estampe_types::shader! {
    impl Shader for Mute {
        type Attributes<R: Real> = (estampe_types::Vec4<R>, estampe_types::Vec4<R>);
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(
            &self,
            _: estampe::VertexIn<'_, R>,
            (at, _): (estampe_types::Vec4<R>, estampe_types::Vec4<R>),
        ) -> estampe::VertexOut<R, ()> {
            estampe::VertexOut::new(at, ())
        }

        fn fragment<R: Real>(
            &self,
            input: estampe::FragmentIn<'_, R>,
            _: (),
        ) -> estampe::FragmentOut<R> {
            estampe::FragmentOut::color(input.position)
        }
    }
}

/// Each mismatch between stages, topology and limits is an error that names both sides.
///
/// Rows: V3, V4
#[test]
fn stages_that_do_not_fit_are_refused() {
    let device = all_devices()[0];
    let refused = |descriptor: RenderPipelineDescriptor, error: PipelineError| {
        let got = device.create_render_pipeline(&descriptor).unwrap_err();
        assert_eq!(got, error, "{got}");
    };
    let topology = T::PatchList;
    refused(
        descriptor(topology),
        PipelineError::PatchTopology { topology },
    );
    let tessellated = |topology| RenderPipelineDescriptor {
        tessellation: Some(dividing(1.0)),
        ..descriptor(topology)
    };
    let topology = T::TriangleList;
    refused(
        tessellated(topology),
        PipelineError::PatchTopology { topology },
    );
    for points in [0, 33] {
        let mut patches = tessellated(T::PatchList);
        patches.tessellation.as_mut().unwrap().patch_points = points;
        refused(patches, PipelineError::PatchPoints(points));
    }
    let mute = || Some(Arc::new(ShaderProgram::new(Mute)) as _);
    refused(
        RenderPipelineDescriptor {
            vertex_program: mute(),
            ..descriptor(T::TriangleList)
        },
        PipelineError::VertexProgramUnused,
    );
    refused(
        RenderPipelineDescriptor {
            vertex_program: mute(),
            ..tessellated(T::PatchList)
        },
        PipelineError::StageScalars {
            from: "vertex shader",
            gives: 0,
            to: "tessellation shader",
            reads: 4,
        },
    );
    refused(
        RenderPipelineDescriptor {
            program: Arc::new(ShaderProgram::new(Mute)),
            vertex_program: Some(Arc::new(ShaderProgram::new(Passing))),
            ..tessellated(T::PatchList)
        },
        PipelineError::StageScalars {
            from: "tessellation shader",
            gives: 4,
            to: "fragment shader",
            reads: 0,
        },
    );
    let lines = || Some(Arc::new(GeometryShaderProgram::new(Emitting::<1, 1, 7, 3>)) as _);
    for (mut descriptor, from) in [
        (descriptor(T::TriangleStrip), "topology"),
        (tessellated(T::PatchList), "tessellation state"),
    ] {
        descriptor.geometry = lines();
        refused(
            descriptor,
            PipelineError::GeometryInput {
                from,
                made: GeometryPrimitive::Triangles,
                reads: GeometryPrimitive::Lines,
            },
        );
    }
    let many = GeometryShaderProgram::new(Emitting::<0, 0, 257, 1>);
    let mut points = descriptor(T::PointList);
    points.geometry = Some(Arc::new(many));
    let error = device.create_render_pipeline(&points).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the geometry shader's MAX_VERTICES is 257; an invocation emits 1 to 256 vertices"
    );
}

/// A draw of 2²⁷ indices beyond a buffer's end, at level 64 with up to 256 vertices emitted for
/// each triangle, begins at once, keeps its memory small and can be cancelled.
///
/// Rows: V3, V4
#[test]
fn a_hostile_draw_is_cut_and_can_be_cancelled() {
    let device = all_devices().into_iter().next_back().unwrap();
    let mut hostile = descriptor(T::PatchList);
    hostile.tessellation = Some(dividing(64.0));
    hostile.geometry = Some(Arc::new(GeometryShaderProgram::new(Emitting::<2, 2, 9, 2>)));
    let pipeline = device.create_render_pipeline(&hostile).unwrap();
    // Positions outside the view volume, and edges of level 64.
    let vertex = [9.0_f32, 9.0, 9.0, 1.0, 0.5, 0.5, 0.5, 32.0];
    let buffer = device
        .create_buffer_with_contents(estampe::bytes_of(&vertex))
        .unwrap();
    let indices = device.create_buffer_of_words(vec![0; 3]).unwrap();
    let size = TextureDescriptor::new_2d(16, 16, TextureFormat::Rgba8Unorm);
    let image = device.create_texture(&size).unwrap();
    let cancel = AtomicBool::new(false);
    let progress = |_: usize, _: usize| cancel.store(true, Ordering::Relaxed);
    let slice = (&indices).into();
    let result = device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
        control: PassControl {
            cancel: Some(&cancel),
            progress: Some(&progress),
        },
        draws: &[Draw {
            vertex_buffers: &[(&buffer).into()],
            index_buffer: Some((&slice, estampe::IndexFormat::Uint32)),
            ..Draw::new(&pipeline, 0..1 << 27)
        }],
        ..RenderPass::default()
    });
    let error = result.unwrap_err();
    assert!(
        matches!(error.kind, PassErrorKind::Draw(DrawError::Cancelled)),
        "{error}"
    );
}
