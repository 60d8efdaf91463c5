//! Indirect draws: draws whose parameters are in a buffer.

use estampe::{
    Buffer, BufferError, BufferSlice, ColorAttachment, DepthStencilAttachment, Device,
    DeviceDescriptor, Draw, IndexFormat, RenderPass, RenderPipeline, RenderPipelineDescriptor,
    Texture, TextureDescriptor, TextureFormat,
};
use estampe_tests::geometry::{Style, triangles, vertex_buffer, vertex_layout};
use estampe_tests::{Random, shaders::Probe, shaders::Scalar};

fn device() -> Device {
    Device::new(&DeviceDescriptor::default()).unwrap()
}

fn texture(device: &Device, format: TextureFormat) -> Texture {
    let descriptor = TextureDescriptor::new_2d(40, 40, format);
    device.create_texture(&descriptor).unwrap()
}

fn buffer(device: &Device, words: &[u32]) -> Buffer {
    device.create_buffer_of_words(words.to_vec()).unwrap()
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
    let color = texture(device, TextureFormat::Rgba8Unorm);
    let depth = texture(device, TextureFormat::Depth32Float);
    let pass = RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(&color.view(), [0.0; 4]))],
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth.view(), 1.0)),
        draws: &[draw],
        ..RenderPass::default()
    };
    device.render(&pass).unwrap();
    device.read_texture(&color).unwrap()
}

/// Rows: V2.
#[test]
fn parameters_are_read_from_the_buffer() {
    let (device, random) = (device(), &mut Random::new("indirect", 1));
    let pipeline = pipeline(&device);
    let vertices = vertex_buffer(&triangles(random, Style::Large, [40, 40], 6));
    let buffers = [BufferSlice::from(&buffer(&device, vertices.words()))];
    let indices = buffer(&device, &(0..18).rev().collect::<Vec<u32>>());
    let indices = BufferSlice::from(&indices);
    // The parameters are read at the offset, which need not be a multiple of four.
    for shift in [0, 4, 7] {
        let parameters = |words: &[u32]| {
            let mut bytes = vec![0xAB; shift];
            bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
            device.create_buffer_with_contents(&bytes).unwrap()
        };
        let direct = Draw {
            vertex_buffers: &buffers,
            instances: 2..3,
            ..Draw::new(&pipeline, 3..12)
        };
        let indirect = Draw {
            vertex_buffers: &buffers,
            ..Draw::indirect(&pipeline, &parameters(&[9, 1, 3, 2]), shift as u64).unwrap()
        };
        let wanted = image(&device, direct);
        assert!(wanted.iter().any(|&byte| byte != 0));
        assert_eq!(image(&device, indirect), wanted);

        let indices = (&indices, IndexFormat::Uint32);
        let direct = Draw {
            vertex_buffers: &buffers,
            index_buffer: Some(indices),
            base_vertex: -3,
            ..Draw::new(&pipeline, 3..12)
        };
        let words = [9, 1, 3, (-3_i32).cast_unsigned(), 0];
        let indirect = Draw {
            vertex_buffers: &buffers,
            ..Draw::indexed_indirect(&pipeline, indices, &parameters(&words), shift as u64).unwrap()
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
                let words = buffer(&device, &[count, instances, first, first]);
                let draw = Draw::indirect(&pipeline, &words, 0).unwrap();
                let size = |range: &std::ops::Range<u32>| u64::from(range.end - range.start);
                let (elements, copies) = (size(&draw.elements), size(&draw.instances));
                assert!(elements <= u64::from(count) && copies <= u64::from(instances));
                assert!(elements * copies <= Draw::INDIRECT_LIMIT);
                if u64::from(count) * u64::from(instances) <= 1 << 27 && first < 1 << 27 {
                    assert_eq!(elements * copies, u64::from(count) * u64::from(instances));
                }
            }
        }
    }
}

/// Rows: V2.
#[test]
fn parameters_beyond_the_buffers_end_are_an_error() {
    let device = device();
    let pipeline = pipeline(&device);
    let parameters = buffer(&device, &[3, 1, 0, 0]);
    assert!(Draw::indirect(&pipeline, &parameters, 0).is_ok());
    for offset in [1, 4, 400, u64::MAX - 3, u64::MAX] {
        let error = Draw::indirect(&pipeline, &parameters, offset).unwrap_err();
        assert!(matches!(error, BufferError::Range { size: 16, .. }));
    }
}
