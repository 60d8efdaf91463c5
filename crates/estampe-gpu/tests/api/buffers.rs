//! Buffers: partial writes and reads, slices, dynamic offsets, indirect draws, copies.

use crate::support::{Images, device, noise};
use estampe::state::{PrimitiveTopology, VertexBufferLayout};
use estampe::{
    BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType,
    BufferDescriptor, BufferSlice, Device, Draw, FragmentIn, FragmentOut, IndexFormat,
    RenderPipeline, RenderPipelineDescriptor, Vec2, Vec4, VertexFormat, VertexIn, VertexOut,
    bytes_of,
};

#[test]
fn any_bytes_are_written_and_read() {
    let device = device();
    for size in [1_usize, 6, 64, 103] {
        let all = 0..size as u64;
        let buffer = device
            .create_buffer(&BufferDescriptor::new(all.end))
            .unwrap();
        assert_eq!(buffer.size(), all.end);
        let mut expected = vec![0; size];
        for (seed, first) in (0..).zip(0..size) {
            for len in [0, 1, 2, 3, 5, size - first] {
                if first + len > size {
                    continue;
                }
                let bytes = noise(len, seed);
                let range = first as u64..(first + len) as u64;
                buffer.write(range.start, &bytes).unwrap();
                expected[first..][..len].copy_from_slice(&bytes);
                let mut read = vec![0; size];
                buffer.read(0, &mut read).unwrap();
                assert_eq!(read, expected);
                let mut part = vec![0; len];
                buffer.read(range.start, &mut part).unwrap();
                assert_eq!(part, bytes);
                let mapped = buffer.map_read(range, <[u8]>::to_vec);
                assert_eq!(mapped.unwrap(), bytes);
            }
        }
        let len = buffer.map_write(1..all.end, |bytes| {
            bytes.reverse();
            bytes.len()
        });
        assert_eq!(len.unwrap(), size - 1);
        expected[1..].reverse();
        let mapped = buffer.map_read(all, <[u8]>::to_vec).unwrap();
        assert_eq!(mapped, expected);
        // A clone is the same memory.
        buffer.clone().write(0, &[9]).unwrap();
        assert_eq!(buffer.map_read(0..1, |bytes| bytes[0]).unwrap(), 9);
    }
}

#[test]
fn buffers_are_copied_and_cleared_in_part() {
    let device = device();
    let bytes = noise(50, 1);
    let from = device.create_buffer_with_contents(&bytes).unwrap();
    let into = device.create_buffer_with_contents(&[7; 20]).unwrap();
    device
        .copy_buffer_to_buffer((&from, 13), (&into, 3), 11)
        .unwrap();
    let mut expected = vec![7; 20];
    expected[3..14].copy_from_slice(&bytes[13..24]);
    assert_eq!(into.map_read(0..20, <[u8]>::to_vec).unwrap(), expected);
    device.clear_buffer(&into, 5, 2).unwrap();
    expected[5..7].fill(0);
    assert_eq!(into.map_read(0..20, <[u8]>::to_vec).unwrap(), expected);
    // Inside one buffer, overlapping.
    device
        .copy_buffer_to_buffer((&from, 0), (&from, 10), 40)
        .unwrap();
    let expected = [&bytes[..10], &bytes[..40]].concat();
    assert_eq!(from.map_read(0..50, <[u8]>::to_vec).unwrap(), expected);
}

#[test]
fn slices_take_every_kind_of_range() {
    let buffer = device().create_buffer(&BufferDescriptor::new(40)).unwrap();
    let place = |slice: BufferSlice| (slice.offset, slice.size);
    assert_eq!(place(buffer.slice(..)), (0, 40));
    assert_eq!(place(buffer.slice(4..12)), (4, 8));
    assert_eq!(place(buffer.slice(8..)), (8, 32));
    assert_eq!(place(buffer.slice(..=15)), (0, 16));
    assert_eq!(place(buffer.slice(48..)), (48, 0));
    assert_eq!(place((&buffer).into()), (0, 40));
}

/// A pixel per vertex; its red is in the vertex buffer, its blue in the uniform buffer.
struct Dots;

estampe::shader! {
    impl Shader for Dots {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, Vec2<R>> {
            let [shift, blue] = input.bindings.f32s::<2>(0, 5, 0);
            // Column x of 8, at its centre.
            let x = (at.x + shift) * 0.25 - 0.875;
            let varyings = Vec2::new(at.y, input.real(blue));
            VertexOut::new(Vec4::new(x, input.zero, input.zero, input.real(1.0)), varyings)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, color: Vec2<R>) -> FragmentOut<R> {
            FragmentOut::color(Vec4::new(color.x, input.zero, color.y, input.real(1.0)))
        }
    }
}

struct Scene {
    device: Device,
    pipeline: RenderPipeline,
    group: estampe::BindGroup,
    uniforms: estampe::Buffer,
}

/// Uniforms of 8 bytes at each multiple of 8: no shift and blue 0, a shift of 1 and blue 1, …
fn scene() -> Scene {
    let device = device();
    let layout = device
        .create_bind_group_layout(&[BindGroupLayoutEntry {
            binding: 5,
            ty: BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset: true,
                min_binding_size: 8,
            },
        }])
        .unwrap();
    let uniforms = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.2], [3.0, 0.4]];
    let uniforms = device
        .create_buffer_with_contents(bytes_of(&uniforms))
        .unwrap();
    let group = device
        .create_bind_group(&BindGroupDescriptor {
            label: Some("uniforms"),
            layout: &layout,
            entries: &[(5, BindingResource::Buffer(uniforms.slice(8..16)))],
        })
        .unwrap();
    let mut descriptor = RenderPipelineDescriptor::new(Dots);
    descriptor.bind_group_layouts = vec![layout];
    descriptor.primitive.topology = PrimitiveTopology::PointList;
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
    descriptor.depth_stencil = None;
    Scene {
        pipeline: device.create_render_pipeline(&descriptor).unwrap(),
        device,
        group,
        uniforms,
    }
}

