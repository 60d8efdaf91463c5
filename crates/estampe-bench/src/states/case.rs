//! A load in a state, with all of its resources on a device.

use super::Load;
use super::geometry::{Geometry, layout};
use super::shaders::{OutputKind, SurfaceKind, program};
use super::state::{BASELINE_COLOR, BASELINE_DEPTH, BASELINE_VERTEX_COLOR, Change, State};
use super::texture_views::Pictures;
use crate::BenchError;
use crate::frame::FrameSize;
use crate::target::{Target, TargetDescriptor};
use estampe::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, CompareFunction,
    DepthState, DepthStencilState, LogicOperation, PrimitiveState, ScissorRect, StencilFaceState,
    StencilOperation, StencilState,
};
use estampe::{
    BufferSlice, Device, Draw, IndexFormat, OcclusionQueries, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, SampleType, TextureFormat, VertexFormat,
};

/// Everything that a state may change.
#[derive(Debug)]
struct Setup {
    geometry: Geometry,
    surface: SurfaceKind,
    output: OutputKind,
    vertex_color: VertexFormat,
    has_uv: bool,
    /// The pipeline; its program, vertex buffers and topology are set last.
    pipeline: RenderPipelineDescriptor,
    target: TargetDescriptor,
    scissor: Option<ScissorRect>,
    depth_bounds: Option<[f32; 2]>,
    has_query: bool,
}

impl Setup {
    fn baseline(load: Load, size: FrameSize, pictures: &Pictures) -> Result<Self, BenchError> {
        let surface = if load.is_textured() {
            SurfaceKind::Texture(pictures.sampled(load)?)
        } else {
            SurfaceKind::Tint
        };
        let blend = match load {
            Load::Blend => Some(BlendState::ALPHA_BLENDING),
            Load::Text => Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            Load::Fill | Load::Tris8 | Load::Textured => None,
        };
        let output = OutputKind::Targets(1);
        let depth = if blend.is_some() {
            DepthState::LESS_READ
        } else {
            DepthState::LESS_WRITE
        };
        let pipeline = RenderPipelineDescriptor {
            depth_stencil: Some(depth.into()),
            targets: vec![Some(ColorTargetState {
                blend,
                ..BASELINE_COLOR.into()
            })],
            ..RenderPipelineDescriptor::with_program(program(&surface, output))
        };
        Ok(Self {
            geometry: Geometry::of(load, size),
            surface,
            output,
            vertex_color: BASELINE_VERTEX_COLOR,
            has_uv: load.is_textured(),
            pipeline,
            target: TargetDescriptor {
                color_formats: vec![BASELINE_COLOR],
                depth_stencil: Some(BASELINE_DEPTH),
                ..TargetDescriptor::new(size)
            },
            scissor: None,
            depth_bounds: None,
            has_query: false,
        })
    }

    fn change(
        &mut self,
        change: Change,
        load: Load,
        pictures: &Pictures,
    ) -> Result<(), BenchError> {
        let size = self.target.size;
        match change {
            Change::ColorFormat(format) => self.set_color_format(format),
            Change::DepthFormat(format) => {
                self.target.depth_stencil = format;
                if !format.is_some_and(TextureFormat::has_depth) {
                    self.pipeline.depth_stencil = None;
                }
            }
            Change::StencilKeep => self.set_stencil(StencilFaceState::default()),
            Change::StencilIncrement => self.set_stencil(StencilFaceState {
                compare: CompareFunction::LessEqual,
                pass_op: StencilOperation::IncrementWrap,
                ..StencilFaceState::default()
            }),
            Change::DepthBounds => self.depth_bounds = Some([0.0, 1.0]),
            Change::Samples(samples) => self.set_samples(samples),
            Change::AlphaToCoverage => {
                self.set_samples(4);
                self.pipeline.multisample.alpha_to_coverage_enabled = true;
            }
            Change::SampleMask => {
                self.set_samples(4);
                self.pipeline.multisample.mask = 0b0110;
            }
            Change::Targets(count) => {
                self.output = OutputKind::Targets(count);
                self.pipeline.targets = vec![self.pipeline.targets[0]; count];
                self.target.color_formats = vec![BASELINE_COLOR; count];
            }
            Change::Premultiplied => {
                self.set_blend(BlendState::PREMULTIPLIED_ALPHA_BLENDING);
            }
            Change::ConstantAlpha => self.set_blend(both(
                BlendFactor::ConstantAlpha,
                BlendFactor::OneMinusConstantAlpha,
            )),
            Change::DualSource => {
                self.output = OutputKind::DualSource;
                self.set_blend(both(BlendFactor::One, BlendFactor::OneMinusSrc1));
            }
            Change::LogicXor => self.pipeline.logic_operation = Some(LogicOperation::Xor),
            Change::Discard => self.output = OutputKind::Discard,
            Change::OcclusionQuery => self.has_query = true,
            Change::Scissor => self.scissor = Some(inner_rect(size)),
            Change::Lines => self.geometry = Geometry::lines(size),
            Change::Points => {
                self.geometry = Geometry::points(size);
                self.surface = SurfaceKind::PointTint;
            }
            Change::VertexColor(format) => {
                self.vertex_color = format;
                if format == VertexFormat::Uint32x4 {
                    self.surface = SurfaceKind::IntegerTint;
                }
            }
            Change::View(kind) => self.surface = SurfaceKind::View(pictures.view(load, kind)?),
        }
        Ok(())
    }

