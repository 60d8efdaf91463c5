//! A `Program` that claims to pass its colour through although it has no varyings, or to read
//! derivatives of varyings that it does not have.

use crate::support::Images;
use estampe::shader::{FragmentBatch, Interface, Interpolation, VertexBatch};
use estampe::state::BlendState;
use estampe::{
    Bindings, Device, DeviceDescriptor, Draw, Level, Program, RenderPipelineDescriptor, SampleType,
    TextureFormat,
};
use std::sync::Arc;

#[derive(Debug)]
struct Claimant(Interface);

impl Program for Claimant {
    fn interface(&self) -> &Interface {
        &self.0
    }

    fn run_vertices(&self, _level: Level, _bindings: &Bindings, batch: VertexBatch<'_>) {
        // One triangle that covers the target.
        let corners = [[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]];
        for (position, index) in batch.positions.chunks_exact_mut(4).zip(batch.vertex_index) {
            for (lane, vertex) in index.0.iter().enumerate() {
                let [x, y] = corners[*vertex as usize % 3];
                for (axis, value) in [x, y, 0.5, 1.0].into_iter().enumerate() {
                    position[axis].0[lane] = value;
                }
            }
        }
    }

    fn run_fragments(&self, _level: Level, _bindings: &Bindings, batch: FragmentBatch<'_>) {
        batch
            .colors
            .iter_mut()
            .for_each(|color| color.0 = [1.0; 16]);
    }
}

#[test]
fn a_false_passthrough_claim_has_no_effect() {
    for level in Level::all_available() {
        let device = Device::new(&DeviceDescriptor {
            threads: 1,
            level,
            ..DeviceDescriptor::default()
        })
        .unwrap();
        for blend in [None, Some(BlendState::ALPHA_BLENDING)] {
            let mut descriptor =
                RenderPipelineDescriptor::with_program(Arc::new(Claimant(Interface {
                    color_targets: 1,
                    color_passthrough: true,
                    no_derivatives: true,
                    ..Interface::default()
                })));
            descriptor.targets[0].as_mut().unwrap().blend = blend;
            let pipeline = device.create_render_pipeline(&descriptor).unwrap();
            let images = Images::new(&device, 70, 20);
            images.draw(&device, &[Draw::new(&pipeline, 0..3)]);
            assert!(
                images.pixels(&device).iter().all(|&byte| byte == 255),
                "{level:?}"
            );
        }
    }
}

/// What a pipeline says of a target's format, where the shader writes numbers of a type.
fn said_of(
    color_types: &[Option<SampleType>],
    formats: &[Option<TextureFormat>],
) -> Option<String> {
    let device = Device::new(&DeviceDescriptor::default()).expect("the default");
    let program = Claimant(Interface {
        color_targets: formats.len(),
        color_types: color_types.to_vec(),
        no_derivatives: true,
        ..Interface::default()
    });
    let targets = formats.iter().map(|format| format.map(Into::into));
    let made = device.create_render_pipeline(&RenderPipelineDescriptor {
        targets: targets.collect(),
        ..RenderPipelineDescriptor::with_program(Arc::new(program))
    });
    made.err().map(|error| error.to_string())
}

#[test]
fn colors_have_the_type_of_their_targets() {
    use SampleType::{Float, Sint, Uint};
    use TextureFormat::{R32Sint, Rgb10a2Uint, Rgba8Unorm, Rgba8UnormSrgb, Rgba16Float};
    let fitting = [
        (Float, Rgba8UnormSrgb),
        (Float, Rgba16Float),
        (Uint, Rgb10a2Uint),
        (Sint, R32Sint),
    ];
    for (ty, _) in fitting {
        for (other, format) in fitting {
            let said = said_of(&[Some(ty)], &[Some(format)]);
            assert_eq!(said.is_none(), ty == other, "{ty:?}, {format:?}: {said:?}");
        }
    }
    // Targets without a colour, holes, and shaders that tell no types.
    for types in [&[][..], &[None], &[None, Some(Uint)]] {
        assert_eq!(said_of(types, &[Some(R32Sint), None]), None, "{types:?}");
    }
    assert_eq!(
        said_of(&[Some(Float), Some(Uint)], &[Some(Rgba8Unorm); 2]).as_deref(),
        Some(
            "the shader writes unsigned integers (u32) at location 1, and colour target 1 has the \
             format rgba8unorm, which holds floats (f32): give the output or the target the \
             other's type"
        )
    );
}

/// What a pipeline says of the scalars whose derivatives the fragments read, of two.
fn said_of_gradients(gradients: &[usize]) -> Option<String> {
    let device = Device::new(&DeviceDescriptor::default()).expect("the default");
    let program = Claimant(Interface {
        varyings: vec![Interpolation::Smooth; 2],
        gradients: gradients.to_vec(),
        color_targets: 1,
        ..Interface::default()
    });
    let descriptor = RenderPipelineDescriptor::with_program(Arc::new(program));
    let made = device.create_render_pipeline(&descriptor);
    made.err().map(|error| error.to_string())
}

#[test]
fn derivatives_are_those_of_varyings_that_exist() {
    for gradients in [&[][..], &[0], &[1], &[0, 1]] {
        assert_eq!(said_of_gradients(gradients), None, "{gradients:?}");
    }
    for (gradients, scalar) in [(&[2][..], 2), (&[0, usize::MAX], usize::MAX)] {
        let said = said_of_gradients(gradients).expect("a varying that is missing");
        assert_eq!(
            said,
            format!(
                "the program reads the derivative of scalar {scalar} of its 2 scalars of varyings: \
                 list scalars that exist, in ascending order"
            )
        );
    }
    for gradients in [[1, 0], [1, 1]] {
        assert!(said_of_gradients(&gradients).is_some(), "{gradients:?}");
    }
}
