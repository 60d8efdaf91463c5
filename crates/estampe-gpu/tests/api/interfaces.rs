//! A shader's interface is that of its body: it works without declarations, and what contradicts it
//! is refused when the pipeline is created.

use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{CompareFunction, DepthState, VertexBufferLayout};
use estampe::{
    BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType,
    BufferSlice, ColorAttachment, DepthStencilAttachment, Device, DeviceDescriptor, Draw, Level,
    PipelineError, RenderPass, RenderPipeline, RenderPipelineDescriptor, ShaderError, Texture,
    TextureDescriptor, TextureFormat, Vec2, Vec4, VertexFormat, bytes_of,
};

/// A triangle over the target, whose fragments do what the field says.
struct Doing(Does);

#[derive(Debug, Clone, Copy, PartialEq)]
enum Does {
    /// Discards the left half, which the window position tells.
    DiscardLeft,
    /// Sets depth ¼ in the left half.
    NearLeft,
    /// Discards everything if the uniform is this.
    DiscardIf(f32),
    /// Takes a derivative if the uniform is 6.
    DeriveIfSix,
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
                Does::DiscardIf(number) if input.bindings.f32s(0, 0, 0) == [number] => {
                    white.discard_unless(input.position.x.lt(0.0))
                }
                Does::DeriveIfSix if input.bindings.f32s(0, 0, 0) == [6.0] => {
                    FragmentOut::color(Vec4::repeat(input.position.x.ddx()))
                }
                Does::DiscardIf(_) | Does::DeriveIfSix => white,
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
    descriptor.depth_stencil = Some(
        DepthState {
            compare: CompareFunction::Less,
            ..DepthState::LESS_WRITE
        }
        .into(),
    );
    device.create_render_pipeline(&descriptor)
}

/// The columns, of sixteen, that are drawn over depths of 0.4 (in front of the triangle) or 1.
fn drawn(device: &Device, does: Does, clear_depth: f32, uniform: f32) -> Vec<u8> {
    let pipeline = pipeline(device, does).expect("it is valid");
    let color = texture(device, [16, 1], TextureFormat::Rgba8Unorm);
    let depth = texture(device, [16, 1], TextureFormat::Depth32Float);
    let uniforms = slice(device, &[uniform]);
    let entry = BindGroupLayoutEntry {
        binding: 0,
        ty: BindingType::Buffer {
            ty: BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: 4,
        },
    };
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &device.create_bind_group_layout(&[entry]).expect("valid"),
        entries: &[(0, BindingResource::Buffer(uniforms))],
    });
    let group = group.expect("it fits the layout");
    let pass = RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&color.view(), [0.0; 4]))],
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth.view(), clear_depth)),
        draws: &[Draw {
            vertex_buffers: &[slice(device, &CORNERS)],
            bind_groups: std::slice::from_ref(&group),
            ..Draw::new(&pipeline, 0..3)
        }],
        ..RenderPass::default()
    };
    device.render(&pass).expect("it fits");
    let bytes = device.read_texture(&color).expect("it can be read");
    bytes.chunks_exact(4).map(|texel| texel[0]).collect()
}

/// A triangle over the whole image.
const CORNERS: [f32; 6] = [-1.0, -1.0, 3.0, -1.0, -1.0, 3.0];

fn slice(device: &Device, numbers: &[f32]) -> BufferSlice {
    let buffer = device.create_buffer_with_contents(bytes_of(numbers));
    buffer.expect("it is small").slice(..)
}

fn texture(device: &Device, [width, height]: [u32; 2], format: TextureFormat) -> Texture {
    let descriptor = TextureDescriptor::new_2d(width, height, format);
    device.create_texture(&descriptor).expect("it is small")
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

#[test]
fn what_small_numbers_in_bindings_decide_is_found() {
    let device = device(Level::best());
    for number in [0.0, 1.0, 2.0, 3.0] {
        let does = Does::DiscardIf(number);
        assert_eq!(drawn(&device, does, 1.0, number), [0; 16], "{number}");
        assert_eq!(drawn(&device, does, 1.0, 6.0), [255; 16], "{number}");
    }
}

/// Derivatives that neither the dry run finds nor a constant declares.
#[test]
#[cfg_attr(
    debug_assertions,
    should_panic(
        expected = "the fragment takes derivatives, which it did not do with nothing bound; set \
                    TAKES_DERIVATIVES of the shader"
    )
)]
fn derivatives_that_bindings_decide_stop_debug_builds() {
    let device = device(Level::best());
    assert_eq!(drawn(&device, Does::DeriveIfSix, 1.0, 0.0), [255; 16]);
    let columns = drawn(&device, Does::DeriveIfSix, 1.0, 6.0);
    assert_eq!(columns.len(), 16, "undefined numbers, but no others");
}

/// Fragments are discarded where a uniform is 6, which the dry run cannot know.
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
    assert_eq!(drawn(&device, Does::DiscardIf(6.0), 1.0, 0.0), [255; 16]);
    assert_eq!(drawn(&device, Does::DiscardIf(6.0), 1.0, 6.0), [255; 16]);
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
    let colors = [(); 3].map(|()| texture(&device, [2, 2], TextureFormat::Rgba8Unorm));
    let attachments = colors
        .each_ref()
        .map(|color| Some(ColorAttachment::clear(&color.view(), [0.5; 4])));
    let depth = texture(&device, [2, 2], TextureFormat::Depth32Float);
    let pass = RenderPass {
        color_attachments: &attachments,
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth.view(), 1.0)),
        draws: &[Draw {
            vertex_buffers: &[slice(&device, &CORNERS)],
            ..Draw::new(&pipeline, 0..3)
        }],
        ..RenderPass::default()
    };
    device.render(&pass).expect("it fits");
    let bytes = colors.map(|color| device.read_texture(&color).expect("it can be read")[0]);
    assert_eq!(bytes, [0, 255, 0]);
}