    fn set_color_format(&mut self, format: TextureFormat) {
        self.target.color_formats = vec![format];
        self.set_target(|target| target.format = format);
        if format.sample_type() != SampleType::Float {
            self.output = OutputKind::Integers;
        }
    }

    fn set_target(&mut self, set: impl FnOnce(&mut ColorTargetState)) {
        set(self.pipeline.targets[0]
            .as_mut()
            .expect("the baseline has a target"));
    }

    fn set_stencil(&mut self, face: StencilFaceState) {
        self.target.depth_stencil = Some(TextureFormat::Depth32FloatStencil8);
        self.pipeline.depth_stencil.get_or_insert_default().stencil =
            Some(StencilState::from(face));
    }

    fn set_samples(&mut self, samples: u32) {
        self.target.samples = samples;
        self.pipeline.multisample.count = samples;
    }

    fn set_blend(&mut self, blend: BlendState) {
        self.set_target(|target| target.blend = Some(blend));
        self.pipeline.depth_stencil = Some(DepthStencilState::LESS_READ);
    }
}

/// Blending with the same pair of factors for colour and alpha.
fn both(src_factor: BlendFactor, dst_factor: BlendFactor) -> BlendState {
    let component = BlendComponent {
        operation: BlendOperation::Add,
        src_factor,
        dst_factor,
    };
    BlendState {
        color: component,
        alpha: component,
    }
}

/// A rectangle of most of the target, whose edges are inside tiles and packets.
fn inner_rect(size: FrameSize) -> ScissorRect {
    let (x, y) = ((size.width / 16) | 1, (size.height / 16) | 1);
    ScissorRect {
        x,
        y,
        width: size.width - x * 2,
        height: size.height - y * 2,
    }
}

/// A load in a state, ready to be drawn repeatedly.
#[derive(Debug)]
pub(super) struct Case<'d> {
    device: &'d Device,
    pipeline: RenderPipeline,
    vertices: [BufferSlice; 1],
    indices: BufferSlice,
    index_count: u32,
    size: FrameSize,
    target: Target,
    scissor: Option<ScissorRect>,
    depth_bounds: Option<[f32; 2]>,
    queries: Option<OcclusionQueries>,
    primitives: u32,
    fragments: u64,
}

impl<'d> Case<'d> {
    /// A load in the baseline state, or changed by a state.
    ///
    /// # Errors
    /// [`BenchError`] if the device refuses the pipeline or the target.
    pub(super) fn new(
        device: &'d Device,
        load: Load,
        size: FrameSize,
        state: Option<&State>,
        pictures: &Pictures,
    ) -> Result<Self, BenchError> {
        let mut setup = Setup::baseline(load, size, pictures)?;
        if let Some(state) = state {
            setup.change(state.change, load, pictures)?;
        }
        let mut case = Self::of(device, &setup)?;
        case.fragments = case.count_fragments(&setup)?;
        Ok(case)
    }