impl Scene {
    /// The red and blue codes of a picture of 8×1 pixels.
    fn drawn(&self, draws: &[Draw<'_>]) -> [[u8; 2]; 8] {
        let images = Images::new(&self.device, 8, 1);
        images.draw(&self.device, draws);
        let pixels = images.pixels(&self.device);
        std::array::from_fn(|x| [pixels[x * 4], pixels[x * 4 + 2]])
    }

    /// A draw with one dynamic offset.
    fn draw<'a>(&'a self, offset: &'a u32, elements: std::ops::Range<u32>) -> Draw<'a> {
        Draw {
            bind_groups: std::slice::from_ref(&self.group),
            dynamic_offsets: std::slice::from_ref(offset),
            ..Draw::new(&self.pipeline, elements)
        }
    }

    /// Vertices in columns 0 to 3, of red 51, 102, 153, 204.
    fn vertices(&self) -> estampe::Buffer {
        let vertices = [[0.0, 0.2], [1.0, 0.4], [2.0, 0.6], [3.0, 0.8]];
        self.device
            .create_buffer_with_contents(bytes_of(&vertices))
            .unwrap()
    }
}

const NONE: [u8; 2] = [0, 0];

#[test]
fn draws_read_slices_and_dynamic_offsets() {
    let scene = scene();
    let vertices = scene.vertices();
    // The second and third vertex: red 102 and 153 in columns 1 and 2. The binding begins at 8, so
    // the offset 8 finds the shift 2 and blue 51.
    let slice = [vertices.slice(8..24)];
    let draw = |offset| Draw {
        vertex_buffers: &slice,
        ..scene.draw(offset, 0..2)
    };
    let expected = [NONE, NONE, NONE, [102, 51], [153, 51], NONE, NONE, NONE];
    assert_eq!(scene.drawn(&[draw(&8)]), expected);
    // Two draws of one group: the second one shifts by 1.
    let mut expected = expected;
    expected[2] = [102, 255];
    expected[3] = [153, 255];
    assert_eq!(scene.drawn(&[draw(&8), draw(&0)]), expected);
    // What is written is in the next pass.
    scene.uniforms.write(12, &0.8_f32.to_le_bytes()).unwrap();
    expected[2] = [102, 204];
    expected[3] = [153, 204];
    assert_eq!(scene.drawn(&[draw(&8), draw(&0)]), expected);
}

/// A vertex beyond the slice reads zeros, even if the buffer goes on.
#[test]
fn slices_end_where_they_end() {
    let scene = scene();
    let vertices = scene.vertices();
    let slice = [vertices.slice(16..24)];
    let draw = Draw {
        vertex_buffers: &slice,
        ..scene.draw(&0, 0..2)
    };
    let mut expected = [NONE; 8];
    expected[3] = [153, 255];
    expected[1] = [0, 255];
    assert_eq!(scene.drawn(&[draw]), expected);
    // Indices: the slice holds 2 and 3, then the buffer 1.
    let indices = scene
        .device
        .create_buffer_with_contents(bytes_of(&[0_u32, 2, 3, 1]))
        .unwrap();
    let (all, indices) = ([vertices.slice(..)], indices.slice(4..12));
    let draw = Draw {
        vertex_buffers: &all,
        index_buffer: Some((&indices, IndexFormat::Uint32)),
        ..scene.draw(&0, 0..3)
    };
    let mut expected = [NONE; 8];
    expected[3] = [153, 255];
    expected[4] = [204, 255];
    let mut drawn = scene.drawn(&[draw]);
    // The index beyond the slice is 0, or draws nothing; it is not 1.
    drawn[1] = NONE;
    assert_eq!(drawn, expected);
}

#[test]
fn indirect_draws_read_the_parameters() {
    let scene = scene();
    let vertices = [scene.vertices().slice(..)];
    let parameters = [99_u32, 2, 1, 1, 0, 2, 1, 1, u32::MAX, 0];
    let parameters = scene
        .device
        .create_buffer_with_contents(bytes_of(&parameters))
        .unwrap();
    let draw = Draw {
        vertex_buffers: &vertices,
        bind_groups: std::slice::from_ref(&scene.group),
        dynamic_offsets: &[0],
        ..Draw::indirect(&scene.pipeline, &parameters, 4).unwrap()
    };
    assert_eq!(
        (draw.elements.clone(), draw.instances.clone()),
        (1..3, 0..1)
    );
    let mut expected = [NONE; 8];
    expected[2] = [102, 255];
    expected[3] = [153, 255];
    assert_eq!(scene.drawn(&[draw]), expected);
    // Indices 1 and 3, from the base vertex −1.
    let indices = scene
        .device
        .create_buffer_with_contents(bytes_of(&[9_u16, 1, 3]))
        .unwrap();
    let indices = indices.slice(..);
    let index_buffer = (&indices, IndexFormat::Uint16);
    let draw = Draw {
        vertex_buffers: &vertices,
        bind_groups: std::slice::from_ref(&scene.group),
        dynamic_offsets: &[0],
        ..Draw::indexed_indirect(&scene.pipeline, index_buffer, &parameters, 20).unwrap()
    };
    assert_eq!((draw.elements.clone(), draw.base_vertex), (1..3, -1));
    let mut expected = [NONE; 8];
    expected[1] = [51, 255];
    expected[3] = [153, 255];
    assert_eq!(scene.drawn(&[draw]), expected);
}
