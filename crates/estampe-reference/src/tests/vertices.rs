//! Vertex fetch and primitive assembly.

use super::*;
use crate::assembly::{Primitive, primitives};

fn layout(format: VertexFormat, stride: u32, offset: u32, location: u32) -> VertexBufferLayout {
    VertexBufferLayout {
        array_stride: stride,
        step_mode: VertexStepMode::Vertex,
        attributes: vec![VertexAttribute {
            format,
            offset,
            shader_location: location,
        }],
        ..VertexBufferLayout::default()
    }
}

/// Rows: V2.
#[test]
fn missing_components_are_0_0_0_1() {
    let floats = BufferData::from_f32s(&[1.5, -2.0, 3.0, 4.0]);
    let decode = |format, buffer: &BufferData| fetch::decode(format, buffer, 0);
    assert_eq!(decode(VertexFormat::Float32, &floats), [1.5, 0.0, 0.0, 1.0]);
    assert_eq!(
        decode(VertexFormat::Float32x2, &floats),
        [1.5, -2.0, 0.0, 1.0]
    );
    assert_eq!(
        decode(VertexFormat::Float32x3, &floats),
        [1.5, -2.0, 3.0, 1.0]
    );
    assert_eq!(
        decode(VertexFormat::Float32x4, &floats),
        [1.5, -2.0, 3.0, 4.0]
    );
    let bytes = BufferData::from_bytes(&[255, 51, 0, 128, 255, 255, 0, 0]);
    let [second, fourth] = [51.0, 128.0].map(|code| code * (1.0 / 255.0));
    assert_eq!(
        decode(VertexFormat::Unorm8x2, &bytes),
        [1.0, second, 0.0, 1.0]
    );
    assert_eq!(
        decode(VertexFormat::Unorm8x4, &bytes),
        [1.0, second, 0.0, fourth]
    );
    let wide = f32::from(51_u16 * 256 + 255) * (1.0 / 65_535.0);
    assert_eq!(decode(VertexFormat::Unorm16x2, &bytes)[0], wide);
    assert_eq!(decode(VertexFormat::Unorm16x4, &bytes)[2..], [1.0, 0.0]);
}

/// Rows: V2.
#[test]
fn missing_data_reads_zeros() {
    let buffers = [(
        layout(VertexFormat::Float32x4, 16, 8, 3),
        BufferData::from_f32s(&[1.0; 7]),
    )];
    let fetch = |location, vertex| fetch::attribute(&buffers, location, vertex, [0; 2]);
    assert_eq!(fetch(3, 0), [1.0; 4]);
    assert_eq!(
        fetch(3, 1),
        [1.0, 0.0, 0.0, 0.0],
        "the buffer ends after one number"
    );
    assert_eq!(fetch(3, u32::MAX), [0.0; 4]);
    assert_eq!(fetch(0, 0), [0.0; 4], "no such location");
    let short = [(
        layout(VertexFormat::Float32x2, 8, 0, 0),
        BufferData::from_f32s(&[]),
    )];
    assert_eq!(fetch::attribute(&short, 0, 0, [0; 2]), [0.0, 0.0, 0.0, 1.0]);
}

/// Rows: V2.
#[test]
fn indices_of_every_width_and_the_base_vertex() {
    let bytes = BufferData::from_bytes(&[1, 2, 3, 4, 5]);
    let index = |format, position, base| fetch::index(format, &bytes, position, base);
    assert_eq!(index(IndexFormat::Uint8, 4, 0), 5);
    assert_eq!(index(IndexFormat::Uint8, 4, -2), 3);
    assert_eq!(index(IndexFormat::Uint16, 1, 0), 0x0403);
    assert_eq!(index(IndexFormat::Uint32, 0, 0), 0x0403_0201);
    assert_eq!(index(IndexFormat::Uint32, 1, 0), 5, "the rest is zeros");
    assert_eq!(
        index(IndexFormat::Uint32, u32::MAX, 7),
        7,
        "beyond the end is 0, plus the base"
    );
    assert_eq!(index(IndexFormat::Uint8, 0, -2), u32::MAX, "modulo 2³²");
}

