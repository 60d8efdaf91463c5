//! A `Program` that claims to pass its colour through although it has no varyings.

use crate::support::Images;
use estampe::shader::{FragmentBatch, Interface, VertexBatch};
use estampe::state::BlendState;
use estampe::{Bindings, Device, DeviceDescriptor, Draw, Level, Program, RenderPipelineDescriptor};
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
