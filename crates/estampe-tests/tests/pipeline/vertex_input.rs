//! Vertex fetch: instances, indices of every width, formats, and buffers that are too short.

use estampe_tests::geometry::{
    Style, Vertex, clip_at, triangles, values, vertex_buffer, vertex_layout,
};
use estampe_tests::shaders::{Colored, Formats, Indexed, Probe};
use estampe_tests::{Case, CaseDraw, Random, check, check_some};
use estampe_types::state::{
    PrimitiveTopology, VertexAttribute, VertexBufferLayout, VertexStepMode,
};
use estampe_types::{BufferData, IndexFormat, VertexFormat};

fn small_vertices(random: &mut Random, size: [u32; 2], count: u32) -> Vec<Vertex> {
    (0..count)
        .map(|_| {
            let place = [
                random.range(0.0, size[0] as f32),
                random.range(0.0, size[1] as f32),
            ];
            Vertex {
                position: clip_at(size, place, random.unit(), 1.0),
                values: values(random),
            }
        })
        .collect()
}

/// The third attribute of [`Indexed`], in a buffer of its own.
fn shifts(
    random: &mut Random,
    step_mode: VertexStepMode,
    count: u32,
    stride: u32,
) -> (VertexBufferLayout, BufferData) {
    let layout = VertexBufferLayout {
        array_stride: stride,
        step_mode,
        attributes: vec![VertexAttribute {
            format: VertexFormat::Float32x2,
            offset: 0,
            shader_location: 2,
        }],
        instance_step_rate: random.pick(&[1, 1, 0, 2, 3, u32::MAX]),
    };
    let words = (0..count * stride.div_ceil(4).max(2)).map(|_| random.range(-0.7, 0.7).to_bits());
    (layout, BufferData::from_words(words.collect::<Vec<_>>()))
}

fn topology(random: &mut Random) -> PrimitiveTopology {
    random.pick(&[
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::TriangleFan,
        PrimitiveTopology::LineStrip,
        PrimitiveTopology::LineLoop,
        PrimitiveTopology::PointList,
    ])
}

fn indexed_draw(random: &mut Random, case: &Case) -> CaseDraw {
    let vertices = small_vertices(random, case.size, 20);
    let mut draw = CaseDraw::new(Indexed, &vertices);
    let step_mode = random.pick(&[VertexStepMode::Vertex, VertexStepMode::Instance]);
    let stride = random.pick(&[8, 16, 12, 0]);
    let shifts = shifts(random, step_mode, 5, stride);
    draw.buffers.push(shifts);
    draw.primitive.topology = topology(random);
    draw
}

/// Rows: V2.
#[test]
fn instances() {
    check("vertex_input/instances", 40, |random| {
        let mut case = Case::random_target(random);
        let mut draw = indexed_draw(random, &case);
        let first = random.pick(&[0, 0, 1, 3, 70_000]);
        draw.instances = first..first + random.pick(&[0, 1, 2, 5]);
        draw.elements = random.pick(&[0..3, 0..6, 4..13, 2..2, 18..24]);
        draw.depth = None;
        case.draws.push(draw);
        case
    });
}

/// Rows: V2.
#[test]
fn many_instances_of_a_draw_that_fills_no_packet() {
    // Unused lanes of a packet once accumulated the instances' first vertices until they
    // overflowed.
    let random = &mut Random::new("vertex_input/many", 1);
    let mut case = Case::new([2, 2], 1);
    let mut draw = indexed_draw(random, &case);
    draw.indices = Some((IndexFormat::Uint8, BufferData::from_bytes(&[0, 5, 11])));
    draw.elements = 0..3;
    draw.instances = 0..30_000;
    draw.primitive.topology = PrimitiveTopology::TriangleList;
    case.draws.push(draw);
    check_some("vertex_input/many", &case);
}

/// Rows: V2.
#[test]
fn instances_of_more_vertices_than_a_draw_batch_holds() {
    // Twelve vertices each, so that the bound on vertices ends a draw batch before the bound on
    // primitives does; the step rate counts across the cut.
    let random = &mut Random::new("vertex_input/waves", 1);
    let mut case = Case::new([3, 3], 1);
    let mut draw = indexed_draw(random, &case);
    draw.buffers[1].0.step_mode = VertexStepMode::Instance;
    draw.buffers[1].0.instance_step_rate = 100_003;
    draw.indices = Some((IndexFormat::Uint8, BufferData::from_bytes(&[0, 5, 11])));
    draw.elements = 0..3;
    draw.instances = 7..200_007;
    draw.primitive.topology = PrimitiveTopology::TriangleList;
    draw.depth = None;
    case.draws.push(draw);
    check_some("vertex_input/waves", &case);
}

#[test]
fn the_base_vertex_moves_indices_alone() {
    check("vertex_input/base_without_indices", 6, |random| {
        let mut case = Case::new([40, 40], 1);
        let mut draw = indexed_draw(random, &case);
        draw.elements = 3..12;
        draw.base_vertex = random.pick(&[-3, 2, i32::MIN, i32::MAX]);
        case.draws.push(draw);
        case
    });
}