/// Rows: A1, A5.
#[test]
fn assembly_keeps_winding_and_puts_the_provoking_vertex_first() {
    use PrimitiveTopology as T;
    let of = |topology, count| primitives(topology, count).collect::<Vec<_>>();
    let triangles = |list: &[[u32; 3]]| {
        list.iter()
            .copied()
            .map(Primitive::Triangle)
            .collect::<Vec<_>>()
    };
    let lines = |list: &[[u32; 2]]| {
        list.iter()
            .copied()
            .map(Primitive::Line)
            .collect::<Vec<_>>()
    };
    assert_eq!(of(T::TriangleList, 7), triangles(&[[0, 1, 2], [3, 4, 5]]));
    assert_eq!(
        of(T::TriangleStrip, 5),
        triangles(&[[0, 1, 2], [1, 3, 2], [2, 3, 4]])
    );
    assert_eq!(
        of(T::TriangleFan, 5),
        triangles(&[[1, 2, 0], [2, 3, 0], [3, 4, 0]])
    );
    assert_eq!(of(T::LineList, 5), lines(&[[0, 1], [2, 3]]));
    assert_eq!(of(T::LineStrip, 3), lines(&[[0, 1], [1, 2]]));
    assert_eq!(of(T::LineLoop, 3), lines(&[[0, 1], [1, 2], [2, 0]]));
    assert_eq!(of(T::LineLoop, 1), []);
    assert_eq!(
        of(T::PointList, 2),
        [Primitive::Point(0), Primitive::Point(1)]
    );
    for topology in [T::TriangleStrip, T::TriangleFan, T::LineStrip, T::LineList] {
        assert_eq!(of(topology, 0), []);
        assert_eq!(of(topology, 1), []);
    }
}

/// Rows: V2.
#[test]
fn instances_advance_instance_buffers_and_are_drawn_in_order() {
    // A quad of one pixel as an indexed strip, translated and coloured by instance.
    let mut per_instance = layout(VertexFormat::Float32x3, 28, 16, 1);
    per_instance.step_mode = VertexStepMode::Instance;
    let colors: Vec<f32> = [[0.0, 0.2, 0.2], [0.0, 0.4, 0.4], [0.0, 0.6, 0.6]]
        .iter()
        .flat_map(|color| [0.0; 4].iter().chain(color).copied().collect::<Vec<_>>())
        .collect();
    let corners = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
    let positions: Vec<f32> = corners
        .iter()
        .flat_map(|[x, y]| [*x, *y, 0.0, 1.0])
        .collect();
    let buffers = [
        (
            layout(VertexFormat::Float32x4, 16, 0, 0),
            BufferData::from_f32s(&positions),
        ),
        (per_instance, BufferData::from_f32s(&colors)),
    ];
    let indices = BufferData::from_bytes(&[9, 3, 4, 5, 6]);
    let bindings = Bindings::default();
    let mut target = unorm(2, 2, 1);
    let state = State {
        primitive: PrimitiveState {
            topology: PrimitiveTopology::TriangleStrip,
            cull_mode: CullMode::Back,
            ..PrimitiveState::default()
        },
        ..State::new(2, 2)
    };
    let command = Draw {
        buffers: &buffers,
        indices: Some((IndexFormat::Uint8, &indices)),
        vertices: 1..5,
        instances: 0..2,
        base_vertex: -3,
        bindings: &bindings,
    };
    let counts = draw(&mut target, &Plain, &state, &command);
    assert_eq!(
        (counts.primitives, counts.rasterized, counts.fragments),
        (4, 4, 8)
    );
    assert!(
        target.color.iter().all(|&code| code == [0, 102, 102, 255]),
        "instance 1 is on top"
    );
}

/// Rows: V2.
#[test]
fn codes_at_the_ends_of_every_normalised_format_are_one_and_minus_one() {
    let ones = BufferData::from_bytes(&[0xFF; 16]);
    let most = BufferData::from_bytes(&[0xFF, 0x7F].repeat(8));
    let least = BufferData::from_bytes(&[0x00, 0x80].repeat(8));
    for &format in VertexFormat::ALL {
        let decode = |buffer| fetch::decode(format, buffer, 0)[0];
        match (format.encoding(), format.size_bytes() / format.components()) {
            (VertexEncoding::Unorm, _) => assert_eq!(decode(&ones), 1.0, "{format:?}"),
            (VertexEncoding::Snorm, 2) => {
                assert_eq!([&most, &least].map(decode), [1.0, -1.0], "{format:?}");
            }
            (VertexEncoding::Snorm, _) => {
                let codes = [127, 128, 129].map(|code| BufferData::from_bytes(&[code]));
                assert_eq!(
                    codes.each_ref().map(decode),
                    [1.0, -1.0, -1.0],
                    "{format:?}"
                );
            }
            (VertexEncoding::Uint, 4) | (VertexEncoding::Sint, _) => {
                assert_eq!(decode(&ones).to_bits(), u32::MAX, "{format:?}");
            }
            (VertexEncoding::Uint, bytes) => {
                assert_eq!(
                    decode(&ones).to_bits(),
                    (1 << (8 * bytes)) - 1,
                    "{format:?}"
                );
            }
            (VertexEncoding::Float, _) => assert!(decode(&ones).is_nan(), "{format:?}"),
        }
    }
}

