//! Indirect draws: draws whose parameters are in a buffer.

use estampe::{
    Buffer, Device, DeviceDescriptor, Draw, IndexFormat, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, RenderTarget, RenderTargetDescriptor,
};
use estampe_tests::geometry::{Style, triangles, vertex_buffer, vertex_layout};
use estampe_tests::{Random, shaders::Probe, shaders::Scalar};

fn device() -> Device {
    Device::new(&DeviceDescriptor::default()).unwrap()
}

fn target(device: &Device) -> RenderTarget {
    let descriptor = RenderTargetDescriptor::new(40, 40);
    device.create_render_target(&descriptor).unwrap()
}

fn pipeline(device: &Device) -> RenderPipeline {
    device
        .create_render_pipeline(&RenderPipelineDescriptor {
            vertex_buffers: vec![vertex_layout()],
            ..RenderPipelineDescriptor::new(Probe(Scalar::Flat))
        })
        .unwrap()
}

fn image(device: &Device, draw: Draw<'_>) -> Vec<u8> {
    let mut target = target(device);
    let pass = RenderPass {
        draws: &[draw],
        ..RenderPass::default()
    };
    device.render(&mut target, &pass).unwrap();
    target.read_color(0)
}

/// Rows: V2.
#[test]
fn parameters_are_read_from_the_buffer() {
    let (device, random) = (device(), &mut Random::new("indirect", 1));
    let pipeline = pipeline(&device);
    let buffers = [vertex_buffer(&triangles(random, Style::Large, [40, 40], 6))];
    let indices = Buffer::from_words((0..18).rev().collect::<Vec<u32>>());
    // The parameters are read at the offset, which need not be a multiple of four.
    for shift in [0, 4, 7] {
        let parameters = |words: &[u32]| {
            let mut bytes = vec![0xAB; shift];
            bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
            Buffer::from_bytes(&bytes)
        };
        let direct = Draw {
            vertex_buffers: &buffers,
            instances: 2..3,
            ..Draw::new(&pipeline, 3..12)
        };
        let indirect = Draw {
            vertex_buffers: &buffers,
            ..Draw::indirect(&pipeline, &parameters(&[9, 1, 3, 2]), shift)
        };
        let wanted = image(&device, direct);
        assert!(wanted.iter().any(|&byte| byte != 0));
        assert_eq!(image(&device, indirect), wanted);

        let indices = (&indices, IndexFormat::Uint32);
        let direct = Draw {
            vertex_buffers: &buffers,
            indices: Some(indices),
            base_vertex: -3,
            ..Draw::new(&pipeline, 3..12)
        };
        let words = [9, 1, 3, (-3_i32).cast_unsigned(), 0];
        let indirect = Draw {
            vertex_buffers: &buffers,
            ..Draw::indexed_indirect(&pipeline, indices, &parameters(&words), shift)
        };
        assert_eq!(image(&device, indirect), image(&device, direct));
    }
}

/// Rows: V2.
#[test]
fn hostile_counts_are_limited() {
    let device = device();
    let pipeline = pipeline(&device);
    let numbers = [0, 1, 3, 1 << 20, 1 << 27, u32::MAX - 1, u32::MAX];
    for count in numbers {
        for instances in numbers {
            for first in numbers {
                let words = vec![count, instances, first, first];
                let draw = Draw::indirect(&pipeline, &Buffer::from_words(words), 0);
                let size = |range: &std::ops::Range<u32>| u64::from(range.end - range.start);
                let (elements, copies) = (size(&draw.elements), size(&draw.instances));
                assert!(elements <= u64::from(count) && copies <= u64::from(instances));
                assert!(elements * copies <= u64::from(Draw::INDIRECT_LIMIT));
                if u64::from(count) * u64::from(instances) <= 1 << 27 && first < 1 << 27 {
                    assert_eq!(elements * copies, u64::from(count) * u64::from(instances));
                }
            }
        }
    }
}

/// Rows: V2.
#[test]
fn parameters_beyond_the_buffers_end_are_zero() {
    let device = device();
    let pipeline = pipeline(&device);
    let parameters = Buffer::from_words(vec![3]);
    for offset in [0, 2, 4, 400, usize::MAX - 3, usize::MAX] {
        let draw = Draw::indirect(&pipeline, &parameters, offset);
        assert!(draw.instances.is_empty());
        assert!(image(&device, draw).iter().all(|&byte| byte == 0));
    }
}