    fn of(device: &'d Device, setup: &Setup) -> Result<Self, BenchError> {
        let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
            program: program(&setup.surface, setup.output),
            vertex_buffers: vec![layout(setup.vertex_color, setup.has_uv)],
            primitive: PrimitiveState {
                topology: setup.geometry.topology,
                ..PrimitiveState::default()
            },
            ..setup.pipeline.clone()
        })?;
        let vertices = setup.geometry.encoded(setup.vertex_color, setup.has_uv);
        let buffer = |bytes: &[u8]| -> Result<BufferSlice, BenchError> {
            Ok(BufferSlice::from(
                &device.create_buffer_with_contents(bytes)?,
            ))
        };
        Ok(Self {
            device,
            pipeline,
            vertices: [buffer(&vertices)?],
            indices: buffer(setup.geometry.indices())?,
            index_count: setup.geometry.index_count(),
            size: setup.target.size,
            target: Target::new(device, &setup.target)?,
            scissor: setup.scissor,
            depth_bounds: setup.depth_bounds,
            queries: setup.has_query.then(|| OcclusionQueries::new(1)),
            primitives: setup.geometry.primitives(),
            fragments: 0,
        })
    }

    /// The number of fragments of the primitives inside the scissor rectangle, whether they pass
    /// the tests or not.
    fn count_fragments(&self, setup: &Setup) -> Result<u64, BenchError> {
        let plain =
            RenderPipelineDescriptor::with_program(program(&setup.surface, OutputKind::Targets(1)));
        let counting = Self::of(
            self.device,
            &Setup {
                geometry: setup.geometry.clone(),
                surface: setup.surface.clone(),
                output: OutputKind::Targets(1),
                pipeline: RenderPipelineDescriptor {
                    depth_stencil: None,
                    ..plain
                },
                target: TargetDescriptor::new(self.size),
                depth_bounds: None,
                has_query: true,
                ..*setup
            },
        )?;
        counting.draw();
        Ok(counting.samples_passed())
    }

    /// Draws a frame: clears the target and draws the load.
    pub(super) fn draw(&self) {
        let draw = Draw {
            vertex_buffers: &self.vertices,
            index_buffer: Some((&self.indices, IndexFormat::Uint32)),
            scissor: self.scissor,
            depth_bounds: self.depth_bounds,
            blend_constant: [0.75; 4],
            occlusion_query: self.queries.is_some().then_some(0),
            ..Draw::new(&self.pipeline, 0..self.index_count)
        };
        let pass = RenderPass {
            color_attachments: &self.target.colors([0.0; 4]),
            depth_stencil_attachment: self.target.depth_stencil(),
            occlusion_queries: self.queries.as_ref(),
            draws: std::slice::from_ref(&draw),
            ..RenderPass::default()
        };
        self.device
            .render(&pass)
            .expect("the pipeline is made for the target");
    }

    /// The number of samples that passed in all frames so far, if they are counted.
    fn samples_passed(&self) -> u64 {
        self.queries
            .as_ref()
            .map_or(0, |queries| queries.samples_passed(0))
    }

    /// Fragments per frame.
    pub(super) fn fragments(&self) -> u64 {
        self.fragments
    }

    /// Primitives per frame.
    pub(super) fn primitives(&self) -> u32 {
        self.primitives
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe::DeviceDescriptor;

    const SIZE: FrameSize = FrameSize {
        width: 76,
        height: 45,
    };

    fn device() -> Device {
        Device::new(&DeviceDescriptor {
            threads: 1,
            ..DeviceDescriptor::default()
        })
        .unwrap()
    }

    /// The texels of all targets and samples.
    fn picture(case: &mut Case<'_>) -> Vec<u8> {
        case.draw();
        let mut texels = Vec::new();
        for color in &case.target.colors {
            for sample in 0..color.sample_count() {
                let read = case.device.read_sample(&color.view(), sample);
                texels.extend(read.unwrap());
            }
        }
        texels
    }

    /// A draw whose pipeline does not fit its target draws nothing, and would appear fast.
    #[test]
    fn every_state_is_drawn_with_each_of_its_loads() {
        let (device, pictures) = (device(), Pictures::new().unwrap());
        for load in Load::ALL {
            let mut baseline = Case::new(&device, load, SIZE, None, &pictures).unwrap();
            let expected = picture(&mut baseline);
            assert!(expected.iter().any(|&byte| byte != 0), "{load:?}");
            for state in State::all().iter().filter(|state| state.applies_to(load)) {
                let mut case = Case::new(&device, load, SIZE, Some(state), &pictures).unwrap();
                let texels = picture(&mut case);
                let place = format!("{load:?}, {}", state.name);
                assert!(texels.iter().any(|&byte| byte != 0), "{place}");
                assert!(case.fragments() > 0, "{place}");
                let is_same_picture = match state.change {
                    Change::DepthFormat(_)
                    | Change::StencilKeep
                    | Change::StencilIncrement
                    | Change::DepthBounds
                    | Change::OcclusionQuery => true,
                    Change::View(kind) => {
                        let is_converted = kind.format == TextureFormat::Rgba8Unorm
                            || kind.format == TextureFormat::Bgra8Unorm;
                        is_converted && kind.dimension != estampe::ViewDimension::Cube
                    }
                    _ => false,
                };
                if is_same_picture {
                    assert!(texels == expected, "{place}");
                }
                if let Change::Targets(count) = state.change {
                    assert!(texels == expected.repeat(count), "{place}");
                }
                assert_eq!(
                    case.queries.is_some(),
                    state.change == Change::OcclusionQuery
                );
                if case.queries.is_some() {
                    assert_eq!(case.samples_passed(), case.fragments(), "{place}");
                }
            }
        }
    }

    #[test]
    fn fragments_are_those_of_the_load() {
        let (device, pictures) = (device(), Pictures::new().unwrap());
        let count = |load, name: Option<&str>| {
            let states = State::all();
            let state = name.map(|name| states.iter().find(|s| s.name == name).unwrap());
            Case::new(&device, load, SIZE, state, &pictures)
                .unwrap()
                .fragments()
        };
        let pixels = u64::from(SIZE.width * SIZE.height);
        assert_eq!(count(Load::Fill, None), pixels * 8);
        assert_eq!(count(Load::Fill, Some("16-samples")), pixels * 8);
        assert_eq!(count(Load::Textured, Some("no-depth")), pixels);
        assert_eq!(count(Load::Text, None), 7 * 3 * 140);
        // Cells of 4×4 pixels fill all except the last row of pixels.
        assert_eq!(count(Load::Tris8, None), pixels - u64::from(SIZE.width));
        // From column 5 to 70, row 3 to 41.
        assert_eq!(count(Load::Blend, Some("scissor")), 66 * 39 * 8);
        // Moved ends make lines slightly shorter or longer than 8 pixels.
        let of_lines = count(Load::Tris8, Some("lines"));
        assert!((760..=824).contains(&of_lines), "{of_lines}");
    }
}