/// Rows: V2.
#[test]
fn packed_formats_and_halves_are_read_as_webgpu_says() {
    let word = |word: u32| BufferData::from_words(vec![word]);
    let packed = word(3 << 30 | 1023 << 20 | 1);
    let decode = |format, buffer: &BufferData| fetch::decode(format, buffer, 0);
    let [r, g, b, a] = decode(VertexFormat::Unorm10_10_10_2, &packed);
    assert_eq!([r, g, b, a], [1.0 / 1023.0, 0.0, 1.0, 1.0]);
    let bgra = decode(VertexFormat::Unorm8x4Bgra, &word(0xFF00_00FF));
    assert_eq!(bgra, [0.0, 0.0, 1.0, 1.0]);
    let halves = [
        (0x3C00, 1.0),
        (0xC000, -2.0),
        (0x7BFF, 65_504.0),
        (0x0400, 2.0_f32.powi(-14)),
        (0x0001, 2.0_f32.powi(-24)),
        (0x83FF, -1023.0 * 2.0_f32.powi(-24)),
        (0x7C00, f32::INFINITY),
        (0xFC00, f32::NEG_INFINITY),
    ];
    for (code, number) in halves {
        assert_eq!(fetch::half(code), number, "{code:#x}");
    }
    assert!(fetch::half(0x8000).to_bits() == 1 << 31 && fetch::half(0x7E00).is_nan());
    let integers = decode(VertexFormat::Sint8, &word(0xFE)).map(f32::to_bits);
    assert_eq!(integers, [u32::MAX - 1, 0, 0, 1]);
}

/// Rows: V2.
#[test]
fn instances_step_from_the_first_one() {
    let of = |instance, rate| fetch::instance_element(instance, 10, rate);
    assert_eq!([10, 11, 12, 13].map(|i| of(i, 2)), [10, 10, 11, 11]);
    assert_eq!([10, 11, 12, 13].map(|i| of(i, 1)), [10, 11, 12, 13]);
    assert_eq!([10, 99].map(|i| of(i, 0)), [10, 10]);
}

/// Rows: V2, A1.
#[test]
fn runs_end_where_an_index_restarts() {
    use crate::assembly::runs;
    let at = |restarts: &'static [u32]| runs(5, move |position| restarts.contains(&position));
    assert_eq!(at(&[5]), vec![0..5; 1]);
    assert_eq!(at(&[0, 3]), [0..0, 1..3, 4..5]);
    assert_eq!(at(&[4]), [0..4, 5..5]);
}

/// Rows: A1, A5.
#[test]
fn the_provoking_vertices_are_those_of_vulkans_table() {
    use crate::assembly::turned;
    use estampe_types::state::{PrimitiveTopology as T, ProvokingVertex as P};
    // (topology, first, last) of primitive i, from the table of §Flat Shading.
    type Of = fn(u32) -> u32;
    let table: [(T, Of, Of); 5] = [
        (T::TriangleList, |i| 3 * i, |i| 3 * i + 2),
        (T::TriangleStrip, |i| i, |i| i + 2),
        (T::TriangleFan, |i| i + 1, |i| i + 2),
        (T::TriangleListAdjacency, |i| 6 * i, |i| 6 * i + 4),
        (T::TriangleStripAdjacency, |i| 2 * i, |i| 2 * i + 4),
    ];
    for (topology, first, last) in table {
        for (i, primitive) in (0..).zip(primitives(topology, 30)) {
            let Primitive::Triangle(given) = primitive else {
                panic!("{topology:?} makes triangles");
            };
            let by = |mode| turned(topology, mode, i as usize, given);
            assert_eq!(by(P::First)[0], first(i), "{topology:?} {i}");
            assert_eq!(by(P::Last)[0], last(i), "{topology:?} {i}");
            // The winding is unchanged.
            let mut turning = given;
            turning.rotate_left(given.iter().position(|&v| v == last(i)).unwrap());
            assert_eq!(by(P::Last), turning, "{topology:?} {i}");
        }
    }
}