fn index_bytes(format: IndexFormat, indices: &[u32]) -> Vec<u8> {
    let width = match format {
        IndexFormat::Uint8 => 1,
        IndexFormat::Uint16 => 2,
        IndexFormat::Uint32 => 4,
    };
    let bytes = indices.iter().map(|index| index.to_le_bytes());
    bytes.flat_map(|four| four[..width].to_vec()).collect()
}

/// Rows: V2.
#[test]
fn indices_of_every_width() {
    check("vertex_input/indices", 120, |random| {
        let mut case = Case::random_target(random);
        let mut draw = indexed_draw(random, &case);
        let format = random.pick(&[IndexFormat::Uint8, IndexFormat::Uint16, IndexFormat::Uint32]);
        // Few of 20 vertices, or some far away: a sparse range, also beyond the buffers' ends.
        let far = random.pick(&[0, 0, 21, 200, 70_000, u32::MAX]);
        let mut indices: Vec<_> = (0..18).map(|_| random.below(20)).collect();
        if far > 0 {
            for _ in 0..3 {
                indices[random.below(18) as usize] = far - random.below(3);
            }
        }
        let mut bytes = index_bytes(format, &indices);
        // The buffer ends before the draw, sometimes within an index.
        if random.once_in(3) {
            bytes.truncate(random.index(bytes.len()));
        }
        draw.indices = Some((format, BufferData::from_bytes(&bytes)));
        draw.elements = random.pick(&[0..18, 3..18, 0..7, 5..30, 17..17]);
        draw.base_vertex = random.pick(&[0, 0, 0, 1, -5, 70_000, i32::MAX, i32::MIN]);
        draw.instances = random.pick(&[0..1, 0..1, 2..4]);
        case.draws.push(draw);
        case
    });
}

/// Rows: V2.
#[test]
fn elements_at_the_end_of_the_range_of_u32() {
    check("vertex_input/far_elements", 6, |random| {
        let mut case = Case::new([20, 20], 1);
        let mut draw = indexed_draw(random, &case);
        draw.elements = u32::MAX - 9..u32::MAX;
        if random.once_in(2) {
            draw.indices = Some((IndexFormat::Uint16, BufferData::from_bytes(&[1, 0, 2, 0])));
        }
        case.draws.push(draw);
        case
    });
}

/// Rows: V2.
#[test]
fn vertex_buffers_that_end_too_soon() {
    check("vertex_input/short", 60, |random| {
        let mut case = Case::random_target(random);
        let vertices = triangles(random, Style::Large, case.size, 6);
        let whole: Vec<u8> = vertex_buffer(&vertices)
            .words()
            .iter()
            .flat_map(|word| word.to_le_bytes())
            .collect();
        // Cut at any byte: within a vertex, an attribute or a number.
        let kept = random.index(whole.len() + 1);
        let mut draw = CaseDraw::new(Probe::random(random), &vertices);
        draw.buffers = vec![(vertex_layout(), BufferData::from_bytes(&whole[..kept]))];
        case.draws.push(draw);
        case
    });
}

/// Rows: V1, V2.
#[test]
fn formats_strides_and_offsets() {
    check("vertex_input/formats", 250, |random| {
        let mut case = Case::new([32, 32], 1);
        let vertices = triangles(random, Style::Small, case.size, 8);
        let mut draw = CaseDraw::new(Formats(random.below(10) as usize), &vertices);
        draw.buffers[0].0.attributes.truncate(1);
        // Four attributes in one buffer, aligned or not, with gaps between them.
        let mut offset = random.pick(&[0, 0, 4, 1, 2, 3]);
        let mut attributes = Vec::new();
        for shader_location in 1..5 {
            let format = random.pick(VertexFormat::ALL);
            attributes.push(VertexAttribute {
                format,
                offset,
                shader_location,
            });
            let size = u32::try_from(format.size_bytes()).expect("at most 16");
            offset += size + random.pick(&[0, 0, 4, 1, 2]);
        }
        let stride = match random.below(4) {
            0 => 0,
            1 => offset,
            _ => offset.next_multiple_of(4) + random.pick(&[0, 4]),
        };
        let layout = VertexBufferLayout {
            array_stride: stride,
            step_mode: random.pick(&[VertexStepMode::Vertex, VertexStepMode::Instance]),
            attributes,
            instance_step_rate: random.pick(&[1, 1, 2, 0]),
        };
        let needed = stride.max(1) * random.pick(&[24, 24, 20, 2]) + offset;
        let bytes: Vec<u8> = (0..needed).map(|_| random.byte()).collect();
        draw.buffers.push((layout, BufferData::from_bytes(&bytes)));
        draw.instances = random.pick(&[0..1, 0..2, 7..8]);
        draw.depth = None;
        case.draws.push(draw);
        case
    });
}

/// Rows: V2.
#[test]
fn empty_draws() {
    check("vertex_input/nothing", 6, |random| {
        let mut case = Case::random_target(random);
        let vertices = triangles(random, Style::Large, case.size, 1);
        let mut draw = CaseDraw::new(Colored, &vertices);
        draw.elements = random.pick(&[0..0, 0..2, 3..3, 1..3]);
        case.draws.push(draw);
        case
    });
}
