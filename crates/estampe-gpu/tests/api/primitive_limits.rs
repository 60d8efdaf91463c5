//! Primitive state that a pipeline refuses, and the rule that the error names.

use estampe::state::{LineState, LineStipple};
use estampe::{
    Device, DeviceDescriptor, FragmentIn, FragmentOut, PipelineError, RenderPipelineDescriptor,
    Shader, Vec4, VertexIn, VertexOut,
};

/// A shader with `CLIP` clip distances and `CULL` cull distances.
struct Distant<const CLIP: usize, const CULL: usize>;

impl<const CLIP: usize, const CULL: usize> Shader for Distant<CLIP, CULL> {
    type Attributes<R: estampe::Real> = ();
    type Varyings<R: estampe::Real> = ();
    const CLIP_DISTANCES: usize = CLIP;
    const CULL_DISTANCES: usize = CULL;

    fn vertex<R: estampe::Real>(&self, input: VertexIn<'_, R>, _nothing: ()) -> VertexOut<R, ()> {
        let zero = input.zero;
        VertexOut::new(Vec4::new(zero, zero, zero, zero), ())
    }

    fn fragment<R: estampe::Real>(&self, input: FragmentIn<'_, R>, _nothing: ()) -> FragmentOut<R> {
        let zero = input.zero;
        FragmentOut::color(Vec4::new(zero, zero, zero, zero))
    }
}

fn error(descriptor: &RenderPipelineDescriptor) -> Option<PipelineError> {
    let device = Device::new(&DeviceDescriptor::default()).unwrap();
    device.create_render_pipeline(descriptor).err()
}

#[test]
fn lines_have_a_width_of_up_to_64_pixels() {
    for (width, is_fine) in [
        (1.0, true),
        (64.0, true),
        (1e-30, true),
        (0.0, false),
        (-1.0, false),
        (64.01, false),
        (f32::NAN, false),
        (f32::INFINITY, false),
    ] {
        let mut descriptor = RenderPipelineDescriptor::new(Distant::<0, 0>);
        descriptor.primitive.line.width = width;
        let found = error(&descriptor);
        assert_eq!(found.is_none(), is_fine, "{width}: {found:?}");
        assert!(is_fine || matches!(found, Some(PipelineError::LineWidth(_))));
    }
}

#[test]
fn a_stipple_factor_is_1_to_256() {
    for (factor, is_fine) in [(1, true), (256, true), (0, false), (257, false)] {
        let mut descriptor = RenderPipelineDescriptor::new(Distant::<0, 0>);
        descriptor.primitive.line = LineState {
            stipple: Some(LineStipple { factor, pattern: 1 }),
            ..LineState::default()
        };
        let wanted = (!is_fine).then_some(PipelineError::StippleFactor(factor));
        assert_eq!(error(&descriptor), wanted);
    }
}

#[test]
fn there_are_eight_clip_and_eight_cull_distances() {
    let too_many = |count| Some(PipelineError::TooManyDistances { count, limit: 8 });
    let of = |descriptor: RenderPipelineDescriptor| error(&descriptor);
    assert_eq!(of(RenderPipelineDescriptor::new(Distant::<8, 8>)), None);
    assert_eq!(
        of(RenderPipelineDescriptor::new(Distant::<9, 0>)),
        too_many(9)
    );
    assert_eq!(
        of(RenderPipelineDescriptor::new(Distant::<0, 12>)),
        too_many(12)
    );
}
