//! A shader's interface is that of its body: it works without declarations, and what contradicts it
//! is refused when the pipeline is created.

use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{CompareFunction, DepthState, VertexBufferLayout};
use estampe::{
    BindGroup, Binding, Bindings, Buffer, Device, DeviceDescriptor, Draw, Level, LoadOp,
    PipelineError, RenderPass, RenderPipeline, RenderPipelineDescriptor, RenderTargetDescriptor,
    ShaderError, TextureFormat, Vec2, Vec4, VertexFormat,
};
use std::sync::Arc;

/// A triangle over the target, whose fragments do what the field says.
struct Doing(Does);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Does {
    /// Discards the left half, which the window position tells.
    DiscardLeft,
    /// Sets depth ¼ in the left half.
    NearLeft,
    /// Discards everything if a uniform is 1.
    DiscardIfBound,
    /// Sets the colour of a target.
    Color(usize),
}

estampe::shader! {
    impl Shader for Doing {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, ()> {
            VertexOut::new(at.extend(0.5).extend(input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let white = FragmentOut::color(Vec4::repeat(input.real(1.0)));
            let is_left = input.position.x.lt(8.0);
            match self.0 {
                Does::DiscardLeft => white.discard_unless(!is_left),
                Does::NearLeft => {
                    white.with_depth(R::select(is_left, input.real(0.25), input.position.z))
                }
                Does::DiscardIfBound if input.bindings.f32s(0, 0, 0) == [1.0] => {
                    white.discard_unless(input.position.x.lt(0.0))
                }
                Does::DiscardIfBound => white,
                Does::Color(index) => white.with_color(index, Vec4::repeat(input.zero)),
            }
        }
    }
}

fn device(level: Level) -> Device {
    Device::new(&DeviceDescriptor {
        threads: 1,
        level,
        ..DeviceDescriptor::default()
    })
    .expect("one thread starts")
}

fn pipeline(device: &Device, does: Does) -> Result<RenderPipeline, PipelineError> {
    let mut descriptor = RenderPipelineDescriptor::new(Doing(does));
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
    descriptor.depth = Some(DepthState {
        compare: CompareFunction::Less,
        ..DepthState::LESS_WRITE
    });
    device.create_render_pipeline(&descriptor)
}

/// The columns, of sixteen, that are drawn over depths of 0.4 (in front of the triangle) or 1.
fn drawn(device: &Device, does: Does, clear_depth: f32, uniform: f32) -> Vec<u8> {
    let pipeline = pipeline(device, does).expect("it is valid");
    let mut target = device
        .create_render_target(&RenderTargetDescriptor::new(16, 1))
        .expect("it is small");
    let vertices = [Buffer::from_f32s(&[-1.0, -1.0, 3.0, -1.0, -1.0, 3.0])];
    let buffer = Buffer::from_f32s(&[uniform]);
    let entry = Binding::Buffer {
        buffer,
        offset: 0,
        has_dynamic_offset: false,
    };
    let group = Arc::new(BindGroup {
        entries: vec![(0, entry)],
    });
    let bindings = Bindings {
        groups: vec![(group, 0)],
    };
    let draws = [Draw {
        vertex_buffers: &vertices,
        bindings: Some(&bindings),
        ..Draw::new(&pipeline, 0..3)
    }];
    let pass = RenderPass {
        load_depth: LoadOp::Clear(clear_depth),
        draws: &draws,
        ..RenderPass::default()
    };
    device.render(&mut target, &pass).expect("it fits");
    target.read_color(0).chunks_exact(4).map(|p| p[0]).collect()
}

#[test]
fn undeclared_inputs_and_outputs_work() {
    let (left, right) = ([255; 8], [0; 8]);
    for level in Level::all_available() {
        let device = device(level);
        let cut = drawn(&device, Does::DiscardLeft, 1.0, 0.0);
        assert_eq!(cut, [right, left].concat(), "{level:?}");
        let near = drawn(&device, Does::NearLeft, 0.4, 0.0);
        assert_eq!(near, [left, right].concat(), "{level:?}");
    }
}

#[test]
fn a_contradiction_is_an_error_of_the_pipeline() {
    let device = device(Level::best());
    let error = pipeline(&device, Does::Color(8)).expect_err("there is no target 8");
    assert_eq!(
        error,
        PipelineError::Shader(ShaderError::ColorIndex { index: 8 })
    );
    assert_eq!(
        error.to_string(),
        "the fragment sets the colour of target 8 (with_color); targets are 0 to 7"
    );
    // The pipeline has one target.
    assert_eq!(
        pipeline(&device, Does::Color(2)).expect_err("there is one target"),
        PipelineError::TargetCount {
            shader: 3,
            pipeline: 1
        }
    );
}

/// Fragments are discarded where a uniform is 1, which the dry run cannot know.
#[test]
#[cfg_attr(
    debug_assertions,
    should_panic(
        expected = "the fragment discards, which it did not do with nothing bound; set \
                             DISCARDS of the shader"
    )
)]
fn an_output_that_bindings_decide_stops_debug_builds_and_has_no_effect_in_others() {
    let device = device(Level::best());
    assert_eq!(drawn(&device, Does::DiscardIfBound, 1.0, 0.0), [255; 16]);
    assert_eq!(drawn(&device, Does::DiscardIfBound, 1.0, 1.0), [255; 16]);
}

/// All targets of the pipeline, and zeros in those that the shader does not set.
#[test]
fn declared_targets_that_are_not_set_hold_zeros() {
    struct Three;
    estampe::shader! {
        impl Shader for Three {
            type Attributes<R: Real> = Vec2<R>;
            type Varyings<R: Real> = ();
            const COLOR_TARGETS: usize = 3;

            fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, ()> {
                VertexOut::new(at.extend(0.5).point(), ())
            }

            fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
                FragmentOut::none().with_color(1, Vec4::repeat(input.real(1.0)))
            }
        }
    }
    let device = device(Level::best());
    let mut descriptor = RenderPipelineDescriptor::new(Three);
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
    descriptor.targets = vec![TextureFormat::Rgba8Unorm.into(); 3];
    let pipeline = device.create_render_pipeline(&descriptor).expect("valid");
    let mut target = device
        .create_render_target(&RenderTargetDescriptor {
            color_formats: vec![TextureFormat::Rgba8Unorm; 3],
            ..RenderTargetDescriptor::new(2, 2)
        })
        .expect("it is small");
    let vertices = [Buffer::from_f32s(&[-1.0, -1.0, 3.0, -1.0, -1.0, 3.0])];
    let draws = [Draw {
        vertex_buffers: &vertices,
        ..Draw::new(&pipeline, 0..3)
    }];
    let pass = RenderPass {
        load_colors: vec![LoadOp::Clear([0.5; 4]); 3],
        draws: &draws,
        ..RenderPass::default()
    };
    device.render(&mut target, &pass).expect("it fits");
    let bytes = [0, 1, 2].map(|index| target.read_color(index)[0]);
    assert_eq!(bytes, [0, 255, 0]);
}
